"""`armland render`: films and stills, and what is refused before anything is drawn."""

from pathlib import Path

import pytest

from armland.errors import PictureError
from armland.view.film import film as films


@pytest.fixture
def log(landed, tmp_path):
    return str(landed.log)


@pytest.mark.slow
def test_film_and_stills(armland, log, tmp_path) -> None:
    done = armland(
        *("render", log, "--video", "f.mp4", "--stills", "s", "--size", "160x120", "--fps", "2", "--speed", "9")
    )
    if done.code == 2:
        assert "no OpenGL" in done.err
        pytest.skip("no OpenGL")
    assert done.code == 0, done.err
    assert "The film is f.mp4" in done.out
    assert (tmp_path / "f.mp4").stat().st_size > 1000
    assert len(list((tmp_path / "s").glob("still_*.png"))) == len(list((tmp_path / "s").iterdir())) > 10


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ((), "--video film.mp4 makes a film"),
        (("--video", "f.avi"), "a film is a file *.mp4"),
        (("--video", "no/f.mp4"), "create the folder"),
        (("--video", "f.mp4", "--size", "big"), "expected width x height"),
        (("--video", "f.mp4", "--size", "161x120"), "both must be even"),
        (("--video", "f.mp4", "--speed", "0"), "speed"),
        (("--stills", "/proc/no"), "cannot be made a folder"),
    ],
)
def test_bad_input_is_one_message_and_writes_nothing(armland, log, tmp_path, words, says) -> None:
    done = armland("render", log, *words)
    assert (done.code, done.out) == (2, "")
    assert says in " ".join(done.err.split())
    assert list(tmp_path.iterdir()) == []


def test_foreign_and_missing_logs_are_refused(armland, tmp_path) -> None:
    (tmp_path / "foreign.mcap").write_bytes(b"no log" * 100)
    for name, says in {"foreign.mcap": "not an MCAP file", "no.mcap": "cannot read"}.items():
        done = armland("render", name, "--video", "f.mp4")
        assert done.code == 2
        assert says in done.err
    assert [p.name for p in tmp_path.iterdir()] == ["foreign.mcap"]


def test_log_that_was_cut_off_is_shown_as_far_as_it_goes(armland, log, tmp_path, monkeypatch) -> None:
    data = Path(log).read_bytes()
    (tmp_path / "cut.mcap").write_bytes(data[: len(data) // 3])
    seen = []
    monkeypatch.setattr(films, "film", lambda take, *_: seen.append(take))
    assert armland("render", "cut.mcap", "--video", "f.mp4").code == 0
    assert 2.0 < seen[0].seconds < 8.0
    assert not seen[0].success


def test_no_opengl_is_one_message(armland, log, tmp_path, monkeypatch) -> None:
    def no_opengl(*_: object) -> None:
        raise PictureError("no OpenGL for off-screen pictures; install EGL")

    monkeypatch.setattr(films, "film", no_opengl)
    done = armland("render", log, "--video", "f.mp4")
    assert done.code == 2
    assert "no film and no stills: no OpenGL" in done.err
    assert list(tmp_path.iterdir()) == []
