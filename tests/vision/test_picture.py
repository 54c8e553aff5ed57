from ctypes.util import find_library
from pathlib import Path

import mujoco
import numpy as np
import pytest
from matplotlib.image import imread

from armland.errors import ArmlandError, PictureError
from armland.plant.scene.composition import build_scene
from armland.scenario import load_scenario
from armland.vision import opengl
from armland.vision.picture import render

BALL = """
<mujoco>
  <worldbody>
    <light pos="0 0 3"/>
    <camera name="overview" pos="0 0 3"/>
    <body><joint name="slide" type="slide" axis="1 0 0"/><geom size="0.4" rgba="1 0 0 1"/></body>
  </worldbody>
</mujoco>
"""


@pytest.fixture(scope="module")
def ball() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(BALL)


def drawn(*args, **options) -> np.ndarray:
    """Pixels (height, width, 3) in 0..1; skips the test on a machine without OpenGL, where the error must say so."""
    try:
        return imread(render(*args, **options))[..., :3]
    except PictureError as e:
        reason = str(e)
    assert "install" in reason
    pytest.skip(reason)


def red(pixels: np.ndarray) -> np.ndarray:
    return (pixels[..., 0] > 0.3) & (pixels[..., 1:] < 0.1).all(axis=-1)


def test_picture_has_its_size_and_shows_the_pose(ball, tmp_path) -> None:
    pixels = drawn(ball, [0.8], tmp_path / "new" / "ball.png", 160, 120)
    assert pixels.shape == (120, 160, 3)
    rows, columns = np.nonzero(red(pixels))
    # 0.8 m to the right at 3 m distance, 45° field of view over 120 pixels: 38.6 pixels from the middle.
    assert columns.mean() == pytest.approx(79.5 + 0.8 / 3.0 * 60.0 / np.tan(np.deg2rad(22.5)), abs=3.0)
    assert rows.mean() == pytest.approx(59.5, abs=1.0)


def test_leftovers_of_another_backend_do_not_matter(ball, tmp_path, monkeypatch) -> None:
    drawn(ball, [0.0], tmp_path / "first.png", 80, 60)
    monkeypatch.setenv("PYOPENGL_PLATFORM", "no such platform")
    assert render(ball, [0.0], tmp_path / "second.png", 80, 60).is_file()


def test_next_backend_is_tried(ball, tmp_path, monkeypatch) -> None:
    drawn(ball, [0.0], tmp_path / "first.png", 80, 60)
    working = opengl.backends()
    monkeypatch.setattr(opengl, "backends", lambda: ["disable", *working])
    assert render(ball, [0.0], tmp_path / "second.png", 80, 60).is_file()


@pytest.mark.parametrize("backend", ["osmesa", "disable", "no such backend"])
def test_missing_opengl_is_one_readable_line(ball, tmp_path, monkeypatch, backend: str) -> None:
    if backend == "osmesa" and find_library("OSMesa"):
        pytest.skip("this machine has OSMesa")
    monkeypatch.setenv("MUJOCO_GL", backend)
    with pytest.raises(PictureError) as caught:
        render(ball, [0.0], tmp_path / "ball.png", 80, 60)
    message = str(caught.value)
    assert isinstance(caught.value, ArmlandError)
    assert f"({backend}: " in message
    assert "unset MUJOCO_GL" in message
    assert "apt-get install" in message
    assert "\n" not in message
    assert list(tmp_path.iterdir()) == []


def test_backend_is_chosen_where_none_is_asked_for(monkeypatch) -> None:
    monkeypatch.setattr(opengl.sys, "platform", "linux")
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.delenv("DISPLAY", raising=False)
    assert opengl.backends() == ["egl", "osmesa"]
    monkeypatch.setenv("DISPLAY", ":0")
    assert opengl.backends() == ["egl", "osmesa", "glfw"]
    monkeypatch.setenv("MUJOCO_GL", "osmesa")
    assert opengl.backends() == ["osmesa"]


@pytest.mark.parametrize(
    ("qpos", "options", "says"),
    [
        ([0.0, 0.0], {}, r"shape \(2,\); the model needs \(1,\)"),
        ([np.nan], {}, "all finite"),
        ([0.0], {"camera": "front"}, "no camera 'front'; its cameras are: overview"),
        ([0.0], {"width": 0}, "0 x 960 pixels"),
        ([0.0], {"height": 5000}, "1280 x 5000 pixels.*1 to 4096"),
    ],
)
def test_what_the_model_does_not_have_is_refused(ball, tmp_path: Path, qpos, options, says: str) -> None:
    with pytest.raises(PictureError, match=says):
        render(ball, qpos, tmp_path / "ball.png", **options)


def test_overview_shows_the_demonstrator(tmp_path) -> None:
    scene = build_scene(load_scenario("paper"), "hinged")
    qpos = np.zeros(scene.model.nq)
    qpos[scene.joint_qpos] = [0.39, -1.68, -2.51, 1.30, 2.07, 0.74, 0.0]
    pixels = drawn(scene.model, qpos, tmp_path / "scene.png", 320, 240)
    r, g, b = np.moveaxis(pixels, -1, 0)
    arm = (r > 0.4) & (r > 1.6 * g) & (g > 1.6 * b)
    uav = (b > 0.35) & (b > 1.4 * r)
    for part, least in ((arm, 0.03), (uav, 0.004)):
        assert part.mean() > least
        border = np.concatenate([part[0], part[-1], part[:, 0], part[:, -1]])
        assert not border.any()
    assert np.nonzero(uav)[0].mean() < np.nonzero(arm)[0].mean() - 40.0
