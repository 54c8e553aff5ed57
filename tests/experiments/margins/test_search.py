"""The search on made-up limits: it finds them within its bracket, and says so where there is none."""

import pytest

from armland.experiments.margins.search import CLOSE, Failure, bracketed, following


def up_to(limit, tried=None):
    """A trial that holds up to `limit`."""

    def trial(k):
        if tried is not None:
            tried.append(k)
        return None if k <= limit else Failure(1, f"fails at {k:g}", "lost")

    return trial


@pytest.mark.parametrize("limit", [0.3, 0.9, 1.0, 1.3, 2.0, 3.7, 7.9])
def test_limit_lies_in_the_bracket_and_the_bracket_is_narrow(limit):
    found = bracketed(up_to(limit), 8.0, steps=12)
    assert found.lands <= limit < found.fails
    assert found.fails <= CLOSE * found.lands
    assert found.failure.reason == f"fails at {found.fails:g}"


@pytest.mark.parametrize("limit", [0.06, 0.7, 1.5, 6.0])
def test_six_trials_leave_a_bracket_of_its_own_accord(limit):
    tried = []
    found = bracketed(up_to(limit, tried), 8.0)
    assert found.trials == len(tried) == len(set(tried)) <= 6
    assert found.lands <= limit < found.fails <= 2.0 * found.lands


def test_nothing_is_found_beyond_the_bound():
    tried = []
    found = bracketed(up_to(50.0, tried), 5.0)
    assert (found.lands, found.fails, found.failure) == (5.0, None, None)
    assert tried == [1.0, 2.0, 4.0, 5.0]


def test_what_always_fails_holds_at_nothing():
    found = bracketed(up_to(-1.0), 8.0)
    assert (found.lands, found.fails, found.trials) == (0.0, 1.0 / 32.0, 6)


def test_first_failure_from_below_counts_where_it_holds_again_above():
    def trial(k):
        return Failure(1, "hole", "lost") if 1.5 < k < 3.0 else None

    found = bracketed(trial, 8.0, steps=12)
    assert found.lands <= 1.5 < found.fails


@pytest.mark.parametrize(
    ("low", "high", "most", "expected"),
    [
        (0.0, None, 8.0, 1.0),
        (0.0, None, 0.5, 0.5),
        (2.0, None, 3.0, 3.0),
        (3.0, None, 3.0, None),
        (0.0, 1.0, 8.0, 0.5),
        (1.0, 4.0, 8.0, 2.0),
        (1.0, 1.1, 8.0, None),
    ],
)
def test_next_factor(low, high, most, expected):
    assert following(low, high, most) == expected
