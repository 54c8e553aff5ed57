"""What waits for the UAV: the magnet's face on the arm's tool, and the cradle.

The face is four pads on a circle, with a cushion below each that damps an approach; what pulls is in `devices.magnet`.
"""

import mujoco
import numpy as np

from armland.errors import ConfigurationError, ModelError
from armland.plant.scene.arm import add_capsule
from armland.plant.scene.closing import RATE, closing
from armland.plant.scene.compliance import modes, rest_on_buffers
from armland.plant.scene.deck import ground
from armland.plant.scene.uav import PLATE
from armland.rotations import Array
from armland.scenario import Scenario
from armland.scenario.gear import Magnet

PADS = 4

PAD_RADIUS_M = 0.003

CUSHION_N = 1e-3
"""Adhesion of a cushion's contact; too small to hold anything."""

CUSHION_BELOW_M = 3e-5
"""How far the cushions lie below the pads. They brake without friction: level with the pads they would let a plate that slides,
which MuJoCo's contact lifts by micrometres, sink back so slowly that it slides on as if on ice."""

TOOL_RADIUS_M = 0.03
"""Of the shape that stands for sensor and tool where they can touch."""

LOWEST_CRADLE_M = 0.1
"""Least height of the cradle's rails above the floor: its legs stand on it."""


def check_gear(scenario: Scenario) -> None:
    """Refuse gear that does not fit together.

    Raises:
        ModelError: what is too short or too small, and the bound.
    """
    tool, plate, magnet = scenario.tool, scenario.plate, scenario.magnet
    lowest = tool.sensor_length_m + plate.drop_m
    if tool.length_m <= lowest:
        raise ModelError(
            f"tool.length_m = {tool.length_m:g} leaves no room for the magnet below the hinge plate; it must exceed {lowest:g}"
        )
    if plate.radius_m < magnet.pad_radius_m:
        raise ModelError(
            f"plate.radius_m = {plate.radius_m:g} does not cover the magnet's pads; it must exceed {magnet.pad_radius_m:g}"
        )
    outside = 0.5 * scenario.cradle.gap_m + 2.0 * scenario.cradle.radius_m
    if scenario.skids.half_length_m < outside:
        raise ModelError(
            f"skids.half_length_m = {scenario.skids.half_length_m:g} does not reach over the rails; it must exceed {outside:g}"
        )


def add_tool(spec: mujoco.MjSpec, scenario: Scenario) -> None:
    """Put the magnet's face on the tool: the pivot of a plate gripped flush is the end effector point."""
    t = scenario.tool
    face = t.length_m - t.sensor_length_m - scenario.plate.drop_m
    body = spec.body("armland_tool")
    mount_face(body, face, scenario.magnet)
    # From the flange on; what is below, the wrist's shape covers.
    add_capsule(body, "tool", [0, 0, -t.sensor_length_m - 0.01, 0, 0, face - 0.03], TOOL_RADIUS_M)


def mount_face(body: mujoco.MjsBody, height: float, magnet: Magnet) -> None:
    """Put the magnet's pads on `body` so that they touch the plane z = `height` m of its frame, and the cushions."""
    for i in range(PADS):
        angle = 0.5 * np.pi * i
        x, y = magnet.pad_radius_m * np.cos(angle), magnet.pad_radius_m * np.sin(angle)
        for name, below in (("pad", 0.0), ("cushion", CUSHION_BELOW_M)):
            body.add_geom(
                name=f"{name}_{i + 1}",
                type=mujoco.mjtGeom.mjGEOM_SPHERE,
                size=[PAD_RADIUS_M, 0, 0],
                pos=[x, y, height - below - PAD_RADIUS_M],
                mass=0,
                group=3,
            )


def couple(spec: mujoco.MjSpec, magnet: Magnet) -> None:
    """Let pads and cushions meet the plate, a cylinder whose lower end is the face that is gripped."""
    # Hard: the rating presses the faces together by less than 1 µm. The last of it is softer: on a curved path each step opens
    # the contact a little, 0.1 µm at 0.2 m/s, and a harder one would close again with blows.
    hard = {"solref": closing(RATE, spec.option.timestep), "solimp": [0.995, 0.9999, 1e-6, 0.5, 2.0]}
    friction = [magnet.shear_share, magnet.shear_share, 0.0, 0.0, 0.0]
    for i in range(PADS):
        pad = {"name": f"magnet_{i + 1}", "geomname1": f"pad_{i + 1}", "geomname2": PLATE}
        spec.add_pair(condim=3, friction=friction, **pad, **hard)
        # A hint of adhesion keeps the cushion's contact active over the reach: there it damps the snap of a light plate onto
        # the face, which takes less than a step. It cannot do the pulling: MuJoCo drops a contact's friction under tension.
        cushion = {"name": f"cushion_{i + 1}", "geomname1": f"cushion_{i + 1}", "geomname2": PLATE}
        spec.add_pair(condim=1, gap=magnet.reach_m, adhesion=CUSHION_N, **cushion, **hard)


def cradle_position(scenario: Scenario, lever: Array) -> Array:
    """Middle of the slot at the rails' upper edge (3,), m, D: where the skids stand with the pivot at `place.put_down_m`.

    Args:
        scenario: its place and skids.
        lever: centre of mass to the pivot (3,), m, B.

    Raises:
        ConfigurationError: the rails would lie on the floor.
    """
    position = np.array(scenario.place.put_down_m)
    # The skids' lower edge lies on the rails.
    position[2] += scenario.skids.z_m - scenario.skids.radius_m - lever[2]
    if position[2] < LOWEST_CRADLE_M:
        raise ConfigurationError(
            f"place.put_down_m = {scenario.place.put_down_m} puts the cradle's rails {position[2]:.3f} m above the floor; "
            f"they must lie at least {LOWEST_CRADLE_M:g} m above it"
        )
    return np.round(position, 9)


def add_cradle(spec: mujoco.MjSpec, scenario: Scenario, position: Array) -> None:
    """Put two rails, with the middle of their slot at `position` (3,), m, D, on a frame that rests on buffers below the skids.

    Raises:
        ModelError: buffers that are too stiff for the base rate.
    """
    c = scenario.cradle
    across = 0.5 * c.gap_m + c.radius_m
    half = 0.5 * np.deg2rad(c.heading_deg)
    place = {"pos": position, "quat": [np.cos(half), 0, 0, np.sin(half)]}
    stand, body = (ground(spec).add_body(name=name, **place) for name in ("stand", "cradle"))
    look = {"type": mujoco.mjtGeom.mjGEOM_CAPSULE, "rgba": [0.45, 0.48, 0.53, 1], "group": 2}
    for i, side in enumerate((-1.0, 1.0)):
        x, y, z = 0.5 * c.length_m, side * across, -c.radius_m
        body.add_geom(name=f"rail_{i + 1}", fromto=[-x, y, z, x, y, z], size=[c.radius_m, 0, 0], mass=0, **look)
        for foot in (-0.3, 0.8):
            # Legs stand outside the slot.
            leg = [foot * x, y, z, foot * x, 1.5 * y, -position[2]]
            stand.add_geom(fromto=leg, size=[0.7 * c.radius_m, 0, 0], **look)
    rest_on_buffers(spec, body, c, modes(c, scenario.skids.x_m, across), scenario.environment.gravity_mps2[2])
