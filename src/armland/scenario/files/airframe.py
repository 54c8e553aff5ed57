"""A UAV as a file of its own: tables of a scenario's hardware, the source of each value, and a thrust curve measured on a bench.

A scenario names one by `airframe`. Its values lie above those that come with armland and below those that the user's
scenario sets. A file
without `uav.file` describes the UAV whole: mass, inertia, lever, and the places of the rotors. An MJCF or URDF file is one that says no
more than itself.
"""

import csv
from itertools import pairwise
from pathlib import Path
from typing import Any

from armland.errors import ConfigurationError
from armland.scenario.files.toml import read_toml

AIRFRAMES = Path(__file__).parents[2] / "airframes"
"""Folder of the UAVs that come with armland."""

TABLES = (
    "uav",
    "rotors",
    "onboard",
    "link",
    "hinge",
    "plate",
    "magnet",
    "skids",
    "cradle",
    "camera",
    "tool",
    "sensors",
    "imperfections",
    "deviation",
)
"""What a UAV's file may hold: what comes with the UAV, or has to fit it."""

MEASURED = "thrust_csv"
"""Key of `[rotors]`: a table of thrusts, N, over commands, of one rotor."""

NEEDED = ("uav.mass_kg", "uav.inertia_kgm2", "uav.lever_m", "rotors.place_m")
"""What a file without `uav.file` must say."""


def known() -> list[str]:
    """Names of the UAVs that come with armland."""
    return sorted(p.stem for p in AIRFRAMES.glob("*.toml"))


def find_airframe(name: str, folder: Path | None = None) -> Path:
    """The file that `name` means: itself, beside `folder`, or one that comes with armland.

    Raises:
        ConfigurationError: there is none; names those that come with armland.
    """
    for candidate in (Path(name) if folder is None else folder / name, AIRFRAMES / f"{name}.toml"):
        try:
            if candidate.is_file():
                return candidate.resolve()
        except (OSError, ValueError):
            continue
    raise ConfigurationError(
        f"airframe {name!r:.200}: there is no such file; UAVs that come with armland are {', '.join(known())}"
    )


def read_airframe(path: Path) -> dict[str, Any]:
    """The tables of a UAV's file, `sources` not among them.

    Raises:
        ConfigurationError: a file that cannot be read, or that holds or lacks what it should not.
    """
    if path.suffix.lower() in (".xml", ".mjcf", ".urdf"):
        return {"uav": {"file": str(path)}}
    data = read_toml(path)
    data.pop("sources", None)
    data.pop("title", None)
    other = sorted(set(data) - set(TABLES))
    if other:
        raise ConfigurationError(f"{path.name}: {', '.join(other)}: a UAV's file holds {', '.join(TABLES)} and sources")
    flat = [name for name, table in data.items() if not isinstance(table, dict)]
    if flat:
        raise ConfigurationError(f"{path.name}: {', '.join(flat)}: should be a table")
    rotors, uav = data.setdefault("rotors", {}), data.setdefault("uav", {})
    if MEASURED in rotors:
        low, high = measured(path.parent / str(rotors.pop(MEASURED)))
        rotors.setdefault("min_thrust_n", low)
        rotors.setdefault("max_thrust_n", high)
    if "file" not in uav:
        missing = [key for key in NEEDED if key.partition(".")[2] not in data[key.partition(".")[0]]]
        if missing:
            raise ConfigurationError(f"{path.name} lacks {', '.join(missing)}; or uav.file, an MJCF file that has them")
        uav["file"] = ""
    elif (path.parent / str(uav["file"])).is_file():
        uav["file"] = str((path.parent / str(uav["file"])).resolve())
    return data


def sources(path: Path) -> dict[str, str]:
    """What a UAV's file says of where its values come from, by dotted key."""
    found = read_toml(path).get("sources", {}) if path.suffix.lower() == ".toml" else {}
    return {str(key): str(value) for key, value in found.items()} if isinstance(found, dict) else {}


def measured(path: Path) -> tuple[float, float]:
    """Least and largest thrust, N, of a bench's table: columns `command` and `thrust_n`, a header, rows in any order.

    Raises:
        ConfigurationError: a table that cannot be read, or in which more command gives less thrust.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            rows = [(float(row["command"]), float(row["thrust_n"])) for row in csv.DictReader(file)]
    except OSError as e:
        raise ConfigurationError(f"{path.name} cannot be read: {e.strerror}") from e
    except (KeyError, TypeError, ValueError) as e:
        raise ConfigurationError(
            f"{path.name}: should have a header with command and thrust_n, and numbers ({e})"
        ) from e
    thrusts = [thrust for _, thrust in sorted(rows)]
    if len(thrusts) < 2:
        raise ConfigurationError(f"{path.name}: {len(thrusts)} rows; a thrust curve has two or more")
    for before, after in pairwise(thrusts):
        if after < before:
            raise ConfigurationError(
                f"{path.name}: the thrust falls from {before:g} to {after:g} N where the command grows"
            )
    return max(thrusts[0], 0.0), thrusts[-1]
