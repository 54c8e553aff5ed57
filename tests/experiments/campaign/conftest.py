"""Cheap work in the place of flights, in a module that other processes find, and a campaign of it."""

import importlib
import sys

import pytest

FAKES = """
import os, signal, time
from pathlib import Path

from armland.experiments.campaign.rows import Row


def quick(job, task):
    time.sleep(0.003)
    result = {"seed": task.seed, "success": task.seed % 7 != 3, "reason": "made up", "hinge_force_max_n": float(task.seed)}
    return Row(*task, success=result["success"], outcome="done", result=result, digest=f"{task.seed:032x}")


def deadly(job, task):
    if task.run == 5:
        os.kill(os.getpid(), signal.SIGKILL)
    return quick(job, task)


def mortal(job, task):
    # Dies over one flight, the first time.
    mark = Path(job.mission)
    if task.run == 5 and not mark.exists():
        mark.write_text("dead")
        os.kill(os.getpid(), signal.SIGKILL)
    return quick(job, task)


def endless(job, task):
    Path(job.mission, str(os.getpid())).touch()
    time.sleep(1000.0)


def tailed(job, task):
    # Its hinge force is the drawn value `a`.
    result = {"seed": task.seed, "success": True, "reason": "made up", "hinge_force_max_n": task.values["a"]}
    return Row(*task, success=True, outcome="done", result=result, digest=f"{task.seed:032x}")


def lucky(job, task):
    # Its seed alone decides.
    row = tailed(job, task)
    row.result["hinge_force_max_n"] = 100.0 * (task.seed * 0.6180339887498949 % 1.0)
    return row


def hasty(job, task):
    # Successes take longer than failures do.
    row = quick(job, task)
    time.sleep(0.02 if row.success else 0.0)
    return row
"""


@pytest.fixture
def fakes(tmp_path, monkeypatch):
    folder = tmp_path / "modules"
    folder.mkdir()
    (folder / "fakes.py").write_text(FAKES)
    monkeypatch.syspath_prepend(folder)
    sys.modules.pop("fakes", None)
    return importlib.import_module("fakes")


@pytest.fixture
def described():
    """A campaign's description from TOML."""
    import tomllib

    from armland.experiments.campaign.description import Description, dotted
    from armland.scenario.tables import as_json

    return lambda text="": Description.model_validate_json(as_json(dotted(tomllib.loads(text))))


@pytest.fixture
def made_up(described):
    """A campaign that flies nothing of armland; `mission` is what the fakes are told."""
    from armland.experiments.campaign.engine import Campaign
    from armland.experiments.campaign.rows import Job

    def make(runs, text="", mission="landing", scenario='{"values": {"air": {"wind_mps": 0.0}}}'):
        return Campaign(described(text), Job(scenario, mission), runs, {"hinge_force_max_n": 50.0})

    return make
