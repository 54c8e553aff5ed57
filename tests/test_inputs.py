"""Small inputs with one oddity each, as real files have them: each lands, or is refused before anything moves by a sentence that helps.

`data/arms` holds arms, `data/uavs` UAVs with their scenarios, `data/scenarios` landings.
"""

import re
from pathlib import Path

import pytest

from armland.errors import ArmlandError
from armland.experiments.episode import fly
from armland.scenario import load_scenario

pytestmark = pytest.mark.slow

DATA = Path(__file__).parent / "data"
PUBLISHED = {"deviation": {"level": "published"}}

REFUSED = {
    "weak.urdf": r"N·m",
    "no_inertial_link3.urdf": r"'l3'.*<inertial>",
    "t3_unbalanced.urdf": r"'l7'.*0\.003",
    "t19_one_limit_reversed.urdf": r"'j4'.*2\.1",
    "revrange.urdf": r"'joint_1'.*6\.283",
    "xacro.urdf": r"xacro FILE\.xacro -o",
    "tri.toml": r"3 rotors",
    "crash_align_speed.toml": r"bounds\.align_speed_mps",
    "crash_deep.toml": r"nested too deeply|TOML",
    "crash_duration.toml": r"duration_s",
    "crash_sensor_mass.toml": r"sensor_mass_kg",
    "crash_uav_age.toml": r"uav_age_ms",
    "endless.toml": r"duration_s(.|\n)*retries",
    "ignored_keys.toml": r"sensors\.force_bias_n(.|\n)*control\.k3",
    "joint_speed_wrong_length.toml": r"joint_speed_rad_s",
    "paper_traversal.toml": r"experiments",
}
"""What the refusal must say, by file."""

GIVEN_UP = {"friction5.urdf": "arm_blocked"}
"""Flights that the self-test ends, the UAV flying, and the fault that it must name: 5 N·m of dry friction hold the wrist."""

HELD = {"attitude_17deg_in_carry.toml": None, "uav_power_off_in_carry.toml": "power_lost"}
"""Faults while the UAV is held: it stays on the arm. With them the fault that the supervisor must name."""


def arm_of(path: Path):
    return {**PUBLISHED, "arm": {"file": str(path)}}


def files(folder, pattern="*"):
    return [pytest.param(path, id=path.name) for path in sorted((DATA / folder).glob(pattern))]


def landed_or_refused(path, make):
    """Fly seed 1: standing on the cradle, or refused by the words of `REFUSED`."""
    words = REFUSED.get(path.name)
    if words is None:
        result, fault = fly(make(), "landing", 1).result, GIVEN_UP.get(path.name, "none")
        assert result["state"] == ("standing" if fault == "none" else "flying"), result["reason"]
        assert (result["success"], result["fault"]) == (fault == "none", fault), result["reason"]
        return
    with pytest.raises(ArmlandError) as refusal:
        fly(make(), "landing", 1)
    assert re.search(words, str(refusal.value)), str(refusal.value)


@pytest.mark.parametrize("path", files("arms"))
def test_arm_lands_or_is_refused(path):
    landed_or_refused(path, lambda: load_scenario("landing", arm_of(path)))


@pytest.mark.parametrize("path", files("uavs", "*.toml"))
def test_uav_lands_or_is_refused(path):
    landed_or_refused(path, lambda: load_scenario(path, PUBLISHED))


@pytest.mark.parametrize("path", files("scenarios"))
def test_scenario_lands_holds_or_is_refused(path):
    if path.name not in HELD:
        landed_or_refused(path, lambda: load_scenario(path, PUBLISHED))
        return
    result = fly(load_scenario(path, PUBLISHED), "landing", 1).result
    assert result["state"] == "held", result["reason"]
    assert HELD[path.name] in (None, result["fault"]), result["reason"]
