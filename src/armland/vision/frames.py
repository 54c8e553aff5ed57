"""Many grey pictures of one scene, as a camera on it would take them, drawn in one child process: all at once, or one by one.

`armland.vision.picture` draws one picture for the eye; here, starting a child for each would take longest.
"""

import contextlib
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from armland.errors import PictureError
from armland.vision.opengl import (
    SUPERSAMPLING,
    backends,
    check,
    command,
    draw_in_child,
    environment,
    last_line,
    refusal,
)

TIMEOUT_S = 600.0

MODULE = "armland.vision.frames"


def frames(model: mujoco.MjModel, qpos: ArrayLike, width: int, height: int, camera: str) -> NDArray[np.uint8]:
    """Grey pictures (n, height, width) of `model` at each `qpos` (n, nq), m and rad, from its `camera`; without shadows.

    Raises:
        PictureError: no OpenGL that works (the message says what to install), or a camera, size or `qpos` that the model
            does not have.
    """
    poses = np.atleast_2d(np.asarray(qpos, dtype=float))
    for q in poses:
        check(model, q, width, height, camera)
    with tempfile.TemporaryDirectory(prefix="armland-") as name:
        folder = Path(name)
        _store(folder, model, poses, width, height, camera)
        draw_in_child(MODULE, folder, TIMEOUT_S)
        pictures: NDArray[np.uint8] = np.load(folder / "frames.npy")
        return pictures


class FrameStream:
    """Grey pictures one after the other, each when it is asked for; a child process draws them. Use it in a `with` statement.

    Args:
        model: the scene.
        width: px.
        height: px.
        camera: name of the model's camera.

    Raises:
        PictureError: as for `frames`, on entry.
    """

    def __init__(self, model: mujoco.MjModel, width: int, height: int, camera: str) -> None:
        self.model, self.width, self.height, self.camera = model, width, height, camera
        self._child: subprocess.Popen[bytes] | None = None
        self._folder: tempfile.TemporaryDirectory[str] | None = None

    def __enter__(self) -> "FrameStream":
        check(self.model, self.model.qpos0, self.width, self.height, self.camera)
        self._folder = tempfile.TemporaryDirectory(prefix="armland-")
        folder = Path(self._folder.name)
        _store(folder, self.model, np.zeros((0, self.model.nq)), self.width, self.height, self.camera)
        complaints = []
        for backend in backends():
            with open(folder / "errors.txt", "wb") as errors:
                self._child = subprocess.Popen(
                    command(MODULE, str(folder), "stream"),
                    env=environment(backend),
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=errors,
                )
            try:
                self.draw(self.model.qpos0)
            except PictureError:
                self._end()
                said = (folder / "errors.txt").read_text("utf-8", "replace")
                complaints.append(f"{backend or 'default'}: {last_line(said, self._child.returncode)}")
                continue
            return self
        self._folder.cleanup()
        raise refusal(complaints)

    def __exit__(self, *_: object) -> None:
        self._end()
        assert self._folder is not None
        self._folder.cleanup()

    def draw(self, qpos: ArrayLike) -> NDArray[np.uint8]:
        """Grey picture (height, width) at `qpos` (nq,), m and rad.

        Raises:
            PictureError: the child process has died.
        """
        assert self._child is not None
        assert self._child.stdin is not None
        assert self._child.stdout is not None
        try:
            self._child.stdin.write(np.ascontiguousarray(qpos, dtype=float).tobytes())
            self._child.stdin.flush()
        except OSError as e:
            raise PictureError(f"the process that draws pictures has ended: {e.strerror}") from e
        pixels = self._child.stdout.read(self.width * self.height)
        if len(pixels) != self.width * self.height:
            raise PictureError("the process that draws pictures has ended in the middle of one")
        return np.frombuffer(pixels, np.uint8).reshape(self.height, self.width)

    def _end(self) -> None:
        child = self._child
        if child is None or child.stdin is None or child.stdout is None:
            return
        with contextlib.suppress(OSError):
            child.stdin.close()
        child.stdout.close()
        try:
            child.wait(timeout=10.0)
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()


def _store(folder: Path, model: mujoco.MjModel, qpos: NDArray[Any], width: int, height: int, camera: str) -> None:
    mujoco.mj_saveModel(model, str(folder / "scene.mjb"), None)
    np.savez(folder / "view.npz", qpos=qpos, size=[width, height], camera=camera)


@contextlib.contextmanager
def _painter(folder: Path) -> Iterator[tuple[int, Callable[[NDArray[Any]], NDArray[np.uint8]]]]:
    """The child's part: nq of `scene.mjb` in `folder`, and what draws a picture at a qpos, as `view.npz` there says."""
    model = mujoco.MjModel.from_binary_path(str(folder / "scene.mjb"))
    with np.load(folder / "view.npz") as view:
        (width, height), camera = view["size"].tolist(), str(view["camera"])
    k = SUPERSAMPLING
    model.vis.global_.offwidth, model.vis.global_.offheight = k * width, k * height
    # OpenGL's own smoothing is of edges only; supersampling also smooths what is printed on a face.
    model.vis.quality.offsamples = 0
    data, option = mujoco.MjData(model), mujoco.MjvOption()
    option.sitegroup[:] = 0
    with mujoco.Renderer(model, k * height, k * width) as renderer:

        def paint(qpos: NDArray[Any]) -> NDArray[np.uint8]:
            data.qpos[:] = qpos
            mujoco.mj_forward(model, data)
            renderer.update_scene(data, camera, option)
            renderer.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = 0
            # A grey sensor sees best what is green.
            green = renderer.render()[..., 1].astype(np.uint16)
            total = sum((green[i::k, j::k] for i in range(k) for j in range(k)), np.zeros((height, width), np.uint16))
            return np.asarray((total + k * k // 2) // (k * k), np.uint8)

        yield model.nq, paint


def draw(folder: Path) -> None:
    """The child's part: draw `scene.mjb` at each qpos of `view.npz` into `frames.npy`, all in `folder`."""
    with np.load(folder / "view.npz") as view:
        qpos, (width, height) = view["qpos"], view["size"].tolist()
    pictures = np.empty((len(qpos), height, width), np.uint8)
    with _painter(folder) as (_, paint):
        for q, picture in zip(qpos, pictures, strict=True):
            picture[:] = paint(q)
    np.save(folder / "frames.npy", pictures)


def stream(folder: Path) -> None:
    """The child's part: a picture on standard output for every qpos on standard input."""
    with _painter(folder) as (nq, paint):
        while len(raw := sys.stdin.buffer.read(8 * nq)) == 8 * nq:
            sys.stdout.buffer.write(paint(np.frombuffer(raw)).tobytes())
            sys.stdout.buffer.flush()


if __name__ == "__main__":
    (stream if sys.argv[2:] == ["stream"] else draw)(Path(sys.argv[1]))
