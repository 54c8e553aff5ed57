"""Pictures of the scene: MuJoCo's off-screen renderer in a child process of its own.

MuJoCo picks its OpenGL library from the variable MUJOCO_GL when it is imported, once per process, and a broken OpenGL
driver can end the process. A child can be given the right variable, and its death is only a missing picture.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from armland.errors import PictureError

MAX_PIXELS = 4096
"""Largest width and height of a picture."""

SUPERSAMPLING = 2
"""Rendered pixels per pixel and direction; their mean smooths the edges that software renderers leave jagged."""

TIMEOUT_S = 120.0

_REMEDY = "install EGL (Debian, Ubuntu: apt-get install libegl1 libopengl0) or OSMesa (apt-get install libosmesa6)"


def render(
    model: mujoco.MjModel,
    qpos: ArrayLike,
    path: str | Path,
    width: int = 1280,
    height: int = 960,
    camera: str = "overview",
    show: Sequence[str] = (),
) -> Path:
    """Draw `model` at `qpos` (nq,), m and rad, into the PNG file `path`, `width` × `height` pixels, and return its path.

    `camera` is a camera of the model; `show` names visualisation flags of MuJoCo to switch on, such as "joint" or "com".
    The OpenGL backend is MUJOCO_GL where that is set, else the first that works: no display is needed.

    Raises:
        PictureError: no OpenGL that works (the message says what to install), or a camera, flag, size or `qpos` that the
            model does not have.
    """
    path, q = Path(path), np.asarray(qpos, dtype=float)
    _check(model, q, width, height, camera, show)
    with tempfile.TemporaryDirectory(prefix="armland-") as name:
        folder = Path(name)
        mujoco.mj_saveModel(model, str(folder / "scene.mjb"), None)
        np.savez(folder / "view.npz", qpos=q, size=[width, height], camera=camera, show=list(show))
        complaints = []
        for backend in _backends():
            complaint = _attempt(folder, backend)
            if not complaint:
                path.parent.mkdir(parents=True, exist_ok=True)
                return Path(shutil.copyfile(folder / "picture.png", path))
            complaints.append(f"{backend or 'default'}: {complaint}")
    remedy = f"unset MUJOCO_GL, or {_REMEDY}" if os.environ.get("MUJOCO_GL") else _REMEDY
    raise PictureError(f"no OpenGL for an off-screen picture ({'; '.join(complaints)}); {remedy}")


def _check(model: mujoco.MjModel, qpos: np.ndarray, width: int, height: int, camera: str, show: Sequence[str]) -> None:
    if qpos.shape != (model.nq,) or not np.isfinite(qpos).all():
        raise PictureError(f"qpos has the shape {qpos.shape}; the model needs ({model.nq},), all finite")
    if not (0 < width <= MAX_PIXELS and 0 < height <= MAX_PIXELS):
        raise PictureError(f"a picture of {width} x {height} pixels is not possible; both must be 1 to {MAX_PIXELS}")
    cameras = [model.camera(i).name for i in range(model.ncam)]
    if camera not in cameras:
        raise PictureError(f"the model has no camera {camera!r}; its cameras are: {', '.join(cameras) or 'none'}")
    unknown = [name for name in show if name not in _flags()]
    if unknown:
        raise PictureError(f"show: unknown {', '.join(unknown)}; known are: {', '.join(_flags())}")


def _flags() -> dict[str, int]:
    flags = mujoco.mjtVisFlag.__members__.items()
    return {name.removeprefix("mjVIS_").lower(): int(flag) for name, flag in flags if name.startswith("mjVIS_")}


def _backends() -> list[str]:
    """Values of MUJOCO_GL to try, in this order."""
    asked = os.environ.get("MUJOCO_GL", "")
    if asked or sys.platform != "linux":
        return [asked]
    return ["egl", "osmesa", "glfw"] if os.environ.get("DISPLAY") else ["egl", "osmesa"]


def _attempt(folder: Path, backend: str) -> str:
    """Draw with this backend; returns what went wrong in one line, empty if nothing did."""
    # MuJoCo leaves PYOPENGL_PLATFORM behind in the environment and refuses it with any other backend.
    environment = {k: v for k, v in os.environ.items() if k != "PYOPENGL_PLATFORM"} | {"MUJOCO_GL": backend}
    # Without -P a folder named `mujoco` where the user stands would be imported in its place.
    command = [sys.executable, "-P", "-m", "armland.view.picture", str(folder)]
    try:
        done = subprocess.run(
            command,
            env=environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=TIMEOUT_S,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return f"no answer within {TIMEOUT_S:g} s"
    if done.returncode == 0:
        return ""
    # A traceback names the exception in the last line that starts at the margin.
    lines = [line for line in done.stderr.splitlines() if line and not line[0].isspace()]
    return lines[-1] if lines else f"renderer ended with code {done.returncode}"


def draw(folder: Path) -> None:
    """The child's part: draw `scene.mjb` as `view.npz` says into `picture.png`, all in `folder`."""
    from matplotlib.image import imsave

    model = mujoco.MjModel.from_binary_path(str(folder / "scene.mjb"))
    with np.load(folder / "view.npz") as view:
        qpos, size, camera, show = view["qpos"], view["size"], str(view["camera"]), view["show"]
    width, height = (SUPERSAMPLING * int(s) for s in size)
    model.vis.global_.offwidth, model.vis.global_.offheight = width, height
    data = mujoco.MjData(model)
    data.qpos[:] = qpos
    mujoco.mj_forward(model, data)
    option = mujoco.MjvOption()
    # Sites are marks for sensors, not things that one would see.
    option.sitegroup[:] = 0
    for name in show:
        option.flags[_flags()[str(name)]] = True
    with mujoco.Renderer(model, height, width) as renderer:
        renderer.update_scene(data, camera, option)
        pixels = renderer.render().astype(np.float64)
    k = SUPERSAMPLING
    mean = pixels.reshape(height // k, k, width // k, k, 3).mean(axis=(1, 3))
    imsave(folder / "picture.png", np.rint(mean).astype(np.uint8), format="png")


if __name__ == "__main__":
    draw(Path(sys.argv[1]))
