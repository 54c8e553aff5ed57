"""Many grey pictures of one scene, as a camera on it would take them, drawn in one child process.

`armland.view.picture` draws one picture for the eye, and says why in a child; here, starting it for each would take longest.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from armland.errors import PictureError
from armland.view.picture import _REMEDY, _backends, _check

SUPERSAMPLING = 2
"""Rendered pixels per pixel and direction: a real pixel, too, collects light from all of its area."""

TIMEOUT_S = 600.0


def frames(model: mujoco.MjModel, qpos: ArrayLike, width: int, height: int, camera: str) -> NDArray[np.uint8]:
    """Grey pictures (n, height, width) of `model` at each `qpos` (n, nq), m and rad, from its `camera`; without shadows.

    Raises:
        PictureError: no OpenGL that works (the message says what to install), or a camera, size or `qpos` that the model
            does not have.
    """
    poses = np.atleast_2d(np.asarray(qpos, dtype=float))
    for q in poses:
        _check(model, q, width, height, camera, ())
    with tempfile.TemporaryDirectory(prefix="armland-") as name:
        folder = Path(name)
        mujoco.mj_saveModel(model, str(folder / "scene.mjb"), None)
        np.savez(folder / "view.npz", qpos=poses, size=[width, height], camera=camera)
        complaints = []
        for backend in _backends():
            complaint = _attempt(folder, backend)
            if not complaint:
                pictures: NDArray[np.uint8] = np.load(folder / "frames.npy")
                return pictures
            complaints.append(f"{backend or 'default'}: {complaint}")
    remedy = f"unset MUJOCO_GL, or {_REMEDY}" if os.environ.get("MUJOCO_GL") else _REMEDY
    raise PictureError(f"no OpenGL for off-screen pictures ({'; '.join(complaints)}); {remedy}")


def _attempt(folder: Path, backend: str) -> str:
    """Draw with this backend; returns what went wrong in one line, empty if nothing did."""
    # For environment and command, see the same function of `armland.view.picture`.
    environment = {k: v for k, v in os.environ.items() if k != "PYOPENGL_PLATFORM"} | {"MUJOCO_GL": backend}
    command = [sys.executable, "-P", "-m", "armland.view.frames", str(folder)]
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
    lines = [line for line in done.stderr.splitlines() if line and not line[0].isspace()]
    return lines[-1] if lines else f"renderer ended with code {done.returncode}"


def draw(folder: Path) -> None:
    """The child's part: draw `scene.mjb` at each qpos of `view.npz` into `frames.npy`, all in `folder`."""
    model = mujoco.MjModel.from_binary_path(str(folder / "scene.mjb"))
    with np.load(folder / "view.npz") as view:
        qpos, (width, height), camera = view["qpos"], view["size"].tolist(), str(view["camera"])
    k = SUPERSAMPLING
    model.vis.global_.offwidth, model.vis.global_.offheight = k * width, k * height
    # OpenGL's own smoothing is of edges only; supersampling also smooths what is printed on a face.
    model.vis.quality.offsamples = 0
    data, option = mujoco.MjData(model), mujoco.MjvOption()
    option.sitegroup[:] = 0
    pictures = np.empty((len(qpos), height, width), np.uint8)
    with mujoco.Renderer(model, k * height, k * width) as renderer:
        for q, picture in zip(qpos, pictures, strict=True):
            data.qpos[:] = q
            mujoco.mj_forward(model, data)
            renderer.update_scene(data, camera, option)
            renderer.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
            # A grey sensor sees best what is green.
            green = renderer.render()[..., 1].astype(np.uint16)
            total = sum((green[i::k, j::k] for i in range(k) for j in range(k)), np.zeros_like(picture, np.uint16))
            picture[:] = (total + k * k // 2) // (k * k)
    np.save(folder / "frames.npy", pictures)


if __name__ == "__main__":
    draw(Path(sys.argv[1]))
