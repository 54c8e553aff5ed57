"""Pictures in place of the measurement model: each sample is that of its exposure, at the camera's rate, and late."""

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.plant.devices.camera_numbers import SAMPLE
from armland.plant.pictures import Pictures
from armland.plant.simulator import Simulator
from armland.records import Tick

LEVEL = np.array([1.0, 0.0, 0.0, 0.0])


class Roll:
    """Film with a picture of the number of its exposure; every third one shows nothing."""

    def __init__(self):
        self.count = 0

    def __call__(self, qpos, qvel):
        self.count += 1
        return None if self.count % 3 == 0 else (np.full(3, float(self.count)), LEVEL)


def delivered(pictures, capture):
    sample = np.zeros(1, SAMPLE)
    sample["capture"] = capture
    return (pictures.deliver(sample), *sample["position"][0])


def test_sample_is_that_of_its_exposure_whatever_was_taken_since():
    pictures = Pictures(Roll())
    for tick in (0, 33, 66, 100):
        pictures.expose(tick, LEVEL, LEVEL, False)
    assert delivered(pictures, 0) == (True, 1.0, 1.0, 1.0)
    assert delivered(pictures, 33) == (True, 2.0, 2.0, 2.0)
    assert delivered(pictures, 66)[0] is False
    assert delivered(pictures, 100) == (True, 4.0, 4.0, 4.0)
    assert delivered(pictures, 133)[0] is False


def test_frozen_camera_shows_the_last_picture_and_takes_none():
    roll = Roll()
    pictures = Pictures(roll)
    pictures.expose(0, LEVEL, LEVEL, False)
    pictures.expose(33, LEVEL, LEVEL, True)
    assert roll.count == 1
    assert delivered(pictures, 33) == (True, 1.0, 1.0, 1.0)


def test_simulator_delivers_pictures_at_the_cameras_rate_and_late(landing):
    roll, tick = Roll(), Tick(7)
    sim = Simulator(landing(), np.deg2rad([-4.7, -110.0, -7.9, -71.4, 11.8, 39.3, -7.2]), "air", photographer=roll)
    assert not sim.compilable
    sim.connect()
    arrivals = []
    for k in range(400):
        sim.read(tick)
        m = tick.measurement
        if m["camera_fresh"][0]:
            arrivals.append((k, int(m["camera_capture"][0]), m["camera_position"][0, 0]))
        tick.command["uav_quat"][0, 0] = 1.0
        sim.command(tick)
    assert roll.count == 12
    delays = np.array([k - capture for k, capture, _ in arrivals])
    assert (delays >= 50).all()
    assert (delays <= 75).all()
    # Exposure n is at tick 33.3 (n - 1), and every third found nothing.
    numbers = [round(capture * 0.03) + 1 for _, capture, _ in arrivals]
    assert [value for *_, value in arrivals] == numbers
    assert numbers == [1, 2, 4, 5, 7, 8, 10, 11]


def test_error_of_the_measurement_model_is_refused_on_pictures(landing):
    home = np.deg2rad([-4.7, -110.0, -7.9, -71.4, 11.8, 39.3, -7.2])
    with pytest.raises(ConfigurationError, match="camera_flip cannot act on pictures"):
        Simulator(landing(faults=[{"kind": "camera_flip"}]), home, "air", photographer=Roll())
    Simulator(landing(faults=[{"kind": "camera_frozen"}]), home, "air", photographer=Roll())
