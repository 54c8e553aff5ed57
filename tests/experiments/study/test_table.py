"""A study as a table: what is flown of it, and which of its changes."""

import pytest

from armland.errors import ConfigurationError
from armland.experiments.study.sensors import SENSORS
from armland.experiments.study.table import chosen, describe
from armland.experiments.study.terms import TERMS


def test_variants_are_the_scenario_as_it_is_and_each_change(made):
    study = made({"one": {"camera.rate_hz": 60}, "two": lambda s: {"uav.extra_mass_kg": s}})
    described = describe(study, 0.02, "landing", 17)
    assert [(v.name, v.values) for v in described.variants] == [
        ("as it is", {}),
        ("one", {"camera.rate_hz": 60}),
        ("two", {"uav.extra_mass_kg": 0.02}),
    ]
    assert (described.first_seed, described.mission, described.title) == (17, "landing", "Made up")


def test_changes_are_chosen_by_name_in_the_order_asked_for(made):
    study = made({"one": {}, "two": {}, "three": {}})
    assert [c.name for c in chosen(study, "three, one,three").changes] == ["three", "one"]
    assert chosen(study, None) is study


@pytest.mark.parametrize("study", [SENSORS, TERMS], ids=["sensors", "terms"])
def test_every_change_can_be_chosen_by_its_name(study):
    assert [chosen(study, change.name).changes for change in study.changes] == [(change,) for change in study.changes]


@pytest.mark.parametrize(("names", "words"), [("four", "'four' is none; made has: one"), (" , ", "it names nothing")])
def test_a_change_that_there_is_not_is_refused(made, names, words):
    with pytest.raises(ConfigurationError, match=words):
        chosen(made({"one": {}}), names)
