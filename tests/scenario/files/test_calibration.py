"""Calibrated values: each inside its supported range and with a reason, each mistake named by its place."""

import re
import tomllib

import pytest

from armland.errors import ConfigurationError
from armland.scenario import SCENARIOS, load_scenario

PAPER = (SCENARIOS / "paper.toml").read_text("utf-8")
CALIBRATION = (SCENARIOS / "calibration.toml").read_text("utf-8")


def refusal(folder, calibration, scenario=PAPER):
    (folder / "mine.toml").write_text(scenario, encoding="utf-8")
    (folder / "calibration.toml").write_text(calibration, encoding="utf-8")
    with pytest.raises(ConfigurationError) as error:
        load_scenario(folder / "mine.toml")
    return str(error.value)


def recalibrated(name, value):
    """The calibration file with another value of `name`."""
    heading = re.escape(f"[{name}]")
    return re.sub(rf"(^{heading}\nvalue = ).*$", rf"\g<1>{value}", CALIBRATION, flags=re.MULTILINE)


def supported(name):
    """The range of a calibrated value, as a message writes it."""
    section, key = name.split(".")
    entry = tomllib.loads(CALIBRATION)[section][key]
    return f"{entry['low']:g} to {entry['high']:g}"


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
        CALIBRATION.replace("[link.torque_effectiveness]", "[link.torque_effectivenes]"),
        "link.torque_effectivenes: unknown key; known here: downlink_delay_ms",
    ),
    "unknown word beside the value": (
        CALIBRATION.replace("because", "reason"),
        "calibration.toml: onboard.kp_nm: reason: unknown key; known here: because, high, low, unit, value",
    ),
    "syntax": (CALIBRATION + "\n[[", "calibration.toml is not valid TOML: "),
}


@pytest.mark.parametrize("mistake", SPOILT_CALIBRATION)
def test_mistake_in_a_calibration_is_refused_by_its_place(tmp_path, mistake) -> None:
    text, says = SPOILT_CALIBRATION[mistake]
    assert says in refusal(tmp_path, text)


def test_value_outside_its_range_is_one_problem_and_not_also_missing(tmp_path) -> None:
    text = recalibrated("link.torque_effectiveness", "17.0")
    assert refusal(tmp_path, text).startswith("mine.toml: 1 problem\n")


def test_calibrated_values_arrive_in_the_scenario() -> None:
    scenario, calibration = load_scenario("paper"), tomllib.loads(CALIBRATION)
    for section, entries in calibration.items():
        for key, entry in entries.items():
            value = getattr(getattr(scenario, section), key)
            assert (list(value) if isinstance(value, tuple) else value) == entry["value"]


def test_value_that_is_set_and_calibrated_is_refused(tmp_path) -> None:
    message = refusal(tmp_path, CALIBRATION, PAPER + "\n[link]\ntorque_effectiveness = 0.7\n")
    assert "link.torque_effectiveness is set here and in calibration.toml; keep one of the two" in message


def test_a_file_may_set_what_its_base_calibrates(tmp_path) -> None:
    (tmp_path / "mine.toml").write_text('base = "paper"\n[link]\ntorque_effectiveness = 0.7\n')
    loaded = load_scenario(tmp_path / "mine.toml")
    assert loaded.link.torque_effectiveness == 0.7
    assert loaded.link.uplink_delay_ms == 25.0


@pytest.mark.parametrize("value", ["nan", "inf", "1e300", '"0.6"', "[]", "true", "{ x = 1 }"])
def test_value_that_is_no_number_is_refused(tmp_path, value) -> None:
    assert "calibration.toml: link.torque_effectiveness: value" in refusal(
        tmp_path, recalibrated("link.torque_effectiveness", value)
    )


def test_every_shipped_value_has_unit_and_reason() -> None:
    for entries in tomllib.loads(CALIBRATION).values():
        for entry in entries.values():
            assert entry["low"] < entry["high"]
            assert entry["unit"]
            assert len(entry["because"].split()) > 8
