"""What the plant says of a scenario's places before anything moves.

In the box of starts the UAV must touch nothing, and the waiting arm's camera must see its marker.
"""

from collections.abc import Iterator
from itertools import product

import mujoco
import numpy as np

from armland.errors import ConfigurationError
from armland.models.description import EE_SITE
from armland.plant.devices.camera import visible
from armland.plant.devices.camera_numbers import camera_told
from armland.plant.scene.composition import Scene
from armland.plant.scene.eye import MARKER_DOWN
from armland.rotations import Array, from_rotation_vector, matrix
from armland.scenario import Scenario

CLEARANCE_M = 0.05
"""Distance that the UAV keeps at its start: a UAV that hovers by itself wanders."""

HEIGHTS_M = np.arange(0.0, 2.0, 0.01)
"""Heights above the catch that are tried to say what would have worked."""


def check_start(scenario: Scenario, scene: Scene, home: Array) -> None:
    """Refuse a box of starts in which the UAV could touch something, or where the waiting arm's camera could not see it.

    Args:
        scenario: place and camera.
        scene: of the plant; its model is not changed.
        home: joint positions (n,) rad of the waiting arm.

    Raises:
        ConfigurationError: the point, what is wrong there, and the heights at which the whole box would do.
    """
    bench = _Bench(scenario, scene, home)
    place = scenario.place
    problem = next(bench.problems(place.start_above_m), None)
    if problem is None:
        return
    good = [h for h in HEIGHTS_M if next(bench.problems(h), None) is None]
    half = ", ".join(f"{x:g}" for x in place.start_offset_m)
    hint = (
        f"with these half widths place.start_above_m from {good[0]:.2f} to {good[-1]:.2f} would do"
        if good
        else "no place.start_above_m would do; make place.start_offset_m smaller"
    )
    raise ConfigurationError(
        f"place.start_above_m = {place.start_above_m:g} and start_offset_m = ({half}) let the UAV start at {problem}; {hint}"
    )


class _Bench:
    """The scene with the arm at rest, where the UAV is put here and there."""

    def __init__(self, scenario: Scenario, scene: Scene, home: Array) -> None:
        self._scene, self._data = scene, mujoco.MjData(scene.model)
        self._place, self._eye = scenario.place, scenario.camera
        self._data.qpos[scene.joint_qpos] = home
        heading = np.deg2rad(scenario.place.start_heading_deg)
        self._attitudes = [from_rotation_vector(np.array([0.0, 0.0, h])) for h in (-heading, 0.0, heading)]
        self._told = camera_told(scenario.camera, scenario.run.rate_hz)[0]
        self._down = matrix(MARKER_DOWN)

    def problems(self, above: float) -> Iterator[str]:
        """What is wrong at corners, edges and middles of the box whose middle is `above` m above the catch."""
        place = self._place
        middle, half = np.array(place.catch_m) + [0.0, 0.0, above], np.array(place.start_offset_m)
        corners = np.stack(np.meshgrid(*3 * [[-1.0, 0.0, 1.0]]), axis=-1).reshape(-1, 3)
        for corner, quat in product(corners, self._attitudes):
            where = f"({', '.join(f'{x:.2f}' for x in middle + corner * half)}) m"
            near = self._nearest(middle + corner * (half + CLEARANCE_M), quat)
            if near is not None:
                yield f"{where}, less than {CLEARANCE_M:g} m beside {near}"
            if not self._seen(middle + corner * half, quat):
                yield f"{where}, where the camera of the waiting arm does not see its marker"

    def _put(self, pivot: Array, quat: Array) -> Array:
        self._data.qpos[self._scene.uav_qpos] = np.concatenate([pivot - matrix(quat) @ self._scene.lever, quat])
        mujoco.mj_kinematics(self._scene.model, self._data)
        return self._data.qpos[self._scene.uav_qpos[:3]]

    def _nearest(self, pivot: Array, quat: Array) -> str | None:
        self._put(pivot, quat)
        mujoco.mj_collision(self._scene.model, self._data)
        model, uav = self._scene.model, (self._scene.uav_body, self._scene.plate_body)
        for geoms in self._data.contact.geom:
            on_uav = np.isin(model.geom_bodyid[geoms], uav)
            if on_uav.any() and not on_uav.all():
                return str(model.geom(int(geoms[~on_uav][0])).name).removesuffix("_shape")
        return None

    def _seen(self, pivot: Array, quat: Array) -> bool:
        cm, R = self._put(pivot, quat), matrix(quat)
        d, eye = self._data, self._eye
        ee, R_we = d.site(EE_SITE).xpos, d.site(EE_SITE).xmat.reshape(3, 3)
        offset = R_we.T @ (cm + R @ np.array(eye.marker_m) - ee - R_we @ np.array(eye.position_m))
        return bool(visible(offset, np.ascontiguousarray(R_we.T @ R @ self._down), self._told))
