"""How near an arm comes to what stands around it: floor, cradle, UAV and its own links, by MuJoCo's distances.

| solid | what it is measured by |
|---|---|
| all links | shapes, hulls of meshes that their file means for contact, else those that it draws, else what stands for a link without |
| outer half, links without shapes | capsules from joint to joint as well, which is what the plant lets touch |
| tool | a capsule around sensor, magnet and camera; the sensor as it is drawn |
| UAV | what its file draws, skids, marker, and beams between the rotors, which is what the plant lets touch |

The scene is the planner's own and knows nothing of the plant's: cradle and UAV are put where a plan wants them.
"""

from itertools import combinations
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.models.airframe.solids import OWN, add_cradle, add_links, add_tool, add_uav, stand_legs
from armland.models.arm_file.meshes.worn import Worn, worn
from armland.models.arm_file.spec import PREFIX, SHAPE
from armland.models.arm_file.strength import poses
from armland.models.description import EE_SITE, compile_spec
from armland.models.parameters import arm_file, arm_spec, uav_parameters
from armland.rotations import Array
from armland.scenario import Scenario

FLOOR_M, CRADLE_M, UAV_M = 0.01, 0.01, 0.01
"""Clearance of the arm to floor, cradle and UAV. To the cradle it is less than `control.approach.clearance_m`, which the corridor of
`room` leaves an arm that stands upright in it: one that leans may use some of that."""

FAR_M, TOUCH_M, SAME_M = 0.05, 1e-6, 0.3
"""Distances beyond the first, and differences below the second, are not told apart; within the third it is seen what never changes."""

SPARE_M = 0.002
"""By how much less than the largest distance of all poses is kept at most."""

CORNERS = 64
"""Of a mesh's convex hull, at most."""

ALWAYS, SAMPLED = 0.9, 60
"""Share of random poses, and their number: two shapes that meet in more of them are built into each other."""


class Near(NamedTuple):
    """The tightest place between an arm and what is around it."""

    room: float
    """Distance less the clearance that is kept, m: negative where the arm is too near."""
    link: str
    other: str
    clearance: float
    """That is kept, m."""


class _Pair(NamedTuple):
    one: int
    two: int
    clearance: float
    link: str
    other: str


class Obstacles:
    """An arm between floor, cradle and UAV. It owns a scene of its own, which `nearest` overwrites."""

    def __init__(self, scenario: Scenario) -> None:
        """Compose the scene of a believed scenario's arm, UAV and cradle.

        Raises:
            ModelError: an arm or UAV file that cannot be used.
        """
        spec = arm_spec(scenario)
        bare = compile_spec(spec, "the arm")
        _dress(spec, worn(arm_file(scenario).chain))
        solid = [g.name for g in spec.geoms if g.name.startswith(SHAPE)]
        own = add_tool(spec, scenario)
        links = [*solid, *add_links(spec, bare), *own]
        uav, cradle = add_uav(spec, scenario), add_cradle(spec, scenario)
        spec.worldbody.add_geom(
            name="floor", type=mujoco.mjtGeom.mjGEOM_BOX, size=[9.0, 9.0, 0.5], pos=[0.0, 0.0, -0.5]
        )
        self._model = compile_spec(spec, "the arm's surroundings")
        self._data = mujoco.MjData(self._model)
        self._data.mocap_pos[:] = [0.0, 0.0, 99.0]
        self._joints, self.lever = bare.nq, uav_parameters(scenario).lever
        """Centre of mass to the pivot (3,), m, B."""
        above = self.lever[2] - scenario.skids.z_m + scenario.skids.radius_m
        self._rails, self._cradle = np.array([0.0, 0.0, above]), scenario.cradle
        others = {
            "the floor": (["floor"], FLOOR_M),
            "the cradle": (cradle, CRADLE_M),
            "the UAV": (uav, UAV_M),
        }
        self._pairs = self._outside(links, others) + self._inside([*solid, *own])
        self._ends, self._clearance = _ends(self._pairs), np.array([p.clearance for p in self._pairs])
        self._size = self._sizes(self._ends)

    def put_cradle(self, put_down: Array, heading_deg: float) -> None:
        """Put the cradle where the UAV stands on it with its pivot at `put_down` (3,), m, D, its rails along the heading."""
        half, origin = 0.5 * np.deg2rad(heading_deg), put_down - self._rails
        at = self._model.body("cradle").mocapid[0]
        stand_legs(self._model, self._cradle, float(origin[2]))
        self._size = self._sizes(self._ends)
        self._data.mocap_pos[at] = origin
        self._data.mocap_quat[at] = [np.cos(half), 0.0, 0.0, np.sin(half)]

    def nearest(self, q: Array, pivot: Array, slack: float = 0.0, any_will_do: bool = False) -> Near:
        """The tightest place with the arm at `q` (n,), rad, and the level UAV's pivot at `pivot` (3,), m, D.

        `slack` is by how much the clearances are less, m; `any_will_do` asks for any place that is too tight, where there is one.
        """
        self._data.qpos[: self._joints] = q
        self._data.mocap_pos[self._model.body("uav").mocapid[0]] = pivot - self.lever
        mujoco.mj_kinematics(self._model, self._data)
        best, kept = Near(FAR_M, "", "", 0.0), np.maximum(self._clearance - slack, 0.0)
        # The nearest by their spheres are measured first, and most never.
        least = self._apart(self._ends) - self._size - kept
        near = np.flatnonzero(least < FAR_M)
        for i in near[np.argsort(least[near], kind="stable")].tolist():
            if least[i] >= best.room or (any_will_do and best.room < 0.0):
                break
            pair, most = self._pairs[i], max(best.room + kept[i], TOUCH_M)
            room = mujoco.mj_geomDistance(self._model, self._data, pair.one, pair.two, most, None) - kept[i]
            if room < best.room - TOUCH_M:
                best = Near(float(room), pair.link, pair.other, float(kept[i]))
        return best

    def _apart(self, ends: NDArray[np.int64]) -> Array:
        # Distances of the middles of shapes, m. Less `_sizes` they are those of the spheres around them: the shapes are no nearer.
        step = self._data.geom_xpos[ends[0]] - self._data.geom_xpos[ends[1]]
        return np.asarray(np.sqrt(np.einsum("ij,ij->i", step, step)))

    def _sizes(self, ends: NDArray[np.int64]) -> Array:
        return np.asarray(self._model.geom_rbound[ends].sum(axis=0))

    def held(self) -> Near:
        """The tightest place between what does not move against the tool and a UAV that it holds: the same in all poses."""
        model, data, end = self._model, self._data, self._model.body("armland_tool").weldid[0]
        uav, best = self._model.body("uav").mocapid[0], Near(FAR_M, "", "", 0.0)
        mujoco.mj_kinematics(model, data)
        there = data.site(EE_SITE)
        data.mocap_pos[uav] = there.xpos - there.xmat.reshape(3, 3) @ self.lever
        mujoco.mju_mat2Quat(data.mocap_quat[uav], there.xmat)
        mujoco.mj_kinematics(model, data)
        for pair in self._pairs:
            body = model.geom_bodyid[pair.one]
            if (
                pair.other != "the UAV"
                or model.body_weldid[body] != end
                or not model.geom(pair.one).name.startswith(SHAPE)
            ):
                continue
            room = mujoco.mj_geomDistance(model, data, pair.one, pair.two, FAR_M, None) - pair.clearance
            if room < best.room:
                best = Near(room, pair.link, pair.other, pair.clearance)
        data.mocap_quat[uav] = [1.0, 0.0, 0.0, 0.0]
        return best

    def outermost(self) -> float:
        """How far what does not move against the tool reaches out beyond the end effector along its z axis, m."""
        model, data, end = self._model, self._data, self._model.body("armland_sensor")
        mujoco.mj_kinematics(model, data)
        out, z = data.body(end.id).xmat[2::3], 0.0
        for geom in range(model.ngeom):
            fixed = model.body_weldid[model.geom_bodyid[geom]] == end.weldid[0]
            if fixed and model.geom(geom).name.startswith(SHAPE):
                step = data.geom_xpos[geom] - data.body(end.id).xpos
                z = max(z, float(out @ step) + _reach(model, geom, data.geom_xmat[geom].reshape(3, 3).T @ out))
        return z

    def _outside(self, links: list[str], others: dict[str, tuple[list[str], float]]) -> list[_Pair]:
        # What stands still, as the arm's base, meets no floor; nor does the tool meet what it grips.
        model, pairs = self._model, []
        moving = [n for n in links if model.body_weldid[model.geom(n).bodyid[0]] != 0]
        for what, (names, clearance) in others.items():
            for link in moving if what == "the floor" else links:
                if what == "the UAV" and link == "tool":
                    continue
                for name in names:
                    label = self._label(link)
                    pairs.append(_Pair(model.geom(link).id, model.geom(name).id, clearance, label, what))
        return self._free(pairs)

    def _inside(self, links: list[str]) -> list[_Pair]:
        model = self._model
        pairs = []
        for one, two in combinations(links, 2):
            a, b = (self._depth(n) for n in (one, two))
            if abs(a - b) >= 3:
                label = self._label(one), self._label(two)
                pairs.append(_Pair(model.geom(one).id, model.geom(two).id, 0.0, label[1], label[0]))
        return self._free(pairs)

    def _free(self, pairs: list[_Pair]) -> list[_Pair]:
        # Without those that are built into each other, or whose distance no joint changes: a plan can do nothing about them.
        samples = poses(self._model)[:SAMPLED]
        far, ends = np.full((len(samples), len(pairs)), SAME_M), _ends(pairs)
        size = self._sizes(ends)
        for row, q in zip(far, samples, strict=True):
            self._data.qpos[:] = q
            mujoco.mj_kinematics(self._model, self._data)
            for i in np.flatnonzero(self._apart(ends) - size < SAME_M):
                pair = pairs[i]
                row[i] = mujoco.mj_geomDistance(self._model, self._data, pair.one, pair.two, SAME_M, None)
        always, same = (far < 0.0).mean(axis=0) > ALWAYS, (np.ptp(far, axis=0) < TOUCH_M) & (far[0] < SAME_M)
        # No clearance is kept that no pose has, as of a shoulder to the floor that its arm stands on.
        most = np.maximum(far.max(axis=0) - SPARE_M, 0.0)
        kept = [p._replace(clearance=min(p.clearance, m)) for p, m in zip(pairs, most, strict=True)]
        return [p for p, a, s in zip(kept, always, same, strict=True) if not a and not s]

    def _depth(self, name: str) -> int:
        # Number of joints between the ground and a shape.
        body, count = int(self._model.geom(name).bodyid[0]), 0
        while body > 0:
            count += int(self._model.body_jntnum[body])
            body = int(self._model.body_parentid[body])
        return count

    def _label(self, name: str) -> str:
        if name in OWN:
            return f"the {name}"
        body = int(self._model.geom(name).bodyid[0])
        part, link = name.partition(":")[2], self._model.body(body).name.removeprefix("arm/")
        if part not in ("", link):
            return f"{part!r} on link {link!r}"
        return link if link.startswith("link") else f"link {link}"


def _dress(spec: mujoco.MjSpec, links: dict[str, Worn]) -> None:
    # Meshes in place of what stands for a link without shapes; MuJoCo measures to their convex hulls.
    for name, one in links.items():
        body = spec.body(name)
        for geom in [g for g in body.geoms if one.instead and g.name.startswith(SHAPE)]:
            spec.delete(geom)
        for solid in one.solids:
            mesh, shell = f"{SHAPE}{len(spec.meshes)}_mesh", mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
            spec.add_mesh(
                name=mesh,
                uservert=solid.vertices.ravel(),
                userface=solid.faces.ravel(),
                inertia=shell,
                maxhullvert=CORNERS,
            )
            kind, called = mujoco.mjtGeom.mjGEOM_MESH, f"{mesh}:{name.removeprefix(PREFIX)}"
            body.add_geom(name=called, type=kind, meshname=mesh, mass=0.0, contype=0, conaffinity=0)


def _reach(model: mujoco.MjModel, geom: int, along: Array) -> float:
    # From a shape's middle along a direction (3,) of its own, m: to its corners, or those of the box around it.
    if model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_MESH:
        first, many = (int(a[model.geom_dataid[geom]]) for a in (model.mesh_vertadr, model.mesh_vertnum))
        return float((model.mesh_vert[first : first + many] @ along).max())
    return float(model.geom_aabb[geom, :3] @ along + model.geom_aabb[geom, 3:] @ np.abs(along))


def _ends(pairs: list[_Pair]) -> NDArray[np.int64]:
    return np.array([[p.one for p in pairs], [p.two for p in pairs]], np.int64)
