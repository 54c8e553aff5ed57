"""The solids of a scene for the judge: arm, tool, UAV, cradle and floor as they are, in a model of MuJoCo's own that flies nothing.

It is made from the plant's scene, deviations included, and stands in a log as text. The controller and its planner know nothing of it.

| solid | shapes |
|---|---|
| link of the arm | shapes and meshes that its file means for contact, else those that it draws, else what stands for a link without |
| tool | a capsule around magnet and camera, the sensor below it as it is drawn |
| UAV | all that its file draws; not its plate, which the tool grips |
| cradle, floor | rails and legs; the plane that the arm stands on |
"""

from collections.abc import Iterator, Mapping
from types import MappingProxyType

import mujoco
import numpy as np

from armland.models.airframe.body import drawn
from armland.models.arm_file.meshes.worn import Solid, Worn
from armland.models.arm_file.spec import PREFIX, SHAPE
from armland.models.arm_file.strength import poses
from armland.plant.scene.composition import Scene
from armland.plant.scene.deck import DECK, moves

UAV, TOOL, FLOOR = "uav/uav", "armland_tool", "floor"

ARM_BIT, STAND_BIT, UAV_BIT = 1, 2, 4

NEAR_JOINTS = 3
"""Links with fewer joints between them are not held against each other: their shapes are rounded, and meet at the joint itself."""

ALWAYS = 0.9
"""Share of random poses: two solids that meet in more of them are built into each other."""


NONE: Mapping[str, Worn] = MappingProxyType({})


def solids_of(scene: Scene, worn: Mapping[str, Worn] = NONE) -> str:
    """MJCF of the scene's solids; empty where the UAV hangs on the arm for good, as nothing can touch there.

    Args:
        scene: of the plant.
        worn: meshes of the arm's links, by the name of their body.
    """
    if scene.bond != "free":
        return ""
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    model = scene.model
    bodies = {0: spec.worldbody}
    if moves(model):
        # Seen from the deck nothing but arm and UAV moves.
        bodies[model.body(DECK).id] = spec.worldbody
    for body in range(1, model.nbody):
        name = model.body(body).name
        if name.startswith((PREFIX, "armland_")):
            bodies[body] = _moving(model, body, bodies[int(model.body_parentid[body])])
            bits = (ARM_BIT, ARM_BIT | STAND_BIT | (0 if name == TOOL else UAV_BIT))
            one = worn.get(name, Worn((), False))
            _add_shapes(bodies[body], model, body, [] if one.instead else _touched(model, body), bits)
            for solid in one.solids:
                _add_mesh(spec, bodies[body], solid, bits)
    uav = spec.worldbody.add_body(name=UAV, mocap=True)
    _add_shapes(uav, model, scene.uav_body, drawn(model, scene.uav_body), (UAV_BIT, 0))
    for name in ("stand", "cradle"):
        if name in {model.body(i).name for i in range(model.nbody)}:
            b = model.body(name)
            fixed = spec.worldbody.add_body(name=name, pos=b.pos, quat=b.quat)
            _add_shapes(fixed, model, b.id, drawn(model, b.id), (STAND_BIT, 0))
    plane = mujoco.mjtGeom.mjGEOM_PLANE
    spec.worldbody.add_geom(name=FLOOR, type=plane, size=[0, 0, 0.1], contype=STAND_BIT, conaffinity=0)
    for near, far in _left_out(spec.compile()):
        spec.add_exclude(bodyname1=near, bodyname2=far)
    spec.compile()
    return str(spec.to_xml())


def _moving(model: mujoco.MjModel, body: int, parent: mujoco.MjsBody) -> mujoco.MjsBody:
    made = parent.add_body(name=model.body(body).name, pos=model.body_pos[body], quat=model.body_quat[body])
    # Nothing moves here by forces: any mass will do.
    made.mass, made.ipos, made.inertia, made.explicitinertial = 1.0, [0.0, 0.0, 0.0], [1.0, 1.0, 1.0], True
    for j in range(model.body_jntadr[body], model.body_jntadr[body] + model.body_jntnum[body]):
        ref = float(model.qpos0[model.jnt_qposadr[j]])
        made.add_joint(
            name=model.joint(j).name,
            type=mujoco.mjtJoint(int(model.jnt_type[j])),
            pos=model.jnt_pos[j],
            axis=model.jnt_axis[j],
            ref=ref,
            range=model.jnt_range[j],
            limited=bool(model.jnt_limited[j]),
        )
    return made


def _touched(model: mujoco.MjModel, body: int) -> list[int]:
    if model.body(body).name == TOOL:
        return [model.geom("tool").id] if "tool" in _names(model, body) else []
    names = _names(model, body)
    meant = [g for n, g in names.items() if n.startswith(SHAPE)]
    return meant or drawn(model, body) or [g for n, g in names.items() if n.endswith("_shape")]


def _names(model: mujoco.MjModel, body: int) -> dict[str, int]:
    first = int(model.body_geomadr[body])
    return {model.geom(g).name: g for g in range(first, first + int(model.body_geomnum[body])) if model.geom(g).name}


def _add_shapes(body: mujoco.MjsBody, model: mujoco.MjModel, of: int, shapes: list[int], bits: tuple[int, int]) -> None:
    for g in shapes:
        body.add_geom(
            type=mujoco.mjtGeom(int(model.geom_type[g])),
            size=model.geom_size[g],
            pos=model.geom_pos[g],
            quat=model.geom_quat[g],
            contype=bits[0],
            conaffinity=bits[1],
            mass=0.0,
        )


def _add_mesh(spec: mujoco.MjSpec, body: mujoco.MjsBody, solid: Solid, bits: tuple[int, int]) -> None:
    name, shell = f"mesh_{len(spec.meshes)}", mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
    spec.add_mesh(name=name, uservert=solid.vertices.ravel(), userface=solid.faces.ravel(), inertia=shell)
    kind = mujoco.mjtGeom.mjGEOM_MESH
    body.add_geom(type=kind, meshname=name, contype=bits[0], conaffinity=bits[1], mass=0.0)


def _left_out(model: mujoco.MjModel) -> Iterator[tuple[str, str]]:
    # Links that are near each other along the chain, and what is built into each other: in the file nobody can do a thing about it.
    arm = [b for b in range(1, model.nbody) if model.body(b).name.startswith((PREFIX, "armland_"))]
    depth = {b: _joints_below(model, b) for b in arm}
    near = {(i, j) for i in arm for j in arm if i < j and depth[j] - depth[i] < NEAR_JOINTS}
    data, count = mujoco.MjData(model), dict[tuple[int, int], int]()
    samples = poses(model)[:60]
    data.mocap_pos[:] = [0.0, 0.0, 99.0]
    for q in samples:
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)
        mujoco.mj_collision(model, data)
        met = {_pair(model, c.geom) for c in data.contact if c.dist < 0.0}
        for pair in met - near:
            count[pair] = count.get(pair, 0) + 1
    always = {pair for pair, n in count.items() if n > ALWAYS * len(samples)}
    # What no joint moves against the floor, as the first link, meets it in all poses or in none.
    yield from ((model.body(i).name, model.body(j).name) for i, j in sorted(near | always))


def _pair(model: mujoco.MjModel, geoms: np.ndarray) -> tuple[int, int]:
    i, j = sorted(int(model.geom_bodyid[g]) for g in geoms)
    return i, j


def _joints_below(model: mujoco.MjModel, body: int) -> int:
    count = 0
    while body > 0:
        count += int(model.body_jntnum[body])
        body = int(model.body_parentid[body])
    return count
