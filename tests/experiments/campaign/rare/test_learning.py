"""Failures of known rates are found, and their intervals hold, where a score shows the way and where none does."""

import numpy as np
import pytest
from scipy.stats import norm

from armland.experiments.campaign.rare.estimate import rate_of
from armland.experiments.campaign.rare.learning import MOST, Stage, following

STAGE, LAST, STUDIES = 100, 1000, 20


def study(score, d, rng):
    """The rate from flights in d directions with a score of a point and of luck, how many were flown, and from where."""
    stages = []
    while not (now := following(stages, d)).learnt:
        z = now.proposal.places(rng.random((STAGE, d + 1)))
        stages.append(Stage(now.proposal, z, score(z, rng)))
    z = now.proposal.places(rng.random((LAST, d + 1)))
    failed = score(z, rng) >= 0.0
    return rate_of(now.proposal.weights(z), failed), len(stages), failed.mean()


def tail(p, share=1.0):
    # Of a normal number, of which luck is a part.
    def score(z, rng):
        direction = z.sum(axis=1) / np.sqrt(z.shape[1])
        return share * direction + np.sqrt(1.0 - share**2) * rng.standard_normal(len(z)) - norm.isf(p)

    return score


def blind(p):
    # Nothing says how near a flight came.
    return lambda z, rng: np.where(z[:, 0] > norm.isf(p), 0.0, -np.inf)


KNOWN = {
    "a tail": (tail(1e-6), 2, 1e-6),
    "in five directions": (tail(1e-5), 5, 1e-5),
    "not so rare": (tail(1e-2), 3, 1e-2),
    "on both sides": (lambda z, rng: np.abs(z[:, 0]) - norm.isf(5e-6), 2, 1e-5),
    "by luck, too": (tail(1e-4, 0.9), 2, 1e-4),
    "blind": (blind(1e-4), 2, 1e-4),
    "misled": (lambda z, rng: np.where(z[:, 0] > norm.isf(1e-3), 0.0, -1.0 - z[:, 0] ** 2), 2, 1e-3),
}


@pytest.mark.parametrize(("score", "d", "p"), KNOWN.values(), ids=KNOWN)
def test_known_rate_is_found_and_intervals_hold_it(score, d, p):
    rng = np.random.default_rng(1)
    rates, _, failing = zip(*(study(score, d, rng) for _ in range(STUDIES)), strict=True)
    # Were it 90 %, fewer than 15 of 20 would hold it in one of 100 runs.
    assert sum(r.interval.low <= p <= r.interval.high for r in rates) >= 15
    middle = np.mean([r.value for r in rates])
    assert middle == pytest.approx(p, rel=4.0 * np.mean([r.deviation for r in rates]) / np.sqrt(STUDIES) + 0.02)
    # Without weights it would be another rate.
    assert np.mean(failing) > 8.0 * p


def test_rare_failure_costs_a_small_part_of_plain_flights():
    rng = np.random.default_rng(2)
    for _ in range(5):
        rate, stages, _ = study(tail(1e-6), 2, rng)
        assert rate.plain > 10_000.0 * (STAGE * stages + LAST)
        assert rate.deviation < 0.15


def test_where_seeds_alone_decide_it_stops_looking_and_says_what_it_is_worth():
    rng = np.random.default_rng(3)
    rates, stages, _ = zip(*(study(tail(1e-2, 0.0), 2, rng) for _ in range(10)), strict=True)
    assert max(stages) <= MOST
    # Were it 90 %, fewer than 7 of 10 would hold it in one of 100 runs.
    assert sum(r.interval.low <= 1e-2 <= r.interval.high for r in rates) >= 7
    assert max(r.plain for r in rates) < 5.0 * LAST


def test_what_comes_next_depends_on_what_was_flown_alone():
    rng = np.random.default_rng(4)
    first = following([], 2)
    z = first.proposal.places(rng.random((STAGE, 3)))
    stage = Stage(first.proposal, z, tail(1e-3)(z, rng))
    one, two = following([stage], 2), following([stage], 2)
    assert all(np.array_equal(a.root, b.root) for a, b in zip(one.proposal.parts, two.proposal.parts, strict=True))
    assert not first.learnt
    # The way leads to where flights came nearest.
    assert one.proposal.parts[2].mean.sum() > 1.5


def test_flights_that_say_nothing_lead_nowhere():
    first = following([], 2)
    z = first.proposal.places(np.random.default_rng(5).random((STAGE, 3)))
    after = following([Stage(first.proposal, z, np.full(STAGE, -np.inf))], 2)
    assert [p.share for p in after.proposal.parts] == [p.share for p in first.proposal.parts]
