"""The take-off with and without a speed: which phases, which points."""

import numpy as np
import pytest

from armland.mission.belief import flyer
from armland.mission.missions.takeoff import (
    CURRENT_GONE_S,
    PHASES,
    QUICKEST,
    TAKEOFF,
    TEARS,
    gives_speed,
    launch_phases,
)
from armland.mission.reference.septic import septic
from armland.models.airframe.sizing import sized
from armland.models.capture import Grip
from armland.scenario import load_scenario

PLAIN = {p.name: p for p in PHASES}
UNDER_WAY = [p for p in PHASES if not p.final]
THROWN = {p.name: p for p in launch_phases(fly_on=False)}


def names(**place):
    return [p.name for p in TAKEOFF.phases(load_scenario("landing", {"place": place}))]


def test_run_up_comes_between_hand_over_and_release():
    plain, thrown = names(), names(takeoff_velocity_mps=[0.3, 0.0, 0.0])
    assert "launch" not in plain
    assert thrown.index("hand_back") < thrown.index("launch") < thrown.index("release") < thrown.index("leave")


@pytest.mark.parametrize(("speed", "last"), [([0.0, 0.0, 0.0], "catch_m"), ([0.3, 0.0, 0.0], "launch_m")])
def test_arm_visits_where_it_lets_go(speed, last):
    points = TAKEOFF.points(load_scenario("landing", {"place": {"takeoff_velocity_mps": speed}}))
    assert points[-1].place == last
    assert points[0].above < 0.0


def test_uav_that_cannot_hover_is_let_go_with_the_force_that_its_rotors_leave():
    """Its hinge never comes free of force: the hand-over's bound is the looser one, and it flies on at the end."""
    phases = {
        fly_on: {
            p.name: p
            for p in TAKEOFF.phases(
                load_scenario("landing", {"place": {"takeoff_velocity_mps": [0.3, 0.0, 0.0], "fly_on": fly_on}})
            )
        }
        for fly_on in (False, True)
    }
    bound = {k: phases[k]["hand_back"].guards[0].conditions[0].threshold for k in phases}
    assert bound == {False: "force_light_n", True: "force_balanced_n"}
    assert phases[True]["done"].uav == "cruise"


def test_first_guards_lead_from_the_self_test_to_the_goal_through_every_phase():
    here, way = "self_test", []
    while not PLAIN[here].final:
        way.append(here)
        here = PLAIN[here].guards[0].target
    assert here == "done"
    assert way == [p.name for p in UNDER_WAY]


def test_arm_that_grips_on_waits_until_it_feels_no_push():
    felt = {"on": 0.7, "off": 0.5, "on_s": 0.0, "off_s": 0.0}
    light = load_scenario("landing", {"estimation": {"contact": {"contact_n": felt}}})
    assert PLAIN["grip"].guards[0].conditions[-1].threshold == "force_felt_n"
    assert TAKEOFF.thresholds(light)["force_felt_n"] == 0.7
    assert PLAIN["grip"].magnet == "on"


def test_magnet_is_on_from_the_touch_until_the_hinge_is_free_of_force():
    on = [p.name for p in UNDER_WAY if p.magnet == "on"]
    names = [p.name for p in UNDER_WAY]
    assert on == names[names.index("touch") : names.index("hand_back") + 1]


def test_contact_counts_from_half_of_the_stroke_on_which_lies_before_the_plate():
    """The septic is half-way at half its time; a camera that errs by 5 mm does not bring the plate nearer than that.

    Nor is what is felt of a plate that is seen well above the magnet: a light UAV's threshold is below the arm's own unrest.
    """
    (guard,), scenario = PLAIN["touch"].guards, load_scenario("landing")
    found = {(c.signal, c.relation): c.threshold for c in guard.conditions}
    assert found == {("contact", ">"): "half", ("progress", ">"): "half", ("gap", "<"): "let_go_m"}
    assert scenario.bounds.let_go_m == 0.01
    standoff, beyond = scenario.place.standoff_m, scenario.control.approach.beyond_m
    assert 0.5 * (standoff + beyond) < standoff - 0.005


def test_rotors_turn_only_once_the_uav_is_gripped():
    names = [p.name for p in UNDER_WAY]
    off = [p.name for p in UNDER_WAY if p.uav == "off"]
    assert off == names[: names.index("spin_up")]
    assert PLAIN["grip"].magnet == "on"


@pytest.mark.parametrize("phase", UNDER_WAY, ids=lambda p: p.name)
def test_time_out_leads_to_a_safe_end_and_leaves_time_for_the_move(phase):
    assert phase.timeout_s > phase.duration_s
    # A magnet that has let go is left in any case.
    assert PLAIN[phase.on_timeout].final or (phase.name, phase.on_timeout) == ("release", "clear")
    # What may still stand on the rails is secured there, and what hangs on the arm is held.
    assert phase.kind != "held" or phase.on_timeout == "holding"
    assert phase.kind != "grip" or phase.on_timeout == "secured"


def test_guards_lead_from_the_self_test_past_the_run_up_to_the_goal():
    here, way = "self_test", []
    while not THROWN[here].final:
        way.append(here)
        here = THROWN[here].guards[0].target
    assert here == "done"
    assert way == [p.name for p in THROWN.values() if not p.final]


@pytest.mark.parametrize("fly_on", [False, True])
def test_every_phase_leads_to_one_that_is_there(fly_on):
    phases = launch_phases(fly_on)
    names = {p.name for p in phases}
    assert len(names) == len(phases)
    for p in phases:
        assert {g.target for g in p.guards} <= names
        assert p.final or p.on_timeout in names


def test_up_to_the_lift_it_is_the_plain_take_off():
    for name in ("self_test", "reach", "touch", "grip", "spin_up", "lift"):
        assert THROWN[name] == PLAIN[name]
    # It is carried as in the plain one, only elsewhere.
    for name in ("carry_up", "bring"):
        assert THROWN[name]._replace(name="carry_up", guards=()) == PLAIN["carry_up"]._replace(guards=())


def test_arm_holds_on_while_it_runs_up_and_goes_on_as_fast_while_the_current_dies():
    assert (THROWN["launch"].magnet, THROWN["launch"].held) == ("on", True)
    assert (THROWN["release"].magnet, THROWN["release"].held, THROWN["release"].arm) == ("off", False, "launch")
    # The pull of a magnet falls with the square of its current: after four time constants to a thousandth of its rating.
    assert Grip().rated_force * 0.0004 < 0.1
    assert TAKEOFF.thresholds(load_scenario("landing"))["current_gone_s"] == CURRENT_GONE_S


def test_uav_that_cannot_hover_is_never_asked_to():
    """Neither at the end nor while it leaves, and the hinge need not come free of force before."""
    after = {p.name: p for p in launch_phases(True)}
    for name in ("release", "leave", "clear", "done"):
        assert after[name].uav == "cruise", name
    assert after["hand_back"].guards[0].target == "launch"
    for p in THROWN.values():
        if p.name not in ("clear", "done", "hand_back"):
            assert after[p.name] == p


@pytest.mark.parametrize(
    ("place", "speed"),
    [
        ({}, False),
        ({"takeoff_velocity_mps": [0.0, 0.0, 0.1]}, True),
        ({"takeoff_velocity_mps": [-0.1, 0.0, 0.0]}, True),
        ({"fly_on": True}, True),
    ],
)
def test_speed_in_any_direction_is_one_and_so_is_that_of_a_uav_that_flies_on(place, speed):
    assert gives_speed(load_scenario("landing", {"place": place})) == speed


def test_uav_may_touch_the_cradle_up_to_the_lift_and_not_in_the_end():
    before = ["self_test", "reach", "touch", "grip", "spin_up", "lift"]
    for phases in (PLAIN, THROWN):
        assert [n for n, p in phases.items() if p.on_cradle and not p.final] == before
        assert not phases["done"].on_cradle
        assert phases["refused"].on_cradle


def leaving(settings):
    """Time of the arm's leaving, s, and the largest pull on the plate by the UAV's inertia, N, by the septic's accelerations."""
    scenario = sized(load_scenario("landing", settings)).believed()
    clear = next(p for p in TAKEOFF.phases(scenario) if p.name == "clear")
    rises = [septic(u, clear.duration_s)[2] for u in np.linspace(0.0, 1.0, 201)]
    return clear.duration_s, max(rises) * scenario.place.wait_below_m * flyer(scenario).mass, scenario.magnet.residual_n


def test_arm_leaves_a_light_uav_fast_enough_to_tear_the_plate_off():
    """Its magnet keeps more of its weight than the AR.Drone's, which the usual time tears off."""
    usual, pull, kept = leaving({})
    assert usual == PLAIN["clear"].duration_s
    assert pull > TEARS * kept
    quick, pull, kept = leaving({"airframe": "crazyflie"})
    assert quick < usual
    assert pull == pytest.approx(TEARS * kept, rel=1e-3)
    assert pull * (quick / usual) ** 2 < TEARS * kept


def test_arm_never_leaves_in_less_than_a_share_of_its_time():
    assert leaving({"magnet": {"residual_n": 50.0}})[0] == QUICKEST * PLAIN["clear"].duration_s
