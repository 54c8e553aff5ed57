"""The schema that an editor gets says what the loader accepts."""

import json
import re
import tomllib

from armland.config import SCENARIOS
from armland.mission.landing_schema import landing_schema

SCHEMA = json.loads(landing_schema())


def resolve(node):
    return SCHEMA["$defs"][node["$ref"].rsplit("/", 1)[1]] if "$ref" in node else node


def known(node, key):
    node = resolve(node)
    for option in node.get("anyOf", []):
        if key in resolve(option).get("properties", {}):
            return resolve(option)["properties"][key]
    return node["properties"][key]


def test_references_lead_somewhere():
    names = set(re.findall(r'"#/\$defs/(\w+)"', landing_schema()))
    assert len(names) > 20
    assert names <= set(SCHEMA["$defs"])


def test_every_key_of_the_scenario_is_in_it():
    def walk(data, node):
        for key, value in data.items():
            found = known(node, key)
            if isinstance(value, dict):
                walk(value, found)

    walk(tomllib.loads((SCENARIOS / "landing.toml").read_text("utf-8")), SCHEMA)
    walk({"faults": [], "demonstrator": {"link": {"uplink_delay_ms": 3}, "control": {"thrust_n": 2.0}}}, SCHEMA)


def test_single_values_of_the_demonstrator_may_be_replaced_and_nothing_made_up():
    parts = {name: d for name, d in SCHEMA["$defs"].items() if name.startswith("Demonstrator")}
    assert {"Demonstrator", "DemonstratorLink", "DemonstratorRotors"} <= set(parts)
    assert [name for name, d in parts.items() if "required" in d] == []
    assert all(d["additionalProperties"] is False for d in parts.values())
    assert SCHEMA["additionalProperties"] is False
    # Where there is no base, what is needed stays so.
    assert SCHEMA["$defs"]["Fault"]["required"] == ["kind"]
