"""A UAV's values with the source of each: its file, the user's scenario, a rule from its size, or a default."""

from pathlib import Path
from typing import Any, NamedTuple

from armland.models.airframe.file import foreign_of
from armland.models.airframe.sizing import RULES, at, is_settled, said
from armland.models.parameters import rotor_set, uav_parameters
from armland.scenario import Scenario
from armland.scenario.files.airframe import sources

UNITS = {
    "kg": "kg",
    "kgm2": "kg·m²",
    "m": "m",
    "n": "N",
    "s": "s",
    "nspm": "N·s/m",
    "nm": "N·m",
    "nms": "N·m·s",
    "nps": "N/s",
    "npm": "N/m",
    "hz": "Hz",
    "deg": "°",
    "mpns": "m/(N·s)",
}
"""By the last part of a key's name."""

ODD = {"rotors.drag_torque_m": "N·m/N", "estimation.contact.contact_n.on": "N", "estimation.contact.contact_n.off": "N"}
ODD |= {"estimation.contact.release_n.on": "N", "estimation.contact.release_n.off": "N"}

SHOWN = (
    "rotors.time_constant_s",
    "plate.radius_m",
    "plate.thickness_m",
    "plate.drop_m",
    "hinge.range_deg",
    "skids.x_m",
    "skids.z_m",
)


class UavRow(NamedTuple):
    """Key, value, unit and source, as a line of the table."""

    key: str
    value: Any
    unit: str
    source: str


def rows_of(scenario: Scenario) -> list[UavRow]:
    """The rows for a scenario that is sized.

    Raises:
        ModelError: the UAV's file cannot be used.
    """
    told = sources(Path(scenario.airframe)) if scenario.airframe else {}
    body, rotors = uav_parameters(scenario), rotor_set(scenario)
    file = Path(scenario.uav.file).name or "file"
    named = {
        "uav.mass_kg": body.mass,
        "uav.inertia_kgm2": body.inertia.tolist(),
        "uav.lever_m": body.lever.tolist(),
        "rotors.place_m": rotors.place.tolist(),
        "rotors.axis": rotors.axis.tolist(),
        "rotors.spin": [int(s) for s in rotors.spin],
    }
    out = []
    for key, value in named.items():
        absent = _absent(key, scenario, file)
        source = _given(key, told) if is_settled(scenario, key) else absent
        out.append(UavRow(key, value, _unit(key), source))
    because, of_file = {rule.key: rule.because for rule in RULES}, said(scenario)
    for key in dict.fromkeys((*because, *SHOWN)):
        value = at(scenario, key)
        if is_settled(scenario, key):
            source = _given(key, told)
        elif key in of_file:
            source = file
        elif key in because:
            source = f"rule: {because[key]}"
        else:
            source = "default"
        out.append(UavRow(key, list(value) if isinstance(value, tuple) else value, _unit(key), source))
    return out


def _absent(key: str, scenario: Scenario, file: str) -> str:
    # Where a value of body or rotors comes from that the user has not set.
    foreign = foreign_of(scenario)
    if key == "rotors.spin":
        return file if foreign is not None and foreign.spin is not None else "alternating about the body"
    if key == "uav.lever_m" and foreign is not None and foreign.pivot is None:
        return "rule: the paper's hinge, shorter where the rotors sit closer"
    return file if scenario.uav.file else "along body z"


def _given(key: str, told: dict[str, str]) -> str:
    return told.get(key, "given")


def _unit(key: str) -> str:
    return ODD.get(key) or UNITS.get(key.rpartition("_")[2], "1")
