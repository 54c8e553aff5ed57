"""The page docs/faults.md says what the tables say; its figures are checked where the trials fly (`test_flights`)."""

from pathlib import Path

from armland.mission.supervisor.table import FAULTS
from armland.scenario.faults import Fault
from pages.faults import provoked, signs, static_part
from pages.trials import all_trials

PAGE = (Path(__file__).parents[3] / "docs" / "faults.md").read_text(encoding="utf-8")


def test_page_holds_the_tables_as_they_are():
    assert PAGE.startswith(static_part()), "run: make pages"


def test_page_has_every_trial_once_with_what_provokes_it():
    for t in all_trials():
        assert PAGE.count(f"| {t.name} | {provoked(t.faults)} |") == 1, t.name


def test_every_fault_has_its_sign():
    assert set(signs()) == set(FAULTS[1:])


def test_failure_in_words_says_what_fails_and_when():
    fault = Fault(kind="wrench_drift", size=-6.0, phase="carry", after_s=0.5)
    assert provoked((fault,)) == "force sensor drifting -6 N/s 0.5 s into carry"
