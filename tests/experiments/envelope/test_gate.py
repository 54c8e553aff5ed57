"""Landings as flown, at the gate."""

import numpy as np
import pytest

from armland.experiments.envelope.gate import at_the_gate
from armland.models.capture import GATE_M


def test_at_the_gate_reads_the_tick_of_passing(landed):
    close = landed.metadata["phases"].split(",").index("close")
    state = at_the_gate(landed.ticks, close)
    truth, phase = landed.ticks["truth"], landed.ticks["mission"]["phase"]
    gap = (truth["r"] - truth["ee"])[:, 2]
    first = int(np.flatnonzero((phase == close) & (gap < GATE_M))[0])
    assert state is not None
    assert state[0] == pytest.approx(np.hypot(*(truth["r"] - truth["ee"])[first, :2]))
    assert at_the_gate(landed.ticks[:1000], close) is None


def test_flown_landings_lie_well_inside(small):
    (flown,) = small.flown
    assert flown.offset < 0.5 * small.axis("offset").bound.bound
    assert flown.speed < 0.5 * small.axis("speed").bound.bound
    assert flown.closing == pytest.approx(small.closing, rel=0.4)
