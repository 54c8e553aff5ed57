"""The films of the documentation are there, play, and are small enough for a repository."""

import numpy as np
import pytest
from PIL import Image

from armland.experiments.judge.judgement import PhaseTime
from pages import films
from pages.films import CUT, IMAGES, RUNS, SHOWN, STILL_PX, contact_sheet


@pytest.mark.parametrize("name", RUNS)
def test_film_plays_for_some_seconds_and_is_small(name) -> None:
    path = IMAGES / f"{name}.webp"
    assert path.stat().st_size < 1_500_000
    with Image.open(path) as image:
        assert image.size == (CUT.width, CUT.height)
        frames, seconds = image.n_frames, 0.0
        first = np.asarray(image.convert("RGB")).astype(int)
        for i in range(frames):
            image.seek(i)
            image.load()
            seconds += image.info["duration"] / 1e3
        last = np.asarray(image.convert("RGB")).astype(int)
    assert 4.0 < seconds < 10.0
    assert (np.abs(first - last).max(axis=2) > 40).mean() > 0.01


def test_sheet_has_the_phases_that_are_shown_in_their_order(monkeypatch) -> None:
    names = ("self_test", *SHOWN)
    shades = {name: 30 * i for i, name in enumerate(names)}

    def stills(take: object, width: int, height: int):
        for name in names:
            yield PhaseTime(name, 0.0, 1.0), np.full((height, width, 3), shades[name], np.uint8)

    monkeypatch.setattr(films, "stills", stills)
    sheet = np.asarray(contact_sheet(None, columns=3))  # type: ignore[arg-type]
    width, height = STILL_PX
    found = [int(sheet[(i // 3) * (height + 6) + 50, (i % 3) * (width + 6) + 50, 0]) for i in range(6)]
    assert found == [shades[name] for name in SHOWN]
