"""The scene of a film: what flew, composed from the log's scenario, with a camera that has all of it in the picture."""

import warnings
from collections.abc import Mapping
from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from armland.errors import LogError
from armland.mission.registry import UNAIDED
from armland.models.description import compile_spec
from armland.plant.deviation.bodies import deviate_bodies
from armland.plant.deviation.drawn import drawn
from armland.plant.scene.composition import Scene, build_scene, scene_spec
from armland.plant.scene.pad import build_pad_scene, pad_scene_spec
from armland.plant.scene.uav import UAV
from armland.records import Records
from armland.rotations import Array
from armland.runtime.log import Log
from armland.scenario import Scenario
from armland.view.film.framing import Framing, framed
from armland.view.film.water import Water, add_water
from armland.view.flown import scenario_of

CAMERA = "film"

LEGS = "hexapod"
"""The mission whose pad stands on a platform on legs."""

SAMPLES = 40
"""Poses of a run that the camera is placed by."""

NEAR_M = 0.7
"""The camera follows the UAV as far as this from the end effector: what flies off leaves the picture."""

TUBES = (int(mujoco.mjtGeom.mjGEOM_CAPSULE), int(mujoco.mjtGeom.mjGEOM_CYLINDER))

LARGEST_M = 0.2
"""Radius beyond which a shape is taken for a small one: what is drawn of it may reach out of the picture."""

SCENERY = ("floor", "water", "hull", "edge")
"""Names of geoms that may reach beyond the picture."""


class Stage(NamedTuple):
    """A compiled scene, and what is needed to show a tick of the run in it."""

    scene: Scene
    water: Water | None  # None on land

    @property
    def model(self) -> mujoco.MjModel:
        """MuJoCo's model of the scene."""
        return self.scene.model

    def surface(self, t: float) -> NDArray[np.float32]:
        """Heights of the water at the time `t`, s, as `FrameStream.draw` takes them; (0,) on land."""
        return np.zeros(0, np.float32) if self.water is None else self.water.surface(t)


def stage_of(log: Log, aspect: float) -> Stage:
    """Compose the scene of a log, and place the camera `CAMERA` for a picture `aspect` times as wide as high.

    Raises:
        LogError: a log without scenario or ticks, or of another version.
        ModelError: a file of the scenario is no longer there.
    """
    scenario, truth = scenario_of(log), log.messages["truth"]
    if not len(truth):
        raise LogError("the log holds no tick; there is nothing to show")
    mission = log.metadata.get("mission", "")
    plain = scene_of(scenario, log.metadata)
    if plain.joints != truth["q"].shape[1]:
        raise LogError(f"the log has {truth['q'].shape[1]} joints where its scenario's arm has {plain.joints}")
    bare, _ = _dressed(scenario, plain, mission, None)
    rows = truth[np.linspace(0, len(truth) - 1, min(SAMPLES, len(truth))).astype(int)]
    near = np.linalg.norm(rows["r"] - rows["ee"], axis=1) < NEAR_M
    framing = framed(*extent(bare, poses(bare, rows[near] if near.any() else rows)), aspect)
    return Stage(*_dressed(scenario, plain, mission, framing))


def scene_of(scenario: Scenario, metadata: Mapping[str, str]) -> Scene:
    """The scene of a log with this `metadata`; of a platform on legs hull and legs are shown where the platform is.

    Raises:
        ModelError: a file of the scenario is no longer there.
    """
    if (mission := metadata.get("mission", "")) in UNAIDED:
        return build_pad_scene(scenario, mission == LEGS)
    return build_scene(scenario, "hinged" if metadata.get("start") == "hinged" else "free")


def _dressed(scenario: Scenario, plain: Scene, mission: str, framing: Framing | None) -> tuple[Scene, Water | None]:
    if mission in UNAIDED:
        spec, _ = pad_scene_spec(scenario, mission == LEGS)
    else:
        spec, _ = scene_spec(scenario, plain.bond)
    # A turning rotor is seen as a disc.
    for blade in [g for g in spec.geoms if g.material.endswith("blade")]:
        spec.delete(blade)
    water = add_water(spec, scenario) if plain.deck_qpos >= 0 else None
    spec.visual.quality.shadowsize = 2048
    if framing is not None:
        spec.worldbody.add_camera(name=CAMERA, pos=framing.eye, xyaxes=framing.axes, fovy=framing.angle_deg)
        _set_depth(spec, framing, water is not None)
    with warnings.catch_warnings():
        # No other scene has the arm's names, and none is saved.
        warnings.filterwarnings("ignore", message="Attaching a spec with an empty prefix")
        scene = plain._replace(model=compile_spec(spec, "the film's scene"))
    values = drawn(scenario, plain.joints) if plain.bond == "free" else {}
    return (deviate_bodies(values, scenario, scene) if values else scene), water


def _set_depth(spec: mujoco.MjSpec, framing: Framing, at_sea: bool) -> None:
    # MuJoCo's distances for shadows, mist and clipping are multiples of the extent.
    far = float(np.linalg.norm(np.array(framing.eye) - framing.target))
    spec.stat.extent, spec.stat.center = far, list(framing.target)
    spec.visual.map.znear, spec.visual.map.zfar = 0.05, 60.0
    spec.visual.map.shadowclip = 0.9
    if at_sea:
        spec.visual.map.fogstart, spec.visual.map.fogend = 2.5, 12.0


def poses(scene: Scene, truth: Records) -> Array:
    """qpos (k, nq), m and rad, at each tick of `truth` (k,), in W.

    Raises:
        LogError: numbers that are not finite.
    """
    out = np.tile(scene.model.qpos0, (len(truth), 1))
    uav = Rotation.from_quat(truth["quat"], scalar_first=True)
    out[:, scene.joint_qpos] = truth["q"]
    if scene.bond == "free":
        plate = Rotation.from_quat(truth["plate_quat"], scalar_first=True)
        pivot = scene.model.site(f"{UAV}pivot").pos
        out[:, scene.uav_qpos] = np.hstack([truth["r"] - uav.apply(pivot), truth["quat"]])
        out[:, scene.hinge_qpos] = (uav.inv() * plate).as_euler("YXZ")
    else:
        ee = Rotation.from_quat(truth["ee_quat"], scalar_first=True)
        out[:, scene.hinge_qpos] = (ee.inv() * uav).as_euler("ZXY")
    if scene.deck_qpos >= 0:
        turn = Rotation.from_quat(truth["deck_quat"], scalar_first=True).as_euler("ZYX")
        out[:, scene.deck_qpos : scene.deck_qpos + 6] = np.hstack([truth["deck"], turn])
    if not np.isfinite(out).all():
        raise LogError("the log's truth holds numbers that are not finite; there is no pose to show")
    return out


def extent(scene: Scene, qpos: Array) -> tuple[Array, Array]:
    """Middles (n, 3) and radii (n,), m, W, of spheres around all that is to be in the picture, at each of `qpos` (k, nq), m and rad."""
    model, data = scene.model, mujoco.MjData(scene.model)
    shown = [g for g in range(model.ngeom) if model.geom(g).name not in SCENERY and model.geom_group[g] <= 2]
    # Of a tube both ends: the sphere around all of it is mostly air.
    tubes = np.isin(model.geom_type[shown], TUBES)
    half = np.where(tubes, model.geom_size[shown, 1], 0.0)
    radii = np.where(tubes, model.geom_size[shown, 0], np.minimum(model.geom_rbound[shown], LARGEST_M))
    places = []
    for q in qpos:
        data.qpos[:] = q
        mujoco.mj_kinematics(model, data)
        along = half[:, None] * data.geom_xmat[shown].reshape(-1, 3, 3)[:, :, 2]
        places += [data.geom_xpos[shown] + along, data.geom_xpos[shown] - along]
    return np.vstack(places), np.tile(radii, 2 * len(qpos))
