"""What other tools read back is what `read_log` reads."""

import json
import sys

import numpy as np
import pyarrow as pa
import pyarrow.csv as pacsv
import pyarrow.parquet as pq
import pytest

from armland.errors import ConfigurationError
from armland.records import MESSAGES
from armland.runtime.log import Log
from armland.view.export.columns import columns_of, write_csv, write_parquet


@pytest.fixture(scope="module")
def log(sea_log) -> Log:
    return sea_log


def test_every_number_of_every_message_is_a_column(log) -> None:
    found = {c.name: c for c in columns_of(log)}
    numbers = sum(np.dtype(log.ticks.dtype[m]).itemsize // 8 for m in MESSAGES)
    assert len(found) == numbers + len(["time_ns", "phase_name", "fault_name"])
    np.testing.assert_array_equal(found["truth.r.2"].values, log.messages["truth"]["r"][:, 2])
    assert (found["truth.r.2"].unit, found["truth.r.2"].frame) == ("m", "W")
    assert found["time_ns"].values.dtype == np.int64
    np.testing.assert_array_equal(found["time_ns"].values, np.arange(len(log.ticks)) * 1_000_000)


def test_names_stand_for_numbers_also_for_unknown_ones(log) -> None:
    ticks = log.ticks[:3].copy()
    ticks["mission"]["phase"] = [0, 1, 999]
    words = {c.name: c.values for c in columns_of(Log(ticks, log.metadata, {}, True))}["mission.phase_name"]
    names = log.metadata["phases"].split(",")
    assert words.tolist() == [names[0], names[1], "999"]


def test_parquet_is_read_back_exactly(log, tmp_path) -> None:
    table = pq.read_table(write_parquet(log, tmp_path / "run.parquet"))
    for c in columns_of(log):
        column = table.column(c.name)
        if c.values.dtype.kind == "U":
            assert column.to_pylist() == c.values.tolist()
        else:
            np.testing.assert_array_equal(column.to_numpy(), c.values)
            assert column.to_numpy().dtype == c.values.dtype
    field = table.schema.field("truth.hinge_force.0")
    assert field.metadata == {b"unit": b"N", b"frame": b"W", b"meaning": b"force on the UAV at the hinge"}
    assert table.schema.metadata[b"armland.seed"] == b"5"
    assert table.schema.field("time_ns").type == pa.int64()


def test_csv_is_read_back_exactly(log, tmp_path) -> None:
    short = Log(log.ticks[:50], log.metadata, {}, True)
    paths = write_csv(short, tmp_path)
    assert sorted(p.name for p in paths) == sorted([*(f"{m}.csv" for m in MESSAGES), "columns.csv", "metadata.json"])
    tables = {m: pacsv.read_csv(tmp_path / f"{m}.csv") for m in MESSAGES}
    for c in columns_of(short):
        for message in MESSAGES if c.name == "time_ns" else [c.name.partition(".")[0]]:
            back = tables[message].column(c.name).to_numpy(zero_copy_only=False)
            if c.values.dtype.kind == "U":
                assert back.tolist() == c.values.tolist()
            else:
                np.testing.assert_array_equal(back.astype(c.values.dtype), c.values)
    about = pacsv.read_csv(tmp_path / "columns.csv").to_pylist()
    assert {"column": "truth.v.0", "unit": "m/s", "frame": "W", "meaning": "its velocity"} in about
    assert json.loads((tmp_path / "metadata.json").read_text()) == log.metadata


def test_missing_package_says_how_to_get_it(log, tmp_path, monkeypatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(ConfigurationError, match=r"pip install 'armland\[export\]'"):
        write_parquet(log, tmp_path / "run.parquet")
    assert list(tmp_path.iterdir()) == []
