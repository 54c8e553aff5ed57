"""Random streams by name: repeatable, independent of one another, and white."""

import numpy as np
import pytest

from armland.plant.noise import BLOCK, Noise, NoiseSource, stream, uniform


def rows(seed, name, blocks=1, joints=7):
    source, out = NoiseSource(seed, joints), []
    for _ in range(blocks):
        source.draw()
        out.append(getattr(source.rows, name).copy())
    return np.concatenate(out)


def test_same_seed_and_name_give_the_same_numbers():
    np.testing.assert_array_equal(rows(3, "imu"), rows(3, "imu"))


def test_another_seed_or_name_gives_other_numbers():
    assert np.abs(rows(3, "imu") - rows(4, "imu")).min() > 0.0
    assert np.abs(rows(3, "imu") - rows(3, "wrench")).min() > 0.0


@pytest.mark.parametrize("name", Noise._fields[:-2])
def test_each_device_has_a_stream_of_its_own(name):
    """What a stream gives alone it gives among all others: one more device moves nobody's noise."""
    block = rows(7, name)
    np.testing.assert_array_equal(block, stream(7, name).standard_normal(block.shape))


def test_wind_that_is_known_by_the_clock_is_not_drawn():
    source = NoiseSource(7, 7)
    source.rows.wind[:] = 3.0
    source.draw()
    np.testing.assert_array_equal(source.rows.wind, 3.0)


def test_device_that_the_scene_lacks_costs_no_numbers_and_moves_no_other():
    source = NoiseSource(7, 7, {"camera", "reference"})
    source.draw()
    for name in Noise._fields[:-2]:
        drawn = 0.0 if name in {"camera", "reference"} else rows(7, name)
        np.testing.assert_array_equal(getattr(source.rows, name), drawn)


def test_width_of_one_device_moves_no_other():
    np.testing.assert_array_equal(rows(7, "wrench", joints=6), rows(7, "wrench", joints=7))


def test_blocks_continue_one_long_draw_in_the_same_arrays():
    long = stream(5, "wrench").standard_normal((3 * BLOCK, 6))
    np.testing.assert_array_equal(rows(5, "wrench", blocks=3), long)
    source = NoiseSource(5, 7)
    before = source.rows
    source.draw()
    assert all(a is b for a, b in zip(before, source.rows, strict=True))


def test_restart_begins_anew():
    source = NoiseSource(5, 7)
    source.draw()
    first = source.rows.link.copy()
    source.draw()
    assert np.abs(source.rows.link - first).min() > 0.0
    source.restart()
    source.draw()
    np.testing.assert_array_equal(source.rows.link, first)


def test_numbers_are_standard_normal_and_white():
    """30 000 rows: mean within 5/√N, variance within 5√(2/N), no correlation in time, between columns or streams."""
    x, y = rows(1, "wrench", blocks=30), rows(1, "imu", blocks=30)
    bound = 5.0 / np.sqrt(len(x))
    assert np.abs(x.mean(axis=0)).max() < bound
    assert np.abs(x.var(axis=0) - 1.0).max() < np.sqrt(2.0) * bound
    assert np.abs(np.mean(x[1:] * x[:-1], axis=0)).max() < bound
    assert np.abs(np.mean(x[:, 0] * x[:, 1])) < bound
    assert np.abs(np.mean(x * y, axis=0)).max() < bound
    # Fourth moment 3: normal, not merely of unit variance.
    assert np.mean(x**4) == pytest.approx(3.0, abs=0.15)


def test_normal_numbers_become_uniform_ones():
    u = np.sort([uniform(x) for x in rows(1, "link").ravel()])
    assert np.abs(u - (np.arange(u.size) + 0.5) / u.size).max() < 0.04
    assert u.min() >= 0.0
    assert u.max() < 1.0
    assert uniform(40.0) < 1.0
