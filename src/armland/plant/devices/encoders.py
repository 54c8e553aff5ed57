"""Joint encoders: position and velocity of each joint, with offset, resolution and white noise.

The speed is made of the position's counts, so a reading that stays has no speed and one that creeps has the creep's.

| symbol | name | unit |
|---|---|---|
| σ | `sigma_q`, `sigma_qd` | rad, rad/s |
| q₀ | `offset` (n,): what each encoder reads too much | rad |
| Δ | `resolution`: positions are read as whole multiples of it; 0: as they are | rad |
| 1/K | `compliance` (n,): wind-up between encoder and link, q + τ/K is read | rad/(N·m) |
"""

import numpy as np
from numba import njit

from armland.plant.scene.composition import Scene
from armland.records import Record, Records
from armland.rotations import Array
from armland.scenario import Scenario


def told_layout(joints: int) -> np.dtype:
    """What the encoders of an arm with `joints` joints are told."""
    return np.dtype(
        [
            ("at_q", "i8"),  # first position in sensordata
            ("at_qd", "i8"),
            ("sigma_q", "f8"),
            ("sigma_qd", "f8"),
            ("resolution", "f8"),
            ("offset", "f8", (joints,)),
            ("at_tau", "i8"),
            ("compliance", "f8", (joints,)),
        ]
    )


def tell(told: Records, scenario: Scenario, scene: Scene, noisy: bool) -> None:
    """Fill `told` (1,); `noisy` says whether there is white noise."""
    if not scene.joints:
        return
    first = scene.model.joint(int(scene.model.dof_jntid[scene.joint_dof[0]])).name
    told["at_q"], told["at_qd"] = scene.sensor[f"q_{first}"], scene.sensor[f"qd_{first}"]
    told["at_tau"] = scene.sensor[f"tau_{first}"]
    if noisy:
        told["sigma_q"] = scenario.sensors.joint_position_rad
        told["sigma_qd"] = scenario.sensors.joint_velocity_rad_s


@njit(cache=True)
def sample(k: int, data: Array, told: Record, faults: Record, noise: Array, m: Record) -> None:
    """Sample all joints into the measurement `m`.

    Args:
        k: present tick.
        data: MuJoCo's `sensordata` (nsensordata,), in the units of each sensor: m, rad, N, 1 for quaternions.
        told: of `told_layout`.
        faults: what fails, of `faults.table.kept_layout`.
        noise: standard normal numbers (2n,).
        m: `q` rad, `qd` rad/s and `arm_tick` are written.
    """
    if faults.arm_stale:
        return
    n = m.q.shape[0]
    m.arm_tick = k
    for i in range(n):
        if faults.encoder_stuck[i]:
            m.qd[i] = 0.0
            continue
        q = data[told.at_q + i] + told.offset[i] + faults.encoder_off[i]
        q += told.compliance[i] * data[told.at_tau + i]
        if told.resolution > 0.0:
            q = told.resolution * np.floor(q / told.resolution + 0.5)
        m.q[i] = q + told.sigma_q * noise[i]
        m.qd[i] = data[told.at_qd + i] + faults.encoder_creep[i] + told.sigma_qd * noise[n + i]
