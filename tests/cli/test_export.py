"""`armland export`: what is written whole, and what is refused."""

import sys

import pyarrow.parquet as pq
import pytest


@pytest.fixture
def log(landed) -> str:
    return str(landed.log)


def names(folder) -> list[str]:
    return sorted(p.name for p in folder.iterdir())


def test_parquet_into_a_file_or_a_folder(armland, log, tmp_path, landed) -> None:
    assert armland("export", log, "--parquet", "run.parquet").code == 0
    done = armland("export", log, "--parquet", "tables")
    assert "The Parquet file is tables/landing.parquet" in done.out
    assert names(tmp_path) == ["run.parquet", "tables"]
    for file in ("run.parquet", "tables/landing.parquet"):
        assert pq.read_metadata(tmp_path / file).num_rows == len(landed.ticks)


@pytest.mark.slow
def test_rerun_and_csv(armland, log, tmp_path) -> None:
    done = armland("export", log, "--rerun", "run.rrd", "--csv", "csv")
    assert done.code == 0, done.err
    assert (tmp_path / "run.rrd").read_bytes()[:4] == b"RRF2"
    assert "truth.csv" in names(tmp_path / "csv")
    assert len(names(tmp_path / "csv")) == 10


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ((), "--csv DIR, --parquet FILE or --rerun FILE.rrd"),
        (("--rerun", "run.mcap"), "is a file *.rrd"),
        (("--rerun", "no/run.rrd"), "create the folder 'no' first"),
        (("--parquet", "/proc/run.parquet"), "cannot be written"),
        (("--csv", "/proc/csv"), "cannot be made a folder"),
    ],
)
def test_bad_input_is_one_message_and_writes_nothing(armland, log, tmp_path, words, says) -> None:
    done = armland("export", log, *words)
    assert (done.code, done.out) == (2, "")
    assert says in " ".join(done.err.split())
    assert names(tmp_path) == []


@pytest.mark.parametrize(
    ("package", "words"), [("pyarrow", ("--parquet", "p.parquet")), ("rerun", ("--rerun", "r.rrd"))]
)
def test_missing_package_is_one_message_and_leaves_nothing(armland, log, tmp_path, monkeypatch, package, words) -> None:
    monkeypatch.setitem(sys.modules, package, None)
    done = armland("export", log, *words)
    assert done.code == 2
    assert "pip install 'armland[export]'" in done.err
    assert names(tmp_path) == []
