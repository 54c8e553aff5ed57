"""A picture of the scene for the eye, in colour and with shadows."""

from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import ArrayLike

from armland.vision.frames import FrameStream
from armland.vision.opengl import check


def render(
    model: mujoco.MjModel,
    qpos: ArrayLike,
    path: str | Path,
    width: int = 1280,
    height: int = 960,
    camera: str = "overview",
) -> Path:
    """Draw `model` at `qpos` (nq,), m and rad, into the PNG file `path`, `width` × `height` pixels, and return its path.

    `camera` is a camera of the model.
    The OpenGL backend is MUJOCO_GL where that is set, else the first that works: no display is needed.

    Raises:
        PictureError: no OpenGL that works (the message says what to install), or a camera, size or `qpos` that the
            model does not have.
    """
    from matplotlib.image import imsave

    path, q = Path(path), np.asarray(qpos, dtype=float)
    check(model, q, width, height, camera)
    with FrameStream(model, width, height, camera, coloured=True) as stream:
        pixels = stream.draw(q)
    path.parent.mkdir(parents=True, exist_ok=True)
    imsave(path, pixels, format="png")
    return path
