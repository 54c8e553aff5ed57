"""Pictures of one scene, as a camera on it would take them, drawn by one child process, each when it is asked for."""

import contextlib
import subprocess
import sys
import tempfile
import threading
from pathlib import Path

import mujoco
import numpy as np
from numpy.typing import ArrayLike, NDArray

from armland.errors import PictureError
from armland.vision import opengl

READY = b"ready"  # What the child says when it can draw
TIMEOUT_S = 120.0  # The longest that a picture may take

SUPERSAMPLING = 2
"""Rendered pixels per pixel and direction: a real pixel, too, collects light from all of its area, and edges become smooth."""


def frames(model: mujoco.MjModel, qpos: ArrayLike, width: int, height: int, camera: str) -> NDArray[np.uint8]:
    """Grey pictures (n, height, width) of `model` at each `qpos` (n, nq), m and rad, from its `camera`; without shadows.

    Raises:
        PictureError: no OpenGL that works (the message says what to install), or a camera, size or `qpos` that the model
            does not have.
    """
    poses = np.atleast_2d(np.asarray(qpos, dtype=float))
    for q in poses:
        opengl.check(model, q, width, height, camera)
    with FrameStream(model, width, height, camera) as stream:
        return np.array([stream.draw(q) for q in poses])


class FrameStream:
    """Pictures one after the other, each when it is asked for; a child process draws them. Use it in a `with` statement.

    Args:
        model: the scene.
        width: px.
        height: px.
        camera: name of the model's camera.
        coloured: whether pictures have colours and shadows.
        quick: whether OpenGL's own smoothing of edges is enough, which draws in half the time.

    Raises:
        PictureError: as for `frames`, on entry.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        width: int,
        height: int,
        camera: str,
        coloured: bool = False,
        quick: bool = False,
    ) -> None:
        self.model, self.width, self.height, self.camera = model, width, height, camera
        self._kind = f"{'coloured' if coloured else 'grey'}{'-quick' if quick else ''}"
        self._shape = (height, width, 3) if coloured else (height, width)
        self._child: subprocess.Popen[bytes] | None = None
        self._folder: tempfile.TemporaryDirectory[str] | None = None

    def __enter__(self) -> "FrameStream":
        opengl.check(self.model, self.model.qpos0, self.width, self.height, self.camera)
        self._folder = tempfile.TemporaryDirectory(prefix="armland-")
        folder = Path(self._folder.name)
        mujoco.mj_saveModel(self.model, str(folder / "scene.mjb"), None)
        # Without -P a folder named `mujoco` where the user stands would be imported in its place.
        command = [sys.executable, "-P", "-m", "armland.vision.frames", str(folder), self.camera]
        command += [str(self.width), str(self.height), self._kind]
        complaints = []
        for backend in opengl.backends():
            with open(folder / "errors.txt", "wb") as errors:
                self._child = subprocess.Popen(
                    command,
                    env=opengl.environment(backend),
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=errors,
                )
            try:
                self._read(len(READY))
            except PictureError:
                self._end()
                said = (folder / "errors.txt").read_text("utf-8", "replace")
                complaints.append(f"{backend or 'default'}: {opengl.last_line(said, self._child.returncode)}")
                continue
            return self
        self._folder.cleanup()
        raise opengl.refusal(complaints)

    def __exit__(self, *_: object) -> None:
        self._end()
        assert self._folder is not None
        self._folder.cleanup()

    def draw(self, qpos: ArrayLike, surface: ArrayLike = ()) -> NDArray[np.uint8]:
        """Picture (height, width), or (height, width, 3) in colour, at `qpos` (nq,), m and rad.

        Args:
            surface: heights (nhfielddata,) of the model's height fields, each between 0 and 1; none where it has none.

        Raises:
            PictureError: the child process has died, or gives no picture within `TIMEOUT_S`.
        """
        assert self._child is not None
        assert self._child.stdin is not None
        try:
            self._child.stdin.write(np.ascontiguousarray(qpos, dtype=float).tobytes())
            self._child.stdin.write(np.ascontiguousarray(surface, dtype=np.float32).tobytes())
            self._child.stdin.flush()
        except OSError as e:
            raise PictureError(f"the process that draws pictures has ended: {e.strerror}") from e
        return np.frombuffer(self._read(int(np.prod(self._shape))), np.uint8).reshape(self._shape)

    def _read(self, size: int) -> bytes:
        assert self._child is not None
        assert self._child.stdout is not None
        patience = threading.Timer(TIMEOUT_S, self._child.kill)
        patience.start()
        said = self._child.stdout.read(size)
        patience.cancel()
        if len(said) != size:
            raise PictureError("the process that draws pictures has ended in the middle of one")
        return said

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


def stream(folder: str, camera: str, width: int, height: int, kind: str) -> None:
    """The child's part: a picture of `scene.mjb` in `folder` on standard output for every qpos on standard input."""
    coloured, k = kind.startswith("coloured"), 1 if kind.endswith("quick") else SUPERSAMPLING
    model = mujoco.MjModel.from_binary_path(f"{folder}/scene.mjb")
    model.vis.global_.offwidth, model.vis.global_.offheight = k * width, k * height
    if not coloured:
        # OpenGL's own smoothing is of edges only; supersampling also smooths what is printed on a face.
        model.vis.quality.offsamples = 0
    data, option = mujoco.MjData(model), mujoco.MjvOption()
    # Sites are marks for sensors, not things that one would see.
    option.sitegroup[:] = 0
    with mujoco.Renderer(model, k * height, k * width) as renderer:
        # An empty picture shows that this OpenGL draws.
        renderer.render()
        sys.stdout.buffer.write(READY)
        sys.stdout.buffer.flush()
        while _told(model, data, renderer):
            mujoco.mj_forward(model, data)
            renderer.update_scene(data, camera, option)
            renderer.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] &= coloured
            # Where there is water around, the far of it is lost in the mist.
            renderer.scene.flags[mujoco.mjtRndFlag.mjRND_FOG] = coloured and model.nhfield > 0
            # A grey sensor sees best what is green.
            pixels = renderer.render()[..., slice(None) if coloured else 1]
            sys.stdout.buffer.write((_mean(pixels, k, coloured) if k > 1 else pixels).tobytes())
            sys.stdout.buffer.flush()


def _told(model: mujoco.MjModel, data: mujoco.MjData, renderer: mujoco.Renderer) -> bool:
    # Reads what to show next; false where there is no more.
    own = {"qpos": 8 * model.nq, "surface": 4 * model.nhfielddata}
    qpos, surface = (sys.stdin.buffer.read(size) for size in own.values())
    if len(qpos) != own["qpos"] or len(surface) != own["surface"]:
        return False
    data.qpos[:] = np.frombuffer(qpos)
    if surface:
        model.hfield_data[:] = np.frombuffer(surface, np.float32)
        for field in range(model.nhfield):
            mujoco.mjr_uploadHField(model, renderer._mjr_context, field)
    return True


def _mean(pixels: NDArray[np.uint8], k: int, coloured: bool) -> NDArray[np.uint8]:
    # Of each k x k pixels.
    wide = pixels.astype(np.uint16)
    total = sum((wide[i::k, j::k] for i in range(k) for j in range(k)), np.zeros_like(wide[::k, ::k]))
    mean = np.rint(total / k**2) if coloured else (total + k**2 // 2) // k**2
    return mean.astype(np.uint8)


if __name__ == "__main__":
    folder, camera, width, height, kind = sys.argv[1:]
    stream(folder, camera, int(width), int(height), kind)
