import numpy as np
import pytest

from armland.experiments.judge.judgement import PhaseTime
from armland.view.film.captions import DONE, NOW, Captions

PHASES = [PhaseTime("approach", 0.0, 4.0), PhaseTime("set_down", 4.0, 10.0)]
SCENE = np.full((540, 960, 3), 128, np.uint8)


@pytest.fixture
def captions() -> Captions:
    return Captions("landing, seed 7", PHASES, 2.0, True, "landed")


def share(picture: np.ndarray, color: tuple[int, ...]) -> float:
    """Share of the lowest row in a colour."""
    return float((picture[-1] == color).all(axis=1).mean())


def test_bar_shows_how_far_it_is(captions) -> None:
    for t in (2.0, 4.0, 7.0, 10.0):
        row = captions.over(SCENE, t)
        assert share(row, DONE) + share(row, NOW) == pytest.approx(t / 10.0, abs=0.006)
    # The phase that is on has a colour of its own.
    assert share(captions.over(SCENE, 7.0), NOW) == pytest.approx(0.3, abs=0.006)


def test_scene_stays_where_nothing_is_written(captions) -> None:
    picture = captions.over(SCENE, 2.0)
    assert (picture[100:400, 400:] == 128).all()
    assert (picture[:60, :200] != 128).any()
    assert picture.shape == SCENE.shape


def test_verdict_is_shown_in_the_end_alone(captions) -> None:
    before, after = captions.over(SCENE, 10.0), captions.over(SCENE, 10.0, ended=True)
    failed = captions._replace(success=False).over(SCENE, 10.0, ended=True)
    assert (before[60:100] != after[60:100]).any()
    assert (failed != after).any()


def test_long_reasons_stay_in_the_picture(captions) -> None:
    picture = captions._replace(reason="limits violated: " * 30).over(SCENE, 10.0, ended=True)
    assert (picture[:, -10:] == 128)[:500].all()
