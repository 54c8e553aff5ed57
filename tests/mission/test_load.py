"""Hinge force without the tool, and the disturbance that the momentum of the held UAV shows."""

import numpy as np
import pytest

from armland.mission.load import estimate_load, feel_nod, observe, weigh
from armland.rotations import from_rotation_vector, matrix

TURN = np.array([0.2, -0.1, 0.4])


def reading(bench, force, acceleration):
    """The sensor's reading (6,) when the end effector puts `force` (3,), N, deck, on the UAV while the tool accelerates."""
    tool, R = bench.plan.scenario.tool, bench.board["arm"]["rotation"][0]
    tool_force = R.T @ (tool.tool_mass_kg * (acceleration + np.array([0.0, 0.0, 9.81])))
    on_uav = R.T @ force
    torque = np.cross([0.0, 0.0, tool.tool_com_m], tool_force)
    return np.concatenate([tool_force + on_uav, torque])


@pytest.mark.parametrize("follows", [0.0, 1.0])
def test_tool_is_taken_off_the_reading_with_its_inertia_where_it_follows(bench, follows):
    force, a = np.array([1.0, -2.0, 3.0]), np.array([0.5, 0.2, -0.4])
    bench.board["arm"]["rotation"] = matrix(from_rotation_vector(TURN))
    bench.told["estimate"]["tool_follows"], bench.kept["refer"]["a"] = follows, a
    bench.m["wrench"] = reading(bench, force, a)
    estimate_load(False, True, 0.0, bench.b)
    missed = (1.0 - follows) * bench.plan.scenario.tool.tool_mass_kg * a
    np.testing.assert_allclose(bench.e["hinge_force"][0], force + missed, atol=1e-12)


def test_force_that_is_too_old_gives_way_to_nothing(bench):
    bench.m["wrench"] = reading(bench, np.array([1.0, -2.0, 3.0]), np.zeros(3))
    bench.m["wrench_tick"] = 1000 - bench.told["estimate"]["wrench_age"][0] - 1
    estimate_load(False, True, 0.0, bench.b)
    np.testing.assert_array_equal(bench.e["hinge_force"], 0.0)


def test_shares_of_arm_rotors_and_ground_add_up(bench):
    weight = bench.told["estimate"]["weight"][0]
    bench.e["thrust"] = 0.5 * weight
    bench.m["wrench"] = reading(bench, np.array([0.0, 0.0, 0.3 * weight]), np.zeros(3))
    estimate_load(False, True, 0.0, bench.b)
    assert bench.e["arm_share"][0] == pytest.approx(0.3)
    assert bench.e["ground_share"][0] == pytest.approx(0.2)


def push_held_uav(bench, force, seconds, learns=True):
    """A held UAV under a constant `force` (3,), N, while arm and rotors give what the controller believes; its estimate of it."""
    p, mass = bench.told["estimate"], bench.told["estimate"]["body_mass"][0]
    bench.e["thrust"], bench.kept["act"]["force"] = 2.0, [0.3, -0.2, 2.4]
    a = (bench.kept["act"]["force"][0] + [0.0, 0.0, 2.0] + force) / mass + [0.0, 0.0, -9.81]
    for _ in range(round(seconds * 1000)):
        bench.e["v"][0] += a * p["tick_s"][0]
        observe(bench.b, learns)
    return bench.e["disturbance"][0].copy()


def test_observer_finds_a_constant_force_in_its_own_time(bench):
    force = np.array([0.5, -0.3, 0.2])
    bandwidth = bench.plan.scenario.estimation.load_observer_rad_s
    np.testing.assert_allclose(push_held_uav(bench, force, 1.0 / bandwidth), force * (1.0 - np.exp(-1.0)), rtol=0.02)
    np.testing.assert_allclose(push_held_uav(bench, force, 6.0 / bandwidth), force, rtol=0.01)


def test_observer_that_may_not_learn_keeps_what_it_knows(bench):
    bench.kept["estimate"]["observer"]["force"] = 0.1
    np.testing.assert_array_equal(push_held_uav(bench, np.array([0.5, 0.0, 0.0]), 0.3, learns=False), 0.1)
    # What was missed meanwhile is not caught up on.
    assert push_held_uav(bench, np.zeros(3), 0.001)[0] == pytest.approx(0.1, rel=0.05)


def test_no_disturbance_is_none(bench):
    np.testing.assert_allclose(push_held_uav(bench, np.zeros(3), 0.5), 0.0, atol=1e-9)


def test_velocity_of_the_centre_of_mass_counts_and_not_the_pivots(bench):
    """A UAV that swings about a pivot at rest: its momentum changes by ω × ω × ρ, which the model must not take for a force."""
    rate, lever, dt = 2.0, bench.told["estimate"]["lever"][0], 1e-3
    bench.e["omega"] = [rate, 0.0, 0.0]
    mass = bench.told["estimate"]["body_mass"][0]
    for k in range(200):
        R = matrix(from_rotation_vector(np.array([rate * k * dt, 0.0, 0.0])))
        bench.e["quat"][0] = from_rotation_vector(np.array([rate * k * dt, 0.0, 0.0]))
        omega = np.array([rate, 0.0, 0.0])
        # Pivot at rest: the centre of mass is accelerated by −R ω × (ω × ρ).
        a = -R @ np.cross(omega, np.cross(omega, lever))
        bench.e["thrust"], bench.kept["act"]["force"] = 0.0, mass * (a + [0.0, 0.0, 9.81])
        observe(bench.b, True)
    np.testing.assert_allclose(bench.e["disturbance"][0], 0.0, atol=2e-3)


@pytest.mark.parametrize("turn", [(0.5, 0.0, 0.0), (0.0, -0.5, 0.0), (0.3, 0.4, 0.0)])
def test_tilted_rotors_carry_what_of_their_thrust_is_vertical(bench, turn):
    weight = bench.told["estimate"]["weight"][0]
    R = matrix(from_rotation_vector(np.array(turn)))
    bench.e["quat"][0], bench.e["thrust"] = from_rotation_vector(np.array(turn)), 0.5 * weight
    bench.m["wrench"] = reading(bench, np.zeros(3), np.zeros(3))
    estimate_load(False, True, 0.0, bench.b)
    assert bench.e["ground_share"][0] == pytest.approx(1.0 - 0.5 * R[2, 2], rel=1e-9)


def test_tool_on_a_deck_that_accelerates_pulls_at_its_sensor(bench):
    """The deck falls away at 2 m/s² and goes sideways: the tool's weight on it is that much less."""
    deck = np.array([0.5, -0.3, -2.0])
    bench.board["environment"]["base_a"] = deck
    bench.told["estimate"]["tool_follows"] = 0.0
    bench.m["wrench"] = reading(bench, np.array([1.0, 2.0, 3.0]), deck)
    estimate_load(False, True, 0.0, bench.b)
    np.testing.assert_allclose(bench.e["hinge_force"][0], [1.0, 2.0, 3.0], atol=1e-9)


def test_force_is_believed_up_to_its_age(bench):
    bench.m["wrench"] = reading(bench, np.array([1.0, -2.0, 3.0]), np.zeros(3))
    bench.m["wrench_tick"] = 1000 - bench.told["estimate"]["wrench_age"][0]
    estimate_load(False, True, 0.0, bench.b)
    np.testing.assert_allclose(bench.e["hinge_force"][0], [1.0, -2.0, 3.0], atol=1e-9)


def test_bias_is_learnt_where_the_end_effector_is_free_and_only_there(bench):
    blocks = {}
    for free in (False, True):
        bench.kept["estimate"]["wrench"] = 0
        bench.m["wrench"] = reading(bench, np.array([0.3, 0.0, 0.0]), np.zeros(3))
        bench.told["estimate"]["wrench"]["block"] = 5
        for _ in range(20):
            estimate_load(free, False, 0.0, bench.b)
        blocks[free] = int(bench.kept["estimate"]["wrench"]["blocks"][0])
    assert blocks == {False: 0, True: 3}


def test_release_needs_a_magnet_that_is_off_and_a_retreat(bench):
    for magnet, retreat, released in ((True, 1.0, 0), (False, 0.0, 0), (False, 1.0, 1)):
        bench.kept["estimate"]["contact"] = 0
        bench.m["wrench"] = reading(bench, np.zeros(3), np.zeros(3))
        bench.told["estimate"]["contact"]["release"]["off_ticks"] = 3
        for _ in range(10):
            estimate_load(False, magnet, retreat, bench.b)
        assert bench.kept["estimate"]["load"]["released"][0] == released, (magnet, retreat)


def test_gravity_that_the_observer_knows_is_that_at_the_centre_of_mass(bench):
    """On a deck that turns at ω about z the outward pull ω² r is that of the centre of mass, a lever's length above the pivot."""
    lever, spin, mass = bench.told["estimate"]["lever"][0], 3.0, bench.told["estimate"]["body_mass"][0]
    bench.board["environment"]["base_omega"] = [spin, 0.0, 0.0]
    bench.e["r"], bench.e["v"] = [0.4, 0.3, 0.8], 0.0
    centre = bench.e["r"][0] - lever
    pull = spin**2 * np.array([0.0, centre[1], centre[2]])
    # At rest on the deck: arm and rotors hold it against weight and pull.
    bench.e["thrust"], bench.kept["act"]["force"] = 2.0, -mass * (pull + [0.0, 0.0, -9.81]) - [0.0, 0.0, 2.0]
    for _ in range(30):
        observe(bench.b, True)
    np.testing.assert_allclose(bench.e["disturbance"][0], 0.0, atol=1e-9)


def weighed(bench, real, rotors, seconds, force=None):
    """Weight that is found, as a share of the believed, of a UAV that weighs `real` of it and hangs with `rotors` of it carried."""
    p, s = bench.told["estimate"], bench.kept["estimate"]
    weight = p["weight"][0]
    for _ in range(round(seconds * 1000)):
        weigh(real * weight * (1.0 - rotors) if force is None else force, rotors, p[0], s[0])
    return s["weight"][0] / weight


@pytest.mark.parametrize("real", [0.8, 0.93, 1.0, 1.2])
@pytest.mark.parametrize("rotors", [0.0, 0.5])
def test_weight_of_the_held_uav_is_found(bench, real, rotors):
    """F/(1 − share of the rotors), within e⁻⁵ of the difference after five time constants of 0.3 s."""
    assert weighed(bench, real, rotors, 1.5) == pytest.approx(real, abs=1.1 * np.exp(-5.0) * abs(real - 1.0) + 1e-9)


def test_weight_is_found_with_its_time_constant(bench):
    assert weighed(bench, 1.2, 0.5, 0.3) - 1.0 == pytest.approx(0.2 * (1.0 - np.exp(-1.0)), rel=5e-3)


@pytest.mark.parametrize(("real", "rotors"), [(0.0, 0.0), (0.5, 0.0), (1.5, 0.5), (1.2, 0.8)])
def test_lost_load_blow_or_uav_that_flies_is_no_weight(bench, real, rotors):
    """Of a lost load the force is nothing, of a blow too much; where rotors carry most, what is left says nothing."""
    assert weighed(bench, real, rotors, 3.0) == 1.0


def test_weight_that_was_found_stays_when_the_load_is_lost(bench):
    found = weighed(bench, 1.2, 0.5, 3.0)
    assert weighed(bench, 0.0, 0.5, 3.0) == found


@pytest.mark.parametrize(
    ("phase", "height", "fresh", "learns"),
    [
        ("carry", 0.1, True, True),
        ("hand_over", 0.1, True, True),
        ("carry", -0.01, True, False),
        ("carry", 0.1, False, False),
        ("guide", 0.1, True, False),
        ("set_down", 0.1, True, False),
    ],
)
def test_weight_is_learnt_only_where_the_uav_hangs_clear_of_the_cradle(bench, phase, height, fresh, learns):
    weight = bench.told["estimate"]["weight"][0]
    bench.enter(phase)
    bench.kept["act"]["hover"], bench.e["thrust"] = weight, 0.5 * weight
    bench.e["r"][0, 2] = bench.told["decide"]["clear_z"][0] + height
    bench.m["wrench"] = reading(bench, np.array([0.0, 0.0, 0.6 * weight]), np.zeros(3))
    if not fresh:
        bench.m["wrench_tick"] -= bench.told["estimate"]["wrench_age"][0] + 1
    estimate_load(False, True, 0.0, bench.b)
    assert (bench.kept["estimate"]["weight"][0] > weight) == learns


def test_share_of_the_rotors_counts_by_what_really_carries_the_weight(bench):
    """Rotors that give 80 % are asked for weight/0.8 in hover: half of that carries half of it and not 0.62."""
    weight = bench.told["estimate"]["weight"][0]
    bench.kept["act"]["hover"], bench.e["thrust"] = weight / 0.8, 0.5 * weight / 0.8
    bench.m["wrench"] = reading(bench, np.array([0.0, 0.0, 0.5 * weight]), np.zeros(3))
    estimate_load(False, True, 0.0, bench.b)
    assert bench.e["ground_share"][0] == pytest.approx(0.0, abs=1e-9)


def nodded(bench, gain, bias=(0.0, 0.0, 0.0), noise=0.0):
    """Force found over force expected (3,) after a nod, of a sensor with `gain` and `bias`, N, W, on a turned tool."""
    rng, mass = np.random.default_rng(1), bench.told["estimate"]["wrench"]["mass"][0]
    R = matrix(from_rotation_vector(TURN))
    bench.board["arm"]["rotation"] = R
    for k in range(500):
        a = np.array([1.5, 1.2, 1.8]) * np.sin(2.0 * np.pi * k / 500)
        bench.kept["refer"]["a"] = a
        force = gain * mass * (a + [0.0, 0.0, 9.81]) + bias
        bench.m["wrench"][0, :3] = R.T @ force + noise * rng.standard_normal(3)
        feel_nod(bench.m[0], bench.b)
    return bench.kept["estimate"]["nod"]["gain"][0].copy()


@pytest.mark.parametrize("gain", [1.0, 0.0, -1.0, 1.6])
def test_nod_tells_the_gain_of_the_force_sensor_whatever_its_bias(bench, gain):
    np.testing.assert_allclose(nodded(bench, gain, bias=(3.0, -2.0, 1.0)), gain, atol=1e-6)


@pytest.mark.parametrize("known", [1, 0])
def test_nod_on_a_moving_deck_weighs_the_tool_and_not_the_deck(bench, known):
    """The deck surges and heaves with the nod's own period: unknown, its acceleration would count as the tool's."""
    rng, mass = np.random.default_rng(1), bench.told["estimate"]["wrench"]["mass"][0]
    bench.board["environment"]["moves"] = known
    for k in range(500):
        swing = np.sin(2.0 * np.pi * k / 500)
        a, deck = np.array([1.5, 1.2, 1.8]) * swing, np.array([0.9, -0.8, 1.1]) * swing
        bench.kept["refer"]["a"], bench.board["environment"]["base_a"] = a, deck
        bench.m["wrench"][0, :3] = bench.board["arm"]["rotation"][0].T @ (mass * (a + deck + [0.0, 0.0, 9.81]))
        bench.m["wrench"][0, :3] += 0.01 * rng.standard_normal(3)
        feel_nod(bench.m[0], bench.b)
    apart = np.abs(bench.kept["estimate"]["nod"]["gain"][0] - 1.0)
    assert (apart < 0.02).all() if known else (apart > 0.5).all()


@pytest.mark.parametrize("share", [1.0, 0.4, 0.0])
def test_nod_tells_the_share_of_itself_that_the_arm_made(bench, share):
    for k in range(500):
        v = np.array([0.05, 0.04, -0.06]) * np.sin(4.0 * np.pi * k / 500)
        bench.kept["refer"]["v"], bench.e["v"] = v, share * v
        feel_nod(bench.m[0], bench.b)
    np.testing.assert_allclose(bench.kept["estimate"]["nod"]["followed"][0], share, atol=1e-9)


def test_noise_of_the_force_sensor_leaves_its_gain_within_the_slopes_error(bench):
    """σ/(m √Σa²), with Σa² = 250 A² of the sines: five of them."""
    error = 0.05 / (bench.told["estimate"]["wrench"]["mass"][0] * np.sqrt(250.0) * np.array([1.5, 1.2, 1.8]))
    found = nodded(bench, 1.0, noise=0.05)
    assert (np.abs(found - 1.0) < 5.0 * error).all()
    assert (error < 0.01).all()


def test_force_is_averaged_where_it_is_waited_for(bench):
    """A step of force comes through with the time constant; jitter about it is left out; without one the force is taken as it is."""
    known, force = bench.kept["estimate"]["calm"], np.array([1.0, -2.0, 3.0])
    bench.m["wrench"] = reading(bench, force, np.zeros(3))
    estimate_load(False, True, 0.0, bench.b)
    np.testing.assert_array_equal(known, bench.e["hinge_force"])
    known[:], bench.told["estimate"]["calm_gain"] = 0.0, 1.0 - np.exp(-0.01)
    for k in range(300):
        bench.m["wrench"] = reading(bench, force + 5.0 * np.sin(0.1 * 2.0 * np.pi * k), np.zeros(3))
        estimate_load(False, True, 0.0, bench.b)
    np.testing.assert_allclose(known[0], force * (1.0 - np.exp(-3.0)), atol=0.1)


def lifting(bench, gives, share, seconds):
    """The command that is thought to carry the weight, over what does; in wind, where rotors give `gives` of what they are asked."""
    weight, hover = bench.told["estimate"]["weight"][0], bench.kept["act"]["hover"]
    bench.told["estimate"]["windy"] = 1
    bench.enter("carry")
    bench.e["thrust"], hover[0] = share * weight, weight
    bench.e["r"][0, 2] = bench.told["decide"]["clear_z"][0] + 0.1
    bench.m["wrench"] = reading(bench, np.array([0.0, 0.0, (1.0 - share * gives) * weight]), np.zeros(3))
    for _ in range(round(1000 * seconds)):
        estimate_load(False, True, 0.0, bench.b)
    return hover[0] * gives / weight


@pytest.mark.parametrize("gives", [0.85, 1.0, 1.4])
def test_in_wind_the_hinge_says_what_the_rotors_make_of_a_command_and_the_weight_stays(bench, gives):
    """Then load and thrust explain the hinge's force, and nobody else carries. Negative control: before, they do not."""
    weight = bench.told["estimate"]["weight"][0]
    assert lifting(bench, gives, 0.5, 3.0) == pytest.approx(1.0, abs=1e-3)
    assert bench.kept["estimate"]["weight"][0] == weight
    assert bench.e["ground_share"][0] == pytest.approx(0.0, abs=2e-3)
    if gives != 1.0:
        assert abs(lifting(bench, gives, 0.5, 0.01) - 1.0) > 0.1


@pytest.mark.parametrize(("gives", "share"), [(1.0, 0.2), (0.3, 0.6)])
def test_rotors_that_hardly_turn_or_lift_say_nothing_of_a_command(bench, gives, share):
    assert lifting(bench, gives, share, 1.0) == pytest.approx(gives)


@pytest.mark.parametrize("falls", [0.0, 0.8])
def test_deck_that_falls_away_is_no_cradle_that_carries(bench, falls):
    """Of a UAV at rest on a hull that falls with 0.8 m/s² the arm carries m (g − 0.8): the cradle's share is nothing.

    Without the deck's acceleration it would seem to carry a twelfth, more than counts as touched.
    """
    weight, mass, shares = bench.told["estimate"]["weight"][0], bench.told["estimate"]["mass"][0], []
    for known in (1, 0):
        bench.board["environment"]["moves"], bench.board["environment"]["base_a"] = known, [0.0, 0.0, -falls]
        bench.kept["estimate"]["weight"], bench.e["thrust"], bench.kept["act"]["hover"] = weight, 0.0, weight
        bench.m["wrench"] = reading(bench, np.array([0.0, 0.0, mass * (9.81 - falls)]), np.array([0.0, 0.0, -falls]))
        for _ in range(600):
            estimate_load(False, True, 0.0, bench.b)
        shares.append(bench.e["ground_share"][0])
    assert shares[0] == pytest.approx(0.0, abs=2e-3)
    assert shares[1] == pytest.approx(falls / 9.81, abs=2e-3)


def test_weight_is_that_at_rest_wherever_it_hangs(bench):
    """A deck that falls takes weight off the arm and none off the UAV."""
    p, s = bench.told["estimate"], bench.kept["estimate"]
    s["felt"] = 0.9
    for _ in range(1500):
        weigh(p["weight"][0] * (0.9 - 0.5), 0.5, p[0], s[0])
    assert s["weight"][0] == pytest.approx(p["weight"][0], rel=1e-6)


@pytest.mark.parametrize("gain", [0.8, 0.0, -1.0])
def test_nod_on_a_platform_tells_the_sensors_gain_though_the_deck_makes_most_of_the_force(bench, gain):
    """The deck makes three times the nod's force, against it on one axis: taken off as −m γ a gain of 0.8 would count as 1.4 there."""
    mass, nod = bench.told["estimate"]["wrench"]["mass"][0], np.array([0.5, 0.5, 0.5])
    bench.board["environment"]["moves"] = 1
    for k in range(500):
        swing = np.sin(2.0 * np.pi * k / 500)
        a, deck = nod * swing, np.array([0.9, -1.5, 0.3]) * swing
        bench.kept["refer"]["a"], bench.board["environment"]["base_a"] = a, deck
        bench.m["wrench"][0, :3] = bench.board["arm"]["rotation"][0].T @ (gain * mass * (a + deck + [0.0, 0.0, 9.81]))
        feel_nod(bench.m[0], bench.b)
    np.testing.assert_allclose(bench.kept["estimate"]["nod"]["gain"][0], gain, atol=1e-6)
