"""A gap closes the same at each step size."""

import numpy as np
import pytest

from armland.plant.scene.closing import closing


@pytest.mark.parametrize("step", [1e-3, 2.5e-4])
def test_gap_closes_the_same_at_each_step_size(step):
    # x = (1 + λ t) e^(−λ t) obeys x₂ − 2 e^(−λ h) x₁ + e^(−2λ h) x₀ = 0; a step is v' = v − h (B v + K x), x' = x + h v'.
    (K_, B), rate = (-a for a in closing(500.0, step)), 500.0
    x, v, seen = 1.0, 0.0, []
    for _ in range(8):
        seen.append(x)
        v -= step * (B * v + K_ * x)
        x += step * v
    left = np.exp(-rate * step)
    for a, b, c in zip(seen, seen[1:], seen[2:], strict=False):
        assert c - 2.0 * left * b + left**2 * a == pytest.approx(0.0, abs=1e-12)


def test_short_steps_make_the_closing_numbers_those_of_a_critically_damped_spring():
    np.testing.assert_allclose(closing(500.0, 1e-7), [-(500.0**2), -1000.0], rtol=1e-3)
