"""Corners of a dark square on a light ground in an image, to a few hundredths of a pixel.

| symbol | name | unit |
|---|---|---|
| u | pixel coordinates: x right, y down, whole numbers at the pixels' centres | px |
| d, L | across an edge, positive out of the square, and half the length of the profile | px |
| I₋, I₊ | grey at the profile's inner and outer end | |

Along each edge, many short profiles are read across it. Where a blurred step from I₋ to I₊ sits follows from the area under it,
d = L − ∫ (I − I₋)/(I₊ − I₋) dd, whatever the blur, as long as that is symmetric and ends inside the profile. A line
goes through each edge's points, and two lines meet in a corner. OpenCV's `cornerSubPix` looks at the corner itself, which
blur rounds off: on images with known corners it sits 0.15 to 0.3 px inside the square, which makes a marker look farther away.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import map_coordinates

from armland.rotations import Array

ROUNDS = 3  # Every round puts the profiles where the last one found the edges
REACH_PX = (1.5, 5.0)  # Least and largest L: must hold a camera's blur; more only collects noise
REACH_CELLS = 0.6  # L over the width of the border, which is dark on one side of the edge and light on the other
STEP_PX = 0.25  # Between the samples of a profile
CONTRAST = 8.0  # Least I₊ − I₋, grey levels of 255: below, noise decides where the edge is


def refined(image: NDArray[np.uint8], corners: Array, cells: int) -> Array | None:
    """Corners (4, 2), px, of the dark square whose corners are about `corners`; None where it has no clear edges.

    Args:
        image: grey (h, w).
        corners: (4, 2) px, clockwise as seen, good to about a pixel.
        cells: the square's side over the width of its border; around it, the ground is light for as much.
    """
    for _ in range(ROUNDS):
        following = np.roll(corners, -1, axis=0)
        sides = np.linalg.norm(following - corners, axis=1)
        reach = float(np.clip(REACH_CELLS * sides.min() / cells, *REACH_PX))
        if sides.min() < 4.0 * reach:
            return None
        edges = [_edge(image, a, b, reach) for a, b in zip(corners, following, strict=True)]
        lines = np.array([line for line in edges if line is not None])
        if len(lines) < len(edges):
            return None
        # A line through p and q is p × q in homogeneous coordinates, and so is the point where two lines meet.
        meets = np.cross(np.roll(lines, 1, axis=0), lines)
        corners = meets[:, :2] / meets[:, 2:]
        if not np.isfinite(corners).all():
            return None
    return corners


def _edge(image: NDArray[np.uint8], a: Array, b: Array, reach: float) -> Array | None:
    """Line (3,), homogeneous, along the edge that runs about from a to b, both (2,) px."""
    length = float(np.linalg.norm(b - a))
    along = (b - a) / length
    outward = np.array([along[1], -along[0]])
    # Near the corners, the other edge is in the profile.
    margin = min(reach + 2.0, 0.25 * length)
    x = np.linspace(margin, length - margin, int(np.clip(length, 12, 240)))
    d, found = _steps(image, a + x[:, None] * along, outward, reach)
    x, d = x[found], d[found]
    if len(x) < 8:
        return None
    slope, height = np.polyfit(x, d, 1)
    off = np.abs(d - height - slope * x)
    # What covers a part of the edge must not turn the line.
    keep = off <= 3.0 * np.median(off) + 0.02
    slope, height = np.polyfit(x[keep], d[keep], 1)
    p, q = a + height * outward, b + (height + slope * length) * outward
    return np.cross([*p, 1.0], [*q, 1.0])


def _steps(image: NDArray[np.uint8], points: Array, outward: Array, reach: float) -> tuple[Array, NDArray[np.bool_]]:
    """d (k,) px of the step across each of the points (k, 2), and whether there is one (k,)."""
    d = np.linspace(-reach, reach, 2 * round(reach / STEP_PX) + 1)
    where = points[:, None, :] + d[:, None] * outward
    grey = map_coordinates(image, [where[..., 1], where[..., 0]], output=np.float64, order=1, mode="nearest")
    inner, rise = grey[:, :1], grey[:, -1] - grey[:, 0]
    clear = rise > max(CONTRAST, 0.3 * float(np.median(rise)))
    area = np.trapezoid(grey - inner, d, axis=1)
    steps = reach - area / np.where(clear, rise, 1.0)
    return steps, clear & (np.abs(steps) < reach)
