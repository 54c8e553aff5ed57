"""Paths of the subsystem, followed with controlled error, and what they say about V₂; compiled.

Where η_e changes sign, α jumps, and V₂ with it (Remark 1). No step straddles that: the steps close in on it, and the path
goes across within `ACROSS_S`, so that what V₂ does along the flow and what it does in the jump are told apart.
"""

import numpy as np
from numba import njit
from numpy.typing import NDArray

from armland.experiments.proof.dormand_prince import TIMES, excess, next_step, stage
from armland.experiments.proof.subsystem import Setting, flow, reference_at, storage
from armland.records import Record
from armland.rotations import Array, angle, error, sgn

LOG = np.dtype([("t", "f8"), ("v2", "f8"), ("angle", "f8"), ("distance", "f8"), ("jumped", "i8"), ("y", "f8", (13,))])
"""A row of a path: s, N·m, rad, m; whether η_e changed sign since the row before; the state."""

SUMMARY = np.dtype(
    [
        ("v2_start", "f8"),  # N·m
        ("end", "f8"),  # s
        ("rise", "f8"),  # largest change of V₂ over a step, relative to V₂ at its start; jumps apart
        ("jumps", "i8"),
        ("jump_rise", "f8"),  # largest change of V₂ over a jump, relative likewise; -1 if there is none
        ("settled", "f8"),  # s, when V₂ first is at SETTLED of its start; NaN if never
        ("arrived", "f8"),  # s, since when the path is at the goal; NaN if it is not at its end
        ("visited_t", "f8"),  # s, a time along it
        ("visited", "f8", (13,)),  # the state then
    ]
)
"""What is kept of a path."""

SETTLED = 0.01  # Part of its initial value at which V₂ counts as settled
NEAR_RAD, NEAR_M = np.deg2rad(0.1), 1e-4  # At the goal: within this angle and this distance of it

ACROSS_S, FIRST_STEP_S, SMALLEST_STEP_S = 1e-12, 1e-3, 1e-15
MAX_ROWS = 20_000


@njit(cache=True)
def follow(problem: Record, setting: Setting, log: NDArray[np.void]) -> int:
    """Follow a problem from its start; fills `log` of `LOG`, a row per step, and returns how many rows are filled.

    It ends when V₂ is at most `setting.enough`, at the horizon, when the log is full or when no step is small enough.
    """
    y, trial, slopes = problem.start.copy(), np.empty(13), np.empty((7, 13))
    t, h, rows = 0.0, FIRST_STEP_S, 1
    eta = flow(t, y, problem, setting, slopes[0])
    _note(log[0], t, y, 0, problem, setting)
    while rows < log.shape[0] and t < setting.horizon and h > SMALLEST_STEP_S and log[rows - 1].v2 > setting.enough:
        h = min(h, setting.horizon - t)
        crossing, eta_end = _stages(t, y, h, eta, problem, setting, slopes, trial)
        if crossing > ACROSS_S:
            # The next attempt ends just before the change of sign.
            h = 0.95 * crossing
            continue
        if crossing >= 0.0:
            t += 2.0 * ACROSS_S
            y += 2.0 * ACROSS_S * slopes[0]
            eta_end = flow(t, y, problem, setting, slopes[0])
            h = FIRST_STEP_S
        else:
            over = excess(y, trial, slopes, h, setting.tolerance, setting.tolerance)
            step, h = h, next_step(h, over)
            if not over <= 1.0:
                continue
            t += step
            y[:] = trial
            # V₂ of (X.1) feels the quaternion's norm to first order.
            y[:4] /= np.sqrt((y[:4] ** 2).sum())
            slopes[0] = slopes[6]
        _note(log[rows], t, y, int(sgn(eta_end) != sgn(eta)), problem, setting)
        eta = eta_end
        rows += 1
    return rows


@njit(cache=True)
def _stages(
    t: float, y: Array, h: float, eta: float, problem: Record, setting: Setting, slopes: Array, out: Array
) -> tuple[float, float]:
    # Stages of a step of h from y, where η_e is `eta`. Returns the time into the step at which η_e changes sign, by a
    # straight line to the first stage on the other side, or -1; and η_e at the step's end.
    eta_i = eta
    for i in range(1, 7):
        stage(y, slopes, i, h, out)
        eta_i = flow(t + TIMES[i] * h, out, problem, setting, slopes[i])
        if sgn(eta_i) != sgn(eta):
            return TIMES[i] * h * eta / (eta - eta_i), eta_i
    return -1.0, eta_i


@njit(cache=True)
def _note(row: Record, t: float, y: Array, jumped: int, problem: Record, setting: Setting) -> None:
    reference = reference_at(t, problem)
    row.t = t
    row.v2, _ = storage(t, y, problem, setting)
    row.angle = angle(error(reference.q_d, y[:4]))
    row.distance = np.sqrt(((reference.r_d - y[7:10]) ** 2).sum())
    row.jumped = jumped
    for i in range(13):
        row.y[i] = y[i]


@njit(cache=True)
def survey_paths(problems: NDArray[np.void], setting: Setting, summaries: NDArray[np.void]) -> None:
    """Follow each of `problems` (k,) of `PROBLEM` and fill its row of `summaries` (k,) of `SUMMARY`."""
    log = np.empty(MAX_ROWS, LOG)
    for i in range(problems.shape[0]):
        rows = follow(problems[i], setting, log)
        summarise(log[:rows], summaries[i])
        # From the first third of the rows: close to the goal 1 − |η_e|, and with it V₂ of (X.1), has lost its digits.
        seen = log[(rows * (1 + i % 3)) // 9]
        summaries[i].visited_t = seen.t
        summaries[i].visited[:] = seen.y


@njit(cache=True)
def summarise(log: NDArray[np.void], s: Record) -> None:
    """Fill the summary `s` of a path's rows `log` (k,); times between rows as if everything decayed exponentially."""
    last = log.shape[0] - 1
    s.v2_start, s.end = log[0].v2, log[last].t
    s.rise, s.jumps, s.jump_rise, s.settled, s.arrived = -1.0, 0, -1.0, np.nan, 0.0
    for k in range(1, last + 1):
        a, b = log[k - 1], log[k]
        change = b.v2 / a.v2 - 1.0
        if b.jumped:
            s.jumps += 1
            s.jump_rise = max(s.jump_rise, change)
        else:
            s.rise = max(s.rise, change)
        if np.isnan(s.settled) and b.v2 <= SETTLED * s.v2_start:
            s.settled = _when(a.t, b.t, a.v2, b.v2, SETTLED * s.v2_start)
        if a.angle > NEAR_RAD:
            s.arrived = _when(a.t, b.t, a.angle, b.angle, NEAR_RAD)
        if a.distance > NEAR_M:
            late = _when(a.t, b.t, a.distance, b.distance, NEAR_M)
            s.arrived = max(s.arrived, late) if a.angle > NEAR_RAD else late
    if log[last].angle > NEAR_RAD or log[last].distance > NEAR_M:
        s.arrived = np.nan


@njit(cache=True)
def _when(t_a: float, t_b: float, a: float, b: float, level: float) -> float:
    # When what falls from a to b passes the level; the end where it does not.
    if b >= level or b <= 0.0:
        return t_b
    return t_a + (t_b - t_a) * np.log(a / level) / np.log(a / b)
