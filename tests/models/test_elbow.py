"""The elbow is found from geometry: arms whose elbow is known, and a chain made by hand."""

from pathlib import Path

import mujoco
import pytest

from armland.models.description import EE_SITE
from armland.models.elbow import elbow
from armland.models.parameters import arm_model
from armland.scenario import load_scenario

EXAMPLES = Path(__file__).parents[2] / "examples"


@pytest.mark.parametrize(("file", "joint"), [("lwr4.xml", "A3"), ("six_axis.urdf", 2), ("seven_axis.urdf", 3)])
def test_elbow_of_arms_that_are_known(file, joint):
    path = file if file == "lwr4.xml" else str(EXAMPLES / file)
    arm = arm_model(load_scenario("landing", {"arm": {"file": path, "ee": None, "elbow_joint": None}}))
    found = elbow(arm.model)
    assert arm.joint_names[found] == joint if isinstance(joint, str) else found == joint


LINK = '<body pos="0 0 {length}"><joint name="j{i}" axis="{axis}" range="-2.5 2.5" limited="true"/><geom size="0.02"/>'


def chain(*links, rail=False):
    """Links of (length before the joint, m, axis), then 0.1 m to the hand."""
    body = "".join(LINK.format(i=i, length=length, axis=axis) for i, (length, axis) in enumerate(links))
    hand = f'<site name="{EE_SITE}" pos="0 0 0.1"/>'
    slide = '<body><joint name="rail" type="slide" axis="1 0 0" range="0 1" limited="true"/><geom size="0.02"/>'
    inside = f"{slide}{body}{hand}{'</body>' * len(links)}</body>" if rail else f"{body}{hand}{'</body>' * len(links)}"
    text = f'<mujoco><compiler angle="radian"/><worldbody>{inside}</worldbody></mujoco>'
    return mujoco.MjModel.from_xml_string(text)


X, Y, Z = "1 0 0", "0 1 0", "0 0 1"


@pytest.mark.parametrize(
    ("links", "rail", "index"),
    [
        (((0.1, Z), (0.2, Y), (0.4, Y), (0.4, Y), (0.05, Z), (0.05, Y)), False, 2),
        (((0.1, Z), (0.2, Y), (0.0, Z), (0.4, Y), (0.2, Z), (0.2, Y), (0.0, Z)), False, 3),
        (((0.1, Z), (0.2, Y), (0.0, Z), (0.4, Y), (0.2, Z), (0.2, Y), (0.0, Z)), True, 4),
        # A long forearm behind a short upper arm: still the joint between the two.
        (((0.1, Z), (0.2, Y), (0.25, Y), (0.6, Y), (0.0, Z), (0.05, Y)), False, 2),
    ],
)
def test_elbow_is_between_the_long_links(links, rail, index):
    assert elbow(chain(*links, rail=rail)) == index
