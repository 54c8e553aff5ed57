"""What the UAV is asked: ramps tied to the hinge, station keeping at its station, flying on, set-points in its own world."""

import numpy as np
import pytest

from armland.estimation.plate.layouts import FELT_S
from armland.mission.reference.guided import CAUGHT_S
from armland.mission.table.phases import LINK, UAV
from armland.mission.told import ASTRAY_M
from armland.mission.uav import LEANT_MPS2, RECKONED_S, SEATS_S, command_uav
from armland.records import UavMode
from armland.rotations import conjugate, from_rotation_vector, matrix, multiply

LEVEL = np.array([1.0, 0.0, 0.0, 0.0])


def ask(bench, phase, ticks=1, align=LEVEL):
    """Be in a phase for some ticks; returns the thrust commanded."""
    row = bench.enter(phase)
    for _ in range(ticks):
        command_uav(row, align, bench.b)
        bench.m["tick"] += 1
    return float(bench.c["thrust"][0])


class Hanging:
    """A UAV whose arm `carries` a share of what the rotors leave."""

    def __init__(self, bench, carries):
        self.bench, self.carries = bench, carries
        self.weight = bench.told["act"]["uav"]["weight"][0]
        bench.kept["act"]["hover"] = bench.kept["act"]["thrust"] = self.weight

    def run(self, ticks, phase="hand_over"):
        bench = self.bench
        for _ in range(ticks):
            bench.e["thrust"] = bench.kept["act"]["thrust"]
            bench.e["hinge_force"][0, 2] = self.carries * (self.weight - bench.e["thrust"][0])
            thrust = ask(bench, phase)
        return thrust


def test_thrust_ramps_down_where_the_arm_takes_over(bench):
    share = bench.plan.scenario.control.thrust.carry_share
    hanging = Hanging(bench, 1.0)
    assert hanging.run(2000) == pytest.approx(share * hanging.weight, abs=1e-6)
    assert bench.c["uav_mode"][0] == UavMode.HELD


def test_ramp_has_its_rate(bench):
    hanging = Hanging(bench, 1.0)
    assert hanging.weight - hanging.run(100) == pytest.approx(0.1 * bench.plan.scenario.control.thrust.rate_nps)


def test_thrust_waits_where_nobody_takes_over(bench):
    hanging = Hanging(bench, 0.0)
    assert hanging.run(3000) > hanging.weight - bench.plan.scenario.control.thrust.slack_n - 0.1


def test_rotors_stop_at_the_end_of_the_last_ramp(bench):
    assert Hanging(bench, 1.0).run(4000, "unload") == 0.0
    assert bench.c["uav_mode"][0] == UavMode.OFF


@pytest.mark.parametrize("leans", [1, 0])
def test_uav_caught_in_wind_lies_on_the_magnet_leaning_before_it_pulls(bench, leans):
    """In calm air it is levelled, and pulls at once."""
    kept, told, hover = bench.kept["act"], bench.told["act"]["uav"], 5.0
    kept["hover"], kept["thrust"], kept["hovered"] = hover, hover, [2.0, 0.0]
    told["sight"]["leans"] = leans
    pull = bench.plan.scenario.bounds.pull_test_n
    bench.e["thrust"] = hover
    bench.kept["decide"]["begin"] = bench.m["tick"]
    early = ask(bench, "capture", round(0.8 * SEATS_S / 1e-3))
    lean = 2.0 * np.arctan2(kept["q_d"][0, 2], kept["q_d"][0, 0])
    assert (early < hover) is bool(leans)
    assert lean == pytest.approx(np.arctan(2.0 / 9.81) if leans else 0.0, abs=1e-3)
    late = ask(bench, "capture", 1200)
    assert late - hover == pytest.approx(hover - early if leans else late - hover)
    assert late > hover + 0.5 * pull


def test_uav_that_nobody_vouches_for_hovers_by_itself(bench):
    bench.kept["act"]["hover"], bench.kept["estimate"]["seen"] = 5.0, 0
    assert ask(bench, "guide") == 5.0
    assert bench.c["uav_mode"][0] == UavMode.AUTONOMOUS
    bench.kept["estimate"]["seen"] = 1
    ask(bench, "guide")
    assert bench.c["uav_mode"][0] == UavMode.GUIDED


@pytest.mark.parametrize(
    ("age", "sigma", "mode"), [(1.9, 0.14, "GUIDED"), (1.9, 0.16, "AUTONOMOUS"), (2.1, 0.01, "AUTONOMOUS")]
)
def test_in_wind_a_uav_out_of_view_is_guided_for_as_long_as_it_is_known_where_it_is(bench, age, sigma, mode):
    """Negative control: without a forecast it is left to its own hover at that age."""
    p = bench.told["act"]["uav"]
    bench.e["plate"][0], bench.e["plate_age"], bench.kept["estimate"]["plate"]["sigma_position"] = 0.8, age, sigma
    ask(bench, "guide")
    assert bench.c["uav_mode"][0] == UavMode.AUTONOMOUS
    p["reckoned"], p["astray"] = FELT_S, ASTRAY_M
    ask(bench, "guide")
    assert bench.c["uav_mode"][0] == getattr(UavMode, mode)


@pytest.mark.parametrize(("leans", "fused", "mode"), [(1, 2, 0), (1, 3, 1), (0, 0, 1)])
def test_in_wind_a_uav_is_guided_once_enough_images_fit_each_other(bench, leans, fused, mode):
    """Of the first ones an outlier is believed, and speed and gust with it. In calm air one is enough."""
    bench.told["act"]["uav"]["sight"]["leans"], bench.kept["estimate"]["seen"] = leans, 1
    bench.kept["estimate"]["filter"]["fused"] = fused
    ask(bench, "guide")
    assert bench.tick.buffer["command"]["uav_mode"][0] == mode


def test_uav_that_has_left_the_view_is_told_where_to_hover_in_its_own_axes(bench):
    """It believes a heading of 90 degrees less than it has: what lies along deck x lies along its own −y."""
    align = from_rotation_vector(np.array([0.0, 0.0, 0.5 * np.pi]))
    bench.e["plate"][0] = np.array(bench.plan.scenario.place.catch_m) - [0.2, 0.0, 0.0]
    bench.e["plate_age"], bench.e["r"][0, 2] = 0.99 * RECKONED_S, 0.6
    ask(bench, "guide", align=align)
    assert bench.c["uav_mode"][0] == UavMode.GUIDED
    np.testing.assert_array_equal(bench.c["uav_step"], 0.0)
    bench.e["plate_age"] = 1.01 * RECKONED_S
    ask(bench, "guide", align=align)
    assert bench.c["uav_mode"][0] == UavMode.AUTONOMOUS
    np.testing.assert_allclose(bench.c["uav_step"][0, :2], [0.0, -0.2], atol=1e-12)
    # In an end it stays where it was sent; found again it is guided.
    step = bench.c["uav_step"].copy()
    ask(bench, "abort", align=align)
    np.testing.assert_array_equal(bench.c["uav_step"], step)
    bench.e["plate_age"] = 0.0
    ask(bench, "guide", align=align)
    np.testing.assert_array_equal(bench.c["uav_step"], 0.0)


def at_station(bench, away=(0.0, 0.0, 0.0), lean=(0.0, 0.0, 0.0), rate=(0.0, 0.0, 0.0)):
    """A UAV `away` from its station, leaning and turning about its centre of mass, which is at rest; the arm waits below."""
    p = bench.told["act"]["uav"]
    R, lever = matrix(from_rotation_vector(np.array(lean))), p["lever"][0]
    bench.e["quat"][0], bench.e["omega"] = from_rotation_vector(np.array(lean)), rate
    cm = p["station"][0] - lever + away
    bench.e["plate"], bench.e["plate_v"] = cm + R @ lever, R @ np.cross(rate, lever)
    bench.m["tick"], bench.e["r"][0, 2] = 1000, 0.62


def test_uav_at_its_station_is_asked_to_hover_there(bench):
    at_station(bench)
    assert ask(bench, "guide") == pytest.approx(bench.told["act"]["uav"]["weight"][0])
    np.testing.assert_allclose(bench.c["uav_quat"][0], LEVEL, atol=1e-12)


def test_swing_of_the_plate_below_the_uav_is_no_motion_of_the_uav(bench):
    at_station(bench, lean=(0.1, 0.0, 0.0), rate=(1.0, 0.0, 0.0))
    ask(bench, "guide")
    np.testing.assert_allclose(bench.c["uav_quat"][0], LEVEL, atol=1e-12)


@pytest.mark.parametrize(("away", "axis"), [((0.1, 0.0, 0.0), 0), ((0.0, -0.1, 0.0), 1)])
def test_uav_beside_its_station_is_tilted_towards_it(bench, away, axis):
    at_station(bench, away)
    ask(bench, "guide")
    lift = matrix(bench.c["uav_quat"][0].copy())[:, 2]
    assert lift[axis] * away[axis] < 0.0


def test_station_keeping_has_its_own_rate(bench):
    at_station(bench, (0.1, 0.0, 0.0))
    ask(bench, "guide")
    first = bench.c["uav_quat"][0].copy()
    bench.e["plate"] += 0.05
    for _ in range(int(bench.told["act"]["uav"]["period"][0]) - 1):
        ask(bench, "guide")
        np.testing.assert_array_equal(bench.c["uav_quat"][0], first)
    ask(bench, "guide")
    assert not np.array_equal(bench.c["uav_quat"][0], first)


def test_thrust_that_carries_the_weight_is_learnt_while_the_station_is_kept(bench):
    at_station(bench)
    weight = bench.told["act"]["uav"]["weight"][0]
    bench.kept["act"]["hover"] = 0.9 * weight
    ask(bench, "guide", 5000)
    assert bench.kept["act"]["hover"][0] == pytest.approx(weight, rel=1e-2)


def test_set_points_travel_in_the_uavs_own_idea_of_the_world(bench):
    align = from_rotation_vector(np.array([0.0, 0.0, 0.3]))
    at_station(bench, (0.1, 0.0, 0.0))
    ask(bench, "guide", align=align)
    np.testing.assert_allclose(multiply(align, bench.c["uav_quat"][0].copy()), bench.kept["act"]["q_d"][0], atol=1e-12)


@pytest.mark.parametrize(("force", "sign"), [(1.0, 1.0), (-1.0, -1.0)])
def test_hinge_is_freed_of_force_by_more_thrust_where_the_arm_lifts(cradle_bench, force, sign):
    bench = cradle_bench
    bench.kept["act"]["thrust"], bench.e["hinge_force"][0, 2] = 3.0, force
    thrust = ask(bench, "hand_back")
    rate = bench.plan.scenario.control.thrust.balance_nps_per_n
    assert thrust - 3.0 == pytest.approx(sign * rate * 1e-3)
    # What carries the weight by then is where the station keeping takes over.
    p = bench.told["act"]["uav"]
    assert bench.kept["act"]["hover"][0] == thrust
    assert bench.kept["act"]["integral"][0, 2] == pytest.approx(thrust / p["mass"][0] - 9.81)


def as_uav(bench, what, ticks=1, **row):
    """Command what a phase whose UAV does `what` commands; returns the thrust."""
    phase = bench.enter("guide")
    phase["uav"] = UAV.index(what)
    for name, value in row.items():
        phase[name] = value
    for _ in range(ticks):
        command_uav(phase, LEVEL, bench.b)
        bench.m["tick"] += 1
    return float(bench.c["thrust"][0])


def axis_of(bench):
    """Where the body's z axis shall point (3,), deck."""
    return matrix(bench.kept["act"]["q_d"][0].copy())[:, 2]


@pytest.mark.parametrize("link", LINK)
def test_what_a_uav_without_link_does_is_said_by_the_phase(bench, link):
    modes = {"guided": "GUIDED", "held": "HELD", "landed": "LANDED", "caught": "CAUGHT", "hinged": "HINGED"}
    as_uav(bench, "level", link=LINK.index(link))
    assert bench.c["uav_mode"][0] == getattr(UavMode, modes[link])


def test_level_uav_keeps_the_thrust_it_has_and_its_rotors_stop_where_it_shall_be_off(bench):
    bench.kept["act"]["thrust"], bench.kept["act"]["hover"] = 3.3, 5.0
    assert as_uav(bench, "level") == 3.3
    assert as_uav(bench, "off") == 0.0
    assert bench.c["uav_mode"][0] == UavMode.OFF
    assert bench.kept["act"]["thrust"][0] == 0.0


def test_level_uav_keeps_its_heading(bench):
    bench.told["act"]["uav"]["heading"] = 0.7
    as_uav(bench, "autonomous")
    np.testing.assert_allclose(bench.c["uav_quat"][0], from_rotation_vector(np.array([0.0, 0.0, 0.7])), atol=1e-12)


@pytest.mark.parametrize(("held", "thrust"), [(1, 1.7), (0, 2.35)])
def test_hinged_uav_gives_what_the_law_made_of_it_else_what_the_hinge_is_told(bench, held, thrust):
    bench.c["thrust"], bench.told["act"]["uav"]["hinged"] = 1.7, 2.35
    assert as_uav(bench, "hinged", held=held) == thrust


@pytest.mark.parametrize("v", [(0.6, 0.0, 0.0), (0.3, -0.4, 0.0)])
def test_uav_that_the_arm_runs_up_with_holds_its_own_drag(bench, v):
    """Its thrust, as strong as before, along weight and drag together: at a constant speed the hinge is free of force."""
    p = bench.told["act"]["uav"][0]
    bench.kept["act"]["thrust"], bench.e["v"] = 5.1, v
    assert as_uav(bench, "run_up") == 5.1
    wanted = np.array([p["drag"] * v[0], p["drag"] * v[1], p["weight"]])
    np.testing.assert_allclose(axis_of(bench), wanted / np.linalg.norm(wanted), atol=1e-12)


def flying_on(bench, velocity, fly_on=0):
    """A UAV that begins to fly on at the bench's tick: at rest in its frame, level, its centre of mass at (0.1, 0.2, 1.0)."""
    p, cm = bench.told["act"]["uav"], np.array([0.1, 0.2, 1.0])
    p["launch"], p["fly_on"], p["period"] = velocity, fly_on, 5
    bench.e["quat"][0], bench.e["plate"], bench.e["plate_v"] = LEVEL, cm + p["lever"][0], velocity
    return cm


def test_uav_flies_on_from_where_it_was_let_go_at_the_speed_that_it_was_given(bench):
    """On its way it is tilted against its drag alone; behind its way it is tilted on, ahead of it back."""
    velocity = np.array([0.4, -0.3, 0.0])
    cm, p, start = flying_on(bench, velocity), bench.told["act"]["uav"][0], 1000
    as_uav(bench, "cruise")
    np.testing.assert_allclose(bench.kept["act"]["anchor"][0], cm)
    leans = {}
    for ahead in (0.0, 0.05, -0.05):
        bench.kept["act"]["integral"], bench.m["tick"] = 0.0, start + 500
        bench.e["plate"] = cm + p["lever"] + velocity * 0.5 + ahead * np.array([0.8, -0.6, 0.0])
        thrust = as_uav(bench, "cruise")
        leans[ahead] = axis_of(bench)
        if ahead == 0.0:
            np.testing.assert_allclose(thrust * axis_of(bench)[2], p["weight"], rtol=1e-3)
    drag = p["drag"] * velocity / p["weight"]
    np.testing.assert_allclose(leans[0.0][:2] / leans[0.0][2], drag[:2], rtol=1e-6)
    along = {k: v[:2] / v[2] @ [0.8, -0.6] for k, v in leans.items()}
    assert along[0.05] < along[0.0] < along[-0.05]


def test_uav_that_flies_on_keeps_to_its_period_once_it_has_begun(bench):
    """At once where it is let go, whatever the tick; then as often as the station is kept."""
    cm = flying_on(bench, np.array([0.4, 0.0, 0.0]))
    bench.m["tick"] = 1003
    as_uav(bench, "cruise")
    assert bench.kept["act"]["cruising"][0] == 1003
    first = bench.c["uav_quat"][0].copy()
    bench.e["plate"][0] = cm + 1.0
    for tick, changed in ((1004, False), (1005, True)):
        bench.m["tick"] = tick
        as_uav(bench, "cruise")
        assert (not np.array_equal(bench.c["uav_quat"][0], first)) == changed
    np.testing.assert_allclose(bench.kept["act"]["anchor"][0], cm)


def test_uav_too_heavy_to_hover_flies_on_with_all_it_has_seen_or_not(bench):
    velocity, p = np.array([0.0, -0.5, 0.0]), bench.told["act"]["uav"][0]
    flying_on(bench, velocity, fly_on=1)
    for age in (0.0, 9.0):
        bench.e["plate_age"] = age
        assert as_uav(bench, "cruise", link=LINK.index("guided")) == p["thrust_max"]
        assert bench.c["uav_mode"][0] == UavMode.GUIDED
        wanted = np.array([0.0, -0.5 * p["drag"], p["weight"]])
        np.testing.assert_allclose(axis_of(bench), wanted / np.linalg.norm(wanted), atol=1e-12)


def test_uav_that_flies_on_and_is_not_seen_hovers_by_itself(bench):
    flying_on(bench, np.array([0.4, 0.0, 0.0]))
    bench.e["plate_age"] = 9.0
    as_uav(bench, "cruise")
    assert bench.c["uav_mode"][0] == UavMode.AUTONOMOUS


@pytest.mark.parametrize(("behind", "share"), [(0.0, 1.0), (0.25, 0.75), (0.5, 0.5), (1.5, 0.0), (-1.0, 1.0)])
def test_ramp_slows_down_as_the_hinge_falls_behind_what_it_must_carry(bench, behind, share):
    """By the slack's share: at half of it half as fast, at all of it not at all; and never faster than its rate."""
    p, kept = bench.told["act"]["uav"][0], bench.kept["act"]
    kept["hover"], kept["thrust"], bench.e["thrust"] = 5.0, 4.0, 3.0
    bench.e["hinge_force"][0, 2] = 0.4 * p["weight"] - behind * p["force_slack"]
    down = 4.0 - as_uav(bench, "ramp", share=0.5, link=LINK.index("held"))
    assert down == pytest.approx(share * p["thrust_rate"] * 1e-3)


@pytest.mark.parametrize(("link", "thrust", "step"), [("held", 1.0, 1.0), ("landed", 4.0, -1.0)])
def test_ramp_upwards_and_one_that_nobody_must_take_over_wait_for_nothing(bench, link, thrust, step):
    p, kept = bench.told["act"]["uav"][0], bench.kept["act"]
    kept["hover"], kept["thrust"], bench.e["thrust"], bench.e["hinge_force"] = 5.0, thrust, 3.0, -50.0
    gained = as_uav(bench, "ramp", share=0.5, link=LINK.index(link)) - thrust
    assert gained == pytest.approx(step * p["thrust_rate"] * 1e-3)


def test_ramp_ends_where_its_share_says_and_stays_there(bench):
    kept = bench.kept["act"]
    kept["hover"], kept["thrust"] = 5.0, 2.5001
    assert as_uav(bench, "ramp", ticks=50, share=0.5, link=LINK.index("landed")) == 2.5


@pytest.mark.parametrize(("share", "above", "off"), [(0.0, -0.001, True), (0.0, 0.5, False), (0.01, -0.001, False)])
def test_rotors_stop_only_at_the_end_of_a_ramp_to_nothing(bench, share, above, off):
    bench.kept["act"]["thrust"] = bench.told["act"]["uav"]["thrust_min"] + above
    thrust = as_uav(bench, "ramp", share=share, link=LINK.index("landed"))
    assert (bench.c["uav_mode"][0] == UavMode.OFF) == off
    assert (thrust == 0.0) == off


@pytest.mark.parametrize(("force", "step"), [(0.5, None), (100.0, 1.0), (-100.0, -1.0)])
def test_thrust_that_frees_the_hinge_changes_no_faster_than_a_ramp(bench, force, step):
    p = bench.told["act"]["uav"][0]
    bench.kept["act"]["thrust"], bench.e["hinge_force"][0, 2] = 4.0, force
    wanted = (p["balance_rate"] * force if step is None else step * p["thrust_rate"]) * 1e-3
    assert as_uav(bench, "balance") - 4.0 == pytest.approx(wanted)


def test_thrust_that_frees_the_hinge_stays_within_what_the_rotors_give(bench):
    p, kept = bench.told["act"]["uav"][0], bench.kept["act"]
    for force, bound in ((100.0, "thrust_max"), (-100.0, "thrust_min")):
        kept["thrust"], bench.e["hinge_force"][0, 2] = p[bound], force
        assert as_uav(bench, "balance") == p[bound]


def test_thrust_that_carries_the_weight_is_learnt_with_its_time_constant(bench):
    """One period of 5 ms behind 1 s: of what the integral says beyond what was known, 0.5 %."""
    at_station(bench)
    kept, p = bench.kept["act"], bench.told["act"]["uav"][0]
    kept["hover"], kept["integral"] = 4.0, [0.0, 0.0, 0.5]
    ask(bench, "guide")
    wanted = p["mass"] * (9.81 + kept["integral"][0, 2])
    assert kept["hover"][0] - 4.0 == pytest.approx(0.005 / p["hover_s"] * (wanted - 4.0), rel=1e-9)


def test_uav_that_comes_nearer_is_braked_in_time(bench):
    """Towards its station at the speed that is wanted of it, it is left alone; faster, it is tilted back."""
    p, leans = bench.told["act"]["uav"][0], {}
    # By the time the command acts it is that much nearer: v = k (d − v T).
    late = bench.kept["estimate"]["uplink"][0] * 1e-3
    wanted = p["k_position"] * 0.1 / (1.0 + p["k_position"] * late)
    assert late > 0.0
    for speed in (wanted, 0.3):
        at_station(bench, (-0.1, 0.0, 0.0))
        bench.e["plate_v"], bench.kept["act"]["integral"] = [speed, 0.0, 0.0], 0.0
        ask(bench, "guide")
        leans[speed] = axis_of(bench)[0]
    assert leans[wanted] == pytest.approx(0.0, abs=1e-9)
    assert leans[0.3] < -0.01


def test_station_is_kept_against_the_decks_own_acceleration(bench):
    """On a deck that accelerates along x the UAV must lean forwards by a/g to stay above its place."""
    bench.board["environment"]["base_a"] = [0.8, 0.0, 0.0]
    at_station(bench)
    ask(bench, "guide")
    axis = axis_of(bench)
    assert axis[0] / axis[2] == pytest.approx(0.8 / 9.81)


def hovering_alone(bench, seconds, gives=1.0, lift=(0.0, 0.0, 1.0), sees=True):
    """A UAV that hovers by itself with rotors that give `gives` of what they are asked for, its body's z axis along `lift`."""
    p = bench.told["act"]["uav"]
    turn = np.cross([0.0, 0.0, 1.0], lift)
    bench.e["quat"][0] = from_rotation_vector(turn)
    for _ in range(round(seconds * 1000)):
        if bench.m["tick"] % 5 == 0 and sees:
            bench.m["uav_tick"] = bench.m["tick"]
            bench.m["uav_rotors"][0, :4] = 0.25 * p["weight"] / gives
        as_uav(bench, "autonomous")


def test_trim_of_a_uav_that_hovers_in_w_knows_nothing_of_the_decks_acceleration(bench):
    bench.board["environment"]["moves"], bench.board["environment"]["base_a"] = 1, [0.4, -0.3, 0.7]
    hovering_alone(bench, 1.0, 1.0)
    np.testing.assert_allclose(bench.kept["act"]["trim"][0], 0.0, atol=1e-9)


@pytest.mark.parametrize("gives", [0.8, 0.9, 1.0, 1.1])
def test_thrust_that_a_uav_asks_for_by_itself_tells_what_its_rotors_really_give(bench, gives):
    """A UAV that hovers asks for weight/gives: so much carries the weight, whatever the belief says."""
    weight = bench.told["act"]["uav"]["weight"][0]
    bench.kept["act"]["hover"] = weight
    hovering_alone(bench, 1.0, gives)
    assert bench.kept["act"]["hover"][0] == pytest.approx(weight / gives, rel=1e-9)
    assert bench.kept["act"]["trim"][0, 2] == pytest.approx(9.81 * (1.0 / gives - 1.0), rel=1e-6, abs=1e-9)
    # And so much it is asked for.
    assert as_uav(bench, "autonomous") == bench.kept["act"]["hover"][0]


def test_trim_follows_a_change_with_its_time_constant(bench):
    weight = bench.told["act"]["uav"]["weight"][0]
    hovering_alone(bench, 1.0, 1.0)
    hovering_alone(bench, 0.4, 0.8)
    learnt = (bench.kept["act"]["hover"][0] / weight - 1.0) / 0.25
    assert learnt == pytest.approx(1.0 - np.exp(-1.0), abs=0.01)


def test_trim_holds_what_leans_the_uav_sideways(bench):
    """Thrust along R z less gravity is what wind and wrong tilt are held with: here 0.05 of gravity along x."""
    hovering_alone(bench, 1.0, lift=(0.05, 0.0, 1.0))
    np.testing.assert_allclose(bench.kept["act"]["trim"][0, :2], [9.81 * np.sin(0.05), 0.0], atol=1e-3)


@pytest.mark.parametrize("why", ["not yet alone", "stands on the ground", "is silent"])
def test_trim_is_not_learnt_of_a_uav_that_does_not_hover(bench, why):
    bench.kept["act"]["hover"] = 4.0
    if why == "not yet alone":
        hovering_alone(bench, 0.15, 0.8)
    elif why == "stands on the ground":
        hovering_alone(bench, 1.0, 4.0)
    else:
        bench.m["uav_rotors"], bench.m["uav_tick"] = 1.0, 0
        hovering_alone(bench, 1.0, sees=False)
    assert bench.kept["act"]["hover"][0] == 4.0


def sag(bench, gives, seconds=3.0):
    """How far a UAV sinks below its station, and how far it is thrown above it, that the ground takes over at rest there; m."""
    p, dt = bench.told["act"]["uav"], 1e-3
    bench.kept["estimate"]["uplink"] = 0.0
    bench.e["quat"][0], bench.e["plate"], bench.e["plate_v"] = LEVEL, p["station"][0], 0.0
    z, v, path = 0.0, 0.0, []
    for _ in range(round(seconds / dt)):
        thrust = as_uav(bench, "station")
        v += (gives * thrust / p["mass"][0] - 9.81) * dt
        z += v * dt
        bench.e["plate"][0, 2], bench.e["plate_v"][0, 2] = p["station"][0, 2] + z, v
        path.append(z)
    return -min(path), max(path)


@pytest.mark.parametrize("gives", [0.8, 0.85, 0.9, 1.1])
def test_uav_that_is_taken_over_neither_sags_nor_leaps(bench, gives):
    """Within 1 mm of its station; what was not learnt, or not taken over, sags by centimetres (below)."""
    hovering_alone(bench, 1.0, gives)
    assert max(sag(bench, gives)) < 1e-3


@pytest.mark.parametrize("gives", [0.8, 0.85, 0.9])
def test_uav_of_which_nothing_was_learnt_sags(bench, gives):
    """Negative control: at (1 − gives) g/(k_p k_v) it would rest without the integral, which wins part of it back meanwhile."""
    p = bench.told["act"]["uav"][0]
    rest = (1.0 - gives) * 9.81 / gives / (p["k_position"] * p["k_velocity"])
    down, _ = sag(bench, gives)
    assert 0.3 * rest < down < 1.1 * rest
    assert down > 0.03


def test_trim_is_taken_over_once_and_within_the_integrals_bound(bench):
    """In the first tick after its own hover; from then on the station keeping's integral is its own."""
    p, kept = bench.told["act"]["uav"][0], bench.kept["act"]
    hovering_alone(bench, 1.0)
    kept["trim"] = [0.5, -100.0, 100.0]
    at_station(bench)
    as_uav(bench, "station")
    np.testing.assert_allclose(kept["integral"][0], [0.5, -p["integral_max"], p["integral_max"]], rtol=0.01)
    assert kept["alone"][0] == 0
    kept["integral"] = 0.0
    as_uav(bench, "station", ticks=7)
    assert np.abs(kept["integral"]).max() < 0.01


@pytest.mark.parametrize(("bias", "held"), [(0.5, 0.5), (-0.5, -0.5), (50.0, None)])
def test_gust_that_the_plates_filter_sees_is_leaned_against(bench, bias, held):
    """By its share of the acceleration that the filter misses, and never by more than its bound."""
    p = bench.told["act"]["uav"][0]
    at_station(bench)
    bench.kept["estimate"]["plate"]["bias"][0, 0] = bias
    ask(bench, "guide")
    wanted = p["gust_max"] if held is None else p["gust_share"] * held
    axis = axis_of(bench)
    assert p["gust_share"] > 0.0
    assert -axis[0] / axis[2] * 9.81 == pytest.approx(wanted, rel=0.02)


def test_uav_is_steered_by_where_it_will_be_when_the_command_arrives(bench):
    """Coming nearer by uplink × speed: as if it were there, at the speed that it will have; the acceleration counts to its bound."""
    p, kept = bench.told["act"]["uav"][0], bench.kept["estimate"]
    axes = {}
    for name, uplink, away, speed, push in (
        ("now", 0.0, 0.1, 0.0, 0.0),
        ("soon", 100.0, 0.1 - 0.02, 0.2, 0.0),
        ("there", 0.0, 0.1, 0.2, 0.0),
        ("pushed", 100.0, 0.1 - 0.5 * p["coming_max"] * 0.01, 0.0, 1e3),
        ("bound", 0.0, 0.1, 0.1 * p["coming_max"], 0.0),
    ):
        at_station(bench, (away, 0.0, 0.0))
        kept["uplink"], bench.kept["act"]["integral"] = uplink, 0.0
        bench.e["plate_v"][0, 0], bench.e["plate_a"][0, 0] = speed, push
        ask(bench, "guide")
        axes[name] = axis_of(bench)
    np.testing.assert_allclose(axes["soon"], axes["there"], atol=1e-9)
    np.testing.assert_allclose(axes["pushed"], axes["bound"], atol=1e-9)
    assert not np.allclose(axes["soon"], axes["now"], atol=1e-3)


@pytest.mark.parametrize(("age", "mode"), [(0.45, "GUIDED"), (0.55, "AUTONOMOUS")])
def test_uav_that_left_the_cameras_view_is_guided_by_reckoning_for_a_while(bench, age, mode):
    at_station(bench)
    bench.e["plate_age"], bench.e["plate_valid"] = age, 0
    ask(bench, "guide")
    assert bench.c["uav_mode"][0] == getattr(UavMode, mode)


@pytest.mark.parametrize(("age", "left"), [(0.1, 1.0), (0.25, np.exp(-1.0)), (0.45, np.exp(-3.0))])
def test_a_gust_that_no_image_has_shown_lately_is_forgotten(bench, age, left):
    # Its remainder, by the lean that is asked for against it.
    leans = []
    for bias in (0.5, 0.0):
        at_station(bench)
        bench.kept["act"]["integral"] = bench.e["plate_v"] = 0.0
        bench.kept["estimate"]["plate"]["bias"][0, 0], bench.e["plate_age"] = bias, age
        ask(bench, "guide")
        leans.append(axis_of(bench)[0])
    assert leans[0] - leans[1] == pytest.approx(-0.5 * left / 9.81, rel=0.02)


@pytest.mark.parametrize("wind", [1.5, -1.5])
def test_wind_is_not_held_against_twice_by_a_uav_that_the_hinge_lets_go(bench, wind):
    """On the hinge it leans against the wind, free of force, and the pose filter sees one that leans and does not move."""
    axes = {}
    for freed in (1, 0):
        at_station(bench)
        kept = bench.kept["act"]
        kept["alone"], kept["freed"], kept["integral"] = 0, freed, 0.0
        kept["integral"][0, 0] = -wind
        bench.kept["estimate"]["plate"]["bias"][0, 0] = wind
        as_uav(bench, "station")
        axes[freed] = axis_of(bench)
        assert kept["freed"][0] == 0
    assert axes[1][0] / axes[1][2] * 9.81 == pytest.approx(-wind, rel=0.03)
    # Negative control: it would lean twice as far.
    assert axes[0][0] / axes[0][2] * 9.81 == pytest.approx(-2.0 * wind, rel=0.05)


@pytest.mark.parametrize("wind", [0.4, -0.4])
def test_wind_is_not_held_against_twice_when_a_uav_is_taken_over(bench, wind):
    """Trim −d by its own hover, of which the pose filter's share is cancelled beside the integral: the sum stays the trim."""
    p, kept = bench.told["act"]["uav"][0], bench.kept["act"]
    hovering_alone(bench, 1.0)
    kept["trim"] = [-wind, 0.0, 0.0]
    bench.kept["estimate"]["plate"]["bias"][0, 0] = wind
    at_station(bench)
    as_uav(bench, "station")
    assert kept["integral"][0, 0] == pytest.approx(-wind + p["gust_share"] * wind, rel=1e-3)
    axis = axis_of(bench)
    assert axis[0] / axis[2] * 9.81 == pytest.approx(-wind, rel=5e-3)


@pytest.mark.parametrize("force", [(0.5, 0.0), (0.0, -0.5), (20.0, 0.0)])
def test_hinge_is_freed_of_sideways_force_by_leaning_along_it(bench, force):
    """The arm holds the UAV by `force`: it leans that way until it holds itself, and by no more than its bound."""
    bench.e["hinge_force"][0, :2], p = force, bench.told["act"]["uav"][0]
    as_uav(bench, "balance", ticks=100)
    wanted = np.clip(p["balance_rate"] * np.array(force) / p["mass"] * 0.1, -LEANT_MPS2, LEANT_MPS2)
    axis = axis_of(bench)
    np.testing.assert_allclose(axis[:2] / axis[2] * 9.81, wanted, rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(bench.kept["act"]["integral"][0, :2], wanted, rtol=1e-9, atol=1e-12)


def caught(bench, loss, seconds, zero=0.0, bias=0.0):
    """A UAV on the magnet whose rotors give less by `loss`, the force sensor off by `zero`, N; returns the hover thrust learnt, N."""
    kept, weight = bench.kept["act"], bench.told["act"]["uav"]["weight"][0]
    kept["hover"] = kept["thrust"] = weight
    bench.kept["estimate"]["weight"], bench.kept["decide"]["begin"] = weight, bench.m["tick"][0]
    bench.kept["estimate"]["plate"]["bias"][0, 2] = bias
    for _ in range(round(1e3 * seconds)):
        bench.e["thrust"] = kept["thrust"]
        bench.e["hinge_force"][0, 2] = weight - (1.0 - loss) * kept["thrust"][0] + zero
        ask(bench, "capture")
    return float(kept["hover"][0])


@pytest.mark.parametrize("loss", [0.1, 0.15, 0.3])
def test_thrust_that_is_missing_is_felt_by_the_arm_below_a_caught_uav(bench, loss):
    """T_h = W / (1 − loss): then the pull of the rotors can be tested, and a UAV that is let go keeps its height."""
    weight = bench.told["act"]["uav"]["weight"][0]
    assert caught(bench, loss, CAUGHT_S + 1.2) == pytest.approx(weight / (1.0 - loss), rel=0.01)
    assert bench.kept["act"]["integral"][0, 2] == pytest.approx(
        (bench.kept["act"]["hover"][0] - weight) / bench.told["act"]["uav"]["mass"][0], rel=1e-3
    )


@pytest.mark.parametrize("zero", [-0.5, 0.2])
def test_healthy_uav_is_not_thought_weak_by_a_drifting_sensor(bench, zero):
    weight = bench.told["act"]["uav"]["weight"][0]
    assert abs(zero) < bench.told["act"]["uav"]["shortfall"][0] or zero < 0.0
    assert caught(bench, 0.0, CAUGHT_S + 1.2, zero) == weight


def test_what_the_filter_saw_before_the_catch_counts_at_once(bench):
    weight, mass = (bench.told["act"]["uav"][name][0] for name in ("weight", "mass"))
    assert caught(bench, 0.0, 0.001, bias=-1.0) == pytest.approx(weight + mass)
    bench.kept["act"]["integral"] = 0.0
    assert caught(bench, 0.0, 0.001, bias=-0.3) == weight


def test_what_a_drifting_sensor_says_is_forgotten_at_the_let_go(bench):
    """Its zero never comes to rest, so what is learnt of it never does."""
    weight = bench.told["act"]["uav"]["weight"][0]
    caught(bench, 0.0, CAUGHT_S)
    for k in range(1200):
        kept = bench.kept["act"]
        bench.e["thrust"], bench.e["hinge_force"][0, 2] = kept["thrust"], weight - kept["thrust"][0] + 6e-3 * k
        ask(bench, "capture")
    assert kept["hover"][0] > 1.2 * weight
    ask(bench, "miss")
    assert kept["hover"][0] == pytest.approx(weight, rel=0.03)


@pytest.mark.parametrize(("phase", "stands"), [("carry", True), ("guide", False)])
def test_uav_on_the_arm_is_held_at_the_decks_level_of_when_it_answers(bench, phase, stands):
    """(K.4) of a deck that rolls at 0.5 rad/s and 2 rad/s², slow enough to be followed: ω τ + ½ ω̇ τ² from where it is.

    One that flies points its thrust in W, whatever the deck does meanwhile.
    """
    environment, lag = bench.board["environment"], bench.told["act"]["uav"]["lags"][0, 0]
    at_station(bench)
    environment["moves"], environment["base_quat"][0] = 1, [1.0, 0.0, 0.0, 0.0]
    environment["base_omega"], environment["base_alpha"] = [0.5, 0.0, 0.0], [2.0, 0.0, 0.0]
    bench.kept["act"]["ride"]["share"], bench.kept["act"]["ride"]["mean"] = 1.0, [1.0, 0.0, 0.0, 0.0]
    ask(bench, phase)
    level = multiply(bench.c["uav_quat"][0], conjugate(bench.kept["act"]["q_d"][0]))
    turn = np.array([0.5 * lag + lag**2, 0.0, 0.0]) if stands else np.zeros(3)
    np.testing.assert_allclose(level, from_rotation_vector(turn), atol=1e-9)
