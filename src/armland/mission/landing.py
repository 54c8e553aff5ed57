"""The landing's controller: estimate -> mission -> reference -> law -> limits, one compiled call per tick."""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.mission.landing_arm import (
    BACK_OFF,
    BRAKE,
    JOIN,
    LAUNCH,
    LEAVE,
    TRACK,
    YIELD,
    arm_torque,
    begin_reference,
    held_force,
    refer,
    track,
)
from armland.mission.landing_arm import BALANCE as BALANCE_UAV
from armland.mission.landing_balance import begin_balance, refer_balance
from armland.mission.landing_estimate import estimate_arm, estimate_load, estimate_plate, look_at_grip, tilt_of
from armland.mission.landing_uav import AUTONOMOUS, BALANCE, CRUISE, HELD, LEVEL, STATION, command_uav, thrust_in_force
from armland.mission.phase_table import next_phase
from armland.mission.phases import MAGNET, SIGNAL, SIGNALS
from armland.mission.supervisor import find_fault, limit
from armland.records import Record
from armland.rotations import Array

MAGNET_ON, MAGNET_TEST = MAGNET.index("on"), MAGNET.index("test")
COUNT = len(SIGNALS)
(
    S_PROGRESS,
    S_ELAPSED,
    S_SEEN,
    S_UAV_ERROR,
    S_UAV_SPEED,
    S_OFFSET,
    S_RELATIVE,
    S_TILT,
    S_GAP,
    S_CONTACT,
    S_PULL,
    S_THRUST_LEFT,
    S_ARM_SHARE,
    S_GROUND_SHARE,
    S_FORCE,
    S_RETREAT,
    S_MAGNET_READY,
    S_MAGNET_FAULT,
    S_ARM_ERROR,
    S_RETRIES,
    S_BIAS,
    S_ROTORS,
) = (SIGNAL[name] for name in SIGNALS)

JOLT_MPS = 0.1
"""Speed of the end effector against its reference that no healthy flight makes once the UAV is held."""

COIL_S = 0.15
"""Time after which a magnet that was switched on must carry its current."""


@njit(cache=True)
def signals_of(
    phase: Record,
    progress: float,
    elapsed: float,
    contact: int,
    blocks: int,
    t: Record,
    p: Record,
    s: Record,
    out: Array,
) -> None:
    """Fill `out` (COUNT,) as `phases.SIGNALS` names it, from the messages of the tick before and today's estimate."""
    m, e, r = t.measurement, t.estimate, t.reference
    apart, speed, relative, arm, way, force = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        apart += (e.plate[i] - p.station[i]) ** 2
        speed += e.plate_v[i] ** 2
        relative += (e.plate_v[i] - e.v[i]) ** 2
        arm += (r.r[i] - e.r[i]) ** 2
        way += (e.r[i] - s.grip[i]) ** 2
        force += e.hinge_force[i] ** 2
    out[S_PROGRESS], out[S_ELAPSED], out[S_SEEN] = progress, elapsed, e.plate_valid
    out[S_UAV_ERROR], out[S_UAV_SPEED] = np.sqrt(apart), np.sqrt(speed)
    out[S_OFFSET] = np.sqrt((e.plate[0] - e.r[0]) ** 2 + (e.plate[1] - e.r[1]) ** 2)
    out[S_RELATIVE], out[S_TILT] = np.sqrt(relative), np.rad2deg(tilt_of(e.quat))
    out[S_GAP], out[S_CONTACT], out[S_PULL] = e.plate[2] - e.r[2], contact, -e.hinge_force[2]
    out[S_THRUST_LEFT] = abs(s.thrust - phase.share * s.hover)
    out[S_ARM_SHARE], out[S_GROUND_SHARE], out[S_FORCE] = e.arm_share, e.ground_share, np.sqrt(force)
    out[S_RETREAT], out[S_ARM_ERROR], out[S_RETRIES] = np.sqrt(way), np.sqrt(arm), s.retries
    out[S_MAGNET_READY] = 1.0 if m.magnet_force > p.magnet_share * p.rated else 0.0
    out[S_MAGNET_FAULT], out[S_BIAS], out[S_ROTORS] = m.magnet_fault, 1.0 if blocks >= 3 else 0.0, e.thrust


@njit(cache=True)
def enter(
    new: int,
    tick: int,
    magnet_was: int,
    miss: int,
    phases: NDArray[np.void],
    counts: NDArray[np.int64],
    t: Record,
    s: Record,
) -> None:
    """Begin phase `new`."""
    before, after = phases[s.phase].arm, phases[new].arm
    switched = phases[s.phase].held != phases[new].held
    begin_reference(after, before, switched, t.estimate, t.reference, s)
    if magnet_was and phases[new].magnet == 0:
        for i in range(3):
            s.grip[i] = t.estimate.r[i]
    if phases[new].held and not phases[s.phase].held:
        s.observing, s.caught = 0, tick
        for i in range(3):
            s.d[i] = s.force[i] = 0.0
    s.retries += 1 if new == miss else 0
    s.phase, s.begin = new, tick
    counts[:] = 0


@njit(cache=True)
def load_expected(phase: Record, elapsed: float, e: Record, p: Record, s: Record) -> float:
    """Vertical hinge force, N, that load and thrust explain, where they do; else NaN.

    None where the arm follows the plate from below, where it has had the time to learn the sensor's bias or to draw back, and
    where it has had the time to give way; what the rotors leave where the arm carries and the cradle cannot.
    """
    if phase.arm == TRACK:
        return 0.0
    if phase.arm == YIELD:
        return 0.0 if elapsed > 0.5 else np.nan
    if phase.free or phase.arm == BACK_OFF:
        return 0.0 if elapsed > 1.0 else np.nan
    if phase.uav == BALANCE:
        # What carries the weight is being found out: until then it is the thrust that was asked for.
        return float(p.weight - e.thrust)
    if phase.held and (phase.observe or e.r[2] > p.clear_z):
        return float(p.weight * (1.0 - e.thrust / max(s.hover, 1e-3)))
    return np.nan


@njit(cache=True)
def note_jolts(now: int, e: Record, r: Record, p: Record, s: Record) -> None:
    """Remember what makes a UAV lean that has lost no rotor: that the end effector was struck, and how hard it accelerates."""
    missed, asked = 0.0, 0.0
    for i in range(3):
        missed += (r.v[i] - e.v[i]) ** 2
        asked += r.a[i] ** 2
    s.tip = p.tip * np.sqrt(asked)
    if missed > JOLT_MPS**2:
        s.jolted = now


@njit(cache=True)
def known_push(arm: int, held: bool, r: Record, p: Record) -> Array:
    """Acceleration (3,) of the UAV, m/s², world, that neither its thrust nor its weight make: by the arm that gives it a speed, and
    by the drag at that speed."""
    out = np.zeros(3)
    if arm in (LAUNCH, LEAVE):
        for i in range(3):
            drag = p.drag / p.mass if i < 2 else 0.0
            out[i] = r.a[i] - drag * r.v[i] if held else -drag * p.launch[i]
    return out


@njit(cache=True)
def landing_tick(
    tick: NDArray[np.void],
    p_: NDArray[np.void],
    s_: NDArray[np.void],
    arm_: NDArray[np.void],
    bad: int,
    sample: NDArray[np.void],
    filter_p: NDArray[np.void],
    filter_s: NDArray[np.void],
    plate: NDArray[np.void],
    wrench_p: NDArray[np.void],
    wrench_s: NDArray[np.void],
    contact_p: NDArray[np.void],
    contact_s: NDArray[np.void],
    load: NDArray[np.void],
    phases: NDArray[np.void],
    guards: NDArray[np.void],
    conditions: NDArray[np.void],
    counts: NDArray[np.int64],
    signals: Array,
    rows: NDArray[np.int64],
    debounce: NDArray[np.int64],
    miss: int,
) -> None:
    """One tick. All records have shape (1,); the tables are those of `phases.compile_table` and `supervisor.fault_rows`.

    Args:
        tick: all messages, `landing_tick_layout`.
        p_: `landing_state.parameters_layout`.
        s_: `landing_state.memory_layout`.
        arm_: arm model's state at the measurement's joints.
        bad: numbers in the measurement that were not finite, and are replaced.
        sample: camera sample for the pose filter.
        filter_p: pose filter's parameters.
        filter_s: its memory.
        plate: its output.
        wrench_p: parameters of bias and tool removal.
        wrench_s: its memory.
        contact_p: parameters of contact detection.
        contact_s: its memory.
        load: its output.
        phases: table of phases.
        guards: table of guards.
        conditions: table of conditions.
        counts: ticks for which each guard has held.
        signals: (COUNT,), overwritten.
        rows: final phase of each fault in each phase.
        debounce: ticks for each fault.
        miss: index of the phase that counts as a retry; −1: none.
    """
    t, p, s, arm = tick[0], p_[0], s_[0], arm_[0]
    m, e, c = t.measurement, t.estimate, t.command
    now = m.tick
    row = phases[s.phase]
    held = row.held == 1
    s.held = 1 if held or (row.final == 1 and row.link == HELD) else 0
    # Estimate.
    e.thrust = thrust_in_force(now, p, s)
    estimate_arm(m, arm, e)
    # Where arm or cradle carry, they take what the rotors leave: nothing accelerates much.
    flies = row.uav == AUTONOMOUS or row.uav == STATION or row.uav == CRUISE
    flies = flies or (row.uav == LEVEL and row.magnet != MAGNET_ON)
    lift = e.thrust * p.weight / max(s.hover, 1e-3) if flies else p.weight
    push = known_push(row.arm, held, t.reference, p)
    estimate_plate(m, arm, p.camera.copy(), lift, push, sample, filter_p, filter_s, plate, e)
    s.seen = 1 if e.plate_valid else s.seen
    look_at_grip(m, p, filter_p[0].marker_offset, filter_p[0].marker_quat, s)
    way = signals[S_RETREAT]
    estimate_load(
        m,
        arm,
        t.reference.a.copy(),
        row.free == 1,
        c.magnet == MAGNET_ON,
        way,
        wrench_p,
        wrench_s,
        contact_p,
        contact_s,
        load,
        e,
    )
    known = now - m.wrench_tick <= p.wrench_age
    for i in range(3):
        e.disturbance[i] = s.d[i]
        # A force that is not known gives way to nothing.
        e.hinge_force[i] = e.hinge_force[i] if known else 0.0
    # Mission.
    elapsed = (now - s.begin) * p.tick_s
    signals_of(row, t.mission.progress, elapsed, load[0].contact, wrench_s[0].blocks, t, p, s, signals)
    magnet_on = (c.magnet == MAGNET_ON and elapsed > COIL_S) or row.magnet == MAGNET_TEST
    expected = load_expected(row, elapsed, e, p, s)
    note_jolts(now, e, t.reference, p, s)
    matters = rows[:, s.phase].copy()
    fault = find_fault(bad, magnet_on, expected, row.force, m, e, t.health, p, s, debounce, matters)
    new = rows[fault, s.phase] if fault else next_phase(s.phase, elapsed, signals, phases, guards, conditions, counts)
    if fault:
        s.fault = fault
    if new != s.phase:
        enter(new, now, c.magnet, miss, phases, counts, t, s)
        elapsed, row, held = 0.0, phases[new], phases[new].held == 1
        if row.arm == JOIN:
            track(e, p, s, True)
        elif row.arm == BALANCE_UAV:
            begin_balance(e, p, s)
    t.mission.tick, t.mission.phase, t.mission.retries, t.mission.fault = now, s.phase, s.retries, s.fault
    t.mission.elapsed = elapsed
    # Reference and laws.
    track(e, p, s, False)
    t.reference.tick = now
    t.mission.progress = refer(row.arm, elapsed, row.duration, s.phase, e, p, s, t.reference)
    if row.arm == BALANCE_UAV:
        refer_balance(elapsed, now - m.uav_tick, e, p, s, t.reference)
    for i in range(4):
        t.reference.quat[i] = s.q_d[i]
    c.magnet = row.magnet
    c.brake = 1 if row.arm == BRAKE else 0
    if held:
        held_force(e, t.reference, p, s, row.observe == 1)
    arm_torque(held, row.arm == BALANCE_UAV, m, e, t.reference, p, arm, s, c)
    if row.arm == BRAKE:
        # What the last good sample says that holds it, should a brake let go; no law runs on it.
        for i in range(m.q.shape[0]):
            c.tau[i] = arm.gravity[i]
    command_uav(now, row.uav, row.share, row.link, filter_s[0].align.quat.copy(), e, p, s, c)
    limit(bad, arm.gravity, m, e, p, s, c, t.health)
