"""The stage that acts: what the commanded torques do to the arm, by Pinocchio's forward dynamics, against springs and dampers.

The controller's torques act on the arm alone, without the UAV, in random states around the home pose. Then the end effector
accelerates by Λ⁻¹ times the wrench that the law wants, beyond what it does under gravity compensation alone; the null-space
torque must not show. With the published gains the wrench is 935 N/m and 44.4 N·s/m, 25 N·m/rad and 7 N·m·s/rad.
"""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.control.laws.backstepping import paper_law
from armland.control.laws.rigid_body import BacksteppingGains, UavParameters
from armland.mission.act import act, load_force, prove
from armland.records import Limit
from armland.rotations import from_rotation_vector, matrix

STIFFNESS, DAMPING = 935.0, 44.4
TOOL_WEIGHT = 0.30 * 9.81


@pytest.fixture
def states(workplace):
    rng = np.random.default_rng(12)
    return [(workplace.home + rng.normal(scale=0.05, size=7), rng.normal(scale=0.1, size=7)) for _ in range(10)]


def wrench_of(c, dynamics, q, qd):
    """The wrench (6,) that the command puts on the end effector, from the acceleration that it makes."""
    tau = c.tick.command["tau"][0]
    gained = dynamics.acceleration(q, qd, tau) - dynamics.acceleration(q, qd, dynamics.gravity(q))
    return np.linalg.solve(dynamics.mobility(q), gained)


def spring_and_damper(c, dynamics, workplace, q, qd):
    """Force and torque by hand, from Pinocchio's pose and twist."""
    c.arm.update(q, qd)
    position, R = c.arm.position.copy(), Rotation.from_matrix(c.arm.rotation)
    twist = dynamics.jacobian(q) @ qd
    goal = c.tick.reference["r"][0]
    force = STIFFNESS * (goal - position) - DAMPING * twist[:3]
    torque = 25.0 * (Rotation.from_matrix(R_D(workplace)) * R.inv()).as_rotvec() - 7.0 * twist[3:]
    return np.concatenate([force, torque])


def R_D(workplace):
    return workplace.told["act"]["realisation"]["R_d"][0]


def moving_tick(workplace):
    """A tick at which the reference accelerates on some axis."""
    return int(np.abs(workplace.path[:, 6:9]).max(axis=1).argmax())


def test_eq35_e1_is_spring_and_damper_of_eq33(controller, dynamics, workplace, states):
    c = controller("E1")
    for q, qd in states:
        c.sample(moving_tick(workplace), q, qd)
        expected = spring_and_damper(c, dynamics, workplace, q, qd)
        np.testing.assert_allclose(wrench_of(c, dynamics, q, qd), expected, atol=1e-6)
        np.testing.assert_allclose(c.tick.command["force"][0], expected[:3], atol=1e-9)
        np.testing.assert_array_equal(c.tick.command["delta_tau"], 0.0)


def test_eq35_e2_adds_the_desired_acceleration_and_nothing_else(controller, dynamics, workplace, states):
    """The end effector accelerates by r̈_d more than under E1, without turning."""
    e1, e2 = controller("E1"), controller("E2")
    busiest = [int(np.abs(workplace.path[:, 6 + axis]).argmax()) for axis in range(3)]
    for i, (q, qd) in enumerate(states):
        k = busiest[i % 3]
        desired = workplace.path[k, 6:9]
        assert np.abs(desired[i % 3]) > 0.05
        e1.sample(k, q, qd)
        e2.sample(k, q, qd)
        more = dynamics.acceleration(q, qd, e2.tick.command["tau"][0]) - dynamics.acceleration(
            q, qd, e1.tick.command["tau"][0]
        )
        np.testing.assert_allclose(more, [*desired, 0.0, 0.0, 0.0], atol=1e-8)


def test_eq35_e3_adds_the_measured_support_along_z(controller, dynamics, workplace, states):
    """Force-torque reading f in sensor axes: the support is (R f)_z less the tool's weight; x and y are not used."""
    k = moving_tick(workplace)
    e2, e3 = controller("E2"), controller("E3")
    reading = np.array([0.4, -0.3, 5.3, 0.01, 0.02, 0.03])
    for q, qd in states:
        for c in (e2, e3):
            c.sample(k, q, qd, wrench=reading)
        e3.arm.update(q, qd)
        support = (e3.arm.rotation @ reading[:3])[2] - TOOL_WEIGHT
        more = wrench_of(e3, dynamics, q, qd) - wrench_of(e2, dynamics, q, qd)
        np.testing.assert_allclose(more, [0.0, 0.0, support, 0.0, 0.0, 0.0], atol=1e-6)


def test_eq35_coriolis_feedforward_adds_mu_times_the_desired_twist(controller, dynamics, workplace, states):
    """Under φ̇ = 𝒥̄ ẋ_d the arm then keeps its twist: with the switch the velocity-dependent acceleration is gone."""
    k = moving_tick(workplace) + 100
    twist = np.concatenate([workplace.path[k, 3:6], np.zeros(3)])
    assert np.abs(twist).max() > 0.05
    off, on = controller("E1"), controller("E1", {"control": {"coriolis_feedforward": True}})
    for q, _ in states:
        arm = on.arm
        arm.update(q, np.zeros(7))
        qd = 10.0 * np.linalg.solve(arm.mass_matrix, arm.jacobian.T @ arm.lambda_ee @ twist)
        off.sample(k, q, qd)
        on.sample(k, q, qd)
        drift = dynamics.acceleration(q, qd, dynamics.gravity(q))
        more = dynamics.acceleration(q, qd, on.tick.command["tau"][0]) - dynamics.acceleration(
            q, qd, off.tick.command["tau"][0]
        )
        # μ depends on φ̇, ten times that of ẋ_d here; its product with ẋ_d then cancels a tenth of the drift.
        np.testing.assert_allclose(more, -0.1 * drift, atol=1e-8)
        assert np.abs(drift).max() > 1e-2


def test_null_space_pulls_the_elbow_down_and_brakes(controller, dynamics, workplace):
    """Joint torques beyond g and 𝒥ᵀ wrench exist, do not accelerate the end effector, and lower the elbow from rest."""
    c = controller("E1")
    q = workplace.home
    c.sample(0, q, 0.0)
    tau = c.tick.command["tau"][0]
    wrench = wrench_of(c, dynamics, q, np.zeros(7))
    null = tau - dynamics.gravity(q) - dynamics.jacobian(q).T @ wrench
    assert np.abs(null).max() > 0.05
    arm = c.arm
    arm.update(q, np.zeros(7))
    qdd = np.linalg.solve(arm.mass_matrix, null)
    np.testing.assert_allclose(dynamics.jacobian(q) @ qdd, 0.0, atol=1e-9)
    elbow = int(c.told["act"]["realisation"]["elbow"][0])
    raises = np.cross(arm.axis[:elbow], arm.anchor[elbow] - arm.anchor[:elbow])[:, 2]
    assert raises @ qdd[:elbow] < 0.0


def test_eq29_extra_torque_is_the_laws_at_the_estimate(controller, paper, workplace):
    c = controller("E2")
    quat = Rotation.from_rotvec([0.05, -0.03, 0.02]).as_quat(scalar_first=True)
    rate = np.array([0.2, -0.1, 0.3])
    tick = c.sample(moving_tick(workplace), quat=quat, rate=rate)
    e, r = tick.estimate[0], tick.reference[0]
    np.testing.assert_array_equal(e["quat"], quat)
    uav = UavParameters(0.480, np.diag([0.006, 0.007, 0.012]), np.array([0.0, 0.0, -0.06]))
    k = np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0])
    p = c.told["estimate"]
    onboard = -p["onboard_kp"][0] * 2.0 * quat[1:] - p["onboard_kd"][0] * rate
    np.testing.assert_allclose(e["tau_att"], onboard, atol=1e-12)
    expected, _ = paper_law(
        quat, rate, e["r"].copy(), e["v"].copy(), np.array([1.0, 0, 0, 0]), r["r"].copy(), paper.control.thrust_n, onboard, uav,
        BacksteppingGains(k, k, 35.0),
    )  # fmt: skip
    np.testing.assert_allclose(tick.command["delta_tau"][0], expected, atol=1e-12)
    assert tick.command["thrust"][0] == paper.control.thrust_n


def test_torques_stay_within_the_joints_limits_and_say_so(controller, workplace):
    """Far from the reference the spring asks for more than the arm can give."""
    c = controller()
    q = workplace.home + 0.8
    tick = c.sample(0, q)
    limits = np.array([176.0, 176.0, 100.0, 100.0, 100.0, 38.0, 38.0])
    assert (np.abs(tick.command["tau"][0]) <= limits).all()
    assert tick.health["flags"][0] & Limit.JOINT_TORQUE
    assert tick.health["torque_ratio"][0] > 1.0
    calm = c.sample(0)
    assert not calm.health["flags"][0] & Limit.JOINT_TORQUE
    assert calm.health["torque_ratio"][0] == pytest.approx((np.abs(calm.command["tau"][0]) / limits).max())


def test_health_tells_the_nearest_end_of_a_joints_range(controller, workplace):
    c = controller()
    q = workplace.home.copy()
    q[4] = c.arm.q_max[4] - 0.017
    assert c.sample(0, q).health["joint_margin"][0] == pytest.approx(0.017)


def test_health_tells_the_age_of_the_uavs_sample(controller, paper):
    c = controller()
    watchdog = round(paper.link.watchdog_ms)
    fresh, stale = c.sample(5000, uav_tick=5000 - watchdog), None
    assert fresh.health["uav_age"][0] == pytest.approx(1e-3 * watchdog)
    assert not fresh.health["flags"][0] & Limit.UAV_STALE
    stale = c.sample(5000, uav_tick=5000 - watchdog - 1)
    assert stale.health["flags"][0] & Limit.UAV_STALE


RATE = 25.0
"""Poles of the free end effector, rad/s."""


def pose(bench, q, qd):
    """Have the arm at joint positions and velocities (7,)."""
    arm = bench.plan.arm
    arm.qpos[:], arm.qvel[:] = q, qd
    arm.refresh(velocity_terms=True)
    bench.board["arm"] = arm.state
    bench.m["q"], bench.m["qd"] = q, qd
    bench.e["r"], bench.e["v"] = arm.position, arm.jacobian[:3] @ qd


def by_orientation(bench, dynamics, q):
    """Linear acceleration (3,) that the orientation's torque makes beside its own, m/s²."""
    return dynamics.mobility(q)[:3, 3:] @ bench.c["torque"][0]


def acted(bench, phase):
    """Joint torques of one tick in a phase."""
    bench.enter(phase)
    act(bench.b, bench.plan.path)
    return bench.c["tau"][0].copy()


@pytest.fixture
def landing_states(landing_plan):
    rng = np.random.default_rng(3)
    return [(landing_plan.home + rng.normal(scale=0.05, size=7), rng.normal(scale=0.2, size=7)) for _ in range(5)]


def test_eq6_free_end_effector_accelerates_towards_its_reference(bench, dynamics, landing_states):
    for q, qd in landing_states:
        pose(bench, q, qd)
        r = bench.tick.reference
        r["r"], r["v"], r["a"] = bench.e["r"] + [0.01, -0.02, 0.03], [0.1, 0.0, -0.1], [0.5, -1.0, 2.0]
        tau = acted(bench, "guide")
        wanted = r["a"][0] + RATE**2 * (r["r"][0] - bench.e["r"][0]) + 2.0 * RATE * (r["v"][0] - bench.e["v"][0])
        wanted += by_orientation(bench, dynamics, q)
        np.testing.assert_allclose(dynamics.acceleration(q, qd, tau)[:3], wanted, atol=1e-6)
        np.testing.assert_array_equal(bench.c["force"], 0.0)


def hold(bench, thrust, error=(0.0, 0.0, 0.0), v=(0.0, 0.0, 0.0)):
    bench.e["thrust"] = thrust
    bench.tick.reference["r"], bench.tick.reference["v"] = bench.e["r"] + error, np.array(v)
    bench.tick.reference["a"] = 0.0


def test_arm_at_rest_carries_what_the_rotors_leave(bench, landing_plan):
    pose(bench, landing_plan.home, np.zeros(7))
    body = bench.told["estimate"]["body_mass"][0] * 9.81
    hold(bench, 0.4 * body)
    acted(bench, "carry")
    np.testing.assert_allclose(bench.c["force"][0], [0.0, 0.0, 0.6 * body], atol=1e-9)


def test_x1_spring_and_damper_of_the_held_uav_have_the_wanted_poles(bench, landing_plan):
    """Position error x and its rate: force m (ω² x + 2 ζ ω ẋ) beyond what carries the weight."""
    pose(bench, landing_plan.home, np.zeros(7))
    body, c = bench.told["estimate"]["body_mass"][0], bench.plan.scenario.control
    # A force that moves nothing would be taken for a disturbance.
    bench.told["estimate"]["observer"]["gain"] = 0.0
    hold(bench, 0.0)
    acted(bench, "carry")
    still = bench.c["force"][0].copy()
    for error, v in (([0.01, 0.0, 0.0], [0.0] * 3), ([0.0, 0.0, 0.0], [0.0, 0.1, 0.0])):
        hold(bench, 0.0, error, v)
        acted(bench, "carry")
        wanted = body * (
            c.position_rad_s**2 * np.array(error) + 2.0 * c.position_damping * c.position_rad_s * np.array(v)
        )
        np.testing.assert_allclose(bench.c["force"][0] - still, wanted, rtol=1e-6, atol=1e-9)


def test_x2_arm_moves_as_the_uav_will_under_the_force(bench, dynamics, landing_states):
    """The arm alone, pushed back by the force that it shall put on the UAV, accelerates as the pivot of a level UAV would."""
    mass = bench.told["estimate"]["body_mass"][0]
    # From state to state the momentum jumps.
    bench.told["estimate"]["observer"]["gain"] = 0.0
    for q, qd in landing_states:
        pose(bench, q, qd)
        hold(bench, 2.0, [0.004, -0.003, 0.002])
        tau = acted(bench, "carry")
        force = bench.c["force"][0]
        back = tau - dynamics.jacobian(q)[:3].T @ force
        wanted = (force + [0.0, 0.0, 2.0]) / mass + [0.0, 0.0, -9.81] + by_orientation(bench, dynamics, q)
        np.testing.assert_allclose(dynamics.acceleration(q, qd, back)[:3], wanted, atol=1e-6)


def test_braked_arm_is_told_its_weight_only(bench, landing_states):
    q, qd = landing_states[0]
    pose(bench, q, qd)
    bench.tick.reference["r"] = bench.e["r"] + 0.1
    np.testing.assert_array_equal(acted(bench, "braked_held"), bench.board["arm"]["gravity"][0])
    assert bench.c["brake"][0] == 1
    acted(bench, "holding")
    assert bench.c["brake"][0] == 0


def test_b1_load_of_a_balanced_uav_is_held_up_and_swung(bench):
    """m (u + l θ̈) by the pendulum's own equation, and the weight that the dying rotors leave."""
    s, t = bench.kept["refer"]["balance"], bench.told["estimate"]
    s["sway_a"], bench.e["thrust"] = [2.0, -1.0], 1.0
    bench.e["quat"][0] = from_rotation_vector(np.array([0.0, 0.05, 0.0]))
    load_force(bench.b)
    mass, lever, inertia = t["body_mass"][0], -t["lever"][0, 2], 0.5 * (0.006 + 0.007)
    swung = inertia + mass * lever**2
    theta = np.array([np.sin(0.05), 0.0])
    theta_ddot = mass * lever * (9.81 * theta - [2.0, -1.0]) / swung
    wanted = mass * (np.array([2.0, -1.0]) + lever * theta_ddot)
    np.testing.assert_allclose(bench.c["force"][0, :2], wanted, rtol=2e-3)
    assert bench.c["force"][0, 2] == pytest.approx(t["weight"][0] - 1.0)


def test_tool_turns_towards_its_lean_and_ahead_with_it(bench, dynamics, landing_plan):
    q, lean = landing_plan.home, np.array([0.0, 0.02, 0.0])
    pose(bench, q, np.zeros(7))
    hold(bench, 0.0)
    s = bench.kept["refer"]["balance"]
    s["lean"], s["lean_a"] = lean, [0.0, 0.5, 0.0]
    bench.enter("balancing")
    tau = acted(bench, "balancing") - dynamics.jacobian(q)[:3].T @ bench.c["force"][0]
    turned = dynamics.acceleration(q, np.zeros(7), tau)[3:]
    # The home pose is upright to a thousandth of a radian.
    np.testing.assert_allclose(turned, np.array([0.0, 0.5, 0.0]) + RATE**2 * lean, atol=RATE**2 * 2e-3)
    assert matrix(from_rotation_vector(lean))[0, 2] > 0.0


def test_proof_is_promised_while_the_uav_is_held_only(bench, landing_plan):
    pose(bench, landing_plan.home, np.zeros(7))
    hold(bench, 2.0, [0.01, 0.0, 0.0])
    prove(False, bench.b)
    assert np.isnan(bench.tick.proof["v2"][0])
    prove(True, bench.b)
    assert bench.tick.proof["v2"][0] > 0.0
    assert bench.tick.proof["v2_rate"][0] < 0.0
    near = bench.tick.proof["v2"][0]
    hold(bench, 2.0, [0.02, 0.0, 0.0])
    prove(True, bench.b)
    assert bench.tick.proof["v2"][0] == pytest.approx(4.0 * near, rel=1e-6)


@pytest.mark.parametrize(("tick", "fresh"), [(1000, True), (1003, False), (1005, True)])
def test_proof_is_taken_at_every_fifth_tick(bench, landing_plan, tick, fresh):
    pose(bench, landing_plan.home, np.zeros(7))
    hold(bench, 2.0, [0.01, 0.0, 0.0])
    bench.tick.proof["v2"], bench.m["tick"] = -1.0, tick
    acted(bench, "carry")
    assert (bench.tick.proof["v2"][0] > 0.0) == fresh


@pytest.mark.parametrize(("phase", "magnet"), [("guide", 0), ("carry", 1), ("self_test", 2)])
def test_what_was_commanded_is_remembered(bench, landing_plan, phase, magnet):
    """Thrust for as long as it travels, the magnet for the next tick's signs, and the law's force for the observer."""
    pose(bench, landing_plan.home, np.zeros(7))
    hold(bench, 2.0, [0.004, 0.0, 0.0])
    bench.m["tick"], bench.kept["estimate"]["thrust_log"] = 2003, -1.0
    acted(bench, phase)
    log = bench.kept["estimate"]["thrust_log"][0]
    assert log[2003 % 256] == bench.c["thrust"][0] == bench.kept["act"]["thrust"][0]
    assert (np.delete(log, 2003 % 256) == -1.0).all()
    assert bench.c["magnet"][0] == bench.kept["act"]["magnet"][0] == magnet
    if phase == "carry":
        np.testing.assert_array_equal(bench.kept["act"]["force"], bench.c["force"])
        assert np.abs(bench.c["force"]).max() > 0.1


def test_arm_that_holds_nothing_asks_for_no_torque_and_tells_what_the_observer_last_knew(bench, landing_plan):
    pose(bench, landing_plan.home, np.zeros(7))
    hold(bench, 2.0)
    bench.c["delta_tau"], bench.c["force"] = 9.0, 9.0
    bench.kept["estimate"]["observer"]["force"] = [0.1, -0.2, 0.3]
    acted(bench, "guide")
    np.testing.assert_array_equal(bench.c["delta_tau"], 0.0)
    np.testing.assert_array_equal(bench.c["force"], 0.0)
    np.testing.assert_array_equal(bench.e["disturbance"][0], [0.1, -0.2, 0.3])


@pytest.mark.parametrize("turn", [(0.0, 0.05, 0.0), (-0.05, 0.0, 0.0), (0.03, 0.04, 0.0)])
def test_b1_load_swings_about_both_axes(bench, turn):
    """At rest on a pivot at rest it falls by m g l θ/(J + m l²), and its lever pulls the pivot along."""
    t = bench.told["estimate"]
    R = matrix(from_rotation_vector(np.array(turn)))
    bench.e["quat"][0] = from_rotation_vector(np.array(turn))
    load_force(bench.b)
    mass, lever = t["body_mass"][0], -t["lever"][0, 2]
    falls = mass * lever * 9.81 * R[:2, 2] / (0.0065 + mass * lever**2)
    np.testing.assert_allclose(bench.c["force"][0, :2], mass * lever * falls, rtol=2e-3, atol=1e-12)


@pytest.mark.parametrize(("share", "left"), [(0.0, 1.0), (0.4, 0.6), (1.5, 0.0)])
def test_arm_carries_what_dying_rotors_leave_and_never_pushes_down(bench, share, left):
    weight = bench.told["estimate"]["weight"][0]
    bench.e["thrust"] = share * weight
    load_force(bench.b)
    assert bench.c["force"][0, 2] == pytest.approx(left * weight)


def test_tool_follows_its_leans_speed_and_is_braked_against_it(bench, dynamics, landing_plan):
    """The angular acceleration is 2ζω times the rate that is missing, beside the lean's own."""
    q, s = landing_plan.home, bench.kept["refer"]["balance"]
    pose(bench, q, np.zeros(7))
    hold(bench, 0.0)
    s["lean"] = s["lean_a"] = 0.0
    found = []
    for speed in (0.0, 0.3):
        s["lean_v"] = [speed, -speed, 0.0]
        tau = acted(bench, "balancing") - dynamics.jacobian(q)[:3].T @ bench.c["force"][0]
        found.append(dynamics.acceleration(q, np.zeros(7), tau)[3:])
    damping = 2.0 * landing_plan.scenario.control.free_damping * RATE
    np.testing.assert_allclose(found[1] - found[0], damping * np.array([0.3, -0.3, 0.0]), atol=1e-6)


def test_orientations_torque_stays_out_of_the_balance(bench, landing_plan):
    """The tool is led by an acceleration; a torque to where it pointed would hold it back."""
    q = landing_plan.home + 0.02
    pose(bench, q, np.zeros(7))
    hold(bench, 0.0)
    acted(bench, "holding")
    assert np.abs(bench.c["torque"]).max() > 0.01
    acted(bench, "balancing")
    np.testing.assert_array_equal(bench.c["torque"], 0.0)
