"""What the plant refuses before anything moves, each beside what it accepts; the contacts are those of the simulation itself."""

from itertools import product

import mujoco
import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.plant.simulator import Simulator
from armland.plant.start import check_start
from armland.records import Tick
from armland.scenario import load_scenario

HOME = np.deg2rad([-4.72, -109.96, -7.94, -71.39, 11.82, 39.34, -7.2])


def plant_of(**place):
    return Simulator(load_scenario("landing").replaced({"place": place}), HOME, "air")


def refused(**place):
    plant = plant_of(**place)
    with pytest.raises(ConfigurationError) as refusal:
        check_start(plant.scenario, plant.scene, HOME)
    return str(refusal.value)


def accepted(**place):
    plant = plant_of(**place)
    check_start(plant.scenario, plant.scene, HOME)
    return plant


def force_at(plant, pivot):
    """Force between arm and UAV, N, with the UAV's pivot there, level."""
    s, d = plant.scene, plant.data
    d.qpos[s.uav_qpos[:3]] = np.array(pivot) - s.lever
    d.qpos[s.uav_qpos[3:]] = [1.0, 0.0, 0.0, 0.0]
    mujoco.mj_forward(s.model, d)
    return np.linalg.norm(d.sensordata[s.sensor["arm_uav_force"] :][:3])


def test_in_the_shipped_scenario_the_uav_touches_nothing_wherever_it_starts():
    plant = accepted()
    plant.connect()
    place = plant.scenario.place
    middle = np.array(place.catch_m) + [0.0, 0.0, place.start_above_m]
    corners = [middle + np.array(c) * place.start_offset_m for c in product((-1.0, 1.0), repeat=3)]
    assert [force_at(plant, corner) for corner in corners] == [0.0] * 8
    # Among the links of the waiting arm it would.
    assert force_at(plant, np.array(place.catch_m) - [0.0, 0.0, 0.3]) > 0.0


def test_hint_holds_and_its_ends_are_the_last_that_do():
    text = refused(start_above_m=0.0)
    low, _, high = text.partition("start_above_m from ")[2].removesuffix(" would do").partition(" to ")
    for height in (low, high):
        accepted(start_above_m=float(height))
    for height in (float(low) - 0.011, float(high) + 0.011):
        assert "would do" in refused(start_above_m=height)


def test_start_that_is_refused_touches_the_arm_when_it_is_simulated():
    place = {"start_above_m": 0.0, "start_offset_m": [0.0, 0.0, 0.3]}
    assert "beside tool" in refused(**place) or "beside link" in refused(**place)
    plant = plant_of(start_above_m=0.0, start_offset_m=[0.0, 0.0, 0.0])
    plant.connect()
    s, d = plant.scene, plant.data
    for below, touches in ((0.0, False), (0.3, True)):
        d.qpos[s.uav_qpos[:3]] = np.array(plant.scenario.place.catch_m) + [0.0, 0.0, 0.06 - below]
        d.qpos[s.uav_qpos[3:]] = [1.0, 0.0, 0.0, 0.0]
        mujoco.mj_forward(s.model, d)
        force = d.sensordata[s.sensor["arm_uav_force"] :][:3]
        assert (np.linalg.norm(force) > 0.0) == touches


def test_marker_that_is_refused_as_unseen_is_not_found_by_the_camera():
    assert "does not see its marker" in refused(start_above_m=2.0)
    assert "does not see its marker" in refused(start_offset_m=[0.45, 0.0, 0.1])
    for above, seen in ((2.0, False), (0.2, True)):
        plant = plant_of(start_above_m=above, start_offset_m=[0.0, 0.0, 0.0], start_speed_mps=0.0)
        tick, fresh = Tick(7), 0
        plant.connect()
        for _ in range(300):
            plant.read(tick)
            fresh += int(tick.measurement["camera_fresh"][0])
            tick.command["tau"] = plant.data.qfrc_bias[plant.scene.joint_dof]
            plant.command(tick)
        assert (fresh > 0) == seen
