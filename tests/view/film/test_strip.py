import numpy as np
import pytest

from armland.experiments.judge.judgement import phase_times
from armland.view.film.strip import Strip


@pytest.fixture(scope="module")
def strip(landed) -> Strip:
    phases = phase_times(landed.ticks["mission"]["phase"], landed.brief.phases, landed.brief.rate_hz)
    return Strip(landed, phases, 420, 540)


def black(picture: np.ndarray) -> np.ndarray:
    """Columns that are black over most of the first panel's height."""
    return np.flatnonzero((picture[40:120].max(axis=2) == 0).mean(axis=0) > 0.8)


def test_line_moves_with_the_time_and_what_comes_is_pale(strip, landed) -> None:
    early, late = strip.at(2.0), strip.at(12.0)
    assert early.shape == (540, 420, 3)
    places = [np.median(black(strip.at(t))[black(strip.at(t)) > 70]) for t in (4.0, 8.0, 12.0)]
    assert np.diff(places)[0] == pytest.approx(np.diff(places)[1], abs=1.5)
    x = int(places[1])
    assert early[30:500, x:].mean() > late[30:500, x:].mean() - 0.5
    assert (early[:, x + 5 : x + 60] >= late[:, x + 5 : x + 60]).mean() > 0.99


def test_plots_themselves_do_not_change(strip) -> None:
    np.testing.assert_array_equal(strip.at(3.0), strip.at(3.0))
    # Left of the panels stand the scales.
    np.testing.assert_array_equal(strip.at(3.0)[:, :20], strip.at(9.0)[:, :20])
