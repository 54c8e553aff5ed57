"""A UAV's file as armland's scenes take it: a body `uav` with the sites `cm`, `pivot` and one for each rotor, from `rotor_1` on.

A file that has them is taken as it is. Of any other the numbers are taken, and the body is drawn from them.
"""

from pathlib import Path

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.models.airframe.body import described
from armland.models.airframe.foreign import Foreign, read_foreign
from armland.models.description import read_spec, resolve
from armland.rotations import Array
from armland.scenario import Scenario


def uav_file(scenario: Scenario) -> mujoco.MjSpec:
    """The UAV of a scenario as a new spec.

    Raises:
        ModelError: a file that cannot be used; the message names what it lacks.
    """
    if not scenario.uav.file:
        return described(scenario.uav, scenario.rotors)
    told = foreign_of(scenario)
    return read_spec(resolve(scenario.uav.file), "UAV file") if told is None else _drawn(told, scenario)


def foreign_of(scenario: Scenario) -> Foreign | None:
    """What a file says that is none of armland's form; None where it is, or where there is no file.

    Raises:
        ModelError: a file that cannot be used; the message names what it lacks.
    """
    file = scenario.uav.file
    if not file or _is_own(resolve(file), scenario.rotors.place_m is not None):
        return None
    told = read_foreign(_existing(resolve(file)))
    if told.place is None and scenario.rotors.place_m is None:
        raise ModelError(
            f"UAV file {file!r} says the mass of its body {told.body!r}, {told.mass:.4g} kg, and not where its rotors are: no four "
            "actuators push at sites of their own, and no four sites or bodies are called rotor_1, rotor_2 ... (motor, prop, thrust do "
            f'as well). Add such sites, z along the thrust, or write a TOML file with [uav] file = "{Path(file).name}" and [rotors] '
            "place_m = [[x, y, z], ...] from the centre of mass, and spin"
        )
    return told


def _existing(path: Path) -> Path:
    if not path.is_file():
        raise ModelError(f"UAV file {str(path)!r} does not exist; give an MJCF (.xml), URDF (.urdf) or TOML file")
    return path


def _is_own(path: Path, placed: bool) -> bool:
    # Whether all that a scene needs is there by name; `placed` where the scenario says where the rotors are.
    if path.suffix.lower() == ".urdf" or not path.is_file():
        return False
    try:
        spec = read_spec(path, "UAV file")
    except ModelError:
        return False
    sites = {s.name for s in spec.sites}
    return any(b.name == "uav" for b in spec.bodies) and {"cm", "pivot"} <= sites and (placed or "rotor_1" in sites)


def _drawn(told: Foreign, scenario: Scenario) -> mujoco.MjSpec:
    place = scenario.rotors.place_m if told.place is None else told.place.tolist()
    body = {"mass_kg": told.mass, "inertia_kgm2": told.inertia.tolist(), "lever_m": told.lever.tolist()}
    spec = described(scenario.uav.model_copy(update=body), scenario.rotors.model_copy(update={"place_m": place}))
    if told.place is not None and told.axis is not None:
        for i, (at, axis) in enumerate(zip(told.place, told.axis, strict=True)):
            spec.body("uav").add_site(name=f"rotor_{i + 1}", pos=at, quat=_towards(axis))
    return spec


def _towards(axis: Array) -> Array:
    # Rotation (4,) that takes z to `axis` (3,).
    quat = np.zeros(4)
    mujoco.mju_quatZ2Vec(quat, np.asarray(axis, float))
    return quat
