"""The signs of faults: which of them shows, and for how long it must; compiled.

| symbol | name | unit |
|---|---|---|
| F, F_z | `estimate.hinge_force`, what load and thrust explain of its vertical part | N, deck |
"""

from functools import lru_cache

import numpy as np
from numba import njit

from armland.mission.reference.guided import MOST_HOVER
from armland.mission.reference.moves import BACK_OFF, FLEE, MOVE, YIELD
from armland.mission.supervisor.reading import LEAPT_S, misreads
from armland.mission.supervisor.rising import DRIFTS_S, needed
from armland.mission.supervisor.table import FAULT, FAULTS
from armland.mission.supervisor.touch import touched
from armland.mission.table.arrays import FAULT_ROWS
from armland.mission.table.phases import LINK, UAV
from armland.models.environment import climb
from armland.records import Record
from armland.rotations import Array, multiply

COUNT = len(FAULTS)
AUTONOMOUS, STATION, RAMP, BALANCE = (UAV.index(name) for name in ("autonomous", "station", "ramp", "balance"))
CAUGHT = LINK.index("caught")
NON_FINITE, ARM_STALE, UAV_SILENT, LINK_LATE = (
    FAULT[name] for name in ("non_finite", "arm_stale", "uav_silent", "link_late")
)
CAMERA_STALE, WRENCH_STALE, WRENCH_DRIFT = FAULT["camera_stale"], FAULT["wrench_stale"], FAULT["wrench_drift"]
MAGNET_COIL, OVERLOAD, ROTOR_LOST = FAULT["magnet_coil"], FAULT["overload"], FAULT["rotor_lost"]
ENCODER_FROZEN, POWER_LOST, CAMERA_LEAP = FAULT["encoder_frozen"], FAULT["power_lost"], FAULT["camera_leap"]
CAMERA_NOISE, WRENCH_WRONG, MAGNET_STUCK = FAULT["camera_noise"], FAULT["wrench_wrong"], FAULT["magnet_stuck"]
ARM_BLOCKED, THRUST_LOST, THRUST_SHORT = FAULT["arm_blocked"], FAULT["thrust_lost"], FAULT["thrust_short"]
UAV_TILT, SLIP, NEAR_LIMIT, LAW_FAILED = FAULT["uav_tilt"], FAULT["slip"], FAULT["near_limit"], FAULT["law_failed"]

SEEN_S = 0.15
"""Age, since the exposure, up to which an image says where the plate is on the magnet: its delay and two images lost."""

THROWN_M = 0.05
"""How far above the magnet the plate of a UAV is seen that no longer stands on its cradle: a skid that slips off a rail sinks."""

LOAD_LEFT = 0.3
"""A load of which less than this share is felt is gone."""

WEIGHT_FELT = 0.85
"""Share of the weight at the hinge from which on the rotors carry nothing, where they should carry some."""

STRAINS, SINKS_MPS, PLUNGES_MPS, FALLS_MPS = 1.12, 0.15, 0.5, 0.6
"""Thrust over what should carry the weight; speed of sinking, with all the thrust, and with that much, of a UAV whose rotors give
too little; of one that is silent."""

ARRIVES_S = 0.06
"""Time since the newest sample of the UAV up to which its samples come, however old."""

SHORT, SHORT_S = 0.08, 0.05
"""Share of the weight by which a UAV that was let go and lies on the arm gives less than it was asked for; time constant of that."""

NOISY = 25.0
"""Variance of the camera over what it claims, beyond which it is not to be trusted: five times the standard deviation."""

WEIGHED_S, WEIGHED, NODDED = 0.45, (0.6, 1.5), (0.8, 1.2)
"""Time of the nod after which the tool has been weighed; force found over force expected of a sensor that can be used; share of the
nod that an arm makes which lets the sensor be judged."""

STUCK_M, STUCK_S = 0.002, 0.2
"""Way that the reference has drawn back from which on a plate that pulls sticks; time after which the current is gone."""

FOLLOWED_M, SANK_M, TOUCHES_M = 0.06, 0.1, 0.01
"""Way that the arm has drawn back, and distance of the plate, from which on a plate that is light enough to follow sticks; way after
which a UAV that still lies on the arm will not rise by itself."""

GUSTS_S = 20.0
"""How long, in wind, a UAV on the arm may need more thrust than it may hover with: that of four gusts of 44 m, at 9 m/s."""

BLOCKED_M = 0.03
"""Distance of an arm in free motion from its reference which no healthy flight makes."""


@lru_cache
def watch_layout() -> np.dtype:
    """What the search for faults is told."""
    return np.dtype(
        [
            ("tick_s", "f8"),
            ("uav_age", "i8"),  # ticks
            ("camera_age", "f8"),  # s
            ("search_age", "f8"),  # s, likewise where a UAV that is not seen is looked for
            ("arm_age", "i8"),  # ticks
            ("wrench_age", "i8"),  # ticks
            ("unexplained", "f8"),  # N, hinge force that load and thrust need not explain
            ("load_gone", "f8"),  # N, load of which less than `LOAD_LEFT` is felt where nothing is left of it
            ("load_missed", "f8"),  # N, least load that is missed
            ("stuck", "f8"),  # N, pull at which a plate sticks
            ("late", "f8"),  # s, delay of the link, both ways, beyond which the UAV cannot be guided
            ("uav_late", "f8"),  # s, delay of one way beyond which it cannot be held either
            ("hinge_max", "f8"),  # N
            ("tilt_max", "f8"),  # rad
            ("thrust_max", "f8"),  # N, largest thrust that is commanded
            ("sinks", "f8"),  # m/s, with all the thrust
            ("plunges", "f8"),  # m/s, at which a UAV sinks whose rotors give too little
            ("hover_max", "f8"),  # N, command beyond which a UAV cannot hover safely
            ("gust", "f8"),  # s, for which one that hangs on the arm may need more: gusts take it, and give it back
            ("joint_margin", "f8"),  # rad
            ("sigma_min", "f8"),
            ("speed_share", "f8"),
        ]
    )


@lru_cache
def seen_layout() -> np.dtype:
    """What the search for faults remembers."""
    return np.dtype(
        [
            ("counts", "i8", (FAULT_ROWS,)),  # ticks for which each fault's sign has been seen
            ("off", "i8"),  # tick at which the magnet was switched off last
            ("carried", "i8"),  # 1 where the UAV hung on the arm until then
            ("short", "f8"),  # N, vertical hinge force beyond what a UAV on the magnet makes with its thrust
            ("zero", "f8"),  # N, that until the magnet was switched off
            ("nothing", "i8"),  # ticks in a row in which the sensor has read nothing
            ("usual", "f8"),  # N, the vertical hinge force of late, where nothing touches the plate
            (
                "borne",
                "f8",
            ),  # N, of late, the vertical hinge force and what the rotors give at least, while the hinge is freed of force
            ("rises", "i8"),  # 1 where that rises
            (
                "lacks",
                "i8",
            ),  # ticks by which the UAV that the hinge is freed from has longer needed more than it may than not
            ("rising", "i8"),  # ticks by which it has risen longer than not
        ]
    )


@njit(cache=True)
def find_fault(expected: float, magnet_on: bool, phase: int, b: Record) -> int:
    """The gravest fault whose sign has been seen long enough and that matters in this phase; 0: none.

    Args:
        expected: vertical hinge force that load and thrust explain, N; NaN where nothing is known.
        magnet_on: whether the magnet has been on for longer than its current takes to rise.
        phase: index.
        b: board; measurement and estimate are those of the present tick.
    """
    m, e, s = b.tick.measurement, b.tick.estimate, b.kept.decide.seen
    signs = np.zeros(FAULT_ROWS, np.bool_)
    _device_signs(magnet_on, b.table.phases[phase].seeks == 1, m, e, b.told.decide.watch, b.kept.estimate, signs)
    row, act = b.table.phases[phase], b.kept.act
    caught = row.uav == RAMP and row.link == CAUGHT
    runs_away = caught and act.hover > 0.95 * MOST_HOVER * b.kept.estimate.weight
    runs_away = runs_away and abs(act.short) > b.told.act.uav.shortfall
    _load_signs(expected, runs_away, row.force, m, e, b.told.decide.watch, b.kept.estimate, signs)
    if row.final == 1 and row.arm == YIELD:
        # A plate that slides aside leaves its UAV standing; one that is seen above the cradle has been thrown off it.
        signs[SLIP] = act.thrust > 0.0 and b.kept.estimate.grip_far >= 3 and b.kept.estimate.grip[2] > THROWN_M
    _motion_signs(b.table.phases[phase], b, signs)
    misread = misreads(expected, b.table.phases[phase], b)
    signs[WRENCH_WRONG] = signs[WRENCH_WRONG] or misread
    felt = touched(phase, b)
    signs[ARM_BLOCKED] = signs[ARM_BLOCKED] or felt
    p, health = b.told.decide.watch, b.kept.limit
    near = health.joint_margin < p.joint_margin or b.kept.estimate.sigma < p.sigma_min
    signs[NEAR_LIMIT] = near or health.speed_ratio > p.speed_share
    signs[LAW_FAILED] = b.kept.act.law.failed != 0
    for f in range(1, COUNT):
        s.counts[f] = s.counts[f] + 1 if signs[f] else 0
        if b.table.faults[f, phase] >= 0 and s.counts[f] >= b.table.debounce[f]:
            return f
    return 0


@njit(cache=True)
def _device_signs(
    magnet_on: bool, seeks: bool, m: Record, e: Record, p: Record, known: Record, signs: np.ndarray
) -> None:
    signs[NON_FINITE] = known.bad > 0
    signs[ARM_STALE] = m.tick - m.arm_tick > p.arm_age
    # Both directions: what it says arrives, and it has heard what was said to it.
    signs[UAV_SILENT] = m.tick - min(m.uav_tick, m.uav_heard) > p.uav_age
    # Stamps tell a link that is slow from one that is dead: samples come, and say that commands came.
    comes = (m.tick - known.arrived) * p.tick_s < ARRIVES_S and m.uav_tick - m.uav_heard <= p.uav_age
    signs[LINK_LATE] = comes and (e.uplink + e.downlink > p.late or max(e.uplink, e.downlink) > p.uav_late)
    signs[UAV_SILENT] = signs[UAV_SILENT] and not signs[LINK_LATE]
    signs[CAMERA_STALE] = known.seen == 1 and e.plate_age > (p.search_age if seeks else p.camera_age)
    # One that falls is not where it was expected either, and is silent then.
    leapt = known.filter.leapt > 0 and (m.tick - known.filter.leapt) * p.tick_s < LEAPT_S
    signs[CAMERA_LEAP] = leapt and not signs[UAV_SILENT]
    signs[CAMERA_NOISE] = known.filter.noise > NOISY
    nod, wrong, nodded = known.nod, False, True
    for i in range(3):
        wrong = wrong or not WEIGHED[0] < nod.gain[i] < WEIGHED[1]
        nodded = nodded and NODDED[0] < nod.followed[i] < NODDED[1]
    if nod.count * p.tick_s > WEIGHED_S and wrong:
        # A tool that was not moved as it should weighs nothing: that is the arm's fault, and says nothing of the sensor.
        signs[WRENCH_WRONG if nodded else ARM_BLOCKED] = True
    for i in range(known.same.shape[0]):
        signs[ENCODER_FROZEN] = signs[ENCODER_FROZEN] or known.same[i] > 1
    signs[WRENCH_STALE] = m.tick - m.wrench_tick > p.wrench_age
    signs[MAGNET_COIL] = magnet_on and m.magnet_fault == 1


@njit(cache=True)
def _load_signs(
    expected: float,
    runs_away: bool,
    force_max: float,
    m: Record,
    e: Record,
    p: Record,
    known: Record,
    signs: np.ndarray,
) -> None:
    force = _force(e)
    missed = expected > p.load_missed and force < LOAD_LEFT * expected
    # Nor does a UAV that the magnet has caught ever come to rest for a sensor whose zero runs away.
    signs[WRENCH_DRIFT] = abs(known.calm[2] - expected) > p.unexplained or runs_away
    signs[OVERLOAD] = force > min(force_max, p.hinge_max)
    if signs[UAV_SILENT]:
        # It could not be given its thrust back: it is better off lying on the magnet.
        signs[SLIP] = False
    elif (m.tick - known.grip_tick) * p.tick_s < SEEN_S:
        # A single image errs by as much now and then, and stands for longer where the next one is lost: with it the load must go.
        signs[SLIP] = known.grip_far >= 3 or (missed and known.grip_far + known.grip_slides > 0)
    else:
        # Nobody sees it: what the arm should carry is not there, or it was seen to slide, left the view, and nothing is felt of it.
        signs[SLIP] = missed or (known.grip_slides > 1 and force < LOAD_LEFT * p.load_gone)


@njit(cache=True)
def _upright(held: bool, quat: Array, environment: Record) -> float:
    # Cosine of the UAV's tilt: of one that is held against the deck, of one that flies against the vertical.
    q = quat.copy()
    if not held and environment.moves:
        q = multiply(environment.base_quat.copy(), q)
    return float(1.0 - 2.0 * (q[1] ** 2 + q[2] ** 2))


@njit(cache=True)
def _motion_signs(row: Record, b: Record, signs: np.ndarray) -> None:
    m, e, p, known, kept = b.tick.measurement, b.tick.estimate, b.told.decide.watch, b.kept.estimate, b.kept
    held, seen, apart, drawn, gap = kept.decide.held == 1, kept.decide.seen, 0.0, 0.0, 0.0
    for i in range(3):
        gap += (e.plate[i] - e.r[i]) ** 2
        apart += (kept.refer.r[i] - e.r[i]) ** 2
        drawn += (kept.refer.r[i] - kept.decide.grip[i]) ** 2
    signs[UAV_TILT] = _upright(held, e.quat, b.environment) < np.cos(p.tilt_max)
    # It knows its motors' speeds. A lean alone does not say so: a gust, a blow and the rails make a healthy UAV lean.
    signs[ROTOR_LOST] = held and m.uav_weak == 1 and not signs[UAV_SILENT] and known.grip_far == 0 and not signs[SLIP]
    felt = e.hinge_force[2] > WEIGHT_FELT * known.weight and kept.act.thrust > 0.25 * known.weight
    rises = climb(b.environment, e.plate, e.plate_v)
    falls = not held and known.seen == 1 and e.plate_age < LEAPT_S and rises < -FALLS_MPS
    signs[POWER_LOST] = signs[UAV_SILENT] and (falls or (held and felt))
    strains = kept.act.thrust >= min(0.99 * p.thrust_max, STRAINS * kept.act.hover)
    # A loss that its rotors can make up for is learnt: the ground catches it sooner than the UAV's own hover.
    sinks = kept.act.thrust >= 0.99 * p.thrust_max and rises < -p.sinks
    known_speed = e.plate_valid == 1 and known.filter.scattered == 0
    sinks = row.uav == STATION and known_speed and (sinks or (strains and rises < -p.plunges))
    sinks = sinks or (row.uav == AUTONOMOUS and known_speed and rises < -p.plunges)
    # What is still being learnt says nothing: a sensor that drifts is never done.
    felt_short = row.uav == RAMP and row.link == CAUGHT and abs(kept.act.short) < b.told.act.uav.shortfall
    weighed = (row.uav == AUTONOMOUS and kept.act.trimmed > 0) or felt_short or row.uav == BALANCE
    short = needed(row.uav == BALANCE, known.weight, kept.act.hover, p.tick_s, e, seen) > p.hover_max and weighed
    seen.lacks = max(seen.lacks + (1 if short else -1), 0) if row.uav == BALANCE else 0
    short = short and (row.uav != BALANCE or seen.lacks * p.tick_s > p.gust)
    signs[THRUST_LOST] = sinks or (short and seen.rises == 0)
    signs[WRENCH_DRIFT] = signs[WRENCH_DRIFT] or (short and seen.rising * p.tick_s > DRIFTS_S)
    signs[ARM_BLOCKED] = signs[ARM_BLOCKED] or apart > BLOCKED_M**2
    if kept.act.magnet != 0:
        seen.off, seen.carried, seen.zero = m.tick, row.observe, seen.short
    # It moves with the arm: F = m a + W (1 − f_T/T_h), and more by what its rotors fail to give.
    made = b.told.estimate.mass * kept.refer.a[2] + known.weight * (known.felt - e.thrust / max(kept.act.hover, 1e-3))
    seen.short += p.tick_s / SHORT_S * (e.hinge_force[2] - made - seen.short)
    gone = (m.tick - seen.off) * p.tick_s > STUCK_S and seen.off > 0
    leaves = row.arm == BACK_OFF or row.arm == MOVE or row.arm == FLEE
    # What presses the arm down is a UAV that lies on it or hits it, however hard.
    pulls = drawn > STUCK_M**2 and _force(e) > p.stuck and e.hinge_force[2] <= 0.0
    # One that was not carried yet and lies on the arm may be too weak to rise.
    follows = seen.carried == 1 and kept.decide.retreat > FOLLOWED_M and e.plate_age < SEEN_S and gap < TOUCHES_M**2
    # A plate that sticks pulls with all the thrust beyond the weight.
    lies = seen.short - seen.zero > SHORT * known.weight
    signs[THRUST_SHORT] = gone and leaves and follows and lies and kept.decide.retreat > SANK_M
    # So does a plate that gives no way at all, before the arm has come far: it holds the arm back, and nothing pushes it.
    torn = signs[OVERLOAD] and e.hinge_force[2] < 0.0
    signs[MAGNET_STUCK] = gone and leaves and (pulls or torn or (follows and not lies))
    signs[OVERLOAD] = signs[OVERLOAD] and not signs[MAGNET_STUCK]


@njit(cache=True)
def _force(e: Record) -> float:
    return float(np.sqrt(e.hinge_force[0] ** 2 + e.hinge_force[1] ** 2 + e.hinge_force[2] ** 2))
