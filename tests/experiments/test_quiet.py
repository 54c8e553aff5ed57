"""A scenario without what differs between seeds."""

from armland.experiments.quiet import quiet
from armland.plant.draw import draw


def test_nothing_is_drawn_and_nothing_fails(landing_scenario):
    flawed = landing_scenario.replaced({"faults": [{"kind": "link_loss"}]})
    still = quiet(flawed)
    assert still.faults == ()
    assert not still.imperfections.noise
    assert not still.imperfections.camera
    assert quiet(flawed, camera=True).imperfections.camera
    one, other = (draw(still.with_seed(seed), "air") for seed in (1, 2))
    assert all((a == b).all() if hasattr(a, "all") else a == b for a, b in zip(one, other, strict=True))
    assert (one.wrench_bias == 0.0).all()
    assert one.thrust_factor == 1.0
