"""A block of ticks of a landing without an arm, compiled, controller and physics inside."""

from numba import njit

from armland.mission.unaided.controller import control_unaided
from armland.mission.unaided.decide import AWAY, DONE
from armland.native import mj_step
from armland.plant.cycle import APPLIED, Views, actuate, sense
from armland.plant.noise import BLOCK, Noise
from armland.plant.unaided.hexapod import compensate
from armland.plant.unaided.tether import pull
from armland.records import Record, Records
from armland.rotations import Array

Machine = tuple[Records, Array, Records]
"""(1,) of `hexapod.layout`, the noise (BLOCK, 12) of its motion reference, (1,) of `tether.layout`."""


@njit(cache=True)
def act_all(
    k: int, w: Record, views: Views, noise: Noise, phase: int, command: Record, truth: Record, machine: Machine
) -> int:
    """Let all devices act at tick `k`, those of the method as well; arguments and result as for `cycle.actuate`, and the `machine`."""
    status = int(actuate(k, w, views, noise, phase, command, truth))
    if status != APPLIED:
        return status
    platform, row, rope = machine[0][0], k % BLOCK, machine[2][0]
    if platform.fitted:
        given = noise.deck[row], machine[1][row]
        compensate(k, platform, *given, views.qpos, views.qvel, views.qfrc_applied, views.qfrc_bias)
    if rope.fitted:
        pull(rope, phase, truth, views.xipos[w.uav], views.xfrc_applied[w.uav])
    return status


@njit(cache=True)
def act_on(
    k: int, world: Records, views: Views, noise: Noise, phase: int, command: Records, truth: Records, machine: Machine
) -> int:
    """`act_all` for records (1,), from Python."""
    return int(act_all(k, world[0], views, noise, phase, command[0], truth[0], machine))


@njit(cache=True, nogil=True)
def fly_unaided(
    k: int,
    world: Records,
    views: Views,
    noise: Noise,
    physics: tuple[int, int],
    brain: tuple[Records, int],
    machine: Machine,
    rows: Records,
) -> tuple[int, int]:
    """Fly from tick `k` until `rows` are full or the mission is over; arguments and results as for `plant.block.fly_block`.

    Args:
        k: tick to begin with.
        world: (1,) of `world.world_layout`, updated.
        views: of MuJoCo's arrays.
        noise: whose block holds all ticks flown.
        physics: addresses of the plant's `MjModel` and `MjData`.
        brain: (1,) of `unaided.board`, updated; ticks for which a mission that has ended is watched further.
        machine: of the method, updated.
        rows: (ticks,) of `records.tick_layout`, written.

    Returns:
        How many ticks were flown, and `cycle.APPLIED`, or `NOT_FINITE` where the next one was refused.
    """
    board, watch = brain
    b, w = board[0], world[0]
    t, s = b.tick, b.kept.descent
    for i in range(rows.shape[0]):
        sense(k + i, w, views, noise, t.measurement, t.truth)
        control_unaided(board)
        status = act_all(k + i, w, views, noise, t.mission.phase, t.command, t.truth, machine)
        if status != APPLIED:
            return i, status
        rows[i] = t
        mj_step(physics[0], physics[1])
        if s.phase in (DONE, AWAY) and k + i - s.begin >= watch:
            return i + 1, APPLIED
    return rows.shape[0], APPLIED
