"""Each term has a switch that takes it away, and nothing else: what the controller is told without it."""

import numpy as np
import pytest

from armland.experiments.campaign.description import changes
from armland.experiments.study.table import describe
from armland.experiments.study.terms import TERMS
from armland.mission.plan import plan
from armland.models.airframe.sizing import sized
from armland.scenario import load_scenario


@pytest.fixture(scope="module")
def at_sea():
    weather = {"air": {"wind_mps": 8.0, "turbulence": "by_wind"}, "sea": {"state": "ss3", "hull_m": 4.0}}
    return load_scenario("landing", weather)


@pytest.fixture(scope="module")
def told(at_sea):
    """What the controller is told with the changes of a term; of no term as it is."""
    made = {}

    def tell(name=None):
        if name not in made:
            values = {} if name is None else next(c for c in TERMS.changes if c.name == name).of(at_sea)
            made[name] = plan(sized(at_sea).replaced(changes(at_sea.model_dump(mode="json"), values)), "landing")
        return made[name]

    return tell


def differ(a, b, head=""):
    """Paths at which two nested records differ."""
    if a.dtype.names:
        return [path for n in a.dtype.names for path in differ(a[n], b[n], f"{head}{n}.")]
    return [] if np.array_equal(a, b, equal_nan=True) else [head.rstrip(".")]


@pytest.mark.parametrize(
    ("name", "paths"),
    [
        ("deck feed-forward", {"estimate.carried"}),
        ("kept pose", {"act.realisation.posture"}),
        ("load observer", {"estimate.observer"}),
        ("deck-following", {"act.uav.rides"}),
        ("prediction by τ", {"act.uav.ahead"}),
        (
            "accelerometers",
            {
                "estimate.filter.gust_max",
                "estimate.filter.forgotten",
                "estimate.filter.bias_prior",
                "act.uav.reckoned",
                "act.uav.fades",
            },
        ),
        ("gusts cancelled", {"act.uav.gust_share"}),
        ("room above", {"act.uav.sight.above"}),
    ],
)
def test_a_switch_changes_what_it_says(told, name, paths):
    found = set(differ(told().told[0], told(name).told[0]))
    assert found
    assert {p for p in found if not any(p.startswith(known) for known in paths)} == set()


def test_spare_thrust_is_not_waited_for_without_its_term(told):
    with_it, without = (p.table["conditions"]["threshold"] for p in (told(), told("spare thrust")))
    (differs,) = np.argwhere(with_it[0] != without[0])
    assert (with_it[0][tuple(differs)], without[0][tuple(differs)]) == (0.4, 0.0)
    assert differ(told().told[0], told("spare thrust").told[0]) == []


def test_every_change_is_one_that_the_scenario_takes(at_sea):
    tables = at_sea.model_dump(mode="json")
    for variant in describe(TERMS, at_sea, "landing", 1).variants:
        at_sea.replaced(changes(tables, variant.values))
    assert len({c.name for c in TERMS.changes}) == len(TERMS.changes)
