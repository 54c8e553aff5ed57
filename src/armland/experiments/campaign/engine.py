"""A campaign from its description to a store full of rows: begun, gone on with, stopped when enough is known."""

import hashlib
import json
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from armland.errors import ConfigurationError
from armland.experiments.campaign.crews.threads import Crew, Work, threads
from armland.experiments.campaign.description import Description
from armland.experiments.campaign.design import Schedule
from armland.experiments.campaign.flight import attempt
from armland.experiments.campaign.rows import Job, Row, Task
from armland.experiments.campaign.stopping import Watch
from armland.experiments.campaign.store import Store
from armland.experiments.campaign.versions import versions
from armland.scenario import Scenario
from armland.scenario.tables import leaves

Told = Callable[[Row], None]
"""Called with each row when it is in the store."""


class Campaign(NamedTuple):
    """What is flown, how often, and what the rows are told about it."""

    description: Description
    job: Job
    runs: int
    """Flights of each point."""
    bounds: dict[str, float]
    """Of figures, see `judge.figures.bounds`."""
    rare: bool = False
    """Whether flights are drawn nearer to the failures, see `rare.search`."""

    @property
    def schedule(self) -> Schedule:
        """All its flights."""
        return Schedule(self.description, self.runs)

    def about(self) -> dict[str, Any]:
        """What its store says about it."""
        return {
            "description": json.loads(self.description.model_dump_json(exclude_none=True)),
            "job": self.job._asdict(),
            "runs": self.runs,
            "bounds": self.bounds,
            "rare": self.rare,
            "files": files_of(self.job),
            "versions": versions(),
        }


def campaign_of(about: dict[str, Any]) -> Campaign:
    """The campaign of which a store says `about`."""
    description = Description.model_validate_json(json.dumps(about["description"]))
    return Campaign(description, Job(**about["job"]), about["runs"], about["bounds"], about.get("rare", False))


def conduct(
    campaign: Campaign,
    store: Store,
    crew: Crew,
    until: float | None = None,
    told: Told = lambda _: None,
    work: Work = attempt,
) -> Watch:
    """Fly what the store lacks, and add each row to it as it is done; rows that are there are not flown again.

    Args:
        campaign: what is flown.
        store: open for writing, empty or of the same campaign.
        crew: who flies.
        until: half width of the rates' intervals, a ratio, at which to stop; None: at the end.
        told: called with each row that is new.
        work: makes the row of a task.

    Returns:
        What the rows count so far.

    Raises:
        ConfigurationError: the store is of another campaign.
        StoreError: the disk takes no more; all rows before are there.
        ClusterError: there is nobody to fly.
    """
    begin(campaign, store)
    if until is not None and campaign.description.drawn and campaign.description.design != "random":
        raise ConfigurationError(
            f"--until needs flights that are drawn independently, and those of design = {campaign.description.design!r} are not; "
            "design = 'random' works"
        )
    store.describe({"until": until})
    schedule, made = campaign.schedule, json.dumps(versions(), sort_keys=True)
    watch = Watch(len(schedule.points), until)
    flown = set()
    for run, success in store.outcomes():
        flown.add(run)
        watch.add(run, success)

    def wanted() -> Iterator[Task]:
        for task in schedule.tasks(flown):
            if watch.enough:
                return
            yield task

    for row in crew(work, campaign.job, wanted()):
        store.add(row, made)
        watch.add(row.run, row.success)
        told(row)
    return watch


def begin(campaign: Campaign, store: Store) -> None:
    """Make the store one of this campaign, or check that it is.

    Raises:
        ConfigurationError: it is of another campaign, scenario or version; the message names both.
    """
    there, here = store.about, json.loads(json.dumps(campaign.about()))
    if not there:
        store.describe(here)
        return
    for about in (there, here):
        # Comments in a scenario's file fly nothing.
        scenario = json.loads(about["job"]["scenario"])
        about["job"]["scenario"] = json.dumps({name: v for name, v in scenario.items() if name != "_text"})
    for name, what in (
        ("versions", "version"),
        ("files", "contents of the scenario's files"),
        ("job", "scenario"),
        ("description", "file"),
    ):
        if there[name] != here[name]:
            raise ConfigurationError(
                f"{store.file} is of another {what}: {_difference(there[name], here[name])}; name another --out"
            )
    if there.get("rare", False) != here["rare"]:
        which = ("without", "with") if here["rare"] else ("with", "without")
        raise ConfigurationError(f"{store.file} was flown {which[0]} --rare, not {which[1]}; name another --out")
    if there["runs"] != here["runs"]:
        if campaign.description.design == "latin" and campaign.description.drawn:
            raise ConfigurationError(
                f"{store.file} is a Latin hypercube of {there['runs']} runs, and a hypercube cannot be made larger; "
                f"--runs {there['runs']} goes on with it"
            )
        if here["runs"] < there["runs"]:
            raise ConfigurationError(
                f"{store.file} is of --runs {there['runs']}, more than {here['runs']}; leave out --runs to go on with it"
            )
        store.describe({"runs": here["runs"]})


def _difference(there: Any, here: Any) -> str:
    # The first few values that differ, by path.
    def flat(data: Any) -> dict[str, Any]:
        data = dict(data)
        for name, value in data.items():
            if isinstance(value, str) and value.startswith("{"):
                data[name] = json.loads(value)
        out: dict[str, Any] = {}
        for path in leaves(data):
            node: Any = data
            for step in _steps(node, path):
                node = node[step]
            out[path.removeprefix("scenario.values.")] = node
        return out

    a, b = flat(there), flat(here)
    lines = [
        f"{path} = {_short(a.get(path))} there, {_short(b.get(path))} here"
        for path in sorted(a.keys() | b.keys())
        if a.get(path) != b.get(path) and not path.startswith("scenario._")
    ]
    shown = lines[:5] or ["it was made from other files or options"]
    return "; ".join([*shown, *([f"and {len(lines) - 5} more"] if len(lines) > 5 else [])])


def _steps(data: Any, path: str) -> list[str]:
    # Keys of a description's parameters hold dots themselves: the longest key that fits is the next step.
    steps, rest = [], path
    while rest:
        key = next(k for k in sorted(data, key=len, reverse=True) if rest == k or rest.startswith(f"{k}."))
        steps.append(key)
        data, rest = data[key], rest[len(key) + 1 :]
    return steps


def _short(value: Any) -> str:
    text = "nothing" if value is None else json.dumps(value)
    return text if len(text) <= 60 else text[:57] + "..."


def files_of(job: Job) -> dict[str, str]:
    """Digests of the files that a job's scenario and law name, by path."""
    tables = json.loads(job.scenario)["values"]
    out: dict[str, str] = {}

    def look(value: Any) -> None:
        if isinstance(value, dict | list):
            for inner in value.values() if isinstance(value, dict) else value:
                look(inner)
        elif isinstance(value, str) and "/" in value:
            for name in (value, value.rpartition(":")[0]):
                if name and Path(name).is_file():
                    out[name] = hashlib.sha256(Path(name).read_bytes()).hexdigest()[:16]

    look([tables, job.law or ""])
    return out


def campaign(
    scenario: Scenario,
    mission: str,
    seeds: Iterable[int],
    jobs: int = 1,
    law: str | None = None,
    experiment: str | None = None,
) -> list[dict[str, Any]]:
    """Fly a scenario with many seeds on threads; the results in the order of the seeds, kept nowhere.

    A flight that breaks is a row too, with its error as reason.

    Args:
        scenario: of all flights.
        mission: name of the mission.
        seeds: which; the same seed gives the same row, alone or with others.
        jobs: threads.
        law: row of the law table instead of the mission's own.
        experiment: row of the scenario's experiments, for missions that fly one.
    """
    job = Job(scenario.frozen(), mission, law, experiment)
    tasks = (Task(run, 0, seed, {}) for run, seed in enumerate(seeds))
    return [row.judged() for row in sorted(threads(jobs)(attempt, job, tasks), key=lambda row: row.run)]
