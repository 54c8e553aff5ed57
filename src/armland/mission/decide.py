"""The stage that decides: signals of the tick, faults, the next phase, and what begins with a phase; compiled."""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.linking import linked, named
from armland.mission.reference.moves import BACK_OFF, TRACK, YIELD
from armland.mission.reference.refer import begin_reference
from armland.mission.supervisor.faults import find_fault, seen_layout, watch_layout
from armland.mission.table.arrays import GUARDS, next_phase, unmet
from armland.mission.table.phases import LINK, MAGNET, SIGNAL, SIGNALS, UAV
from armland.records import Record
from armland.rotations import Array, matrix

MAGNET_ON, MAGNET_TEST = MAGNET.index("on"), MAGNET.index("test")
BALANCE, HELD = UAV.index("balance"), LINK.index("held")
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
    S_LEAN,
    S_IMAGE_OFFSET,
    S_IMAGE_GAP,
    S_SPARE,
) = (SIGNAL[name] for name in SIGNALS)

COIL_S = 0.15
"""Time after which a magnet that was switched on must carry its current."""

SPARE_S = 0.5
"""Time constant of the thrust that is asked for, of which it is said what it leaves."""

LEAST_SPARE_N = 1e-3
"""Of a UAV that can hardly hover: what it has to spare is then none."""

BIAS_BLOCKS = 3
"""Blocks of readings after which the force-torque sensor's bias is known."""

FREED_S, YIELDED_S = 1.0, 0.5
"""Time that a phase has to learn the sensor's bias or to draw back, and to give way, before a force counts as unexplained."""


@lru_cache
def told_layout() -> np.dtype:
    """What deciding is told."""
    return np.dtype(
        [
            ("tick_s", "f8"),
            ("station", "f8", (3,)),  # m, pivot [D]
            ("weight", "f8"),  # N, of all that flies
            ("magnet_ready", "f8"),  # N, promised force from which the magnet counts as ready
            ("clear_z", "f8"),  # m, height of the end effector above which the cradle carries nothing
            ("watch", watch_layout()),
        ]
    )


@lru_cache
def kept_layout() -> np.dtype:
    """What deciding keeps from tick to tick."""
    return np.dtype(
        [
            ("phase", "i8"),
            ("begin", "i8"),  # tick at which the phase began
            ("retries", "i8"),
            ("fault", "i8"),
            ("unmet", "i8"),  # bits of `arrays.unmet` where the phase before ran out of time, else 0
            ("held", "i8"),  # 1 where the UAV hangs on the arm, also in an end
            ("grip", "f8", (3,)),  # m, end effector where the magnet was switched off last [D]
            ("retreat", "f8"),  # m, from there
            ("pushes", "f8"),  # N, thrust asked for, smoothed
            ("signals", "f8", (len(SIGNALS),)),
            ("held_for", "i8", (GUARDS,)),  # ticks for which each guard has held
            ("seen", seen_layout()),
        ]
    )


@linked(lambda n: (named("board", n),))
@njit(cache=True)
def decide(b: Record) -> None:
    """Fill the mission message of the tick, and begin what begins.

    Args:
        b: board, whose estimate is that of the tick; commands and reference are those of the tick before.
    """
    m, mission, p, s = b.tick.measurement, b.tick.mission, b.told.decide, b.kept.decide
    row, now = b.table.phases[s.phase], b.tick.measurement.tick
    elapsed = (now - s.begin) * p.tick_s
    fill_signals(elapsed, b)
    known = b.kept.estimate
    magnet_on = (b.kept.act.magnet == MAGNET_ON and elapsed > COIL_S) or row.magnet == MAGNET_TEST
    expected = load_expected(row, elapsed, b.tick.estimate, b.kept.act.hover, known.weight, known.felt, p)
    fault = find_fault(expected, magnet_on, s.phase, b)
    new = b.table.faults[fault, s.phase] if fault else next_phase(s.phase, elapsed, s, b.table)
    if fault:
        s.fault = fault
    if new != s.phase:
        late = not fault and new == row.on_timeout and elapsed > row.timeout
        s.unmet = unmet(s.phase, s, b.table) if late else 0
        enter(new, now, b)
        elapsed = 0.0
    row = b.table.phases[s.phase]
    s.held = 1 if row.held == 1 or (row.final == 1 and row.link == HELD) else 0
    mission.tick, mission.phase, mission.retries, mission.fault = m.tick, s.phase, s.retries, s.fault
    mission.elapsed, mission.unmet = elapsed, s.unmet


@njit(cache=True)
def fill_signals(elapsed: float, b: Record) -> None:
    """Fill `kept.decide.signals` as `phases.SIGNALS` names them.

    Args:
        elapsed: time in the phase, s.
        b: board.
    """
    m, e, p, s = b.tick.measurement, b.tick.estimate, b.told.decide, b.kept.decide
    ride = b.kept.act.ride
    refer, act, out = b.kept.refer, b.kept.act, b.kept.decide.signals
    apart, speed, relative, arm, retreat, force = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    station = b.kept.act.asked if b.told.act.uav.sight.leans else p.station
    for i in range(3):
        apart += (e.plate[i] - station[i] - ride.aside[i]) ** 2
        speed += (e.plate_v[i] - ride.aside_v[i]) ** 2
        relative += (e.plate_v[i] - e.v[i]) ** 2
        arm += (refer.r[i] - e.r[i]) ** 2
        retreat += (e.r[i] - s.grip[i]) ** 2
        force += b.kept.estimate.calm[i] ** 2
    s.retreat = np.sqrt(retreat)
    out[S_PROGRESS], out[S_ELAPSED], out[S_SEEN] = refer.progress, elapsed, e.plate_valid
    out[S_UAV_ERROR], out[S_UAV_SPEED] = np.sqrt(apart), np.sqrt(speed)
    out[S_OFFSET] = np.sqrt((e.plate[0] - e.r[0]) ** 2 + (e.plate[1] - e.r[1]) ** 2)
    up = 1.0 - 2.0 * (e.quat[1] ** 2 + e.quat[2] ** 2)
    out[S_RELATIVE], out[S_TILT] = np.sqrt(relative), np.rad2deg(np.arccos(min(max(up, -1.0), 1.0)))
    out[S_GAP], out[S_CONTACT] = e.plate[2] - e.r[2], b.kept.estimate.load.contact
    out[S_PULL] = -e.hinge_force[2]
    out[S_THRUST_LEFT] = abs(act.thrust - b.table.phases[s.phase].share * act.hover)
    out[S_ARM_SHARE], out[S_GROUND_SHARE], out[S_FORCE] = e.arm_share, e.ground_share, np.sqrt(force)
    out[S_RETREAT], out[S_ARM_ERROR], out[S_RETRIES] = s.retreat, np.sqrt(arm), s.retries
    out[S_MAGNET_READY] = 1.0 if m.magnet_force > p.magnet_ready else 0.0
    out[S_BIAS] = 1.0 if b.kept.estimate.wrench.blocks >= BIAS_BLOCKS else 0.0
    out[S_MAGNET_FAULT], out[S_ROTORS], out[S_LEAN] = m.magnet_fault, e.thrust, _lean(e.quat, act.q_d)
    shown = b.kept.estimate.grip
    out[S_IMAGE_OFFSET], out[S_IMAGE_GAP] = np.sqrt(shown[0] ** 2 + shown[1] ** 2), shown[2]
    s.pushes += p.tick_s / SPARE_S * (act.thrust - s.pushes)
    out[S_SPARE] = (p.watch.thrust_max - s.pushes) / max(p.watch.thrust_max - p.weight, LEAST_SPARE_N)


@njit(cache=True)
def _lean(quat: Array, asked: Array) -> float:
    # Angle between the z axes of two attitudes (4,), deg.
    apart = 0.0
    R, R_d = matrix(quat), matrix(asked)
    for i in range(3):
        apart += R[i, 2] * R_d[i, 2]
    return float(np.rad2deg(np.arccos(min(max(apart, -1.0), 1.0))))


@njit(cache=True)
def load_expected(row: Record, elapsed: float, e: Record, hover: float, weight: float, felt: float, p: Record) -> float:
    """Vertical hinge force, N, that load and thrust explain, where they do; else NaN.

    None where the arm follows the plate from below, where it has had the time to learn the sensor's bias or to draw back, and
    where it has had the time to give way; what the rotors leave where the arm carries and the cradle cannot.

    Args:
        row: phase.
        elapsed: time in it, s.
        e: estimate.
        hover: thrust command that carries the weight, N.
        weight: as the force-torque sensor finds it, N.
        felt: share of it that is felt on the deck, 1, of `load.heaviness`.
        p: what deciding is told.
    """
    if row.arm == TRACK:
        return 0.0
    if row.arm == YIELD:
        return 0.0 if elapsed > YIELDED_S else np.nan
    if row.free or row.arm == BACK_OFF:
        return 0.0 if elapsed > FREED_S else np.nan
    if row.uav == BALANCE:
        # What carries the weight is being found out: until then it is the thrust that was asked for.
        return float(weight * felt - e.thrust)
    if row.held and (row.observe or e.r[2] > p.clear_z):
        return float(weight * (felt - e.thrust / max(hover, 1e-3)))
    return np.nan


@njit(cache=True)
def enter(new: int, now: int, b: Record) -> None:
    """Begin phase `new` at tick `now` on the board `b`."""
    s, e, table = b.kept.decide, b.tick.estimate, b.table
    before, after = table.phases[s.phase], table.phases[new]
    begin_reference(s.phase, new, b)
    if b.kept.act.magnet and after.magnet == 0:
        for i in range(3):
            s.grip[i] = e.r[i]
    if after.held and not before.held:
        b.kept.estimate.observer.begun = 0
        for i in range(3):
            b.kept.estimate.observer.force[i] = b.kept.act.force[i] = 0.0
    if after.free and not before.free:
        # What the sensor's zero was before a contact says little after it: it is learnt anew.
        b.kept.estimate.wrench.blocks = 0
    s.retries += 1 if new == table.miss else 0
    s.phase, s.begin = new, now
    for i in range(GUARDS):
        s.held_for[i] = 0
