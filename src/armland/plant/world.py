"""The plant's one record: what each device is told, and what it keeps."""

from functools import lru_cache

import numpy as np

from armland.models.environment import environment_layout
from armland.models.parameters import rotor_effect
from armland.plant import truth
from armland.plant.devices import (
    air,
    brake,
    camera_numbers,
    encoders,
    imu,
    link,
    magnet,
    motors,
    onboard,
    rotors,
    wrench,
)
from armland.plant.draw import Draw, Start
from armland.plant.faults import table as faults
from armland.plant.scene.composition import Scene
from armland.plant.sea import deck, reference
from armland.records import Records
from armland.scenario import Scenario

TOLD = {
    "truth": truth,
    "encoders": encoders,
    "wrench": wrench,
    "imu": imu,
    "link": link,
    "onboard": onboard,
    "rotors": rotors,
    "motors": motors,
    "brake": brake,
    "camera": camera_numbers,
    "magnet": magnet,
    "faults": faults,
    "air": air,
    "deck": deck,
    "reference": reference,
}
"""Devices that are told something, by the name of their sub-record."""

KEPT = {name: device for name, device in TOLD.items() if name not in ("truth", "encoders", "deck")}
"""Devices that keep something."""


# Kept, so that equal layouts are one object, which compiled code recognises fastest.
@lru_cache
def world_layout(joints: int) -> np.dtype:
    """Layout of the plant's record for an arm with `joints` joints: `told` and `kept` with a sub-record for each device.

    `environment` is what surrounds the deck, `uav` the row of MuJoCo's bodies that the rotors push.
    """
    told = np.dtype([(name, device.told_layout(joints)) for name, device in TOLD.items()])
    kept = np.dtype([(name, device.kept_layout(joints)) for name, device in KEPT.items()])
    return np.dtype([("told", told), ("kept", kept), ("environment", environment_layout()), ("uav", "i8")])


def build_world(scenario: Scenario, scene: Scene, start: Start, drawn: Draw, phases: tuple[str, ...]) -> Records:
    """The plant's record (1,) with everything told and nothing kept.

    Args:
        scenario: what the plant really has.
        scene: of the same scenario.
        start: where the UAV is at first.
        drawn: imperfections of the seed.
        phases: names of the mission's phases, in the order of their numbers.

    Raises:
        ConfigurationError: a delay or a fault that cannot be.
        PlantError: a camera that cannot be.
    """
    world: Records = np.zeros(1, world_layout(scene.joints))
    t = world["told"]
    noisy = start == "hinged" or scenario.imperfections.noise
    world["uav"], world["environment"]["gravity"] = scene.uav_body, scenario.environment.gravity_mps2
    truth.tell(t["truth"], scene)
    encoders.tell(t["encoders"], scenario, scene, noisy)
    wrench.tell(t["wrench"], scenario, scene, drawn.wrench_bias, noisy)
    imu.tell(t["imu"], scenario, drawn, noisy)
    link.tell(t["link"], scenario)
    rotors.tell(t["rotors"], scenario, scene, drawn.thrust_factor)
    onboard.tell(t["onboard"], scenario, scene, rotor_effect(scenario))
    motors.tell(t["motors"], scene)
    brake.tell(t["brake"], scenario, scene)
    camera_numbers.tell(t["camera"], scenario, scene)
    magnet.tell(t["magnet"], scenario, scene)
    faults.tell(t["faults"], scenario, scene, phases)
    air.tell(t["air"], scenario, scene)
    deck.tell(t["deck"], scene)
    reference.tell(t["reference"], scenario, scene, noisy)
    return world


def absent(world: Records) -> set[str]:
    """Streams of `plant.noise` of the devices that `world` lacks."""
    lacks = set() if world["told"]["camera"]["fitted"].any() else {"camera", "flip"}
    return lacks if world["told"]["reference"]["fitted"].any() else lacks | {"reference"}
