import re

import numpy as np
import pytest

from armland.experiments.episode import prepare
from armland.scenario import load_scenario
from armland.view.flown import flown
from armland.view.page.belief import beliefs, deviations, learnt


@pytest.fixture(scope="module")
def scenario():
    return load_scenario("landing", {"deviation": {"level": "published"}}).with_seed(5)


def test_deviations_are_those_that_flew(scenario) -> None:
    flown_with = prepare(scenario, "landing").simulator.deviations
    rows = {r[0]: r for r in deviations(scenario, 7, False).rows}
    assert rows.keys() == flown_with.keys()
    for path in ("uav.mass", "magnet.gap_m", "link.up_ms"):
        number = float(re.match(r"[+-][\d.e-]+", rows[path][2].text)[0])
        assert number == pytest.approx(float(flown_with[path][0]), rel=6e-3)
    seven = rows["arm.encoder_rad"][2].text
    low, high = (float(x) for x in re.findall(r"[+-][\d.]+(?:e-\d+)?", seven)[:2])
    np.testing.assert_allclose([low, high], [f(flown_with["arm.encoder_rad"]) for f in (np.min, np.max)], rtol=6e-3)
    assert "(7 values)" in seven


def test_bar_is_the_share_of_the_range(scenario) -> None:
    rows = {r[0]: r for r in deviations(scenario, 7, False).rows}
    number = float(rows["uav.mass"][2].text)
    assert rows["uav.mass"][3] == "±0.07"
    assert rows["uav.mass"][2].share == pytest.approx(abs(number) / 0.07, abs=0.01)
    assert all(0.0 <= r[2].share <= 1.0 for r in rows.values())


def test_units_stand_beside_the_numbers_and_not_before_the_meaning(scenario) -> None:
    rows = {r[0]: r for r in deviations(scenario, 7, False).rows}
    assert rows["camera.mount_m"][1] == "place of camera and marker together, each axis"
    assert rows["camera.mount_m"][2].text.endswith(" m")
    assert rows["camera.noise"][1].startswith("real noise over claimed noise")


def test_plant_as_believed_has_none() -> None:
    plain = load_scenario("landing")
    assert deviations(plain, 7, False) is None
    assert deviations(load_scenario("paper", {"deviation": {"level": "published"}}), 7, True) is None
    assert beliefs(plain) is None


def test_what_was_learnt_is_what_the_estimate_says(landing_log) -> None:
    rows = {r[0]: r for r in learnt(landing_log, flown(landing_log)).rows}
    last = landing_log.messages["estimate"][-1]
    assert rows["weight of all that flies"][2] == f"{float(last['weight']):.2f} N"
    assert rows["delay of its samples"][2] == f"{1e3 * float(last['downlink']):.1f} ms"
