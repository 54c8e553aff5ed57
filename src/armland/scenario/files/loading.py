"""Strict scenario loading: TOML, a base, calibrated values from their own file, all errors at once with their path."""

from collections.abc import Iterator
from contextlib import contextmanager
from copy import deepcopy
from importlib.resources import files
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from armland.errors import ConfigurationError
from armland.scenario.files.airframe import find_airframe, read_airframe
from armland.scenario.files.calibration import merge_calibration
from armland.scenario.files.former import rebased, renamed, without_effect
from armland.scenario.files.toml import read_toml, text_of
from armland.scenario.refusal import problems, refused
from armland.scenario.tables import as_json, leaves, orderly, update
from armland.scenario.tree import Scenario

SCENARIOS = Path(str(files("armland") / "scenarios"))
"""Folder of the scenarios that come with armland."""

MOST_BASES = 8
"""Bases on bases."""


def load_scenario(path: str | Path = "landing", overrides: dict[str, Any] | None = None) -> Scenario:
    """Load a scenario from a TOML file, or by the name of one that comes with armland (`landing`, `paper`, `compare`).

    Args:
        path: file, or name without suffix.
        overrides: nested values that replace those of the file (from the command line).

    Raises:
        ConfigurationError: one message that lists every error with its path.
    """
    path = find(path)
    head = f"{path.name} as overridden" if overrides else path.name
    extra = deepcopy(orderly(overrides or {}, "what overrides the scenario"))
    found = renamed(extra)
    idle, own = without_effect(read_toml(path)), _tables(path, found)
    own |= {key: extra.pop(key) for key in ("base", "calibration", "airframe") if key in extra}
    asked = set(leaves(extra))
    data = _based(own, path, found, asked)
    update(own, extra)
    _resolve_files(extra, path.parent)
    _lay(data, extra)
    try:
        scenario = Scenario.model_validate_json(as_json(data))
    except ValidationError as e:
        found += problems(e, Scenario)
    if found:
        raise refused(head, found)
    scenario._text = text_of(path)
    scenario._overrides = as_json(overrides) if overrides else ""
    scenario._own = (
        frozenset(leaves({k: v for k, v in own.items() if k not in ("base", "calibration", "title", "airframe")}))
        - idle
    )
    scenario._asked = frozenset(asked)
    return scenario


def find(path: str | Path) -> Path:
    """The file that `path` means: itself, or a scenario that comes with armland.

    Raises:
        ConfigurationError: there is none; the message names the scenarios that come with armland.
    """
    for candidate in (Path(path), SCENARIOS / path, SCENARIOS / f"{path}.toml"):
        if _is_file(candidate):
            return candidate
    known = ", ".join(sorted(p.stem for p in SCENARIOS.glob("*.toml") if p.stem != "calibration"))
    raise ConfigurationError(
        f"scenario file {str(path)!r:.200} does not exist; those that come with armland are: {known}"
    )


def _based(data: dict[str, Any], path: Path, found: list[str], asked: set[str], depth: int = 0) -> dict[str, Any]:
    # The tables of a file on those of its base, calibrated values and absolute paths included. What a user's file sets is asked for.
    data = deepcopy(data)
    if path.parent.resolve() != SCENARIOS.resolve():
        asked |= set(leaves(data))
    base, calibration = data.pop("base", None), data.get("calibration")
    if isinstance(calibration, str):
        file = _beside(calibration, path, "calibration")
        with _named(path, "calibration"):
            found += merge_calibration(data, read_toml(file), file)
    _resolve_files(data, path.parent)
    frame = data.get("airframe")
    if base is None:
        return _framed({}, frame, data, path, asked)
    if not isinstance(base, str):
        raise ConfigurationError(f"{path.name}: base = {base!r:.60} should be the name of a scenario or of a file")
    if depth >= MOST_BASES:
        raise ConfigurationError(
            f"{path.name}: more than {MOST_BASES} scenarios are based on each other; is one its own base?"
        )
    file = _beside(base, path, "base")
    with _named(path, "base"):
        tables = _tables(file, found)
    out = _based(tables, file, found, asked, depth + 1)
    return _framed(out, frame, data, path, asked)


def _framed(below: dict[str, Any], frame: Any, data: dict[str, Any], path: Path, asked: set[str]) -> dict[str, Any]:
    # `data` on `below`, and the UAV that it names between them; what comes with armland, and names none by itself, lies below the UAV.
    own = path.parent.resolve() == SCENARIOS.resolve()
    if frame is not None:
        if not isinstance(frame, str):
            raise ConfigurationError(f"{path.name}: airframe = {frame!r:.60} should be the name of a UAV or of a file")
        file = find_airframe(frame, None if own else path.parent)
        with _named(path, "airframe"):
            tables = read_airframe(file)
        asked |= set(leaves(tables))
        data = {**data, "airframe": str(file)}
        layers: tuple[dict[str, Any], ...] = (data, tables) if own else (tables, data)
    else:
        layers = (data,)
    for layer in layers:
        _lay(below, layer)
    return below


def _lay(below: dict[str, Any], layer: dict[str, Any]) -> None:
    # Put `layer` on the tables `below`. What was said of an arm, and where it stands, says nothing of another one.
    arm, before = layer.get("arm"), below.get("arm")
    if isinstance(arm, dict) and isinstance(before, dict) and arm.get("file", before.get("file")) != before.get("file"):
        below["arm"] = {}
        for table, key in (("place", "home_deg"), ("trajectory", "start_m")):
            if isinstance(below.get(table), dict):
                below[table].pop(key, None)
    update(below, layer)


def _tables(path: Path, found: list[str]) -> dict[str, Any]:
    # The tables of a file, each key where it stands today.
    data = read_toml(path)
    if path.parent.resolve() != SCENARIOS.resolve():
        rebased(data)
    found += renamed(data)
    return data


def _beside(name: str, path: Path, what: str) -> Path:
    # Never in the working directory: what a file means does not depend on where the command is run.
    for candidate in (path.parent / name, SCENARIOS / name, SCENARIOS / f"{name}.toml"):
        if _is_file(candidate) and candidate != path:
            return candidate
    raise ConfigurationError(f"{path.name}: {what}: file {name!r:.200} does not exist beside the scenario")


@contextmanager
def _named(path: Path, what: str) -> Iterator[None]:
    # A file that cannot be read is refused with the name of the one that asks for it.
    try:
        yield
    except ConfigurationError as e:
        raise ConfigurationError(f"{path.name}: {what}: {e}") from e


def _is_file(path: Path) -> bool:
    # A name that is too long for the file system, or that no file can have, is no file.
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def _resolve_files(data: dict[str, Any], folder: Path) -> None:
    # A path in a scenario is relative to the scenario's own folder; a bare name may be an asset of armland, or a law's.
    belief, experiments = data.get("belief"), data.get("experiments")
    for tables in (data, belief):
        for section in ("arm", "uav"):
            _absolute(tables, section, "file", folder)
    _absolute(data, "air", "trace", folder)
    for name in ("trace", "spectrum_file", "response_file"):
        _absolute(data, "sea", name, folder)
    _absolute(data, "control", "law", folder)
    for name in experiments if isinstance(experiments, dict) else ():
        _absolute(experiments, name, "law", folder)


def _absolute(tables: Any, section: str, key: str, folder: Path) -> None:
    part = tables.get(section) if isinstance(tables, dict) else None
    value = part.get(key) if isinstance(part, dict) else None
    if not isinstance(part, dict) or not isinstance(value, str):
        return
    # A law's address ends in its function's name.
    name, colon, function = value.rpartition(":") if key == "law" else (value, "", "")
    if name and _is_file(folder / name):
        part[key] = f"{(folder / name).resolve()}{colon}{function}"
