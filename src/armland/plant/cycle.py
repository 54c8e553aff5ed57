"""One cycle of all devices around the physics step, in two compiled calls: what is sampled before, what acts after."""

from typing import NamedTuple

import mujoco
import numpy as np
from numba import int64, njit, types

from armland.linking import MATRIX, VECTOR, head, linked, record
from armland.plant import truth as true
from armland.plant.devices import (
    air,
    brake,
    camera,
    encoders,
    imu,
    link,
    magnet,
    motors,
    onboard,
    rotors,
    wrench,
)
from armland.plant.faults import effects, intrusions
from armland.plant.noise import BLOCK, Noise
from armland.plant.sea import deck, reference
from armland.plant.world import world_layout
from armland.records import Record, layout
from armland.rotations import Array

APPLIED, NOT_FINITE = 0, 1
"""What `actuate` answers: done; command or state are not finite numbers and nothing was applied."""


class Views(NamedTuple):
    """MuJoCo's arrays that the devices read and write; views, of the data and the model that are stepped."""

    sensordata: Array
    ctrl: Array
    xfrc_applied: Array
    geom_xpos: Array
    geom_xmat: Array
    xipos: Array
    dof_frictionloss: Array
    dof_solimp: Array
    qpos: Array
    qvel: Array
    qfrc_applied: Array
    qfrc_bias: Array


VIEWS = types.NamedTuple((VECTOR, VECTOR, *4 * (MATRIX,), VECTOR, MATRIX, *4 * (VECTOR,)), Views)
NOISE = types.NamedUniTuple(MATRIX, len(Noise._fields), Noise)


def views_of(model: mujoco.MjModel, data: mujoco.MjData) -> Views:
    """The views of a model and its data."""
    seen = (data.sensordata, data.ctrl, data.xfrc_applied, data.geom_xpos, data.geom_xmat, data.xipos)
    return Views(
        *seen, model.dof_frictionloss, model.dof_solimp, data.qpos, data.qvel, data.qfrc_applied, data.qfrc_bias
    )


def _seen(n: int) -> tuple:
    # Types of what both halves of a cycle take first.
    return (int64, record(world_layout(n)), VIEWS, NOISE)


@linked(lambda n: (*_seen(n), record(layout("measurement", n)), record(layout("truth", n))))
@njit(cache=True)
def sense(k: int, world: Record, views: Views, noise: Noise, measurement: Record, truth: Record) -> None:
    """Sample all devices at tick `k`.

    Args:
        k: present tick.
        world: of `world.world_layout`, updated.
        views: of MuJoCo's arrays.
        noise: whose block holds tick k.
        measurement: written.
        truth: written.
    """
    told, kept, row = world.told, world.kept, k % BLOCK
    what_fails, data = kept.faults, views.sensordata
    measurement.tick = k
    true.record(k, data, told.truth, kept.rotors, told.rotors.mixer, truth)
    encoders.sample(k, data, told.encoders, what_fails, noise.encoders[row], measurement)
    wrench.sample(k, data, told.wrench, kept.wrench, what_fails, noise.wrench[row], measurement)
    imu.sample(k, told.imu, kept.imu, noise.imu[row], noise.force[row], truth)
    link.report(k, world, noise.link[row])
    link.receive(k, told.link, kept.link, what_fails, noise.link[row], measurement)
    if told.camera.fitted:
        chance = noise.flip[row, 0]
        given = head(measurement), head(truth)
        camera.look(k, told.camera, kept.camera, what_fails.camera, noise.camera[row], *given, chance)
    if told.reference.fitted:
        reference.sample(k, told.reference, kept.reference, noise.reference[row], measurement, truth)
    measurement.magnet_force, measurement.magnet_fault = kept.magnet.report, kept.magnet.fault
    truth.touching = kept.magnet.touching
    if told.faults.count > 0:
        intrusions.corrupt(told.faults, what_fails, measurement)


@linked(lambda n: (*_seen(n), int64, record(layout("command", n)), record(layout("truth", n))), int64)
@njit(cache=True)
def actuate(k: int, world: Record, views: Views, noise: Noise, phase: int, command: Record, truth: Record) -> int:
    """Let all devices act at tick `k`; the physics is stepped afterwards.

    Joint torques act at once; the UAV's part goes over the link to its own controller.

    Args:
        k: present tick.
        world: of `world.world_layout`, updated.
        views: of MuJoCo's arrays; `ctrl`, `xfrc_applied`, the joints' friction and the deck's state are written.
        noise: whose block holds tick k.
        phase: number of the mission's phase, by which faults are armed.
        command: of the tick.
        truth: of the tick.

    Returns:
        `APPLIED` or `NOT_FINITE`.
    """
    told, kept, row = world.told, world.kept, k % BLOCK
    if told.faults.count > 0:
        effects.act(k, phase, told.faults, kept.faults)
    if not _finite(command, truth):
        return NOT_FINITE
    motors.drive(command.tau, told.motors, kept.motors, noise.motors[row], views.sensordata, views.ctrl)
    link.send(k, told.link, kept.link, kept.faults, noise.link[row], command)
    if k % told.onboard.period == 0:
        onboard.fly(k, world, noise, row, truth)
    given = noise.air[row], noise.turbulence[row], noise.wind[row]
    air.blow(told.air, kept.air, kept.faults, given, truth)
    rotors.spin(k, told.rotors, kept.rotors, kept.faults, kept.air, truth, views.xfrc_applied[world.uav])
    if told.magnet.fitted:
        magnet.energise(
            command.magnet,
            views.geom_xpos,
            views.geom_xmat,
            views.xipos,
            told.magnet,
            kept.magnet,
            kept.faults,
            views.xfrc_applied,
        )
        if told.air.wash > 0.0:
            air.wash(told.air, kept.rotors.lift.sum(), truth, views.xfrc_applied[told.magnet.tool])
    brake.brake(k, command.brake, told.brake, kept.brake, views.dof_frictionloss, views.dof_solimp)
    if told.faults.count > 0:
        intrusions.push(told.faults, kept.faults, views.xfrc_applied)
    if told.deck.moves:
        deck.move(told.deck, noise.deck[row], views.qpos, views.qvel, views.qfrc_applied, views.qfrc_bias)
    return APPLIED


@njit(cache=True)
def _finite(c: Record, t: Record) -> bool:
    total = c.thrust
    for i in range(c.tau.shape[0]):
        total += c.tau[i]
    for i in range(4):
        total += c.uav_quat[i] + t.quat[i]
    for i in range(3):
        total += c.delta_tau[i] + c.uav_step[i] + t.r[i] + t.omega[i]
    return bool(np.isfinite(total))
