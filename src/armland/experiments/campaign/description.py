"""A campaign's file: which mission and scenario, what varies in it, and by which design."""

import json
from collections.abc import Callable
from itertools import product
from math import prod
from pathlib import Path
from typing import Annotated, Any, Literal, cast

import numpy as np
from pydantic import Field, ValidationError

from armland.errors import ConfigurationError
from armland.experiments.campaign.parameters import DRAWN, Parameter
from armland.experiments.campaign.summary import FIGURES
from armland.scenario import Scenario
from armland.scenario.files.toml import read_toml
from armland.scenario.quantities import Section, key
from armland.scenario.refusal import refusal, refused
from armland.scenario.tables import as_json, update

MOST_POINTS = 10_000
MOST_VARIANTS = 100
MOST_TRIED = 200
"""Points that are tried on the scenario before anything flies; a later one that it refuses is a row with its error."""
Design = Literal["random", "latin", "sobol"]
_Path = Annotated[str, Field(min_length=1, max_length=200)]


class Failure(Section):
    """What a flight does that counts as the failure whose rate is asked for."""

    figure: str | None = key(
        None, "figure that is too large then, as `touchdown.speed_mps`; absent: the mission's own criteria"
    )
    above: Annotated[float | None, Field(allow_inf_nan=False, ge=-1e12, le=1e12)] = key(
        None, "what the figure is above then, SI units and degrees"
    )
    stage: Annotated[int, Field(ge=20, le=1_000_000)] = key(100, "flights of each stage of learning, with --rare")

    def _contradictions(self) -> list[str]:
        if self.figure is not None and self.figure not in FIGURES:
            return [f"figure = {self.figure!r} is none; there are {', '.join(FIGURES)}"]
        if (self.figure is None) != (self.above is None):
            return ["figure and above belong together: `figure = 'touchdown.speed_mps', above = 0.2`"]
        return []


class Variant(Section):
    """A scenario that differs in some values, by its name."""

    name: _Path = Field(description="in tables and figures")
    values: dict[str, Any] = Field(default_factory=dict, description="what differs, by path in the scenario")


class Description(Section):
    """A campaign's file as it is read."""

    title: Annotated[str, Field(max_length=200)] = key("", "of the report")
    mission: str = key("landing", "name of the mission")
    scenario: str = key("landing", "file, relative to this one, or the name of one that comes with armland")
    law: str | None = key(None, "row of the law table instead of the mission's own")
    experiment: str | None = key(None, "row of the scenario's experiments, for missions that fly one")
    design: Design = key("random", "how values are drawn: random, latin (hypercube) or sobol")
    first_seed: Annotated[int, Field(ge=0, le=2**61)] = key(0, "seed of the first flight, and of the design")
    overrides: dict[str, Any] = Field(default_factory=dict, description="values of the scenario that are replaced")
    parameters: Annotated[dict[_Path, Parameter], Field(max_length=100)] = Field(
        default_factory=dict, description="what varies: dotted path in the scenario -> how"
    )
    points: Annotated[tuple[dict[str, Any], ...], Field(max_length=MOST_POINTS)] = key(
        (), "values that change together: each table is a point, flown with the same seeds as the others"
    )
    variants: Annotated[tuple[Variant, ...], Field(max_length=MOST_VARIANTS)] = key(
        (),
        "points with names: what one does not set is the scenario's, and follows its rules; the first is compared with",
    )
    failure: Failure | None = key(None, "the failure whose rate is asked for; the mission's own criteria if absent")

    @property
    def drawn(self) -> dict[str, Parameter]:
        """Parameters of which each flight draws a value."""
        return {name: p for name, p in self.parameters.items() if p.kind in DRAWN}

    @property
    def swept(self) -> dict[str, Parameter]:
        """Parameters whose values make the points."""
        return {name: p for name, p in self.parameters.items() if p.kind == "sweep"}

    @property
    def grid(self) -> list[dict[str, Any]]:
        """Fixed values and those of each point, by path: each of `points` with all combinations of what is swept; one at least."""
        return self._crossed(self.points or tuple(v.values for v in self.variants) or ({},))

    def _crossed(self, points: tuple[dict[str, Any], ...]) -> list[dict[str, Any]]:
        fixed = {name: p.fixed for name, p in self.parameters.items() if p.kind == "fixed"}
        sweeps = [[(name, value) for value in p.sweep or ()] for name, p in self.swept.items()]
        return [fixed | point | dict(swept) for point in points for swept in product(*sweeps)]

    @property
    def named(self) -> list[str]:
        """The variant of each point of `grid`; empty where there are none."""
        each = prod(len(p.sweep or ()) for p in self.swept.values())
        return [variant.name for variant in self.variants for _ in range(each)]

    def _contradictions(self) -> list[str]:
        count = max(len(self.points), len(self.variants), 1) * prod(len(p.sweep or ()) for p in self.swept.values())
        found = [f"there are {count} points; at most {MOST_POINTS}"] if count > MOST_POINTS else []
        for i, point in enumerate(self.points):
            twice = sorted(point.keys() & self.parameters.keys())
            found += [f"points.{i} sets {', '.join(twice)}, which a parameter sets, too"] if twice else []
            if point.keys() != self.points[0].keys():
                found.append(f"points.{i} must set what points.0 sets: {', '.join(sorted(self.points[0]))}")
        if self.points and self.variants:
            found.append("points and variants: one of them; variants may set different values")
        names = [v.name for v in self.variants]
        found += [f"variants: {name!r} is there twice" for name in sorted(set(names)) if names.count(name) > 1]
        for v in self.variants:
            twice = sorted(v.values.keys() & self.parameters.keys())
            found += [f"variant {v.name!r} sets {', '.join(twice)}, which a parameter sets, too"] if twice else []
        return found

    def settings(self) -> dict[str, Any]:
        """Nested values that replace those of the scenario when it is loaded: `overrides`, and a value of all that varies.

        Each flight sets what varies itself. But a scenario may not be one without it, as turbulence without wind is none, and what the
        user varies no rule may set. Places in lists need the list first and are left out.
        """
        out: dict[str, Any] = json.loads(json.dumps(self.overrides))
        for path, value in self.middle().items():
            steps = path.split(".")
            if not any(step.isdigit() for step in steps):
                nested: Any = value
                for step in reversed(steps):
                    nested = {step: nested}
                update(out, nested)
        return out

    def middle(self) -> dict[str, Any]:
        """Values of the first point, and of all that is drawn its median, by path; nothing of variants, which set different ones."""
        return {**self._medians(), **self._crossed(self.points or ({},))[0]}

    def _medians(self) -> dict[str, Any]:
        return {name: p.quantile()(np.array([0.5]))[0] for name, p in self.drawn.items()}

    def tried(self) -> list[tuple[dict[str, Any], dict[str, Any]]]:
        """What is tried before anything flies: what is said of a refusal, and values, by path."""
        middle, medians = self.middle(), self._medians()
        found: list[tuple[dict[str, Any], dict[str, Any]]] = [({}, {**medians, **p}) for p in self.grid[:MOST_TRIED]]
        for path, parameter in self.drawn.items():
            found += [({path: x}, {**middle, path: x}) for x in parameter.examples()]
        return found


def read_description(file: Path) -> Description:
    """The campaign that a TOML file describes; the path of its scenario made absolute where it is a file beside it.

    Raises:
        ConfigurationError: all that is wrong with it.
    """
    data = dotted(read_toml(file))
    try:
        made = Description.model_validate_json(as_json(data))
    except ValidationError as e:
        raise refusal(e, Description, file.name) from e
    beside = file.parent / made.scenario
    return made.model_copy(update={"scenario": str(beside.resolve())}) if beside.is_file() else made


def dotted(data: dict[str, Any]) -> dict[str, Any]:
    """The tables of a campaign's file with dotted paths: TOML reads air.wind_mps = {...} as a table in a table."""
    out = dict(data)
    if isinstance(out.get("parameters"), dict):
        out["parameters"] = _paths(out["parameters"], lambda v: not all(isinstance(x, dict) for x in v.values()))
    if isinstance(out.get("points"), list):
        out["points"] = [_paths(p, lambda v: False) if isinstance(p, dict) else p for p in out["points"]]
    for variant in out["variants"] if isinstance(out.get("variants"), list) else []:
        if isinstance(variant, dict) and isinstance(variant.get("values"), dict):
            variant["values"] = _paths(variant["values"], lambda v: False)
    return out


def _paths(table: dict[str, Any], ends: Callable[[dict[str, Any]], bool], head: str = "") -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in table.items():
        if isinstance(value, dict) and value and not ends(value):
            found |= _paths(value, ends, f"{head}{name}.")
        else:
            found[f"{head}{name}"] = value
    return found


def changes(tables: dict[str, Any], values: dict[str, Any]) -> dict[str, Any]:
    """Nested changes of a scenario that set the `values`, by dotted path; a number in a path is a place in a list.

    Args:
        tables: the scenario as plain data.
        values: what to set.

    Raises:
        ConfigurationError: a path that leads nowhere; the message names what there is.
    """
    out: dict[str, Any] = {}
    for path, value in values.items():
        _set(out, tables, path, value)
    return out


def _set(out: dict[str, Any], tables: dict[str, Any], path: str, value: Any) -> None:
    node: Any = tables
    steps, target = path.split("."), cast(Any, out)
    for depth, step in enumerate(steps):
        last = depth == len(steps) - 1
        if isinstance(node, list):
            if not step.isdigit() or int(step) >= len(node):
                raise ConfigurationError(f"{path}: {'.'.join(steps[:depth])} has the places 0 to {len(node) - 1}")
            # The list was laid into the changes as a whole one step before.
            inner, node = target, node[int(step)]
            if last:
                inner[int(step)] = value
                return
            target = inner[int(step)]
            continue
        if not isinstance(node, dict) or (step not in node and not _open(steps[:depth])):
            known = f"; known there: {', '.join(sorted(node))}" if isinstance(node, dict) else ": it is a single value"
            raise ConfigurationError(f"{path} is no value of the scenario{known}")
        node = node.get(step, {})
        if last:
            target[step] = value
            return
        target = target.setdefault(step, json.loads(json.dumps(node)) if isinstance(node, list) else {})


def _open(steps: list[str]) -> bool:
    # Tables whose keys a scenario chooses itself.
    return steps[:1] in (["belief"], ["experiments"], ["deviation"])


def check_parameters(description: Description, scenario: Scenario) -> None:
    """Refuse what the scenario cannot take: each point, and each parameter at its ends with the others in their middle.

    Raises:
        ConfigurationError: all of it, with the paths.
    """
    tables, found = json.loads(scenario.model_dump_json()), []
    for said, values in description.tried():
        try:
            if odd := values.keys() & {"run.seed", "title"}:
                raise ConfigurationError(f"{odd.pop()}: the seed follows from first_seed, and a title flies nothing")
            scenario.replaced(changes(tables, values))
        except ConfigurationError as e:
            line = str(e).split("\n  ")[-1]
            line = line if not said or next(iter(said)) in line else f"{said}: {line}"
            found += [] if line in found else [line]
    if found:
        raise refused("[parameters], [[points]] and [[variants]]", found)
