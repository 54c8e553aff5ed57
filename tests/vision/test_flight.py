"""The whole chain: rendered pictures, the real detector, pose filter, mission and arm in one loop."""

import pytest

from armland.errors import PictureError
from armland.scenario import load_scenario
from armland.view.figures.markers import draw_flight
from armland.vision.flight import fly_rendered, summary
from armland.vision.imaging import Imaging


@pytest.mark.slow
def test_lands_by_rendered_pictures(tmp_path) -> None:
    pytest.importorskip("cv2")
    try:
        flight = fly_rendered(load_scenario("landing", {"run": {"seed": 3}}))
    except PictureError as e:
        pytest.skip(str(e))
    result = summary(flight)
    assert result["success"], result["reason"]
    assert result["capture"]["offset_m"] < 0.004
    assert result["found"] > 0.95 * result["pictures"] > 90
    assert [name for name, _, _ in flight.phases][-1] == "done"
    # The print's true error in the loop stays below what the model claims at the farthest distance, 0.5 m.
    assert result["lateral_mm"] < 0.5
    assert result["depth_mm"] < 1.2
    assert draw_flight(tmp_path, flight)[1].stat().st_size > 100_000


@pytest.mark.slow
def test_does_not_begin_by_pictures_that_show_nothing() -> None:
    pytest.importorskip("cv2")
    scenario = load_scenario("landing", {"run": {"seed": 3, "duration_s": 2.0}})
    try:
        flight = fly_rendered(scenario, Imaging(read_noise=150.0))
    except PictureError as e:
        pytest.skip(str(e))
    assert summary(flight)["found"] == 0
    assert not flight.episode.judgement.success
    # By good pictures it is on its way after one second.
    assert [name for name, _, _ in flight.phases] == ["self_test"]
