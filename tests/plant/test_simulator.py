"""The simulated demonstrator as a physical system: energy, momentum at the hinge, starts, refusals, and what repeats."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.errors import PlantError

G = 9.81
MASS, LEVER, TOOL_MASS = 0.480, 0.06, 0.30
FREE = {"friction_nm": 0.0, "damping_nms": 0.0}


def lossless(sim):
    sim.scene.model.dof_damping[:] = 0.0
    sim.scene.model.dof_frictionloss[:] = 0.0


def balance(hinged, sway, energy, rate, loss_free):
    """Energy gained less work of motors and rotors plus losses, J, over half a second; and the work and the losses."""
    led = hinged(sway, run={"rate_hz": rate})
    if loss_free:
        lossless(led.sim)
    state = []

    def watch(sim):
        state.append((*energy(sim), sim.data.qpos[:7].copy(), sim.data.qvel.copy()))

    forces = led.step(rate // 2, watch)["truth"][2:]
    # After step k the state was taken; truth k + 2 describes the forces of step k + 1, which leads to the next state.
    n, dt, model = len(forces), 1.0 / rate, led.sim.scene.model
    gained = state[n][0] - state[0][0]
    com, q, qd = (np.array([s[i] for s in state[: n + 1]]) for i in (1, 2, 3))
    up = Rotation.from_quat(forces["quat"], scalar_first=True).as_matrix()[:, :, 2]
    lift = forces["rotor_thrust"].sum(axis=1)[:, None] * up
    middle = 0.5 * (qd[:-1] + qd[1:])
    work = np.sum(forces["tau"] * np.diff(q, axis=0)) + np.sum(lift * np.diff(com, axis=0))
    work += np.sum(forces["tau_uav"] * forces["omega"]) * dt
    lost = dt * np.sum(model.dof_damping * middle**2 + model.dof_frictionloss * np.abs(middle))
    return gained - work + lost, work, lost


@pytest.mark.parametrize("loss_free", [True, False], ids=["without losses", "with friction and damping"])
def test_energy_balance_closes(hinged, sway, energy, loss_free):
    """The integrator is of first order: the residual halves with the step, and what extrapolates to step zero is nothing.

    What remains in the case with losses is the difference between MuJoCo's soft friction and Coulomb's while a joint reverses.
    """
    coarse, work, lost = balance(hinged, sway, energy, 2000, loss_free)
    fine, _, _ = balance(hinged, sway, energy, 4000, loss_free)
    assert abs(work) > 1.0
    assert coarse / fine == pytest.approx(2.0, abs=0.2)
    assert abs(2.0 * fine - coarse) < 2e-3 * abs(work)
    # Negative control: without the losses in the account it does not close.
    assert lost == 0.0 if loss_free else lost > 10.0 * abs(2.0 * fine - coarse)


def falling(hinged, energy, loss_free):
    """Energy without motors and rotors, J, over 0.3 s at 5 kHz, and the last joint speeds."""
    sim = hinged(run={"rate_hz": 5000}).sim
    # Joints may turn on and on: an end stop would take energy, too.
    sim.scene.model.jnt_limited[:] = False
    if loss_free:
        lossless(sim)
    sim.data.ctrl[:], sim.data.xfrc_applied[:] = 0.0, 0.0
    out = []
    for _ in range(1500):
        out.append(energy(sim)[0])
        mujoco.mj_step(sim.scene.model, sim.data)
    return np.array(out), sim.data.qvel.copy()


def test_falling_freely_it_loses_only_what_friction_takes(hinged, energy):
    """Without input the plant is passive; with its losses switched off the energy stays."""
    held, _ = falling(hinged, energy, loss_free=False)
    # One step of the integrator errs by less than 1e-5 J here; friction takes far more.
    assert np.diff(held).max() < 1e-5
    assert held[0] - held[-1] > 0.02
    kept, speed = falling(hinged, energy, loss_free=True)
    assert np.abs(speed).max() > 1.0
    assert np.abs(kept - kept[0]).max() < 0.1 * (held[0] - held[-1])


def test_hinge_force_is_what_accelerates_the_uav(hinged, sway):
    """F = m(v̇ + g e₃) − f_T R e₃ with v̇ by finite differences of the recorded velocity, while the arm moves.

    The force is evaluated at the start of a step and the difference spans it: they differ by half a step of jerk, and by the
    hinge's damping, which is integrated implicitly.
    """
    truth = hinged(sway).step(900)["truth"][1:]
    acceleration = np.diff(truth["v_cm"], axis=0) / 1e-3
    up = Rotation.from_quat(truth["quat"], scalar_first=True).as_matrix()[:, :, 2]
    lift = truth["rotor_thrust"].sum(axis=1)[:, None] * up
    expected = MASS * (acceleration + np.array([0.0, 0.0, G])) - lift[:-1]
    jerk = np.abs(np.diff(acceleration, axis=0)).max() / 1e-3
    np.testing.assert_allclose(truth["hinge_force"][:-1], expected, atol=2e-3 + MASS * jerk * 0.5e-3)
    # Negative control: it moves, so the force without the acceleration is another one.
    still = MASS * np.array([0.0, 0.0, G]) - lift[:-1]
    assert np.abs(truth["hinge_force"][:-1] - still).max() > 20.0 * (2e-3 + MASS * jerk * 0.5e-3)


def test_uav_turns_as_the_hinge_force_and_the_rotors_make_it(hinged, sway):
    """J ω̇ = −ω × Jω + τ + ρ × (Rᵀ F), without hinge friction: the lever arm and the torque in the record."""
    truth = hinged(sway, hinge=FREE).step(900)["truth"][1:]
    J, rho = np.diag([0.006, 0.007, 0.012]), np.array([0.0, 0.0, -LEVER])
    R, omega = Rotation.from_quat(truth["quat"], scalar_first=True), truth["omega"][:-1]
    torque = truth["tau_uav"] + np.cross(rho, R.inv().apply(truth["hinge_force"]))
    expected = (torque[:-1] - np.cross(omega, omega @ J)) @ np.linalg.inv(J)
    measured = np.diff(truth["omega"], axis=0) / 1e-3
    assert np.abs(measured).max() > 3.0
    np.testing.assert_allclose(measured, expected, atol=0.02 * np.abs(measured).max())


def test_after_connect_everything_stands_still_and_the_sensor_reads_the_weights(hinged):
    """Motors hold gravity less the rotors' lift: nothing accelerates; sensor = tool weight + hinge force, by hand."""
    led = hinged()
    assert np.abs(led.sim.data.qacc).max() < 1e-6
    m = led.step()["measurement"][0]
    hinge = MASS * G - led.sim.scenario.control.thrust_n
    R = led.sim.data.site("armland_fts").xmat.reshape(3, 3)
    np.testing.assert_allclose(R @ m["wrench"][:3], [0.0, 0.0, TOOL_MASS * G + hinge], atol=1e-6)


def test_uav_starts_where_it_was_drawn_and_the_arm_at_home(waiting):
    led = waiting(run={"seed": 5})
    t = led.step()["truth"][0]
    np.testing.assert_allclose(t["r"], led.sim.drawn.position, atol=1e-12)
    np.testing.assert_allclose(t["v"], led.sim.drawn.velocity, atol=1e-12)
    np.testing.assert_allclose(t["q"], led.path(0.0), atol=1e-12)
    assert t["quat"][3] == pytest.approx(np.sin(0.5 * led.sim.drawn.heading))
    assert t["rotor_thrust"].sum() == pytest.approx(led.sim.scene.uav_mass * G)


@pytest.mark.parametrize("wind", [2.0, 4.0, 6.5])
def test_uav_that_has_hovered_for_long_in_a_steady_wind_starts_in_balance(waiting, wind):
    """It leans by atan(c v/W) and knows what translational lift gives its rotors: it stays, but for what its plate makes of it
    that swings until it is plumb. 7.2 m/s are the most that flies."""
    led = waiting(
        air={"wind_mps": wind, "towards_deg": 90.0, "profile": "even"},
        place={"start_speed_mps": 0.0},
        link={"watchdog_ms": 1e4},
    )
    s, d = led.sim.scenario, led.sim.data
    start = d.qpos[led.sim.scene.uav_qpos].copy()
    lean = np.arctan(s.uav.drag_nspm * wind / (led.sim.scene.uav_mass * 9.81))
    up = d.xmat[led.sim.scene.uav_body].reshape(3, 3)[:, 2]
    np.testing.assert_allclose(up, [0.0, -np.sin(lean), np.cos(lean)], atol=1e-9)
    ticks = led.step(500)["truth"]
    assert np.abs(d.qpos[led.sim.scene.uav_qpos[:3]] - start[:3]).max() < 4e-3
    assert np.abs(ticks["v_cm"]).max() < 0.02


def test_gusts_and_recorded_wind_reach_the_uav_tick_by_tick(waiting):
    """Across blocks of noise, and again after `connect`."""
    gust = {"at_s": 0.2, "peak_mps": 5.0, "length_m": 2.0, "direction": [0.0, 1.0, 0.0]}
    led = waiting(air={"gusts": [gust]})
    felt: list = []
    for _ in range(2):
        felt.clear()
        led.step(1500, watch=lambda sim: felt.append(sim.world["kept"]["air"]["velocity"][0].copy()))
        np.testing.assert_allclose(felt, led.sim.timed_wind[:1500], atol=1e-15)
        assert np.max(felt) == pytest.approx(5.0)
        led.sim.connect()


def test_hinge_levels_the_uav_whatever_the_arms_pose(hinged):
    t = hinged().step()["truth"][0]
    np.testing.assert_allclose(np.abs(t["quat"]), [1.0, 0.0, 0.0, 0.0], atol=1e-9)


def tilt_deg(ticks):
    up = Rotation.from_quat(ticks["truth"]["quat"], scalar_first=True).as_matrix()[:, 2, 2]
    return np.rad2deg(np.arccos(np.clip(up, -1.0, 1.0)))


@pytest.mark.parametrize(("kp", "stands"), [(0.40, True), (0.20, False)])
def test_uav_stands_on_its_hinge_only_above_the_stiffness_m_g_l(hinged, sway, kp, stands):
    """The inverted pendulum tips below k_p = m g l = 0.283 N·m/rad and stands above it. Negative control of the attitude loop."""
    assert pytest.approx(0.2825, abs=1e-3) == MASS * G * LEVER
    led = hinged(lambda t: sway(min(t, 0.5)), onboard={"kp_nm": [kp, kp, 0.30]})
    tilt = tilt_deg(led.step(4000))
    assert (tilt[-500:].max() < 3.0) == stands
    # One that has tipped leans on the stop of its hinge.
    stop = np.deg2rad(led.sim.scenario.hinge.range_deg)
    assert (np.abs(led.sim.data.qpos[led.sim.scene.hinge_qpos[1:]]).max() > 0.99 * stop) != stands


NOISY = {"force_n": 0.05, "joint_velocity_rad_s": 1e-3, "attitude_rad": 2e-3, "rate_rad_s": 1e-2}


def test_same_seed_gives_identical_ticks_and_another_seed_others(hinged):
    one, two, other = (hinged(sensors=NOISY, run={"seed": s}).step(1200) for s in (5, 5, 6))
    assert one.tobytes() == two.tobytes()
    assert one.tobytes() != other.tobytes()
    assert np.abs(one["truth"]["r"] - other["truth"]["r"]).max() < 5e-3


@pytest.mark.parametrize("start", ["air", "cradle"])
def test_connect_starts_the_same_run_again(waiting, start):
    """Magnet, brake, faults and noise included, over more than one block of noise."""
    faults = [{"kind": "magnet_coil", "after_s": 0.1}, {"kind": "camera_frozen", "after_s": 0.5}]
    led = waiting(start, faults=faults, imperfections={"noise": True, "hover_noise_m": 0.01})
    runs = []
    for _ in range(2):
        led.sim.connect()
        led.tick.buffer[:] = np.zeros_like(led.tick.buffer)
        led.tick.command["uav_quat"][0, 0] = 1.0
        runs.append([led.step(1050, magnet=1, brake=0).tobytes(), led.step(50, brake=1).tobytes()])
    assert runs[0] == runs[1]


def test_noise_of_one_sensor_leaves_the_others_alone(hinged):
    """Encoder noise on or off: force-torque sensor and attitude keep theirs, bit for bit, while nothing has moved yet."""
    quiet = hinged(sensors=NOISY | {"joint_velocity_rad_s": 0.0}).step()["measurement"]
    noisy = hinged(sensors=NOISY | {"joint_position_rad": 1e-3}).step()["measurement"]
    for name in ("wrench", "uav_quat", "uav_rate"):
        np.testing.assert_array_equal(noisy[name], quiet[name])
    assert np.abs(noisy["q"] - quiet["q"]).min() > 0.0


@pytest.mark.parametrize("what", ["qpos", "qvel"])
def test_divergence_is_reported_at_once(hinged, what):
    """MuJoCo on its own would put the scene back to its start and go on, and the record would show a flight."""
    led = hinged()
    led.step(3)
    getattr(led.sim.data, what)[2] = np.nan
    led.step(1, tau=0.0)
    with pytest.raises(PlantError, match="tick 4 are not finite"):
        led.step(1, tau=0.0)


@pytest.mark.parametrize("field", ["tau", "thrust", "uav_quat", "delta_tau"])
def test_command_that_is_not_finite_is_refused_and_not_applied(waiting, field):
    led = waiting()
    led.step()
    before = led.sim.data.ctrl.copy()
    led.sim.read(led.tick)
    led.tick.command[field] = np.nan
    with pytest.raises(PlantError, match="tick 1 are not finite"):
        led.sim.command(led.tick)
    np.testing.assert_array_equal(led.sim.data.ctrl, before)


def test_command_answers_what_was_really_applied(waiting):
    led = waiting()
    led.sim.read(led.tick)
    led.tick.command["tau"], led.tick.command["thrust"] = 1e4, 3.0
    applied = led.sim.command(led.tick)
    np.testing.assert_array_equal(applied["tau"][0], [176.0, 176.0, 100.0, 100.0, 100.0, 38.0, 38.0])
    assert applied["thrust"] == 3.0
    assert led.tick.command["tau"][0, 0] == 1e4


def test_stop_may_be_called_at_any_time(hinged):
    led = hinged()
    for _ in range(2):
        assert led.sim.stop() is None
    led.step()
    assert led.sim.stop() is None
