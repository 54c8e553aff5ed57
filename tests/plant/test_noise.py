"""Random streams by name: repeatable, independent of one another, and white."""

import numpy as np
import pytest

from armland.plant.noise import BLOCK, WhiteNoise, stream


def rows(seed, name, width, blocks=1):
    noise = WhiteNoise(seed, name, width)
    out = []
    for _ in range(blocks):
        noise.draw()
        out.append(noise.rows.copy())
    return np.concatenate(out)


def test_same_seed_and_name_give_the_same_numbers():
    np.testing.assert_array_equal(rows(3, "imu", 6), rows(3, "imu", 6))


@pytest.mark.parametrize(("seed", "name"), [(3, "wrench"), (4, "imu"), (3, "imu ")])
def test_another_seed_or_name_gives_other_numbers(seed, name):
    assert np.abs(rows(3, "imu", 6) - rows(seed, name, 6)).min() > 0.0


def test_one_more_stream_does_not_move_the_others():
    """Streams made in any order, with others between them and drawn in any order, give what each gives alone."""
    names = ["encoders", "wrench", "imu"]
    alone = {name: rows(7, name, 3) for name in names}
    together = {name: WhiteNoise(7, name, 3) for name in ["wind", *reversed(names), "deck"]}
    for noise in together.values():
        noise.draw()
    for name in names:
        np.testing.assert_array_equal(together[name].rows, alone[name])


def test_blocks_continue_one_long_draw():
    long = stream(5, "wrench").standard_normal((3 * BLOCK, 2))
    np.testing.assert_array_equal(rows(5, "wrench", 2, blocks=3), long)


def test_numbers_are_standard_normal_and_white():
    """30 000 rows: mean within 5/√N, variance within 5√(2/N), no correlation in time, between columns or streams."""
    x, y = rows(1, "wrench", 3, blocks=30), rows(1, "imu", 3, blocks=30)
    bound = 5.0 / np.sqrt(len(x))
    assert np.abs(x.mean(axis=0)).max() < bound
    assert np.abs(x.var(axis=0) - 1.0).max() < np.sqrt(2.0) * bound
    assert np.abs(np.mean(x[1:] * x[:-1], axis=0)).max() < bound
    assert np.abs(np.mean(x[:, 0] * x[:, 1])) < bound
    assert np.abs(np.mean(x * y, axis=0)).max() < bound
    # Fourth moment 3: normal, not merely of unit variance.
    assert np.mean(x**4) == pytest.approx(3.0, abs=0.15)
