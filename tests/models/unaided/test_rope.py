"""A rope with mass against hand calculation and the catenary; it pulls and never pushes."""

import numpy as np
import pytest
from scipy.optimize import brentq

from armland.models.unaided.rope import POINTS, carry_rope, pull_of

G = np.array([0.0, 0.0, -9.81])
TICK = 1e-3


class Rope:
    def __init__(self, low, high, length, kg_per_m=0.05, stretch=1500.0):
        self.ends, self.ends_v = np.array([low, high], float), np.zeros((2, 3))
        self.rope = np.array([length, kg_per_m, stretch])
        share = (np.arange(POINTS) + 1.0)[:, None] / (POINTS + 1.0)
        self.place = self.ends[0] + share * (self.ends[1] - self.ends[0])
        self.speed = np.zeros((POINTS, 3))

    def run(self, seconds, damping=0.0):
        forces, lows = [], []
        for _ in range(round(seconds / TICK)):
            force, low = carry_rope(self.place, self.speed, self.ends, self.ends_v, self.rope, G, TICK)
            self.speed *= 1.0 - damping * TICK
            forces.append(force)
            lows.append(low)
        return np.array(forces), np.array(lows)

    def energy(self):
        rest = self.rope[0] / (POINTS + 1)
        mass = max(self.rope[1] * rest, 3e-4)
        return 0.5 * mass * np.sum(self.speed**2) + mass * 9.81 * np.sum(self.place[:, 2])


@pytest.mark.parametrize(("apart", "expected"), [(0.09, 0.0), (0.1, 0.0), (0.11, 1.5)])
def test_eq_t1_pulls_and_never_pushes(apart, expected):
    still = np.zeros(3)
    force = pull_of(np.zeros(3), still, np.array([0.0, 0.0, apart]), still, 0.1, 150.0, 0.0)
    np.testing.assert_allclose(force, [0.0, 0.0, expected], atol=1e-12)


def test_eq_t1_damping_turns_no_pull_into_a_push():
    force = pull_of(np.zeros(3), np.zeros(3), np.array([0.0, 0.0, 0.101]), np.array([0.0, 0.0, -9.0]), 0.1, 150.0, 5.0)
    assert force == (0.0, 0.0, 0.0)


def test_a_taut_rope_stretches_as_its_stiffness_says():
    # 1 m of EA = 1500 N drawn to 1.002 m: 3 N at both ends, but for its weight of 0.02 N.
    rope = Rope([0, 0, 0], [0, 0, 1.002], 1.0, kg_per_m=0.002)
    forces, lows = rope.run(2.0, damping=5.0)
    assert -forces[-500:, 2].mean() == pytest.approx(3.0, abs=0.05)
    assert lows[-500:].mean() == pytest.approx(3.0, abs=0.05)


def test_upper_end_carries_the_weight_that_the_lower_does_not():
    rope = Rope([0, 0, 0], [0, 0, 1.01], 1.0, kg_per_m=0.1)
    forces, lows = rope.run(3.0, damping=5.0)
    inner = 0.1 * 1.0 / (POINTS + 1) * POINTS
    assert -forces[-500:, 2].mean() - lows[-500:].mean() == pytest.approx(inner * 9.81, rel=0.02)


def test_a_slack_rope_hangs_as_a_catenary():
    # Both ends as high, 1 m apart, 1.3 m of rope: a cosh(1/(2a)) − a is its sag, 2a sinh(1/(2a)) its length.
    rope = Rope([0, 0, 0], [1.0, 0, 0], 1.3, kg_per_m=0.05)
    forces, lows = rope.run(8.0, damping=2.0)
    a = brentq(lambda a: 2.0 * a * np.sinh(0.5 / a) - 1.3, 0.1, 2.0)
    sag = a * (np.cosh(0.5 / a) - 1.0)
    assert -rope.place[:, 2].min() == pytest.approx(sag, rel=0.03)
    # λ g a is the horizontal force of a catenary; nine pieces are a coarse one.
    assert -forces[-500:, 0].mean() == pytest.approx(0.05 * 9.81 * a, rel=0.08)
    # Half of its weight hangs on each end.
    assert -forces[-500:, 2].mean() == pytest.approx(0.5 * 0.05 * 1.3 * 9.81 * POINTS / (POINTS + 1), rel=0.03)
    assert lows[-1] > 0.0


def test_a_free_fall_keeps_its_energy_until_it_is_taut():
    rope = Rope([0, 0, 0], [0.5, 0, 0], 1.5, kg_per_m=0.05)
    before = rope.energy()
    forces, lows = rope.run(0.05)
    # Symplectic Euler is off by half a step of the fall.
    assert rope.energy() == pytest.approx(before, abs=1e-5)
    assert not forces.any()
    assert not lows.any()


def test_a_swinging_rope_never_gains_energy():
    rope = Rope([0, 0, 0], [0.6, 0, 0.3], 1.0, kg_per_m=0.05)
    energies = []
    for _ in range(20):
        rope.run(0.1)
        energies.append(rope.energy())
    assert max(energies[5:]) <= energies[0] + 1e-3


def test_a_short_rope_stays_stable():
    rope = Rope([0, 0, 0], [0, 0, 0.032], 0.03, kg_per_m=0.002)
    forces, _ = rope.run(1.0)
    assert np.isfinite(forces).all()
    assert np.abs(rope.speed).max() < 1.0
