"""JSON schema of a scenario's file, for editors."""

import json

from armland.scenario.tree import HARDWARE, Scenario


def schema() -> str:
    """JSON schema of a scenario's file: what a base may give is not demanded, and `belief` has the hardware's tables."""
    root = Scenario.model_json_schema()
    # Tables of a list stand for themselves: a fault without its kind is none.
    for section in (root, root["$defs"]["Link"]):
        section.pop("required")
    base = {"type": "string", "description": "scenario that comes with armland, or file, on whose values these are put"}
    belief = root["properties"].pop("belief")
    belief |= {"additionalProperties": False, "properties": {name: root["properties"][name] for name in HARDWARE}}
    root["properties"] = {"base": base, **root["properties"], "belief": belief}
    return json.dumps(root, indent=2, ensure_ascii=False)
