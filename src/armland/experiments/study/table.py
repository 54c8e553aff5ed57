"""A study as a table: one scenario, and what is changed in it, one thing at a time."""

from collections.abc import Callable, Mapping
from typing import Any, NamedTuple

from armland.errors import ConfigurationError
from armland.experiments.campaign.description import Description, Variant
from armland.scenario import Scenario

Values = Mapping[str, Any]
"""What a scenario has instead, by dotted path."""


class Change(NamedTuple):
    """One thing that is changed."""

    name: str
    group: str
    """What it is a change of: those of one group stand together in a figure."""
    means: str
    """What that is, in words."""
    values: Values | Callable[[Scenario], Values]
    """What is set instead; a function where that depends on the scenario's hardware."""

    def of(self, scenario: Scenario) -> dict[str, Any]:
        """What is set in this scenario."""
        return dict(self.values(scenario) if callable(self.values) else self.values)


class Study(NamedTuple):
    """A question that one campaign answers."""

    name: str
    title: str
    usual: str
    """Name of the scenario as it is, with which each change is compared."""
    removes: bool
    """Whether a change takes away what the scenario has, and what is asked is what that gives; else what the change gives."""
    changes: tuple[Change, ...]


def chosen(study: Study, names: str | None) -> Study:
    """The study with the changes that are named, by commas, alone; all of them if absent.

    Raises:
        ConfigurationError: a name that it does not have; the message says which it has.
    """
    if names is None:
        return study
    wanted = [name.strip() for name in names.split(",") if name.strip()]
    known = {change.name: change for change in study.changes}
    if not wanted or (unknown := [name for name in wanted if name not in known]):
        odd = f"{unknown[0]!r} is none" if wanted else "it names nothing"
        raise ConfigurationError(f"--only {names!r}: {odd}; {study.name} has: {', '.join(known)}")
    return study._replace(changes=tuple(known[name] for name in dict.fromkeys(wanted)))


def describe(study: Study, scenario: Scenario, file: str, first: int) -> Description:
    """The campaign of a study.

    Args:
        study: what is asked.
        scenario: which is changed.
        file: its name.
        first: seed of the first flight.
    """
    variants = (Variant(name=study.usual), *(Variant(name=c.name, values=c.of(scenario)) for c in study.changes))
    return Description(title=study.title, mission="landing", scenario=file, first_seed=first, variants=variants)
