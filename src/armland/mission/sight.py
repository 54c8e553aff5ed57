"""What camera and link say of the UAV: its plate and attitude, and where the plate is on the magnet; compiled.

| symbol | name | unit, frame |
|---|---|---|
| p, ṗ | `estimate.plate`, `.plate_v` (3,): the hinge's pivot on the UAV | m, m/s, D |
| q | `estimate.quat` (4,) | 1, D<-B |
| ρ_p, ρ_m | `told.lever`, `told.filter.marker_offset` (3,): pivot and marker from the centre of mass | m, body |
"""

import numpy as np
from numba import float64, njit, types

from armland.estimation.plate.late_fusion import RING as FILTER_RING
from armland.estimation.plate.layouts import kept_layout, plate_layout, told_layout
from armland.estimation.plate.pose_filter import fuse, predict
from armland.estimation.plate.reckoning import advance
from armland.linking import VECTOR, head, heads, linked, record
from armland.mission.reference.moves import LAUNCH, LEAVE
from armland.mission.table.phases import MAGNET, UAV
from armland.models.environment import apparent_gravity
from armland.records import Record
from armland.rotations import Array, conjugate, matrix, multiply, quaternion_of, turned

MAGNET_ON = MAGNET.index("on")
GRIP_GAIN = 0.4
"""Weight of the newest image in where the plate is on the magnet."""

SURE = 3.0
"""Standard deviations that noise does not explain."""

ONE_WAY = 0.8
"""Cosine of the angle between the offsets of two images above which they show one motion."""

AUTONOMOUS, STATION, LEVEL, CRUISE = (UAV.index(name) for name in ("autonomous", "station", "level", "cruise"))


@njit(cache=True)
def flies(row: Record) -> bool:
    """Whether a UAV is borne by its rotors alone in the phase `row`."""
    alone = row.uav == AUTONOMOUS or row.uav == STATION or row.uav == CRUISE
    return bool(alone or (row.uav == LEVEL and row.magnet != MAGNET_ON))


@njit(cache=True)
def lift_of(row: Record, act: Record, p: Record, e: Record) -> float:
    """Force along the UAV's z axis that lifts it, N: of the rotors where it flies, else the weight.

    Where arm or cradle carry, they take what the rotors leave: nothing accelerates much.
    """
    return float(e.thrust * p.weight / max(act.hover, 1e-3) if flies(row) else p.weight)


@njit(cache=True)
def known_push(arm: int, held: bool, refer: Record, p: Record) -> Array:
    """Acceleration (3,) of the UAV, m/s², deck, that neither thrust nor weight make: by the arm that gives it a speed, by the drag.

    Args:
        arm: index into `ARM`.
        held: whether the arm holds the UAV.
        refer: what the reference keeps: v, m/s, and a, m/s², of the tick before.
        p: what the estimate is told.
    """
    out = np.zeros(3)
    if arm in (LAUNCH, LEAVE):
        for i in range(3):
            drag = p.drag / p.mass if i < 2 else 0.0
            out[i] = refer.a[i] - drag * refer.v[i] if held else -drag * p.launch[i]
    return out


@njit(cache=True)
def take_attitude(m: Record, e: Record) -> None:
    """The attitude as received; the plate is where the end effector is, for the hinge binds them."""
    for i in range(3):
        e.plate[i], e.plate_v[i], e.omega[i] = e.r[i], e.v[i], m.uav_rate[i]
    for i in range(4):
        e.quat[i] = m.uav_quat[i]
    e.plate_valid = 1


@linked(
    lambda _: (
        *(*heads("measurement"), float64, VECTOR, types.UniTuple(float64, 3), VECTOR, VECTOR),
        *(record(told_layout()), record(kept_layout())),
    )
)
@njit(cache=True)
def follow(
    m: Record,
    lift: float,
    push: Array,
    gravity: tuple[float, float, float],
    eye: Array,
    view: Array,
    p: Record,
    s: Record,
) -> None:
    """One tick of the pose filter: reckon, and fuse an image that has arrived.

    Args:
        m: measurement, `linking.head`.
        lift: force along the body's z, N; this and what follows as for `reckoning.advance`.
        push: (3,), m/s², D.
        gravity: γ (3,), m/s², D.
        eye: (3,), m, D.
        view: quaternion (4,), D<-camera.
        p: of `layouts.told_layout`.
        s: of `layouts.kept_layout`, updated.
    """
    advance(m, lift, push, gravity, eye, view, p, s)
    if m.camera_fresh:
        fuse(m, p, s)


@linked(lambda _: (record(told_layout()), record(kept_layout()), record(plate_layout())))
@njit(cache=True)
def know(p: Record, s: Record, plate: Record) -> None:
    """Fill `plate`, of `layouts.plate_layout`, with what the pose filter knows of it now; `p` and `s` as for `follow`."""
    predict(0.0, p, s, plate)


@njit(cache=True)
def tell_plate(plate: Record, e: Record) -> None:
    """Put `plate`, of `layouts.plate_layout`, into the estimate `e`: plate and attitude of the UAV."""
    for i in range(3):
        e.plate[i], e.plate_v[i], e.plate_a[i] = plate.position[i], plate.velocity[i], plate.acceleration[i]
        e.omega[i] = plate.omega[i]
    for i in range(4):
        e.quat[i] = plate.quat[i]
    e.plate_valid, e.plate_age = plate.valid, plate.age


@njit(cache=True)
def estimate_plate(lift: float, push: Array, b: Record) -> None:
    """Pose filter on camera and link: plate, and the UAV's attitude on the deck.

    Args:
        lift: force that lifts the UAV along its z, N: rotors and, where it is held, the hinge.
        push: (3,), m/s², deck: what else is known to accelerate it.
        b: board; its estimate's plate and attitude are those of the tick before, and are written.
    """
    m, e, p, s = b.tick.measurement, b.tick.estimate, b.told.estimate, b.kept.estimate
    eye = turned(b.arm.rotation, p.camera)
    for i in range(3):
        eye[i] += b.arm.position[i]
    gravity = apparent_gravity(b.environment, e.plate, e.plate_v)
    if b.environment.moves and not flies(b.table.phases[b.kept.decide.phase]):
        # What arm or cradle carry goes along with the deck, whatever that does.
        lift, push = 0.0, push - np.array(gravity)
    follow(head(m), lift, push, gravity, eye, quaternion_of(b.arm.rotation), p.filter, s.filter)
    know(p.filter, s.filter, s.plate)
    tell_plate(s.plate, e)


@njit(cache=True)
def look_at_grip(m: Record, p: Record, s: Record) -> None:
    """Where the plate is on the magnet, from the newest image and the attitude at its exposure: no motion of the arm comes in.

    Pivot in the end effector's frame: camera + sample + R_eb (ρ_p − ρ_m), with R_eb by the fused attitude, since a marker's own tilt
    is what a camera sees worst. It is far off where it is beyond what the camera's noise explains.

    Args:
        m: measurement.
        p: what the estimate is told.
        s: what it keeps, written.
    """
    if not m.camera_fresh:
        return
    marker = p.filter
    seen = m.camera_capture % FILTER_RING
    body = multiply(s.filter.align.quat, s.filter.quat[seen])
    R_eb = matrix(multiply(conjugate(s.filter.camera_quat[seen]), body))
    apart, variance, newest, before, along = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        across = p.camera[i] + m.camera_position[i]
        for k in range(3):
            across += R_eb[i, k] * (p.lever[k] - marker.marker_offset[k])
        # Outliers scatter, a plate that has slid stays where it is.
        s.grip[i] += GRIP_GAIN * (across - s.grip[i])
        newest += across**2
        before += s.grip_newest[i] ** 2
        along += across * s.grip_newest[i]
        s.grip_newest[i] = across
        apart += s.grip[i] ** 2
        variance += s.filter.noise * m.camera_sigma[i] ** 2
    s.grip_offset, s.grip_tick = np.sqrt(apart), m.camera_capture
    far = p.slip + SURE * np.sqrt(variance)
    s.grip_far = s.grip_far + 1 if s.grip_offset > far else 0
    slides = newest > before and along > ONE_WAY * np.sqrt(newest * before)
    s.grip_slides = 0 if newest < far**2 else (s.grip_slides + 1 if slides else 1)
