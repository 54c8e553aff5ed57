"""The take-off, the landing backwards: the arm grips the UAV on the cradle, lifts it to its station and lets it fly.

With a speed that the UAV is given it is the same up to the hand-over; then come run-up, release in motion, and leaving.
"""

from typing import Any

from armland.mission.missions.keys import GEAR, LAUNCH, ON_MAGNET, SHARED
from armland.mission.missions.landing import ARRIVED, CARRIED, HELD, READY, TESTED
from armland.mission.reference.septic import SWELL
from armland.mission.supervisor.ends import TAKEOFF_FINALS
from armland.mission.table.mission import At, Criterion, Mission
from armland.mission.table.phases import Phase
from armland.models.parameters import plate_mass, uav_parameters
from armland.scenario import Scenario

CURRENT_GONE_S = 0.08
"""Time after which a magnet that was switched off no longer holds: four of its time constants."""

FLOWN_S = 3.0
"""Time for which a UAV that was given a speed is waited for after the arm has left it."""

TEARS = 2.2
"""Least pull on the plate by the UAV's inertia while the arm leaves it, over what the magnet is believed to keep without current.

A magnet keeps up to 2.7 times that at published deviations; the rest is pulled by the UAV's thrust, which holds its station."""

QUICKEST = 0.5
"""Share of its usual time in which the arm leaves, at least."""

STANDING: dict[str, Any] = {"kind": "ground", "uav": "off", "free": True, "on_cradle": True, "on_timeout": "refused"}
"""The UAV stands on the cradle, nothing touches it yet."""

GRIPPING: dict[str, Any] = {
    "kind": "grip",
    "load": "impact",
    "magnet": "on",
    "on_cradle": True,
    "on_timeout": "secured",
}
"""The magnet works on the plate of a UAV that stands on the cradle."""

CARRY_UP = Phase("carry_up", **CARRIED, arm="move", observe=True, duration_s=2.5, timeout_s=6.0)

# It flies by itself should the link be lost: it must know so before the magnet opens.
HAND_BACK = Phase("hand_back", **{**HELD, "link": "caught"}, arm="hold", uav="balance", observe=True, timeout_s=8.0)
LEVEL = "uav_seen > half, lean < level_tilt_deg"

BEFORE = (
    Phase("self_test", **{**STANDING, **TESTED}).to("reach", READY, 0.2),
    # To the plate as the camera sees it: the cradle may stand a little aside.
    Phase("reach", **STANDING, arm="join", duration_s=2.0, timeout_s=5.0).to(
        "touch", "progress > almost_one, uav_seen > half"
    ),
    # What is felt before the arm is half-way to the plate is the arm's own stop before it, which a light UAV's threshold lies below;
    # so does what the tool's inertia makes of the arm's unrest farther on. A plate that is seen well above the magnet touches nothing.
    Phase("touch", **GRIPPING, arm="close", uav="off", duration_s=1.5, timeout_s=3.0).to(
        "grip", "contact > half, progress > half, gap < let_go_m"
    ),
    # The magnet stays on, so what the arm pushes on a UAV that stands need be no less than what can be told from its own motion.
    Phase("grip", **GRIPPING, arm="yield", uav="off", timeout_s=2.0).to(
        "spin_up", "elapsed > settled_s, hinge_force < force_felt_n", 0.1
    ),
    Phase("spin_up", **GRIPPING, link="landed", arm="yield", uav="ramp", share="carry", timeout_s=5.0).to(
        "lift", "thrust_left < thrust_left_n, uav_seen > half", 0.2
    ),
    Phase("lift", **CARRIED, arm="move", on_cradle=True, duration_s=1.5, timeout_s=4.0).to(
        "carry_up", "progress > almost_one, arm_share > share_carried", 0.1
    ),
)
"""Up to where the UAV hangs on the arm."""

PHASES = (
    *BEFORE,
    CARRY_UP.to("hand_back", ARRIVED, 0.1),
    HAND_BACK.to("release", f"hinge_force < force_balanced_n, {LEVEL}", 0.3),
    Phase("release", kind="touch", arm="hold", uav="level", timeout_s=1.0, on_timeout="clear").to(
        "clear", "elapsed > coil_off_s"
    ),
    # Down to where it sees the UAV well.
    Phase("clear", arm="move", uav="station", seeks=True, duration_s=1.2, timeout_s=20.0).to(
        "done", "progress > almost_one, uav_seen > half, uav_error < flown_error_m, uav_speed < flown_speed_mps", 0.5
    ),
    *TAKEOFF_FINALS,
)


def gives_speed(scenario: Scenario) -> bool:
    """Whether the scenario's take-off is the one with a run-up."""
    return scenario.place.fly_on or any(scenario.place.takeoff_velocity_mps)


def launch_phases(fly_on: bool) -> tuple[Phase, ...]:
    """Phases of a take-off with a run-up; `fly_on`: the UAV keeps its speed with all its thrust, since it may not be able to hover."""
    # What the arm still carries the UAV loses at the release, in the arm's way; where the rotors give all they have, the hinge
    # keeps what they cannot carry.
    free = "force_balanced_n" if fly_on else "force_light_n"
    after = "cruise" if fly_on else "autonomous"
    return (
        *BEFORE,
        CARRY_UP.to("bring", ARRIVED, 0.1),
        # Upwards first: beside the rails, not between them, there is room to run.
        CARRY_UP._replace(name="bring").to("hand_back", ARRIVED, 0.1),
        HAND_BACK.to("launch", f"hinge_force < {free}, {LEVEL}", 0.3),
        Phase("launch", **HELD, arm="launch", uav="run_up").to(
            "release", "progress > almost_one, hinge_force < force_launched_n", 0.03
        ),
        # It goes on as fast as before while the magnet's current dies.
        Phase("release", kind="touch", arm="launch", uav="cruise", timeout_s=1.0, on_timeout="leave").to(
            "leave", "elapsed > current_gone_s"
        ),
        Phase("leave", arm="leave", uav="cruise").to("clear", "progress > almost_one"),
        # The UAV has left: it flies by itself.
        Phase("clear", sight=False, arm="hold", uav=after, on_timeout="done").to("done", "elapsed > flown_s"),
        *(p._replace(kind="end", uav=after) if p.name == "done" else p for p in TAKEOFF_FINALS),
    )


def _phases(scenario: Scenario) -> tuple[Phase, ...]:
    if gives_speed(scenario):
        return launch_phases(scenario.place.fly_on)
    return tuple(p._replace(duration_s=leaving_s(scenario, p)) if p.name == "clear" else p for p in PHASES)


def leaving_s(scenario: Scenario, clear: Phase) -> float:
    """Time, s, in which the arm leaves a UAV that it let go: that of the phase, or less where a light UAV would go with the arm.

    Args:
        scenario: believed.
        clear: the phase.
    """
    mass, residual = uav_parameters(scenario).mass + plate_mass(scenario), scenario.magnet.residual_n
    torn = SWELL * scenario.place.wait_below_m * mass / max(TEARS * residual, 1e-9)
    return float(min(max(torn**0.5, QUICKEST * clear.duration_s), clear.duration_s))


def _points(scenario: Scenario) -> tuple[At, ...]:
    before = At("put_down_m", -1.0, "withdraw_m"), At("put_down_m"), At("put_down_m", 1.0, "above_m")
    if gives_speed(scenario):
        return (*before, At("launch_m"))
    return (*before, At("catch_m"), At("catch_m", -1.0, "wait_below_m"))


TARGETS = {
    "lift": At("put_down_m", 1.0, "above_m"),
    "carry_up": At("catch_m"),
    "clear": At("catch_m", -1.0, "wait_below_m"),
}

MOVES = {
    "reach": (At("put_down_m", -1.0, "withdraw_m"), At("put_down_m", -1.0, "standoff_m")),
    "lift": (At("put_down_m"), TARGETS["lift"]),
    "carry_up": (TARGETS["lift"], TARGETS["carry_up"]),
    "clear": (At("catch_m"), TARGETS["clear"]),
}

TAKEOFF = Mission(
    name="takeoff",
    summary="lift a UAV from the cradle and let it fly, with a speed if wanted",
    start="cradle",
    phases=_phases,
    uses=(*SHARED, *GEAR, *ON_MAGNET, *LAUNCH),
    points=_points,
    targets=TARGETS,
    moves=MOVES,
    thresholds=lambda s: {
        "current_gone_s": CURRENT_GONE_S,
        "flown_s": FLOWN_S,
        "force_felt_n": s.estimation.contact.contact_n.on,
    },
    timeouts={
        "self_test": "not all was ready: check magnet, force sensor and camera",
        "reach": "the arm did not arrive below the UAV: look for what is in its way",
        "touch": "the arm did not feel the plate: check that the UAV stands in the cradle",
        "grip": "the hinge did not come free of force: look for what has jammed",
        "spin_up": "the rotors did not come up to their share, or the camera does not see the marker",
        "lift": "the arm did not feel the UAV's weight: check the force sensor and whether the UAV obeys",
        "carry_up": "the arm did not arrive: look for what is in its way",
        "bring": "the arm did not arrive: look for what is in its way",
        "hand_back": "the hinge did not come free of force, or the camera does not see the marker",
        "launch": "the hinge did not come free of force at speed",
        "leave": "the arm did not get out of the UAV's path: look for what is in its way",
        "clear": "the UAV did not come to its station: check that it obeys and has room",
    },
    criteria=(
        Criterion(
            "flying_speed", 0.25, "m/s", "speed of the UAV at the end, against the one that it was given to keep"
        ),
        Criterion("flying_tilt", 10.0, "deg", "tilt at the end"),
    ),
    judged_as="takeoff",
    praise="flies",
    doc="""The arm reaches below the UAV on its cradle, touches the plate and grips it; the rotors spin up to their share of the
weight, and the arm lifts the UAV and carries it to its station. There the thrust rises until the hinge is free of force, and the
magnet opens. With `place.takeoff_velocity_mps` the arm runs up to that velocity through `place.launch_m`, lets go in motion and
dives out of the UAV's way; with `place.fly_on` the UAV keeps the speed with all its thrust, and may weigh more than can hover.""",
)
