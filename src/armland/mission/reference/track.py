"""The filter that smooths the plate's motion for the arm that follows it; compiled.

| symbol | name | unit |
|---|---|---|
| p, ṗ, p̈ | `kept.p`, `.pv`, `.pa` (3,): the plate's pivot, smoothed | m, m/s, m/s², deck |
| λ | `told.track` | rad/s |

p̈ = a + 2λ (ṗ_e − ṗ) + λ² (p_e − p), limited, with the estimate's p_e, ṗ_e, and a fed forward: a double pole at λ.

The arm has a room of its own: a plate outside of it is followed to the room's wall and no further, whatever the estimate says.
"""

from numba import njit

from armland.records import Record


@njit(cache=True)
def track(e: Record, p: Record, s: Record) -> None:
    """One tick. Where the estimate of the plate is not valid, the smoothed plate comes to rest.

    Args:
        e: estimate.
        p: what the reference is told.
        s: what it keeps, written.
    """
    for i in range(3):
        a = -2.0 * p.track * s.pv[i]
        if e.plate_valid:
            place, speed, push = e.plate[i], e.plate_v[i], e.plate_a[i]
            if place < p.room[0, i] or place > p.room[1, i]:
                place, speed, push = min(max(place, p.room[0, i]), p.room[1, i]), 0.0, 0.0
            a = push + 2.0 * p.track * (speed - s.pv[i]) + p.track**2 * (place - s.p[i])
        a = min(max(a, -p.track_max), p.track_max)
        v = min(max(s.pv[i] + a * p.tick_s, -p.track_speed), p.track_speed)
        s.p[i] += v * p.tick_s
        if (s.p[i] < p.room[0, i] and v < 0.0) or (s.p[i] > p.room[1, i] and v > 0.0):
            s.p[i], v = min(max(s.p[i], p.room[0, i]), p.room[1, i]), 0.0
        s.pa[i], s.pv[i] = (v - s.pv[i]) / p.tick_s, v


@njit(cache=True)
def begin_track(e: Record, p: Record, s: Record) -> None:
    """Begin at the estimate `e`, within the room, without an acceleration; `s` is what the reference keeps."""
    for i in range(3):
        s.p[i] = min(max(e.plate[i], p.room[0, i]), p.room[1, i])
        s.pv[i] = min(max(e.plate_v[i], -p.track_speed), p.track_speed) if s.p[i] == e.plate[i] else 0.0
        s.pa[i] = 0.0
