"""What failures do to the UAV, compiled: link, rotors, power, what pulls at it and the air around it."""

import numpy as np
from numba import njit

from armland.records import MOST_ROTORS, Record
from armland.scenario.faults import FAILURES

LINK_LOSS, UPLINK_LOSS, DOWNLINK_LOSS = (FAILURES.index(f"{n}_loss") for n in ("link", "uplink", "downlink"))
ROTOR_LOSS, THRUST_LOSS, POWER_LOSS = (FAILURES.index(f"{n}_loss") for n in ("rotor", "thrust", "power"))
LINK_DELAY, UNREACHABLE = FAILURES.index("link_delay"), FAILURES.index("unreachable")
OVERLOAD, TWIST, GUST = FAILURES.index("overload"), FAILURES.index("twist"), FAILURES.index("gust")


@njit(cache=True)
def fail_link(row: Record, since: float, rate_hz: int, kept: Record) -> None:
    """Set which way the link is lost, and by how much later its messages come.

    Args:
        row: of `table.ROW`, a fault that acts.
        since: time for which it has acted, s.
        rate_hz: of the ticks.
        kept: of `table.kept_layout`, updated.
    """
    kind = row.kind
    if kind in (LINK_LOSS, UPLINK_LOSS):
        kept.uplink_lost = 1
    if kind in (LINK_LOSS, DOWNLINK_LOSS):
        kept.downlink_lost = 1
    elif kind == LINK_DELAY:
        kept.late += int(1e-3 * row.size * since * rate_hz + 0.5)


@njit(cache=True)
def fail_uav(row: Record, since: float, kept: Record) -> None:
    """Set what rotors, board and air around the UAV do.

    Args:
        row: of `table.ROW`, a fault that acts.
        since: time for which it has acted, s.
        kept: of `table.kept_layout`, updated.
    """
    kind = row.kind
    if kind == ROTOR_LOSS:
        kept.rotor[row.rotor] *= 1.0 - row.size
    elif kind in (THRUST_LOSS, POWER_LOSS):
        left = 1.0 - row.size if kind == THRUST_LOSS else 0.0
        kept.unpowered |= kind == POWER_LOSS
        for i in range(MOST_ROTORS):
            kept.rotor[i] *= left
    elif kind == OVERLOAD:
        kept.force[2] = -row.size
    elif kind == UNREACHABLE:
        kept.deaf = 1
        for i in range(3):
            kept.away[i] = row.size * row.direction[i]
    elif kind == TWIST:
        for i in range(3):
            kept.torque[i] = row.size * row.direction[i]
    elif kind == GUST:
        speed = 0.5 * row.size * (1.0 - np.cos(2.0 * np.pi * since / row.lasts))
        for i in range(3):
            kept.wind[i] += speed * row.direction[i]
