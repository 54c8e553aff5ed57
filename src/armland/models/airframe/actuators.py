"""What pushes at the sites of an MJCF file, and where a URDF places the mass of its links.

An actuator with a site as its transmission puts the force f = k u g_f and the torque k u g_t on the site, in the site's axes, with the
control u, the gain k and the six numbers g of `gear`. Source: MuJoCo's documentation, "XML reference", actuator/general.
"""

import xml.etree.ElementTree as ET
from pathlib import Path
from typing import NamedTuple

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.models.arm_file.formats.mjcf import NO_PART, parsed
from armland.models.arm_file.formats.text import included, numbers, read_root
from armland.rotations import Array


class Push(NamedTuple):
    """An actuator at a site, per unit of its force."""

    name: str
    site: str
    force: Array  # (3,), site axes
    torque: Array  # (3,) m, site axes
    range: tuple[float, float] | None  # of the unit


def pushes_of(path: Path) -> list[Push]:
    """Actuators at sites, in the file's order; none of a URDF.

    Raises:
        ModelError: the file is no XML, or MuJoCo cannot read it.
    """
    what = f"UAV file {str(path)!r}"
    root = read_root(path, what)
    if root.tag != "mujoco":
        return []
    root = included(root, path, what)
    for parent in list(root.iter()):
        for child in [c for c in parent if c.tag in NO_PART]:
            parent.remove(child)
    out = []
    for a in _spec(root, what).actuators:
        if a.trntype != mujoco.mjtTrn.mjTRN_SITE:
            continue
        gain, gear = float(a.gainprm[0]), np.array(a.gear, float)
        row = np.array(a.ctrlrange, float) * gain
        asked = tuple(np.sort(row)) if row.any() else None
        most = np.array(a.forcerange, float)
        if most.any():
            asked = tuple(np.sort(most)) if asked is None else (max(asked[0], most[0]), min(asked[1], most[1]))
        out.append(
            Push(a.name, a.target, gear[:3], gear[3:], None if asked is None else (float(asked[0]), float(asked[1])))
        )
    return out


def urdf_places(path: Path) -> dict[str, Array]:
    """Centre (3,), m, of the inertia of each link of a URDF that has one, link axes, whatever its mass; none of an MJCF.

    Raises:
        ModelError: the file is no XML, or an origin is no three numbers.
    """
    what = f"UAV file {str(path)!r}"
    root, out = read_root(path, what), {}
    for link in root.findall("link") if root.tag == "robot" else []:
        origin = link.find("inertial/origin")
        if origin is not None:
            at = numbers(origin.get("xyz"), 3, (0.0, 0.0, 0.0), f"{what}: link {link.get('name')!r}: origin")
            out[link.get("name") or ""] = np.array(at)
    return out


def urdf_properties(path: Path) -> dict[str, float]:
    """The attributes of `<properties>`, by which gym-pybullet-drones and its kin describe a multirotor: `thrust2weight`, `km`, `kf` ...

    Raises:
        ModelError: the file is no XML, or an attribute is no number.
    """
    what = f"UAV file {str(path)!r}"
    root = read_root(path, what)
    found = root.find("properties") if root.tag == "robot" else None
    given = {} if found is None else found.attrib
    return {name: numbers(text, 1, (0.0,), f"{what}: properties: {name}")[0] for name, text in given.items()}


def _spec(root: ET.Element, what: str) -> mujoco.MjSpec:
    try:
        return parsed(root)
    except (ValueError, mujoco.FatalError) as e:
        raise ModelError(f"{what} cannot be read: {' '.join(str(e).split())}") from e
