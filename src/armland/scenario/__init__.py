"""What a scenario holds, and how it is loaded."""

from armland.scenario.files.loading import SCENARIOS, load_scenario
from armland.scenario.files.schema import schema
from armland.scenario.tree import Scenario

__all__ = ["SCENARIOS", "Scenario", "load_scenario", "schema"]
