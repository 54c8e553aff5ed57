"""What a real camera makes of a rendered picture, and what its calibration leaves wrong.

| symbol | name | unit |
|---|---|---|
| σ² = σ_lens² + (c/4)² | blur: Gaussian of the lens, and defocus as a disc of diameter c, which has c/4 for each axis | px |
| c = f (f_m/N) abs(1/z − 1/z_f) | `focal_m`, `f_number`, `focus_m`; f in px: defocus of a thin lens at depth z | px |
| H(t) = K [r₁ r₂ t](t) (K [r₁ r₂ t](0))⁻¹ | where the marker's plane is in the picture at time t of the exposure | |
| I (1 + g·u) cos⁴θ | uneven light along the picture, and the fall of a lens's light to its corners | grey levels |
| σ_I² = r² + 255 I/w | `read_noise` r, `full_well_e` w: shot noise of I·w/255 electrons | grey levels |

Rendered pictures are pinhole pictures of 8 bits, sharp and at one instant. Not modelled: rolling shutter (the shutter is
global), shadows that cross the marker, reflections on the print, dirt, a stamp that is not that of the exposure's middle.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.rotations import Array, from_rotation_vector, matrix
from armland.vision.fiducial import Intrinsics, opencv


class Imaging(NamedTuple):
    """Imperfections of the picture. Numbers without a source are assumptions: an industrial board camera in a lit hall."""

    lens_px: float = 0.6
    """Standard deviation of the lens's blur in focus: about 30 % contrast at half the sampling frequency."""
    focal_m: float = 4.0e-3  # With pixels of 3.75 µm, 1280 by 960 of a common 1/3 inch sensor, the 48 degrees of view
    f_number: float = 8.0  # Stopped down, as the marker must be sharp from 0.13 m to 1 m
    focus_m: float = 0.25
    exposure_s: float = 4.0e-3
    """What f/8 needs under 500 lx (EN 12464-1, assembly work) with a gain; shorter with a lamp."""
    substeps: int = 5
    gradient: float = 0.3
    """Largest change of the light from the picture's middle to its edge, as a fraction; direction and size are drawn."""
    dimmest: float = 0.4
    """Least exposure, as a share of the renderer's; drawn between that and 1: the UAV shades its own underside."""
    read_noise: float = 1.2  # Grey levels of 255
    full_well_e: float = 5000.0
    """Electrons at grey 255: half the well of a 3.75 µm pixel, as with a gain of 6 dB. 2.5 grey levels of noise in mid grey."""


IDEAL = Imaging(
    lens_px=0.0, f_number=np.inf, exposure_s=0.0, gradient=0.0, dimmest=1.0, read_noise=0.0, full_well_e=np.inf
)
"""Nothing but the renderer and 8 bits."""


class Calibration(NamedTuple):
    """Standard deviations of what an intrinsic calibration leaves. Assumptions of the size that bundle adjustments of 20 to 50
    pictures of a board state for themselves, doubled."""

    focal: float = 1.5e-3  # Share of the focal length: 0.15 %
    aspect: float = 3e-4  # Share by which f_x and f_y err apart
    centre_px: float = 0.4  # Principal point, each axis
    corner_px: float = 0.3  # Distortion that is left in the picture's corners, radial


class Unit(NamedTuple):
    """One camera: what its calibration believes, and the distortion that it does not know of."""

    believed: Intrinsics
    k1: float  # radial, in tangents of the angle of view


class Motion(NamedTuple):
    """The marker against the camera in the middle of the exposure, camera frame."""

    position: Array  # (3,) m
    quat: Array  # (4,) camera<-marker
    velocity: Array  # (3,) m/s
    omega: Array  # (3,) rad/s


def draw_unit(true: Intrinsics, calibration: Calibration, rng: np.random.Generator) -> Unit:
    """A camera as it may leave a calibration."""
    n, c = rng.standard_normal(5), calibration
    f = true.fx * (1.0 + c.focal * n[0])
    believed = Intrinsics(
        f * (1.0 + 0.5 * c.aspect * n[1]),
        f * (1.0 - 0.5 * c.aspect * n[1]),
        true.cx + c.centre_px * n[2],
        true.cy + c.centre_px * n[3],
    )
    corner = float(np.hypot(true.cx / true.fx, true.cy / true.fy))
    return Unit(believed, float(c.corner_px * n[4] / (true.fx * corner**3)))


def photographed(
    picture: NDArray[np.uint8],
    true: Intrinsics,
    motion: Motion,
    imaging: Imaging,
    rng: np.random.Generator,
    k1: float = 0.0,
) -> NDArray[np.uint8]:
    """A rendered grey picture (h, w) as the camera takes it.

    Args:
        picture: rendered at the middle of the exposure.
        true: intrinsics that it was rendered with.
        motion: of the marker; all of the picture is moved as the marker's plane is.
        imaging: the imperfections.
        rng: of light and noise.
        k1: distortion of the lens that is not known.
    """
    cv2 = opencv()
    image = picture.astype(np.float32)
    if imaging.exposure_s > 0.0:
        image = _smeared(cv2, image, true, motion, imaging)
    if k1:
        image = _distorted(cv2, image, true, k1)
    blur = blur_px(imaging, true.fx, float(motion.position[2]))
    if blur > 0.0:
        image = cv2.GaussianBlur(image, (0, 0), blur)
    if imaging.gradient > 0.0 or imaging.dimmest < 1.0:
        image *= _light(image.shape, true, imaging, rng)
    spread = np.sqrt(imaging.read_noise**2 + np.maximum(image, 0.0) * (255.0 / imaging.full_well_e))
    image += spread * rng.standard_normal(image.shape, np.float32)
    return np.clip(np.rint(image), 0, 255).astype(np.uint8)


def blur_px(imaging: Imaging, focal_px: float, depth: float) -> float:
    """Standard deviation of the blur of lens and defocus at a depth in m, px."""
    disc = focal_px * imaging.focal_m / imaging.f_number * abs(1.0 / depth - 1.0 / imaging.focus_m)
    return float(np.hypot(imaging.lens_px, 0.25 * disc))


def smear_px(imaging: Imaging, true: Intrinsics, motion: Motion) -> float:
    """Path of the marker's centre in the picture during the exposure, px."""
    p, v = motion.position, motion.velocity
    path = true.fx * (v[:2] - v[2] * p[:2] / p[2]) / p[2]
    return float(imaging.exposure_s * np.hypot(*path))


def _smeared(cv2: Any, image: NDArray[Any], true: Intrinsics, motion: Motion, imaging: Imaging) -> NDArray[Any]:
    K = np.array([[true.fx, 0.0, true.cx], [0.0, true.fy, true.cy], [0.0, 0.0, 1.0]])
    height, width = image.shape
    total = np.zeros_like(image)
    start = K @ _plane(motion, 0.0)
    for t in (np.arange(imaging.substeps) + 0.5) / imaging.substeps - 0.5:
        H = K @ _plane(motion, t * imaging.exposure_s) @ np.linalg.inv(start)
        total += cv2.warpPerspective(image, H, (width, height), flags=cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(total / np.float32(imaging.substeps))


def _plane(motion: Motion, t: float) -> Array:
    R = matrix(from_rotation_vector(motion.omega * t)) @ matrix(motion.quat)
    return np.column_stack([R[:, 0], R[:, 1], motion.position + t * motion.velocity])


def _distorted(cv2: Any, image: NDArray[Any], true: Intrinsics, k1: float) -> NDArray[Any]:
    height, width = image.shape
    x = ((np.arange(width) - true.cx) / true.fx).astype(np.float32)
    y = ((np.arange(height) - true.cy) / true.fy).astype(np.float32)[:, None]
    # Where the light of a distorted pixel would have come without distortion; k₁ is so small that one step inverts it.
    bent = 1.0 - np.float32(k1) * (x * x + y * y)
    u, v = true.fx * x * bent + true.cx, true.fy * y * bent + true.cy
    return np.asarray(
        cv2.remap(image, u.astype(np.float32), v.astype(np.float32), cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    )


def _light(shape: tuple[int, ...], true: Intrinsics, imaging: Imaging, rng: np.random.Generator) -> NDArray[Any]:
    x = (np.arange(shape[1]) - true.cx) / true.fx
    y = ((np.arange(shape[0]) - true.cy) / true.fy)[:, None]
    azimuth, size = rng.uniform(0.0, 2.0 * np.pi), imaging.gradient * rng.uniform()
    exposure = rng.uniform(imaging.dimmest, 1.0)
    slope = size * (np.cos(azimuth) * x / abs(x[0]) + np.sin(azimuth) * y / abs(y[0, 0]))
    return np.asarray(exposure * (1.0 + slope) / (1.0 + x * x + y * y) ** 2, np.float32)
