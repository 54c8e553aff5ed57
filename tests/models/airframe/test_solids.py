"""What stands around an arm, against sizes worked out by hand."""

import mujoco
import numpy as np
import pytest

from armland.models.airframe.solids import add_cradle, add_uav, stand_legs
from armland.plant.scene.composition import build_scene
from armland.scenario import load_scenario


@pytest.fixture(scope="module")
def scenario():
    return load_scenario("landing").believed()


def lying(model, name):
    """Ends (2, 3) of the capsule `name` in the world."""
    data, geom = mujoco.MjData(model), model.geom(name)
    mujoco.mj_kinematics(model, data)
    way = data.geom(name).xmat.reshape(3, 3)[:, 2] * geom.size[1]
    return data.geom(name).xpos + np.array([-way, way])


def test_rails_are_the_slot_apart_and_their_upper_edge_is_the_bodys_origin(scenario):
    spec = mujoco.MjSpec()
    assert add_cradle(spec, scenario) == ["rail-1", "leg-1a", "leg-1b", "rail+1", "leg+1a", "leg+1b"]
    model = spec.compile()
    one, other = lying(model, "rail-1"), lying(model, "rail+1")
    radius, gap = scenario.cradle.radius_m, scenario.cradle.gap_m
    np.testing.assert_allclose(other[:, 1] - one[:, 1], gap + 2.0 * radius)
    np.testing.assert_allclose(one[:, 2] + radius, 0.0, atol=1e-12)
    np.testing.assert_allclose(np.ptp(one[:, 0]), scenario.cradle.length_m)


@pytest.mark.parametrize("height", [0.2, 0.4, 0.9, 1.6])
def test_legs_stand_where_the_plants_do_at_any_height(scenario, height):
    """Ends of the legs of the planner's cradle and of the plant's, which is built apart from it; both reach the floor."""
    catch = [*scenario.place.put_down_m[:2], height + 0.3]
    down = [*catch[:2], height + 0.1]
    moved = scenario.replaced({"place": {"put_down_m": down, "catch_m": catch}})
    plant = build_scene(moved, "free").model
    stand, origin = plant.body("stand"), plant.body("stand").pos.copy()
    data = mujoco.MjData(plant)
    mujoco.mj_kinematics(plant, data)
    theirs = []
    for g in range(stand.geomadr[0], stand.geomadr[0] + stand.geomnum[0]):
        way = data.geom(g).xmat.reshape(3, 3)[:, 2] * plant.geom_size[g, 1]
        theirs.append(sorted((data.geom(g).xpos + [-way, way]).round(6).tolist()))
    spec = mujoco.MjSpec()
    names = add_cradle(spec, moved)
    spec.body("cradle").pos = origin
    model = spec.compile()
    stand_legs(model, moved.cradle, float(origin[2]))
    ours = [sorted(lying(model, n).round(6).tolist()) for n in names if n.startswith("leg")]
    np.testing.assert_allclose(sorted(ours), sorted(theirs), atol=2e-6)
    assert min(p[2] for leg in ours for p in leg) == pytest.approx(0.0, abs=1e-6)


def test_uav_is_drawn_about_its_centre_of_mass(scenario):
    """The AR.Drone's file: a sphere of 12.5 mm around the pivot, 60 mm below; skids 95 mm below; marker 30 mm below."""
    spec = mujoco.MjSpec()
    add_uav(spec, scenario)
    model = spec.compile()
    places = {(round(float(g.size[0]), 4), round(float(g.pos[2]), 4)) for g in map(model.geom, range(model.ngeom))}
    assert {(0.0125, -0.06), (0.006, -0.095), (0.0375, -0.0295)} <= places
    assert np.count_nonzero(model.geom_contype) == 0
