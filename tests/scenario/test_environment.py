"""The section `[air]`: what makes no wind is refused, and so is what contradicts itself."""

import pytest
from pydantic import ValidationError

from armland.errors import ConfigurationError
from armland.scenario.environment import Air

GUST = {"at_s": 1.0, "peak_mps": 5.0, "length_m": 10.0}


def refused(**keys):
    with pytest.raises(ValidationError) as e:
        Air(**keys)
    return str(e.value)


@pytest.mark.parametrize(
    "keys",
    [
        {},
        {"wind_mps": 8.0},
        {"wind_mps": 8.0, "turbulence": "by_wind", "towards_deg": -90.0, "reference_m": 10.0, "roughness_m": 2e-4},
        {"turbulence": "moderate", "floor_m": 2.0, "towards_deg": 10.0},
        {"wind_mps": 8.0, "profile": "power", "exponent": 0.2},
        {"gusts": (GUST,), "towards_deg": 10.0},
        {"trace": "wind.csv", "gusts": ({**GUST, "direction": (0.0, 0.0, 1.0)},)},
    ],
)
def test_wind_that_can_be(keys):
    assert Air(**keys).blows == bool(keys)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"turbulence": "by_wind"}, "none without wind"),
        ({"profile": "power"}, "profile has no effect"),
        ({"reference_m": 10.0, "turbulence": "light"}, "reference_m has no effect"),
        ({"wind_mps": 8.0, "profile": "even", "reference_m": 10.0}, "reference_m has no effect"),
        ({"wind_mps": 8.0, "exponent": 0.3}, "exponent has no effect without wind_mps and profile = 'power'"),
        ({"wind_mps": 8.0, "profile": "power", "roughness_m": 0.1}, "roughness_m has no effect"),
        ({"floor_m": 2.0}, "floor_m has no effect"),
        ({"towards_deg": 90.0}, "towards_deg has no effect"),
        ({"trace": "wind.csv", "towards_deg": 90.0}, "towards_deg has no effect"),
        ({"gusts": ({**GUST, "direction": (1.0, 0.0, 0.0)},), "towards_deg": 90.0}, "towards_deg has no effect"),
        ({"trace": "wind.csv", "wind_mps": 3.0}, "leave out wind_mps and turbulence"),
        ({"trace": "wind.csv", "turbulence": "light"}, "leave out wind_mps and turbulence"),
        ({"wind_mps": 8.0, "reference_m": 1.0, "roughness_m": 2.0}, "reference_m = 1 must be above roughness_m = 2"),
        ({"gusts": ({**GUST, "direction": (0.0, 0.0, 0.0)},)}, "points nowhere"),
    ],
)
def test_key_that_does_nothing_or_contradicts_another_is_refused(keys, message):
    assert message in refused(**keys)


def test_controller_is_never_told_of_the_air(landing_scenario):
    assert landing_scenario.replaced({"air": {"wind_mps": 8.0}}).believed().air == Air()


def test_gust_after_the_end_of_the_run_is_refused(landing_scenario):
    with pytest.raises(ConfigurationError, match=r"air.gusts.0.at_s = 50 must be below run.duration_s = 45"):
        landing_scenario.replaced({"air": {"gusts": [{**GUST, "at_s": 50.0}]}})
