"""A study of rows that are made up: how its changes do is known beforehand."""

import pytest

from armland.experiments.campaign.answers.report import report
from armland.experiments.campaign.crews.threads import threads
from armland.experiments.campaign.engine import Campaign, conduct
from armland.experiments.campaign.rows import Job, Row
from armland.experiments.campaign.store import Store
from armland.experiments.study.answer import answer
from armland.experiments.study.table import Change, Study, describe

SCENARIO = '{"values": {"air": {"wind_mps": 0.0}}}'


def outcome(job, task):
    """A flight whose value `bad` makes each third seed fail, whose value `good` mends each fourth, and which misses `misses` plates."""
    fails = task.seed % 4 == 1 and not task.values.get("good")
    fails = fails or (task.seed % 3 == 0 and bool(task.values.get("bad")))
    result = {"seed": task.seed, "success": not fails, "reason": "made up", "state": "standing"}
    result |= {"retries": task.values.get("misses", 1) + task.seed % 2}
    return Row(*task, success=not fails, outcome="done", result=result, digest=f"{task.seed} {task.values}")


@pytest.fixture
def made():
    """A study by its changes: name -> values."""

    def make(changes, removes=False):
        return Study("made", "Made up", "as it is", removes, tuple(Change(n, n[:3], n, v) for n, v in changes.items()))

    return make


@pytest.fixture
def found(tmp_path):
    """What a study of rows that are made up found, flown with so many seeds from 0 on."""

    def find(study, runs):
        campaign = Campaign(describe(study, None, "landing", 0), Job(SCENARIO, "landing"), runs, {})
        with Store(tmp_path / "a.sqlite", write=True) as store:
            conduct(campaign, store, threads(1), work=outcome)
            return answer(study, report(store)[0], store)

    return find
