"""Distances of the arm to what is around it, against distances worked out by hand."""

from pathlib import Path

import mujoco
import numpy as np
import pytest

from armland.errors import ConfigurationError, MountingError
from armland.experiments.episode import prepare
from armland.experiments.judge.solids import solids_of
from armland.mission.feasibility.obstacles import CRADLE_M, FLOOR_M, UAV_M, Obstacles
from armland.mission.feasibility.reach import check_beside
from armland.models.parameters import arm_model
from armland.models.posture import lead
from armland.plant.scene.composition import build_scene
from armland.scenario import load_scenario

AWAY = np.array([0.0, 0.0, 50.0])


@pytest.fixture(scope="module")
def scenario():
    return load_scenario("landing").believed()


@pytest.fixture(scope="module")
def arm(scenario):
    return arm_model(scenario)


@pytest.fixture
def around(scenario):
    made = Obstacles(scenario)
    made.put_cradle(np.array(scenario.place.put_down_m), 0.0)
    return made


def at(arm, scenario, point):
    return lead(arm, np.deg2rad(scenario.place.home_deg), np.array(point), 25)


def test_arm_of_the_landing_is_clear_where_it_is_caught_and_in_the_cradle(arm, scenario, around):
    for point in (scenario.place.catch_m, scenario.place.put_down_m):
        assert around.nearest(at(arm, scenario, point), np.array(point)).room > 0.02


def test_arm_beside_the_slots_middle_meets_a_rail(arm, scenario, around):
    """Rails 0.25 m apart, links 0.12 m wide: in the middle of the slot 65 mm are left, 60 mm beside it the arm is too near."""
    near = around.nearest(at(arm, scenario, [0.62, -0.06, 0.86]), AWAY)
    assert near.other == "the cradle"
    assert near.room < 0.0
    # The cradle aside by as much, the same pose is clear.
    around.put_cradle(np.array(scenario.place.put_down_m) - [0.0, 0.06, 0.0], 0.0)
    assert around.nearest(at(arm, scenario, [0.62, -0.06, 0.86]), AWAY).room > near.room + 0.02


def test_slack_is_taken_off_the_clearance(arm, scenario, around):
    q = at(arm, scenario, [0.62, -0.05, 0.86])
    tight, loose = around.nearest(q, AWAY), around.nearest(q, AWAY, slack=0.008)
    assert tight.clearance == CRADLE_M
    assert loose.room - tight.room == pytest.approx(0.008, abs=1e-6)


def test_elbow_that_hangs_to_the_floor_is_told_with_its_distance(arm, scenario, around):
    """Stretched level and down: the capsule of 60 mm about the forearm ends below the floor."""
    q = np.zeros(arm.joints)
    q[1] = np.deg2rad(118.0)
    arm.update(q, np.zeros(arm.joints))
    near = around.nearest(q, AWAY)
    assert near.other == "the floor"
    lowest = arm.anchor[-2:, 2].min() - 0.06 - FLOOR_M
    assert near.room == pytest.approx(lowest, abs=0.05)
    assert near.room < 0.0


def test_any_place_that_is_too_tight_will_do_where_it_is_asked_for(arm, scenario, around):
    q = at(arm, scenario, [0.62, -0.06, 0.86])
    assert around.nearest(q, AWAY, any_will_do=True).room < 0.0
    clear = at(arm, scenario, scenario.place.catch_m)
    assert around.nearest(clear, AWAY, any_will_do=True) == around.nearest(clear, AWAY)


def test_uav_that_is_held_too_low_meets_the_arm(arm, scenario, around):
    q = at(arm, scenario, scenario.place.catch_m)
    held = around.nearest(q, np.array(scenario.place.catch_m))
    sunk = around.nearest(q, np.array(scenario.place.catch_m) - [0.1, 0.0, 0.25])
    assert held.room > 0.0 > sunk.room
    assert sunk.other == "the UAV"


ARMS = Path(__file__).parents[2] / "data" / "arms"

FINGER = """<link name="finger"><collision><origin xyz="0.055 0 {middle}"/><geometry><box size="0.01 0.02 0.04"/></geometry></collision>
  <inertial><mass value="0.05"/><inertia ixx="1e-4" iyy="1e-4" izz="1e-4" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="grip" type="prismatic"><parent link="tool0"/><child link="finger"/><origin xyz="0 0 0.1"/><axis xyz="0 1 0"/>
  <limit lower="0" upper="0.01" effort="20" velocity="1"/></joint></robot>"""

FINGER_MJCF = """<site name="tool0" pos="0 0 0.07"/><body name="hand" pos="0 0 0.07"><geom type="box" size="0.03 0.03 0.01"/>
  <body name="finger" pos="0 0 0.1"><joint name="grip" type="slide" axis="0 1 0" range="0 0.01"/><inertial pos="0 0 0" mass="0.05"
  diaginertia="1e-4 1e-4 1e-4"/><geom type="box" pos="0.055 0 {middle}" size="0.005 0.01 0.02"/></body></body>"""

MARKER_M = 0.1064 + 0.030
"""Out from the flange, the lower side of the AR.Drone's marker: 30 mm above the pivot, where the tool ends."""


@pytest.fixture(params=["ok.urdf", "ok.xml"])
def gripping(request, tmp_path):
    """A scenario with an arm of which a finger ends `top` m out from the flange, 55 mm before the tool's axis."""

    def make(top, ee="tool0"):  # "" leaves it to armland
        text, middle = (ARMS / request.param).read_text("utf-8"), top - 0.1 - 0.02
        old, new = (
            ("</robot>", FINGER) if request.param == "ok.urdf" else ('<site name="tool0" pos="0 0 0.07"/>', FINGER_MJCF)
        )
        path = tmp_path / request.param
        path.write_text(text.replace(old, new.format(middle=middle)), encoding="utf-8")
        return load_scenario("landing", {"arm": {"file": str(path), **({"ee": ee} if ee else {})}}).believed()

    return make


@pytest.mark.parametrize("top", [0.115, 0.125, 0.13, 0.136])
def test_finger_beside_the_tool_is_refused_where_it_reaches_the_uav(gripping, top):
    scenario = gripping(top)
    around = Obstacles(scenario)
    near = around.held()
    assert near.room + UAV_M == pytest.approx(MARKER_M - top, abs=1e-6)
    if top < MARKER_M - UAV_M:
        check_beside(scenario, around)
        return
    with pytest.raises(ConfigurationError, match=r"'finger' on link 'l7' is .* the UAV in whatever pose"):
        check_beside(scenario, around)


def test_end_effector_that_nobody_chose_is_one_that_works(gripping):
    flight = prepare(gripping(0.136, ""), "landing", 1)
    assert flight.scenario.arm.ee == "finger"
    assert flight.moved.startswith("arm.ee = 'finger' chosen, because 'finger' on link 'l7' is within 0 mm of the UAV")
    with pytest.raises(MountingError):
        prepare(gripping(0.136), "landing", 1)


def test_refusal_names_an_end_effector_that_works(gripping):
    scenario = gripping(0.15)
    with pytest.raises(ConfigurationError, match=r"end effector 'tool0'.*; --ee 'finger' mounts the tool clear of it"):
        check_beside(scenario, Obstacles(scenario))
    check_beside(gripping(0.15, "finger"), Obstacles(gripping(0.15, "finger")))


def test_flange_without_a_frame_at_its_outer_end_carries_the_tool_there(tmp_path):
    """The file's last frame lies at the root of a flange that reaches out by 0.13 m, into what the UAV needs clear."""
    text = (ARMS / "ok.urdf").read_text("utf-8")
    flange = '<visual><origin xyz="0 0 0.065"/><geometry><cylinder radius="0.04" length="0.13"/></geometry></visual>'
    text = text.replace('<link name="tool0"/>', f'<link name="tool0">{flange}</link>')
    file = tmp_path / "ok.urdf"
    file.write_text(text, encoding="utf-8")
    flight = prepare(load_scenario("landing", {"arm": {"file": str(file)}}), "landing", 1)
    assert flight.scenario.arm.ee == "tool0:z+0.130"
    assert flight.moved.startswith("arm.ee = 'tool0:z+0.130' chosen, because")


def test_planner_and_judge_take_the_same_shapes_for_the_arm_and_the_uav(gripping):
    """Of a scene that the planner has measured nothing is left that the judge alone would see."""
    scenario = gripping(0.15)
    judged = mujoco.MjModel.from_xml_string(solids_of(build_scene(scenario, "free")))
    planned = Obstacles(scenario)
    model = planned._model
    measured = {g for pair in planned._pairs if pair.other == "the UAV" for g in (pair.one, pair.two)}

    def shapes(model, geoms, body):
        own = [g for g in geoms if model.body(int(model.geom_bodyid[g])).name == body]
        return {(int(model.geom_type[g]), *np.round(model.geom_size[g], 6)) for g in own}

    for theirs, ours in (
        ("uav/uav", "uav"),
        *((f"arm/l{i}", f"arm/l{i}") for i in range(1, 8)),
        ("armland_sensor",) * 2,
    ):
        wanted = shapes(judged, range(judged.ngeom), theirs)
        assert wanted, theirs
        assert wanted <= shapes(model, measured, ours), theirs


def test_links_are_measured_by_the_meshes_that_their_file_draws(tmp_path):
    """A block around the third link ends 30 mm above the floor where the arm stands upright; the capsule instead of it is far up."""
    file, ends = tmp_path / "ok.urdf", ARMS / "ok.urdf"
    part = '<link name="l3"><visual><geometry><mesh filename="block.obj"/></geometry></visual>'
    file.write_text(ends.read_text("utf-8").replace('<link name="l3">', part))
    scenario = load_scenario("landing", {"arm": {"file": str(file), "ee": "tool0"}}).believed()
    arm = arm_model(scenario)
    still = np.zeros(arm.joints)
    arm.update(still, still)
    height = arm.anchor[2, 2]
    bare = Obstacles(scenario).nearest(still, AWAY)
    corners = [f"v {x:g} {y:g} {z:g}\n" for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (0.03 - height, 0.1)]
    quads = ("1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4")
    (tmp_path / "block.obj").write_text("".join(corners) + "".join(f"f {q}\n" for q in quads))
    near = Obstacles(scenario).nearest(still, AWAY)
    assert (near.link, near.other) == ("link l3", "the floor")
    assert near.room == pytest.approx(0.03 - FLOOR_M, abs=1e-3)
    assert bare.other != "the floor"
