"""Bodies of UAVs: one that has no file, by its numbers; the skids that each gets; the shapes of which it is taken to be."""

import mujoco
import numpy as np

from armland.errors import ModelError
from armland.scenario.gear import Skids
from armland.scenario.uav import Rotors, Uav

BEAM, DARK, DISC = 0.006, [0.13, 0.14, 0.16, 1.0], [0.45, 0.5, 0.56, 0.22]


def described(uav: Uav, rotors: Rotors) -> mujoco.MjSpec:
    """The body `uav` with the sites `cm` and `pivot`; places count from the centre of mass, where its origin is.

    Raises:
        ModelError: a number is missing.
    """
    if uav.mass_kg is None or uav.inertia_kgm2 is None or uav.lever_m is None or rotors.place_m is None:
        raise ModelError("a UAV without uav.file needs uav.mass_kg, uav.inertia_kgm2, uav.lever_m and rotors.place_m")
    spec, J = mujoco.MjSpec(), np.array(uav.inertia_kgm2)
    body = spec.worldbody.add_body(name="uav")
    body.explicitinertial, body.mass, body.ipos, body.iquat = True, uav.mass_kg, np.zeros(3), [1.0, 0.0, 0.0, 0.0]
    body.inertia, body.fullinertia = np.zeros(3), [J[0, 0], J[1, 1], J[2, 2], J[0, 1], J[0, 2], J[1, 2]]
    body.add_site(name="cm")
    body.add_site(name="pivot", pos=list(uav.lever_m))
    look = {"mass": 0, "contype": 0, "conaffinity": 0, "group": 2}
    capsule, cylinder, sphere = (
        mujoco.mjtGeom.mjGEOM_CAPSULE,
        mujoco.mjtGeom.mjGEOM_CYLINDER,
        mujoco.mjtGeom.mjGEOM_SPHERE,
    )
    thick = max(0.03 * float(np.abs(np.array(rotors.place_m)).max()), 0.5 * BEAM)
    for place in rotors.place_m:
        beam = [0.0, 0.0, 0.0, *place]
        body.add_geom(type=capsule, fromto=beam, size=[thick, 0, 0], rgba=DARK, **look)
        body.add_geom(type=cylinder, pos=list(place), size=[rotors.radius_m, 1e-3, 0], rgba=DISC, **look)
    body.add_geom(type=sphere, size=[4.0 * thick, 0, 0], rgba=DARK, **look)
    body.add_geom(type=capsule, fromto=[0, 0, 0, *uav.lever_m], size=[0.5 * thick, 0, 0], rgba=DARK, **look)
    return spec


def add_skids(body: mujoco.MjsBody, skids: Skids) -> None:
    """Put two tubes on four legs below a UAV's centre of mass; they weigh nothing of their own."""
    capsule, y, z = mujoco.mjtGeom.mjGEOM_CAPSULE, skids.half_length_m, skids.z_m
    look = {"group": 2, "mass": 0, "rgba": [0.72, 0.74, 0.77, 1]}
    for i, x in enumerate((skids.x_m, -skids.x_m)):
        tube = {"fromto": [x, -y, z, x, y, z], "size": [skids.radius_m, 0, 0]}
        body.add_geom(name=f"skid_{i + 1}", type=capsule, **tube, **look)
        for side in (-1, 1):
            leg = [0.75 * x, side * 0.09, 0.0, x, side * 0.6 * y, z]
            body.add_geom(type=capsule, fromto=leg, size=[0.6 * skids.radius_m, 0, 0], **look)


def drawn(model: mujoco.MjModel, body: int) -> list[int]:
    """Geoms of a body that its file draws, meshes left out: what a UAV or a cradle is made of for whoever asks what touches it."""
    first, mesh = int(model.body_geomadr[body]), int(mujoco.mjtGeom.mjGEOM_MESH)
    geoms = range(first, first + int(model.body_geomnum[body]))
    return [g for g in geoms if model.geom_group[g] == 2 and model.geom_type[g] < mesh]
