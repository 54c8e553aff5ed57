"""The electromagnet on the arm's tool, which grips the UAV's hinge plate: its law.

| symbol | name | unit |
|---|---|---|
| F₀, g₀ | `rated`, `gap_scale`: pull of F(g) = F₀/(1 + g/g₀)² on a plate at gap g | N, m |
| i | `current`, share of the rated current; the pull goes with i², as F = (N i)² μ₀ A / (2 g²) does | 1 |
| | `coil`: share of the rated current that the coil lets through; less than 1 is damage | 1 |
| | `dirt`: thickness of what lies between the faces | m |
| | `report_gain`, `report_offset`: the force that it reports over the one that its current promises, and beyond it | 1, N |

The face is four pads on a circle. Each pulls the plate with its share of F at its own gap, by forces from outside
(`xfrc_applied`) on plate and tool, and a contact bears against the pull: so peeling, breaking loose and sliding are physics
and no rule, and MuJoCo's force sensors see the load and not the pull. Measured beside it: contacts with MuJoCo's `adhesion`
break at their rating, but slide without friction as soon as the load pulls; the force of its adhesion actuator is missing from
its force sensors, which then read the whole pull; a weld is no cheaper and knows no gap, no tilt and no slip.
"""

import numpy as np
from numba import njit

from armland.plant.scene.composition import Scene
from armland.plant.scene.gear import PADS
from armland.plant.scene.uav import PLATE
from armland.records import Record, Records
from armland.rotations import Array
from armland.scenario import Scenario

OFF, ON, TEST = 0, 1, 2
"""Commands. TEST switches the coil on until its current should have risen, reports, and switches off again."""

TOUCHING_M = 2e-5
"""Gap below which a pad counts as touching."""

HEALTHY = 0.9
"""Share of the rated force below which a current is a fault."""


def told_layout(joints: int) -> np.dtype:
    """What the magnet is told."""
    numbers = ("rated", "gap_scale", "residual", "coil", "report_gain", "report_offset", "dirt")
    return np.dtype(
        [
            ("fitted", "i8"),  # 0 where the scene has none
            *((name, "f8") for name in numbers),
            ("current_gain", "f8"),  # share of a step that the current makes in one tick
            ("test_ticks", "i8"),
            ("pad", "i8", (PADS,)),  # geom of each pad
            ("plate_geom", "i8"),
            ("plate", "i8"),  # body
            ("tool", "i8"),  # body
            ("thickness", "f8"),  # m, from the plate's middle to its face, plus a pad's own radius
            ("plate_radius", "f8"),
        ]
    )


def kept_layout(joints: int) -> np.dtype:
    """What the magnet keeps."""
    return np.dtype(
        [
            ("current", "f8"),  # share of the rated current
            ("on_ticks", "i8"),  # ticks since it was switched on
            ("report", "f8"),  # N in contact that the current promises; 0 before the first self-test
            ("fault", "i8"),  # 1: the current did not rise as it should
            ("gap", "f8", (PADS,)),  # m, of each pad
            ("touching", "i8"),  # pads in contact
            ("pull", "f8"),  # N, sum of the pads' attraction, whether or not something bears against it
        ]
    )


def tell(told: Records, scenario: Scenario, scene: Scene) -> None:
    """Fill `told` (1,); it stays empty where the scene has no magnet."""
    if "magnet" not in scene.parts:
        return
    model, magnet = scene.model, scenario.magnet
    geom, step = model.geom(PLATE), model.opt.timestep
    told["fitted"], told["coil"], told["report_gain"] = 1, 1.0, 1.0
    told["rated"], told["gap_scale"], told["residual"] = magnet.rating_n, magnet.gap_scale_m, magnet.residual_n
    told["current_gain"] = 1.0 - np.exp(-step / magnet.time_constant_s)
    told["test_ticks"] = round(5.0 * magnet.time_constant_s / step)
    told["pad"] = [model.geom(f"pad_{i + 1}").id for i in range(PADS)]
    told["plate_geom"], told["plate"], told["tool"] = geom.id, scene.plate_body, scene.tool_body
    told["thickness"] = geom.size[1] + model.geom("pad_1").size[0]
    told["plate_radius"] = geom.size[0]


@njit(cache=True)
def pull(gap: float, current: float, rated: float, gap_scale: float, residual: float) -> float:
    """Force in N between face and plate at a `gap` in m.

    Args:
        gap: m.
        current: share of the rated current.
        rated: N, in contact at the rated current.
        gap_scale: g₀, m.
        residual: N, in contact without current.
    """
    share = 1.0 + max(gap, 0.0) / gap_scale
    return (residual + (rated - residual) * current * current) / (share * share)


@njit(cache=True)
def energise(
    command: int,
    geom_xpos: Array,
    geom_xmat: Array,
    xipos: Array,
    told: Record,
    kept: Record,
    faults: Record,
    xfrc: Array,
) -> None:
    """One tick: the coil's current, each pad's gap and pull, and their wrenches on plate and tool.

    The arrays are MuJoCo's, one step old: in flight, at 0.1 m/s, a gap is 0.1 mm behind. The rows of the plate and of the
    tool belong to the magnet alone.

    Args:
        command: `OFF`, `ON` or `TEST`.
        geom_xpos: positions of geoms (ngeom, 3), m, W.
        geom_xmat: their rotation matrices (ngeom, 9).
        xipos: bodies' centres of mass (nbody, 3), m, W.
        told: of `told_layout`.
        kept: of `kept_layout`, updated.
        faults: what fails, of `faults.table.kept_layout`.
        xfrc: MuJoCo's `xfrc_applied` (nbody, 6), N, N·m, W, written.
    """
    rated = told.rated * faults.rating
    residual = max(told.residual, faults.residual * rated)
    _switch(command, rated, told, kept, faults.coil)
    b, plate, tool = told.plate_geom, told.plate, told.tool
    nx, ny, nz = geom_xmat[b, 2], geom_xmat[b, 5], geom_xmat[b, 8]
    for i in range(6):
        xfrc[plate, i] = xfrc[tool, i] = 0.0
    kept.touching, kept.pull = 0, 0.0
    for i in range(PADS):
        x, y, z = geom_xpos[told.pad[i], 0], geom_xpos[told.pad[i], 1], geom_xpos[told.pad[i], 2]
        dx, dy, dz = x - geom_xpos[b, 0], y - geom_xpos[b, 1], z - geom_xpos[b, 2]
        height = nx * dx + ny * dy + nz * dz
        kept.gap[i] = -height - told.thickness
        # A pad that the plate does not cover pulls at nothing, nor does one that is beyond it.
        if dx * dx + dy * dy + dz * dz - height * height > told.plate_radius**2 or height > 0.0:
            continue
        kept.touching += kept.gap[i] < TOUCHING_M
        force = pull(kept.gap[i] + told.dirt, kept.current, rated, told.gap_scale, residual) / PADS
        kept.pull += force
        fx, fy, fz = force * nx, force * ny, force * nz
        _push(xfrc[plate], x - xipos[plate, 0], y - xipos[plate, 1], z - xipos[plate, 2], -fx, -fy, -fz)
        _push(xfrc[tool], x - xipos[tool, 0], y - xipos[tool, 1], z - xipos[tool, 2], fx, fy, fz)


@njit(cache=True)
def _push(wrench: Array, x: float, y: float, z: float, fx: float, fy: float, fz: float) -> None:
    # Adds a force at a point, seen from the body's centre of mass, to the wrench (6,) there.
    wrench[0] += fx
    wrench[1] += fy
    wrench[2] += fz
    wrench[3] += y * fz - z * fy
    wrench[4] += z * fx - x * fz
    wrench[5] += x * fy - y * fx


@njit(cache=True)
def _switch(command: int, rated: float, told: Record, kept: Record, coil: float) -> None:
    kept.on_ticks = kept.on_ticks + 1 if command != OFF else 0
    tested = kept.on_ticks > told.test_ticks
    # A coil that fails later, while it holds something, is found as well.
    if kept.on_ticks == told.test_ticks or (tested and command == ON):
        kept.report = told.report_gain * (rated * kept.current * kept.current) + told.report_offset
        kept.fault = kept.current * kept.current < HEALTHY
    wanted = told.coil * coil if command == ON or (command == TEST and not tested) else 0.0
    kept.current += told.current_gain * (wanted - kept.current)
