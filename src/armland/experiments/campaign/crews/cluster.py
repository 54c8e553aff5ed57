"""A crew of a Ray cluster: the same flights on other machines, which need armland of the same version.

The store stays with who started the campaign. Where the cluster is lost, the campaign ends with what it has, and `--resume` goes on.
"""

import json
import logging
import socket
from collections.abc import Iterator
from functools import partial
from itertools import islice
from typing import Any

from armland.errors import ClusterError, ConfigurationError
from armland.experiments.campaign.crews.threads import Crew, Work
from armland.experiments.campaign.rows import Job, Row, Task, lost
from armland.experiments.campaign.versions import versions

AHEAD = 2
"""Flights in hand for each of the cluster's processors: one flies, one waits."""


PATIENCE_S = 5.0
"""How long an address may take to answer."""


def cluster(address: str, jobs: int | None = None) -> Crew:
    """The crew of the cluster at `address`, or of this machine alone where that is `local`, `jobs` at a time, all processors if absent.

    Raises:
        ConfigurationError: Ray is not installed, or there is no cluster.
    """
    try:
        import ray
    except ImportError as e:
        raise ConfigurationError("--ray needs Ray: install armland[cluster]") from e
    if not _answers(address):
        raise _nobody(address, f"nobody answers within {PATIENCE_S:g} s")
    _join(address, jobs)
    return partial(_by_ray, address, jobs or max(int(ray.cluster_resources().get("CPU", 1)), 1))


def _join(address: str, jobs: int | None) -> None:
    import ray

    where: dict[str, Any] = {"num_cpus": jobs} if address == "local" else {"address": address}
    try:
        ray.init(
            **where,
            log_to_driver=False,
            logging_level=logging.ERROR,
            include_dashboard=False if address == "local" else None,
        )
    except (ConnectionError, ValueError, RuntimeError, TimeoutError) as e:
        first = (str(e).strip().splitlines() or [type(e).__name__])[0]
        raise _nobody(address, first[:200]) from e


def _nobody(address: str, why: str) -> ConfigurationError:
    hint = "`ray start --head` begins one, and `--ray local` needs none"
    return ConfigurationError(f"--ray {address!r}: no cluster there ({why}); {hint}")


def _answers(address: str) -> bool:
    # Ray itself tries for minutes. What is no address with a port is for Ray to find.
    host, _, port = address.rpartition("//")[2].rpartition(":")
    if not host or not port.isdigit():
        return True
    try:
        with socket.create_connection((host, int(port)), timeout=PATIENCE_S):
            return True
    except (OSError, OverflowError):
        return False


def _remote(work: Work, job: Job, task: Task, made: str) -> Row | str:
    # On the cluster: a row, or the versions of armland and its packages there if they are others.
    here = json.dumps(versions(), sort_keys=True)
    return here if here != made else work(job, task)


def _by_ray(address: str, jobs: int, work: Work, job: Job, tasks: Iterator[Task]) -> Iterator[Row]:
    import ray
    from ray.exceptions import RayError, RayTaskError, WorkerCrashedError

    # A crew that was called before has left the cluster.
    if not ray.is_initialized():
        _join(address, jobs)
    made = json.dumps(versions(), sort_keys=True)
    # Ray flies a task of a worker that dies once more by itself.
    fly = ray.remote(num_cpus=1, max_retries=1)(_remote)
    common = ray.put(job)
    under_way = {fly.remote(work, common, task, made): task for task in islice(tasks, AHEAD * jobs)}
    try:
        while under_way:
            (done, *_), _ = ray.wait(list(under_way), num_returns=1)
            task = under_way.pop(done)
            try:
                row = ray.get(done)
            except WorkerCrashedError as e:
                row = lost(task, f"its worker died, twice over: {str(e).splitlines()[0]}")
            if isinstance(row, str):
                raise ConfigurationError(
                    f"the cluster has other versions: {row} there, {made} here; a row must not depend on who flies it"
                )
            for following in islice(tasks, 1):
                under_way[fly.remote(work, common, following, made)] = following
            yield row
    except RayTaskError as e:
        raise ClusterError(f"the cluster cannot fly: {str(e).strip().splitlines()[-1]}") from e
    except RayError as e:
        raise ClusterError(
            f"the cluster is lost ({type(e).__name__}); rows that were written stay, and --resume goes on"
        ) from e
    finally:
        ray.shutdown()
