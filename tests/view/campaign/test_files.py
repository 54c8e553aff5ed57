"""CSV and Parquet hold the same columns, with nothing where a flight has no figure."""

import csv
import sys

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.view.campaign.files import columns, write_csv, write_parquet


def test_csv_can_be_read_again(made, tmp_path):
    _, _, table = made
    write_csv(tmp_path / "rows.csv", table)
    with (tmp_path / "rows.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(table.run)
    assert [float(r["air.wind_mps"]) for r in rows] == table.values["air.wind_mps"]
    assert [r["sea.state"] for r in rows] == table.values["sea.state"]
    assert rows[7]["figure.hinge_force_max_n"] == ""
    assert float(rows[8]["figure.hinge_force_max_n"]) == table.figures["hinge_force_max_n"][8]
    assert {r["success"] for r in rows} == {"0", "1"}


def test_parquet_has_the_same_columns(made, tmp_path):
    pq = pytest.importorskip("pyarrow.parquet")
    _, _, table = made
    write_parquet(tmp_path / "rows.parquet", table)
    found = pq.read_table(tmp_path / "rows.parquet").to_pydict()
    assert list(found) == list(columns(table))
    assert found["figure.hinge_force_max_n"][7] is None
    assert found["success"] == list(table.success)
    assert found["air.wind_mps"] == table.values["air.wind_mps"]


def test_values_of_several_kinds_are_numbers_or_text(made, tmp_path):
    pq = pytest.importorskip("pyarrow.parquet")
    _, _, table = made
    mixed = table._replace(values={"a": [1, 2.5] * 120, "b": ["x", 2] * 120, "c": [[1, 2], [3, 4]] * 120})
    write_parquet(tmp_path / "rows.parquet", mixed)
    found = pq.read_table(tmp_path / "rows.parquet").to_pydict()
    assert found["a"][:2] == [1.0, 2.5]
    assert found["b"][:2] == ["x", "2"]
    assert found["c"][:2] == ["[1, 2]", "[3, 4]"]


def test_without_pyarrow_it_is_said_what_to_install(made, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(ConfigurationError, match=r"armland\[export\]"):
        write_parquet(tmp_path / "rows.parquet", made[2])
    assert list(tmp_path.iterdir()) == []
    assert np.isnan(made[2].figures["hinge_force_max_n"][7])
