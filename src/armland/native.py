"""MuJoCo's functions for compiled code: called with addresses (`model._address`, `data._address`), Python's lock released.

They are the functions that MuJoCo's Python package calls, from the same library, so both give the same bytes. This module
loads the library, also into a process that only finds compiled code in the cache: what calls these functions imports them.

| argument | meaning |
|---|---|
| `model`, `data` | addresses of the `MjModel` and `MjData` |
| `result`, `x`, `y`, `jacp`, `jacr`, `point` | addresses of float64 arrays, C-contiguous |

Their warnings are counted in `data.warning`, which is where the plant looks; without a handler MuJoCo would also write them
into a file `MUJOCO_LOG.TXT` in the working directory.
"""

from pathlib import Path
from typing import Any

import llvmlite.binding
import mujoco
from numba import types

from armland.errors import ModelError

LIBRARY_NAMES = ("libmujoco.so*", "libmujoco*.dylib", "mujoco.dll")
"""What MuJoCo's library is called on Linux, macOS and Windows."""


def library(folder: Path) -> Path:
    """MuJoCo's library in the `folder` of its Python package.

    Raises:
        ModelError: there is none.
    """
    for pattern in LIBRARY_NAMES:
        for path in sorted(folder.glob(pattern)):
            return path
    raise ModelError(
        f"{folder} holds no library of MuJoCo ({', '.join(LIBRARY_NAMES)}); install the package mujoco anew"
    )


def _unheard(text: str) -> None:
    # See above: warnings are counted in the data.
    del text


llvmlite.binding.load_library_permanently(str(library(Path(mujoco.__file__).parent)))
mujoco.set_mju_user_warning(_unheard)

_A, _I = types.uintp, types.int32


def _function(name: str, *arguments: Any) -> Any:
    return types.ExternalFunction(name, types.void(_A, _A, *arguments))


mj_step = _function("mj_step")
"""(model, data): one step of the physics."""
mj_forward = _function("mj_forward")
"""(model, data): all that follows from state and controls."""
mj_kinematics = _function("mj_kinematics")
"""(model, data): poses of bodies, joints and sites from `qpos`."""
mj_comPos = _function("mj_comPos")
"""(model, data): centres of mass of subtrees, motion axes; after `mj_kinematics`."""
mj_makeM = _function("mj_makeM")
"""(model, data): joint-space inertia; after `mj_comPos`."""
mj_factorM = _function("mj_factorM")
"""(model, data): its factors; after `mj_makeM`."""
mj_solveM = _function("mj_solveM", _A, _A, _I)
"""(model, data, x, y, rows): x = M⁻¹ y for each of `rows` rows; after `mj_factorM`."""
mj_comVel = _function("mj_comVel")
"""(model, data): velocities of bodies from `qvel`; after `mj_comPos`."""
mj_rne = _function("mj_rne", _I, _A)
"""(model, data, with_acceleration, result): torques (nv,) of the inverse dynamics; after `mj_comVel`."""
mj_jacDot = _function("mj_jacDot", _A, _A, _A, _I)
"""(model, data, jacp, jacr, point, body): rates (3, nv) of a point's Jacobian; after `mj_comVel`."""
