"""An arm that went through floor, cradle, UAV or itself has failed, whether or not the plant lets those touch."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from armland.experiments.judge.brief import brief_of
from armland.experiments.judge.geometry import insides
from armland.experiments.judge.judgement import judge
from armland.experiments.judge.limits import limits_violated
from armland.experiments.judge.solids import solids_of
from armland.models.arm_file.meshes.worn import worn
from armland.models.parameters import arm_file
from armland.plant.scene.composition import build_scene
from armland.records import tick_layout
from armland.scenario import load_scenario

from .conftest import METADATA, standing

ARMS = Path(__file__).parents[2] / "data" / "arms"

PENDULUM = """
<mujoco>
  <worldbody>
    <geom name="floor" type="plane" size="0 0 0.1" contype="2" conaffinity="0"/>
    <body name="arm/upper" pos="0 0 0.5">
      <joint axis="0 1 0"/>
      <geom type="capsule" fromto="0 0 0.1 0 0 0.55" size="0.05" conaffinity="7"/>
    </body>
    <body name="uav/uav" mocap="true"><geom type="sphere" size="0.1" contype="4" conaffinity="0"/></body>
    <body name="cradle" pos="0.5 0 0.5"><geom type="sphere" size="0.06" contype="2" conaffinity="0"/></body>
  </worldbody>
</mujoco>
"""
"""A link of 0.55 m with a round end of 50 mm, half a metre above the floor."""


def swung(angle, uav=(0.0, 0.0, 9.0), ticks=100):
    r = np.zeros(ticks, tick_layout(1))
    r["truth"]["quat"][:, 0] = 1.0
    r["truth"]["r_cm"], r["truth"]["q"] = uav, angle
    return r


@pytest.fixture
def pendulum():
    return brief_of(METADATA | {"solids": PENDULUM})


def test_depth_is_that_of_the_round_end_below_the_floor(pendulum):
    found = insides(swung(np.pi), pendulum)
    assert list(found) == ["upper_in_floor"]
    # Its middle hangs 0.05 m below, and it reaches 0.05 m further.
    assert found["upper_in_floor"].depth.max() == pytest.approx(100.0, abs=0.01)


def test_depth_in_cradle_and_uav(pendulum):
    found = insides(swung(np.pi / 2, uav=(0.3, 0.0, 0.62)), pendulum)
    # The cradle's sphere is around a point of the link's axis: the shortest way out is radial.
    assert found["upper_in_cradle"].depth.max() == pytest.approx(110.0, abs=0.01)
    assert found["upper_in_uav"].depth.max() == pytest.approx(30.0, abs=0.01)


def test_uav_is_where_its_centre_of_mass_and_attitude_put_it(pendulum):
    low = pendulum._replace(uav_cm=np.array([0.0, 0.0, 0.1]))
    ticks = swung(np.pi / 2, uav=(0.3, 0.0, 0.62))
    assert insides(ticks, low)["upper_in_uav"].depth.max() == pytest.approx(130.0, abs=0.01)
    ticks["truth"]["quat"] = [0.0, 1.0, 0.0, 0.0]
    assert "upper_in_uav" not in insides(ticks, low)


def test_arm_that_is_clear_and_a_log_without_solids_have_none(pendulum, ticks, brief):
    assert insides(swung(0.0), pendulum) == {}
    assert insides(ticks, brief) == {}


def test_moment_is_told(pendulum):
    ticks = swung(0.0, ticks=4000)
    ticks["truth"]["q"][2000:2100] = np.pi
    assert np.flatnonzero(insides(ticks, pendulum)["upper_in_floor"].where)[[0, -1]].tolist() == [2000, 2080]


BASE = (
    '<body name="arm/base" pos="0.5 0 0.4"><geom type="sphere" size="0.05" conaffinity="7"/></body><body name="uav/uav"'
)


def test_base_that_stands_in_the_cradle_is_seen_though_neither_moves(pendulum):
    """Spheres of 50 and 60 mm, 100 mm apart; a base 20 mm lower is clear."""
    inside = pendulum._replace(solids=PENDULUM.replace('<body name="uav/uav"', BASE))
    found = insides(swung(0.0), inside)
    assert list(found) == ["base_in_cradle"]
    assert found["base_in_cradle"].depth.max() == pytest.approx(10.0, abs=1e-6)
    assert insides(swung(0.0), inside._replace(solids=inside.solids.replace("0.5 0 0.4", "0.5 0 0.38"))) == {}


@pytest.fixture(scope="module")
def lwr():
    scene = build_scene(load_scenario("landing"), "free")
    return METADATA | {"solids": solids_of(scene), "uav_cm": json.dumps(scene.model.site("uav/cm").pos.tolist())}


THROUGH = np.deg2rad([0.0, 110.0, 0.0, -60.0, 0.0, 0.0, 0.0])
"""The LWR bent down in front of itself: its wrist is below the floor."""


def bent(q):
    ticks = standing()
    ticks["truth"]["q"], ticks["truth"]["r_cm"][:, 2] = q, 5.0
    return ticks


def test_landing_through_the_floor_fails_with_link_time_and_depth(lwr):
    ticks, brief = bent(THROUGH), brief_of(lwr)
    found = [name for name in limits_violated(ticks, brief) if name.endswith("_in_floor")]
    assert "link_5_in_floor" in found
    judgement = judge(ticks, brief)
    assert not judgement.success
    assert "link_5_in_floor (in guide at 0.00 s, up to " in judgement.reason
    assert " mm)" in judgement.reason
    # Without the solids the same record shows nothing of it.
    assert not [n for n in limits_violated(ticks, brief_of(METADATA)) if "_in_" in n]


def test_arm_upright_is_clear_and_folded_into_itself_is_not(lwr):
    brief = brief_of(lwr)
    assert insides(bent(np.zeros(7)), brief) == {}
    folded = insides(bent(np.deg2rad([0.0, 0.0, 0.0, 170.0, 0.0, 0.0, 0.0])), brief)
    assert any(name.startswith(("link_6_in_", "link_7_in_", "tool_in_")) for name in folded)


def bracket(at):
    """The pendulum with a bracket of a mesh in place of its capsule, its arms along the link and to `at` (3,) m."""
    outline = [(0, 0), (0.4, 0), (0.4, 0.1), (0.1, 0.1), (0.1, 0.4), (0, 0.4)]
    vertices = [f"{y:g} {x - 0.05:g} {z:g}" for z in (-0.05, 0.05) for x, y in outline]
    sides = [(i, (i + 1) % 6, (i + 1) % 6 + 6) for i in range(6)] + [(i, (i + 1) % 6 + 6, i + 6) for i in range(6)]
    fans = [(0, k, k + 1) for k in range(1, 5)]
    faces = [(a, c, b) for a, b, c in sides] + fans + [(a + 6, c + 6, b + 6) for a, b, c in fans]
    told = " ".join(f"{a} {b} {c}" for a, b, c in faces)
    mesh = f'<asset><mesh name="m" vertex="{"  ".join(vertices)}" face="{told}" inertia="shell"/></asset><worldbody>'
    text = PENDULUM.replace("<worldbody>", mesh, 1).replace('"0.5 0 0.5"', f'"{at[0]:g} {at[1]:g} {at[2]:g}"')
    geom = '<geom type="mesh" mesh="m" mass="0.1" contype="0" conaffinity="7"/>'
    return text.replace('<geom type="capsule" fromto="0 0 0.1 0 0 0.55" size="0.05" conaffinity="7"/>', geom)


def test_hull_of_a_mesh_that_meets_something_is_no_depth(pendulum):
    """The cradle's ball stands in the inner corner, inside the hull; 80 mm lower one of the arms of the bracket is in it."""
    corner = insides(swung(0.0), pendulum._replace(solids=bracket((0.2, 0.15, 0.5))))
    assert corner == {}
    found = insides(swung(0.0), pendulum._replace(solids=bracket((0.2, 0.08, 0.5))))
    assert list(found) == ["upper_in_cradle"]
    # The ball of 60 mm is 30 mm beside the arm, which ends at y = 50 mm.
    assert found["upper_in_cradle"].depth.max() == pytest.approx(30.0, abs=2.0)


def test_links_wear_the_meshes_of_their_file_in_place_of_what_stands_for_them(tmp_path):
    """A block of 0.2 m that the file draws around the third link is seen; without its file a capsule stands there."""
    block = [f"v {x:g} {y:g} {z:g}\n" for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.1, 0.1)]
    quads = ("1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4")
    part = '<link name="l3"><visual><geometry><mesh filename="block.obj"/></geometry></visual>'
    file = tmp_path / "ok.urdf"
    file.write_text((ARMS / "ok.urdf").read_text("utf-8").replace('<link name="l3">', part))
    scenario = load_scenario("landing", {"arm": {"file": str(file), "ee": "tool0"}})

    def seen():
        solids = solids_of(build_scene(scenario, "free"), worn(arm_file(scenario).chain))
        return {
            m.group(1): m.group(2)
            for m in re.finditer(r'<body name="arm/(\w+)"[^>]*>.*?<geom[^>]*type="(\w+)"', solids, re.S)
        }

    bare = seen()
    (tmp_path / "block.obj").write_text("".join(block) + "".join(f"f {q}\n" for q in quads))
    dressed = seen()
    assert dressed["l3"] == "mesh"
    assert bare["l3"] == "capsule"
    assert {k: v for k, v in dressed.items() if k != "l3"} == {k: v for k, v in bare.items() if k != "l3"}


def test_hinged_uav_has_no_solids():
    assert solids_of(build_scene(load_scenario("paper"), "hinged", ())) == ""
