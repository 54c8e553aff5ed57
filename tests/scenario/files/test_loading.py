"""Scenario files: each mistake is one readable message that names its place and what would have worked."""

import json
import os
import re

import pytest

from armland.errors import ArmlandError, ConfigurationError
from armland.scenario import SCENARIOS, Scenario, load_scenario
from armland.scenario.files.toml import LARGEST
from armland.scenario.refusal import MOST_LINES

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


def refusal(file, overrides=None):
    """The message with which a scenario is refused."""
    with pytest.raises(ConfigurationError) as error:
        load_scenario(file, overrides)
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


NO_TIME = first("^duration_s = .*$", "duration_s = 0.0")
SPOILT = {
    "unknown key": (
        changed("elbow_joint", "elbow_jiont"),
        ["arm.elbow_jiont: unknown key; known here:", "elbow_joint"],
    ),
    "unknown section": (
        appended("[armm]\nfile = 'x'"),
        ["armm: unknown key; known here: air, airframe, arm, belief, bounds, calibration"],
    ),
    "number with a unit": (
        appended('[link]\nwatchdog_ms = "30 ms"'),
        ["link.watchdog_ms: ", "valid number (got '30 ms')"],
    ),
    "gain that is no number": (appended("[control]\nk3 = nan"), ["control.k3: ", "nan lies outside 1e-09 to 1e+06"]),
    "infinite gain": (appended("[control]\nk3 = inf"), ["control.k3: ", "inf lies outside 1e-09 to 1e+06"]),
    "negative gain": (appended("[control]\nk3 = -1.0"), ["control.k3: ", "-1.0 lies outside 1e-09 to 1e+06"]),
    "one negative gain of six": (
        appended("[control]\nk1 = [1.0, 1.0, 1.0, 30.0, -30.0, 30.0]"),
        ["control.k1.4: ", "-30.0 lies outside 1e-09"],
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
    "move in no time": (NO_TIME, ["trajectory.moves.0.duration_s: 0.0 lies outside 1e-06 to 3600"]),
    "table that is a number": (
        changed("[arm]", "[run.x]").replace("title", "arm = 3\ntitle"),
        ["arm: ", "table (got 3)"],
    ),
    "missing calibration file": (
        changed('"calibration.toml"', '"calibrated.toml"'),
        ["mine.toml: calibration: file 'calibrated.toml' does not exist beside the scenario"],
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


def test_arm_file_is_found_beside_the_scenario(folder, tmp_path):
    """A path in a scenario counts from the scenario's folder, wherever the command is run."""
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "arm.xml").write_text("<mujoco/>", encoding="utf-8")
    scenario = load_scenario(folder(changed('"lwr4.xml"', '"parts/arm.xml"')))
    assert scenario.arm.file == str(tmp_path / "parts" / "arm.xml")


def test_every_shipped_scenario_loads():
    names = [p.stem for p in SCENARIOS.glob("*.toml") if p.stem != "calibration"]
    assert {"paper", "landing", "compare"} <= set(names)
    for name in names:
        assert isinstance(load_scenario(name), Scenario)


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


def test_override_replaces_a_calibrated_value() -> None:
    assert load_scenario("paper", {"link": {"torque_effectiveness": 0.7}}).link.torque_effectiveness == 0.7


def test_text_and_overrides_are_kept_and_the_callers_are_left_alone(folder) -> None:
    file = folder(PAPER)
    (file.parent / "arm.xml").write_text("<mujoco/>")
    overrides = {"seed": 4, "demonstrator": {"arm": {"file": "arm.xml"}}}
    loaded = load_scenario(file, overrides)
    assert loaded.text == PAPER
    assert json.loads(loaded.overrides) == overrides == {"seed": 4, "demonstrator": {"arm": {"file": "arm.xml"}}}
    assert loaded.run.seed == 4
    assert loaded.arm.file == str(file.parent / "arm.xml")
    assert load_scenario(file).overrides == ""


def test_own_keys_are_those_of_the_file_and_what_overrides_it_not_those_of_a_base(tmp_path) -> None:
    (tmp_path / "base.toml").write_text('base = "landing"\n[uav]\ndrag_nspm = 0.3\n')
    (tmp_path / "mine.toml").write_text(
        'title = "x"\nbase = "base.toml"\n[envelope]\ntilt_deg = 20.0\n[[faults]]\nkind = "push"\n'
    )
    loaded = load_scenario(tmp_path / "mine.toml", {"run": {"seed": 3}, "belief": {"uav": {"mass_kg": 0.5}}})
    assert loaded.own == {"limits.tilt_deg", "faults", "run.seed", "belief.uav.mass_kg"}
    assert loaded.uav.drag_nspm == 0.3
    assert load_scenario("landing").own >= {"place.home_deg", "hinge.friction_nm"}


def test_files_that_a_scenario_names_are_found_beside_it(tmp_path, monkeypatch) -> None:
    """Arm, UAV, what is believed of them, and laws of one's own; what comes with armland still goes by its name."""
    for name in ("my.xml", "law.py"):
        (tmp_path / name).write_text("")
    (tmp_path / "mine.toml").write_text(
        '[uav]\nfile = "my.xml"\n[belief.uav]\nfile = "my.xml"\n[belief.arm]\nfile = "lwr4.xml"\n'
        '[control]\nlaw = "law.py:mine"\n[experiments.a]\nlaw = "law.py:mine"\n[experiments.b]\nlaw = "exact"\n'
        '[experiments.c]\nlaw = "other.py:mine"\n'
    )
    monkeypatch.chdir("/")
    loaded = load_scenario(tmp_path / "mine.toml")
    here = str(tmp_path / "my.xml")
    assert (loaded.arm.file, loaded.uav.file, loaded.believed().uav.file) == ("lwr4.xml", here, here)
    assert loaded.control.law == loaded.experiments["a"].law == f"{tmp_path / 'law.py'}:mine"
    assert [loaded.experiments[name].law for name in "bc"] == ["exact", "other.py:mine"]


def test_a_base_is_looked_for_beside_the_scenario_and_never_in_the_working_directory(tmp_path, monkeypatch) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    here.mkdir()
    there.mkdir()
    (there / "base.toml").write_text('base = "landing"\n[run]\nseed = 5\n')
    (here / "mine.toml").write_text('base = "base.toml"\n')
    monkeypatch.chdir(there)
    assert "mine.toml: base: file 'base.toml' does not exist beside the scenario" in refusal(here / "mine.toml")
    (here / "base.toml").write_text('base = "landing"\n[run]\nseed = 6\n')
    assert load_scenario(here / "mine.toml").run.seed == 6


def test_own_file_with_the_name_of_its_base_stands_on_the_one_that_comes_with_armland(tmp_path) -> None:
    (tmp_path / "landing.toml").write_text('base = "landing.toml"\n[run]\nseed = 6\n')
    assert load_scenario(tmp_path / "landing.toml").onboard.controller == "cascade"


def test_scenarios_based_on_each_other_are_refused(tmp_path) -> None:
    (tmp_path / "a.toml").write_text('base = "b.toml"\n')
    (tmp_path / "b.toml").write_text('base = "a.toml"\n')
    assert "more than 8 scenarios are based on each other; is one its own base?" in refusal(tmp_path / "a.toml")


def test_base_that_is_no_name_is_refused(tmp_path) -> None:
    (tmp_path / "a.toml").write_text("base = 3\n")
    assert "a.toml: base = 3 should be the name of a scenario or of a file" in refusal(tmp_path / "a.toml")


def test_file_without_a_base_stands_on_the_landing(tmp_path) -> None:
    (tmp_path / "a.toml").write_text("[run]\nseed = 3\n")
    loaded = load_scenario(tmp_path / "a.toml")
    assert (
        loaded.replaced({"run": {"seed": 1}, "title": "x"}).model_dump()
        == load_scenario("landing").replaced({"title": "x"}).model_dump()
    )
    # One that has a part of its own that every file has to have gives all of it, or says on what it stands.
    (tmp_path / "a.toml").write_text("[trajectory]\nmoves = [{to_m = [0.0, 0.0, 0.1], duration_s = 1.0}]\n")
    assert "link: is missing, and no `base` has it: base = 'landing' or 'paper'" in refusal(tmp_path / "a.toml")


def test_byte_order_mark_changes_nothing(tmp_path) -> None:
    (tmp_path / "a.toml").write_bytes("\ufeff[run]\nseed = 3\n".encode())
    assert load_scenario(tmp_path / "a.toml").run.seed == 3


LARGE = {
    "too large": (b"#" * (LARGEST + 1), "a.toml has 1000001 bytes; a scenario has at most 1000000"),
    "binary": (bytes(range(256)), "a.toml is not valid TOML"),
    "dotted depth": (b"a." * 490_000 + b"b = 1", "nested too deeply"),
    "quoted depth": (b"title = 'x'\n[\"a\" . 'b' . " + b"c . " * 200_000 + b"b]", "nested too deeply"),
    "listed depth": (b"title = " + b"[" * 50_000, "nested too deeply"),
    "digits": (b"[run]\nseed = " + b"9" * 5000, "a.toml is not valid TOML"),
    "hexadecimal digits": (b"[run]\nseed = 0x" + b"f" * 90_000, "an integer of 360000 bits; it may have 63"),
    "date": (b"[run]\nseed = 1979-05-27", "run.seed: Input should be a valid integer (got '1979-05-27')"),
}


@pytest.mark.parametrize("case", LARGE)
def test_file_that_is_none_is_refused_before_it_costs_time(tmp_path, case) -> None:
    content, says = LARGE[case]
    (tmp_path / "a.toml").write_bytes(content)
    assert says in refusal(tmp_path / "a.toml")


def test_many_problems_are_counted_and_the_first_are_listed(tmp_path) -> None:
    (tmp_path / "a.toml").write_text("".join(f"x{i} = 1\n" for i in range(5000)))
    message = refusal(tmp_path / "a.toml")
    assert message.startswith("a.toml: 5000 problems\n")
    assert len(message.splitlines()) == MOST_LINES + 2
    assert message.endswith(f"and {5000 - MOST_LINES} more")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_file_that_may_not_be_read_is_refused(tmp_path) -> None:
    (tmp_path / "a.toml").write_text("")
    (tmp_path / "a.toml").chmod(0)
    assert "a.toml cannot be read: Permission denied" in refusal(tmp_path / "a.toml")


@pytest.mark.parametrize("path", ["x" * 5000, "a\0b", "a/" * 3000])
def test_path_that_no_file_can_have_is_refused(path) -> None:
    message = refusal(path)
    assert "does not exist; those that come with armland are: arm-paper, compare, hexapod, landing, paper" in message
    assert len(message) < 400


@pytest.mark.parametrize("key", ["base", "calibration", "file"])
@pytest.mark.parametrize("name", ["x" * 5000, "a\0b"])
def test_name_inside_a_file_that_no_file_can_have_is_no_traceback(tmp_path, key, name) -> None:
    overrides = {"arm": {"file": name}} if key == "file" else {key: name}
    if key == "file" and len(name) < 500:
        assert load_scenario("landing", overrides).arm.file == name
    else:
        refusal("landing", overrides)


@pytest.mark.parametrize("overrides", [{"a": 2**70}, {"run": {"seed": float("inf")}}, {"title": "\ud800"}, {3: 4}])
def test_override_that_no_file_could_hold_is_refused(overrides) -> None:
    assert refusal("landing", overrides)


def test_what_was_said_of_one_arm_says_nothing_of_another(tmp_path) -> None:
    (tmp_path / "other.xml").write_text("<mujoco/>", encoding="utf-8")
    (tmp_path / "mine.toml").write_text('[arm]\nfile = "other.xml"\n[place]\nabove_m = 0.3\n', encoding="utf-8")
    plain, own = load_scenario("landing"), load_scenario(tmp_path / "mine.toml")
    changed = load_scenario("landing", {"arm": {"file": str(tmp_path / "other.xml"), "ee": "tool0"}})
    assert (plain.arm.elbow_joint, plain.arm.ee) == ("A3", "flange")
    assert plain.place.home_deg is not None
    assert own.place.above_m == 0.3
    for other, ee in ((own, None), (changed, "tool0")):
        assert (other.arm.elbow_joint, other.arm.ee, other.place.home_deg) == (None, ee, None)
        assert other.place.catch_m == plain.place.catch_m
    # The same arm again is no other one.
    assert load_scenario("landing", {"arm": {"file": "lwr4.xml"}}).place.home_deg == plain.place.home_deg


def test_recorded_wind_is_found_beside_the_scenario(tmp_path):
    (tmp_path / "wind.csv").write_text("time_s,x,y,z\n")
    (tmp_path / "windy.toml").write_text("base = 'landing'\n[air]\ntrace = 'wind.csv'\n")
    assert load_scenario(tmp_path / "windy.toml").air.trace == str(tmp_path / "wind.csv")
