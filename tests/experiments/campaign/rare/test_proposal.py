"""Where flights of a rare failure are drawn: weights that make up for it, bounded, and a mixture that fits the failures."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal, norm

from armland.experiments.campaign.rare.proposal import PLAIN, Part, Proposal, effective, fitted, nominal

NEAR = np.array([[3.0, -1.0], [3.4, -0.6], [2.7, -1.3], [3.2, -0.8], [2.9, -1.1]])


@pytest.fixture
def drawn():
    """A mixture near (3, −1), and many points of it."""
    proposal = fitted(NEAR, np.ones(5))
    return proposal, proposal.places(np.random.default_rng(0).random((100_000, 3)))


def test_weights_give_the_mean_of_the_campaigns_own_distribution(drawn):
    proposal, z = drawn
    weights = proposal.weights(z)
    for what, true in ((np.ones(len(z)), 1.0), (z[:, 0] > 3.0, norm.sf(3.0)), (z[:, 1] ** 2, 1.0)):
        each = weights * what
        assert abs(each.mean() - true) < 4.0 * each.std() / np.sqrt(len(z))
    # Without weights it is another distribution's.
    assert np.mean(z[:, 0] > 3.0) > 100.0 * norm.sf(3.0)


def test_no_flight_weighs_more_than_the_share_of_plain_ones_allows(drawn):
    proposal, z = drawn
    everywhere = np.random.default_rng(1).uniform(-8.0, 8.0, (10_000, 2))
    assert max(proposal.weights(z).max(), proposal.weights(everywhere).max()) <= 1.0 / PLAIN * (1.0 + 1e-9)
    bare = Proposal(proposal.parts[:1] + (proposal.parts[2]._replace(share=0.9),))
    assert bare.weights(np.zeros((1, 2)))[0] > 9.9


def test_density_is_the_mixtures(drawn):
    proposal, z = drawn
    expected = sum(p.share * multivariate_normal(p.mean, p.root @ p.root.T).pdf(z[:50]) for p in proposal.parts)
    assert np.exp(proposal.density(z[:50])) / (2.0 * np.pi) == pytest.approx(expected)
    assert sum(p.share for p in proposal.parts) == pytest.approx(1.0)
    near = z[np.linalg.norm(z - proposal.parts[2].mean, axis=1) < 1.0]
    assert len(near) / len(z) == pytest.approx(
        np.mean(np.linalg.norm(multi(proposal, 100_000) - proposal.parts[2].mean, axis=1) < 1.0), abs=0.01
    )


def multi(proposal, count):
    # The same mixture by SciPy's own generator.
    rng = np.random.default_rng(2)
    counts = rng.multinomial(count, [p.share for p in proposal.parts])
    drawn = [
        multivariate_normal(p.mean, p.root @ p.root.T).rvs(n, rng) for p, n in zip(proposal.parts, counts, strict=True)
    ]
    return np.vstack(drawn)


def test_half_way_is_the_geometric_mean_of_both_densities():
    part = Part(1.0, np.array([3.0, 1.0]), np.linalg.cholesky(np.array([[0.4, 0.1], [0.1, 0.3]])))
    z = np.random.default_rng(0).normal(size=(20, 2))
    standard = Part(1.0, np.zeros(2), np.eye(2))
    apart = part.half_way().density(z) - 0.5 * (part.density(z) + standard.density(z))
    assert np.ptp(apart) < 1e-9
    assert np.ptp(part.density(z) - standard.density(z)) > 1.0


def test_many_failures_are_fitted_and_few_leave_room():
    rng, root = np.random.default_rng(0), np.linalg.cholesky(np.array([[0.2, 0.1], [0.1, 0.3]]))
    z = np.array([4.0, 0.5]) + rng.normal(size=(20_000, 2)) @ root.T
    part = fitted(z, np.ones(len(z))).parts[2]
    assert part.mean == pytest.approx([4.0, 0.5], abs=0.02)
    assert part.root @ part.root.T == pytest.approx(root @ root.T, abs=0.01)
    (few,) = [fitted(NEAR[:1], np.ones(1)).parts[2]]
    assert few.root @ few.root.T == pytest.approx(0.75 * np.eye(2))
    # Of two points the heavier one counts.
    assert fitted(NEAR[:2], np.array([1.0, 0.0])).parts[2].mean == pytest.approx(NEAR[0])


def test_nothing_is_known_at_first():
    z = nominal(3).places(np.random.default_rng(0).random((50_000, 4)))
    assert z.mean(axis=0) == pytest.approx(np.zeros(3), abs=0.05)
    assert z.std(axis=0) == pytest.approx(np.full(3, np.sqrt(0.9 * 4.0 + 0.1)), abs=0.05)


def test_points_of_equal_weight_count_fully():
    assert effective(np.ones(7)) == pytest.approx(7.0)
    assert effective(np.array([1.0, 1e-9, 1e-9])) == pytest.approx(1.0)
