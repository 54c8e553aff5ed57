"""The UAV on board: modes, its watchdog, its own hover, and the rotors that it stops."""

import mujoco
import numpy as np
import pytest

from armland.records import UavMode

FAULT = {"kind": "link_loss", "after_s": 0.2}


def test_it_hovers_by_itself_where_it_was_met(waiting):
    led = waiting()
    start = led.step()["truth"]["r"][0]
    truth = led.step(4000)["truth"][-1]
    assert np.linalg.norm(truth["r"] - start) < 0.15
    assert np.linalg.norm(truth["v"]) < 0.05


def test_told_to_it_hovers_a_step_aside(waiting):
    """Along its own axes, which it believes turned against the world by up to 10 degrees."""
    led = waiting()
    led.step(1000)
    start = led.tick.truth["r"][0].copy()
    moved = led.step(6000, uav_step=[0.3, 0.0, 0.2])["truth"]["r"][-1] - start
    assert np.linalg.norm(moved[:2]) == pytest.approx(0.3, abs=0.1)
    assert moved[0] > 0.2
    assert moved[2] == pytest.approx(0.2, abs=0.08)


@pytest.mark.parametrize(("turn", "left"), [(0.2, 0.0), (2.5, 2.15), (-2.5, 2.15)])
def test_spun_by_a_knock_it_keeps_the_heading_that_it_has_come_to(waiting, turn, left):
    """A small turn is turned back; after a large one the rotors level it first, and it does not sink meanwhile."""
    led = waiting()
    led.step(1000)
    data, scene, turned = led.sim.data, led.sim.scene, np.empty(4)
    mujoco.mju_mulQuat(
        turned, np.array([np.cos(0.5 * turn), 0.0, 0.0, np.sin(0.5 * turn)]), data.qpos[scene.uav_qpos[3:]]
    )
    data.qpos[scene.uav_qpos[3:]] = turned
    data.qvel[scene.uav_dof[:2]] = 1.0, -0.5
    truth = led.step(3000)["truth"]
    heading = 2.0 * np.arctan2(truth["quat"][:, 3], truth["quat"][:, 0])
    off = heading[-1] - heading[0]
    assert np.ptp(truth["r"][:, 2]) < 0.15
    assert abs(np.arctan2(np.sin(off), np.cos(off))) == pytest.approx(left, abs=0.02)


def test_guided_it_does_as_told(waiting):
    assert waiting().step(250, uav_mode=UavMode.GUIDED, thrust=3.0)["truth"]["v"][-1, 2] < -0.5


@pytest.mark.parametrize(("mode", "rises"), [(UavMode.GUIDED, True), (UavMode.HELD, False)])
def test_without_link_it_climbs_away_unless_it_is_held(waiting, mode, rises):
    led = waiting(faults=[FAULT])
    start = led.step()["truth"]["r"][0, 2]
    weight = led.sim.scene.uav_mass * 9.81 / led.sim.drawn.thrust_factor
    end = led.step(4000, uav_mode=mode, thrust=weight)["truth"]["r"][-1, 2]
    assert (end - start > 0.25) == rises


def test_hinged_it_goes_on_with_what_arrived_last(hinged):
    """Negative control of the test above: no watchdog, no climb."""
    led = hinged(faults=[FAULT])
    led.step(250, thrust=2.0)
    lift = led.step(1000, thrust=3.0)["truth"]["rotor_thrust"].sum(axis=1)
    assert lift[-1] == pytest.approx(2.0, abs=1e-3)
    assert led.sim.acted == (True,)


def test_landed_without_link_it_lets_the_rotors_run_down(waiting):
    led = waiting("cradle", faults=[FAULT])
    led.step(150, uav_mode=UavMode.LANDED, thrust=2.0)
    lift = led.step(1500, uav_mode=UavMode.LANDED, thrust=2.0)["truth"]["rotor_thrust"].sum(axis=1)
    assert lift[100] > 1.5
    assert lift[-1] < 0.01


def test_stands_on_the_cradle_with_its_rotors_stopped(waiting):
    truth = waiting("cradle").step(800)["truth"][-1]
    np.testing.assert_allclose(truth["r"], [0.68, 0.0, 0.701], atol=5e-4)
    assert truth["cradle_force"][2] == pytest.approx(0.5277 * 9.81, abs=0.01)
    assert not truth["rotor_thrust"].any()


def test_extra_torque_arrives_limited_and_then_weakened(bench):
    """The UAV accepts at most 0.03 N·m per axis and its rotors make 0.65 of what it accepts."""
    b = bench(link={"torque_limit_nm": [0.03, 0.03, 0.02], "torque_effectiveness": 0.65})
    b.kept["imu"]["quat"] = [1.0, 0.0, 0.0, 0.0]
    for k, (asked, acts) in enumerate(
        (([0.01, -0.02, 0.005], [0.0065, -0.013, 0.00325]), ([5.0, -0.02, -5.0], [0.0195, -0.013, -0.013]))
    ):
        np.testing.assert_allclose(b.act(k, delta_tau=asked), [0.0, 0.0, b.c["thrust"][0], *acts], atol=1e-12)


def test_it_runs_at_its_own_rate(bench):
    b = bench(onboard={"rate_hz": 200})
    lifts = [b.act(k, thrust=2.0 + 0.01 * k)[2] for k in range(20)]
    np.testing.assert_allclose(lifts, 2.0 + 0.05 * (np.arange(20) // 5), atol=1e-9)


@pytest.mark.parametrize(("mode", "stops"), [(UavMode.HELD, True), (UavMode.CAUGHT, True), (UavMode.GUIDED, False)])
def test_lost_rotor_stops_the_others_only_where_the_arm_carries(waiting, mode, stops):
    led = waiting(faults=[{"kind": "rotor_loss", "rotor": 2, "after_s": 0.1}])
    truth = led.step(500, uav_mode=mode, thrust=4.0)["truth"]
    assert (truth["rotor_thrust"][-1, 0] < 0.1) == stops


def test_rotor_watch_may_be_switched_off(waiting):
    led = waiting(faults=[{"kind": "rotor_loss", "rotor": 2, "after_s": 0.1}], onboard={"rotor_watch": 0.0})
    assert led.step(500, uav_mode=UavMode.HELD, thrust=4.0)["truth"]["rotor_thrust"][-1, 0] > 0.1


def test_position_noise_shakes_the_hover(waiting):
    still, shaken = (
        np.ptp(waiting(imperfections={"hover_noise_m": sigma}).step(300)["truth"]["rotor_thrust"].sum(axis=1)[200:])
        for sigma in (0.0, 0.05)
    )
    assert shaken > 3.0 * still
