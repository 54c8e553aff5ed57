"""Whether a sensor drifts or rotors give too little while the hinge is freed of force: F = W - k T, by the slope of it; compiled."""

from numba import njit

from armland.records import Record

GIVES, RISES, RISES_S, DRIFTS_S = 0.5, 0.03, 0.3, 0.9
"""Least that a UAV's rotors give of the thrust that they are asked for while it does not call a rotor lost, with room for its watch;
share of the weight per s by which the hinge force may rise beyond what such rotors leave, and time constant of that; how much
longer it must have risen than not to be a sensor's drift: a rotor's loss of the moment shows for up to three time constants."""


@njit(cache=True)
def needed(balances: bool, weight: float, hover: float, tick_s: float, e: Record, seen: Record) -> float:
    """Command, N, that would carry the UAV.

    Rotors that give a share k of their thrust relieve the hinge as it rises. A sensor that drifts draws the thrust after it, and the
    force that it shows does not fall.

    Args:
        balances: whether the hinge is being freed of force: what the arm still carries the rotors would have to give as well.
        weight: N.
        hover: command that carries what the rotors carry, N.
        tick_s: s.
        e: estimate.
        seen: what the search for faults remembers; `borne`, `rises` and `rising` are updated.
    """
    borne = e.hinge_force[2] + GIVES * e.thrust
    if not balances:
        seen.borne, seen.rising = borne, 0
    seen.borne += tick_s / RISES_S * (borne - seen.borne)
    seen.rises = 1 if borne - seen.borne > RISES * RISES_S * weight else 0
    seen.rising = max(seen.rising + (1 if seen.rises else -1), 0)
    return hover + max(e.hinge_force[2], 0.0) if balances else hover
