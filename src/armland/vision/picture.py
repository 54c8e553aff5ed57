"""Pictures of the scene: MuJoCo's off-screen renderer in a child process of its own."""

import shutil
import sys
import tempfile
from collections.abc import Sequence
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from armland.vision.opengl import SUPERSAMPLING, check, draw_in_child, flags

TIMEOUT_S = 120.0


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
    check(model, q, width, height, camera, show)
    with tempfile.TemporaryDirectory(prefix="armland-") as name:
        folder = Path(name)
        mujoco.mj_saveModel(model, str(folder / "scene.mjb"), None)
        np.savez(folder / "view.npz", qpos=q, size=[width, height], camera=camera, show=list(show))
        draw_in_child("armland.vision.picture", folder, TIMEOUT_S)
        path.parent.mkdir(parents=True, exist_ok=True)
        return Path(shutil.copyfile(folder / "picture.png", path))


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
        option.flags[flags()[str(name)]] = True
    with mujoco.Renderer(model, height, width) as renderer:
        renderer.update_scene(data, camera, option)
        pixels = renderer.render().astype(np.float64)
    k = SUPERSAMPLING
    mean = pixels.reshape(height // k, k, width // k, k, 3).mean(axis=(1, 3))
    imsave(folder / "picture.png", np.rint(mean).astype(np.uint8), format="png")


if __name__ == "__main__":
    draw(Path(sys.argv[1]))
