"""Arms as data: serial chains written as URDF, no two axes alike, with full inertia tensors that a body can have."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pinocchio as pin
import pytest

from armland.models.arm import ArmModel
from armland.models.description import ASSETS
from armland.scenario.arm import Tool

TOOL = Tool(sensor_mass_kg=0.25, sensor_length_m=0.0504, tool_mass_kg=0.30, tool_com_m=0.025, length_m=0.1064)


def text(values):
    return " ".join(repr(float(v)) for v in values)


def inertial(rng):
    """Mass, centre and full tensor of a random cloud of point masses, in a rotated inertial frame."""
    points, masses = rng.normal(scale=0.06, size=(8, 3)), rng.uniform(0.02, 0.1, size=8)
    offsets = points - masses @ points / masses.sum()
    tensor = np.einsum("k,kij->ij", masses, [x @ x * np.eye(3) - np.outer(x, x) for x in offsets])
    entries = dict(zip(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"), tensor[np.triu_indices(3)], strict=True))
    attributes = " ".join(f'{name}="{float(value)!r}"' for name, value in entries.items())
    return (
        f'<inertial><origin xyz="{text(rng.normal(scale=0.08, size=3))}" rpy="{text(rng.uniform(-3.0, 3.0, size=3))}"/>'
        f'<mass value="{float(masses.sum())!r}"/><inertia {attributes}/></inertial>'
    )


def chain(kinds, seed, massless=()):
    """URDF of a chain of joints of these `kinds`; links named in `massless` are bare frames. Its last link is `tip`."""
    rng = np.random.default_rng(seed)
    body = [f'<link name="base">{inertial(rng)}</link>']
    parent = "base"
    for i, kind in enumerate(kinds):
        link = "tip" if i == len(kinds) - 1 else f"link_{i}"
        origin = (
            f'<origin xyz="{text(rng.uniform(-0.25, 0.25, size=3))}" rpy="{text(rng.uniform(-3.0, 3.0, size=3))}"/>'
        )
        axis = rng.normal(size=3)
        joint = f'<parent link="{parent}"/><child link="{link}"/>{origin}'
        if kind != "fixed":
            joint += f'<axis xyz="{text(axis / np.linalg.norm(axis))}"/>'
        if kind in ("revolute", "prismatic"):
            joint += (
                f'<limit lower="{-2.0 - 0.1 * i!r}" upper="{1.5 + 0.1 * i!r}" effort="{50.0 + i!r}" velocity="2.0"/>'
            )
        body.append(f'<joint name="joint_{i}" type="{kind}">{joint}</joint>')
        body.append(f'<link name="{link}">{"" if link in massless else inertial(rng)}</link>')
        parent = link
    return f'<robot name="chain">{"".join(body)}</robot>'


R, F, P, C = "revolute", "fixed", "prismatic", "continuous"
CHAINS = {
    "seven joints": chain([R] * 7, seed=1),
    "six joints": chain([R] * 6, seed=2),
    "fixed frames between": chain(
        [F, R, R, F, R, F, R, R, F, F, R, F, F], seed=3, massless=("link_8", "link_11", "tip")
    ),
    "slide and endless joint": chain([P, R, C, R, R, P, R, F], seed=4),
}
ARMS = ("lwr4", *CHAINS)


def write_arm(name: str, folder: Path) -> tuple[Path, str]:
    """File and end effector frame of the arm `name`."""
    if name == "lwr4":
        return ASSETS / "lwr4.xml", "flange"
    path = folder / f"{name.replace(' ', '_')}.urdf"
    path.write_text(CHAINS[name], encoding="utf-8")
    return path, "tip"


class Twin:
    """The same file in Pinocchio."""

    def __init__(self, path: Path, frame: str, tool: Tool | None) -> None:
        build = pin.buildModelFromUrdf if path.suffix == ".urdf" else pin.buildModelFromMJCF
        self.model = build(str(path))
        at = self.model.frames[self.model.getFrameId(frame)]
        placement = at.placement
        if tool is not None:
            solid = np.eye(3) * 0.03**2
            for mass, com in (
                (tool.sensor_mass_kg, 0.5 * tool.sensor_length_m),
                (tool.tool_mass_kg, tool.sensor_length_m + tool.tool_com_m),
            ):
                body = pin.Inertia(mass, np.array([0.0, 0.0, com]), mass * solid)
                self.model.appendBodyToJoint(at.parentJoint, body, at.placement)
            placement = at.placement * pin.SE3(np.eye(3), np.array([0.0, 0.0, tool.length_m]))
        self.frame = self.model.addFrame(pin.Frame("point", at.parentJoint, 0, placement, pin.FrameType.OP_FRAME))
        self.data = self.model.createData()

    def configuration(self, q):
        # An endless joint is a point of the circle there.
        return pin.integrate(self.model, pin.neutral(self.model), q)

    def mass_matrix(self, q):
        upper = np.triu(pin.crba(self.model, self.data, self.configuration(q)))
        return upper + np.triu(upper, 1).T

    def bias(self, q, qd):
        return pin.nonLinearEffects(self.model, self.data, self.configuration(q), qd).copy()

    def gravity(self, q):
        return pin.computeGeneralizedGravity(self.model, self.data, self.configuration(q)).copy()

    def jacobian(self, q):
        return pin.computeFrameJacobian(
            self.model, self.data, self.configuration(q), self.frame, pin.LOCAL_WORLD_ALIGNED
        ).copy()

    def pose(self, q):
        pin.framesForwardKinematics(self.model, self.data, self.configuration(q))
        at = self.data.oMf[self.frame]
        return at.translation.copy(), at.rotation.copy()

    def acceleration_bias(self, q, qd):
        """𝒥̇ φ̇: acceleration (6,) of the controlled point, world axes, while no joint accelerates."""
        pin.forwardKinematics(self.model, self.data, self.configuration(q), qd, np.zeros(self.model.nv))
        return pin.getFrameClassicalAcceleration(
            self.model, self.data, self.frame, pin.LOCAL_WORLD_ALIGNED
        ).vector.copy()

    def acceleration(self, q, qd, tau):
        """Joint acceleration under `tau` and the acceleration (6,) of the controlled point, world axes."""
        x = self.configuration(q)
        qdd = pin.aba(self.model, self.data, x, qd, tau).copy()
        pin.forwardKinematics(self.model, self.data, x, qd, qdd)
        return qdd, pin.getFrameClassicalAcceleration(
            self.model, self.data, self.frame, pin.LOCAL_WORLD_ALIGNED
        ).vector.copy()


@pytest.fixture(scope="session")
def bench(tmp_path_factory):
    """Arm model and twin of an arm by name, with or without tool; states to try them at."""
    folder, known = tmp_path_factory.mktemp("arms"), {}

    def build(name, tool=False):
        if (name, tool) not in known:
            path, frame = write_arm(name, folder)
            mounted = TOOL if tool else None
            known[name, tool] = SimpleNamespace(
                path=path, arm=ArmModel.load(path, frame, mounted), twin=Twin(path, frame, mounted)
            )
        return known[name, tool]

    return build


@pytest.fixture
def states():
    def draw(arm, count, seed=0):
        rng = np.random.default_rng(seed)
        low, high = np.maximum(arm.q_min, -np.pi), np.minimum(arm.q_max, np.pi)
        for _ in range(count):
            yield rng.uniform(low, high), rng.normal(scale=1.5, size=arm.joints)

    return draw


@pytest.fixture(params=ARMS)
def arm_name(request):
    return request.param
