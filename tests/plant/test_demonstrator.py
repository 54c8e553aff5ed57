"""The simulated demonstrator as a physical system: energy, momentum at the hinge, delays, and what repeats."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.errors import ConfigurationError, PlantError
from armland.plant.demonstrator import Demonstrator

G = 9.81
MASS, LEVER = 0.480, 0.06
TOOL_MASS = 0.30
FREE = {"friction_nm": 0.0, "damping_nms": 0.0}


def total_energy(plant, scratch, M):
    """½ q̇ᵀMq̇ + Σ m g z of arm, tool and UAV, from the state alone."""
    m, d = plant.scene.model, plant.data
    scratch.qpos[:], scratch.qvel[:] = d.qpos, d.qvel
    mujoco.mj_kinematics(m, scratch)
    mujoco.mj_comPos(m, scratch)
    mujoco.mj_makeM(m, scratch)
    mujoco.mj_fullM(m, scratch, M)
    return 0.5 * d.qvel @ M @ d.qvel + G * m.body_mass @ scratch.xipos[:, 2]


class Meter:
    """Energy, positions and velocities before each step, and the UAV's place."""

    def __init__(self):
        self.energy, self.q, self.qd, self.com = [], [], [], []
        self.scratch = None

    def __call__(self, plant, _):
        m, d = plant.scene.model, plant.data
        if self.scratch is None:
            self.scratch, self.M = mujoco.MjData(m), np.zeros((m.nv, m.nv))
        self.energy.append(total_energy(plant, self.scratch, self.M))
        self.q.append(d.qpos.copy())
        self.qd.append(d.qvel.copy())
        self.com.append(self.scratch.xipos[-1].copy())


def lossless(plant):
    plant.scene.model.dof_damping[:] = 0.0
    plant.scene.model.dof_frictionloss[:] = 0.0


def balance(flight, paper, rate, loss_free):
    """Energy gained less work of motors and rotors plus losses, J, over half a second of E3; and the work and the losses."""
    meter = Meter()

    def watch(plant, k):
        if loss_free and k == 0:
            lossless(plant)
        meter(plant, k)

    run = flight(paper(run={"rate_hz": rate, "settle_s": 0.0, "tail_s": 0.0}), "E3", rate // 2, watch)
    truth, model, dt = run.ticks["truth"], run.plant.scene.model, 1.0 / rate
    # After step k the meter read; truth k + 2 describes the forces of step k + 1, which leads to the meter's next reading.
    forces = truth[2:]
    n = len(forces)
    q, qd, com = np.array(meter.q)[: n + 1], np.array(meter.qd)[: n + 1], np.array(meter.com)[: n + 1]
    upright = Rotation.from_quat(forces["quat"], scalar_first=True).as_matrix()[:, :, 2]
    lift = forces["rotor_thrust"].sum(axis=1)[:, None] * upright
    middle = 0.5 * (qd[:-1] + qd[1:])
    work = (
        np.sum(forces["tau"] * np.diff(q[:, :7], axis=0))
        + np.sum(lift * np.diff(com, axis=0))
        + np.sum(forces["tau_uav"] * forces["omega"]) * dt
    )
    lost = dt * np.sum(model.dof_damping * middle**2 + model.dof_frictionloss * np.abs(middle))
    gained = meter.energy[n] - meter.energy[0]
    return gained - work + lost, work, lost


@pytest.mark.parametrize("loss_free", [True, False], ids=["without losses", "with friction and damping"])
def test_energy_balance_closes(flight, paper, loss_free):
    """The integrator is of first order: the residual halves with the step, and what extrapolates to step zero is nothing.

    What remains in the case with losses is the difference between MuJoCo's soft friction and Coulomb's while a joint reverses.
    """
    coarse, work, lost = balance(flight, paper, 2000, loss_free)
    fine, _, _ = balance(flight, paper, 4000, loss_free)
    assert abs(work) > 1.0
    assert abs(fine) < 3e-3
    assert coarse / fine == pytest.approx(2.0, abs=0.1 if loss_free else 0.2)
    assert abs(2.0 * fine - coarse) < (2e-5 if loss_free else 5e-4)
    # Negative control: without the losses in the account it does not close.
    assert lost == 0.0 if loss_free else lost > 50.0 * abs(2.0 * fine - coarse)


def falling(paper, workplace, loss_free):
    """Energy of the demonstrator without motors and rotors, J, over 0.3 s at 5 kHz."""
    scenario = paper(
        run={"rate_hz": 5000, "settle_s": 0.0, "tail_s": 0.0},
        rotors={"min_thrust_n": 0.0},
        onboard={"kp_nm": [1e-9] * 3, "kd_nms": [1e-9] * 3},
        control={"thrust_n": 0.0},
    )
    plant = Demonstrator(scenario, workplace.home, 0.0)
    plant.connect()
    # Its joints may turn on and on: an end stop would take energy, too.
    plant.scene.model.jnt_limited[:] = False
    if loss_free:
        lossless(plant)
    plant.data.ctrl[:] = 0.0
    meter = Meter()
    for k in range(1500):
        meter(plant, k)
        mujoco.mj_step(plant.scene.model, plant.data)
    return np.array(meter.energy), np.array(meter.qd)


def test_falling_freely_it_loses_only_what_friction_takes(paper, workplace):
    """Without input the plant is passive; with its losses switched off the energy stays."""
    energy, qd = falling(paper, workplace, loss_free=False)
    # One step of the integrator errs by less than 1e-5 J here; friction takes far more.
    assert np.diff(energy).max() < 1e-5
    assert energy[0] - energy[-1] > 0.02
    kept, _ = falling(paper, workplace, loss_free=True)
    assert np.abs(qd[-1]).max() > 1.0
    assert np.abs(kept - kept[0]).max() < 0.1 * (energy[0] - energy[-1])


@pytest.mark.parametrize("experiment", ["E1", "E3"])
def test_hinge_force_is_what_accelerates_the_uav(flight, experiment):
    """F = m(v̇ + g e₃) − f_T R e₃ with v̇ by finite differences of the recorded velocity, while the arm moves.

    Tolerance 4 mN: the force is evaluated at the start of a step and the difference spans it, so they differ by
    half a step of jerk (m · 7 m/s³ · 0.5 ms = 1.7 mN here) and by the hinge's damping, which is integrated implicitly.
    """
    truth = flight(experiment=experiment, ticks=900).ticks["truth"][1:]
    acceleration = np.diff(truth["v_cm"], axis=0) / 1e-3
    upright = Rotation.from_quat(truth["quat"], scalar_first=True).as_matrix()[:, :, 2]
    lift = truth["rotor_thrust"].sum(axis=1)[:, None] * upright
    expected = MASS * (acceleration + np.array([0.0, 0.0, G])) - lift[:-1]
    np.testing.assert_allclose(truth["hinge_force"][:-1], expected, atol=4e-3)
    # Negative control: it moves, so the force without the acceleration is another one.
    still = MASS * np.array([0.0, 0.0, G]) - lift[:-1]
    assert np.abs(truth["hinge_force"][:-1] - still).max() > 0.3


def test_uav_turns_as_the_hinge_force_and_the_rotors_make_it(flight, paper):
    """J ω̇ = −ω × Jω + τ + ρ × (Rᵀ F), without hinge friction: the lever arm and the torque in the record."""
    truth = flight(paper(hinge=FREE), "E2", ticks=900).ticks["truth"][1:]
    J, rho = np.diag([0.006, 0.007, 0.012]), np.array([0.0, 0.0, -LEVER])
    R = Rotation.from_quat(truth["quat"], scalar_first=True)
    omega = truth["omega"][:-1]
    torque = truth["tau_uav"] + np.cross(rho, R.inv().apply(truth["hinge_force"]))
    expected = (torque[:-1] - np.cross(omega, omega @ J)) @ np.linalg.inv(J)
    measured = np.diff(truth["omega"], axis=0) / 1e-3
    assert np.abs(measured).max() > 3.0
    np.testing.assert_allclose(measured, expected, atol=0.02 * np.abs(measured).max())


def test_pivot_and_centre_of_mass_keep_their_lever(flight):
    """v_cm = v + ω × (cm − pivot), both velocities from their own sensors."""
    truth = flight(ticks=400).ticks["truth"]
    arm = Rotation.from_quat(truth["quat"], scalar_first=True).apply(
        np.cross(truth["omega"], np.tile([0.0, 0.0, LEVER], (len(truth), 1)))
    )
    np.testing.assert_allclose(truth["v_cm"] - truth["v"], arm, atol=1e-9)
    assert np.abs(arm).max() > 1e-3


def test_after_connect_everything_stands_still_and_the_sensor_reads_the_weights(held):
    """Motors hold gravity less the rotors' lift: nothing accelerates; sensor = tool weight + hinge force, by hand."""
    h = held()
    np.testing.assert_allclose(h.plant.data.qacc, 0.0, atol=1e-9)
    tick = h.step()
    support = MASS * G - h.plant.scenario.control.thrust_n
    np.testing.assert_allclose(tick.truth["hinge_force"][0], [0.0, 0.0, support], atol=1e-9)
    # The home pose holds the end effector upright to 1e-3 rad.
    reading = tick.measurement["wrench"][0, :3]
    assert np.linalg.norm(reading) == pytest.approx(TOOL_MASS * G + support, abs=1e-9)
    assert reading[2] == pytest.approx(TOOL_MASS * G + support, abs=1e-4)
    np.testing.assert_allclose(tick.truth["quat"][0, 1:], 0.0, atol=1e-9)


def test_at_rest_the_sensor_reads_tool_weight_and_hinge_force(flight):
    """After the move has died away. The elbow still sinks slowly in the null space, so the forces are not quite static: 2 mN."""
    run = flight(ticks=2500)
    last = run.ticks[-1]
    assert np.abs(last["truth"]["v"]).max() < 1e-3
    R_ee = run.plant.data.site("armland_fts").xmat.reshape(3, 3)
    force = R_ee @ last["measurement"]["wrench"][:3]
    np.testing.assert_allclose(force, last["truth"]["hinge_force"] + [0.0, 0.0, TOOL_MASS * G], atol=2e-3)


def test_estimate_of_the_hinge_force_needs_the_tool_weight_taken_off(flight):
    last = flight(ticks=2500).ticks[-1]
    np.testing.assert_allclose(last["estimate"]["hinge_force"], last["truth"]["hinge_force"], atol=2e-3)


# Links of 1 kHz, so that each tick is a sample; delays that are no round number of anything.
@pytest.mark.parametrize("delay", [0, 7, 23])
def test_uplink_delays_thrust_and_torque_by_exactly_its_ticks(held, paper, delay):
    h = held(paper(link={"uplink_delay_ms": float(delay), "rate_hz": 1000}, onboard={"rate_hz": 1000}))
    rest = h.plant.scenario.control.thrust_n
    lifts = [h.step(thrust=rest).truth["rotor_thrust"].sum() for _ in range(30)]
    lifts += [h.step(thrust=rest + 1.0).truth["rotor_thrust"].sum() for _ in range(40)]
    changed = np.flatnonzero(np.abs(np.array(lifts) - rest) > 1e-9)
    # Sent in tick 30, it acts in the step of tick 30 + delay, which the next reading shows.
    assert changed[0] == 30 + delay + 1


@pytest.mark.parametrize("delay", [0, 7, 23])
def test_downlink_delays_attitude_and_rates_by_exactly_its_ticks(flight, paper, delay):
    ticks = flight(
        paper(link={"downlink_delay_ms": float(delay), "rate_hz": 1000}, onboard={"rate_hz": 1000}), ticks=300
    ).ticks
    measured, truth = ticks["measurement"], ticks["truth"]
    for name, true in (("uav_quat", "quat"), ("uav_rate", "omega")):
        np.testing.assert_array_equal(measured[name][delay:], truth[true][: 300 - delay])
    np.testing.assert_array_equal(measured["uav_tick"][delay:], np.arange(300 - delay))
    assert np.abs(truth["omega"]).max() > 1e-2


def test_downlink_at_a_lower_rate_repeats_the_last_sample(flight, paper):
    """200 Hz and 12 ms: at tick k the sample of tick 5⌊(k − 12)/5⌋ is the newest."""
    ticks = flight(paper(link={"downlink_delay_ms": 12.0, "rate_hz": 200}, onboard={"rate_hz": 1000}), ticks=200).ticks
    k = np.arange(12, 200)
    taken = 5 * ((k - 12) // 5)
    np.testing.assert_array_equal(ticks["measurement"]["uav_tick"][12:], taken)
    np.testing.assert_array_equal(ticks["measurement"]["uav_quat"][12:], ticks["truth"]["quat"][taken])


def test_delay_beyond_the_delay_line_is_refused(paper, workplace):
    with pytest.raises(ConfigurationError, match=r"link\.uplink_delay_ms = 2000 ms is too long.* 1023 ms"):
        Demonstrator(paper(link={"uplink_delay_ms": 2000.0}), workplace.home, 1.0)


def test_rotors_lag_by_their_time_constant(held, paper):
    """Step of the total thrust: 1 − e⁻¹ of it after one time constant, 1 − e⁻³ after three."""
    h = held(paper(link={"uplink_delay_ms": 0.0}, onboard={"rate_hz": 1000}, rotors={"time_constant_s": 0.04}))
    rest = h.plant.scenario.control.thrust_n
    h.step(thrust=rest)
    lifts = np.array([h.step(thrust=rest + 1.0).truth["rotor_thrust"].sum() for _ in range(200)]) - rest
    # The step shows one tick after it was sent; after n ticks of action the reading is at index n.
    for n in (1, 40, 120):
        assert lifts[n] == pytest.approx(1.0 - np.exp(-n / 40.0), abs=1e-6)


def test_joint_torque_is_limited_at_the_motor(held):
    h = held()
    limits = np.array([176.0, 176.0, 100.0, 100.0, 100.0, 38.0, 38.0])
    h.step(tau=np.full(7, 1e4))
    np.testing.assert_array_equal(h.step().truth["tau"][0], limits)
    h.step(tau=np.full(7, -1e4))
    np.testing.assert_array_equal(h.step().truth["tau"][0], -limits)


def tilt_deg(ticks):
    """Angle between the UAV's and the world's vertical."""
    up = Rotation.from_quat(ticks["truth"]["quat"], scalar_first=True).as_matrix()[:, 2, 2]
    return np.rad2deg(np.arccos(np.clip(up, -1.0, 1.0)))


def test_uav_stands_on_its_hinge_only_above_the_stiffness_m_g_l(flight, paper):
    """The inverted pendulum tips below k_p = m g l = 0.283 N·m/rad and stands above it. Negative control of the attitude loop."""
    assert pytest.approx(0.2825, abs=1e-3) == MASS * G * LEVER
    standing = tilt_deg(flight(paper(onboard={"kp_nm": [0.40, 0.40, 0.30]}), ticks=2500).ticks)
    falling_over = tilt_deg(flight(paper(onboard={"kp_nm": [0.20, 0.20, 0.30]}), ticks=2500).ticks)
    assert standing[-500:].max() < 2.0
    assert falling_over[-1] > 30.0


def test_same_seed_gives_identical_ticks_and_another_seed_others(flight, paper):
    noisy = {"force_n": 0.05, "joint_velocity_rad_s": 1e-3, "attitude_rad": 2e-3, "rate_rad_s": 1e-2}
    one, two, other = (
        flight(paper(sensors=noisy, run={"seed": seed, "settle_s": 0.0, "tail_s": 0.0}), "E3", 1200).ticks
        for seed in (5, 5, 6)
    )
    assert one.tobytes() == two.tobytes()
    assert one.tobytes() != other.tobytes()
    # They fly the same path all the same.
    assert np.abs(one["truth"]["r"] - other["truth"]["r"]).max() < 5e-3


def test_connect_starts_the_same_run_again(held, paper):
    h = held(paper(sensors={"force_n": 0.05, "rate_rad_s": 0.01, "joint_position_rad": 1e-4}))
    runs = []
    for _ in range(2):
        h.plant.connect()
        h.tick.buffer[:] = np.zeros_like(h.tick.buffer)
        runs.append([h.step(thrust=3.0).buffer.tobytes() for _ in range(1100)])
    assert runs[0] == runs[1]


def test_noise_of_one_sensor_leaves_the_others_alone(held, paper):
    """Encoder noise on or off: force-torque sensor and attitude keep theirs, bit for bit, while nothing has moved yet."""
    sensors = {"force_n": 0.05, "torque_nm": 0.002, "attitude_rad": 2e-3, "rate_rad_s": 1e-2}
    quiet = held(paper(sensors=sensors)).step().measurement.copy()
    noisy = (
        held(paper(sensors={**sensors, "joint_position_rad": 1e-3, "joint_velocity_rad_s": 1e-2})).step().measurement
    )
    for name in ("wrench", "uav_quat", "uav_rate"):
        np.testing.assert_array_equal(noisy[name], quiet[name])
    assert np.abs(noisy["q"] - quiet["q"]).min() > 0.0


@pytest.mark.parametrize("what", ["qpos", "qvel"])
def test_divergence_is_reported_at_once(held, what, tmp_path, monkeypatch):
    """MuJoCo on its own would put the scene back to its start and go on, and the record would show a flight."""
    # MuJoCo writes its warning to a file in the working directory.
    monkeypatch.chdir(tmp_path)
    h = held()
    for _ in range(3):
        h.step()
    getattr(h.plant.data, what)[2] = np.nan
    h.step()
    with pytest.raises(PlantError, match=r"diverged before tick 4"):
        h.step()
