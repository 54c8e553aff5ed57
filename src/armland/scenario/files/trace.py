"""A recorded wind: a CSV file with the columns time_s, x, y, z, checked for what no anemometer records."""

from pathlib import Path

import numpy as np

from armland.errors import ConfigurationError
from armland.rotations import Array
from armland.scenario.environment import MOST_MPS
from armland.scenario.files.columns import check_times, read_columns

COLUMNS = ("time_s", "x", "y", "z")


def read_trace(path: Path, needed_s: float) -> tuple[Array, Array]:
    """A recorded wind that lasts for `needed_s` or longer.

    Returns:
        Times (k,) s, from 0 on, and velocities (k, 3) m/s.

    Raises:
        ConfigurationError: it cannot be read, is too short, has gaps, is not in order, is not finite, or is too fast to be wind in m/s;
            with the row, the value and the bound.
    """
    rows = read_columns(path, COLUMNS, "a recorded wind")
    velocities = rows[:, 1:]
    most = np.abs(velocities)
    if most.max() > MOST_MPS:
        row, axis = np.unravel_index(int(most.argmax()), most.shape)
        raise ConfigurationError(
            f"{path.name}: row {row + 1}: {COLUMNS[axis + 1]} = {velocities[row, axis]:g} m/s; at most {MOST_MPS:g} m/s is wind: "
            "is it in other units?"
        )
    check_times(path.name, rows[:, 0], needed_s)
    return rows[:, 0] - rows[0, 0], velocities
