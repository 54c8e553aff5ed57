"""The landing: the UAV comes to its station, the arm catches it, carries it to the cradle, puts it down and lets go."""

from typing import Any

from armland.mission.missions.keys import GEAR, ON_MAGNET, SHARED
from armland.mission.reference.guided import ALONE_S
from armland.mission.supervisor.ends import FINALS
from armland.mission.table.mission import At, Criterion, Mission
from armland.mission.table.phases import Phase
from armland.scenario import Scenario

LOOKS_S = 60.0
"""Longest wait in wind for a UAV that is out of view."""

FLEES_S, WAITS_S, CLOSES_S = 0.6, 1.0, 0.6
"""In wind and above a deck: in which the arm draws away from a plate that it has missed, goes back to where it waits, and closes; or as
fast as it can. What is near for less time meets fewer gusts."""

BLIND_S = 0.1
"""Time without an image after which the arm draws away then."""

PULLS_S = 5.0
"""Longest wait for the pull test of a UAV that the magnet has gripped."""

JOINS_S, JOINED_M = 6.0, 0.03
"""Longest wait below a UAV that comes down to the arm, and gap beyond the one that the arm keeps at which it has come."""

TOUCHED_M = 0.007
"""Gap, as reckoned, up to which a force that is felt while the arm follows a UAV in gusts is that of a contact."""

RUSHES_MPS, DROPS_MPS, RUSHES_S = 0.7, 0.35, 0.02
"""Speed of the plate against the arm that comes to it, and against one that is right below it, at which the arm draws away; joining a
UAV that comes down takes 0.5 m/s."""

TRIMMED_S = 0.05
"""For which a UAV that hovers by itself is listened to, at least."""

READY = "magnet_ready > half, bias_known > half, uav_seen > half, progress > almost_one"
"""What a self-test waits for."""

TESTED: dict[str, Any] = {
    "kind": "ground",
    "arm": "nod",
    "magnet": "test",
    "free": True,
    "duration_s": 0.5,
    "on_timeout": "refused",
}
"""The magnet is switched on and off; the arm nods, so that the force-torque sensor weighs the tool."""

ARRIVED = "progress > almost_one, arm_error < arm_error_m"

TOUCHING: dict[str, Any] = {"kind": "touch", "load": "impact", "magnet": "on", "timeout_s": 1.5, "on_timeout": "miss"}
"""The magnet works on the plate."""

HELD: dict[str, Any] = {"kind": "held", "magnet": "on", "held": True, "link": "held", "on_timeout": "holding"}
"""The UAV hangs on the arm."""

CARRIED: dict[str, Any] = {**HELD, "uav": "ramp", "share": "carry"}
"""So it does, and its rotors carry their share."""

RESTING: dict[str, Any] = {"kind": "cradle", "arm": "yield", "on_cradle": True, "on_timeout": "secured"}
"""The UAV stands on the cradle, the arm gives way."""

PHASES = (
    Phase("self_test", **TESTED, uav="autonomous").to("guide", READY, 0.2),
    Phase("guide", arm="hold", uav="station", free=True, seeks=True, timeout_s=20.0).to(
        "approach", "uav_error < uav_error_m, uav_speed < uav_speed_mps, uav_seen > half", 0.2
    ),
    Phase("approach", arm="join", uav="station", free=True, duration_s=1.5, timeout_s=4.0, on_timeout="miss")
    .to("align", "progress > almost_one, uav_seen > half")
    .to("miss", "uav_seen < half", 0.5),
    Phase("align", arm="track", uav="station", timeout_s=8.0, on_timeout="miss")
    .to(
        "close",
        "offset < align_offset_m, relative_speed < align_speed_mps, tilt < align_tilt_deg, uav_seen > half",
        0.1,
    )
    .to("miss", "uav_seen < half", 0.5),
    Phase("close", **TOUCHING, arm="close", uav="station", duration_s=1.0)
    .to("capture", "contact > half")
    .to("miss", "offset > lost_offset_m", 0.02)
    .to("miss", "uav_seen < half", 0.2),
    # Until the arm carries, a UAV without link flies by itself.
    Phase("capture", **TOUCHING, arm="hold", uav="ramp", share="test", held=True, link="caught")
    # A UAV that falls onto the magnet is lower than is reckoned, and is reckoned to bounce: what is felt or seen says that it is there.
    .to("miss", "gap > let_go_m, image_gap > let_go_m, contact < half", 0.02)
    # A tilted UAV that the magnet holds goes nowhere, but is reckoned to; a stray image moves no estimate: both must say so.
    .to("miss", "offset > slipped_m, image_offset > slipped_m", 0.05)
    .to("hand_over", "pull > pull_seen_n, elapsed > settled_s", 0.1),
    Phase("hand_over", **CARRIED, arm="hold", observe=True, timeout_s=6.0).to(
        "carry", "thrust_left < thrust_left_n, arm_share > share_carried", 0.1
    ),
    Phase("carry", **CARRIED, arm="move", observe=True, duration_s=2.5, timeout_s=6.0).to("set_down", ARRIVED, 0.1),
    Phase("set_down", **{**CARRIED, "load": "impact"}, arm="lower", on_cradle=True, duration_s=1.5, timeout_s=4.5).to(
        "unload", "ground_share > share_touched, progress > half", 0.02
    ),
    Phase("unload", **RESTING, load="impact", uav="ramp", share="none", link="landed", magnet="on", timeout_s=8.0).to(
        "release", "ground_share > share_resting, hinge_force < force_free_n, rotors < rotors_off_n", 0.2
    ),
    Phase("release", **RESTING, uav="off", timeout_s=3.0).to("withdraw", "elapsed > coil_off_s"),
    # The sensor's zero is learnt anew: by now it may have drifted as far as a plate would pull that sticks.
    Phase("withdraw", **{**RESTING, "arm": "back_off"}, uav="off", free=True, duration_s=1.2, timeout_s=4.0).to(
        "done", "progress > almost_one, retreat > retreat_m, contact < half", 0.1
    ),
    # Down to where it sees the UAV well: close by, a gust takes it out of the camera's view.
    Phase("miss", arm="move", uav="station", seeks=True, duration_s=1.2, timeout_s=12.0)
    .to("abort", "retries > retries_allowed")
    .to("guide", "progress > almost_one, uav_seen > half", 0.1),
    *FINALS,
)

UNLOADED = "ground_share > share_resting, rotors < rotors_off_n"

GOES = ("release", "withdraw")
"""Phases in which the arm lets go and draws back."""

HOLDS = {
    "unload": next(p for p in PHASES if p.name == "unload")._replace(guards=()).to("done", UNLOADED, 0.2),
    "done": next(p for p in PHASES if p.name == "done")._replace(magnet="on", link="landed"),
}
"""What is done differently where the arm keeps hold of the UAV: wind and deck would push it along the rails. Nor does it wait for the
hinge to be free of force: it would give way to the wind meanwhile, and drag the skids along."""

_BY_NAME = {p.name: p for p in PHASES}

ROUGH = {
    "guide": _BY_NAME["guide"]
    ._replace(arm="move", duration_s=WAITS_S, guards=())
    .to(
        "approach",
        "progress > almost_one, uav_error < uav_error_m, uav_speed < uav_speed_mps, uav_seen > half, spare > spare_least",
        0.2,
    ),
    "approach": _BY_NAME["approach"]
    ._replace(timeout_s=JOINS_S, guards=())
    .to("align", "progress > almost_one, uav_seen > half, gap < joined_m")
    .to("miss", "uav_seen < half", BLIND_S)
    .to("miss", "relative_speed > rushes_mps", RUSHES_S),
    "align": _BY_NAME["align"]
    ._replace(guards=_BY_NAME["align"].guards[:1])
    .to("miss", "uav_seen < half", BLIND_S)
    .to("miss", "relative_speed > drops_mps", RUSHES_S),
    # What pushes the sensor while the arm follows a UAV in gusts is taken for a contact.
    "close": _BY_NAME["close"]
    ._replace(duration_s=CLOSES_S, guards=_BY_NAME["close"].guards[1:])
    .to("capture", "contact > half, gap < touched_m"),
    # A UAV on the magnet that gusts press down is held well; it takes longer until its rotors pull.
    "capture": _BY_NAME["capture"]._replace(timeout_s=PULLS_S),
    # A UAV that air takes down comes after the arm that has missed it.
    "miss": _BY_NAME["miss"]._replace(arm="flee", duration_s=FLEES_S, load="impact"),
}
"""What is done differently in wind and above a deck that moves."""

FIND = Phase(
    "find", kind="ground", arm="hold", uav="autonomous", free=True, seeks=True, timeout_s=20.0, on_timeout="refused"
).to("self_test", "uav_seen > half, elapsed > trimmed_s", 0.02)
"""The UAV hovers by itself until the camera sees it."""


def _phases(scenario: Scenario) -> tuple[Phase, ...]:
    # In wind, and above a deck that moves, a UAV that hovers by itself does not stay in view for as long as a self-test: it is guided
    # from the first sight on.
    windy, moves = bool(scenario.forecast.wind_mps), bool(scenario.forecast.deck_moves)
    phases = tuple(HOLDS.get(p.name, p) for p in PHASES if p.name not in GOES) if scenario.place.keep_hold else PHASES
    if not windy and not moves:
        return phases
    first, *rest = phases
    if windy:
        # What the rotors make of a command changes until the cradle is near.
        rest = [p._replace(observe=True) if p.name == "set_down" else p for p in rest]
    rest = [ROUGH.get(p.name, p) for p in rest]
    # As long as `limits.search_ms` and the guiding afterwards may take.
    looks = [p._replace(timeout_s=LOOKS_S) if windy and p.seeks else p for p in rest]
    wait_s = LOOKS_S if windy else 20.0
    return (FIND._replace(timeout_s=wait_s), first._replace(uav="station", seeks=True, timeout_s=wait_s), *looks)


TARGETS = {
    "guide": At("catch_m", -1.0, "wait_below_m"),
    "miss": At("catch_m", -1.0, "wait_below_m"),
    "carry": At("put_down_m", 1.0, "above_m"),
    # Above the highest place of the rails; from there it is lowered until they are felt.
    "set_down": At("put_down_m", 1.0, "search_m"),
}

_WAITING = At("catch_m", -1.0, "wait_below_m")

MOVES = {
    "guide": (At("catch_m"), _WAITING),
    "approach": (_WAITING, At("catch_m", -1.0, "standoff_m")),
    "miss": (At("catch_m"), _WAITING),
    "carry": (At("catch_m"), TARGETS["carry"]),
    "set_down": (TARGETS["carry"], TARGETS["set_down"]),
    "withdraw": (At("put_down_m"), At("put_down_m", -1.0, "withdraw_m")),
}

LANDING = Mission(
    name="landing",
    summary="catch a flying UAV and put it down on the cradle",
    start="air",
    phases=_phases,
    uses=(*SHARED, *GEAR, *ON_MAGNET, "place.keep_hold"),
    points=lambda _: (
        At("catch_m", -1.0, "wait_below_m"),
        At("catch_m"),
        At("put_down_m", 1.0, "above_m"),
        At("put_down_m"),
        At("put_down_m", -1.0, "search_m"),
        At("put_down_m", -1.0, "withdraw_m"),
    ),
    targets=TARGETS,
    moves=MOVES,
    # By then it has said what it asks of its rotors; a moment later it may be out of view again.
    thresholds=lambda s: {
        "trimmed_s": ALONE_S + TRIMMED_S,
        "joined_m": s.place.standoff_m + JOINED_M,
        "touched_m": TOUCHED_M,
        "rushes_mps": RUSHES_MPS,
        "drops_mps": DROPS_MPS,
    },
    timeouts={
        "find": "the camera does not see the UAV: check marker and camera, and whether it hovers above the arm",
        "self_test": "not all was ready: check magnet, force sensor and camera",
        "guide": "the UAV did not come to its station: check that it obeys and has room",
        "miss": "the capture was missed too often: check wind, marker, magnet and force sensor",
        "hand_over": "the arm did not take the weight over: check that the UAV obeys its thrust command",
        "carry": "the arm did not arrive: look for what is in its way",
        "set_down": "the cradle was not felt: check its place",
        "unload": "the cradle did not take the weight over",
        "release": "the hinge did not come free of force: the plate may stick",
        "withdraw": "the plate may stick to the magnet",
    },
    criteria=(
        Criterion("touchdown_speed", 0.15, "m/s", "speed of the pivot when the rails are touched first"),
        Criterion("touchdown_tilt", 3.0, "deg", "tilt of the UAV then"),
        Criterion("placed", 0.015, "m", "distance to the cradle's middle at the end"),
        Criterion("rest", 0.01, "m/s", "speed at the end"),
    ),
    judged_as="landing",
    praise="landed",
    doc="""The ground guides the UAV to `place.catch_m` by camera and link. The arm waits below, joins it, follows it from
`place.standoff_m` below its plate and closes the gap when offset, speed and tilt allow; the magnet grips. A pull of the rotors
tests the grip, then the thrust ramps down while the arm takes the weight over. The arm carries the UAV above the cradle and sets
it down; the rotors stop when the rails carry, the magnet opens when the hinge is free of force, and the arm draws back.
A capture that is missed is tried again `bounds.retries` times. A UAV that leaves the camera's view before is looked
for as long as `limits.search_ms`. Where wind or a deck that moves is foretold the ground guides the UAV from the first
sight on, through the self-test.""",
)
