"""An earlier result stays until the new one is there; nothing is written elsewhere."""

import os
from pathlib import Path

import pytest

from armland.cli.results import Results
from armland.errors import ConfigurationError


def files(folder: Path) -> dict[str, str]:
    return {p.relative_to(folder).as_posix(): p.read_text() for p in sorted(folder.rglob("*")) if p.is_file()}


def test_files_take_the_place_of_an_earlier_result_together(tmp_path) -> None:
    (tmp_path / "result.json").write_text("old")
    (tmp_path / "old_overview.png").write_text("old")
    (tmp_path / "notes.txt").write_text("mine")
    with Results(tmp_path, ("result.json", "*_overview.*")) as results:
        results.write("result.json", "new")
        assert files(tmp_path)["result.json"] == "old"
        results.keep()
        assert files(tmp_path) == {"notes.txt": "mine", "result.json": "new"}
        results.write("new_overview.png", "later")
    assert files(tmp_path) == {"new_overview.png": "later", "notes.txt": "mine", "result.json": "new"}


@pytest.mark.parametrize("end", [KeyboardInterrupt, MemoryError, OSError])
def test_run_that_dies_leaves_the_earlier_result_and_its_own_log(tmp_path, end, capsys) -> None:
    (tmp_path / "result.json").write_text("old")
    (tmp_path / "landing.mcap").write_text("old")
    for content in ("first", "second"):
        with pytest.raises(end), Results(tmp_path, ("result.json", "*.mcap")) as results:  # noqa: PT012
            (results.folder / "landing.mcap").write_text(content)
            results.scratch("other.mcap").write_text("nobody's")
            raise end
    assert files(tmp_path) == {"landing.mcap": "old", "result.json": "old", "unfinished/landing.mcap": "second"}
    assert f"is in {tmp_path}/unfinished/" in capsys.readouterr().err


def test_run_that_dies_before_it_records_leaves_nothing(tmp_path) -> None:
    for out in (tmp_path, tmp_path / "new" / "folder"):
        with pytest.raises(KeyError), Results(out):
            raise KeyError
    assert list(tmp_path.iterdir()) == []


def test_links_are_not_followed(tmp_path) -> None:
    elsewhere, out = tmp_path / "elsewhere", tmp_path / "out"
    elsewhere.mkdir()
    out.mkdir()
    (elsewhere / "precious").write_text("precious")
    for name in ("result.json", "stale.mcap"):
        (out / name).symlink_to(elsewhere / "precious")
    with Results(out, ("*.mcap",)) as results:
        results.write("result.json", "new")
    assert files(elsewhere) == {"precious": "precious"}
    assert (out / "result.json").read_text() == "new"
    assert not (out / "result.json").is_symlink()
    assert not os.path.lexists(out / "stale.mcap")
    (tmp_path / "link").symlink_to(out)
    with pytest.raises(ConfigurationError, match=r"is a link.*name the folder itself"):
        Results(tmp_path / "link")


def test_what_cannot_be_a_folder_is_refused(tmp_path) -> None:
    (tmp_path / "file").write_text("")
    for out in (
        tmp_path / "file",
        tmp_path / "file" / "sub",
        Path("/proc/armland"),
        tmp_path / ("x" * 300),
        Path("a\0b"),
    ):
        with pytest.raises(ConfigurationError, match="--out"):
            Results(out)
    assert files(tmp_path) == {"file": ""}


def test_file_that_cannot_be_written_is_said_and_no_error(tmp_path, capsys) -> None:
    (tmp_path / "result.json").mkdir()
    with Results(tmp_path) as results:
        results.write("no/such/folder", "text")
        results.write("result.json", "text")
    said = capsys.readouterr().err
    assert "armland: no no/such/folder: " in said
    assert "armland: no result.json in " in said


def test_file_that_fits_in_part_only_is_not_left(tmp_path, capsys, monkeypatch) -> None:
    def write_half(path: Path, text: str, encoding: str) -> None:
        path.write_bytes(text.encode(encoding)[: len(text) // 2])
        raise OSError(28, "No space left on device")

    with Results(tmp_path) as results:
        monkeypatch.setattr(Path, "write_text", write_half)
        results.write("result.json", "text")
    assert capsys.readouterr().err == "armland: no result.json: No space left on device\n"
    assert files(tmp_path) == {}
