"""The momentum observer on arms that MuJoCo moves, against its contact forces, its energy, and the observer's first form in NumPy."""

import copy

import mujoco
import numpy as np
import pytest

from armland.estimation.momentum import (
    BANDWIDTH_RAD_S,
    CLEAR_SIGMA,
    PERIOD,
    doubt,
    drive,
    kept_layout,
    observe,
    told,
    told_layout,
)
from armland.models.parameters import arm_model
from armland.scenario import load_scenario

H = 1e-3
STEP = PERIOD * H
ARMS = ("lwr4.xml", "examples/six_axis.urdf")
WEIGHT = 4.7


@pytest.fixture(scope="module", params=ARMS)
def believed(request):
    ee = None if request.param == ARMS[0] else "tool0"
    return load_scenario("landing").replaced({"arm": {"file": request.param, "ee": ee}})


@pytest.fixture(scope="module")
def arm(believed):
    return arm_model(believed)


class Rig:
    """An arm that follows sines with a feed-forward of gravity and a weak spring, and the observer beside it."""

    def __init__(self, believed, arm, friction=0.0, damping=0.0, speed=1.0):
        self.arm, self.speed, n = arm, speed, arm.joints
        self.plant = copy.copy(arm.model)
        self.plant.opt.timestep, self.plant.opt.integrator = H, mujoco.mjtIntegrator.mjINT_EULER
        self.plant.jnt_limited[:], self.plant.jnt_actfrclimited[:] = 0, 0
        self.plant.dof_frictionloss[:], self.plant.dof_damping[:] = friction, damping
        self.data = mujoco.MjData(self.plant)
        self.middle = np.linspace(0.4, -0.9, n)
        self.data.qpos[:] = self.middle
        self.data.qvel[:] = speed * self.rate(0.0)
        self.p, self.s, self.k = told(believed, arm, WEIGHT), np.zeros(1, kept_layout(n)), 0
        self.p["friction"], self.p["damping"] = friction, damping
        self.p["steady"] += friction - arm.friction

    def rate(self, t):
        return np.sin(np.arange(1, self.arm.joints + 1) * 0.7 + 2.0 * t)

    def drive_torque(self):
        t, q, qd = self.k * H, self.data.qpos, self.data.qvel
        wanted = self.middle + 0.5 * self.speed * (np.cos(np.arange(1, self.arm.joints + 1) * 0.7) - self.offset(t))
        M = self.arm.state["mass_matrix"][0]
        return self.arm.state["gravity"][0] + M @ (
            20.0 * (wanted - q) + 6.0 * (self.speed * self.rate(t) - qd) + 2.0 * self.speed * self.offset(t)
        )

    def offset(self, t):
        return np.cos(np.arange(1, self.arm.joints + 1) * 0.7 + 2.0 * t)

    def tick(self, push=None, force=None, touches=False, noise=None, coriolis=True):
        """One tick; returns what was given to the joints."""
        d = self.data
        qd = d.qvel.copy() if noise is None else d.qvel + noise
        self.arm.qpos[:], self.arm.qvel[:] = d.qpos, qd
        self.arm.refresh(velocity_terms=True)
        if not coriolis:
            self.arm.state["coriolis"] = 0.0
        if self.k % PERIOD == 0:
            observe(qd, self.arm.state[0], self.p[0], self.s[0])
        tau = self.drive_torque()
        known = np.zeros(3) if force is None else np.asarray(force, float)
        drive(tau, known, touches, self.arm.state[0], self.p[0], self.s[0])
        d.qfrc_applied[:] = tau
        d.xfrc_applied[:] = 0.0
        if push is not None:
            body, f = push
            d.xfrc_applied[body, :3] = f
        mujoco.mj_step(self.plant, d)
        self.k += 1
        return tau

    @property
    def r(self):
        return self.s["r"][0].copy()

    @property
    def ratio(self):
        return float(self.s["ratio"][0])

    def felt(self, body, force):
        """Torques (n,), N·m, of a force at the body's centre of mass, by MuJoCo's own Jacobian."""
        J = np.zeros((3, self.plant.nv))
        mujoco.mj_forward(self.plant, copy.copy(self.data))
        mujoco.mj_jacBodyCom(self.plant, self.data, J, None, body)
        return J.T @ force


@pytest.fixture
def rig(believed, arm):
    return Rig(believed, arm)


def elbow_body(arm):
    """The body that the middle joint moves: behind it no force sensor feels anything."""
    return int(arm.model.jnt_bodyid[arm.joints // 2])


def test_eq_x7_push_on_a_moving_arm_comes_through_a_low_pass_of_the_first_order(rig, arm):
    body, force, found, given = elbow_body(arm), np.array([12.0, -20.0, 8.0]), [], []
    for k in range(600):
        pushed = k >= 200
        given.append(rig.felt(body, force) if pushed else np.zeros(arm.joints))
        rig.tick((body, force) if pushed else None)
        found.append(rig.r)
    expected = np.zeros((600, arm.joints))
    for k in range(1, 600):
        expected[k] = expected[k - 1] + H * BANDWIDTH_RAD_S * (given[k - 1] - expected[k - 1])
    most = np.abs(expected).max()
    assert most > 5.0
    # It is known up to one step late.
    late = [np.abs(np.array(found)[s:] - expected[: 600 - s]).max() for s in range(PERIOD + 1)]
    assert min(late) < 0.08 * most
    # A third of a time constant after the push little is known, five after it all.
    np.testing.assert_allclose(found[-1], given[-1], atol=0.06 * most)
    assert np.abs(found[210]).max() < 0.5 * np.abs(given[210]).max()


def test_arm_that_moves_freely_feels_nothing_and_without_coriolis_terms_it_does(believed, arm):
    most = {}
    for coriolis in (True, False):
        rig, found = Rig(believed, arm, speed=1.5), []
        for _ in range(800):
            rig.tick(coriolis=coriolis)
            found.append(np.abs(rig.r).max())
        most[coriolis] = max(found)
    assert most[True] < 0.15
    assert most[False] > 8.0 * most[True]


def test_eq_x8_is_the_momentum_form_with_the_energys_gradient(believed, arm):
    """(X.7) as it stands, with p = M φ̇ and Cᵀφ̇ = ½ ∇(φ̇ᵀ M φ̇) by finite differences, gives the same r."""
    rig, body, force = Rig(believed, arm), elbow_body(arm), np.array([0.0, 25.0, 5.0])
    n, before, impulse, r = arm.joints, None, np.zeros(arm.joints), np.zeros(arm.joints)
    gain = float(rig.p["gain"][0])
    other = mujoco.MjData(rig.plant)

    def mass(q):
        other.qpos[:] = q
        M = np.zeros((n, n))
        mujoco.mj_forward(rig.plant, other)
        mujoco.mj_fullM(rig.plant, other, M)
        return M

    def slope(q, qd):
        out = np.zeros(n)
        for i in range(n):
            e = np.zeros(n)
            e[i] = 1e-6
            out[i] = 0.5 * qd @ (mass(q + e) - mass(q - e)) @ qd / 2e-6
        other.qpos[:], other.qvel[:] = q, 0.0
        mujoco.mj_forward(rig.plant, other)
        return out - other.qfrc_bias

    for k in range(150):
        if k % PERIOD == 0:
            q, qd = rig.data.qpos.copy(), rig.data.qvel.copy()
            now = mass(q) @ qd, slope(q, qd)
            if before is not None:
                missed = now[0] - before[0] - impulse - 0.5 * STEP * (now[1] + before[1])
                r += gain * (missed - r * STEP)
            before, impulse = now, np.zeros(n)
        impulse += H * rig.tick((body, force))
        if k % PERIOD == 0:
            np.testing.assert_allclose(rig.r, r, atol=0.04)
    assert np.abs(r).max() > 5.0


def test_power_of_what_is_found_is_the_energy_that_motors_and_gravity_do_not_explain(believed, arm):
    rig, body = Rig(believed, arm, speed=0.4), elbow_body(arm)
    rig.plant.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    force, unexplained, found = np.array([15.0, 15.0, -10.0]), 0.0, 0.0
    energy, work = None, 0.0
    for k in range(1200):
        mujoco.mj_forward(rig.plant, rig.data)
        level, qd = rig.data.energy.sum(), rig.data.qvel.copy()
        if energy is not None and k > 400:
            unexplained += level - energy - work
            found += H * rig.r @ qd
        tau = rig.tick((body, force))
        work, energy = H * tau @ (0.5 * (qd + rig.data.qvel)), level
    assert abs(unexplained) > 0.2
    assert found == pytest.approx(unexplained, rel=0.1)


def test_force_that_is_known_to_act_is_taken_off_and_one_that_is_not_stays(believed, arm):
    """A plate that rests on the end effector, as the force sensor feels it."""
    down, most = np.array([0.0, 0.0, -25.0]), {}
    for touches in (True, False):
        rig = Rig(believed, arm, speed=0.2)
        for _ in range(500):
            # F is the end effector's on the plate; the plate's on the arm is −F, at the end effector's point.
            rig.tick(force=-down, touches=touches)
            rig.data.qvel[:] += _kick(rig, arm.state["jacobian"][0][:3].T @ down)
        most[touches] = np.abs(rig.r).max()
    assert most[True] < 0.1 * most[False]
    assert most[False] > 5.0


def _kick(rig, torque):
    # What joint torques do to the velocities in one tick, by MuJoCo's own factors.
    x = np.zeros((1, rig.plant.nv))
    mujoco.mj_solveM(rig.plant, rig.data, x, torque[None, :])
    return H * x[0]


@pytest.mark.parametrize("told_of_it", [True, False])
def test_friction_of_the_arms_file_is_no_contact_and_what_the_file_does_not_say_is(believed, arm, told_of_it):
    rig = Rig(believed, arm, friction=15.0, damping=4.0, speed=0.3)
    if not told_of_it:
        rig.p["friction"], rig.p["damping"] = 0.0, 0.0
        rig.p["steady"] -= 15.0
    peak = 0.0
    for _ in range(1500):
        rig.tick()
        peak = max(peak, rig.ratio)
    assert (peak < 0.8) == told_of_it
    assert float(rig.s["peak"][0]) >= peak


def test_noise_of_the_velocity_stays_six_standard_deviations_below_the_doubt(believed, arm):
    rng, sigma, found = np.random.default_rng(1), believed.sensors.joint_velocity_rad_s, []
    rig = Rig(believed, arm, speed=0.0)
    for _ in range(4000):
        rig.tick(noise=sigma * rng.standard_normal(arm.joints))
        found.append(rig.r)
    # The spring answers to noise, too, and what it gives is known: what is left is the observer's own.
    spread = np.array(found[500:]).std(axis=0)
    rows = np.linalg.norm(arm.state["mass_matrix"][0], axis=1)
    np.testing.assert_allclose(spread, float(rig.p["noise"][0]) / CLEAR_SIGMA * rows, rtol=0.25)


def test_eq_x9_by_hand(believed, arm):
    n, state = arm.joints, arm.state.copy()
    p, s = np.zeros(1, told_layout(n)), np.zeros(1, kept_layout(n))
    p["tick_s"], p["period"], p["steady"], p["share"], p["viscous"] = 1e-3, 5, 2.0, 0.1, 0.5
    p["load"], p["felt"], p["noise"] = 3.0, 0.05, 0.4
    state["gravity"], state["jacobian"] = -40.0, 0.0
    state["jacobian"][0, 2, 1] = -0.5
    s["impulse"], s["reaction"] = 5e-3 * -44.0, 5e-3 * 20.0
    # 2 + 0.1 (40 + 4) + 0.5 · 0.2 + 3 · 0.5 + 0.05 · 20 + 0.4 · 1.5
    assert doubt(1, -0.2, 1.5, state[0], p[0], s[0]) == pytest.approx(2.0 + 4.4 + 0.1 + 1.5 + 1.0 + 0.6)


def test_doubt_is_of_the_arms_own_limits(believed, arm):
    p, weak = told(believed, arm, WEIGHT), copy.copy(arm)
    weak.tau_max = 0.5 * arm.tau_max
    # Offset and dry friction of 0.5 % and 0.3 % of the limit, twice; and all the friction of the file.
    np.testing.assert_allclose(p["steady"][0], 0.016 * arm.tau_max + arm.friction)
    np.testing.assert_allclose(told(believed, weak, WEIGHT)["steady"][0], 0.008 * arm.tau_max + arm.friction)
    assert float(p["share"][0]) == pytest.approx(2.0 * (0.1 + 0.01 + 0.01))
    # 10 g of a tool, and 3 % of what flies, twice.
    assert float(p["load"][0]) == pytest.approx(2.0 * (0.01 * 9.81 + 0.03 * WEIGHT), rel=1e-3)
    weak.tau_max = np.full(arm.joints, np.inf)
    np.testing.assert_array_equal(told(believed, weak, WEIGHT)["steady"][0], arm.friction)
