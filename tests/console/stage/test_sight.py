"""What the camera sees: the marker where the plant's camera finds it, hulls of what is before it, and words."""

import re

import numpy as np
import pytest

from armland.console.stage.poses import Poses
from armland.console.stage.sight import BLACK, FOUND, PIVOT, WIDTH, Sight


@pytest.fixture(scope="module")
def sight(recording) -> Sight:
    return Sight(Poses(recording.scene), recording.scenario.camera)


def picture(sight, tick, period_s: float = 1e-3) -> str:
    sight.poses.set(tick["truth"])
    return sight.svg(tick, period_s)


def corners(svg: str, color: str) -> np.ndarray:
    path = re.search(rf'<polygon points="([^"]*)" fill="(?:none" stroke=")?{color}', svg)[1]
    return np.array([float(n) for n in path.split(",")]).reshape(-1, 2)


@pytest.mark.parametrize("time", [2.9, 6.0, 11.0])
def test_the_marker_lies_where_the_plant_s_camera_has_it(sight, recording, time) -> None:
    """Two ways to one place: MuJoCo's camera and shapes, and the simulated sensor's own geometry with its noise and delay."""
    tick = recording.at(time)
    assert tick["estimate"]["plate_valid"]
    svg = picture(sight, tick)
    drawn, found = corners(svg, BLACK).mean(axis=0), corners(svg, FOUND).mean(axis=0)
    np.testing.assert_allclose(found, drawn, atol=0.05 * WIDTH)
    size = [np.ptp(corners(svg, color), axis=0).max() for color in (BLACK, FOUND)]
    assert size[1] == pytest.approx(size[0], rel=0.1)


def test_a_point_on_the_view_s_edge_lies_on_the_picture_s(sight) -> None:
    u, v = sight._pixels(sight._half)
    height = WIDTH * sight._half[1] / sight._half[0]
    assert (u, v) == (pytest.approx(WIDTH), pytest.approx(height))
    np.testing.assert_allclose(sight._pixels(np.zeros(2)), [0.5 * WIDTH, 0.5 * height])


def test_it_says_whether_the_marker_is_found_and_how_old_the_image_is(sight, recording) -> None:
    tick = recording.ticks[3000:3001].copy()
    tick["measurement"]["camera_capture"] = tick["measurement"]["tick"] - 70
    tick["measurement"]["camera_position"] = [0.0, 0.0, 0.25]
    assert "marker at 0.250 m, in an image 70 ms old" in picture(sight, tick[0])
    tick["estimate"]["plate_valid"] = 0
    svg = picture(sight, tick[0])
    assert "the marker is not found" in svg
    assert FOUND not in svg
    tick["measurement"]["camera_position"] = np.nan
    assert "polygon" in picture(sight, tick[0])


def test_the_pivot_is_marked_where_it_is_in_view(sight, recording) -> None:
    assert PIVOT in picture(sight, recording.at(2.0))


def test_it_is_small_enough_to_be_sent_a_few_times_a_second(sight, recording) -> None:
    sizes = [len(picture(sight, recording.at(t))) for t in np.linspace(0.0, recording.end, 12)]
    assert max(sizes) < 20_000
