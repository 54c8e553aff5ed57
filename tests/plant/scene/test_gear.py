"""Gear that does not fit together is refused; the cradle stands where the mission puts the UAV down."""

import numpy as np
import pytest

from armland.errors import ConfigurationError, ModelError
from armland.plant.scene.composition import build_scene
from armland.plant.scene.gear import cradle_position


@pytest.mark.parametrize(
    ("sections", "words"),
    [
        ({"plate": {"radius_m": 0.012}}, r"plate\.radius_m = 0\.012 .* must exceed 0\.015"),
        ({"skids": {"half_length_m": 0.10}}, r"skids\.half_length_m = 0\.1 .* must exceed 0\.149"),
        ({"tool": {"length_m": 0.06}}, r"tool\.length_m = 0\.06 .* must exceed 0\.0624"),
    ],
)
def test_gear_that_does_not_fit_is_refused(landing, sections, words):
    with pytest.raises(ModelError, match=words):
        build_scene(landing(**sections), "free")


@pytest.mark.parametrize("down", [[0.66, 0.03, 0.72], [0.7, 0.0, 0.65]])
def test_cradle_stands_where_the_mission_puts_the_uav_down(landing, down):
    np.testing.assert_allclose(build_scene(landing(place={"put_down_m": down}), "free").put_down, down)


def test_cradle_on_the_floor_is_refused(landing):
    with pytest.raises(ConfigurationError, match=r"0\.059 m above the floor; they must lie at least 0\.1 m"):
        cradle_position(landing(place={"put_down_m": [0.68, 0.0, 0.1]}), np.array([0.0, 0.0, -0.06]))


def test_sizes_are_the_scenarios(landing):
    sizes = {"cradle": {"gap_m": 0.2, "heading_deg": 90.0}, "skids": {"radius_m": 0.007, "half_length_m": 0.2}}
    model = build_scene(landing(**sizes, magnet={"pad_radius_m": 0.012}, plate={"thickness_m": 0.005}), "free").model
    rails = np.array([model.geom(f"rail_{i}").pos[1] for i in (1, 2)])
    np.testing.assert_allclose(np.abs(rails) - 0.012, 0.1)
    np.testing.assert_allclose(model.body("cradle").quat, np.sqrt(0.5) * np.array([1, 0, 0, 1]))
    np.testing.assert_allclose(model.geom("uav/skid_1").size[:2], [0.007, 0.2])
    assert np.hypot(*model.geom("pad_1").pos[:2]) == pytest.approx(0.012)
    assert model.geom("uav/plate").size[1] == pytest.approx(0.0025)
