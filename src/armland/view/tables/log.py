"""What a run log holds, in words."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from armland.records import MESSAGES
from armland.runtime.log import Log
from armland.view.tables.verdicts import terminal, titled

LISTS = ("phases", "faults", "finals")  # Entries of the metadata that are lists of names


def described(log: Log) -> dict[str, Any]:
    """What a log holds, as plain data."""
    ticks = len(log.messages["measurement"])
    time = log.time
    return {
        "complete": log.complete,
        "ticks": ticks,
        "duration_s": float(time[-1] - time[0]) + 1e-9 * int(log.metadata["period_ns"]) if ticks else 0.0,
        "metadata": {k: v.split(",") if k in LISTS else v for k, v in sorted(log.metadata.items())},
        "attachments": {name: len(data) for name, data in log.attachments.items()},
        "messages": {
            name: {field: list(array.dtype[field].shape) for field in array.dtype.names or ()}
            for name, array in log.messages.items()
        },
        "phases": list(_phases(log)),
    }


def _phases(log: Log) -> Iterator[dict[str, Any]]:
    phase, names = log.messages["mission"]["phase"], log.metadata.get("phases", "").split(",")
    edges = [0, *(np.flatnonzero(np.diff(phase)) + 1).tolist()] if len(phase) else []
    for k in edges:
        number = int(phase[k])
        yield {"name": names[number] if 0 <= number < len(names) else str(number), "start_s": float(log.time[k])}


def print_log(log: Log, path: Path) -> None:
    """Print what a log holds: of which run, how long, which phases, which messages with fields, units and frames."""
    data, console = described(log), terminal()
    whole = "" if log.complete else "; it ends before its end was written: the run was stopped"
    console.print(f"{path}: {data['ticks']} ticks, {data['duration_s']:.3f} s{whole}", markup=False)
    table = titled("The run", "", "", left=(0, 1))
    for key, value in data["metadata"].items():
        text = ", ".join(value) if isinstance(value, list) else value
        table.add_row(key, text if len(text) <= 200 else f"{text[:200]} ... ({len(text)} characters)")
    for name, size in data["attachments"].items():
        table.add_row("attached", f"{name} ({size} bytes)")
    console.print(table, markup=False)
    phases = ", ".join(f"{p['name']} {p['start_s']:.2f}" for p in data["phases"])
    console.print(f"Phases with their start in s: {phases or 'none'}", markup=False)
    fields = titled("Messages", "field", "shape", "unit", "frame", "meaning", left=(0, 1, 2, 3, 4))
    for name, array in log.messages.items():
        fields.add_section()
        for f in MESSAGES[name]:
            shape = array.dtype[f.name].shape
            fields.add_row(f"{name}.{f.name}", str(shape) if shape else "", f.unit, f.frame, f.meaning)
    console.print(fields)
