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
| w | path of the marker's centre in the image while the shutter is open | px |

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

import numpy as np
from numba import float64, int64, njit

from armland.linking import VECTOR, heads, linked, record
from armland.plant.devices.camera_numbers import ERRORS, QUEUE, kept_layout, told_layout
from armland.plant.devices.detector_errors import claim, loss, second_pose
from armland.plant.noise import uniform
from armland.plant.scene.eye import MARKER_DOWN
from armland.plant.sight import AZIMUTHS
from armland.records import Record
from armland.rotations import Array, conjugate, from_rotation_vector, matrix, multiply, turned, turned_back


@linked(
    lambda n: (
        *(int64, record(told_layout(n)), record(kept_layout(n)), record(ERRORS), VECTOR),
        *(*heads("measurement", "truth"), float64),
    )
)
@njit(cache=True)
def look(k: int, told: Record, kept: Record, errors: Record, noise: Array, m: Record, t: Record, chance: float) -> None:
    """One tick of the camera in the scene.

    Args:
        k: present tick.
        told: of `camera_numbers.told_layout`.
        kept: of `camera_numbers.kept_layout`, updated.
        errors: what fails, of `camera_numbers.ERRORS`.
        noise: standard normal numbers (12,), in the order of `noise.CAMERA_WIDTH`.
        m: measurement, `linking.head`; its fields of the camera are written.
        t: truth of the tick, `linking.head`.
        chance: a standard normal number, by which the second solution of a pose is taken or not.
    """
    m.camera_fresh = 0
    exposes = (k * told.rate_hz) % told.base_hz < told.rate_hz
    if not exposes and kept.first == kept.end:
        return
    if exposes:
        eye, mark = turned(matrix(t.ee_quat), told.eye), turned(matrix(t.quat), told.mark)
        for i in range(3):
            kept.eye[i], kept.mark[i] = t.ee[i] + eye[i], t.r_cm[i] + mark[i]
        kept.eye_quat, seen = t.ee_quat, multiply(t.quat, MARKER_DOWN)
        for i in range(4):
            kept.mark_quat[i] = seen[i]
    kept.chance = chance
    observe(k, noise, errors, told, kept)
    image = kept.sample
    if not image.fresh or errors.lost:
        return
    m.camera_fresh, m.camera_capture = 1, image.capture + told.stamp
    m.camera_position = image.position
    m.camera_quat = image.quat
    m.camera_sigma = image.sigma


@njit(cache=True)
def observe(k: int, noise: Array, errors: Record, told: Record, kept: Record) -> None:
    """Expose when it is time, deliver into `kept.sample` what is due; else its `fresh` is 0.

    Args:
        k: present tick; exposures are the ticks nearest after multiples of 1/rate, so that their mean rate is exact.
        noise: standard normal numbers (12,), in the order of `noise.CAMERA_WIDTH`.
        errors: what fails, of `camera_numbers.ERRORS`.
        told: of `camera_numbers.told_layout`.
        kept: of `camera_numbers.kept_layout`, updated; its `eye`, `eye_quat`, `mark`, `mark_quat` are the true poses now.
    """
    if (k * told.rate_hz) % told.base_hz < told.rate_hz:
        offset = np.empty(3)
        for i in range(3):
            offset[i] = kept.mark[i] - kept.eye[i]
        offset = turned_back(matrix(kept.eye_quat), offset)
        quat = multiply(conjugate(kept.eye_quat), kept.mark_quat)
        if errors.frozen:
            found = kept.end > 0
        else:
            lose = told.stay_lost if kept.lost else told.lose
            stays = (1.0 - lose) * (1.0 - _smeared(k, offset, told, kept))
            kept.lost = 1 if uniform(noise[7]) < 1.0 - stays else 0
            beside = turned_back(matrix(kept.eye_quat), errors.marker)
            for i in range(3):
                offset[i] += beside[i]
            found = not kept.lost and visible(offset, matrix(quat), told)
            if found:
                _detect(offset, quat, noise, errors, told, kept)
        if found:
            _enqueue(k, noise[6], told, kept)
    kept.sample.fresh = 0
    if kept.first < kept.end and kept.due[kept.first % QUEUE] <= k:
        _copy(kept.queue[kept.first % QUEUE], kept.sample)
        kept.sample.fresh = 1
        kept.first += 1


@njit(cache=True)
def visible(offset: Array, R_cm: Array, told: Record) -> bool:
    """Whether a marker is in view whole and at a fair angle.

    Args:
        offset: marker's centre (3,), m, camera frame.
        R_cm: its attitude (3, 3), a rotation camera<-marker.
        told: of `camera_numbers.told_layout`.
    """
    if not told.depth_min <= offset[2] <= told.depth_max:
        return False
    distance = np.sqrt(offset[0] ** 2 + offset[1] ** 2 + offset[2] ** 2)
    facing = -(R_cm[0, 2] * offset[0] + R_cm[1, 2] * offset[1] + R_cm[2, 2] * offset[2]) / distance
    if facing < told.cos_incidence or facing < _cos_clear(offset, R_cm, told):
        return False
    half = 0.5 * told.marker_size
    for i in range(4):
        a, b = half * (1.0 if i % 2 == 0 else -1.0), half * (1.0 if i < 2 else -1.0)
        x, y, z = (
            offset[0] + a * R_cm[0, 0] + b * R_cm[0, 1],
            offset[1] + a * R_cm[1, 0] + b * R_cm[1, 1],
            offset[2] + a * R_cm[2, 0] + b * R_cm[2, 1],
        )
        if z <= 0.0 or abs(x) > told.half_width * z or abs(y) > told.half_height * z:
            return False
    return True


@njit(cache=True)
def _cos_clear(offset: Array, R_cm: Array, told: Record) -> float:
    # Of the directions to both sides the one in which less is seen.
    x = -(R_cm[0, 0] * offset[0] + R_cm[1, 0] * offset[1] + R_cm[2, 0] * offset[2])
    y = -(R_cm[0, 1] * offset[0] + R_cm[1, 1] * offset[1] + R_cm[2, 1] * offset[2])
    at = int(np.floor(np.arctan2(y, x) / (2.0 * np.pi) * AZIMUTHS))
    return float(max(told.cos_clear[at % AZIMUTHS], told.cos_clear[(at + 1) % AZIMUTHS]))


@njit(cache=True)
def _smeared(k: int, offset: Array, told: Record, kept: Record) -> float:
    # The line of sight's rate from exposure to exposure stands for that while the shutter is open.
    if offset[2] <= 0.0:
        return 0.0
    x, y, before = offset[0] / offset[2], offset[1] / offset[2], kept.gazed
    path = np.sqrt((x - kept.gaze[0]) ** 2 + (y - kept.gaze[1]) ** 2)
    kept.gaze[0], kept.gaze[1], kept.gazed = x, y, k + 1
    if before == 0:
        return 0.0
    return loss(told.smear_scale * path * told.base_hz / (k + 1 - before), told.cell / offset[2], told.smeared)


@njit(cache=True)
def _detect(offset: Array, quat: Array, noise: Array, errors: Record, told: Record, kept: Record) -> None:
    image = kept.image
    claim(offset[2], told, image.sigma)
    stray = told.outlier_m if told.outlier > 0.0 and uniform(noise[8]) < told.outlier else 0.0
    stray = max(stray, errors.outlier)
    honesty = told.honesty * errors.noise
    flips = errors.flipped or (told.flip > 0.0 and uniform(kept.chance) < told.flip)
    seen = second_pose(offset, quat) if flips else quat
    turn = np.empty(3)
    for i in range(3):
        bias = told.shift[i] + told.slope[i] * offset[2]
        image.position[i] = offset[i] + bias + honesty * image.sigma[i] * noise[i] + stray * noise[9 + i]
        turn[i] = honesty * image.sigma[3 + i] * noise[3 + i]
    noisy = multiply(from_rotation_vector(turn), seen)
    if told.askew:
        beside = turned(matrix(told.turn), image.position)
        noisy = multiply(told.turn, noisy)
        for i in range(3):
            image.position[i] = beside[i]
    for i in range(4):
        image.quat[i] = noisy[i]


@njit(cache=True)
def _enqueue(k: int, noise: float, told: Record, kept: Record) -> None:
    due = k + told.delay_min + int(uniform(noise) * (told.delay_max - told.delay_min + 1))
    if kept.end > kept.first:
        # The detector works on one image after the other: no image overtakes another.
        due = max(due, kept.due[(kept.end - 1) % QUEUE] + 1)
    kept.image.capture = k
    _copy(kept.image, kept.queue[kept.end % QUEUE])
    kept.due[kept.end % QUEUE] = due
    kept.end += 1


@njit(cache=True)
def _copy(source: Record, target: Record) -> None:
    target.capture = source.capture
    target.position = source.position
    target.quat = source.quat
    target.sigma = source.sigma
