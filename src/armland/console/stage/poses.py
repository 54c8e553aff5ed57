"""Where the bodies of a logged flight are: MuJoCo's own kinematics of the scene that the log's scenario makes.

| of a tick's truth | sets |
|---|---|
| `deck`, `deck_quat` | the deck's joints; none on land |
| `q` | the arm's joints |
| `r`, `quat` | a free UAV by its pivot, which no deviation of its centre of mass moves |
| `ee_quat` or `plate_quat`, `quat` | the hinge between arm or plate and UAV |

The cradle's buffers are not logged: its rails are drawn where they rest without load, which is 2 mm higher at most.
"""

from collections.abc import Callable, Mapping
from math import asin, atan2

import mujoco
import numpy as np

from armland.errors import ArmlandError, LogError
from armland.models.arm_file.spec import PREFIX
from armland.models.description import EE_SITE
from armland.plant.scene.composition import Scene
from armland.plant.scene.uav import UAV
from armland.records import Records
from armland.rotations import Array, matrix, quaternion_of
from armland.scenario import Scenario
from armland.scenario.arm import Arm
from armland.view.film.stage import scene_of as flown_scene


def scene_of(metadata: Mapping[str, str]) -> Scene:
    """The scene of the flight that a log's metadata describes.

    Raises:
        LogError: the log has no scenario, or none that this version knows; or a file of it is no longer there.
    """
    return _scene_of(metadata, lambda scenario: scenario)


def armless_scene_of(metadata: Mapping[str, str]) -> Scene:
    """The same with an arm that comes with armland in place of the log's, which is not to be drawn, see `Poses`; errors likewise."""
    return _scene_of(metadata, lambda scenario: scenario.model_copy(update={"arm": Arm()}))


def _scene_of(metadata: Mapping[str, str], changed: Callable[[Scenario], Scenario]) -> Scene:
    try:
        text, _ = metadata["scenario"], metadata["start"]
        return flown_scene(changed(Scenario.model_validate_json(text)), metadata)
    except KeyError as e:
        raise LogError(
            f"the log's metadata has no {e.args[0]!r}, without which there is no picture of its scene"
        ) from e
    except ArmlandError as e:
        raise LogError(f"no picture of the log's scene: {e}") from e
    except ValueError as e:
        first = str(e).splitlines()[0]
        raise LogError(f"no picture of the log's scene, its scenario is none of this version: {first}") from e


class Poses:
    """Kinematics of a scene: `set` it to a tick's truth, then read `bodies`, `site` and `camera`.

    Args:
        scene: of `scene_of`, or of the simulator that flies; its model is read only.
        armless: whether the scene's arm is none that flew: the tool stands where the truth has the end effector, whatever the arm.
    """

    def __init__(self, scene: Scene, armless: bool = False) -> None:
        self.scene, self.model = scene, scene.model
        self._data = mujoco.MjData(scene.model)
        self._pivot = scene.model.site(f"{UAV}pivot").pos.copy()
        model = scene.model
        self.absent = frozenset(b for b in range(model.nbody) if armless and model.body(b).name.startswith(PREFIX))
        """Bodies that are not to be drawn."""
        # All that the end effector carries; a parent has a lower number than its children.
        carried = {model.body("armland_sensor").id} if armless else set()
        for body in range(model.nbody):
            if int(model.body_parentid[body]) in carried:
                carried.add(body)
        self._carried = sorted(carried)

    def set(self, truth: Records) -> None:
        """Take over the truth of one tick, a record of `records.layout("truth", n)`.

        Raises:
            LogError: it has not as many joints as the scene's arm.
        """
        s, q = self.scene, self._data.qpos
        if not self._carried and len(truth["q"]) != s.joints:
            raise LogError(f"the log has {len(truth['q'])} joints, the arm of its scenario {s.joints}")
        if not self._carried:
            q[s.joint_qpos] = truth["q"]
        if s.deck_qpos >= 0:
            D = turn_of(truth["deck_quat"])
            # Rz, Ry, Rx.
            yaw_pitch_roll = atan2(D[1, 0], D[0, 0]), _arcsin(-D[2, 0]), atan2(D[2, 1], D[2, 2])
            q[s.deck_qpos : s.deck_qpos + 6] = [*truth["deck"], *yaw_pitch_roll]
        B = turn_of(truth["quat"])
        if s.bond == "free":
            q[s.uav_qpos[:3]] = truth["r"] - B @ self._pivot
            q[s.uav_qpos[3:]] = truth["quat"]
            # From the UAV to its plate the hinge turns by Ry, Rx, Rz.
            R = B.T @ turn_of(truth["plate_quat"])
            q[s.hinge_qpos] = [atan2(R[0, 2], R[2, 2]), _arcsin(-R[1, 2]), atan2(R[1, 0], R[1, 1])]
        else:
            # From the arm to the UAV by Rz, Rx, Ry.
            R = turn_of(truth["ee_quat"]).T @ B
            q[s.hinge_qpos] = [atan2(-R[0, 1], R[1, 1]), _arcsin(R[2, 1]), atan2(-R[2, 0], R[2, 2])]
        mujoco.mj_kinematics(self.model, self._data)
        if self._carried:
            self._carry(np.array(truth["ee"]), turn_of(truth["ee_quat"]))
        mujoco.mj_camlight(self.model, self._data)

    def _carry(self, place: Array, turn: Array) -> None:
        # To where the truth has the end effector: (3,), m, W, and its attitude (3, 3).
        d, ee = self._data, self.model.site(EE_SITE).id
        by = turn @ d.site_xmat[ee].reshape(3, 3).T
        at = d.site_xpos[ee].copy()
        for b in self._carried:
            R = by @ d.xmat[b].reshape(3, 3)
            d.xpos[b] = place + by @ (d.xpos[b] - at)
            d.xquat[b], d.xmat[b] = quaternion_of(R), R.ravel()
            d.xipos[b] = place + by @ (d.xipos[b] - at)
        d.site_xpos[ee] = place

    @property
    def bodies(self) -> tuple[Array, Array]:
        """Positions (nbody, 3), m, and attitudes (nbody, 4), scalar first, W."""
        return self._data.xpos, self._data.xquat

    @property
    def turns(self) -> Array:
        """The same attitudes as matrices (nbody, 3, 3), W<-body."""
        return self._data.xmat.reshape(-1, 3, 3)

    @property
    def end_effector(self) -> Array:
        """The end effector point (3,), m, W."""
        return np.array(self._data.site(EE_SITE).xpos)

    def camera(self, name: str) -> tuple[Array, Array] | None:
        """Optical centre (3,), m, W, and attitude (4,), W<-camera with z along the view and y down; None where there is none."""
        number = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_CAMERA, name)
        if number < 0:
            return None
        # MuJoCo's cameras look along their -z, with y up.
        R = self._data.cam_xmat[number].reshape(3, 3) * [1.0, -1.0, -1.0]
        return np.array(self._data.cam_xpos[number]), quaternion_of(R)


def turn_of(quat: Array) -> Array:
    """Rotation matrix (3, 3) of a logged attitude (4,), scalar first; of what is none, in a damaged log, no turn at all."""
    norm = float(np.linalg.norm(quat))
    return matrix(quat / norm) if 0.5 < norm < np.inf else np.eye(3)


def _arcsin(sine: float) -> float:
    # Rounding may carry it beyond one.
    return asin(min(max(float(sine), -1.0), 1.0))


def forces_from(truth: Records) -> Array:
    """Force on the UAV at the hinge (3,), N, W; zeros where it is none."""
    force = np.array(truth["hinge_force"], dtype=float)
    return force if np.isfinite(force).all() else np.zeros(3)


def to_world(truth: Records, points: Array) -> Array:
    """Points (k, 3), m, D, in W at one tick."""
    return np.asarray(points) @ matrix(np.array(truth["deck_quat"])).T + truth["deck"]
