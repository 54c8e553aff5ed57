import os
import signal
from pathlib import Path

import mujoco
import numpy as np
import pytest

from armland.errors import PictureError
from armland.vision import frames as module
from armland.vision import opengl
from armland.vision.frames import FrameStream, frames

BALL = """
<mujoco>
  <visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <worldbody>
    <camera name="eye" pos="0 0 3" fovy="45"/>
    <body><joint name="slide" type="slide" axis="1 0 0"/><geom size="0.4" rgba="0 0.6 0 1"/></body>
  </worldbody>
</mujoco>
"""


@pytest.fixture(scope="module")
def ball() -> mujoco.MjModel:
    return mujoco.MjModel.from_xml_string(BALL)


def drawn(model: mujoco.MjModel, qpos) -> np.ndarray:
    try:
        return frames(model, qpos, 160, 120, "eye")
    except PictureError as e:
        pytest.skip(str(e))


def test_each_frame_shows_its_pose_in_grey(ball) -> None:
    pictures = drawn(ball, [[0.0], [0.8]])
    assert pictures.shape == (2, 120, 160)
    for image, x in zip(pictures, (0.0, 0.8), strict=True):
        rows, columns = np.nonzero(image > 100)
        assert rows.mean() == pytest.approx(59.5, abs=0.3)
        # 45° over 120 pixels; the ball's outline off the axis is a little farther out than its centre.
        assert columns.mean() == pytest.approx(79.5 + x / 3.0 * 60.0 / np.tan(np.deg2rad(22.5)), abs=0.3 + 1.5 * x)
    assert pictures[0].max() == pytest.approx(0.6 * 255, abs=1.0)


def test_frames_do_not_depend_on_those_before(ball) -> None:
    np.testing.assert_array_equal(drawn(ball, [[0.3], [0.8]])[1], drawn(ball, [0.8])[0])


def test_next_backend_is_tried(ball, monkeypatch) -> None:
    drawn(ball, [0.0])
    working = opengl.backends()
    monkeypatch.setattr(opengl, "backends", lambda: ["disable", *working])
    assert frames(ball, [0.0], 80, 60, "eye").any()


def test_missing_opengl_is_one_readable_line(ball, monkeypatch) -> None:
    monkeypatch.setenv("MUJOCO_GL", "disable")
    with pytest.raises(PictureError, match=r"\(disable: .*unset MUJOCO_GL.*apt-get install") as caught:
        frames(ball, [0.0], 80, 60, "eye")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("qpos", "camera", "says"),
    [
        ([[0.0, 0.0]], "eye", r"shape \(2,\); the model needs \(1,\)"),
        ([[0.0], [np.nan]], "eye", "all finite"),
        ([0.0], "front", "no camera 'front'; its cameras are: eye"),
    ],
)
def test_what_the_model_does_not_have_is_refused(ball, qpos, camera: str, says: str) -> None:
    with pytest.raises(PictureError, match=says):
        frames(ball, qpos, 80, 60, camera)


def test_stream_draws_each_picture_when_it_is_asked_for(ball) -> None:
    expected = drawn(ball, [[0.3], [0.8]])
    with FrameStream(ball, 160, 120, "eye") as stream:
        for x, picture in ((0.3, expected[0]), (0.8, expected[1]), (0.3, expected[0])):
            np.testing.assert_array_equal(stream.draw([x]), picture)


def test_stream_without_opengl_says_the_same(ball, monkeypatch) -> None:
    monkeypatch.setenv("MUJOCO_GL", "disable")
    stream = FrameStream(ball, 160, 120, "eye")
    with pytest.raises(PictureError, match=r"\(disable: .*unset MUJOCO_GL.*apt-get install"):
        stream.__enter__()
    assert stream._folder is not None
    assert not Path(stream._folder.name).exists()


def test_picture_that_never_comes_is_an_error(ball, monkeypatch) -> None:
    drawn(ball, [0.0])
    with FrameStream(ball, 160, 120, "eye") as stream:
        monkeypatch.setattr(module, "TIMEOUT_S", 0.2)
        os.kill(stream._child.pid, signal.SIGSTOP)
        with pytest.raises(PictureError, match="has ended"):
            stream.draw([0.0])


def test_coloured_pictures_keep_their_colours(ball) -> None:
    grey = drawn(ball, [0.0])[0]
    with FrameStream(ball, 160, 120, "eye", coloured=True) as stream:
        picture = stream.draw([0.0])
    assert picture.shape == (*grey.shape, 3)
    middle = picture[60, 80].astype(int)
    assert middle[1] == pytest.approx(int(grey[60, 80]), abs=2)
    assert max(middle[0], middle[2]) < 5


def test_quick_pictures_show_the_same(ball) -> None:
    drawn(ball, [0.0])
    pictures = []
    for quick in (False, True):
        with FrameStream(ball, 160, 120, "eye", coloured=True, quick=quick) as stream:
            pictures.append(stream.draw([0.4]).astype(int))
    apart = np.abs(pictures[0] - pictures[1]).max(axis=2)
    assert (apart > 30).mean() < 0.03
    assert pictures[1].shape == (120, 160, 3)


def test_height_field_follows_what_it_is_told(ball) -> None:
    drawn(ball, [0.0])
    field = """
    <mujoco>
      <visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
      <asset><hfield name="water" nrow="20" ncol="20" size="1 1 1 0.01"/></asset>
      <worldbody>
        <camera name="eye" pos="0 -4 0.5" xyaxes="1 0 0 0 0 1" fovy="45"/>
        <geom type="hfield" hfield="water" rgba="0 0.7 0 1"/>
      </worldbody>
    </mujoco>
    """
    model = mujoco.MjModel.from_xml_string(field)
    with FrameStream(model, 160, 120, "eye") as stream:
        low, high = (int((stream.draw([], np.full(400, share)) > 100).sum()) for share in (0.1, 0.9))
    assert high > 3 * low > 0
