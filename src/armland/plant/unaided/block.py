"""A block of ticks of a landing without an arm, compiled, controller and physics inside."""

from numba import njit

from armland.mission.unaided.controller import control_unaided
from armland.mission.unaided.decide import AWAY, DONE
from armland.native import mj_step
from armland.plant.cycle import APPLIED, Views, actuate, sense
from armland.plant.noise import BLOCK, Noise
from armland.plant.unaided.hexapod import compensate
from armland.records import Records
from armland.rotations import Array


@njit(cache=True, nogil=True)
def fly_unaided(
    k: int,
    world: Records,
    views: Views,
    noise: Noise,
    physics: tuple[int, int],
    board: Records,
    machine: tuple[Records, Array],
    watch: int,
    rows: Records,
) -> tuple[int, int]:
    """Fly from tick `k` until `rows` are full or the mission is over; arguments and results as for `plant.block.fly_block`.

    Args:
        k: tick to begin with.
        world: (1,) of `world.world_layout`, updated.
        views: of MuJoCo's arrays.
        noise: whose block holds all ticks flown.
        physics: addresses of the plant's `MjModel` and `MjData`.
        board: (1,) of `unaided.board`, updated.
        machine: (1,) of `hexapod.layout`, updated, and the noise (BLOCK, 12) of its motion reference.
        watch: ticks for which a mission that has ended is watched further.
        rows: (ticks,) of `records.tick_layout`, written.

    Returns:
        How many ticks were flown, and `cycle.APPLIED`, or `NOT_FINITE` where the next one was refused.
    """
    b, w = board[0], world[0]
    t, s = b.tick, b.kept.descent
    for i in range(rows.shape[0]):
        sense(k + i, w, views, noise, t.measurement, t.truth)
        control_unaided(board)
        status = actuate(k + i, w, views, noise, t.mission.phase, t.command, t.truth)
        if status != APPLIED:
            return i, status
        if machine[0][0].fitted:
            row = (k + i) % BLOCK
            given = noise.deck[row], machine[1][row]
            compensate(k + i, machine[0][0], *given, views.qpos, views.qvel, views.qfrc_applied, views.qfrc_bias)
        rows[i] = t
        mj_step(physics[0], physics[1])
        if s.phase in (DONE, AWAY) and k + i - s.begin >= watch:
            return i + 1, APPLIED
    return rows.shape[0], APPLIED
