"""JSON schema of a landing's scenario, for editors that complete and check TOML."""

import json
from typing import Any

from armland.mission.landing_scenario import Landing
from armland.scenario import Scenario

PREFIX = "Demonstrator"
"""Of the definitions that the demonstrator's scenario brings along: both kinds of scenarios may use a name."""


def landing_schema() -> str:
    """The schema as JSON text: the landing's own keys, and under `demonstrator` what may replace values of `base`."""
    schema = Landing.model_json_schema()
    demonstrator = Scenario.model_json_schema(ref_template=f"#/$defs/{PREFIX}{{model}}")
    definitions = {f"{PREFIX}{name}": d for name, d in demonstrator.pop("$defs").items()}
    for part in (demonstrator, *definitions.values()):
        # Only some values are replaced: what is missing stands in the base.
        part.pop("required", None)
    demonstrator["title"] = "Demonstrator"
    demonstrator["description"] = "Values that replace those of the scenario `base`."
    properties: dict[str, Any] = {**schema["properties"], "demonstrator": {"$ref": f"#/$defs/{PREFIX}"}}
    definitions = {**schema.get("$defs", {}), PREFIX: demonstrator, **definitions}
    return json.dumps({**schema, "properties": properties, "$defs": definitions}, indent=2, ensure_ascii=False)
