"""Phases of a take-off that gives the UAV a speed: as `lifting` up to the hand-over, then run-up, release in motion, leave."""

from armland.mission.missions.lifting import PHASES as LIFTING
from armland.mission.supervisor.ends import TAKEOFF_FINALS
from armland.mission.table.phases import Condition, Guard, Phase
from armland.scenario import Scenario

C, G = Condition, Guard

CURRENT_GONE_S = 0.08
"""Time after which a magnet that was switched off no longer holds: four of its time constants."""

FLOWN_S = 3.0
"""Time for which a UAV that was given a speed is waited for after the arm has left it."""

_KNOWN = {p.name: p for p in LIFTING}
_BEFORE = ("self_test", "reach", "touch", "grip", "spin_up", "lift")


def _leading_to(phase: Phase, target: str) -> Phase:
    return phase._replace(guards=tuple(g._replace(target=target) for g in phase.guards))


PHASES = (
    *(_KNOWN[name] for name in _BEFORE),
    _leading_to(_KNOWN["carry_up"], "bring"),
    # Upwards first: beside the rails, not between them, there is room to run.
    _leading_to(_KNOWN["carry_up"], "hand_back")._replace(name="bring"),
    _KNOWN["hand_back"]._replace(
        # What the arm still carries here the UAV loses at the release, in the arm's way.
        guards=(
            G("launch", (C("hinge_force", "<", "force_light_n"), *_KNOWN["hand_back"].guards[0].conditions[1:]), 0.3),
        )
    ),
    Phase(
        "launch",
        kind="held",
        arm="launch",
        uav="run_up",
        magnet="on",
        held=True,
        link="held",
        on_timeout="holding",
        guards=(G("release", (C("progress", ">", "almost_one"), C("hinge_force", "<", "force_launched_n")), 0.03),),
    ),
    Phase(
        "release",
        kind="touch",
        # It goes on as fast as before while the magnet's current dies.
        arm="launch",
        uav="cruise",
        timeout_s=1.0,
        on_timeout="leave",
        guards=(G("leave", (C("elapsed", ">", "current_gone_s"),)),),
    ),
    Phase(
        "leave",
        arm="leave",
        uav="cruise",
        guards=(G("clear", (C("progress", ">", "almost_one"),)),),
    ),
    Phase(
        "clear",
        # The UAV has left: it flies by itself.
        sight=False,
        arm="hold",
        uav="autonomous",
        on_timeout="done",
        guards=(G("done", (C("elapsed", ">", "flown_s"),)),),
    ),
    *(p if p.name != "done" else p._replace(kind="end", uav="autonomous") for p in TAKEOFF_FINALS),
)


def gives_speed(scenario: Scenario) -> bool:
    """Whether the scenario's take-off is the one with a run-up."""
    return scenario.place.fly_on or any(scenario.place.takeoff_velocity_mps)


def launch_phases(fly_on: bool) -> tuple[Phase, ...]:
    """Phases of a take-off with a run-up; `fly_on`: the UAV keeps its speed with all its thrust, since it may not be able to hover."""
    if not fly_on:
        return PHASES
    # Where the rotors give all they have, the hinge keeps what they cannot carry.
    known = {
        "hand_back": _leading_to(_KNOWN["hand_back"], "launch"),
        **{p.name: p._replace(uav="cruise") for p in PHASES if p.name in ("clear", "done")},
    }
    return tuple(known.get(p.name, p) for p in PHASES)


def launch_thresholds() -> dict[str, float]:
    """The thresholds of a run-up, s."""
    return {"current_gone_s": CURRENT_GONE_S, "flown_s": FLOWN_S}
