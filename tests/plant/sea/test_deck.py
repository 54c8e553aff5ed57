"""The deck in MuJoCo: where the sea has it, what a force sensor at rest on it feels, and what a UAV standing on it does."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.experiments.episode import fly_prepared, prepare
from armland.plant.scene import composition
from armland.plant.sea.timed import deck_motion
from armland.scenario import load_scenario

SEA = {"sea": {"state": "ss3", "towards_deg": 120.0}}


def rigid(led, count, watch=None):
    """Fly `count` ticks with the arm held still on the deck: stiff joints, and the torque that going along with the deck takes."""
    s, d, rows = led.sim.scene, led.sim.data, []
    home, M = d.qpos[s.joint_qpos].copy(), np.zeros((s.model.nv, s.model.nv))
    for _ in range(count):
        k = led.sim.tick
        mujoco.mj_fullM(s.model, d, M)
        along = M[s.joint_dof, s.deck_dof : s.deck_dof + 6] @ led.sim.timed_deck[k, 12:]
        error = d.qpos[s.joint_qpos] - home
        tau = d.qfrc_bias[s.joint_dof] + along - 3000.0 * error - 120.0 * d.qvel[s.joint_dof]
        led.step(1, tau=tau)
        if watch is not None:
            rows.append(watch(led.sim))
    return np.array(rows)


def place(motion, t, point):
    """Where `point` (3,), D, is in W at the times `t`, and the deck's attitude."""
    q = motion.at(np.atleast_1d(t))
    R = Rotation.from_euler("ZYX", q[:, [5, 4, 3]])
    return q[:, :3] + R.apply(point), R


@pytest.fixture(scope="module")
def at_sea(waiting):
    led = waiting(**SEA)
    s, d, felt = led.sim.scene, led.sim.data, []
    fts = s.model.site("armland_fts").id
    deck = s.model.body("deck").id

    def look(sim):
        # Sensors speak of the state at the step's begin; so do the positions of `xpos`, which a step leaves behind.
        felt.append(np.concatenate([d.sensordata[s.sensor["force"] :][:3], d.xpos[deck], d.xquat[deck]]))

    rigid(led, 2500, watch=lambda sim: look(sim))
    mujoco.mj_kinematics(s.model, d)
    R_D = d.xmat[deck].reshape(3, 3)
    com = R_D.T @ (d.xipos[s.tool_body] - d.xpos[deck])
    return led, np.array(felt), com, R_D.T @ d.site_xmat[fts].reshape(3, 3)


def test_deck_is_where_the_sea_has_it(at_sea):
    led, felt, _, _ = at_sea
    motion, times = deck_motion(led.sim.scenario), np.arange(len(felt)) / 1000.0
    where, R = place(motion, times, np.zeros(3))
    np.testing.assert_allclose(felt[:, 3:6], where, atol=1e-9)
    turned = Rotation.from_quat(felt[:, 6:], scalar_first=True)
    assert (turned.inv() * R).magnitude().max() < 1e-9


def test_resting_force_sensor_feels_the_decks_acceleration(at_sea):
    """f = R_Sᵀ m (p̈ − g), p̈ by differences of the smooth motion of the tool's centre of mass: within 1e-3 N of some N."""
    led, felt, com, R_DS = at_sea
    motion, mass, h = deck_motion(led.sim.scenario), led.sim.scene.model.body_mass[led.sim.scene.tool_body], 1e-3
    times = np.arange(1000, 2500) / 1000.0
    before, now, after = (place(motion, times + dt, com) for dt in (-h, 0.0, h))
    acceleration = (before[0] - 2.0 * now[0] + after[0]) / h**2
    theory = mass * now[1].inv().apply(acceleration - [0.0, 0.0, -9.81]) @ R_DS
    assert np.abs(acceleration).max() > 0.2
    np.testing.assert_allclose(felt[1000:, :3], theory, atol=1e-3)


def test_truth_tells_of_the_deck(waiting):
    led = waiting(**SEA)
    rows = led.step(400)
    truth, motion = rows["truth"][300], deck_motion(led.sim.scenario)
    # Of the step before, which began at tick 299.
    t = np.array([0.299])
    np.testing.assert_allclose(truth["deck"], motion.at(t)[0, :3], atol=1e-9)
    np.testing.assert_allclose(truth["deck_v"], motion.at(t - 5e-4, 1)[0, :3], atol=1e-5)
    np.testing.assert_allclose(truth["deck_a"], motion.at(t, 2)[0, :3], atol=5e-4)
    R = [Rotation.from_euler("ZYX", motion.at(t + dt)[0, [5, 4, 3]]) for dt in (-1e-3, 0.0, 1e-3)]
    rate = (R[2] * R[0].inv()).as_rotvec() / 2e-3
    np.testing.assert_allclose(truth["deck_omega"], rate, atol=5e-4)
    turn = ((R[2] * R[1].inv()).as_rotvec() - (R[1] * R[0].inv()).as_rotvec()) / 1e-6
    np.testing.assert_allclose(truth["deck_alpha"], turn, atol=1e-3)


def test_uav_standing_on_the_cradle_rides_along(waiting):
    """It stays where it stands, to a millimetre, and the rails bear m (a − g)."""
    led = waiting(start="cradle", **SEA)
    s, d, seen = led.sim.scene, led.sim.data, []

    def where(sim):
        deck = s.model.body("deck").id
        apart = d.xpos[s.uav_body] - d.xpos[deck]
        seen.append(d.xmat[deck].reshape(3, 3).T @ apart)

    rigid(led, 2500, watch=where)
    moved = np.array(seen)[500:]
    assert np.ptp(moved, axis=0).max() < 1e-3
    assert led.tick.truth["foul"].max() == 0.0


@pytest.mark.parametrize("settles", [True, False])
def test_hinge_of_a_uav_on_the_cradle_is_as_quiet_as_on_land(monkeypatch, settles):
    """The arm holds the UAV by the magnet on the cradle, in waves of 1 cm: by tick the hinge's upward force hardly changes.

    Without the solver's tolerance for what is on the deck all of it jumps by up to 8 N: the unloading waits in vain.
    """
    if not settles:
        monkeypatch.setattr(composition, "settle_solver", lambda model: None)
    sea = {"state": "ss2", "height_m": 0.01, "hull_m": 4.0, "towards_deg": 120.0}
    still = {"sea": sea, "bounds": {"force_free_n": 0.02}, "deviation": {"level": "published"}}
    still["place"] = {"keep_hold": False}
    flight = prepare(load_scenario("landing", still), "landing", 401)
    ticks = fly_prepared(flight).ticks
    unload = np.flatnonzero(ticks["mission"]["phase"] == flight.brief.phases.index("unload"))[1000:]
    assert len(unload) > 2000
    jumps = np.diff(ticks["truth"]["hinge_force"][unload, 2]).std()
    assert jumps < 0.01 if settles else jumps > 0.2


def test_calm_sea_has_no_deck(waiting):
    led = waiting(sea={"state": "calm"})
    assert led.sim.scene.deck_dof == -1
    rows = led.step(5)
    np.testing.assert_array_equal(rows["truth"]["deck_quat"], np.tile([1.0, 0.0, 0.0, 0.0], (5, 1)))
    assert not rows["measurement"]["deck_known"].any()
