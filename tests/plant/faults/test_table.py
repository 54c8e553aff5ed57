"""Faults act when they should and only then, on what they should and on nothing else."""

from pathlib import Path

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.plant.faults.table import tell, told_layout
from armland.plant.scene.composition import build_scene
from armland.scenario import load_scenario
from armland.scenario.faults import FAILURES, SHAPES

ARMS = Path(__file__).parents[2] / "data" / "arms"
EXAMPLES = Path(__file__).parents[3] / "examples"


@pytest.mark.parametrize(
    ("kind", "clock"),
    [
        ("downlink_loss", "uav_tick"),
        ("arm_stale", "arm_tick"),
        ("wrench_frozen", "wrench_tick"),
        ("camera_lost", "camera_capture"),
    ],
)
def test_fault_stops_the_clock_of_its_device_alone(waiting, kind, clock):
    m = waiting(faults=[{"kind": kind, "after_s": 0.3}]).step(1000)["measurement"][-1]
    for name in ("uav_tick", "arm_tick", "wrench_tick", "camera_capture"):
        assert (m["tick"] - m[name] > 600) == (name == clock)


def test_clocks_of_healthy_devices_say_how_old_a_sample_is(waiting):
    m = waiting().step(500)["measurement"][-1]
    assert m["tick"] == m["arm_tick"] == m["wrench_tick"] == 499
    assert 12 <= m["tick"] - m["uav_tick"] <= 17
    assert 50 <= m["tick"] - m["camera_capture"] <= 110


def test_uplink_loss_leaves_the_downlink(waiting):
    m = waiting(faults=[{"kind": "uplink_loss", "after_s": 0.3}]).step(1000)["measurement"][-1]
    assert 290 <= m["uav_heard"] <= 330
    assert m["tick"] - m["uav_tick"] < 20


def test_frozen_camera_keeps_its_clock_and_repeats_its_image(waiting):
    led = waiting(faults=[{"kind": "camera_frozen", "after_s": 0.5}])
    first = led.step(900)["measurement"]["camera_position"][-1]
    m = led.step(300)["measurement"][-1]
    assert m["tick"] - m["camera_capture"] < 120
    np.testing.assert_array_equal(m["camera_position"], first)


def test_encoder_that_is_off_shows_in_one_joint(waiting):
    ticks = waiting(faults=[{"kind": "encoder_offset", "joint": 2, "size": 0.1, "after_s": 0.1}]).step(150)[-1]
    np.testing.assert_allclose(ticks["measurement"]["q"] - ticks["truth"]["q"], [0, 0.1, 0, 0, 0, 0, 0], atol=1e-12)


def test_twist_and_overload_act_on_the_uav(waiting):
    twist = {"kind": "twist", "size": 0.2, "direction": [0.0, 0.0, 1.0], "after_s": 0.1}
    assert waiting(faults=[twist]).step(200)["truth"]["omega"][-1, 2] > 0.3
    assert abs(waiting().step(200)["truth"]["omega"][-1, 2]) < 0.1
    assert waiting(faults=[{"kind": "overload", "size": 5.0}]).step(200)["truth"]["v"][-1, 2] < -0.5


def test_unreachable_uav_hovers_elsewhere(waiting):
    fault = {"kind": "unreachable", "size": 0.3, "direction": [0.0, 1.0, 0.0], "after_s": 0.1}
    r = waiting(faults=[fault]).step(3000)["truth"]["r"]
    assert r[-1, 1] - r[0, 1] == pytest.approx(0.3, abs=0.1)


@pytest.mark.parametrize(("kind", "report", "fault"), [("magnet_coil", 0.49, 1), ("magnet_slip", 0.7, 0)])
def test_weak_magnet_shows_in_its_self_test(waiting, kind, report, fault):
    led = waiting(faults=[{"kind": kind, "size": 0.3}])
    m = led.step(120, magnet=2)["measurement"][-1]
    assert m["magnet_force"] == pytest.approx(report * 177.0, rel=0.03)
    assert m["magnet_fault"] == fault


def test_drift_grows_with_the_faults_own_time(waiting):
    led = waiting(faults=[{"kind": "wrench_drift", "size": 5.0, "after_s": 0.2}])
    z = led.step(700)["measurement"]["wrench"][:, 2]
    assert z[650] - z[190] == pytest.approx(5.0 * 0.45, abs=0.1)


def test_fault_waits_for_its_phase_and_for_its_time(bench_in_air):
    """Armed when its phase first begins, it acts from after_s on for lasts_s, and does not begin again."""
    fault = {"kind": "arm_stale", "phase": "carry", "after_s": 0.01, "lasts_s": 0.0195}
    b = bench_in_air(faults=[fault], phases=("approach", "carry"))
    phase = [0] * 10 + [1] * 50 + [0] * 10 + [1] * 50
    stale = []
    for k, number in enumerate(phase):
        b.act(k, number)
        stale.append(int(b.kept["faults"]["arm_stale"][0]))
    np.testing.assert_array_equal(np.flatnonzero(stale), np.arange(20, 40))


def test_fault_that_never_acted_is_known(waiting):
    faults = [{"kind": "arm_stale", "after_s": 0.05, "lasts_s": 0.01}, {"kind": "twist", "phase": "carry"}]
    led = waiting(phases=("approach", "carry"), faults=faults)
    assert led.sim.acted == (False, False)
    led.step(100)
    assert led.sim.acted == (True, False)
    led.sim.connect()
    assert led.sim.acted == (False, False)


LARGE = {"link_delay": {"size": 100.0}, "gust": {"size": 5.0, "lasts_s": 1.0}}
"""What shows within 0.4 s."""


# Without a plate on the magnet, what is left of its pull acts on nothing, and an arm at rest reads alike when it is frozen.
@pytest.mark.parametrize("kind", [kind for kind in FAILURES if kind not in ("magnet_stuck", "encoder_frozen")])
def test_every_kind_changes_the_run_and_healthy_runs_are_alike(waiting, kind):
    def run(faults):
        led = waiting("cradle" if kind.startswith("magnet") else "air", faults=faults)
        return led.step(400, magnet=1).tobytes()

    used = {"size": 0.5} if SHAPES[kind].unit else {}
    used |= {"direction": [0.0, 1.0, 0.0]} if "direction" in SHAPES[kind].keys else {}
    used |= LARGE.get(kind, {})
    assert run([{"kind": kind, "after_s": 0.02, **used}]) != run([])
    assert run([{"kind": kind, "after_s": 5.0, **used}]) == run([])


def test_fault_in_an_unknown_phase_is_refused(waiting):
    with pytest.raises(ConfigurationError, match="no phase 'lunch'; the mission's phases are approach, carry"):
        waiting(phases=("approach", "carry"), faults=[{"kind": "link_loss", "phase": "lunch"}])


def test_fault_of_a_joint_that_is_not_there_is_refused(waiting):
    with pytest.raises(ConfigurationError, match="joint 8 does not exist; the arm has joints 1 to 7"):
        waiting(faults=[{"kind": "encoder_offset", "joint": 8}])


def test_loss_of_a_rotor_that_is_not_there_is_refused(waiting):
    with pytest.raises(ConfigurationError, match="rotor 5 does not exist; the UAV has rotors 1 to 4"):
        waiting(faults=[{"kind": "rotor_loss", "rotor": 5}])
    waiting(faults=[{"kind": "rotor_loss", "rotor": 4}])


@pytest.mark.parametrize(
    "fault",
    [
        {"kind": "magnet_coil"},
        {"kind": "magnet_stuck"},
        {"kind": "camera_lost"},
        {"kind": "wrong_marker"},
        {"kind": "non_finite", "device": "camera"},
    ],
)
def test_fault_of_a_device_that_is_not_there_is_refused(hinged, fault):
    with pytest.raises(ConfigurationError, match="cannot act: the mission flies without a"):
        hinged(faults=[fault])


@pytest.mark.parametrize(
    ("file", "link"),
    [
        ("lwr4.xml", "arm/link_4"),
        (EXAMPLES / "six_axis.urdf", "arm/link_3"),
        pytest.param(ARMS / "eight_axis.xml", "arm/forearm", marks=pytest.mark.slow),
    ],
)
def test_elbow_is_pushed_where_the_arm_bends(file, link):
    """The link behind the joint between upper arm and forearm, whatever its number: of six joints the third, of eight the fifth."""
    arm = {"file": str(file), "ee": None, "elbow_joint": None}
    faults = [{"kind": "push", "body": "elbow", "size": 5.0}]
    scenario = load_scenario("landing", {"arm": arm, "place": {"home_deg": None}, "faults": faults})
    scene, told = build_scene(scenario, "free"), np.zeros(1, told_layout(7))
    tell(told, scenario, scene, ())
    assert scene.model.body(int(told["row"]["body"][0, 0])).name == link
