"""What provokes each of the supervisor's faults."""

import pytest

from armland.experiments.operator.provoked import JERK, KNOCK, PROVOKED, SHOVE, WEDGE
from armland.mission.supervisor.table import FAULT_TABLE
from armland.scenario.faults import Fault


def test_every_fault_that_a_plant_can_have_is_provoked() -> None:
    assert set(PROVOKED) == set(FAULT_TABLE) - {"law_failed"}


@pytest.mark.parametrize("name", PROVOKED)
def test_each_is_a_failure_that_a_scenario_may_hold(name: str) -> None:
    assert Fault(**PROVOKED[name], phase="carry", after_s=0.1).kind


def test_blows_are_of_the_kind_that_their_names_say() -> None:
    assert [f["kind"] for f in (KNOCK, JERK, SHOVE, WEDGE)] == ["push", "overload", "push", "push"]
    assert KNOCK["direction"][2] < 0.0 < WEDGE["direction"][2]
    assert JERK["size"] < 0.0
