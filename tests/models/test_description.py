"""Reading arms: what a file may look like, where the tool goes, and what a refusal says."""

import mujoco
import numpy as np
import pytest

from armland.errors import ConfigurationError, ModelError
from armland.models.arm import ArmModel
from armland.models.description import ASSETS, frame_names, read_spec, without_shapes
from armland.scenario.arm import Tool

LWR = (ASSETS / "lwr4.xml").read_text("utf-8")
FLANGE = '<site name="flange" pos="0 0 0"/>'
TOOL = Tool(sensor_mass_kg=0.25, sensor_length_m=0.05, tool_mass_kg=0.3, tool_com_m=0.02, length_m=0.12)


@pytest.fixture
def urdf(bench):
    return bench("six joints").path.read_text("utf-8")


@pytest.fixture
def load(tmp_path):
    def from_text(text, frame, tool=None, suffix=".urdf"):
        path = tmp_path / f"arm{suffix}"
        path.write_text(text, encoding="utf-8")
        return ArmModel.load(path, frame, tool)

    return from_text


def at(arm, q):
    arm.update(q, np.zeros(arm.joints))
    return arm.position.copy(), arm.rotation.copy()


def test_shipped_arm_offers_its_flange():
    assert "flange" in frame_names(read_spec(ASSETS / "lwr4.xml"))


def test_frame_may_be_a_site_or_a_body(load):
    q = np.linspace(-1.0, 1.0, 7)
    site, body = load(LWR, "flange", suffix=".xml"), load(LWR, "link_7", suffix=".xml")
    for ours, theirs in zip(at(site, q), at(body, q), strict=True):
        np.testing.assert_allclose(ours, theirs, atol=1e-14)


@pytest.mark.parametrize("orientation", ['quat="1 0 1 0"', 'euler="0 90 0"', 'axisangle="0 1 0 90"', 'zaxis="1 0 0"'])
@pytest.mark.parametrize("tool", [None, TOOL], ids=["bare", "tool"])
def test_site_keeps_its_orientation_however_it_is_written(load, orientation, tool):
    """A flange turned by 90° about y: its z axis, and with it the tool, points along x of the last link."""
    turned = FLANGE.replace("/>", f" {orientation}/>")
    q = np.linspace(-1.0, 1.0, 7)
    p, R = at(load(LWR, "flange", suffix=".xml"), q)
    position, rotation = at(load(LWR.replace(FLANGE, turned), "flange", tool, suffix=".xml"), q)
    np.testing.assert_allclose(rotation[:, 2], R[:, 0], atol=1e-12)
    np.testing.assert_allclose(position, p + (0.0 if tool is None else tool.length_m) * R[:, 0], atol=1e-12)


def test_tool_moves_the_controlled_point_out_along_the_frame(bench):
    path = bench("six joints").path
    q = np.linspace(-0.5, 0.5, 6)
    p, R = at(ArmModel.load(path, "tip"), q)
    position, rotation = at(ArmModel.load(path, "tip", TOOL), q)
    np.testing.assert_allclose(position, p + TOOL.length_m * R[:, 2], atol=1e-12)
    np.testing.assert_allclose(rotation, R, atol=1e-12)


def test_tool_weighs_on_the_joints(bench):
    """Gravity torque of the tool by hand: 𝒥ᵀ of its centres of mass times its weights."""
    path = bench("six joints").path
    bare, tooled = ArmModel.load(path, "tip"), ArmModel.load(path, "tip", TOOL)
    q = np.linspace(-0.5, 0.5, 6)
    _, R = at(bare, q)
    at(tooled, q)
    added = np.zeros(6)
    for mass, along in (
        (TOOL.sensor_mass_kg, 0.5 * TOOL.sensor_length_m),
        (TOOL.tool_mass_kg, TOOL.sensor_length_m + TOOL.tool_com_m),
    ):
        lever = along * R[:, 2]
        linear = bare.jacobian[:3] - np.cross(lever, bare.jacobian[3:], axis=0)
        added += linear.T @ np.array([0.0, 0.0, 9.81 * mass])
    np.testing.assert_allclose(tooled.gravity - bare.gravity, added, atol=1e-12)


def test_meshes_and_foreign_elements_do_not_matter(load, urdf):
    mesh = '<geometry><mesh filename="package://nowhere/link.stl"/></geometry>'
    decorated = urdf.replace(
        '<link name="tip">', f'<link name="tip"><visual>{mesh}</visual><collision>{mesh}</collision>'
    )
    decorated = decorated.replace(
        '<parent link="link_4"/>',
        '<safety_controller k_velocity="1"/><calibration rising="0"/><parent link="link_4"/>',
    )
    decorated = decorated.replace("</robot>", '<transmission name="t"/><gazebo reference="tip"/></robot>')
    assert decorated.count("mesh") == 2
    q = np.linspace(-0.5, 0.5, 6)
    plain, arm = load(urdf, "tip"), load(decorated, "tip")
    np.testing.assert_array_equal(at(plain, q)[0], at(arm, q)[0])
    np.testing.assert_array_equal(plain.mass_matrix, arm.mass_matrix)


def test_missing_frame_is_refused_with_those_there_are(bench):
    with pytest.raises(ModelError, match="'flange'") as refusal:
        ArmModel.load(bench("fixed frames between").path, "flange")
    for name in ("base", "link_8", "tip"):
        assert name in str(refusal.value)
    assert isinstance(refusal.value, ConfigurationError)


def replaced(old, new):
    return lambda text: text.replace(old, new)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda text: text[:-20], "not well-formed XML"),
        (lambda text: "", "not well-formed XML"),
        (lambda text: "<sdf/>", "<sdf>; known are <robot> (URDF) and <mujoco>"),
        (replaced('ixx="', 'ixx="9'), "link 'link_0': no rigid body has the principal inertias"),
        (replaced('mass value="', 'mass value="-'), "link 'link_0' has a mass of -"),
        (
            replaced('type="revolute"', 'type="fixed"'),
            "has 0 joints on the way to 'tip'; the end effector needs at least 6",
        ),
        (replaced('"joint_2"', '"joint_1"'), "two of its joints are called 'joint_1'; rename one"),
    ],
    ids=["cut", "empty", "root", "inertia", "mass", "no joints", "same name"],
)
def test_unusable_file_is_refused_in_one_line(load, urdf, change, says):
    with pytest.raises(ModelError) as refusal:
        load(change(urdf), "tip")
    message = str(refusal.value)
    assert says in message
    assert "\n" not in message
    assert "arm.urdf" in message


def test_missing_file_is_refused_by_name(tmp_path):
    with pytest.raises(ModelError, match=r"nowhere\.urdf' does not exist"):
        ArmModel.load(tmp_path / "nowhere.urdf", "tip")


def test_branch_beside_the_chain_stands_still_and_weighs(load, urdf):
    """A finger of 0.1 kg in the origin of link 3: one more mass there, as Pinocchio's or anybody's sum says."""
    inertia = '<mass value="0.1"/><inertia ixx="1e-3" ixy="0" ixz="0" iyy="1e-3" iyz="0" izz="1e-3"/>'
    finger = f'<link name="finger"><inertial>{inertia}</inertial></link>'
    limit = '<limit lower="0" upper="1" effort="1" velocity="1"/>'
    joint = f'<joint name="grip" type="revolute"><parent link="link_3"/><child link="finger"/>{limit}</joint>'
    arm, plain = load(urdf.replace("</robot>", f"{finger}{joint}</robot>"), "tip"), load(urdf, "tip")
    q = np.linspace(-0.5, 0.5, 6)
    assert at(arm, q)[0].tolist() == at(plain, q)[0].tolist()
    assert arm.joint_names == plain.joint_names
    data = plain.data
    lift = plain.gravity.copy()
    body, J = plain.model.body("arm/link_3").id, np.zeros((3, 6))
    mujoco.mj_jacBody(plain.model, data, J, None, body)
    np.testing.assert_allclose(arm.gravity, lift + 0.1 * 9.81 * J[2], atol=1e-12)


def test_joint_that_cannot_be_driven_is_refused(load):
    ball = LWR.replace(
        '<joint name="A6" axis="0 0 1" range="-170 170" actuatorfrcrange="-38 38"', '<joint name="A6" type="ball"'
    )
    assert ball != LWR
    with pytest.raises(ModelError, match="neither a hinge nor a slide"):
        load(ball, "flange", suffix=".xml")


SHAPED = """<mujoco>
  <asset><mesh name="m" vertex="0 0 0  1 0 0  0 1 0  0 0 1"/></asset>
  <worldbody><body name="a"><inertial pos="0 0 .1" mass="2" diaginertia=".1 .2 .25"/><joint name="j" axis="0 1 0"/>
    <geom type="mesh" mesh="m"/>
    <body name="b" pos="0 0 1"><joint name="k" axis="1 0 0"/>{shape}</body></body></worldbody></mujoco>"""
STATED = '<inertial pos="0 0 .2" mass="1" diaginertia=".1 .1 .1"/><geom size=".1"/>'


@pytest.mark.parametrize(("shape", "left"), [(STATED, 0), ('<geom size=".1" density="500"/>', 1)])
def test_model_without_shapes_keeps_every_inertia(shape, left):
    """A shape that gives its body the inertia stays; all others go, meshes with the last one."""
    spec = mujoco.MjSpec.from_string(SHAPED.format(shape=shape))
    whole, bare = spec.compile(), without_shapes(spec).compile()
    assert (whole.ngeom, bare.ngeom, bare.nmesh) == (2, left, left)
    for name in ("body_mass", "body_inertia", "body_ipos", "body_iquat"):
        np.testing.assert_array_equal(getattr(bare, name), getattr(whole, name))
    assert spec.compile().ngeom == 2
