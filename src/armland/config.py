"""Strict scenario loading: TOML, all errors at once with their path, calibrated values merged from their own file."""

import json
import tomllib
from importlib.resources import files
from pathlib import Path
from typing import Any

from pydantic import Field, ValidationError, model_validator

from armland.errors import ConfigurationError
from armland.scenario import Scenario, Section

SCENARIOS = Path(str(files("armland") / "scenarios"))
"""Folder of the scenarios that come with armland."""


class Calibrated(Section):
    """A value that no source publishes, inside the range that a source or an argument supports."""

    value: float | tuple[float, ...]
    low: float = Field(allow_inf_nan=False)
    high: float = Field(allow_inf_nan=False)
    unit: str
    because: str = Field(min_length=10, description="source or argument for the range")

    @model_validator(mode="after")
    def _inside(self) -> "Calibrated":
        values = self.value if isinstance(self.value, tuple) else (self.value,)
        unit = "" if self.unit == "1" else f" {self.unit}"
        for v in values:
            if not self.low <= v <= self.high:
                raise ValueError(f"value {v:g} lies outside its supported range {self.low:g} to {self.high:g}{unit}")
        return self


def load_scenario(path: str | Path, overrides: dict[str, Any] | None = None) -> Scenario:
    """Load a scenario from a TOML file, or by the name of one that comes with armland (`paper`).

    Args:
        path: file, or name without suffix.
        overrides: nested values that replace those of the file (from the command line).

    Raises:
        ConfigurationError: one message that lists every error with its path.
    """
    path = find(path)
    data = read_toml(path)
    problems: list[str] = []
    calibration = data.get("calibration")
    if isinstance(calibration, str):
        problems += _merge_calibration(data, read_toml(_find_calibration(calibration, path.parent)), calibration)
    update(data, overrides or {})
    try:
        scenario = Scenario.model_validate_json(json.dumps(data, default=str))
    except ValidationError as e:
        problems += [line for x in e.errors() for line in problem(x).split("\n")]
    if problems:
        head = f"{path.name}: {len(problems)} problem{'s' if len(problems) > 1 else ''}"
        raise ConfigurationError("\n  ".join([head, *problems]))
    return _absolute(scenario, path.parent)


def find(path: str | Path) -> Path:
    """The file that `path` means: itself, or a scenario that comes with armland.

    Raises:
        ConfigurationError: there is none; the message names the scenarios that come with armland.
    """
    for candidate in (Path(path), SCENARIOS / path, SCENARIOS / f"{path}.toml"):
        if candidate.is_file():
            return candidate
    known = ", ".join(sorted(p.stem for p in SCENARIOS.glob("*.toml") if "experiments" in read_toml(p)))
    raise ConfigurationError(f"scenario file {str(path)!r} does not exist; those that come with armland are: {known}")


def _find_calibration(name: str, folder: Path) -> Path:
    for candidate in (folder / name, SCENARIOS / name):
        if candidate.is_file():
            return candidate
    raise ConfigurationError(f"calibration: file {name!r} does not exist in {str(folder.resolve())!r}")


def schema() -> str:
    """JSON schema of a scenario, for editors."""
    return json.dumps(Scenario.model_json_schema(), indent=2, ensure_ascii=False)


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file.

    Raises:
        ConfigurationError: it cannot be read, or is not TOML.
    """
    try:
        return tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as e:
        raise ConfigurationError(f"{path.name} is not valid TOML: {e}") from e
    except OSError as e:
        raise ConfigurationError(f"{path.name} cannot be read: {e.strerror}") from e


def update(data: dict[str, Any], extra: dict[str, Any]) -> None:
    """Replace values of the nested tables `data` by those of `extra`, in place."""
    for key, value in extra.items():
        if isinstance(value, dict) and isinstance(data.get(key), dict):
            update(data[key], value)
        else:
            data[key] = value


def _merge_calibration(data: dict[str, Any], calibration: dict[str, Any], name: str) -> list[str]:
    problems = []
    for section, entries in calibration.items():
        target = data.setdefault(section, {})
        if not isinstance(entries, dict) or not isinstance(target, dict):
            problems.append(f"{name}: {section}: expected a table of calibrated values")
            continue
        for key, entry in entries.items():
            try:
                calibrated = Calibrated.model_validate_json(json.dumps(entry, default=str))
            except ValidationError as e:
                problems += [problem(x, Calibrated, f"{name}: {section}.{key}") for x in e.errors()]
                # The value itself is judged with the scenario, so that it is not also called missing.
                if isinstance(entry, dict) and "value" in entry:
                    target.setdefault(key, entry["value"])
                continue
            if key in target:
                problems.append(f"{section}.{key} is set here and in {name}; keep one of the two")
            target[key] = calibrated.value
    return problems


def problem(error: Any, model: type[Section] = Scenario, head: str = "") -> str:
    """One of pydantic's errors about `model` in one line: path, what is wrong, what was got or would have been allowed."""
    where = ".".join(str(p) for p in error["loc"])
    message = error["msg"].removeprefix("Value error, ").replace("should be an object", "should be a table")
    if error["type"] == "extra_forbidden":
        message = f"unknown key; known here: {', '.join(_known_keys(model, error['loc'][:-1]))}"
    elif error["type"] != "missing" and not isinstance(error["input"], dict):
        message += f" (got {_short(error['input'])})"
    return ": ".join(part for part in (head, where, message) if part)


def _short(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _known_keys(model: type[Section], location: tuple[Any, ...]) -> list[str]:
    # Walks the schema along the error's path: table names by property, list items and mapping values by their type.
    root = model.model_json_schema()
    node: dict[str, Any] = root
    for step in location:
        node = _resolve(root, node)
        properties = node.get("properties", {})
        if isinstance(step, str) and step in properties:
            node = properties[step]
        else:
            node = node.get("items") or node.get("additionalProperties") or {}
    return sorted(_resolve(root, node).get("properties", {}))


def _resolve(root: dict[str, Any], node: dict[str, Any]) -> dict[str, Any]:
    if "$ref" in node:
        return root["$defs"][node["$ref"].rsplit("/", 1)[1]]
    return node


def _absolute(scenario: Scenario, folder: Path) -> Scenario:
    # A path in a scenario is relative to the scenario's own folder; a bare name may be an asset of armland.
    updates = {}
    for section in ("arm", "uav"):
        part = getattr(scenario, section)
        candidate = folder / part.file
        if candidate.is_file():
            updates[section] = part.model_copy(update={"file": str(candidate)})
    return scenario.model_copy(update=updates)
