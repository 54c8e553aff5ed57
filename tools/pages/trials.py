"""How every cell of the supervisor's fault table is provoked in the plant, and what has to come of it.

Each fault has one physical failure of fixed size that provokes it; the cells differ in the phase in which it begins. Only where
that failure shows nothing (a magnet that is off cannot fail) does a cell have its own.
"""

from typing import Any, NamedTuple

from armland.mission.supervisor.table import ESCALATION, FAULT_TABLE
from armland.mission.table.phases import KINDS
from armland.scenario.faults import Fault

AFTER_S = 0.05
"""From the begin of the phase to the failure."""

PHASES: dict[str, dict[str, str]] = {
    "landing": {"ground": "self_test", "flight": "guide", "touch": "close", "held": "carry", "cradle": "unload"},
    "takeoff": {"ground": "self_test", "grip": "spin_up", "held": "carry_up", "touch": "release", "flight": "clear"},
}
"""Phase that stands for each kind, by mission."""

Failure = dict[str, Any]
"""Keys of `Fault` but for phase and time."""

KNOCK: Failure = {"kind": "push", "body": "tool", "size": 115.0, "direction": (0.0, 0.0, -1.0), "lasts_s": 0.05}
"""A blow on the tool, beyond the force sensor."""

JERK: Failure = {"kind": "overload", "size": -125.0, "lasts_s": 0.02}
"""A UAV that stands is jerked upwards: on the cradle a blow downwards is the rails' to bear."""

SHOVE: Failure = {"kind": "push", "body": "uav", "size": 1.5, "direction": (0.0, 1.0, 0.0)}
"""The UAV is pushed aside."""

PROVOKED: dict[str, Failure] = {
    "non_finite": {"kind": "non_finite", "device": "wrench"},
    "arm_stale": {"kind": "arm_stale"},
    "uav_silent": {"kind": "link_loss"},
    "camera_stale": {"kind": "camera_lost"},
    "wrench_stale": {"kind": "wrench_frozen"},
    "wrench_drift": {"kind": "wrench_drift", "size": 6.0},
    "magnet_coil": {"kind": "magnet_coil", "size": 0.5},
    "overload": KNOCK,
    "rotor_lost": {"kind": "rotor_loss", "size": 1.0},
    "uav_tilt": {"kind": "attitude_offset", "size": 0.8, "direction": (1.0, 0.0, 0.0)},
    "slip": {"kind": "magnet_slip", "size": 1.0},
    # The elbow is pushed: the tool may hardly move, the joints must.
    "near_limit": {"kind": "push", "body": "elbow", "size": 250.0, "direction": (0.0, 1.0, 0.0), "lasts_s": 0.15},
}
"""What fails in the plant, for each fault of the supervisor but the one that is the law's."""

STATES: dict[str, tuple[str, ...]] = {
    "done": ("standing",),
    "abort": ("flying",),
    "holding": ("held",),
    "balancing": ("held", "standing"),
    "let_fly": ("flying",),
    "secured": ("standing", "held"),
    "braked_free": ("flying", "held"),
    "braked_held": ("held",),
    "braked_down": ("standing", "held"),
}
"""Where the UAV may be in each end of a landing; on the cradle the arm may bear a part, after `braked_free` the UAV may still
hover on the magnet that has let go of it."""


class Trial(NamedTuple):
    """One flight with failures and what has to come of it."""

    name: str
    mission: str
    faults: tuple[Fault, ...]
    end: str
    """Final phase; it may lead on by `ESCALATION` only where `onwards` names where to."""
    found: str
    """Fault that the supervisor names; `none` where it does not matter or the procedure copes by itself."""
    states: tuple[str, ...]
    onwards: str | None = None

    @property
    def ends(self) -> list[str]:
        """The ends that it passes through, in order."""
        return [self.end] if self.onwards is None else [self.end, self.onwards]


class Cell(NamedTuple):
    """Where a cell differs from the rule."""

    phase: str | None = None
    failure: Failure | None = None
    end: str | None = None
    found: str | None = None
    after_s: float = AFTER_S
    also: Failure | None = None


COPES = Cell(end="done", found="none")
"""The failure changes nothing, or shows nothing."""

CELLS: dict[tuple[str, str, str], Cell] = {
    # On a magnet without pull the plate lies by its weight until something pushes it.
    ("landing", "slip", "held"): Cell(also=SHOVE),
    ("takeoff", "slip", "held"): Cell(also=SHOVE),
    # An attitude that leaps while it is held is not believed; a true tilt is a lost rotor long before.
    ("landing", "uav_tilt", "held"): Cell(end="holding", found="uav_silent"),
    ("takeoff", "uav_tilt", "held"): Cell(end="holding", found="uav_silent"),
    ("landing", "rotor_lost", "touch"): Cell(phase="capture"),
    ("landing", "rotor_lost", "cradle"): COPES,
    ("takeoff", "rotor_lost", "ground"): Cell(end="balancing"),
    ("takeoff", "rotor_lost", "grip"): Cell(end="balancing"),
    ("landing", "overload", "cradle"): Cell(failure=JERK),
    ("takeoff", "overload", "grip"): Cell(failure=JERK),
    # Once it has seen something; a camera that is dead from the start is among the extras.
    ("landing", "camera_stale", "ground"): Cell(after_s=0.6),
    ("takeoff", "camera_stale", "ground"): Cell(after_s=0.6),
    # On the cradle and in the arm's hands nobody needs the camera before the take-off's release.
    ("landing", "camera_stale", "held"): COPES,
    ("landing", "camera_stale", "cradle"): COPES,
    ("takeoff", "camera_stale", "held"): Cell(end="holding", found="none"),
    # While the magnet closes, forces come and go: pull test and gap decide, and the next free phase finds the drift.
    ("landing", "wrench_drift", "touch"): Cell(end="abort"),
    ("takeoff", "wrench_drift", "touch"): Cell(end="abort"),
    # An arm that gives way hides a slow drift until it has given way as far as it may.
    ("takeoff", "wrench_drift", "grip"): Cell(phase="grip", failure={"kind": "wrench_drift", "size": 20.0}),
    # A magnet that is off shows nothing; it is found as soon as it is needed.
    ("landing", "magnet_coil", "flight"): Cell(end="abort"),
    ("landing", "magnet_coil", "cradle"): COPES,
    ("takeoff", "magnet_coil", "touch"): COPES,
    ("takeoff", "magnet_coil", "flight"): COPES,
    # Without pull the self-test fails, the capture is missed, and the cradle carries anyway.
    ("landing", "slip", "ground"): Cell(end="refused", found="none"),
    ("landing", "slip", "flight"): Cell(end="abort", found="none"),
    ("landing", "slip", "touch"): Cell(end="abort", found="none"),
    ("landing", "slip", "cradle"): COPES,
    ("takeoff", "slip", "ground"): Cell(end="refused", found="none"),
    ("takeoff", "slip", "grip"): COPES,
    ("takeoff", "slip", "touch"): COPES,
    ("takeoff", "slip", "flight"): COPES,
}

_FALLS = "a flying UAV of this weight that loses a rotor falls, docs/laws/balance.md; the arm can only make room"

OPEN: dict[tuple[str, str, str], str] = dict.fromkeys(
    [(m, "rotor_lost", k) for m, k in (("landing", "ground"), ("landing", "flight"))]
    + [(m, "rotor_lost", k) for m, k in (("takeoff", "touch"), ("takeoff", "flight"))],
    _FALLS,
)
"""Cells that have no trial here, and what they are about."""


def failure(phase: str, after_s: float = AFTER_S, **what: Any) -> Fault:
    """A failure that begins `after_s` after the phase does."""
    return Fault(phase=phase, after_s=after_s, **what)


def states_of(mission: str, end: str) -> tuple[str, ...]:
    """Where the UAV may be."""
    if end in ("refused", "braked_refused"):
        return ("flying",) if mission == "landing" else ("standing",)
    return ("flying",) if (mission, end) == ("takeoff", "done") else STATES[end]


def cells() -> list[tuple[str, str, str]]:
    """Every cell of the fault table that a mission can reach and the plant can provoke: mission, fault, kind of phase."""
    return [(m, f, k) for m in PHASES for f in PROVOKED for k in KINDS if k in PHASES[m]]


def trial(mission: str, fault: str, kind: str) -> Trial:
    """The trial of one cell."""
    cell = CELLS.get((mission, fault, kind), Cell())
    end, phase = cell.end or FAULT_TABLE[fault][kind], cell.phase or PHASES[mission][kind]
    failures = [cell.failure or PROVOKED[fault], *([cell.also] if cell.also else [])]
    faults = tuple(failure(phase, cell.after_s, **what) for what in failures)
    return Trial(f"{mission} {fault} {kind}", mission, faults, end, cell.found or fault, states_of(mission, end))


def _extra(name: str, end: str, found: str, *faults: tuple[str, float, Failure], onwards: str | None = None) -> Trial:
    mission = name.partition(" ")[0]
    if onwards is not None and onwards not in ESCALATION[end].values():
        raise ValueError(f"{name}: {end} never leads on to {onwards}")
    made = tuple(failure(phase, after_s, **what) for phase, after_s, what in faults)
    return Trial(name, mission, made, end, found, states_of(mission, onwards or end), onwards)


def _f(phase: str, kind: str | Failure, after_s: float = AFTER_S, **more: Any) -> tuple[str, float, Failure]:
    return phase, after_s, {"kind": kind, **more} if isinstance(kind, str) else {**kind, **more}


_SLIP, _NAN, _LAME = PROVOKED["slip"], "non_finite", {"kind": "rotor_loss", "size": 0.3}

EXTRAS: tuple[Trial, ...] = (
    _extra("landing NaN encoders", "braked_held", "arm_stale", _f("carry", _NAN)),
    _extra("landing NaN attitude", "abort", "non_finite", _f("guide", _NAN, device="attitude")),
    _extra("landing NaN camera", "abort", "camera_stale", _f("guide", _NAN, device="camera")),
    _extra("landing NaN camera, held", "done", "none", _f("carry", _NAN, device="camera")),
    _extra("landing leaping encoder", "braked_held", "arm_stale", _f("carry", "encoder_offset", size=0.1, joint=2)),
    _extra("landing blind camera", "refused", "none", _f("self_test", "camera_lost")),
    _extra("takeoff blind camera", "refused", "none", _f("self_test", "camera_lost")),
    _extra("landing frozen image", "abort", "camera_stale", _f("align", "camera_frozen")),
    _extra("landing uplink", "abort", "uav_silent", _f("capture", "uplink_loss")),
    _extra("landing uplink, held", "holding", "uav_silent", _f("set_down", "uplink_loss")),
    _extra("landing uplink, cradle", "secured", "uav_silent", _f("unload", "uplink_loss")),
    _extra("takeoff downlink", "holding", "uav_silent", _f("hand_back", "downlink_loss")),
    _extra("takeoff uplink at the release", "abort", "uav_silent", _f("release", "uplink_loss", 0.0)),
    _extra("landing falling drift", "holding", "wrench_drift", _f("set_down", "wrench_drift", size=-6.0)),
    _extra("landing deaf UAV", "holding", "wrench_drift", _f("set_down", "unreachable", size=0.0)),
    _extra("landing deaf UAV that climbs", "holding", "wrench_drift", _f("carry", "unreachable", size=0.5)),
    _extra("landing rotor at 70 %", "done", "none", _f("carry", _LAME)),
    _extra("takeoff rotor at 70 %", "balancing", "rotor_lost", _f("carry_up", _LAME)),
    _extra("landing dead magnet at the hand-over", "let_fly", "slip", _f("hand_over", _SLIP), _f("hand_over", SHOVE)),
    # Several at once.
    _extra(
        "landing camera and link", "abort", "uav_silent", _f("guide", "camera_lost"), _f("guide", "link_loss", 0.15)
    ),
    _extra(
        "landing frozen wrench, then overload",
        "holding",
        "wrench_stale",
        _f("carry", "wrench_frozen"),
        _f("carry", KNOCK, 0.5),
    ),
    _extra(
        "landing camera, then magnet",
        "let_fly",
        "slip",
        _f("carry", "camera_lost"),
        _f("carry", _SLIP, 0.5),
        _f("carry", SHOVE, 0.5),
    ),
    _extra("landing link, then magnet", "holding", "uav_silent", _f("carry", "link_loss"), _f("carry", _SLIP, 1.0)),
    # A graver one after the end.
    _extra(
        "landing link, then encoders",
        "holding",
        "arm_stale",
        _f("carry", "link_loss"),
        _f("carry", "arm_stale", 1.0),
        onwards="braked_held",
    ),
    _extra(
        "landing magnet, then encoders",
        "let_fly",
        "arm_stale",
        _f("carry", _SLIP),
        _f("carry", SHOVE),
        _f("carry", "arm_stale", 2.0),
        onwards="braked_free",
    ),
    _extra("takeoff link after the end", "abort", "uav_silent", _f("done", "link_loss")),
    _extra("landing encoders after the end", "braked_down", "arm_stale", _f("done", "arm_stale")),
)
"""Trials beyond the cells: other devices and directions, a UAV that does not obey, several failures at once."""


def all_trials() -> list[Trial]:
    """All of them."""
    return [trial(*cell) for cell in cells() if cell not in OPEN] + list(EXTRAS)
