"""The schema that an editor gets says what the loader accepts."""

import json
import re
import tomllib

import pytest

from armland.scenario import SCENARIOS, schema
from armland.scenario.tree import HARDWARE

SCHEMA = json.loads(schema())
KINDS = {
    "object": dict,
    "array": list,
    "string": str,
    "number": (int, float),
    "integer": int,
    "boolean": bool,
    "null": type(None),
}


def wrong(value, node, path=""):
    """What is wrong with `value` by the schema's `node`: the few keywords that a scenario's schema uses."""
    if "$ref" in node:
        node = SCHEMA["$defs"][node["$ref"].rsplit("/", 1)[1]]
    if "anyOf" in node:
        options = [list(wrong(value, one, path)) for one in node["anyOf"]]
        yield from min(options, key=len)
        return
    kind = KINDS[node["type"]] if "type" in node else object
    if not isinstance(value, kind) or (isinstance(value, bool) and kind is not bool):
        yield f"{path}: {value!r} is no {node['type']}"
    elif isinstance(value, dict):
        known, other = node.get("properties", {}), node.get("additionalProperties", True)
        yield from (f"{path}.{key}: missing" for key in node.get("required", ()) if key not in value)
        for key, inner in value.items():
            if key in known:
                yield from wrong(inner, known[key], f"{path}.{key}")
            elif isinstance(other, dict):
                yield from wrong(inner, other, f"{path}.{key}")
            elif not other:
                yield f"{path}.{key}: unknown"
    elif isinstance(value, list):
        if not node.get("minItems", 0) <= len(value) <= node.get("maxItems", len(value)):
            yield f"{path}: {len(value)} items"
        for i, inner in enumerate(value):
            items = node.get("prefixItems", ())
            yield from wrong(inner, items[i] if i < len(items) else node.get("items", {}), f"{path}.{i}")
    elif "enum" in node and value not in node["enum"]:
        yield f"{path}: {value!r} is none of {node['enum']}"
    elif "minimum" in node and not node["minimum"] <= value <= node["maximum"]:
        yield f"{path}: {value!r} is out of bounds"


def read(name):
    data = tomllib.loads((SCENARIOS / f"{name}.toml").read_text("utf-8"))
    if "calibration" in data:
        for section, entries in tomllib.loads((SCENARIOS / data["calibration"]).read_text("utf-8")).items():
            data.setdefault(section, {}).update({key: entry["value"] for key, entry in entries.items()})
    return data


@pytest.mark.parametrize("name", [p.stem for p in SCENARIOS.glob("*.toml") if p.stem != "calibration"])
def test_shipped_scenario_is_what_the_schema_allows(name) -> None:
    assert list(wrong(read(name), SCHEMA)) == []


SPOILT = [
    ({"place": {"catch": 1}}, ".place.catch: unknown"),
    ({"rum": {}}, ".rum: unknown"),
    ({"belief": {"control": {}}}, ".belief.control: unknown"),
    ({"belief": {"uav": {"mass": 1.0}}}, ".belief.uav.mass: unknown"),
    ({"run": {"duration_s": 601.0}}, ".run.duration_s: 601.0 is out of bounds"),
    ({"run": {"seed": "x"}}, ".run.seed: 'x' is no integer"),
    ({"onboard": {"controller": "pid"}}, ".onboard.controller: 'pid' is none of"),
    ({"faults": [{"size": 1.0}]}, ".faults.0.kind: missing"),
    ({"place": {"catch_m": [0.0, 0.0]}}, ".place.catch_m: 2 items"),
    ({"base": 3}, ".base: 3 is no string"),
]


@pytest.mark.parametrize(("data", "says"), SPOILT)
def test_what_the_loader_refuses_the_schema_refuses(data, says) -> None:
    assert [line for line in wrong(data, SCHEMA) if line.startswith(says)]


def test_values_of_a_base_are_not_demanded_and_single_values_may_be_believed_otherwise() -> None:
    data = {"base": "landing", "link": {"uplink_delay_ms": 3.0}, "belief": {"link": {"uplink_delay_ms": 20.0}}}
    assert list(wrong(data, SCHEMA)) == []
    assert set(SCHEMA["properties"]["belief"]["properties"]) == set(HARDWARE)


def test_references_lead_somewhere() -> None:
    names = set(re.findall(r'"#/\$defs/(\w+)"', schema()))
    assert len(names) > 25
    assert names == set(SCHEMA["$defs"])


def test_every_property_is_described() -> None:
    bare = [
        f"{name}.{key}"
        for name, table in {"Scenario": SCHEMA, **SCHEMA["$defs"]}.items()
        for key, node in table["properties"].items()
        if "description" not in node
        and not SCHEMA["$defs"].get(node.get("$ref", "").rsplit("/", 1)[-1], {}).get("description")
    ]
    assert bare == []
