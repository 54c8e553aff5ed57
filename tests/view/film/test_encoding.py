from pathlib import Path

import av
import numpy as np
import pytest
from PIL import Image

from armland.errors import ConfigurationError
from armland.view.film.encoding import ANIMATED, CODECS, check_name, encode


def pictures(n: int = 12):
    for i in range(n):
        picture = np.full((64, 96, 3), 40, np.uint8)
        picture[:, 8 * i : 8 * i + 8] = (200, 60, 60)
        yield picture


@pytest.mark.parametrize("suffix", CODECS)
def test_film_plays_back_with_all_its_pictures(tmp_path, suffix) -> None:
    path = encode(tmp_path / f"film{suffix}", pictures(), 12)
    with av.open(str(path)) as file:
        stream = file.streams.video[0]
        assert (stream.width, stream.height, stream.pix_fmt) == (96, 64, "yuv420p")
        assert stream.average_rate == 12
        shown = [frame.to_ndarray(format="rgb24").astype(float) for frame in file.decode(video=0)]
    assert len(shown) == 12
    bright = [int(np.argmax(frame[..., 0].mean(axis=0))) // 8 for frame in shown]
    assert bright == list(range(12))
    assert sorted(p.name for p in tmp_path.iterdir()) == [path.name]


def test_mp4_begins_with_its_index(tmp_path) -> None:
    data = encode(tmp_path / "film.mp4", pictures(), 12).read_bytes()
    assert data.index(b"moov") < data.index(b"mdat")


@pytest.mark.parametrize("suffix", ANIMATED)
def test_animation_has_all_its_pictures(tmp_path, suffix) -> None:
    path = encode(tmp_path / f"film{suffix}", pictures(), 10)
    with Image.open(path) as image:
        assert (image.n_frames, image.size) == (12, (96, 64))
        times = []
        for i in range(12):
            image.seek(i)
            image.load()
            times.append(image.info["duration"])
    # An animation may leave out what does not change, never the time.
    assert sum(times) == 1200


@pytest.mark.parametrize("suffix", [*CODECS, *ANIMATED])
def test_film_that_breaks_leaves_the_former_one(tmp_path, suffix) -> None:
    path = tmp_path / f"film{suffix}"
    path.write_text("old")

    def broken():
        yield from pictures(3)
        raise RuntimeError("no more")

    with pytest.raises(RuntimeError, match="no more"):
        encode(path, broken(), 12)
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    assert path.read_text() == "old"


def test_names_that_are_no_films_are_refused(tmp_path) -> None:
    (tmp_path / "folder.mp4").mkdir()
    (tmp_path / "link.mp4").symlink_to(tmp_path / "elsewhere")
    for name, says in {
        "film.avi": r"\*\.mp4, \*\.webm",
        "film": "a film is a file",
        "no/film.mp4": "create the folder",
        "folder.mp4": "is a folder",
        "link.mp4": "is a link",
    }.items():
        with pytest.raises(ConfigurationError, match=says):
            check_name(tmp_path / name)
    with pytest.raises(ConfigurationError, match="cannot be written"):
        check_name(Path("/proc/film.mp4"))
    check_name(tmp_path / "good.mp4")
    assert not (tmp_path / "good.mp4").exists()
