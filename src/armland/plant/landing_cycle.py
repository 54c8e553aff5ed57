"""One cycle of a landing's devices around the physics step, in two compiled calls: what is sampled before, what acts after."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.plant.camera import observe
from armland.plant.landing_devices import actuate, sense
from armland.plant.magnet import energise
from armland.records import Record
from armland.rotations import Array, matrix, multiply, turned

MARKER_DOWN = np.array([0.0, 1.0, 0.0, 0.0])
"""body<-marker: the printed face looks down."""

APPLIED, NOT_FINITE, BRAKE = 0, 1, 2
"""What `act` answers: done; command or state are not finite; done, and the brakes shall change over."""


@njit(cache=True)
def sample(
    tick: int,
    data: Array,
    adr: NDArray[np.void],
    p: NDArray[np.void],
    s: NDArray[np.void],
    noise: Array,
    eye: Array,
    camera_p: NDArray[np.void],
    camera_s: NDArray[np.void],
    image: NDArray[np.void],
    magnet: NDArray[np.void],
    measurement: NDArray[np.void],
    truth: NDArray[np.void],
) -> None:
    """Fill `measurement` and `truth` of one tick.

    Args:
        tick: present tick.
        data: MuJoCo's `sensordata`.
        adr: `landing_devices.ADDRESSES` (1,).
        p: `landing_devices.PARAMETERS` (1,).
        s: `landing_devices.STATE` (1,), updated.
        noise: standard normal numbers (2n + 15 + `camera.NOISE_WIDTH`,).
        eye: (2, 3), m: the camera's optical centre in the end effector's frame, the marker's centre in the body's.
        camera_p: `camera.PARAMETERS` (1,).
        camera_s: `camera.STATE` (1,), updated.
        image: `camera.SAMPLE` (1,), overwritten.
        magnet: `magnet.STATE` (1,).
        measurement: (1,), written.
        truth: (1,), written.
    """
    sense(tick, data, adr, p, s, noise, measurement, truth)
    m, t = measurement[0], truth[0]
    _look(tick, noise[2 * m.q.shape[0] + 15 :], eye, s[0], camera_p, camera_s, image, m, t)
    m.magnet_force, m.magnet_fault, t.touching = magnet[0].report, magnet[0].fault, magnet[0].touching


@njit(cache=True)
def _look(
    tick: int,
    noise: Array,
    eye: Array,
    s: Record,
    camera_p: NDArray[np.void],
    camera_s: NDArray[np.void],
    image_: NDArray[np.void],
    m: Record,
    t: Record,
) -> None:
    m.camera_fresh = 0
    exposes = (tick * camera_p[0].rate_hz) % camera_p[0].base_hz < camera_p[0].rate_hz
    if not exposes and camera_s[0].first == camera_s[0].end:
        return
    centre, mark, quat, seen = np.zeros(3), np.zeros(3), t.ee_quat.copy(), MARKER_DOWN.copy()
    if exposes:
        centre += t.ee + turned(matrix(quat), eye[0])
        mark += t.r_cm + turned(matrix(t.quat), eye[1])
        seen = multiply(t.quat, MARKER_DOWN)
    observe(tick, centre, quat, mark, seen, noise, s.camera_frozen == 1, camera_p, camera_s, image_)
    image = image_[0]
    if not image.fresh or s.camera_lost:
        return
    m.camera_fresh, m.camera_capture = 1, image.capture
    for i in range(3):
        m.camera_position[i] = image.position[i]
    for i in range(4):
        m.camera_quat[i] = image.quat[i]
    for i in range(6):
        m.camera_sigma[i] = image.sigma[i]


@njit(cache=True)
def act(
    tick: int,
    command: NDArray[np.void],
    truth: NDArray[np.void],
    braked: int,
    tau_max: Array,
    p: NDArray[np.void],
    s: NDArray[np.void],
    noise: Array,
    ctrl: Array,
    uav: int,
    geom_xpos: Array,
    geom_xmat: Array,
    xipos: Array,
    magnet_p: NDArray[np.void],
    magnet_s: NDArray[np.void],
    xfrc_applied: Array,
) -> int:
    """Turn a `command` into joint torques `ctrl` (n,) and wrenches `xfrc_applied` on the UAV, the plate and the tool.

    Args:
        tick: present tick.
        command: (1,).
        truth: (1,) of the tick.
        braked: 1 while the arm's brakes are on.
        tau_max: (n,), N·m.
        p: `landing_devices.PARAMETERS` (1,).
        s: `landing_devices.STATE` (1,), updated.
        noise: as for `sample`.
        ctrl: (n,), written.
        uav: the UAV's body.
        geom_xpos: MuJoCo's.
        geom_xmat: MuJoCo's.
        xipos: MuJoCo's.
        magnet_p: `magnet.PARAMETERS` (1,).
        magnet_s: `magnet.STATE` (1,), updated.
        xfrc_applied: MuJoCo's, written.

    Returns:
        `APPLIED`, `NOT_FINITE` or `BRAKE`.
    """
    n = ctrl.shape[0]
    if not actuate(tick, command, truth, tau_max, p, s, noise[2 * n + 12 : 2 * n + 15], ctrl, xfrc_applied[uav]):
        return NOT_FINITE
    energise(command[0].magnet, geom_xpos, geom_xmat, xipos, magnet_p, magnet_s, xfrc_applied)
    return APPLIED if command[0].brake == braked else BRAKE
