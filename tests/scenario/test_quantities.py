"""Bounds of the numbers: each has a lower and an upper one, they hold, and a message names those that hold."""

import json
import math
import re
from functools import cache
from typing import Annotated, get_args

import numpy as np
import pytest
from pydantic import BaseModel, Field, TypeAdapter, ValidationError

from armland.scenario import Scenario
from armland.scenario.files.calibration import Calibrated
from armland.scenario.quantities import Inertia, Section, between
from armland.scenario.refusal import problems

UNITS = "m kg n nm s ms hz deg rad rad_s mps mps2 nps nmps nspm nms kgm2 kgm3 px mpns nm_s"
SUFFIX = re.compile(rf"_(share|{'|'.join(UNITS.split())}|nps_per_n)$")
WORDS = re.compile(
    r"m/s|N/s|N·|1/s|rad/|kg/s|N/m|\bN\b|share|probability|ratio|factor|number|damping|threshold|components|χ²",
    re.IGNORECASE,
)


def sections(model: type[BaseModel], found: dict[str, type[BaseModel]] | None = None) -> dict[str, type[BaseModel]]:
    """All kinds of tables below `model`, by name."""
    found = {} if found is None else found

    def search(annotation) -> None:
        if isinstance(annotation, type) and issubclass(annotation, BaseModel):
            if annotation.__name__ not in found:
                sections(annotation, found)
        else:
            for inner in get_args(annotation):
                search(inner)

    found[model.__name__] = model
    for field in model.model_fields.values():
        search(field.annotation)
        for inner in field.metadata:
            search(inner)
    return found


SECTIONS = sections(Scenario) | {"Calibrated": Calibrated}
FIELDS = [(model, name) for model in SECTIONS.values() for name in model.model_fields]


def nodes(node):
    """The schema nodes of single numbers below `node`."""
    if "$ref" in node:
        return
    if node.get("type") in ("number", "integer"):
        yield node
    for key in ("anyOf", "prefixItems"):
        for inner in node.get(key, ()):
            yield from nodes(inner)
    for key in ("items", "additionalProperties"):
        if isinstance(node.get(key), dict):
            yield from nodes(node[key])


@cache
def schema_of(model: type[BaseModel]):
    return model.model_json_schema()


@cache
def numbers(model: type[BaseModel], name: str):
    """The schema nodes of the numbers that a field of the table itself holds."""
    return list(nodes(schema_of(model)["properties"][name]))


NUMBERS = [pytest.param(model, name, id=f"{model.__name__}.{name}") for model, name in FIELDS if numbers(model, name)]


def unbounded(model: type[BaseModel]) -> list[str]:
    """Numbers of a table that lack a bound."""
    return [
        name
        for name in model.model_fields
        for node in numbers(model, name)
        if not {"minimum", "maximum"} <= node.keys() or not node["minimum"] < node["maximum"] <= 2**62
    ]


def test_the_walk_finds_the_tables() -> None:
    assert {"Scenario", "Arm", "Hover", "Switching", "Move", "Poles", "Fault"} <= SECTIONS.keys()
    assert len(SECTIONS) > 30
    assert len(NUMBERS) > 180


@pytest.mark.parametrize("model", SECTIONS.values(), ids=SECTIONS)
def test_every_number_has_a_lower_and_an_upper_bound(model) -> None:
    assert unbounded(model) == []


def test_number_without_a_bound_is_found() -> None:
    """Negative controls of the walk, however the number is wrapped."""

    class Loose(Section):
        plain: float = 1.0
        low: Annotated[float, Field(ge=0.0)] = 1.0
        pair: tuple[float, float] = (1.0, 1.0)
        many: tuple[Annotated[float, Field(le=1.0)], ...] | None = None
        named: dict[str, int] = Field(default_factory=dict)
        exclusive: Annotated[float, Field(gt=0.0, le=1.0)] = 1.0
        fine: Annotated[float, between(0.0, 1.0)] = 1.0
        switch: bool = True

    assert unbounded(Loose) == ["plain", "low", "pair", "pair", "many", "named", "exclusive"]


@pytest.mark.parametrize("model", SECTIONS.values(), ids=SECTIONS)
def test_a_bound_stands_in_the_type_alone(model) -> None:
    """Pydantic lets a bound beside the default be overruled by the type's, without a word."""
    for name, field in model.model_fields.items():
        bounds = [type(m).__name__ for m in field.metadata]
        assert len(set(bounds)) == len(bounds), f"{model.__name__}.{name}: {field.metadata}"


def errors_at(model, name, value, wrap):
    """What is wrong with a value of the field `name`, other fields and checks of the whole table left aside."""
    try:
        model.model_validate_json(json.dumps({name: wrap(value)}))
    except ValidationError as e:
        wrong = [line for line in problems(e, model) if line.startswith(name)]
        return [line for line in wrong if not line.endswith("is missing")]
    return []


def wrappers(model, name):
    """Ways to write one number where the field expects it: bare, or first of a list."""
    node = schema_of(model)["properties"][name]
    options = [node, *node.get("anyOf", ())]
    if any(option.get("type") in ("number", "integer") for option in options):
        yield lambda v: v
    for option in options:
        inner = (option.get("prefixItems") or [option.get("items")])[0]
        if isinstance(inner, dict) and inner.get("type") in ("number", "integer"):
            length = len(option.get("prefixItems", [0]))
            yield lambda v, n=length: [v] * n


@pytest.mark.parametrize(("model", "name"), NUMBERS)
def test_bounds_hold_and_messages_name_those_that_do(model, name) -> None:
    for wrap in wrappers(model, name):
        for huge in (1e300, -1e300):
            lines = errors_at(model, name, huge, wrap)
            assert lines, f"{huge} is accepted"
            for line in lines:
                match = re.fullmatch(r"[\w.]+: (\S+) lies outside (\S+) to (\S+)", line)
                if match is None:
                    # A whole number is refused as such before its size is looked at.
                    assert "integer" in line
                    continue
                assert float(match[1]) == huge
                for bound in (float(match[2]), float(match[3])):
                    within = int(bound) if "integer" in str(numbers(model, name)[0]) else bound
                    assert not any("lies outside" in x for x in errors_at(model, name, within, wrap))
    for node in numbers(model, name):
        low, high, whole = node["minimum"], node["maximum"], node["type"] == "integer"
        for wrap in wrappers(model, name):
            beyond = (low - 1, high + 1) if whole else (math.nextafter(low, -math.inf), math.nextafter(high, math.inf))
            for value in beyond:
                assert any("lies outside" in x for x in errors_at(model, name, value, wrap))


@pytest.mark.parametrize(("model", "name"), NUMBERS)
def test_what_is_no_number_is_refused(model, name) -> None:
    absent = None if model.model_fields[name].default is not None else "absent is a value here"
    for value in (math.nan, math.inf, -math.inf, "1", True, absent, [[[1.0]]], {}):
        for wrap in wrappers(model, name):
            assert errors_at(model, name, value, wrap), value


def shares(model: type[BaseModel]) -> list[str]:
    """Numbers that say they are shares or probabilities."""
    return [
        name
        for name, field in model.model_fields.items()
        if numbers(model, name)
        and ("share" in name or re.match(r"(share|fraction|probability)\b", field.description or ""))
        and name != "share_s"
    ]


def test_shares_are_at_most_one() -> None:
    found = [(model, name) for model in SECTIONS.values() for name in shares(model)]
    assert len(found) > 12
    for model, name in found:
        assert all(node["minimum"] >= 0.0 and node["maximum"] <= 1.0 for node in numbers(model, name)), name


@pytest.mark.parametrize(("model", "name"), NUMBERS)
def test_every_number_has_a_unit_and_a_meaning(model, name) -> None:
    description = model.model_fields[name].description or ""
    assert description, "no description"
    assert SUFFIX.search(name) or WORDS.search(description) or model is Calibrated, description


@pytest.mark.parametrize(("model", "name"), FIELDS)
def test_every_key_has_a_meaning(model, name) -> None:
    field = model.model_fields[name]
    # A table is described where it is defined.
    table = isinstance(field.annotation, type) and issubclass(field.annotation, BaseModel) and field.annotation.__doc__
    assert field.description or table


@pytest.mark.parametrize("model", SECTIONS.values(), ids=SECTIONS)
def test_texts_and_lists_are_bounded_too(model) -> None:
    def loose(node):
        if node.get("type") == "string" and not {"enum", "const", "maxLength", "pattern"} & node.keys():
            yield "text"
        if node.get("type") == "array" and "maxItems" not in node:
            yield "list"
        for inner in (*node.get("anyOf", ()), *([node["items"]] if isinstance(node.get("items"), dict) else [])):
            yield from loose(inner)

    properties = schema_of(model)["properties"]
    assert {name: list(loose(node)) for name, node in properties.items() if list(loose(node))} == {}


INERTIA = TypeAdapter(Inertia)


@pytest.mark.parametrize("seed", range(20))
def test_inertia_of_a_cloud_of_masses_is_accepted_and_what_breaks_the_triangle_is_not(seed) -> None:
    rng = np.random.default_rng(seed)
    points = rng.normal(size=(10, 3))
    tensor = sum(x @ x * np.eye(3) - np.outer(x, x) for x in points)
    tensor = 0.5 * (tensor + tensor.T)
    rows = tuple(tuple(float(v) for v in row) for row in tensor)
    assert INERTIA.validate_python(rows) == rows
    # The same axes, the largest moment beyond the sum of the others.
    values, axes = np.linalg.eigh(tensor)
    values[2] = 1.1 * (values[0] + values[1])
    broken = axes @ np.diag(values) @ axes.T
    broken = 0.5 * (broken + broken.T)
    with pytest.raises(ValidationError, match="no rigid body"):
        INERTIA.validate_python(tuple(tuple(float(v) for v in row) for row in broken))


def test_flat_plate_is_a_rigid_body() -> None:
    """Its moments meet the triangle's bound exactly."""
    rows = ((0.006, 0.0, 0.0), (0.0, 0.007, 0.0), (0.0, 0.0, 0.013))
    assert INERTIA.validate_python(rows) == rows
    with pytest.raises(ValidationError, match="no rigid body"):
        INERTIA.validate_python((*rows[:2], (0.0, 0.0, 0.01301)))


@pytest.mark.parametrize(
    ("rows", "says"),
    [
        (((0.006, 0.001, 0.0), (0.0, 0.007, 0.0), (0.0, 0.0, 0.012)), "symmetric"),
        (
            ((0.006, 0.0, 0.0), (0.0, -0.007, 0.0), (0.0, 0.0, 0.012)),
            "positive definite; its smallest eigenvalue is -0.007",
        ),
        (((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)), "positive definite"),
    ],
)
def test_impossible_inertia_is_refused(rows, says) -> None:
    with pytest.raises(ValidationError, match=says):
        INERTIA.validate_python(rows)
