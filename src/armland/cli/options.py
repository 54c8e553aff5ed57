"""Arguments and options that several commands share, and the scenario that they make together."""

import inspect
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from armland.errors import ConfigurationError
from armland.scenario.deviation import Level
from armland.scenario.environment import MEASURED
from armland.scenario.tables import update


def parse_settings(settings: list[str]) -> dict[str, Any]:
    """Nested values of settings such as `place.catch_m=[0.6, 0.0, 0.86]`; a later one replaces an earlier one.

    Raises:
        ConfigurationError: no key, or a value that is not TOML; all of them.
    """
    data: dict[str, Any] = {}
    problems = []
    for text in settings:
        try:
            update(data, _parse(text))
        except ConfigurationError as e:
            problems.append(str(e))
    if problems:
        raise ConfigurationError("\n  ".join(problems))
    return data


def _parse(text: str) -> dict[str, Any]:
    key, equals, value = text.partition("=")
    if not equals or not key.strip():
        raise ConfigurationError(f"--set {text!r}: expected KEY=VALUE, e.g. place.catch_m='[0.6, 0.0, 0.86]'")
    try:
        found = tomllib.loads(f"{key} = {value}")
    except tomllib.TOMLDecodeError as e:
        raise ConfigurationError(
            f"--set {text!r}: {value.strip()!r} is not a value of TOML, or {key.strip()!r} no dotted key ({e}); text needs "
            f"quotes of its own, e.g. title='\"calm\"'"
        ) from e
    if len(found) != 1:
        raise ConfigurationError(f"--set {text!r}: one key and one value; repeat --set for more")
    return found


if TYPE_CHECKING:
    from armland.scenario import Scenario

Parameter = tuple[Any, Any]  # Annotation and default of a parameter of a command

SCENARIO_HELP = "Scenario (TOML), or the name of one that comes with armland."


def option(kind: Any, words: str, *names: str, default: Any = None, **more: Any) -> Parameter:
    """An option with the help `words`; `names` where it is not called as its parameter, `more` as for `typer.Option`."""
    return Annotated[kind, typer.Option(*names, help=words, **more)], default


def argument(kind: Any, words: str, default: Any = None, **more: Any) -> Parameter:
    """An argument with the help `words`; `more` as for `typer.Argument`."""
    return Annotated[kind, typer.Argument(help=words, **more)], default


def scenario(name: str) -> Parameter:
    """The argument SCENARIO, `name` if absent."""
    return argument(str, SCENARIO_HELP, name, metavar="SCENARIO")


def out(folder: str) -> Parameter:
    """The option `--out` with its default."""
    words = f"Folder for figures, logs and results; out/{folder} if absent."
    return option(Path, words, default=None if folder == "MISSION" else Path("out") / folder)


AS_JSON = option(bool, "Print the result alone on standard output, as JSON.", "--json", default=False)
SEED = option(int | None, "Seed of every random stream, the scenario's if absent; the first of a campaign.", min=0)
LAW = option(str | None, "Law of the UAV: classical, paper, exact, or your own as FILE.py:FUNCTION.", metavar="LAW")
SETTINGS = option(
    list[str] | None,
    "Replace a value of the scenario: dotted key, value as in TOML. Repeatable.",
    "--set",
    metavar="KEY=VALUE",
)

OF_ARM = {
    "ee": option(
        str | None,
        "Link, body or site of the arm that carries the tool, z outwards; FRAME:x where x points outwards. Chosen if absent.",
        "--ee",
        metavar="FRAME[:AXIS]",
    ),
    "lock": option(
        list[str] | None, "Let a joint stand still: NAME=VALUE, rad or m. Repeatable.", "--lock", metavar="NAME=VALUE"
    ),
    "torque_limits": option(
        str | None, "Torque limit of each joint, N·m, by commas, where the file has none or others."
    ),
}
"""Options that say more about an arm than its file."""

DEVIATION = option(
    Level | None,
    "How far the plant differs from what the controller believes: nominal, mild (half the published ranges), published, harsh "
    "(twice). If absent the scenario's own level; what flies without one flies published.",
    metavar="LEVEL",
)

ARM = {
    "arm": option(
        str | None,
        "Another serial arm: URDF or MJCF file, or a name that mujoco-menagerie or robot_descriptions has. Its pose at the start is "
        "searched for.",
        metavar="FILE|NAME",
    ),
    **OF_ARM,
}
"""Options that say which arm, and what of it."""

UAV = option(
    str | None,
    "Another UAV: a TOML, MJCF or URDF file, or the name of one that comes with armland (crazyflie, ardrone2, "
    "ardrone2_bench, pelican, x500, neo11, m690, hexa10, octo25).",
    metavar="FILE|NAME",
)

MADE = {
    "seed": SEED,
    "settings": SETTINGS,
    "uav": UAV,
    **ARM,
}
"""Options that a scenario is made by, see `load`."""

FIGURES = option(
    bool, "Draw the figures, and write the report where the command has one.", "--figures/--no-figures", default=True
)

SHOWN = {"as_json": AS_JSON, "figures": FIGURES}
"""Options that say how a result is shown."""

FLOWN = {
    "law": LAW,
    "deviation": DEVIATION,
    "wind": option(
        float | None, "Mean wind in m/s at 20 ft, with the turbulence that goes with it; see docs/air.md.", min=0.0
    ),
    "wind_trace": option(
        Path | None, "Recorded wind at the UAV instead: CSV with time_s, x, y, z in m/s, world axes.", metavar="FILE"
    ),
    "sea": option(
        str | None,
        "Sea state 0 to 4: the deck moves as a hull in waves does; tank, usv: as a platform and a small vessel that were measured; see "
        "docs/sea.md.",
        metavar="0-4|tank|usv",
    ),
    "hull": option(float | None, "Length in m of the hull that carries the arm, 4 if absent.", metavar="M"),
    "sea_trace": option(
        Path | None,
        "Recorded motion of the deck instead: CSV with time_s, heave_m, roll_deg and so on.",
        metavar="FILE",
    ),
    "operator": option(
        Path | None,
        "What somebody steered by hand is done again: the log of a console (MCAP), or a line of JSON for each message.",
        metavar="FILE",
    ),
    "seeds": option(int, "Fly this many seeds and print how many succeed.", default=1, min=1, max=1_000_000),
    "jobs": option(int | None, "Flights of a campaign at a time; one per core if absent.", min=1, max=1000),
    **MADE,
    **SHOWN,
    "film": option(bool, "Make a short film of a single flight, film.mp4.", "--film", default=False),
    "log": option(bool, "Write the run log (MCAP) of a single flight.", "--log/--no-log", default=True),
}
"""Options of a command that flies."""


def taken(epilog: str, **parameters: Parameter) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command, which takes them as `**given`, these parameters: annotation and default by name; `epilog` ends its help."""

    def give(command: Callable[..., None]) -> Callable[..., None]:
        kind = inspect.Parameter.KEYWORD_ONLY
        made = [inspect.Parameter(n, kind, default=d, annotation=a) for n, (a, d) in parameters.items()]
        vars(command)["__signature__"], vars(command)["epilog"] = inspect.Signature(made), epilog
        command.__annotations__ = {name: annotation for name, (annotation, _) in parameters.items()}
        return command

    return give


def arm_settings(given: dict[str, Any]) -> dict[str, Any]:
    """The keys of `[arm]` that the options of `OF_ARM` set.

    Raises:
        ConfigurationError: a `--lock` or `--torque-limits` that cannot be read.
    """
    out: dict[str, Any] = {} if given.get("ee") is None else {"ee": given["ee"]}
    for text in given.get("lock") or []:
        name, equals, value = text.rpartition("=")
        try:
            out.setdefault("lock", {})[name.strip()] = float(value)
        except ValueError:
            equals = ""
        if not equals or not name.strip():
            raise ConfigurationError(f"--lock {text!r}: expected NAME=VALUE, rad or m, e.g. rail=0.2")
    limits = given.get("torque_limits")
    if limits is not None:
        try:
            out["torque_limits_nm"] = [float(x) for x in limits.replace(",", " ").split()]
        except ValueError as e:
            raise ConfigurationError(
                f"--torque-limits {limits!r}: expected numbers by commas, e.g. 87,87,87,87,12,12,12"
            ) from e
    return out


def sea_settings(given: dict[str, Any]) -> dict[str, Any]:
    """The keys of `[sea]` that `--sea`, `--hull` and `--sea-trace` set.

    Raises:
        ConfigurationError: a sea state that there is not.
    """
    out: dict[str, Any] = {}
    if (state := given.get("sea")) is not None:
        numbered = {str(i): f"ss{i}" for i in range(1, 5)}
        known = {"0": "calm", **numbered, **{name: name for name in ("calm", *numbered.values(), *MEASURED)}}
        if state not in known:
            raise ConfigurationError(
                f"--sea {state!r}: sea states are 0 (calm) to 4 or ss1 to ss4, or tank and usv: decks that were measured"
            )
        out["state"] = known[state]
    if given.get("hull") is not None:
        out["hull_m"] = float(given["hull"])
    if given.get("sea_trace") is not None:
        out["trace"] = str(given["sea_trace"].resolve())
    return {"sea": out} if out else {}


def load(name: str, given: dict[str, Any]) -> "Scenario":
    """The scenario `name` with what the command line replaces.

    Args:
        name: file, or name of one that comes with armland.
        given: options of `MADE`, and `DEVIATION` and those of wind and sea where the command has them; nested `overrides`.

    Raises:
        ConfigurationError: all that is wrong with it.
    """
    from armland.cli.options import parse_settings
    from armland.scenario import load_scenario
    from armland.scenario.tables import update

    overrides: dict[str, Any] = {}
    arm, seed = given.get("arm"), given.get("seed")
    if arm is not None:
        from armland.models.arm_file.names import arm_path

        overrides = {"arm": {"file": str(arm_path(arm))}}
    if changed := arm_settings(given):
        update(overrides, {"arm": changed})
    if given.get("deviation") is not None:
        update(overrides, {"deviation": {"level": given["deviation"]}})
    if given.get("wind") is not None:
        turbulence = {"turbulence": "by_wind"} if given["wind"] > 0.0 else {}
        update(overrides, {"air": {"wind_mps": float(given["wind"]), **turbulence}})
    if given.get("wind_trace") is not None:
        update(overrides, {"air": {"trace": str(given["wind_trace"].resolve())}})
    update(overrides, sea_settings(given))
    if given.get("uav") is not None:
        from armland.scenario.files.airframe import find_airframe

        update(overrides, {"airframe": str(find_airframe(given["uav"]))})
    update(overrides, parse_settings(given.get("settings") or []))
    update(overrides, given.get("overrides") or {})
    loaded = load_scenario(name, overrides)
    return loaded if seed is None else loaded.with_seed(seed)


def load_flown(mission: str, name: str, given: dict[str, Any]) -> "Scenario":
    """The scenario `name` as it is flown where a mission is asked for: what flies freely deviates as sources say, unless the user says
    otherwise; arguments and errors as for `load`."""
    from armland.mission.registry import mission_named

    hinged = mission_named(mission).start == "hinged"
    loaded = load(name, given)
    if not hinged and "deviation.level" not in loaded.own:
        # A demonstrator differs from what is believed of it. The log says so.
        loaded = load(name, {**given, "deviation": "published"})
    return loaded
