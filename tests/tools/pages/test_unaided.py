"""Missions without an arm: their pages name the ways out that the compiled code has, with the numbers that it is told."""

import ast
import inspect

import pytest

from armland.mission.registry import UNAIDED
from armland.mission.unaided import decide
from armland.mission.unaided.plan import unaided_plan
from armland.scenario import load_scenario
from pages.missions import mission_markdown
from pages.unaided import WAYS_OUT, numbers_of, phase_table


def ways_out(source: str) -> dict[str, set[str]]:
    """Phase -> phases that may follow, read from the branches `if s.phase == PHASE` and what they return."""
    found: dict[str, set[str]] = {}
    for branch in ast.walk(ast.parse(source)):
        if isinstance(branch, ast.If) and ast.unparse(branch.test).startswith("s.phase == "):
            phase = ast.unparse(branch.test).removeprefix("s.phase == ").split()[0]
            returned = [r.value for part in branch.body for r in ast.walk(part) if isinstance(r, ast.Return)]
            ends = [[v.body, v.orelse] if isinstance(v, ast.IfExp) else [v] for v in returned]
            names = {ast.unparse(end).lower() for pair in ends for end in pair}
            found[phase.lower()] = names - {phase.lower()}
    return found


def test_the_ways_out_are_those_of_the_compiled_code() -> None:
    source = inspect.getsource(decide._next.py_func)
    named = {phase: {target for target, _ in ways} for phase, ways in WAYS_OUT.items()}
    assert ways_out(source) == named
    # One that the page leaves out is found.
    assert ways_out(source.replace("return GUIDE\n        there", "return AWAY\n        there")) != named


@pytest.mark.parametrize("name", UNAIDED)
def test_every_phase_has_a_row_and_every_number_a_value(name: str) -> None:
    plan = unaided_plan(load_scenario(name), name)
    text = "\n".join(phase_table(plan))
    for phase in plan.phases:
        assert (f"| `{phase.name}` | " in text) == (not phase.final)
    assert "{" not in text
    assert ("the rope presses it" in text) == (name == "tether")
    assert f"sunk by less than {decide.STOPPED * plan.scenario.descent.sink_mps:.2g} m/s" in text or name == "tether"


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("give_up_m", 0.4567, "aside > 0.4567 m"),
        ("quiet", 1.234, "unrest < 1.234"),
        ("sink_mps", 0.2345, "falls by 0.2345 m/s"),
        ("cut_m", 0.01234, "height < 0.01234 m"),
    ],
)
def test_numbers_of_the_scenario_show(key: str, value: float, words: str) -> None:
    page = mission_markdown("unassisted", load_scenario("unassisted", {"descent": {key: value}}))
    assert words in page
    assert "armland run unassisted unassisted\n" in page
    assert "may touch the pad in `descend`, `settle`, `done`" in page


def test_one_that_waits_for_no_quiet_moment_says_nothing_of_it() -> None:
    plan = unaided_plan(load_scenario("unassisted", {"descent": {"timed": False}}), "unassisted")
    assert numbers_of(plan)["calm"] == ""
    assert "unrest" not in "\n".join(phase_table(plan))
