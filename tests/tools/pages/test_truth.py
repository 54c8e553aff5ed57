"""What is true of each failure and of each deviation: complete, and of names that exist; a table of what was found."""

from armland.mission.supervisor.table import FAULTS
from armland.scenario.faults import FAILURES
from pages.trials import all_trials
from pages.truth import NONE, TRUE_OF_DEVICE, TRUE_OF_FAILURE, confusion, devices, true_of, true_of_row, untrue


def test_every_failure_and_every_device_has_names_that_exist():
    assert set(TRUE_OF_FAILURE) == set(FAILURES)
    assert set(TRUE_OF_DEVICE) == devices()
    for names in (*TRUE_OF_FAILURE.values(), *TRUE_OF_DEVICE.values()):
        assert names
        assert names <= set(FAULTS[1:])


def test_names_that_trials_expect_are_true():
    """A name stands in a trial because it was flown so; here it is judged by what fails and by nothing else."""
    assert [t.name for t in all_trials() if t.found not in true_of(t.faults)] == []


def test_nothing_found_is_true_only_where_the_flight_copes():
    faults = next(t for t in all_trials() if t.name == "landing camera_noise flight").faults
    assert untrue([NONE], faults, copes=False) == {NONE}
    assert untrue([NONE], faults, copes=True) == set()
    assert untrue(["camera_leap"], faults, copes=True) == {"camera_leap"}
    assert untrue(["camera_noise"], faults, copes=False) == set()


def test_names_of_a_deviation_are_those_of_its_device():
    assert "camera_noise" in true_of_row("camera.noise")
    assert "camera_noise" not in true_of_row("uav.mass")


def test_confusion_counts():
    table = confusion([("a", "x"), ("a", "x"), ("b", NONE)]).splitlines()
    assert table == ["| | `x` | none |", "|---|---|---|", "| `a` | 2 |  |", "| `b` |  | 1 |"]
