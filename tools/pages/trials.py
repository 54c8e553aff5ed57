"""How every cell of the supervisor's fault table is provoked in the plant, and what has to come of it.

Each fault has one physical failure of fixed size that provokes it; the cells differ in the phase in which it begins. Only where
that failure shows nothing (a magnet that is off cannot fail) does a cell have its own.
"""

from typing import Any, NamedTuple

from armland.experiments.operator.provoked import JERK, KNOCK, PROVOKED, SHOVE, WEDGE, Failure
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
    states: tuple[str, ...] | None = None
    onwards: str | None = None


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
    # Once it has seen something; a camera that is dead from the start is among the extras.
    ("landing", "camera_stale", "ground"): Cell(after_s=0.6),
    ("takeoff", "camera_stale", "ground"): Cell(after_s=0.6),
    # On the cradle and in the arm's hands nobody needs the camera before the take-off's release.
    ("landing", "camera_stale", "held"): COPES,
    ("landing", "camera_stale", "cradle"): COPES,
    ("takeoff", "camera_stale", "held"): Cell(end="holding", found="none"),
    # While the magnet closes, forces come and go: pull test and gap decide, and the next free phase finds the drift.
    ("landing", "wrench_drift", "touch"): Cell(end="abort"),
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
    # On the way down nothing is expected of the hinge, and beyond it the UAV flies.
    ("takeoff", "wrench_drift", "flight"): Cell(end="done", found="overload", onwards="abort"),
    ("takeoff", "wrench_drift", "touch"): Cell(end="done", found="overload", onwards="abort"),
    # Where the UAV stands or hangs nobody asks its rotors, and the arm has it.
    ("landing", "power_lost", "cradle"): Cell(end="secured", found="uav_silent"),
    ("takeoff", "power_lost", "ground"): Cell(end="refused", found="uav_silent"),
    ("takeoff", "power_lost", "grip"): Cell(end="secured", found="uav_silent"),
    # Once it has seen the right one.
    ("landing", "camera_leap", "ground"): Cell(after_s=0.75),
    ("landing", "camera_leap", "touch"): Cell(end="abort", found="none"),
    ("takeoff", "camera_leap", "ground"): Cell(after_s=0.6, found="camera_stale"),
    ("takeoff", "camera_leap", "grip"): Cell(found="camera_stale"),
    ("takeoff", "camera_leap", "held"): Cell(end="holding", found="none"),
    ("takeoff", "camera_leap", "touch"): COPES,
    ("takeoff", "camera_leap", "flight"): COPES,
    # It is learnt from some twenty images, when the self-test may be over.
    ("landing", "camera_noise", "ground"): Cell(end="abort"),
    ("takeoff", "camera_noise", "grip"): Cell(end="abort"),
    ("takeoff", "camera_noise", "held"): Cell(end="abort"),
    ("landing", "link_late", "touch"): Cell(end="holding"),
    # A magnet that pulls too long shows when it should let go.
    ("landing", "magnet_stuck", "ground"): Cell(end="secured"),
    ("landing", "magnet_stuck", "flight"): Cell(end="secured"),
    ("landing", "magnet_stuck", "touch"): Cell(end="secured"),
    ("landing", "magnet_stuck", "held"): Cell(end="secured"),
    ("takeoff", "magnet_stuck", "ground"): Cell(end="holding"),
    ("takeoff", "magnet_stuck", "held"): Cell(end="holding"),
    ("takeoff", "magnet_stuck", "grip"): Cell(end="holding"),
    # While it carries, the arm bears it as it bears the load; it is found once the arm has let go.
    ("takeoff", "arm_blocked", "held"): Cell(end="braked_free", found="arm_blocked"),
    ("takeoff", "arm_blocked", "grip"): Cell(end="braked_free", found="arm_blocked"),
    # On the rotors' way up it shows when the hinge does not come free of force.
    ("landing", "thrust_lost", "held"): COPES,
    ("takeoff", "thrust_lost", "ground"): Cell(end="holding"),
    ("takeoff", "thrust_lost", "grip"): Cell(end="holding"),
    ("takeoff", "thrust_lost", "touch"): Cell(end="holding", found="thrust_short"),
    ("takeoff", "thrust_lost", "flight"): Cell(end="holding", found="thrust_short"),
    # What is left of its thrust is learnt on the magnet: in a hover it would need nearly all of it, and is not let go.
    ("landing", "thrust_short", "touch"): Cell(found="thrust_lost"),
    ("takeoff", "thrust_short", "ground"): Cell(end="holding", found="thrust_lost"),
    ("takeoff", "thrust_short", "held"): Cell(end="holding", found="thrust_lost"),
    ("takeoff", "thrust_short", "grip"): Cell(end="holding", found="thrust_lost"),
}

_FALLS = "a flying UAV of this weight that loses a rotor falls, docs/laws/balance.md; the arm can only make room"

OPEN: dict[tuple[str, str, str], str] = (
    dict.fromkeys(
        [(m, "rotor_lost", k) for m, k in (("landing", "ground"), ("landing", "flight"))]
        + [(m, "rotor_lost", k) for m, k in (("takeoff", "touch"), ("takeoff", "flight"))],
        _FALLS,
    )
    | dict.fromkeys(
        [("landing", "power_lost", k) for k in ("ground", "flight")]
        + [("takeoff", "power_lost", k) for k in ("touch", "flight")],
        "a flying UAV without power falls; the arm can only make room",
    )
    | dict.fromkeys(
        [("landing", f, k) for f in ("thrust_lost", "thrust_short") for k in ("ground", "flight")],
        "a flying UAV whose rotors give no more than its weight falls; the arm can only make room",
    )
)
"""Cells that have no trial here, and what they are about."""


OTHERWISE: dict[tuple[str, str, str], str] = {
    ("takeoff", "magnet_coil", "touch"): "the magnet is off by then: nothing can be seen of its coil",
    ("takeoff", "wrench_drift", "flight"): "nothing is expected of the hinge while the arm goes down",
    ("takeoff", "wrench_drift", "touch"): "nothing is expected of the hinge while the arm goes down",
    ("landing", "camera_leap", "touch"): "the plate is found beside the magnet, and the capture is missed",
    ("takeoff", "camera_leap", "ground"): "the other marker is beside the camera's view",
    ("takeoff", "camera_leap", "grip"): "the other marker is beside the camera's view",
    ("takeoff", "camera_leap", "touch"): "the UAV leaves the camera's view for longer than a leap lasts",
    ("takeoff", "camera_leap", "flight"): "the UAV leaves the camera's view for longer than a leap lasts",
    ("landing", "camera_noise", "ground"): "it is learnt from some twenty images, when the self-test is over",
    ("landing", "link_late", "touch"): "by then the arm holds the UAV",
    ("takeoff", "camera_noise", "grip"): "it is learnt from some twenty images, when the arm has let go already",
    ("landing", "magnet_stuck", "flight"): "it shows when the magnet is to let go, on the cradle",
    ("landing", "magnet_stuck", "touch"): "it shows when the magnet is to let go, on the cradle",
    ("takeoff", "magnet_stuck", "grip"): "it shows when the magnet is to let go, in the air",
    ("landing", "thrust_lost", "held"): "the arm carries it: its rotors give too little to fly, and need not",
    ("takeoff", "thrust_lost", "ground"): "it shows when the rotors are to carry the whole weight, in the air",
    ("takeoff", "thrust_lost", "grip"): "it shows when the rotors are to carry the whole weight, in the air",
    ("takeoff", "thrust_lost", "touch"): "it lies on the arm that draws back",
    ("takeoff", "thrust_lost", "flight"): "it lies on the arm that draws back",
    ("landing", "thrust_short", "touch"): "what is left is learnt on the magnet, before it is let go",
    ("takeoff", "thrust_short", "ground"): "what is left is felt on the magnet, before it is let go",
    ("takeoff", "thrust_short", "held"): "what is left is felt on the magnet, before it is let go",
    ("takeoff", "thrust_short", "grip"): "what is left is felt on the magnet, before it is let go",
}
"""Cells whose trial does not end as the table says or is not found by the fault's own sign, and why."""


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
    cell = CELLS.get((mission, fault, kind), COPES if FAULT_TABLE[fault][kind] == "-" else Cell())
    end, phase = cell.end or FAULT_TABLE[fault][kind], cell.phase or PHASES[mission][kind]
    failures = [cell.failure or PROVOKED[fault], *([cell.also] if cell.also else [])]
    faults = tuple(failure(phase, cell.after_s, **what) for what in failures)
    states = cell.states or states_of(mission, cell.onwards or end)
    return Trial(f"{mission} {fault} {kind}", mission, faults, end, cell.found or fault, states, cell.onwards)


def _extra(name: str, end: str, found: str, *faults: tuple[str, float, Failure], onwards: str | None = None) -> Trial:
    mission = name.partition(" ")[0]
    if onwards is not None and onwards not in ESCALATION[end].values():
        raise ValueError(f"{name}: {end} never leads on to {onwards}")
    made = tuple(failure(phase, after_s, **what) for phase, after_s, what in faults)
    return Trial(name, mission, made, end, found, states_of(mission, onwards or end), onwards)


def _f(phase: str, kind: str | Failure, after_s: float = AFTER_S, **more: Any) -> tuple[str, float, Failure]:
    return phase, after_s, {"kind": kind, **more} if isinstance(kind, str) else {**kind, **more}


_SLIP, _NAN, _LAME = PROVOKED["slip"], "non_finite", {"kind": "rotor_loss", "size": 0.3}
_GUST: Failure = {"size": 5.0, "lasts_s": 1.0, "direction": (1.0, 0.0, 0.0)}
_BLOW: Failure = {"size": 8.0, "lasts_s": 0.1, "direction": (1.0, 0.0, 0.0), "body": "uav"}

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
    _extra("landing falling drift", "let_fly", "slip", _f("set_down", "wrench_drift", size=-6.0)),
    _extra("landing deaf UAV", "let_fly", "slip", _f("set_down", "unreachable", size=0.0)),
    _extra("landing deaf UAV that climbs", "holding", "wrench_drift", _f("carry", "unreachable", size=0.5)),
    _extra("landing rotor at 70 %", "done", "none", _f("carry", _LAME)),
    _extra("takeoff rotor at 70 %", "holding", "none", _f("carry_up", _LAME)),
    _extra("landing dead magnet at the hand-over", "let_fly", "slip", _f("hand_over", _SLIP), _f("hand_over", SHOVE)),
    # What reads wrong.
    _extra("landing reversed wrench", "refused", "wrench_wrong", _f("self_test", "wrench_reversed")),
    _extra("landing wrench at half", "refused", "wrench_wrong", _f("self_test", "wrench_gain", size=0.5)),
    _extra("landing wrench at twice", "refused", "wrench_wrong", _f("self_test", "wrench_gain", size=2.0)),
    _extra("landing wrench at 110 %", "done", "none", _f("self_test", "wrench_gain", size=1.1)),
    _extra("landing drifting encoder", "secured", "wrench_drift", _f("carry", "encoder_drift", size=0.01, joint=2)),
    _extra("landing scattered images", "abort", "camera_noise", _f("guide", "camera_outliers", size=0.1)),
    _extra("landing other marker", "abort", "camera_leap", _f("approach", PROVOKED["camera_leap"])),
    _extra("landing flipped pose", "done", "none", _f("align", "camera_flip")),
    _extra("landing slower link", "abort", "link_late", _f("guide", "link_delay", size=20.0)),
    # In flight the bridge that breaks shows by the tool's weight.
    _extra("landing reversed wrench in flight", "abort", "wrench_wrong", _f("align", "wrench_reversed")),
    _extra("landing wrench at half in flight", "abort", "wrench_wrong", _f("approach", "wrench_gain", size=0.5)),
    _extra("landing camera at three times its noise", "done", "none", _f("align", "camera_noise", size=3.0)),
    _extra("landing wedged elbow", "braked_free", "arm_blocked", _f("guide", WEDGE)),
    _extra("landing wedged elbow, held", "braked_held", "near_limit", _f("carry", WEDGE)),
    # What makes a healthy UAV lean.
    _extra("landing gust, held", "done", "none", _f("carry", "gust", **_GUST)),
    _extra("landing gust", "done", "none", _f("guide", "gust", **_GUST)),
    _extra("landing blow on the held UAV", "done", "none", _f("carry", "push", **_BLOW)),
    # Less thrust.
    _extra("landing UAV at 85 %", "done", "none", _f("guide", "thrust_loss", size=0.15)),
    _extra("landing UAV at 85 %, approached", "done", "none", _f("approach", "thrust_loss", size=0.15)),
    _extra("landing UAV at 85 %, caught", "done", "none", _f("close", "thrust_loss", size=0.15)),
    _extra("landing UAV at half, held", "balancing", "rotor_lost", _f("carry", "thrust_loss", size=0.5)),
    _extra("takeoff UAV at 85 %", "done", "none", _f("clear", "thrust_loss", size=0.15)),
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
    _extra("takeoff camera after the end", "abort", "camera_stale", _f("done", PROVOKED["camera_stale"])),
    _extra("takeoff link after the end", "abort", "uav_silent", _f("done", "link_loss")),
    _extra("landing encoders after the end", "braked_down", "arm_stale", _f("done", "arm_stale")),
)
"""Trials beyond the cells: other devices and directions, a UAV that does not obey, several failures at once."""


def all_trials() -> list[Trial]:
    """All of them."""
    return [trial(*cell) for cell in cells() if cell not in OPEN] + list(EXTRAS)
