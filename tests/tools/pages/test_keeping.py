"""Records survive a stop: what is there is told, what is new is on disk before the next is flown."""

import json

import pytest

from pages.keeping import completed


def test_records_are_on_disk_as_they_come_and_told_the_next_time(tmp_path):
    path = tmp_path / "records.jsonl"

    def stopped(there):
        assert there == []
        yield {"seed": 1}
        assert json.loads(path.read_text()) == {"seed": 1}
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        completed(path, stopped)
    assert completed(path, lambda there: [{"seed": there[-1]["seed"] + 1}]) == [{"seed": 1}, {"seed": 2}]
    assert len(path.read_text().splitlines()) == 2
