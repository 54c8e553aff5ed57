"""Many episodes over the threads of one process: the compiled loop releases Python's lock, and code is loaded once."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from armland.experiments.episode import attempt
from armland.scenario import Scenario


def campaign(
    scenario: Scenario,
    mission: str,
    seeds: Iterable[int],
    *,
    law: str | None = None,
    experiment: str | None = None,
    jobs: int | None = None,
    done: Callable[[dict[str, Any]], None] | None = None,
) -> list[dict[str, Any]]:
    """Fly many seeds; the results in the order of the seeds. A flight that breaks is a row too, with its error as reason.

    Args:
        scenario: of all flights.
        mission: name of the mission.
        seeds: which; the same seed gives the same row, alone or in a campaign.
        law: row of the law table instead of the mission's own.
        experiment: row of the scenario's experiments, for missions that fly one.
        jobs: threads; as many as there are cores if absent.
        done: called with each row, in the order of the seeds.
    """
    rows = []
    with ThreadPoolExecutor(jobs or os.cpu_count() or 1, "episode") as pool:
        flights = [pool.submit(attempt, scenario, mission, seed, law=law, experiment=experiment) for seed in seeds]
        for flight in flights:
            rows.append(flight.result())
            if done is not None:
                done(rows[-1])
    return rows
