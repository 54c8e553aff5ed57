"""A run as flat columns: what `pandas.DataFrame` takes, one column for each number of each message."""

from numpy.typing import NDArray

from armland.records import Records


def columns(ticks: Records, period_ns: int) -> dict[str, NDArray]:
    """Columns (k,) by name: `time` in s, then e.g. `mission.phase`, `truth.r.0`, `truth.r.1`, `truth.r.2`; views where possible.

    Args:
        ticks: (k,) of `records.tick_layout`.
        period_ns: length of a tick.
    """
    found = {"time": ticks["measurement"]["tick"] * (period_ns * 1e-9)}
    for message in ticks.dtype.names or ():
        rows = ticks[message]
        for field in rows.dtype.names or ():
            values = rows[field]
            if values.ndim == 1:
                found[f"{message}.{field}"] = values
            else:
                found |= {f"{message}.{field}.{i}": values[:, i] for i in range(values.shape[1])}
    return found
