"""A range as a number, a pair or a table; what no device can be is refused with the bound that would have worked."""

import pytest

from armland.errors import ConfigurationError
from armland.scenario import load_scenario
from armland.scenario.deviation import rows
from armland.scenario.deviation.spread import Spread


def landing(deviation):
    return load_scenario("landing", {"deviation": deviation}).deviation


@pytest.mark.parametrize(
    ("device", "entry", "written", "low", "high"),
    [
        ("uav", "mass", 0.2, -0.2, 0.2),
        ("uav", "mass", -0.2, -0.2, 0.2),
        ("uav", "mass", 0, 0.0, 0.0),
        ("uav", "mass", [0.1, 0.3], 0.1, 0.3),
        ("uav", "mass", [-0.2, -0.2], -0.2, -0.2),
        ("air", "wind_mps", 2.0, 0.0, 2.0),
        ("air", "wind_mps", [1.0, 2.0], 1.0, 2.0),
        # Late by less than believed, too: of one sign, but with a bound on both.
        ("link", "up_ms", -5.0, -5.0, 0.0),
        ("camera", "outlier_m", 0.1, 0.0, 0.1),
    ],
)
def test_number_is_a_range_about_zero_or_from_zero_and_a_pair_is_itself(device, entry, written, low, high) -> None:
    assert getattr(getattr(landing({device: {entry: written}}), device), entry) == Spread(low=low, high=high)


def test_table_says_normal() -> None:
    found = landing({"uav": {"mass": {"low": -0.1, "high": 0.2, "normal": True}}}).uav.mass
    assert found == Spread(low=-0.1, high=0.2, normal=True)
    assert not landing({"uav": {"mass": [-0.1, 0.2]}}).uav.mass.normal


@pytest.mark.parametrize(
    ("device", "entry", "written", "says"),
    [
        ("uav", "mass", [-1.5, 0.0], "deviation.uav: mass = [-1.5, 0] lies outside -0.5 to 0.5"),
        ("uav", "mass", 1.5, "deviation.uav: mass = [-1.5, 1.5] lies outside -0.5 to 0.5"),
        ("uav", "inertia", [-1.0, 0.0], "deviation.uav: inertia = [-1, 0] lies outside -0.9 to 2"),
        ("arm", "delay_ms", -1.0, "deviation.arm: delay_ms = [-1, 0] lies outside 0 to 20"),
        ("link", "jitter_ms", [-3.0, 3.0], "deviation.link: jitter_ms = [-3, 3] lies outside 0 to 1000"),
        ("link", "loss", [0.0, 1.0], "deviation.link: loss = [0, 1] lies outside 0 to 0.99"),
        ("link", "burst", 1.5, "deviation.link: burst = [0, 1.5] lies outside 0 to 0.99"),
        ("wrench", "cross", 1.2, "deviation.wrench: cross = [-1.2, 1.2] lies outside -0.9 to 0.9"),
        ("air", "gust_mps", -1.0, "deviation.air: gust_mps = [-1, 0] lies outside 0 to 10"),
        ("hinge", "friction_nm", -1e-3, "deviation.hinge: friction_nm = [-0.001, 0] lies outside 0 to 0.1"),
        ("magnet", "force", [-1.0, 0.0], "deviation.magnet: force = [-1, 0] lies outside -0.95 to 1"),
    ],
)
def test_what_no_device_can_be_is_refused_with_bound_and_published_range(device, entry, written, says) -> None:
    with pytest.raises(ConfigurationError) as e:
        landing({device: {entry: written}})
    assert says in str(e.value)
    assert "published: [" in str(e.value)


@pytest.mark.parametrize(
    ("deviation", "says"),
    [
        ({"link": {"loss": [0.3, 0.1]}}, "deviation.link.loss: low = 0.3 is above high = 0.1"),
        ({"uav": {"mass": {"low": 0.1, "high": -0.1}}}, "deviation.uav.mass: low = 0.1 is above high = -0.1"),
        ({"uav": {"masss": 0.1}}, "deviation.uav.masss: unknown key; known here: cm_m, curve"),
        ({"wings": {}}, "deviation.wings: unknown key; known here: air, arm"),
        ({"level": "wild"}, "deviation.level: Input should be 'nominal', 'mild', 'published' or 'harsh'"),
        ({"uav": {"mass": True}}, "deviation.uav.mass: Input should be a table (got True)"),
        ({"uav": {"mass": [0.1]}}, "deviation.uav.mass: Input should be a table (got [0.1])"),
        ({"uav": {"mass": [0.1, "x"]}}, "deviation.uav.mass.high"),
        ({"uav": {"mass": float("nan")}}, "deviation.uav.mass.low: nan lies outside"),
        ({"air": {"wind_mps": [0.0, float("inf")]}}, "deviation.air.wind_mps.high: inf lies outside"),
    ],
)
def test_what_is_no_range_is_refused(deviation, says) -> None:
    with pytest.raises(ConfigurationError) as e:
        landing(deviation)
    assert says in str(e.value)


@pytest.mark.parametrize("row", list(rows()), ids=lambda row: row.path)
def test_bound_itself_is_allowed_and_what_lies_beyond_is_not(row) -> None:
    device, entry = row.path.split(".")
    least, most = row.told.least, row.told.most
    found = getattr(getattr(landing({device: {entry: [least, most]}}), device), entry)
    assert (found.low, found.high) == (least, most)
    for low, high in ((least - 1e-3, most), (least, most + 1e-3)):
        with pytest.raises(ConfigurationError, match=entry):
            landing({device: {entry: [low, high]}})
