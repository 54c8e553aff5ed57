"""Findings that are made up."""

import pytest

from armland.experiments.campaign.answers.paired import Difference
from armland.experiments.campaign.answers.report import PointReport
from armland.experiments.campaign.stopping import Interval
from armland.experiments.study.answer import Findings, Gain
from armland.experiments.study.table import Change, Study


@pytest.fixture
def findings():
    """Of name -> (group, gain, half width, raised chance, more misses, flights that are the same)."""

    def make(told, removes=False, least=0.15):
        def gain(name, group, value, half, raised, misses, same=0):
            rate = Difference("success", value, value - half, value + half, 40)
            more = Difference("misses", misses, misses - 0.1, misses + 0.1, 40)
            only = (2, 2 + round(40 * value)) if value >= 0 else (2 - round(40 * value), 2)
            return Gain(name, group, name, 40, 30, Interval(0.6, 0.86), rate, *only, raised / 2, raised, more, same)

        gains = tuple(gain(name, *rest) for name, rest in told.items())
        changes = tuple(Change(g.name, g.group, g.means, {}) for g in gains)
        study = Study("made", "Made up", "as it is", removes, changes)
        usual = PointReport(0, "as it is", 40, 30, Interval(0.6, 0.86), Interval(0.5, 0.9), ())
        return Findings(study, usual, gains, least)

    return make
