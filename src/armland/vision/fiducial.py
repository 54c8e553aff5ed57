"""Detector of fiducial markers (AprilTag 36h11) in images: from pixels to the pose of each marker. Needs OpenCV.

| symbol | name | unit, frame |
|---|---|---|
| u | pixel coordinates: x right, y down, whole numbers at the pixels' centres | px |
| camera frame c | origin in the optical centre, z along the view, x to the image's right, y down | |
| marker frame m | origin in the marker's centre, z out of the printed face, x to the right and y up on an upright print | |
| u = (f_x X/Z + c_x, f_y Y/Z + c_y) | pinhole without distortion, (X, Y, Z) in frame c; `Intrinsics` | px |
| s | `size_m`, edge of the black square | m |

Frames are those of `plant.devices.camera`, whose measurement model stands for this detector wherever rendering is too slow.
Source: Olson, AprilTag, ICRA 2011 (family); Collins and Bartoli, Infinitesimal Plane-Based Pose Estimation, IJCV 2014 (both
poses of a square); OpenCV's `aruco` for finding and reading the marker.
"""

from types import ModuleType
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.errors import ArmlandError
from armland.rotations import Array, from_rotation_vector, matrix
from armland.vision.square import refined

CELLS = 8  # Cells along the black square: six of code within a border of one
MARKERS = 587  # Markers in the family


SHAKES_PX = 1e-3 * np.array([[[9, -3], [1, 7], [-8, 2], [4, -6]], [[-2, 5], [8, 3], [1, -9], [-6, 4]]]) / 9.0
"""Tenths of what corners are good to, and of no symmetry, px."""

RESIDUAL_MAX_PX = 0.3  # Ten times what corners are good to: where it is more, mostly something lies over an edge


class Intrinsics(NamedTuple):
    """Pinhole camera without distortion, px."""

    fx: float
    fy: float
    cx: float
    cy: float


class Detection(NamedTuple):
    """One marker in one image."""

    marker: int  # number in the family
    position: Array  # (3,) m, marker's centre in the camera frame
    quat: Array  # (4,) camera<-marker, scalar first
    corners: Array  # (4, 2) px, of the black square: top left, top right, bottom right, bottom left of an upright print
    residual_px: float  # rms distance of the corners from those of the pose
    ambiguity: (
        float  # residual over that of the square's other pose, in [0, 1]: near 1 the tilt may be the mirrored one
    )


def pinhole(width: int, height: int, fovy_deg: float) -> Intrinsics:
    """Intrinsics of an image of `width` × `height` square pixels with the full vertical field of view `fovy_deg`."""
    focal = 0.5 * height / np.tan(0.5 * np.deg2rad(fovy_deg))
    return Intrinsics(focal, focal, 0.5 * (width - 1), 0.5 * (height - 1))


def project(points: Array, intrinsics: Intrinsics) -> Array:
    """Pixels (..., 2) of points (..., 3), m, camera frame, in front of the camera."""
    k = intrinsics
    return points[..., :2] / points[..., 2:] * [k.fx, k.fy] + [k.cx, k.cy]


def square(size_m: float) -> Array:
    """Corners (4, 3) of the black square, m, marker frame, in the order of `Detection.corners`."""
    return 0.5 * size_m * np.array([[-1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, -1.0, 0.0]])


def marker_image(marker: int, cell_px: int) -> NDArray[np.uint8]:
    """Upright print (k, k), grey, of a marker with the white margin of one cell that detection needs; k = 10 `cell_px`.

    OpenCV's prints of this family are turned about z against those of the AprilTag project: take marker and detector from here.

    Raises:
        ArmlandError: no such marker, or no OpenCV.
    """
    if not 0 <= marker < MARKERS:
        raise ArmlandError(f"there is no marker {marker} in the family 36h11; its markers are 0 to {MARKERS - 1}")
    cv2 = opencv()
    black = cv2.aruco.generateImageMarker(_family(cv2), marker, CELLS * cell_px)
    return np.pad(black, cell_px, constant_values=255)


def detect(image: NDArray[np.uint8], size_m: float, intrinsics: Intrinsics) -> list[Detection]:
    """Find all markers in an image, ordered by number; those whose edges are unclear or fit no square are left out.

    Args:
        image: grey (h, w) or red, green, blue (h, w, 3), 8 bits, without distortion.
        size_m: edge of the black square of every marker, m.
        intrinsics: of the camera.

    Raises:
        ArmlandError: not such an image, a size that is not positive, or no OpenCV.
    """
    if image.dtype != np.uint8 or not (image.ndim == 2 or (image.ndim == 3 and image.shape[2] == 3)):
        raise ArmlandError(f"image is {image.dtype} {image.shape}; detection needs uint8 (h, w) or (h, w, 3)")
    if not (np.isfinite(size_m) and size_m > 0.0):
        raise ArmlandError(f"marker size is {size_m:g} m; it must be positive")
    cv2 = opencv()
    grey = np.ascontiguousarray(image) if image.ndim == 2 else cv2.cvtColor(image, cv2.COLOR_RGB2GRAY)
    options = cv2.aruco.DetectorParameters()
    # Good to a fraction of a pixel, as `refined` needs it.
    options.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_SUBPIX
    found, numbers, _ = cv2.aruco.ArucoDetector(_family(cv2), options).detectMarkers(grey)
    detections = []
    for rough, number in zip(found, [] if numbers is None else np.ravel(numbers), strict=True):
        corners = refined(grey, rough[0].astype(float), CELLS)
        if corners is not None:
            detections.append(_detection(cv2, int(number), corners, size_m, intrinsics))
    return sorted((d for d in detections if d is not None), key=lambda d: d.marker)


def relocated(found: Detection, size_m: float, intrinsics: Intrinsics) -> Detection | None:
    """The same corners with another camera's intrinsics; None where no pose fits them."""
    return _detection(opencv(), found.marker, found.corners, size_m, intrinsics)


def _detection(cv2: ModuleType, marker: int, corners: Array, size_m: float, intrinsics: Intrinsics) -> Detection | None:
    """The marker with these corners, None where no pose in front of the camera fits them."""
    # To corners that are symmetric to the last bits, OpenCV answers with NaN or nonsense. Two starts are not both so.
    fits = [_fit(cv2, marker, corners, corners + shake, size_m, intrinsics) for shake in SHAKES_PX]
    possible = [d for d in fits if np.isfinite([*d.position, *d.quat]).all() and d.position[2] > 0.0]
    best = min(possible, key=lambda d: d.residual_px, default=None)
    return best if best is not None and best.residual_px <= RESIDUAL_MAX_PX else None


def _fit(cv2: ModuleType, marker: int, corners: Array, start: Array, size_m: float, k: Intrinsics) -> Detection:
    points, K = square(size_m), np.array([[k.fx, 0.0, k.cx], [0.0, k.fy, k.cy], [0.0, 0.0, 1.0]])
    _, turns, shifts, errors = cv2.solvePnPGeneric(points, start, K, None, flags=cv2.SOLVEPNP_IPPE_SQUARE)
    # The better one comes first. It is exact for a perfect square only: the last step makes the corners' residual least.
    turn, shift = cv2.solvePnPRefineLM(points, corners, K, None, turns[0], shifts[0])
    quat, shift = from_rotation_vector(np.ravel(turn)), np.ravel(shift)
    off = project(points @ matrix(quat).T + shift, k) - corners
    residual = float(np.sqrt(np.mean(np.sum(off**2, axis=1))))
    ambiguity = float(errors[0, 0] / errors[1, 0]) if len(errors) > 1 and errors[1, 0] > 0.0 else 0.0
    return Detection(marker, shift, quat, corners, residual, ambiguity)


def _family(cv2: ModuleType) -> Any:
    return cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)


def opencv() -> ModuleType:
    """OpenCV, which is imported only where it is used.

    Raises:
        ArmlandError: it is not installed, or too old.
    """
    # An extra, and half a second to import: only whoever looks at images pays for it.
    try:
        import cv2

        cv2.aruco.ArucoDetector  # noqa: B018
    except (ImportError, AttributeError) as e:
        raise ArmlandError(
            f"the marker detector needs OpenCV 4.10 or newer ({e}); install it with: pip install 'armland[vision]'"
        ) from e
    return cv2
