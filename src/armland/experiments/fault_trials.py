"""How every cell of the supervisor's fault table is provoked in the plant, and what has to come of it.

Each way is one physical failure of fixed size; the cells differ in the phase in which it begins, and only where the way of the
kind's first choice shows nothing (a magnet that is off cannot fail) does a cell have its own.
"""

from typing import Any, Literal, NamedTuple

from armland.mission.failures import Fault
from armland.mission.supervisor import ESCALATION, FAULT_TABLE, FAULTS, KINDS

Mission = Literal["landing", "takeoff"]

AFTER_S = 0.05
"""From the begin of the phase to the failure."""

PHASES: dict[Mission, dict[str, str]] = {
    "landing": {"ground": "self_test", "flight": "guide", "touch": "close", "held": "carry", "cradle": "unload"},
    "takeoff": {
        "ground": "self_test",
        "grip": "spin_up",
        "held": "carry_up",
        "touch": "release",
        "flight": "clear",
    },
}
"""Phase that stands for each kind."""

KNOCK: dict[str, Any] = {"kind": "push", "body": "tool", "size": 115.0, "direction": (0.0, 0.0, -1.0), "lasts_s": 0.05}
"""A blow on the tool, beyond the force sensor."""

JERK: dict[str, Any] = {"kind": "overload", "size": -125.0, "lasts_s": 0.02}
"""A UAV that stands is jerked upwards: on the cradle a blow downwards is the rails' to bear."""

SHOVE: dict[str, Any] = {"kind": "push", "body": "uav", "size": 1.5, "direction": (0.0, 1.0, 0.0)}
"""The UAV is pushed aside."""

WAYS: dict[str, dict[str, Any]] = {
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
    "near_limit": {"kind": "push", "body": "elbow", "size": 250.0, "direction": (0.0, 1.0, 0.0), "lasts_s": 0.15},
}
"""What fails, for each fault. The elbow is pushed: the tool may hardly move, the joints must."""

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
    mission: Mission
    faults: tuple[Fault, ...]
    end: str
    """Final phase; it may lead on by `supervisor.ESCALATION` only where `onwards` names where to."""
    found: str
    """Fault that the supervisor names; `none` where it does not matter or the procedure copes by itself."""
    states: tuple[str, ...]
    onwards: str | None = None


def failure(phase: str, after_s: float = AFTER_S, **way: Any) -> Fault:
    """A failure that begins `after_s` after the phase does."""
    return Fault(phase=phase, after_s=after_s, **way)


def states_of(mission: Mission, end: str) -> tuple[str, ...]:
    """Where the UAV may be."""
    if end in ("refused", "braked_refused"):
        return ("flying",) if mission == "landing" else ("standing",)
    return ("flying",) if (mission, end) == ("takeoff", "done") else STATES[end]


class Cell(NamedTuple):
    """Where a cell differs from the rule."""

    phase: str | None = None
    way: dict[str, Any] | None = None
    end: str | None = None
    found: str | None = None
    onwards: str | None = None
    after_s: float = AFTER_S
    also: dict[str, Any] | None = None


CELLS: dict[tuple[Mission, str, str], Cell] = {
    # On a magnet without pull the plate lies by its weight until something pushes it.
    ("landing", "slip", "held"): Cell(also=SHOVE),
    ("takeoff", "slip", "held"): Cell(also=SHOVE),
    # An attitude that leaps while it is held is not believed; a true tilt is a lost rotor long before.
    ("landing", "uav_tilt", "held"): Cell(end="holding", found="uav_silent"),
    ("takeoff", "uav_tilt", "held"): Cell(end="holding", found="uav_silent"),
    ("landing", "rotor_lost", "touch"): Cell(phase="capture"),
    ("landing", "rotor_lost", "cradle"): Cell(end="done", found="none"),
    ("takeoff", "rotor_lost", "ground"): Cell(end="balancing"),
    ("takeoff", "rotor_lost", "grip"): Cell(end="balancing"),
    ("landing", "overload", "cradle"): Cell(way=JERK),
    ("takeoff", "overload", "grip"): Cell(way=JERK),
    # Once it has seen something; a camera that is dead from the start is among the extras.
    ("landing", "camera_stale", "ground"): Cell(after_s=0.3),
    ("takeoff", "camera_stale", "ground"): Cell(after_s=0.3),
    # On the cradle and in the arm's hands nobody needs the camera before the take-off's release.
    ("landing", "camera_stale", "held"): Cell(end="done", found="none"),
    ("landing", "camera_stale", "cradle"): Cell(end="done", found="none"),
    ("takeoff", "camera_stale", "held"): Cell(end="holding", found="none"),
    # While the magnet closes, forces come and go: pull test and gap decide, and the next free phase finds the drift.
    ("landing", "wrench_drift", "touch"): Cell(end="abort"),
    ("takeoff", "wrench_drift", "touch"): Cell(end="abort"),
    # An arm that gives way hides a slow drift until it has given way as far as it may.
    ("takeoff", "wrench_drift", "grip"): Cell(phase="grip", way={"kind": "wrench_drift", "size": 20.0}),
    # A magnet that is off shows nothing; it is found as soon as it is needed.
    ("landing", "magnet_coil", "flight"): Cell(end="abort"),
    ("landing", "magnet_coil", "cradle"): Cell(end="done", found="none"),
    ("takeoff", "magnet_coil", "touch"): Cell(end="done", found="none"),
    ("takeoff", "magnet_coil", "flight"): Cell(end="done", found="none"),
    # Without pull the self-test fails, the capture is missed, and the cradle carries anyway.
    ("landing", "slip", "ground"): Cell(end="refused", found="none"),
    ("landing", "slip", "flight"): Cell(end="abort", found="none"),
    ("landing", "slip", "touch"): Cell(end="abort", found="none"),
    ("landing", "slip", "cradle"): Cell(end="done", found="none"),
    ("takeoff", "slip", "ground"): Cell(end="refused", found="none"),
    ("takeoff", "slip", "grip"): Cell(end="done", found="none"),
    ("takeoff", "slip", "touch"): Cell(end="done", found="none"),
    ("takeoff", "slip", "flight"): Cell(end="done", found="none"),
}

_FALLS = "a flying UAV of this weight that loses a rotor falls, docs/laws/balance.md; the arm can only make room"

OPEN: dict[tuple[Mission, str, str], str] = {
    ("landing", "rotor_lost", "ground"): _FALLS,
    ("landing", "rotor_lost", "flight"): _FALLS,
    ("takeoff", "rotor_lost", "touch"): _FALLS,
    ("takeoff", "rotor_lost", "flight"): _FALLS,
}
"""Cells that have no trial here, and what they are about."""


def cells() -> list[tuple[Mission, str, str]]:
    """Every cell of the fault table that a mission can reach: mission, fault, kind of phase."""
    missions: tuple[Mission, ...] = ("landing", "takeoff")
    return [(m, f, k) for m in missions for f in FAULTS[1:] for k in KINDS if k in PHASES[m]]


def trial(mission: Mission, fault: str, kind: str) -> Trial:
    """The trial of one cell."""
    cell = CELLS.get((mission, fault, kind), Cell())
    wanted = FAULT_TABLE[fault][kind]
    end = cell.end or wanted
    phase = cell.phase or PHASES[mission][kind]
    faults: tuple[Fault, ...] = (failure(phase, cell.after_s, **(cell.way or WAYS[fault])),)
    if cell.also is not None:
        faults = (*faults, failure(phase, cell.after_s, **cell.also))
    states = states_of(mission, cell.onwards or end)
    return Trial(f"{mission} {fault} {kind}", mission, faults, end, cell.found or fault, states, cell.onwards)


def _extra(name: str, mission: Mission, end: str, found: str, *faults: Fault, onwards: str | None = None) -> Trial:
    return Trial(f"{mission} {name}", mission, faults, end, found, states_of(mission, onwards or end), onwards)


def extras() -> list[Trial]:
    """Trials beyond the cells: other devices and directions, a UAV that does not obey, several failures at once."""
    f, push = failure, dict(KNOCK)
    lame: dict[str, Any] = {"kind": "rotor_loss", "size": 0.3}
    return [
        _extra("NaN encoders", "landing", "braked_held", "arm_stale", f("carry", kind="non_finite")),
        _extra("NaN attitude", "landing", "abort", "non_finite", f("guide", kind="non_finite", device="attitude")),
        _extra("NaN camera", "landing", "abort", "camera_stale", f("guide", kind="non_finite", device="camera")),
        _extra("NaN camera, held", "landing", "done", "none", f("carry", kind="non_finite", device="camera")),
        _extra(
            "leaping encoder",
            "landing",
            "braked_held",
            "arm_stale",
            f("carry", kind="encoder_offset", size=0.1, joint=2),
        ),
        _extra("blind camera", "landing", "refused", "none", f("self_test", kind="camera_lost")),
        _extra("blind camera", "takeoff", "refused", "none", f("self_test", kind="camera_lost")),
        _extra("frozen image", "landing", "abort", "camera_stale", f("align", kind="camera_frozen")),
        _extra("uplink", "landing", "abort", "uav_silent", f("capture", kind="uplink_loss")),
        _extra("uplink, held", "landing", "holding", "uav_silent", f("set_down", kind="uplink_loss")),
        _extra("uplink, cradle", "landing", "secured", "uav_silent", f("unload", kind="uplink_loss")),
        _extra("downlink", "takeoff", "holding", "uav_silent", f("hand_back", kind="downlink_loss")),
        _extra(
            "uplink at the release", "takeoff", "abort", "uav_silent", f("release", kind="uplink_loss", after_s=0.0)
        ),
        _extra("falling drift", "landing", "holding", "wrench_drift", f("set_down", kind="wrench_drift", size=-6.0)),
        _extra("deaf UAV", "landing", "holding", "wrench_drift", f("set_down", kind="unreachable", size=0.0)),
        _extra("deaf UAV that climbs", "landing", "holding", "wrench_drift", f("carry", kind="unreachable", size=0.5)),
        _extra("rotor at 70 %", "landing", "done", "none", f("carry", **lame)),
        _extra("rotor at 70 %", "takeoff", "balancing", "rotor_lost", f("carry_up", **lame)),
        _extra(
            "dead magnet at the hand-over",
            "landing",
            "let_fly",
            "slip",
            f("hand_over", **WAYS["slip"]),
            f("hand_over", **SHOVE),
        ),
        # Several at once.
        _extra(
            "camera and link",
            "landing",
            "abort",
            "uav_silent",
            f("guide", kind="camera_lost"),
            f("guide", 0.15, kind="link_loss"),
        ),
        _extra(
            "frozen wrench, then overload",
            "landing",
            "holding",
            "wrench_stale",
            f("carry", kind="wrench_frozen"),
            f("carry", 0.5, **push),
        ),
        _extra(
            "camera, then magnet",
            "landing",
            "let_fly",
            "slip",
            f("carry", kind="camera_lost"),
            f("carry", 0.5, **WAYS["slip"]),
            f("carry", 0.5, **SHOVE),
        ),
        _extra(
            "link, then magnet",
            "landing",
            "holding",
            "uav_silent",
            f("carry", kind="link_loss"),
            f("carry", 1.0, **WAYS["slip"]),
        ),
        # A graver one after the end.
        _extra(
            "link, then encoders",
            "landing",
            "holding",
            "arm_stale",
            f("carry", kind="link_loss"),
            f("carry", 1.0, kind="arm_stale"),
            onwards="braked_held",
        ),
        _extra(
            "magnet, then encoders",
            "landing",
            "let_fly",
            "arm_stale",
            f("carry", **WAYS["slip"]),
            f("carry", **SHOVE),
            f("carry", 2.0, kind="arm_stale"),
            onwards="braked_free",
        ),
        _extra("link after the end", "takeoff", "abort", "uav_silent", f("done", kind="link_loss")),
        _extra("encoders after the end", "landing", "braked_down", "arm_stale", f("done", kind="arm_stale")),
    ]


def allowed_ends(t: Trial) -> list[str]:
    """The ends that a trial passes through, in order."""
    assert t.onwards is None or t.onwards in ESCALATION[t.end].values(), t.name
    return [t.end] if t.onwards is None else [t.end, t.onwards]


def all_trials() -> list[Trial]:
    """All of them."""
    return [trial(*cell) for cell in cells() if cell not in OPEN] + extras()
