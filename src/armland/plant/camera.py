"""Camera at the end effector that finds a fiducial marker under the UAV: a measurement model, compiled.

| symbol | name | unit, frame |
|---|---|---|
| camera frame c | origin in the optical centre, z along the view (the tool's z), x to the image's right | |
| marker frame m | origin in the marker's centre, z out of the printed face | |
| z | depth of the marker's centre along the optical axis | m |
| σ_xy² = a₀² + (a₁ z)² | `lateral` = (a₀, a₁) | m, 1 |
| σ_z² = b₀² + (b₁ z²)² | `depth` = (b₀, b₁) | m, 1/m |
| s | `marker_size` | m |
| b = b_s + b_z z | `shift` (3,), `slope` (3,): what mounting and calibration leave wrong, the same in every image | m, 1 |
| w | way of the marker's centre in the image while the shutter is open | px |

Image noise of fixed size is a lateral error that grows with z and a stereo depth error that grows with z²; the floors a₀, b₀
are what does not shrink with distance. Position is the mean of four corners with independent errors, so a corner errs by
2σ_xy and 2σ_z. Rotation is their least-squares fit, seen face on: the corners sit at ±s/2, which makes (2σ_z)/(2·s/2) of tilt,
and s/√2 from the centre, two error components each, which makes (2σ_xy)/(2·s/√2) of yaw:
σ_tilt = 2σ_z/s, σ_yaw = √2 σ_xy/s. The position's noise does not depend on s, the orientation's falls with it.

Source of the numbers: rc_visard manual, "Approximate pose precision for AprilTags" and "Maximum detection distance". It also
says that the size of a tag hardly matters for position and clearly for orientation. Of these and of what armland's own
detector makes on rendered images (`detector_errors`) the larger holds, for each of the four: up to 1.65 m always the published.
An image smeared by w is lost as often as there; a detector that reads to a smaller cell than the published distance
allows gets no credit for it.
"""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.errors import PlantError
from armland.plant.detector_errors import DETECTOR, DetectorErrors, claim, loss
from armland.records import Record
from armland.rotations import Array, conjugate, from_rotation_vector, matrix, multiply

NOISE_WIDTH = 8
"""Standard normal numbers that one tick takes: position 3, rotation 3, delay, drop-out."""

QUEUE = 16
"""Images that can be under way between capture and delivery."""

PARAMETERS = np.dtype(
    [
        ("base_hz", "i8"),
        ("rate_hz", "i8"),
        ("delay_min", "i8"),  # ticks
        ("delay_max", "i8"),  # ticks
        ("half_width", "f8"),  # tangent of half the field of view, image x
        ("half_height", "f8"),  # the same, image y
        ("marker_size", "f8"),  # m
        ("depth_min", "f8"),  # m
        ("depth_max", "f8"),  # m
        ("cos_incidence", "f8"),
        ("lateral", "f8", (2,)),
        ("depth", "f8", (2,)),
        ("detector", "f8", (4, 2)),  # lateral, depth, tilt, yaw: `PowerLaw`
        ("smeared", "f8", (3,)),
        ("smear_scale", "f8"),  # px per rad/s of the line of sight
        ("cell", "f8"),  # px·m: width of the marker's cells at a depth of 1 m
        ("shift", "f8", (3,)),  # m
        ("slope", "f8", (3,)),
        ("honesty", "f8"),  # real noise over claimed noise
        ("lose", "f8"),  # probability that a marker seen in the last image is not found in this one
        ("stay_lost", "f8"),  # probability that a marker not found in the last image is not found in this one
    ]
)

SAMPLE = np.dtype(
    [
        ("fresh", "i8"),  # 1 in the tick in which the sample arrives, else 0
        ("capture", "i8"),  # tick of the exposure
        ("position", "f8", (3,)),  # m, marker's centre in the camera frame
        ("quat", "f8", (4,)),  # camera<-marker, scalar first
        ("sigma", "f8", (6,)),  # claimed standard deviations in camera axes: position m, rotation rad
    ]
)

STATE = np.dtype(
    [
        ("queue", SAMPLE, (QUEUE,)),
        ("due", "i8", (QUEUE,)),  # tick of delivery
        ("first", "i8"),  # images delivered so far
        ("end", "i8"),  # images captured so far that showed a marker
        ("lost", "i8"),
        ("gaze", "f8", (2,)),  # x/z, y/z of the marker at the last exposure
        ("gazed", "i8"),  # tick after it, 0: none yet
        ("image", SAMPLE),  # what the last image with a marker showed
    ]
)


class Camera(NamedTuple):
    """The camera in a user's units."""

    rate_hz: int = 30
    delay_ms: tuple[float, float] = (50.0, 75.0)
    """From exposure to the sample's arrival, uniform; tum_ardrone's video delay is the upper end."""
    field_of_view_deg: tuple[float, float] = (60.0, 48.0)
    """Full angles in image x and y. Assumption: a common lens."""
    marker_size_m: float = 0.08
    """Edge of the black square."""
    depth_min_m: float = 0.05
    """Assumption: closest focus."""
    depth_max_per_size: float = 1.1 / 0.04
    """Largest depth over marker size (family 36h11): the number of pixels on the marker decides."""
    incidence_max_deg: float = 25.0
    """Largest angle between line of sight and marker normal: beyond, skids or hinge plate may hide a part (`plant.sight`)."""
    reference_m: tuple[float, float] = (0.3, 1.0)
    """Depths of the two published precisions."""
    lateral_m: tuple[float, float] = (0.4e-3, 0.7e-3)
    depth_m: tuple[float, float] = (0.9e-3, 3.3e-3)
    detector: DetectorErrors = DETECTOR
    """Least errors, where the published ones are smaller."""
    focal_px: float = 1078.0
    """960 pixels over 48 degrees."""
    exposure_s: float = 4.0e-3
    """Assumption, as `armland.view.marker_imaging.Imaging`."""
    shift_m: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """b_s, camera frame."""
    slope: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """b_z: direction in which it looks, rad, and focal length, as a share."""
    honesty: float = 1.0
    """Real noise over claimed noise."""
    lose: float = 0.02
    """Probability of a drop-out after a found marker. Assumption."""
    stay_lost: float = 0.5
    """Probability that a drop-out lasts another image. Assumption."""


def noise_through(reference: tuple[float, float], sigma: tuple[float, float], power: int) -> Array:
    """(c₀, c₁) of σ² = c₀² + (c₁ z^power)² through σ (2,) m at depths `reference` (2,) m.

    Raises:
        PlantError: no real c₀ and c₁: σ grows more than z^power does, or falls.
    """
    z = np.array(reference) ** power
    squares = np.linalg.solve(np.column_stack([np.ones(2), z * z]), np.square(sigma))
    if squares.min() < 0.0:
        largest = sigma[0] * z[1] / z[0]
        raise PlantError(f"camera noise {sigma[1]:g} m at {reference[1]:g} m must lie in [{sigma[0]:g}, {largest:g}] m")
    return np.sqrt(squares)


def camera_parameters(camera: Camera, base_hz: int) -> NDArray[np.void]:
    """`PARAMETERS` (1,) of a camera in a loop at `base_hz`.

    Raises:
        PlantError: a rate above the base rate, more images under way than the queue holds, noise that the law cannot fit.
    """
    if not 0 < camera.rate_hz <= base_hz:
        raise PlantError(f"camera: rate_hz = {camera.rate_hz} must lie in [1, {base_hz}], the loop's rate")
    low, high = (round(ms * base_hz / 1000.0) for ms in camera.delay_ms)
    if not 0 <= low <= high or high * camera.rate_hz >= (QUEUE - 1) * base_hz:
        longest = 1000.0 * (QUEUE - 1) / camera.rate_hz
        raise PlantError(f"camera: delay_ms = {camera.delay_ms} must rise, within 0 and {longest:g} ms")
    p: NDArray[np.void] = np.zeros(1, PARAMETERS)
    p["base_hz"], p["rate_hz"], p["delay_min"], p["delay_max"] = base_hz, camera.rate_hz, low, high
    p["half_width"], p["half_height"] = np.tan(0.5 * np.deg2rad(camera.field_of_view_deg))
    p["marker_size"], p["depth_min"] = camera.marker_size_m, camera.depth_min_m
    p["depth_max"] = camera.depth_max_per_size * camera.marker_size_m
    p["cos_incidence"] = np.cos(np.deg2rad(camera.incidence_max_deg))
    p["lateral"] = noise_through(camera.reference_m, camera.lateral_m, 1)
    p["depth"] = noise_through(camera.reference_m, camera.depth_m, 2)
    p["detector"], p["smeared"] = camera.detector[:4], camera.detector.smeared
    p["smear_scale"], p["cell"] = camera.focal_px * camera.exposure_s, camera.focal_px * camera.marker_size_m / 8.0
    p["shift"], p["slope"] = camera.shift_m, camera.slope
    p["honesty"], p["lose"], p["stay_lost"] = camera.honesty, camera.lose, camera.stay_lost
    return p


@njit(cache=True)
def observe(
    tick: int,
    camera_position: Array,
    camera_quat: Array,
    marker_position: Array,
    marker_quat: Array,
    noise: Array,
    frozen: bool,
    p_: NDArray[np.void],
    s_: NDArray[np.void],
    sample_: NDArray[np.void],
) -> None:
    """One tick of the camera: expose when it is time, deliver into `sample_` (1,) what is due; else `fresh` is 0.

    Args:
        tick: present tick; exposures are the ticks nearest after multiples of 1/rate, so that their mean rate is exact.
        camera_position: true optical centre (3,), m, world.
        camera_quat: true camera attitude (4,), world<-camera.
        marker_position: true centre of the marker (3,), m, world.
        marker_quat: true marker attitude (4,), world<-marker.
        noise: standard normal numbers (`NOISE_WIDTH`,).
        frozen: the fault: what the last image showed is delivered again and again, with stamps that look new.
        p_: `PARAMETERS` (1,).
        s_: `STATE` (1,), updated.
        sample_: `SAMPLE` (1,), written.
    """
    p, s, sample = p_[0], s_[0], sample_[0]
    if (tick * p.rate_hz) % p.base_hz < p.rate_hz:
        R_cw = matrix(camera_quat).T
        offset = R_cw @ (marker_position - camera_position)
        quat = multiply(conjugate(camera_quat), marker_quat)
        if frozen:
            found = s.end > 0
        else:
            lose = p.stay_lost if s.lost else p.lose
            kept = (1.0 - lose) * (1.0 - _smeared(tick, offset, p, s))
            s.lost = 1 if _uniform(noise[7]) < 1.0 - kept else 0
            found = not s.lost and visible(offset, matrix(quat), p)
            if found:
                _detect(offset, quat, noise, p, s.image)
        if found:
            _enqueue(tick, noise[6], p, s)
    sample.fresh = 0
    if s.first < s.end and s.due[s.first % QUEUE] <= tick:
        _copy(s.queue[s.first % QUEUE], sample)
        sample.fresh = 1
        s.first += 1


@njit(cache=True)
def visible(offset: Array, R_cm: Array, p: Record) -> bool:
    """Whether a marker at `offset` (3,) m with attitude R_cm (3, 3), camera<-marker, is in view whole and at a fair angle."""
    if not p.depth_min <= offset[2] <= p.depth_max:
        return False
    distance = np.sqrt(offset[0] ** 2 + offset[1] ** 2 + offset[2] ** 2)
    facing = -(R_cm[0, 2] * offset[0] + R_cm[1, 2] * offset[1] + R_cm[2, 2] * offset[2]) / distance
    if facing < p.cos_incidence:
        return False
    half = 0.5 * p.marker_size
    for i in range(4):
        a, b = half * (1.0 if i % 2 == 0 else -1.0), half * (1.0 if i < 2 else -1.0)
        x, y, z = (
            offset[0] + a * R_cm[0, 0] + b * R_cm[0, 1],
            offset[1] + a * R_cm[1, 0] + b * R_cm[1, 1],
            offset[2] + a * R_cm[2, 0] + b * R_cm[2, 1],
        )
        if z <= 0.0 or abs(x) > p.half_width * z or abs(y) > p.half_height * z:
            return False
    return True


@njit(cache=True)
def _smeared(tick: int, offset: Array, p: Record, s: Record) -> float:
    # The line of sight's rate from exposure to exposure stands for that while the shutter is open.
    if offset[2] <= 0.0:
        return 0.0
    x, y, before = offset[0] / offset[2], offset[1] / offset[2], s.gazed
    way = np.sqrt((x - s.gaze[0]) ** 2 + (y - s.gaze[1]) ** 2)
    s.gaze[0], s.gaze[1], s.gazed = x, y, tick + 1
    if before == 0:
        return 0.0
    return loss(p.smear_scale * way * p.base_hz / (tick + 1 - before), p.cell / offset[2], p.smeared)


@njit(cache=True)
def _detect(offset: Array, quat: Array, noise: Array, p: Record, image: Record) -> None:
    claim(offset[2], p, image.sigma)
    turn = np.empty(3)
    for i in range(3):
        bias = p.shift[i] + p.slope[i] * offset[2]
        image.position[i] = offset[i] + bias + p.honesty * image.sigma[i] * noise[i]
        turn[i] = p.honesty * image.sigma[3 + i] * noise[3 + i]
    noisy = multiply(from_rotation_vector(turn), quat)
    for i in range(4):
        image.quat[i] = noisy[i]


@njit(cache=True)
def _enqueue(tick: int, noise: float, p: Record, s: Record) -> None:
    due = tick + p.delay_min + int(_uniform(noise) * (p.delay_max - p.delay_min + 1))
    if s.end > s.first:
        # The detector works on one image after the other: no image overtakes another.
        due = max(due, s.due[(s.end - 1) % QUEUE] + 1)
    s.image.capture = tick
    _copy(s.image, s.queue[s.end % QUEUE])
    s.due[s.end % QUEUE] = due
    s.end += 1


@njit(cache=True)
def _copy(source: Record, target: Record) -> None:
    target.capture = source.capture
    for i in range(3):
        target.position[i] = source.position[i]
    for i in range(4):
        target.quat[i] = source.quat[i]
    for i in range(6):
        target.sigma[i] = source.sigma[i]


@njit(cache=True)
def _uniform(normal: float) -> float:
    # A standard normal number as one uniform in [0, 1): the streams are normal.
    return min(0.5 * math.erfc(-normal / math.sqrt(2.0)), 1.0 - 1e-12)
