"""An arm's file, read: the one door of this part."""

from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

import mujoco

from armland.errors import ModelError
from armland.models.arm_file.chain import Chain, chain
from armland.models.arm_file.formats.mjcf import PART, read_mjcf
from armland.models.arm_file.formats.text import read_root
from armland.models.arm_file.formats.urdf import read_urdf
from armland.models.arm_file.shapes import clothed
from armland.models.arm_file.spec import arm_spec, ee_site
from armland.models.arm_file.strength import demand
from armland.models.arm_file.table import Asked, Row, table
from armland.models.arm_file.tree import Tree
from armland.rotations import Array

NOTHING_ASKED = Asked()


class ArmFile(NamedTuple):
    """What a file says of an arm, and what is taken for true of it."""

    chain: Chain
    rows: tuple[Row, ...]

    def spec(self) -> mujoco.MjSpec:
        """A new MuJoCo spec of the arm alone, its end effector at the site `frame`."""
        return arm_spec(self.chain, list(self.rows))

    @property
    def frame(self) -> str:
        """Site of the end effector in the spec."""
        return ee_site(self.chain)


def read_arm(path: str | Path, asked: Asked = NOTHING_ASKED) -> ArmFile:
    """Read an arm of anybody.

    Args:
        path: URDF or MJCF file.
        asked: end effector, locked joints and limits that the user sets.

    Raises:
        ModelError: a file that cannot be used; one sentence with the link or joint, the value, the bound and what would work.
        ConfigurationError: another number of limits than the arm has joints.
    """
    path = Path(path)
    if not path.is_file():
        raise ModelError(f"arm file {str(path)!r} does not exist; give an MJCF (.xml) or URDF (.urdf) file")
    return _read(path, path.stat().st_mtime_ns, asked)


@lru_cache(maxsize=16)
def _read(path: Path, changed: int, asked: Asked) -> ArmFile:
    # Plant, controller and commands ask for the same arm.
    made = clothed(chain(read_tree(path), asked.ee, dict(asked.lock)))

    def needed(rows: list[Row]) -> tuple[Array, Array]:
        # Any limit will do for what the weight asks.
        some = [r._replace(torque=r.torque._replace(number=1.0)) for r in rows]
        return demand(arm_spec(made, some).compile(), ee_site(made))

    try:
        return ArmFile(made, tuple(table(made, asked, needed)))
    except (ValueError, mujoco.FatalError) as e:
        raise ModelError(f"{made.what} is not a valid model: {' '.join(str(e).split())}") from e


def read_tree(path: Path, kind: str = "arm file") -> Tree:
    """All that a file says about a robot.

    Args:
        path: URDF or MJCF file.
        kind: what it is called in messages.

    Raises:
        ModelError: it is no URDF or MJCF, or what it says cannot be.
    """
    what = f"{kind} {str(path)!r}"
    root = read_root(path, what)
    if root.tag == "robot":
        return read_urdf(root, path, what)
    if root.tag == "mujoco":
        return read_mjcf(root, path, what)
    hint = {"sdf": "; that is SDF: export URDF or MJCF", "mujocoinclude": f"; {PART}"}.get(root.tag, "")
    raise ModelError(f"{what} has the root element <{root.tag}>; known are <robot> (URDF) and <mujoco>{hint}")
