"""The command that does a run again, from what its log says."""

import json
import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from armland.control.laws.settings import row_of
from armland.errors import ArmlandError
from armland.mission.registry import UNAIDED
from armland.runtime.recorder import SCENARIO_NAME
from armland.scenario import Scenario
from armland.scenario.files.loading import SCENARIOS
from armland.scenario.tables import leaves, take

NAMED = {"landing": "land", "takeoff": "takeoff"}
"""Missions with a command of their own."""

OPTIONS = {"deviation.level": "--deviation", "arm.file": "--arm", "airframe": "--uav"}
"""Keys of the scenario that an option sets."""


class Again(NamedTuple):
    """How to do it again."""

    command: str
    scenario: str
    """Text of the scenario's file where that is none which comes with armland; it has to be saved first."""


def own_scenario(mission: str, hinged: bool) -> str:
    """Name of the scenario that a mission is flown with where none is named."""
    return mission if mission in UNAIDED else "paper" if hinged else "landing"


def again(metadata: Mapping[str, str], attached: bytes | None, more: tuple[str, ...] = ()) -> Again:
    """The command that flies a run again.

    Args:
        metadata: of the log.
        attached: the scenario's file, as the log holds it.
        more: words of the command line beside those that the log knows, such as `--seeds 20`.
    """
    mission = metadata["mission"]
    default = own_scenario(mission, metadata.get("start") == "hinged")
    words = [NAMED[mission]] if mission in NAMED else ["run", mission]
    words += [name for name in (_file(attached),) if name != default]
    if metadata.get("experiment") and metadata["experiment"] != mission:
        words += ["--experiment", metadata["experiment"]]
    if _chosen_law(metadata):
        words += ["--law", metadata["law"]]
    return _again([*words, *_shared(metadata), *more], attached)


def study_again(metadata: Mapping[str, str], attached: bytes | None, default: str, more: tuple[str, ...] = ()) -> Again:
    """The command that does the paper's experiments or a comparison of laws again.

    Args:
        metadata: of a flight of it.
        attached: the scenario's file.
        default: the scenario where none is named.
        more: words of the command line beside those that the log knows, such as `--compare`.
    """
    named = [word for name in (_file(attached),) if name != default for word in ("--scenario", name)]
    return _again(["paper", *more, *named, *_shared(metadata)], attached)


def command_again(words: Sequence[str], scenario: Scenario, default: str, flag: str = "", seeded: bool = True) -> Again:
    """The command that does a study of a scenario again.

    Args:
        words: command and options that the scenario does not say.
        scenario: that was studied.
        default: the scenario where none is named.
        flag: option that names it; an argument where there is none.
        seeded: whether the command takes `--seed`.
    """
    attached, overrides = scenario.text.encode() or None, json.loads(scenario.overrides or "{}")
    own = overrides.get("run", {}).get("seed")
    named = [word for name in (_file(attached),) if name != default for word in (flag, name) if word]
    seed = ["--seed", str(scenario.run.seed)] if seeded else []
    seed += ["--set", f"run.seed={own}"] if own is not None and not seeded else []
    return _again([*words, *named, *seed, *_settings(overrides)], attached)


def _shared(metadata: Mapping[str, str]) -> list[str]:
    return ["--seed", metadata["seed"], *_settings(json.loads(metadata.get("overrides") or "{}"))]


def _again(words: list[str], attached: bytes | None) -> Again:
    command = " ".join(["armland", *(shlex.quote(word) for word in words)])
    own = attached is not None and _shipped(attached) is None
    return Again(command, attached.decode("utf-8", "replace") if own and attached is not None else "")


def _file(attached: bytes | None) -> str:
    # How the command line calls the scenario.
    return _shipped(attached) or SCENARIO_NAME


def _shipped(attached: bytes | None) -> str | None:
    # Name of the scenario that comes with armland and has this text.
    for path in sorted(SCENARIOS.glob("*.toml")):
        if attached is not None and path.read_bytes() == attached:
            return path.stem
    return None


def _chosen_law(metadata: Mapping[str, str]) -> bool:
    # Whether the command line chose the law: neither the scenario's own nor the mission's.
    if metadata["mission"] in UNAIDED:
        # It is always its own.
        return False
    scenario = json.loads(metadata.get("scenario") or "{}")
    row = scenario.get("experiments", {}).get(metadata.get("experiment") or "", {}).get("law", "exact")
    own = scenario.get("control", {}).get("law") or row
    try:
        return metadata["law"] != row_of(own).name
    except ArmlandError:
        # A law of the user's own whose file is elsewhere now.
        return False


def _settings(overrides: dict[str, Any]) -> list[str]:
    take(overrides, "run.seed")
    words = []
    for path in leaves(overrides):
        value = overrides
        for key in path.split("."):
            value = value[key]
        if value is None or value == {}:
            continue
        if path in OPTIONS:
            words += [OPTIONS[path], _short(str(value))]
        else:
            words += ["--set", f"{path}={toml(value)}"]
    return words


def _short(file: str) -> str:
    # What comes with armland is known by its name.
    return Path(file).stem if SCENARIOS.parent in Path(file).parents else file


def toml(value: Any) -> str:
    """A value of JSON as TOML."""
    if isinstance(value, dict):
        return f"{{{', '.join(f'{key} = {toml(inner)}' for key, inner in value.items() if inner is not None)}}}"
    if isinstance(value, list):
        return f"[{', '.join(toml(inner) for inner in value)}]"
    return json.dumps(value, ensure_ascii=False)
