"""What may touch what in the landing's scene: a table of explicit pairs."""

import mujoco

from armland.plant.landing_eye import HOUSING
from armland.plant.magnet import Magnet, couple
from armland.plant.scene import UAV

PLATE = f"{UAV}plate"
"""Name of the hinge plate's body and of its geom."""


def add_contacts(spec: mujoco.MjSpec, links: list[str], magnet: Magnet) -> None:
    """Add the pairs that may touch; `links` are the shapes of the arm's links."""
    couple(spec, PLATE, magnet)
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
                spec.add_pair(
                    geomname1=one,
                    geomname2=other,
                    condim=3,
                    friction=[friction, friction, 0.0, 0.0, 0.0],
                    # Rubber: gives way within 10 ms (assumption), stiff enough to stand within 0.1 mm.
                    solref=[0.01, 1.0],
                    solimp=[0.98, 0.99, 0.001, 0.5, 2.0],
                )
