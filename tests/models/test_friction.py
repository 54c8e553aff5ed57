"""Joint friction that is made up for: never more than there is, and nothing where there is little."""

import numpy as np

from armland.models.friction import LEAST, SHARE, known, make_up


def made_up(qd, friction, damping):
    tau = np.zeros(len(qd))
    make_up(np.array(qd), known(np.array(friction)), known(np.array(damping)), tau)
    return tau


def test_it_gives_back_less_than_friction_takes():
    """Power: what it feeds in stays below what a joint with Coulomb and viscous friction dissipates, at any speed."""
    rng = np.random.default_rng(0)
    for _ in range(200):
        qd, f, d = rng.normal(scale=1.0, size=3), rng.uniform(0.0, 6.0, 3), rng.uniform(0.0, 12.0, 3)
        fed, lost = made_up(qd, f, d) * qd, f * np.abs(qd) + d * qd**2
        assert (fed >= 0.0).all()
        assert (fed <= SHARE * lost + 1e-12).all()


def test_both_frictions_by_hand():
    """Fast joints: the whole share of both frictions, in the direction of motion."""
    np.testing.assert_allclose(made_up([2.0, -2.0], [5.0, 5.0], [10.0, 0.0]), [0.8 * 25.0, -0.8 * 5.0], rtol=1e-12)


def test_little_friction_changes_no_bit():
    tau, before = np.array([-0.0, 1.0 / 3.0]), np.array([-0.0, 1.0 / 3.0])
    little = np.full(2, 0.99 * LEAST)
    make_up(np.ones(2), known(little), known(little), tau)
    assert tau.tobytes() == before.tobytes()
    make_up(np.ones(2), known(np.full(2, LEAST)), known(little), tau)
    assert (tau > before).all()
