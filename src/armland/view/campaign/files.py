"""The rows of a campaign as files for other programs: CSV and Parquet."""

import csv
import json
from pathlib import Path
from typing import Any

import numpy as np

from armland.errors import ConfigurationError
from armland.experiments.campaign.answers.table import Table


def columns(table: Table) -> dict[str, Any]:
    """A column for each number of a row, by name; lists as long as there are rows, arrays (k,) of figures in SI units and degrees."""
    out: dict[str, Any] = {name: getattr(table, name) for name in ("run", "point", "seed", "success", "outcome")}
    out |= {
        name: [v if isinstance(v, int | float | str) else json.dumps(v) for v in column]
        for name, column in table.values.items()
    }
    out |= {f"figure.{name}": column for name, column in table.figures.items()}
    return out | {"cpu_s": table.cpu_s, "wall_s": table.wall_s}


def write_csv(file: Path, table: Table) -> None:
    """Write the columns with a head; a figure that a flight has not is an empty cell."""
    found = columns(table)
    with file.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(found)
        for cells in zip(*found.values(), strict=True):
            writer.writerow([_cell(cell) for cell in cells])


def _cell(cell: Any) -> Any:
    if isinstance(cell, float | np.floating):
        return "" if np.isnan(cell) else repr(float(cell))
    return int(cell) if isinstance(cell, bool | np.bool_) else cell


def write_parquet(file: Path, table: Table) -> None:
    """Write the columns as Parquet; a figure that a flight has not is null.

    Raises:
        ConfigurationError: PyArrow is not installed.
    """
    try:
        import pyarrow as pa
        import pyarrow.parquet as pq
    except ImportError as e:
        raise ConfigurationError("Parquet needs PyArrow: install armland[export]") from e
    arrays = {}
    for name, column in columns(table).items():
        if isinstance(column, np.ndarray):
            arrays[name] = pa.array(column, from_pandas=True)
        else:
            one_kind = len({type(v) for v in column}) <= 1
            arrays[name] = pa.array(
                column
                if one_kind
                else [float(v) if _number(v) else v for v in column]
                if all(map(_number, column))
                else [str(v) for v in column]
            )
    pq.write_table(pa.table(arrays), file, compression="zstd")


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
