"""What may touch what: a table of explicit pairs, which costs less than MuJoCo's masks and leaves no pair to chance."""

import mujoco

from armland.plant.scene.eye import HOUSING
from armland.plant.scene.uav import PLATE, UAV


def add_contacts(spec: mujoco.MjSpec, links: list[str]) -> None:
    """Let those of the free UAV's, the cradle's and the arm's shapes touch that are in `spec`; `links` are the arm's."""
    here = {g.name for g in spec.geoms}
    rails, skids = ["rail_1", "rail_2"], [f"{UAV}skid_1", f"{UAV}skid_2"]
    frame, arm = [f"{UAV}frame_1", f"{UAV}frame_2"], [*links, "tool", HOUSING]
    table = [
        (skids, [*rails, "floor", *arm], 0.8),
        (frame, [*rails, "floor", *arm], 0.4),
        ([PLATE], [*rails, "floor"], 0.4),
        (rails, arm, 0.4),
        (links, ["floor"], 0.4),
    ]
    for ones, others, friction in table:
        for one in ones:
            for other in others:
                if {one, other} <= here:
                    _add_pair(spec, one, other, friction)


def _add_pair(spec: mujoco.MjSpec, one: str, other: str, friction: float) -> None:
    spec.add_pair(
        geomname1=one,
        geomname2=other,
        condim=3,
        friction=[friction, friction, 0.0, 0.0, 0.0],
        # Rubber: gives way within 10 ms (assumption), stiff enough to stand within 0.1 mm.
        solref=[0.01, 1.0],
        solimp=[0.98, 0.99, 0.001, 0.5, 2.0],
    )
