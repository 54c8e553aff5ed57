"""The page of trials under deviations counts what is not safe and what is not true."""

from pages.published import is_true, markdown

GOOD = {"name": "landing slip held", "seed": 1, "ends": ["let_fly"], "found": ["slip"], "state": "flying", "unsafe": []}


def test_true_is_what_names_the_failure():
    assert is_true(GOOD)
    assert not is_true(GOOD | {"found": ["magnet_stuck"]})
    assert not is_true(GOOD | {"found": ["none"]})
    assert is_true(GOOD | {"found": ["none"], "ends": ["done"]})


def test_page_counts_and_names_what_is_off():
    bad = GOOD | {"seed": 2, "unsafe": ["the UAV fell"], "found": ["magnet_stuck"]}
    missing = {"name": "landing slip held", "seed": 3, "missing": "it never came to carry"}
    page = markdown([GOOD, bad, missing])
    assert "2 trials, **1 safe (50.0 %), reasons true in 1 (50.0 %)**; 1 could not be provoked" in page
    assert "- landing slip held, seed 2: the UAV fell." in page
    assert "- landing slip held, seed 2: found magnet_stuck, ended in let_fly." in page
    assert "| `magnet_slip` | 1 | 1 |" in page


def test_page_leaves_out_trials_that_are_no_more():
    assert "**0 safe" in markdown([GOOD | {"name": "landing nothing"}])
