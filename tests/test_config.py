"""Scenario files: each mistake is one readable message that names its place and what would have worked."""

import json
import re
import tomllib

import pytest

from armland.config import SCENARIOS, load_scenario, schema
from armland.errors import ArmlandError, ConfigurationError
from armland.experiments.assembly import survey
from armland.models.parameters import arm_model
from armland.plant.scene import build_scene
from armland.scenario import Scenario

PAPER = (SCENARIOS / "paper.toml").read_text("utf-8")
CALIBRATION = (SCENARIOS / "calibration.toml").read_text("utf-8")
EFFECTIVENESS = "[link.torque_effectiveness]"


@pytest.fixture
def folder(tmp_path):
    """A folder with the paper's scenario and calibration, changed by hand."""

    def write(scenario=PAPER, calibration=CALIBRATION):
        (tmp_path / "mine.toml").write_text(scenario, encoding="utf-8")
        (tmp_path / "calibration.toml").write_text(calibration, encoding="utf-8")
        return tmp_path / "mine.toml"

    return write


def refusal(file, step=load_scenario):
    """The message with which a scenario is refused, by loading it or by a later step."""
    with pytest.raises(ConfigurationError) as error:
        step(file)
    message = str(error.value)
    assert isinstance(error.value, ArmlandError)
    for internal in ("Traceback", "pydantic", "type=", "Value error", "input_value"):
        assert internal not in message
    return message


def changed(old, new, text=PAPER):
    assert old in text
    return text.replace(old, new)


def appended(text):
    return f"{PAPER}\n{text}\n"


def first(pattern, new, text=PAPER):
    """`text` with the first line that matches `pattern` replaced."""
    assert re.search(pattern, text, re.MULTILINE)
    return re.sub(pattern, new, text, count=1, flags=re.MULTILINE)


def recalibrated(name, value):
    """The calibration file with another value of `name`."""
    heading = re.escape(f"[{name}]")
    return re.sub(rf"(^{heading}\nvalue = ).*$", rf"\g<1>{value}", CALIBRATION, flags=re.MULTILINE)


def supported(name):
    """The range of a calibrated value, as a message writes it."""
    section, key = name.split(".")
    entry = tomllib.loads(CALIBRATION)[section][key]
    return f"{entry['low']:g} to {entry['high']:g}"


NO_TIME = first("^duration_s = .*$", "duration_s = 0.0")
SPOILT = {
    "unknown key": (
        changed("elbow_joint", "elbow_jiont"),
        ["arm.elbow_jiont: unknown key; known here:", "elbow_joint"],
    ),
    "unknown section": (appended("[armm]\nfile = 'x'"), ["armm: unknown key; known here: arm, calibration"]),
    "number with a unit": (
        appended('[link]\nwatchdog_ms = "30 ms"'),
        ["link.watchdog_ms: ", "valid number (got '30 ms')"],
    ),
    "gain that is no number": (appended("[control]\nk3 = nan"), ["control.k3: ", "finite number (got nan)"]),
    "infinite gain": (appended("[control]\nk3 = inf"), ["control.k3: ", "finite number (got inf)"]),
    "negative gain": (appended("[control]\nk3 = -1.0"), ["control.k3: ", "greater than 0 (got -1.0)"]),
    "one negative gain of six": (
        appended("[control]\nk1 = [1.0, 1.0, 1.0, 30.0, -30.0, 30.0]"),
        ["control.k1.4: ", "greater than 0 (got -30.0)"],
    ),
    "switch as a number": (
        appended("[control]\ncoriolis_feedforward = 1"),
        ["control.coriolis_feedforward: ", "(got 1)"],
    ),
    "inertia not positive definite": (
        changed("[uav]\n", "[uav]\ninertia_kgm2 = [[0.006, 0.0, 0.0], [0.0, -0.007, 0.0], [0.0, 0.0, 0.012]]\n"),
        ["uav.inertia_kgm2: ", "positive definite", "-0.007"],
    ),
    "inertia of no rigid body": (
        changed("[uav]\n", "[uav]\ninertia_kgm2 = [[0.001, 0.0, 0.0], [0.0, 0.001, 0.0], [0.0, 0.0, 0.012]]\n"),
        ["uav.inertia_kgm2: ", "no rigid body"],
    ),
    "rate that does not divide": (
        appended("[onboard]\nrate_hz = 300"),
        ["onboard.rate_hz = 300 does not divide run.rate_hz = 1000; nearest that do: ", "250"],
    ),
    "thrust beyond the rotors": (
        appended("[rotors]\nmax_thrust_n = 0.1"),
        ["control.thrust_n = ", " N is beyond the four rotors, which give ", "to 0.4 N"],
    ),
    "move in no time": (NO_TIME, ["trajectory.moves.0.duration_s: ", "greater than 0"]),
    "table that is a number": (
        changed("[arm]", "[run.x]").replace("title", "arm = 3\ntitle"),
        ["arm: ", "table (got 3)"],
    ),
    "missing calibration file": (
        changed('"calibration.toml"', '"calibrated.toml"'),
        ["calibration: file 'calibrated.toml' does not exist in "],
    ),
    "set here and calibrated": (
        appended("[link]\ntorque_effectiveness = 0.7"),
        ["link.torque_effectiveness is set here and in calibration.toml; keep one of the two"],
    ),
    "syntax": (PAPER + "\n[link\n", ["mine.toml is not valid TOML: ", "line "]),
}


@pytest.mark.parametrize("mistake", SPOILT)
def test_mistake_in_a_scenario_is_refused_by_its_place(folder, mistake):
    text, says = SPOILT[mistake]
    message = refusal(folder(text))
    for part in says:
        assert part in message, message


SPOILT_CALIBRATION = {
    "outside its range": (
        recalibrated("link.torque_effectiveness", "17.0"),
        "calibration.toml: link.torque_effectiveness: value 17 lies outside its supported range "
        + supported("link.torque_effectiveness"),
    ),
    "one of three outside its range": (
        recalibrated("onboard.kp_nm", "[0.4, 17.0, 0.4]"),
        "calibration.toml: onboard.kp_nm: value 17 lies outside its supported range "
        + f"{supported('onboard.kp_nm')} N·m/rad",
    ),
    "no reason given": (
        re.sub(r'because = ".*"', 'because = "?"', CALIBRATION, count=1),
        "calibration.toml: onboard.kp_nm: because: String should have at least 10 characters",
    ),
    "bare value": (
        re.sub(r"(?s)\[link.torque_effectiveness\].*?\n\n", "", CALIBRATION) + "\n[link]\ntorque_effectiveness = 0.6\n",
        "calibration.toml: link.torque_effectiveness: Input should be a table (got 0.6)",
    ),
    "unknown key": (
        changed(EFFECTIVENESS, "[link.torque_effectivenes]", CALIBRATION),
        "link.torque_effectivenes: unknown key; known here: downlink_delay_ms",
    ),
    "unknown word beside the value": (
        changed("because", "reason", CALIBRATION),
        "calibration.toml: onboard.kp_nm: reason: unknown key; known here: because, high, low, unit, value",
    ),
    "syntax": (CALIBRATION + "\n[[", "calibration.toml is not valid TOML: "),
}


@pytest.mark.parametrize("mistake", SPOILT_CALIBRATION)
def test_mistake_in_a_calibration_is_refused_by_its_place(folder, mistake):
    text, says = SPOILT_CALIBRATION[mistake]
    assert says in refusal(folder(calibration=text))


def test_value_outside_its_range_is_one_problem_and_not_also_missing(folder):
    text = recalibrated("link.torque_effectiveness", "17.0")
    assert refusal(folder(calibration=text)).startswith("mine.toml: 1 problem\n")


def test_several_mistakes_are_all_listed_at_once(folder):
    text = NO_TIME.replace("elbow_joint", "elbow_jiont")
    text += '\n[control]\nk3 = nan\n[link]\nwatchdog_ms = "30 ms"\n'
    message = refusal(folder(text, recalibrated("link.torque_effectiveness", "17.0")))
    assert message.startswith("mine.toml: 5 problems\n")
    assert len(message.splitlines()) == 6
    for place in (
        "calibration.toml: link.torque_effectiveness",
        "arm.elbow_jiont",
        "trajectory.moves.0.duration_s",
        "control.k3",
        "link.watchdog_ms",
    ):
        assert f"\n  {place}: " in message


def test_all_rates_that_do_not_divide_are_listed(folder):
    message = refusal(folder(appended("[onboard]\nrate_hz = 300\n[link]\nrate_hz = 2000")))
    assert message.startswith("mine.toml: 2 problems\n")
    assert "\n  onboard.rate_hz = 300 " in message
    assert "\n  link.rate_hz = 2000 " in message


@pytest.mark.parametrize("path", ["nowhere", "/nowhere/at/all.toml", "."])
def test_missing_scenario_is_refused_with_those_there_are(path):
    message = refusal(path)
    assert f"scenario file {path!r} does not exist" in message
    shipped = message.rsplit(": ", 1)[1].split(", ")
    assert "paper" in shipped
    # What is offered can be loaded: a calibration file is no scenario.
    for name in shipped:
        load_scenario(name)


def test_missing_arm_file_is_refused_by_name(folder):
    message = refusal(load_scenario(folder(changed('"lwr4.xml"', '"my_arm.urdf"'))), arm_model)
    assert "arm file 'my_arm.urdf' does not exist" in message


def test_missing_uav_file_is_refused_as_such(folder):
    message = refusal(load_scenario(folder(changed('"ardrone2.xml"', '"my_uav.xml"'))), build_scene)
    assert "UAV file 'my_uav.xml' does not exist" in message


def test_arm_without_the_named_frame_is_refused_with_those_it_has(folder):
    message = refusal(load_scenario(folder(changed('ee = "flange"', 'ee = "tool0"'))), arm_model)
    assert "no frame 'tool0'; its frames are: " in message
    assert "flange" in message
    assert "link_7" in message


def test_elbow_joint_that_the_arm_lacks_is_refused_with_those_it_has(folder):
    message = refusal(load_scenario(folder(changed('elbow_joint = "A3"', 'elbow_joint = "A9"'))), survey)
    assert "arm.elbow_joint" in message
    assert "A1, A2, E1, A3, A4, A5, A6" in message


def test_home_of_the_wrong_length_is_refused(folder):
    message = refusal(load_scenario(folder(changed("[arm]\n", "[arm]\nhome_rad = [0.0, 1.0]\n"))), survey)
    assert "arm.home_rad has 2 values; the arm has 7 joints" in message


def test_trajectory_outside_the_workspace_is_refused_with_time_and_place(folder):
    text = first("^to_m = .*$", "to_m = [2.10, 0.0, 0.0]")
    message = refusal(load_scenario(folder(text)), survey)
    assert "the trajectory leaves the workspace at t = " in message
    assert "out of reach by" in message


def test_arm_file_is_found_beside_the_scenario(folder, tmp_path):
    """A path in a scenario counts from the scenario's folder, wherever the command is run."""
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "arm.xml").write_text("<mujoco/>", encoding="utf-8")
    scenario = load_scenario(folder(changed('"lwr4.xml"', '"parts/arm.xml"')))
    assert scenario.arm.file == str(tmp_path / "parts" / "arm.xml")


def test_every_shipped_scenario_loads():
    names = [p.stem for p in SCENARIOS.glob("*.toml") if "[experiments" in p.read_text("utf-8")]
    assert "paper" in names
    for name in names:
        assert isinstance(load_scenario(name), Scenario)


def test_calibrated_values_arrive_in_the_scenario():
    scenario, calibration = load_scenario("paper"), tomllib.loads(CALIBRATION)
    for section, entries in calibration.items():
        for key, entry in entries.items():
            value = getattr(getattr(scenario, section), key)
            assert (list(value) if isinstance(value, tuple) else value) == entry["value"]


def test_override_replaces_one_value_and_keeps_its_neighbours():
    plain, changed_seed = (
        load_scenario("paper"),
        load_scenario("paper", {"run": {"seed": 42}, "hinge": {"range_deg": 30.0}}),
    )
    assert (changed_seed.run.seed, changed_seed.hinge.range_deg) == (42, 30.0)
    assert changed_seed.run.model_copy(update={"seed": plain.run.seed}) == plain.run
    assert changed_seed.control == plain.control


def test_override_is_checked_like_the_file():
    with pytest.raises(ConfigurationError, match=r"run\.seed: .*\(got 'x'\)"):
        load_scenario("paper", {"run": {"seed": "x"}})


def resolved(root, node):
    while "$ref" in node:
        node = root["$defs"][node["$ref"].rsplit("/", 1)[1]]
    return (
        next((resolved(root, n) for n in node["anyOf"] if n.get("type") != "null"), node) if "anyOf" in node else node
    )


def keys_outside(root, node, value, path=""):
    """Paths of keys in `value` that the schema does not know, walked by hand."""
    node = resolved(root, node)
    if isinstance(value, dict):
        for key, inner in value.items():
            below = node.get("properties", {}).get(key) or node.get("additionalProperties")
            if not below:
                yield f"{path}.{key}"
            else:
                yield from keys_outside(root, below, inner, f"{path}.{key}")
    elif isinstance(value, list) and isinstance(node.get("items"), dict):
        for i, inner in enumerate(value):
            yield from keys_outside(root, node["items"], inner, f"{path}[{i}]")


def test_schema_knows_every_key_of_the_shipped_scenario():
    root = json.loads(schema())
    data = tomllib.loads(PAPER)
    for section, entries in tomllib.loads(CALIBRATION).items():
        data.setdefault(section, {}).update({key: entry["value"] for key, entry in entries.items()})
    assert list(keys_outside(root, root, data)) == []
    # Negative control: the walk does find a key that is none.
    data["trajectory"]["moves"][0]["speed"] = 1.0
    assert list(keys_outside(root, root, data)) == [".trajectory.moves[0].speed"]


def test_schema_requires_what_has_no_default_and_describes_ranges():
    root = json.loads(schema())
    assert set(root["required"]) >= {"link", "control", "trajectory", "experiments"}
    assert root["$defs"]["Run"]["properties"]["rate_hz"]["minimum"] == 100
    assert root["$defs"]["Control"]["additionalProperties"] is False
