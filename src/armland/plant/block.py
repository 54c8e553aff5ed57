"""A block of ticks with the controller and the physics inside, compiled: what a loop in Python does tick by tick.

The only place of the plant that knows the controller, and of it no more than the one function that fills a command.
"""

from numba import njit

from armland.mission.controller import control
from armland.models.arm import Views as ArmViews
from armland.native import mj_step
from armland.plant.cycle import APPLIED, Views, actuate, sense
from armland.plant.noise import Noise
from armland.records import Records
from armland.rotations import Array


@njit(cache=True, nogil=True)
def fly_block(
    k: int,
    world: Records,
    views: Views,
    noise: Noise,
    physics: tuple[int, int],
    brain: tuple[Records, Array, ArmViews],
    watch: int,
    rows: Records,
) -> tuple[int, int]:
    """Fly from tick `k` until `rows` are full or the mission is over: sense, control, actuate, record, step.

    Args:
        k: tick to begin with.
        world: (1,) of `world.world_layout`, updated.
        views: of MuJoCo's arrays.
        noise: whose block holds all ticks flown.
        physics: addresses of the plant's `MjModel` and `MjData`.
        brain: what `mission.controller.control` takes: the board (1,), the path (k, 9) in m, m/s and m/s², and the arm's views.
        watch: ticks for which a mission that has ended is watched further.
        rows: (ticks,) of `records.tick_layout`, written.

    Returns:
        How many ticks were flown, and `cycle.APPLIED`, or `NOT_FINITE` where the next one was refused.
    """
    board, path, arm = brain
    b, w = board[0], world[0]
    t, s = b.tick, b.kept.decide
    for i in range(rows.shape[0]):
        sense(k + i, w, views, noise, t.measurement, t.truth)
        control(board, path, arm)
        status = actuate(k + i, w, views, noise, t.mission.phase, t.command, t.truth)
        if status != APPLIED:
            return i, status
        rows[i] = t
        mj_step(physics[0], physics[1])
        if b.table.phases[s.phase].final == 1 and k + i - s.begin >= watch:
            return i + 1, APPLIED
    return rows.shape[0], APPLIED
