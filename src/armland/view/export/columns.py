"""A run as flat columns with names, units and frames: CSV files, a Parquet file.

| column | holds |
|---|---|
| `time_ns` | time of the tick since the start, whole nanoseconds |
| `mission.phase_name`, `mission.fault_name` | the numbers in words |
| e.g. `truth.r.0` | the number 0 of the field `r` of the message `truth` |
"""

import csv
import json
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.errors import ConfigurationError
from armland.records import MESSAGES
from armland.runtime.log import Log

NEEDS_ARROW = "Parquet files need PyArrow: pip install 'armland[export]'"


class Column(NamedTuple):
    """One column of numbers or words."""

    name: str
    values: NDArray
    unit: str
    frame: str
    meaning: str


def columns_of(log: Log) -> Iterator[Column]:
    """All columns of a run, (ticks,) each, the time first; the ticks of the messages are left out."""
    tick = log.messages["measurement"]["tick"]
    yield Column("time_ns", tick * int(log.metadata["period_ns"]), "ns", "-", "time since the start")
    for message, fields in MESSAGES.items():
        rows = log.messages[message]
        for field in fields:
            values = rows[field.name]
            about = (field.unit, field.frame, field.meaning)
            if values.ndim == 1:
                yield Column(f"{message}.{field.name}", values, *about)
            else:
                for i in range(values.shape[1]):
                    yield Column(f"{message}.{field.name}.{i}", values[:, i], *about)
    yield from _words(log)


def _words(log: Log) -> Iterator[Column]:
    for key, what, meaning in (("phase", "phases", "name of the phase"), ("fault", "faults", "name of the fault")):
        names = np.array(log.metadata.get(what, "").split(","))
        numbers = log.messages["mission"][key]
        known = (numbers >= 0) & (numbers < len(names))
        words = np.where(known, names[np.where(known, numbers, 0)], numbers.astype(str))
        yield Column(f"mission.{key}_name", words, "1", "-", meaning)


def write_csv(log: Log, folder: Path) -> list[Path]:
    """Write a CSV file for each message, `columns.csv` with unit, frame and meaning of every column, and `metadata.json`.

    Args:
        log: the run.
        folder: of the files; it is there.
    """
    found = list(columns_of(log))
    time, paths = found[0], []
    for message in MESSAGES:
        own = [time, *(c for c in found if c.name.startswith(f"{message}."))]
        paths.append(folder / f"{message}.csv")
        with open(paths[-1], "w", newline="", encoding="utf-8") as file:
            out = csv.writer(file, lineterminator="\n")
            out.writerow([c.name for c in own])
            # By the shortest digits that give the same number back.
            out.writerows(zip(*(c.values.tolist() for c in own), strict=True))
    paths.append(folder / "columns.csv")
    with open(paths[-1], "w", newline="", encoding="utf-8") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["column", "unit", "frame", "meaning"])
        out.writerows([c.name, c.unit, c.frame, c.meaning] for c in found)
    paths.append(folder / "metadata.json")
    paths[-1].write_text(json.dumps(log.metadata, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")
    return paths


def write_parquet(log: Log, path: Path) -> Path:
    """Write one Parquet file: a column each, with unit, frame and meaning in its metadata, the log's metadata in the file's.

    Raises:
        ConfigurationError: PyArrow is not installed.
    """
    try:
        import pyarrow as pa
        import pyarrow.parquet as pq
    except ImportError as e:
        raise ConfigurationError(NEEDS_ARROW) from e
    found = list(columns_of(log))
    fields = [
        pa.field(
            c.name,
            pa.string() if c.values.dtype.kind == "U" else pa.from_numpy_dtype(c.values.dtype),
            metadata={"unit": c.unit, "frame": c.frame, "meaning": c.meaning},
        )
        for c in found
    ]
    schema = pa.schema(fields, metadata={f"armland.{key}": value for key, value in log.metadata.items()})
    table = pa.table([pa.array(np.ascontiguousarray(c.values)) for c in found], schema=schema)
    pq.write_table(table, path, compression="zstd")
    return path
