"""The filter that smooths the plate's motion for the arm that follows it; compiled.

| symbol | name | unit |
|---|---|---|
| p, ṗ, p̈ | `kept.p`, `.pv`, `.pa` (3,): the plate's pivot, smoothed | m, m/s, m/s², deck |
| λ | `told.track` | rad/s |

p̈ = a + 2λ (ṗ_e − ṗ) + λ² (p_e − p), limited, with the estimate's p_e, ṗ_e, and a fed forward: a double pole at λ.
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
            a = e.plate_a[i] + 2.0 * p.track * (e.plate_v[i] - s.pv[i]) + p.track**2 * (e.plate[i] - s.p[i])
        a = min(max(a, -p.track_max), p.track_max)
        s.pa[i] = a
        s.pv[i] += a * p.tick_s
        s.p[i] += s.pv[i] * p.tick_s


@njit(cache=True)
def begin_track(e: Record, s: Record) -> None:
    """Begin at the estimate `e`, without an acceleration; `s` is what the reference keeps."""
    for i in range(3):
        s.p[i], s.pv[i], s.pa[i] = e.plate[i], e.plate_v[i], 0.0
