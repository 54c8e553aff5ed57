"""Sections of a landing without an arm: what is refused, and that the defaults fit together."""

import pytest

from armland.errors import ConfigurationError
from armland.scenario import load_scenario


@pytest.mark.parametrize(
    ("sections", "words"),
    [
        ({"descent": {"ready_m": 0.6}}, r"ready_m = 0\.6 must be below wait_m = 0\.5: it waits for a quiet moment"),
        ({"descent": {"sink_mps": 0.0}}, r"descent\.sink_mps"),
        ({"descent": {"patience_s": -1.0}}, r"descent\.patience_s"),
        ({"pad": {"friction": 3.0}}, r"pad\.friction"),
        ({"pad": {"height_m": 0.05}}, r"pad\.height_m"),
        ({"pad": {"wings": 2}}, r"pad\.wings"),
    ],
)
def test_what_no_pad_and_no_descent_is(sections, words):
    with pytest.raises(ConfigurationError, match=words):
        load_scenario("unassisted", sections)


def test_scenario_of_the_method_is_the_landing_with_descents_of_its_own():
    own, landing = load_scenario("unassisted"), load_scenario("landing")
    for section in ("uav", "rotors", "onboard", "link", "sensors", "camera", "skids", "imperfections"):
        assert getattr(own, section) == getattr(landing, section)
    # The pad's place is its own by a millimetre, so that rough weather, which moves an arm's places, leaves it alone.
    same = own.place.model_copy(update={"put_down_m": landing.place.put_down_m})
    assert same == landing.place
    assert own.place.put_down_m[:2] == landing.place.put_down_m[:2]
    assert own.place.put_down_m[2] == pytest.approx(landing.place.put_down_m[2], abs=1.1e-3)


def test_camera_sees_the_marker_of_a_uav_that_stands():
    s = load_scenario("unassisted")
    depth = s.pad.recess_m + s.skids.radius_m - s.skids.z_m + s.camera.marker_m[2]
    assert s.camera.depth_min_m < depth < s.camera.depth_max_per_size * s.camera.marker_size_m
