"""A flight that is put back to a moment flies on from there as it did, and as one that was never put back."""

import numpy as np
import pytest

from armland.errors import PlantError
from armland.experiments.episode import prepare, quiet
from armland.experiments.snapshot import Run
from armland.scenario.faults import Fault


@pytest.fixture(scope="module")
def run(landing_scenario):
    return Run(prepare(landing_scenario, "landing", 1))


def test_flies_on_byte_for_byte_after_being_put_back(run, landed):
    before, kept = run.advance(1600, frozenset({900, 1500}))
    assert before.tobytes() == landed.ticks[:1600].tobytes()
    run.simulator.world["told"]["rotors"]["force"] = 1.0
    run.step()
    # Across the next block of noise.
    for k in (1500, 900):
        run.restore(kept[k])
        assert run.simulator.tick == k
        assert run.advance(2100)[0].tobytes() == landed.ticks[k:2100].tobytes()
    # A push that is left out of what is put back would show.
    run.restore(kept[1500])
    run.simulator.world["told"]["rotors"]["force"] = 1.0
    assert run.advance(1600)[0].tobytes() != landed.ticks[1500:1600].tobytes()
    run.restore(kept[900])


def test_failures_begin_with_the_phase_and_are_gone_when_it_is_put_back(run):
    start = run.keep()
    calm = run.advance(run.simulator.tick + 400)[0]
    run.restore(start)
    name = run.plan.names[int(calm["mission"]["phase"][0])]
    run.fail((Fault(kind="push", body="uav", size=2.0, phase=name, after_s=0.1),))
    pushed = run.advance(run.simulator.tick + 400)[0]
    differs = np.flatnonzero(np.any(pushed["truth"]["v"] != calm["truth"]["v"], axis=1))
    assert 100 <= differs[0] <= 103
    assert run.simulator.acted[:1] == ()
    run.restore(start)
    assert run.advance(run.simulator.tick + 400)[0].tobytes() == calm.tobytes()
    run.restore(start)


def test_brakes_are_put_back(run):
    start, friction = run.keep(), run.simulator.scene.model.dof_frictionloss
    free = friction.copy()
    run.fail((Fault(kind="arm_stale"),))
    run.advance(run.simulator.tick + 300)
    assert np.any(friction != free)
    run.restore(start)
    np.testing.assert_array_equal(friction, free)


def test_a_moment_that_never_comes_is_an_error(landing_scenario):
    brief = Run(prepare(landing_scenario.replaced({"run": {"duration_s": 1.0}}), "landing"))
    with pytest.raises(PlantError, match="never came to the moon"):
        brief.advance_to(lambda: False, "the moon")


def test_quiet_seeds_fly_alike(landing_scenario):
    starts = []
    for seed in (1, 2):
        run = Run(prepare(quiet(landing_scenario), "landing", seed))
        run.advance(20)
        starts.append(run.tick.truth["r"][0].copy())
    np.testing.assert_array_equal(*starts)
