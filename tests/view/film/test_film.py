import av
import numpy as np
import pytest

from armland.errors import ConfigurationError, LogError, PictureError
from armland.runtime.log import Log
from armland.scenario import load_scenario
from armland.view.film import film as module
from armland.view.film.film import HOLD_S, Cut, film, stills, take_of, title_of, write_stills


@pytest.fixture(scope="module")
def take(landing_log):
    return take_of(landing_log)


class Pictures:
    """In place of a renderer: a picture that shows how high the UAV is."""

    def __init__(self, model, width, height, *_, **__) -> None:
        self.shape, self.uav = (height, width, 3), model.joint("uav/free").qposadr[0]

    def __enter__(self):
        return self

    def __exit__(self, *_) -> None:
        pass

    def draw(self, qpos, surface) -> np.ndarray:
        assert len(surface) == 0
        return np.full(self.shape, int(200 * min(qpos[self.uav + 2], 1.2)), np.uint8)


def test_film_shows_the_run_at_its_speed(take, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(module, "FrameStream", Pictures)
    cut, told = Cut(160, 120, fps=8, speed=4.0), []
    path = film(take, tmp_path / "film.mp4", cut, lambda *n: told.append(n))
    with av.open(str(path)) as file:
        shown = [f.to_ndarray(format="rgb24") for f in file.decode(video=0)]
    moving = int(np.ceil(take.seconds / (4.0 / 8)))
    assert len(shown) == moving + round(HOLD_S * 8)
    assert told[-1] == (moving, moving)
    z = take.log.messages["truth"]["r_cm"][:, 2]
    for i in (0, moving // 2, moving - 1):
        assert shown[i][60:90, 120:].mean() == pytest.approx(200 * min(z[int(i * 500)], 1.2), abs=4.0)


def test_speed_that_nobody_chose_makes_a_short_film(take, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(module, "FrameStream", Pictures)
    with av.open(str(film(take, tmp_path / "film.mp4", Cut(480, 360, fps=4, plots=True)))) as file:
        frames = list(file.decode(video=0))
    assert len(frames) / 4 <= Cut().longest_s + HOLD_S + 0.5
    assert frames[0].width == 480 + 212


def test_film_is_drawn(take, tmp_path) -> None:
    """The one with a real renderer: the arm is orange, and it moves."""
    try:
        path = film(take, tmp_path / "film.webm", Cut(320, 180, fps=2, speed=8.0))
    except PictureError as e:
        pytest.skip(str(e))
    with av.open(str(path)) as file:
        shown = [f.to_ndarray(format="rgb24").astype(int)[28:150] for f in file.decode(video=0)]
    orange = [(f[..., 0] > f[..., 2] + 90) & (f[..., 0] > 150) for f in shown]
    assert all(300 < mask.sum() < 8000 for mask in orange)
    assert (orange[0] != orange[2]).sum() > 50


@pytest.mark.slow
def test_still_of_each_phase(take, tmp_path) -> None:
    try:
        paths = write_stills(take, tmp_path, Cut(160, 120))
    except PictureError as e:
        pytest.skip(str(e))
    assert [p.name.split("_", 2)[2].removesuffix(".png") for p in paths] == [p.name for p in take.phases]
    pictures = [picture for _, picture in stills(take, 160, 120)]
    assert pictures[0].shape == (120, 160, 3)
    # The UAV stands on the cradle in the end, and hovers in the beginning.
    assert np.abs(pictures[0].astype(int) - pictures[-1]).max() > 60


def test_no_opengl_is_said_and_leaves_nothing(take, tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("MUJOCO_GL", "disable")
    with pytest.raises(PictureError, match="no OpenGL"):
        film(take, tmp_path / "film.mp4", Cut(160, 120))
    assert list(tmp_path.iterdir()) == []


def test_what_no_film_can_be_made_of_is_refused(take, landing_log, tmp_path) -> None:
    with pytest.raises(ConfigurationError, match="must be even"):
        film(take, tmp_path / "film.mp4", Cut(161, 120))
    with pytest.raises(LogError, match="1 ticks"):
        take_of(Log(landing_log.ticks[:1], landing_log.metadata, {}, True))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, "landing, seed 1"),
        ({"air": {"wind_mps": 4.0}}, "landing, seed 1, wind 4 m/s"),
        ({"sea": {"state": "ss2", "hull_m": 6.0}}, "landing, seed 1, sea 2, hull 6 m"),
        ({"sea": {"state": "tank"}}, "landing, seed 1, sea: tank"),
    ],
)
def test_title_says_what_is_flown(landing_log, changes, words) -> None:
    text = load_scenario("landing", changes).model_dump_json()
    assert title_of(Log(landing_log.ticks, {**landing_log.metadata, "scenario": text}, {}, True)) == words
