"""One row of a campaign: a flight that is made, judged and summed up, with a digest of its ticks by which it is known again."""

import hashlib
import json
import threading
import time
from collections import OrderedDict
from pathlib import Path
from typing import Any

import numpy as np

from armland.errors import ConfigurationError
from armland.experiments.campaign.description import changes
from armland.experiments.campaign.rows import BROKE, REFUSED, Job, Row, Task
from armland.experiments.episode import Episode, Flight, fly_prepared, prepare
from armland.mission.plan import Plan
from armland.records import Records
from armland.scenario import Scenario
from armland.scenario.tables import update

KEPT_PLANS = 16
"""A plan holds an arm model of some 14 MB."""


class _Memory(threading.local):
    # Of each thread: the scenario of the job that it flies, and the plans of values that come again.
    def __init__(self) -> None:
        self.job: Job | None = None
        self.scenario: Scenario | None = None
        self.tables: dict[str, Any] = {}
        self.plans: OrderedDict[str, Plan | None] = OrderedDict()


_memory = _Memory()


def prepared(job: Job, task: Task) -> Flight:
    """The flight of a row, ready to be flown.

    Raises:
        ConfigurationError: what is refused.
    """
    m = _memory
    if m.job != job or m.scenario is None:
        m.job, m.scenario, m.plans = job, Scenario.thawed(job.scenario), OrderedDict()
        m.tables = json.loads(m.scenario.model_dump_json())
    key = json.dumps(task.values, sort_keys=True)
    wanted = changes(m.tables, task.values)
    update(wanted, {"run": {"seed": task.seed}})
    known = m.plans.get(key)
    flight = prepare(m.scenario.replaced(wanted), job.mission, law=job.law, experiment=job.experiment, known=known)
    # Values that come a second time come again; drawn ones never do. Where the place was searched for, another seed may find another.
    if known is None and not flight.moved:
        m.plans[key] = flight.plan if key in m.plans else None
        if len(m.plans) > KEPT_PLANS:
            m.plans.popitem(last=False)
    return flight


def flown(job: Job, task: Task, log: Path | None = None) -> tuple[Row, Episode]:
    """Fly the row `task`; `log` is the file of a run log where one is wanted.

    Raises:
        ConfigurationError: what is refused.
        PlantError: the simulated world broke.
    """
    wall, cpu = time.perf_counter(), time.thread_time()
    flight = prepared(job, task)
    episode = fly_prepared(flight, log)
    result = dict(episode.result)
    row = Row(
        *task,
        success=result["success"],
        outcome=result["end"],
        result=result,
        scenario=fingerprint(flight.scenario),
        digest=digest_of(episode.ticks),
        wall_s=time.perf_counter() - wall,
        cpu_s=time.thread_time() - cpu,
    )
    return row, episode


def attempt(job: Job, task: Task) -> Row:
    """The row of a flight, whatever happens in it."""
    begun, cpu = time.perf_counter(), time.thread_time()
    try:
        return flown(job, task)[0]
    except Exception as e:
        outcome = REFUSED if isinstance(e, ConfigurationError) else BROKE
        error = str(e) if outcome == REFUSED else f"{type(e).__name__}: {e}"
        wall_s, cpu_s = time.perf_counter() - begun, time.thread_time() - cpu
        return Row(*task, success=False, outcome=outcome, error=error, wall_s=wall_s, cpu_s=cpu_s)


def digest_of(ticks: Records) -> str:
    """32 hexadecimal digits that two records share only if they are the same bit for bit; `ticks` (k,) as `Episode.ticks`, SI units."""
    return hashlib.sha256(ticks.view(np.uint8).data).hexdigest()[:32]


def fingerprint(scenario: Scenario) -> str:
    """32 hexadecimal digits of all values of a scenario."""
    return hashlib.sha256(scenario.model_dump_json().encode()).hexdigest()[:32]
