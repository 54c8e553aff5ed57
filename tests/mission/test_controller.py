"""The controller in the loop: bad samples, singular poses, and that it never raises."""

import numpy as np
import pytest

from armland.records import Limit

FIELDS = ("q", "qd", "wrench", "uav_quat", "uav_rate")


def spoil(c, field, index, value, **sample):
    """A sample with one number that is none."""
    filled = {"q": c.arm.qpos.copy(), **sample}
    tick = c.sample(**filled)
    good = tick.buffer.copy()
    tick.measurement[field][0, index] = value
    c.law.update(tick)
    return good, tick


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("field", FIELDS)
def test_number_that_is_not_finite_is_replaced_by_the_last_good_one(controller, field, value):
    """The flag is set, and the command is as if the sample had been repeated."""
    c = controller("E3")
    good, tick = spoil(c, field, 1, value, wrench=1.0, rate=0.1)
    assert tick.health["flags"][0] & Limit.NON_FINITE
    assert not good["health"]["flags"][0] & Limit.NON_FINITE
    np.testing.assert_array_equal(tick.command["tau"], good["command"]["tau"])
    np.testing.assert_array_equal(tick.command["delta_tau"], good["command"]["delta_tau"])
    np.testing.assert_array_equal(tick.estimate["r"], good["estimate"]["r"])


def test_only_the_bad_number_is_old(controller, workplace):
    """Joint 2 is lost while the others move on: they are used as measured."""
    c = controller()
    c.sample(0)
    moved = workplace.home + 0.01
    lost = moved.copy()
    lost[2] = np.nan
    tick = c.sample(1, lost)
    held = moved.copy()
    held[2] = workplace.home[2]
    reference = controller().sample(1, held)
    np.testing.assert_array_equal(tick.estimate["r"], reference.estimate["r"])


def test_flag_goes_when_the_sample_is_good_again(controller):
    c = controller()
    _, tick = spoil(c, "qd", 0, np.nan)
    assert tick.health["flags"][0] & Limit.NON_FINITE
    assert not c.sample(2).health["flags"][0] & Limit.NON_FINITE


def test_last_good_value_is_kept_through_a_long_gap(controller, workplace):
    c = controller()
    good = c.sample(0).command["tau"].copy()
    lost = np.full(7, np.nan)
    for k in range(1, 50):
        tick = c.sample(k, lost, lost)
        assert tick.health["flags"][0] & Limit.NON_FINITE
    np.testing.assert_array_equal(tick.estimate["r"], c.sample(50).estimate["r"])
    assert np.isfinite(tick.command["tau"]).all()
    assert np.abs(tick.command["tau"] - good).max() < 1e-6


@pytest.mark.parametrize("field", FIELDS)
def test_command_is_finite_even_if_the_first_sample_is_not(controller, field):
    c = controller("E3")
    nan = {"q": "q", "qd": "qd", "wrench": "wrench", "uav_quat": "quat", "uav_rate": "rate"}[field]
    tick = c.sample(0, **{nan: np.nan})
    assert tick.health["flags"][0] & Limit.NON_FINITE
    for name in ("tau", "delta_tau", "thrust", "force", "torque"):
        assert np.isfinite(tick.command[name]).all()


def test_smallest_singular_value_is_reported(controller, workplace):
    c = controller()
    tick = c.sample(0)
    c.arm.update(workplace.home, np.zeros(7))
    expected = np.linalg.svd(c.arm.jacobian, compute_uv=False)[-1]
    assert tick.health["sigma_min"][0] == pytest.approx(expected)
    assert not tick.health["flags"][0] & Limit.SINGULAR


def test_singular_pose_is_flagged_and_commanded_with_finite_torques(controller):
    """Stretched out: elbow and wrist straight. The flag comes within the period of its evaluation."""
    c = controller("E3")
    q = np.array([0.3, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    for k in range(100):
        tick = c.sample(k, q, 0.1)
        assert np.isfinite(tick.command["tau"]).all()
    assert tick.health["flags"][0] & Limit.SINGULAR
    assert tick.health["sigma_min"][0] < 1e-6


def test_messages_carry_the_measurements_tick(controller):
    tick = controller().sample(321)
    for message in (tick.estimate, tick.reference, tick.command, tick.health):
        assert message["tick"][0] == 321


def test_update_depends_on_its_sample_alone(controller, workplace):
    """No hidden state in the paper's laws: the same sample gives the same command whatever came before."""
    c = controller("E3")
    first = c.sample(100, wrench=1.0).command.copy()
    for k in range(30):
        c.sample(k, workplace.home + 0.01 * np.sin(k), 0.3, wrench=2.0)
    np.testing.assert_array_equal(c.sample(100, wrench=1.0).command, first)


def test_reference_follows_the_path_and_holds_its_end(controller, workplace):
    c = controller()
    last = len(workplace.path) - 1
    for k, row in ((0, 0), (1234, 1234), (last, last), (last + 5000, last)):
        r = c.sample(k).reference[0]
        np.testing.assert_array_equal(np.concatenate([r["r"], r["v"], r["a"]]), workplace.path[row])
        np.testing.assert_array_equal(r["quat"], [1.0, 0.0, 0.0, 0.0])
        assert r["tick"] == k


def test_estimate_of_the_pivot_moves_as_the_arm_does(controller, workplace):
    """v is the rate of r: finite difference of the estimated position along φ̇."""
    c = controller()
    h = 1e-6
    rng = np.random.default_rng(12)
    for _ in range(10):
        q, qd = workplace.home + rng.normal(scale=0.05, size=7), rng.normal(scale=0.1, size=7)
        ahead = c.sample(0, q + h * qd, qd).estimate["r"][0].copy()
        behind = c.sample(0, q - h * qd, qd).estimate["r"][0].copy()
        np.testing.assert_allclose(c.sample(0, q, qd).estimate["v"][0], (ahead - behind) / (2.0 * h), atol=1e-8)


def test_phases_begin_and_end_with_the_paths_moves_and_the_mission_with_its_path(controller, workplace):
    c, rate = controller(), 1000
    settled, arrived, last = round(workplace.legs[0].start_s * rate), round(workplace.legs[-1].arrive_s * rate), 14499
    assert len(workplace.path) == last + 1
    for k, phase in (
        (0, "settle"),
        (settled - 1, "settle"),
        (settled, "follow"),
        (arrived - 1, "follow"),
        (arrived, "rest"),
        (last - 1, "rest"),
        (last, "done"),
    ):
        c.sample(k)
        assert c.law.phase == phase, k
    assert c.law.final


RAISES = "def law(q, omega, r, v, reference, thrust, tau_att, uav, gains):\n    raise ValueError('no')\n"
ENDLESS = "def law(q, omega, r, v, reference, thrust, tau_att, uav, gains):\n    return q[1:] / 0.0, q[1:] / 0.0\n"


@pytest.mark.parametrize("text", [RAISES, ENDLESS])
def test_law_that_fails_ends_in_rest_with_finite_commands(controller, paper, workplace, tmp_path, text):
    from armland.mission.controller import Controller
    from armland.mission.plan import plan
    from armland.mission.supervisor.table import FAULT

    file = tmp_path / "mine.py"
    file.write_text(text)
    made = plan(paper, "E1", law=f"{file}:law")
    law = Controller(made)
    for k in range(3):
        m = law.tick.measurement
        for name in ("tick", "arm_tick", "wrench_tick", "uav_tick", "uav_heard"):
            m[name] = k
        m["q"], m["qd"], m["uav_quat"][0, 0] = workplace.home, 0.0, 1.0
        law.update(law.tick)
        for name in ("tau", "force", "thrust"):
            assert np.isfinite(law.tick.command[name]).all()
    assert law.phase == "resting"
    assert law.tick.mission["fault"][0] == FAULT["law_failed"]
    assert law.board["kept"]["act"]["law"]["tick"][0] == 0
