"""Off-screen OpenGL in a child process of its own: which backends there are, and what to say where none works.

MuJoCo picks its OpenGL library from the variable MUJOCO_GL when it is imported, once per process, and a broken OpenGL
driver can end the process. A child can be given the right variable, and its death is only a missing picture.
"""

import os
import subprocess
import sys

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.errors import PictureError

MAX_PIXELS = 4096  # Largest width and height of a picture

REMEDY = "install EGL (Debian, Ubuntu: apt-get install libegl1 libopengl0) or OSMesa (apt-get install libosmesa6)"


def backends() -> list[str]:
    """Values of MUJOCO_GL to try, in this order."""
    asked = os.environ.get("MUJOCO_GL", "")
    if asked or sys.platform != "linux":
        return [asked]
    return ["egl", "osmesa", "glfw"] if os.environ.get("DISPLAY") else ["egl", "osmesa"]


def environment(backend: str) -> dict[str, str]:
    """Environment of a child that draws with this backend."""
    # MuJoCo leaves PYOPENGL_PLATFORM behind in the environment and refuses it with any other backend.
    return {k: v for k, v in os.environ.items() if k != "PYOPENGL_PLATFORM"} | {"MUJOCO_GL": backend}


def refusal(complaints: list[str]) -> PictureError:
    """The error that says what each backend said, and what would help."""
    remedy = f"unset MUJOCO_GL, or {REMEDY}" if os.environ.get("MUJOCO_GL") else REMEDY
    return PictureError(f"no OpenGL for off-screen pictures ({'; '.join(complaints)}); {remedy}")


PROBE = "import mujoco; mujoco.Renderer(mujoco.MjModel.from_xml_string('<mujoco/>'), 8, 8).render()"
"""What a backend that works can do."""

PROBE_S = 60.0


def working_backend() -> str:
    """The first backend that draws; empty where it is the system's own.

    Raises:
        PictureError: none does; the message says what each complained of, and what would help.
    """
    complaints = []
    for backend in backends():
        try:
            done = subprocess.run(
                [sys.executable, "-P", "-c", PROBE],
                env=environment(backend),
                capture_output=True,
                timeout=PROBE_S,
                check=False,
            )
        except subprocess.TimeoutExpired:
            complaints.append(f"{backend or 'default'}: no picture in {PROBE_S:g} s")
            continue
        if done.returncode == 0:
            return backend
        said = done.stderr.decode("utf-8", "replace")
        complaints.append(f"{backend or 'default'}: {last_line(said, done.returncode)}")
    raise refusal(complaints)


def last_line(said: str, code: int | None) -> str:
    """What a child complained of, in one line; a traceback names the exception in the last line that starts at the margin."""
    lines = [line for line in said.splitlines() if line and not line[0].isspace()]
    return lines[-1] if lines else f"renderer ended with code {code}"


def check(model: mujoco.MjModel, qpos: NDArray[np.float64], width: int, height: int, camera: str) -> None:
    """Refuse what the model cannot show.

    Raises:
        PictureError: a `qpos` (nq,), a size in px or a camera that it does not have.
    """
    if qpos.shape != (model.nq,) or not np.isfinite(qpos).all():
        raise PictureError(f"qpos has the shape {qpos.shape}; the model needs ({model.nq},), all finite")
    if not (0 < width <= MAX_PIXELS and 0 < height <= MAX_PIXELS):
        raise PictureError(f"a picture of {width} x {height} pixels is not possible; both must be 1 to {MAX_PIXELS}")
    cameras = [model.camera(i).name for i in range(model.ncam)]
    if camera not in cameras:
        raise PictureError(f"the model has no camera {camera!r}; its cameras are: {', '.join(cameras) or 'none'}")
