"""What may touch what: a table of explicit pairs, which costs less than MuJoCo's masks and leaves no pair to chance."""

import mujoco

from armland.plant.scene.closing import RATE, closing
from armland.plant.scene.eye import HOUSING
from armland.plant.scene.uav import PLATE, UAV
from armland.records import MOST_ROTORS

OPEN_M, HINT_N = 5e-6, 1e-3
"""Gap at which a skid has left a rail, and the adhesion up to it: too small to hold anything. In the gap a contact has no friction,
so it is far less than a touchdown travels in a step: skids that closed through it for milliseconds would slide like on ice."""

HARD, BEARING = 0.999, 0.98
"""Impedance of contacts, and of those of the skids on the rails, which a touchdown pushes aside. MuJoCo's friction is convex: near its
end it opens a contact, against the load times the regularisation (1 − d)/d of its inverse mass. The harder one opens altogether: for a
step nothing bears, and the next one makes up for it by a blow. One that slides opens all the same."""


def add_contacts(spec: mujoco.MjSpec, links: list[str]) -> None:
    """Let those of the free UAV's, the cradle's and the arm's shapes touch that are in `spec`; `links` are the arm's."""
    here = {g.name for g in spec.geoms}
    rails, skids = ["rail_1", "rail_2"], [f"{UAV}skid_1", f"{UAV}skid_2"]
    frame, arm = [f"{UAV}frame_{i + 1}" for i in range(MOST_ROTORS)], [*links, "tool", HOUSING]
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
                    add_pair(spec, one, other, friction, one in skids and other in rails)


def add_pair(spec: mujoco.MjSpec, one: str, other: str, friction: float, bears: bool) -> None:
    """Let the geoms `one` and `other` touch with `friction`, ratio; what `bears` lies on the other for good."""
    spec.add_pair(
        geomname1=one,
        geomname2=other,
        condim=3,
        friction=[friction, friction, 0.0, 0.0, 0.0],
        # What gives way is the cradle, and not this: a load of 20 N presses skid and rail together by some micrometres.
        solref=closing(RATE, spec.option.timestep),
        solimp=[*(2 * [BEARING if bears else HARD]), 0.001, 0.5, 2.0],
        # So hard a contact opens by 0.1 µm for a step while its load changes. A hint of adhesion keeps it active meanwhile.
        gap=OPEN_M if bears else 0.0,
        adhesion=HINT_N if bears else 0.0,
    )
