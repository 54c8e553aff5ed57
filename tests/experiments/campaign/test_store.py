"""The store: what goes in comes out, one writes, others read, a full disk takes nothing away."""

import resource
import sqlite3
import subprocess
import sys

import pytest

from armland.errors import ConfigurationError, StoreError
from armland.experiments.campaign.rows import Row
from armland.experiments.campaign.store import Store


def row(run, **more):
    given = {"success": True, "outcome": "done", "result": {"x": [1.5, None]}, "digest": "ab", "cpu_s": 0.4}
    return Row(run, 0, 10 + run, {"air.wind_mps": 0.1 * run, "sea.state": "ss1"}, **{**given, **more})


def test_rows_come_out_as_they_went_in_and_by_number(tmp_path):
    with Store(tmp_path / "a.sqlite", write=True) as store:
        made = [row(3), row(1, success=False, outcome="broke", result=None, error="RuntimeError: x"), row(2)]
        for one in made:
            store.add(one, '{"armland": "1"}')
        assert list(store.rows()) == sorted(made)
        assert list(store.outcomes()) == [(1, False), (2, True), (3, True)]
        assert store.row(2) == made[2]
        assert store.versions_of(3) == '{"armland": "1"}'
    with Store(tmp_path / "a.sqlite") as store:
        assert list(store.rows([3])) == [made[0]]
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.sqlite"]


def test_texts_that_rows_share_are_kept_once(tmp_path):
    with Store(tmp_path / "a.sqlite", write=True) as store:
        for run in range(5):
            store.add(row(run), "one text")
    with sqlite3.connect(tmp_path / "a.sqlite") as base:
        assert base.execute("SELECT count(*) FROM texts").fetchone() == (1,)


def test_a_row_that_is_there_is_not_replaced(tmp_path):
    with Store(tmp_path / "a.sqlite", write=True) as store:
        store.add(row(1), "v")
        with pytest.raises(StoreError):
            store.add(row(1, digest="cd"), "v")
        assert store.row(1).digest == "ab"


def test_reading_goes_on_while_another_writes(tmp_path):
    with Store(tmp_path / "a.sqlite", write=True) as writer:
        writer.add(row(1), "v")
        with Store(tmp_path / "a.sqlite") as reader:
            assert len(list(reader.rows())) == 1
            writer.add(row(2), "v")
            assert len(list(reader.rows())) == 2


def test_a_second_writer_is_refused_and_named_the_first(tmp_path):
    with Store(tmp_path / "a.sqlite", write=True) as store:
        store.add(row(1), "v")
        code = "import sys, pathlib; from armland.experiments.campaign.store import Store; Store(pathlib.Path(sys.argv[1]), write=True)"
        done = subprocess.run([sys.executable, "-c", code, store.file], capture_output=True, text=True, check=False)
        assert "is being written by another process (process " in done.stderr
        assert "ConfigurationError" in done.stderr
    with Store(tmp_path / "a.sqlite", write=True) as store:
        assert list(store.outcomes()) == [(1, True)]


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda f: f.write_text("hello " * 100), "no store of a campaign"),
        (lambda f: sqlite3.connect(f).execute("CREATE TABLE x (y)").connection.close(), "no store of a campaign"),
        (lambda f: f.mkdir(), "a.sqlite"),
    ],
)
def test_what_is_no_store_is_refused_and_left_alone(tmp_path, make, words):
    file = tmp_path / "a.sqlite"
    make(file)
    before = file.read_bytes() if file.is_file() else None
    with pytest.raises((ConfigurationError, StoreError), match=words):
        Store(file, write=True)
    assert before is None or file.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["a.sqlite"]


def test_a_store_that_is_not_there_and_a_row_that_is_not_there_are_refused(tmp_path):
    with pytest.raises(ConfigurationError, match="does not exist"):
        Store(tmp_path / "none.sqlite")
    assert list(tmp_path.iterdir()) == []
    with Store(tmp_path / "a.sqlite", write=True) as store:
        with pytest.raises(ConfigurationError, match="it has none yet"):
            store.row(0)
        store.add(row(4), "v")
        with pytest.raises(ConfigurationError, match="has no row 9; it has 1, the last of them 4"):
            store.row(9)


FULL = """
import resource, signal, sys, pathlib
from armland.errors import StoreError
from armland.experiments.campaign.rows import Row
from armland.experiments.campaign.store import Store
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
with Store(pathlib.Path(sys.argv[1]), write=True) as store:
    resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), resource.RLIM_INFINITY))
    for run in range(10_000):
        try:
            store.add(Row(run, 0, run, {}, True, "done", {"text": "x" * 3000}), "v")
        except StoreError as e:
            print(run)
            print(e)
            break
"""


def test_a_full_disk_is_one_message_and_what_was_written_stays(tmp_path):
    file = tmp_path / "a.sqlite"
    done = subprocess.run([sys.executable, "-c", FULL, file, "300000"], capture_output=True, text=True, check=True)
    number, message = done.stdout.splitlines()
    assert 10 < int(number) < 200
    assert "cannot be used" in message
    assert "rows that were written stay" in message
    with sqlite3.connect(file) as base:
        assert base.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    with Store(file, write=True) as store:
        assert [run for run, _ in store.outcomes()] == list(range(int(number)))
        store.add(Row(int(number), 0, 0, {}, True, "done"), "v")
    assert resource.getrlimit(resource.RLIMIT_FSIZE)[0] == resource.RLIM_INFINITY
