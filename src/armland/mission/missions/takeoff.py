"""The take-off, the landing backwards: the arm grips the UAV on the cradle, lifts it to its station and lets it fly."""

from armland.mission.missions.keys import GEAR, HELD, LAUNCH, SHARED
from armland.mission.missions.launch import gives_speed, launch_phases, launch_thresholds
from armland.mission.missions.lifting import PHASES
from armland.mission.table.mission import At, Criterion, Mission
from armland.mission.table.phases import Phase
from armland.scenario import Scenario


def _phases(scenario: Scenario) -> tuple[Phase, ...]:
    return launch_phases(scenario.place.fly_on) if gives_speed(scenario) else PHASES


def _points(scenario: Scenario) -> tuple[At, ...]:
    before = At("put_down_m", -1.0, "withdraw_m"), At("put_down_m"), At("put_down_m", 1.0, "above_m")
    if gives_speed(scenario):
        return (*before, At("launch_m"))
    return (*before, At("catch_m"), At("catch_m", -1.0, "withdraw_m"))


TARGETS = {
    "reach": At("put_down_m", -0.02),
    # A little further than the plate's face, so that all pads touch.
    "touch": At("put_down_m", 0.001),
    "lift": At("put_down_m", 1.0, "above_m"),
    "carry_up": At("catch_m"),
}

TAKEOFF = Mission(
    name="takeoff",
    summary="lift a UAV from the cradle and let it fly, with a speed if wanted",
    start="cradle",
    phases=_phases,
    uses=(*SHARED, *GEAR, *HELD, *LAUNCH),
    points=_points,
    targets=TARGETS,
    thresholds=lambda _: launch_thresholds(),
    timeouts={
        "self_test": "magnet, bias of the force sensor or sight of the UAV were not ready: check magnet and camera",
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
