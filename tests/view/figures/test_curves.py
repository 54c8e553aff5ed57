import numpy as np
import pytest

from armland.errors import LogError
from armland.rotations import angle, error, from_rotation_vector, multiply
from armland.view.figures.curves import clocked, deviation_deg, error_mm, moves, rests, roll_pitch_yaw_deg, thinned

RATE_HZ, SETTLE_S = 100, 0.5


def test_time_starts_with_the_desired_path(make_run) -> None:
    runs = clocked([make_run("E2"), make_run("E1", seconds=2.0)])
    assert [run.name for run in runs] == ["E1", "E2"]
    assert runs[0].time[0] == -SETTLE_S
    assert runs[0].time[round(SETTLE_S * RATE_HZ)] == 0.0
    assert runs[1].time[-1] == pytest.approx(3.0 - SETTLE_S - 1.0 / RATE_HZ)
    assert len(runs[1].judged(runs[1].ticks["truth"])) == 250


def test_no_run_is_an_error() -> None:
    with pytest.raises(LogError, match="no run to draw"):
        clocked([])


@pytest.mark.parametrize("ticks", [0, 1, 50, 51])
def test_run_that_ends_before_its_path_is_an_error(make_run, ticks: int) -> None:
    run = make_run("E2")
    with pytest.raises(LogError, match=f"run E2 has {ticks} ticks"):
        clocked([make_run(), run._replace(ticks=run.ticks[:ticks])])


def test_run_without_a_path_is_an_error(make_run) -> None:
    run = make_run()
    with pytest.raises(LogError, match="follows no path"):
        clocked([run._replace(brief=run.brief._replace(legs=()))])


def random_attitudes(count: int) -> np.ndarray:
    q = np.random.default_rng(7).normal(size=(count, 4))
    return q / np.linalg.norm(q, axis=1)[:, None]


def test_eq15_deviation_is_the_angle_of_the_attitude_error(make_run) -> None:
    log = make_run().ticks[:100]
    log["truth"]["quat"], log["reference"]["quat"] = random_attitudes(200).reshape(2, 100, 4)
    expected = [np.degrees(angle(error(t["reference"]["quat"], t["truth"]["quat"]))) for t in log]
    np.testing.assert_allclose(deviation_deg(log), expected, rtol=0.0, atol=1e-9)
    log["truth"]["quat"] *= -1.0
    np.testing.assert_allclose(deviation_deg(log), expected, rtol=0.0, atol=1e-9)


def test_tiny_deviation_keeps_its_digits(make_run) -> None:
    log, tiny = make_run().ticks[:1], np.array([0.0, 1e-9, 0.0])
    log["reference"]["quat"] = random_attitudes(1)
    log["truth"]["quat"] = multiply(log["reference"]["quat"][0], from_rotation_vector(tiny))
    assert deviation_deg(log)[0] == pytest.approx(np.degrees(1e-9), rel=1e-6)
    # The textbook formula sees nothing here.
    assert np.arccos(min(1.0, np.sum(log["truth"]["quat"] * log["reference"]["quat"]))) in (
        0.0,
        pytest.approx(1e-8, abs=1e-7),
    )


def test_tilt_is_roll_then_pitch_then_yaw(make_run) -> None:
    log, angles = make_run().ticks[:50], np.random.default_rng(3).uniform(-80.0, 80.0, (50, 3))
    for tick, (roll, pitch, yaw) in zip(log, np.deg2rad(angles), strict=True):
        turns = [from_rotation_vector(a * np.eye(3)[i]) for i, a in enumerate((roll, pitch, yaw))]
        tick["truth"]["quat"] = multiply(turns[2], multiply(turns[1], turns[0]))
    np.testing.assert_allclose(roll_pitch_yaw_deg(log), angles, rtol=0.0, atol=1e-9)


def test_error_is_actual_minus_desired(make_run) -> None:
    np.testing.assert_allclose(error_mm(make_run(offset_mm=2.0).ticks), 2.0, rtol=0.0, atol=1e-9)


def test_moves_and_rests_of_the_path(make_run) -> None:
    (run,) = clocked([make_run()])
    tick = 1.0 / RATE_HZ
    assert np.array(moves(run)) == pytest.approx(np.array([[0.5, 1.5]]), abs=1.1 * tick)
    assert np.array(rests(run)) == pytest.approx(np.array([[1.5, 2.5]]), abs=1.1 * tick)
    run.ticks["reference"]["r"] = 0.5
    assert moves(run) == []
    assert rests(run) == []


def test_thinning_keeps_peaks_ends_and_order() -> None:
    x = np.arange(10000.0)
    y = np.zeros(10000)
    y[1234], y[8765] = 3.0, -2.0
    u, v = thinned(x, y, buckets=100)
    assert len(u) <= 202
    assert (v.max(), v.min()) == (3.0, -2.0)
    assert (u[0], u[-1]) == (0.0, 9999.0)
    assert (np.diff(u) > 0.0).all()
    # A plain "every k-th" loses them.
    assert not y[::50].any()


def test_short_curves_stay_as_they_are() -> None:
    x = np.arange(200.0)
    u, v = thinned(x, x**2, buckets=100)
    assert u is x
    assert len(v) == 200
