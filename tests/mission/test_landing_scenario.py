"""Loading a landing's scenario: files beside it, what it keeps of its source, and errors with their path."""

import json
import shutil
from pathlib import Path

import pytest

from armland.config import SCENARIOS
from armland.errors import ConfigurationError
from armland.mission.landing_scenario import landing_scenario
from armland.models.description import ASSETS


def write(folder: Path, text: str) -> Path:
    (folder / "mine.toml").write_text(text)
    return folder / "mine.toml"


def test_base_and_arm_are_found_beside_the_scenario(tmp_path):
    for name in ("paper.toml", "calibration.toml"):
        shutil.copy(SCENARIOS / name, tmp_path / name)
    (tmp_path / "base.toml").write_text((tmp_path / "paper.toml").read_text().replace('title = "', 'title = "my own: '))
    (tmp_path / "arm.xml").write_text((ASSETS / "lwr4.xml").read_text())
    loaded = landing_scenario(write(tmp_path, 'base = "base.toml"\n[demonstrator.arm]\nfile = "arm.xml"\n'))
    assert loaded.demonstrator.title.startswith("my own: ")
    assert loaded.demonstrator.arm.file == str(tmp_path / "arm.xml")
    # What comes with armland still goes by its name.
    assert landing_scenario(write(tmp_path, '[demonstrator.arm]\nfile = "lwr4.xml"\n')).demonstrator.arm.file == (
        "lwr4.xml"
    )


def test_text_and_overrides_are_kept_and_the_caller_s_are_left_alone(tmp_path):
    (tmp_path / "arm.xml").write_text((ASSETS / "lwr4.xml").read_text())
    overrides = {"seed": 4, "demonstrator": {"arm": {"file": "arm.xml"}}}
    loaded = landing_scenario(write(tmp_path, "# mine\nseed = 3\n"), overrides)
    assert loaded.text == "# mine\nseed = 3\n"
    assert json.loads(loaded.overrides) == overrides == {"seed": 4, "demonstrator": {"arm": {"file": "arm.xml"}}}
    assert loaded.landing.seed == 4
    assert landing_scenario(tmp_path / "mine.toml").overrides == ""


def test_all_errors_are_listed_with_their_path(tmp_path):
    file = write(tmp_path, 'demonstrator = 3\nseed = "one"\n[place]\ncatch = 1\n[envelope]\njoint_speed_rad_s = []\n')
    with pytest.raises(ConfigurationError) as refusal:
        landing_scenario(file)
    text = str(refusal.value)
    assert text.startswith("mine.toml: 4 problems")
    for line in ("demonstrator: should be a table", "seed: ", "place.catch: unknown key", "envelope.joint_speed_rad_s"):
        assert f"\n  {line}" in text


def test_error_of_the_demonstrator_says_where_it_is_from(tmp_path):
    with pytest.raises(ConfigurationError, match=r"mine\.toml: base and \[demonstrator\]: paper\.toml: 1 problem\n"):
        landing_scenario(write(tmp_path, "[demonstrator.uav]\nmass = 1.0\n"))
