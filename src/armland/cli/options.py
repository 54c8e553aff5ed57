"""Arguments and options that several commands share, and the scenario that they make together."""

import inspect
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from armland.errors import ConfigurationError

if TYPE_CHECKING:
    from armland.scenario import Scenario

SCENARIO_HELP = "Scenario (TOML), or the name of one that comes with armland."

AsJson = Annotated[bool, typer.Option("--json", help="Print the result alone on standard output, as JSON.")]
Figures = Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figures.")]
Settings = Annotated[
    list[str] | None,
    typer.Option(
        "--set", metavar="KEY=VALUE", help="Replace a value of the scenario: dotted key, value as in TOML. Repeatable."
    ),
]
Seed = Annotated[
    int | None,
    typer.Option(min=0, help="Seed of every random stream, the scenario's if absent; the first of a campaign."),
]
Law = Annotated[
    str | None,
    typer.Option(metavar="LAW", help="Law of the UAV: classical, paper, exact, or your own as FILE.py:FUNCTION."),
]


def out(folder: str) -> Any:
    """The option `--out` with its default."""
    return Annotated[Path, typer.Option(help=f"Folder for figures, logs and results; out/{folder} if absent.")]


def scenario(name: str) -> tuple[Any, str]:
    """The argument SCENARIO, `name` if absent."""
    return Annotated[str, typer.Argument(metavar="SCENARIO", help=SCENARIO_HELP)], name


MADE: dict[str, tuple[Any, Any]] = {
    "seed": (Seed, None),
    "settings": (Settings, None),
    "arm": (
        Annotated[
            Path | None,
            typer.Option(help="Another serial arm: URDF or MJCF file. Its pose at the start is searched for."),
        ],
        None,
    ),
    "ee": (
        Annotated[
            str | None,
            typer.Option("--ee", help="Link, body or site of the arm that carries the tool, z outwards."),
        ],
        None,
    ),
}
"""Options that a scenario is made by, see `load`."""

SHOWN: dict[str, tuple[Any, Any]] = {"as_json": (AsJson, False), "figures": (Figures, True)}
"""Options that say how a result is shown."""

FLOWN: dict[str, tuple[Any, Any]] = {
    "law": (Law, None),
    "seeds": (
        Annotated[int, typer.Option(min=1, max=1_000_000, help="Fly this many seeds and print how many succeed.")],
        1,
    ),
    "jobs": (
        Annotated[
            int | None, typer.Option(min=1, max=1000, help="Flights of a campaign at a time; one per core if absent.")
        ],
        None,
    ),
    **MADE,
    **SHOWN,
    "log": (Annotated[bool, typer.Option("--log/--no-log", help="Write the run log (MCAP) of a single flight.")], True),
}
"""Options of a command that flies."""


def taken(**parameters: tuple[Any, Any]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Give a command, which takes them as `**given`, these parameters: annotation and default by name."""

    def give(command: Callable[..., None]) -> Callable[..., None]:
        kind = inspect.Parameter.KEYWORD_ONLY
        made = [inspect.Parameter(n, kind, default=d, annotation=a) for n, (a, d) in parameters.items()]
        command.__signature__ = inspect.Signature(made)  # type: ignore[attr-defined]
        command.__annotations__ = {name: annotation for name, (annotation, _) in parameters.items()}
        return command

    return give


def load(name: str, given: dict[str, Any], hinged: bool = False) -> "Scenario":
    """The scenario `name` with what the command line replaces.

    Args:
        name: file, or name of one that comes with armland.
        given: options of `MADE`.
        hinged: whether the mission begins with the UAV on the arm, at the start of a path, or at a place of its own.

    Raises:
        ConfigurationError: all that is wrong with it.
    """
    from armland.cli.settings import parse_settings
    from armland.scenario import load_scenario
    from armland.scenario.tables import update

    overrides: dict[str, Any] = {}
    arm, ee, seed = given.get("arm"), given.get("ee"), given.get("seed")
    if arm is not None:
        if not arm.is_file():
            raise ConfigurationError(f"--arm {str(arm)!r}: there is no such file")
        part = {"file": str(arm.resolve()), "ee": ee or "flange", "elbow_joint": None, "home_rad": None}
        # Where the LWR stands says nothing about where another arm should.
        overrides = {"arm": part, **({"trajectory": {"start_m": None}} if hinged else {"place": {"home_deg": None}})}
    elif ee is not None:
        overrides = {"arm": {"ee": ee}}
    update(overrides, parse_settings(given.get("settings") or []))
    loaded = load_scenario(name, overrides)
    return loaded if seed is None else loaded.with_seed(seed)
