"""Files of before version 0.2: each key is found where it stands today, and none is lost."""

import json
from pathlib import Path
from typing import Any

import pytest

from armland.errors import ConfigurationError
from armland.scenario import SCENARIOS, Scenario, load_scenario
from armland.scenario.files.former import BELIEVED, FORMER, renamed
from armland.scenario.tables import leaves

VALUES: dict[str, Any] = {
    "seed": 7,
    "duration_s": 33.0,
    "eye.camera_m": [0.07, 0.0, -0.11],
    "eye.marker_m": [0.07, 0.0, -0.04],
    "eye.marker_size_m": 0.07,
    "eye.rate_hz": 25,
    "envelope.joint_speed_rad_s": [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0],
    "envelope": {"tilt_deg": 20.0, "slip_m": 0.02, "magnet_share": 0.8},
    "rotors.density_kgm3": 1.1,
    "rotors.drag_nspm": 0.3,
    "onboard_kp_nm": [1.0, 2.0, 3.0],
    "onboard_kd_nms": [0.1, 0.2, 0.3],
    "onboard_lead_s": 0.04,
    "onboard_rotor_watch": 0.5,
    "carry_share": 0.4,
    "magnet_rating_n": 200.0,
    "plate_mass_kg": 0.05,
    "extra_mass_kg": 0.1,
    "control.model_inertia_scale": 1.2,
}

LANDING = """
title = "a landing of before"
base = "paper"
seed = 3
duration_s = 40.0
carry_share = 0.45
onboard_kp_nm = [2.1, 2.1, 1.3]
magnet_rating_n = 150.0
plate_mass_kg = 0.05

[place]
catch_m = [0.62, 0.0, 0.86]

[rotors]
radius_m = 0.12
density_kgm3 = 1.2
drag_nspm = 0.2

[eye]
rate_hz = 60
marker_size_m = 0.05

[imperfections]
force_bias_n = 0.5

[bounds]
retries = 2

[envelope]
tilt_deg = 25.0
joint_speed_rad_s = [1.5, 1.5, 1.5, 1.5, 1.5, 1.5, 1.5]

[[faults]]
kind = "push"
size = 0.5

[demonstrator.uav]
file = "mine.xml"
mass_kg = 0.6
inertia_kgm2 = [[0.006, 0.0, 0.0], [0.0, 0.007, 0.0], [0.0, 0.0, 0.012]]
lever_m = [0.0, 0.0, -0.07]

[demonstrator.rotors]
max_thrust_n = 2.5
[demonstrator.control]
model_inertia_scale = 1.1
k3 = 30.0
[demonstrator.onboard]
rate_hz = 250
"""


def write(folder: Path, text: str) -> Path:
    (folder / "mine.toml").write_text(text)
    return folder / "mine.toml"


def value_at(scenario: Scenario, path: str) -> Any:
    value: Any = json.loads(scenario.model_dump_json())
    for step in path.split("."):
        value = value[step]
    return value


def nested(path: str, value: Any) -> dict[str, Any]:
    for key in reversed(path.split(".")):
        value = {key: value}
    return value


@pytest.mark.parametrize("old", FORMER)
def test_former_key_lands_where_it_stands_today(old) -> None:
    loaded, value = load_scenario("landing", nested(old, VALUES[old])), VALUES[old]
    for path, expected in (
        ((f"{FORMER[old]}.{k}", v) for k, v in value.items()) if isinstance(value, dict) else [(FORMER[old], value)]
    ):
        assert value_at(loaded, path) == expected
        assert value_at(load_scenario("landing"), path) != expected if not path.startswith("belief") else True
        assert path in loaded.own
    assert not any(key.startswith(old.split(".")[0] + ".") for key in loaded.own if "." not in FORMER[old])


def test_every_new_place_is_a_key_of_the_scenario() -> None:
    plain = json.loads(load_scenario("landing").model_dump_json())
    known = set(leaves({k: v for k, v in plain.items() if k != "belief"})) | set(plain)
    assert {new.removeprefix("belief.") for new in FORMER.values()} <= known
    assert set(VALUES) == set(FORMER)


def test_landing_of_before_is_read_as_it_was_meant(tmp_path) -> None:
    loaded = load_scenario(write(tmp_path, LANDING))
    assert (loaded.run.seed, loaded.run.duration_s) == (3, 40.0)
    assert loaded.control.thrust.carry_share == 0.45
    assert (loaded.onboard.kp_nm, loaded.onboard.rate_hz) == ((2.1, 2.1, 1.3), 250)
    # The rest is that of the landing, not of the paper's experiments.
    assert (loaded.onboard.controller, loaded.onboard.lead_s) == ("cascade", 0.05)
    assert loaded.hinge == load_scenario("landing").hinge
    assert (loaded.rotors.radius_m, loaded.rotors.max_thrust_n, loaded.rotors.inflow) == (0.12, 2.5, True)
    assert (loaded.environment.air_density_kgm3, loaded.uav.drag_nspm) == (1.2, 0.2)
    assert (loaded.camera.rate_hz, loaded.camera.marker_size_m, loaded.plate.mass_kg) == (60, 0.05, 0.05)
    assert (loaded.limits.tilt_deg, loaded.arm.joint_speed_rad_s) == (25.0, (1.5,) * 7)
    assert (loaded.bounds.retries, loaded.imperfections.force_bias_n, len(loaded.faults)) == (2, 0.5, 1)
    # Mass, inertia and lever of before were what the law believed; the file is what flies.
    assert (loaded.uav.file, loaded.uav.mass_kg, loaded.uav.lever_m) == ("mine.xml", None, None)
    belief = loaded.believed()
    assert (belief.uav.mass_kg, belief.uav.lever_m, belief.uav.file) == (0.6, (0.0, 0.0, -0.07), "mine.xml")
    assert (belief.arm.inertia_scale, loaded.arm.inertia_scale) == (1.1, 1.0)


def test_every_key_of_before_is_among_the_users_own(tmp_path) -> None:
    own = load_scenario(write(tmp_path, LANDING)).own
    assert own >= {
        "run.seed",
        "limits.tilt_deg",
        "camera.rate_hz",
        "belief.uav.mass_kg",
        "belief.arm.inertia_scale",
        "faults",
    }
    assert len(own) == 25


def test_paper_of_before_is_read_as_it_was_meant(tmp_path) -> None:
    text = (SCENARIOS / "paper.toml").read_text("utf-8")
    former = text.replace("drag_nspm = 0.0", "mass_kg = 0.5").replace(
        "[rotors]\ninflow = false", "[control]\nmodel_inertia_scale = 0.9"
    )
    assert former != text
    loaded = load_scenario(write(tmp_path, former))
    assert loaded.arm.inertia_scale == 1.0
    assert loaded.believed().arm.inertia_scale == 0.9


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("seed = 1\n[run]\nseed = 2\n", "seed: run.seed is the same and set too; keep one of the two"),
        ("[envelope]\ntilt_deg = 1.0\n[limits]\ntilt_deg = 2.0\n", "envelope.tilt_deg: limits.tilt_deg is the same"),
        (
            "[demonstrator.uav]\nmass_kg = 1.0\n[belief.uav]\nmass_kg = 2.0\n",
            "demonstrator.uav.mass_kg: belief.uav.mass_kg is",
        ),
        (
            "[demonstrator.rotors]\nradius_m = 1.0\n[rotors]\nradius_m = 2.0\n",
            "demonstrator.rotors.radius_m: rotors.radius_m is",
        ),
        ("demonstrator = 3\n", "demonstrator: should be a table (got 3)"),
        ("[demonstrator]\nuav = 3\n[uav]\nfile = 'a'\n", "demonstrator.uav: uav is the same and set too"),
        ("[demonstrator.uav]\nmass = 1.0\n", "uav.mass: unknown key; known here: drag_nspm"),
        ("[place]\ncatch = 1\n", "place.catch: unknown key; known here: above_m"),
        ("[envelope]\njoint_speed_rad_s = []\n", "arm.joint_speed_rad_s: list should have at least 1 item"),
        ("[eye]\ncolour = 1\n", "eye: unknown key"),
    ],
)
def test_mistake_in_a_file_of_before_is_refused_and_no_value_is_lost(tmp_path, text, says) -> None:
    with pytest.raises(ConfigurationError) as refusal:
        load_scenario(write(tmp_path, text))
    assert f"\n  {says}" in str(refusal.value)


def test_all_errors_are_listed_with_their_path(tmp_path) -> None:
    file = write(tmp_path, 'demonstrator = 3\nseed = "one"\n[place]\ncatch = 1\n[envelope]\njoint_speed_rad_s = []\n')
    with pytest.raises(ConfigurationError) as refusal:
        load_scenario(file)
    text = str(refusal.value)
    assert text.startswith("mine.toml: 4 problems")
    for line in ("demonstrator: should be a table", "run.seed: ", "place.catch: unknown key", "arm.joint_speed_rad_s"):
        assert f"\n  {line}" in text


def test_believed_keys_move_and_the_others_of_the_uav_stay() -> None:
    data = {"demonstrator": {"uav": {**dict.fromkeys(BELIEVED, 1.0), "file": "a.xml"}}}
    assert renamed(data) == []
    assert data == {"uav": {"file": "a.xml"}, "belief": {"uav": dict.fromkeys(BELIEVED, 1.0)}}


@pytest.mark.parametrize(
    "text", ["", "[imperfections]\nnoise = false\n", 'base = "paper"\n[place]\nabove_m = 0.05\n', "seed = 2\n"]
)
def test_landing_of_before_stands_on_the_landing(tmp_path, text) -> None:
    assert load_scenario(write(tmp_path, text)).onboard.controller == "cascade"


@pytest.mark.parametrize(
    "text", ['base = "paper"\n', 'base = "paper"\n[run]\nseed = 3\n', 'base = "paper"\n[control]\nk3 = 30.0\n']
)
def test_file_that_stands_on_the_paper_keeps_it(tmp_path, text) -> None:
    assert load_scenario(write(tmp_path, text)).onboard.controller == "quaternion_pd"
