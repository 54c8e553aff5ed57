"""What failures do around the devices: samples that are no numbers, an attitude that is turned, bodies that are pushed."""

import numpy as np
import pytest

from armland.rotations import angle, conjugate, multiply


@pytest.mark.parametrize(
    ("device", "field"),
    [
        ("encoders", "q"),
        ("encoders", "qd"),
        ("wrench", "wrench"),
        ("attitude", "uav_quat"),
        ("camera", "camera_position"),
    ],
)
def test_device_that_fails_sends_no_numbers(waiting, device, field):
    led = waiting(faults=[{"kind": "non_finite", "device": device, "after_s": 0.1}])
    assert np.isfinite(led.step(90)["measurement"][field][-1]).all()
    assert np.isnan(led.step(20)["measurement"][field][-1]).all()


def test_reported_attitude_is_turned_once_and_the_uav_is_not(waiting):
    fault = {"kind": "attitude_offset", "size": 0.5, "direction": [1.0, 0.0, 0.0], "after_s": 0.1}
    ticks = waiting(faults=[fault]).step(400)[-1]
    turned = multiply(ticks["measurement"]["uav_quat"].copy(), conjugate(ticks["truth"]["quat"].copy()))
    assert angle(turned) == pytest.approx(0.5, abs=0.02)
    assert abs(ticks["truth"]["quat"][0]) > 0.99


def test_push_on_the_tool_is_felt_and_on_the_elbow_is_not(waiting):
    def change(body):
        led = waiting(faults=[{"kind": "push", "body": body, "size": 20.0, "after_s": 0.3}])
        return led.step(299)["measurement"]["wrench"][-1, 2], led.step(60)["measurement"]["wrench"][-1, 2]

    before, after = change("tool")
    assert after - before == pytest.approx(-20.0, abs=2.0)
    before, after = change("elbow")
    assert abs(after - before) < 3.0


@pytest.mark.parametrize("body", ["elbow", "tool"])
def test_push_ends_when_the_fault_does(hinged, body):
    """On the hinge nothing else writes the tool's row."""
    led = hinged(faults=[{"kind": "push", "body": body, "size": 50.0, "after_s": 0.1, "lasts_s": 0.05}])
    row = int(led.sim.world["told"]["faults"]["row"]["body"][0, 0])
    led.step(120)
    assert np.abs(led.sim.data.xfrc_applied[row]).max() == 50.0
    led.step(60)
    assert not led.sim.data.xfrc_applied[row].any()
