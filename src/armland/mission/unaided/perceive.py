"""What the ground knows of a UAV that lands by itself: the arm's pose filter, link and motion reference, without an arm; compiled."""

import numpy as np
from numba import njit

from armland.estimation import deck
from armland.linking import head
from armland.mission.estimate import acting_thrust, learn_uplink, predict_torque, watch_downlink
from armland.mission.screening import screened
from armland.mission.sight import follow, know, tell_plate
from armland.mission.unaided.decide import DESCEND
from armland.models.environment import apparent_gravity
from armland.records import Record

STILL = np.array([1.0, 0.0, 0.0, 0.0])
"""D<-camera: it looks upwards."""


@njit(cache=True)
def perceive(b: Record, stands: bool) -> None:
    """Fill the estimate of the tick from its measurement.

    Args:
        b: `unaided.board`.
        stands: whether the UAV is believed to stand on the pad.
    """
    m, e, p, s = b.tick.measurement, b.tick.estimate, b.told.estimate, b.kept.estimate
    if m.deck_known:
        deck.as_sent(m, s.good)
    s.bad = screened(m, s.good, s.same, False, p.joint_leap, p.attitude_leap, p.tick_s)
    if m.deck_known:
        deck.know_deck(m, p.gravity, p.tick_s, p.deck, s.deck, b.environment)
        deck.turn_into_deck(m, b.environment, p.tick_s)
    watch_downlink(m, p, s)
    learn_uplink(m, p, s)
    e.tick, e.thrust = m.tick, acting_thrust(m.tick, p, s)
    _follow(b, stands)
    s.seen = 1 if e.plate_valid else s.seen
    predict_torque(b.kept.act.q_d, p, e)
    e.camera_noise, e.uplink, e.downlink = np.sqrt(s.filter.noise), s.uplink * p.tick_s, s.downlink * p.tick_s
    e.weight, e.hover, e.ground_share = p.weight, b.kept.act.hover, 1.0 if stands else 0.0


@njit(cache=True)
def _follow(b: Record, stands: bool) -> None:
    m, e, p, s = b.tick.measurement, b.tick.estimate, b.told.estimate, b.kept.estimate
    gravity, push, eye, view = (
        apparent_gravity(b.environment, e.plate, e.plate_v),
        np.zeros(3),
        np.empty(3),
        STILL.copy(),
    )
    if b.kept.descent.phase == DESCEND and b.told.descent.pull > 0.0:
        push[2] = -b.told.descent.pull / p.mass
    lift = e.thrust * p.weight / max(b.kept.act.hover, 1e-3)
    if stands:
        # What the pad carries goes along with it.
        lift = 0.0
        for i in range(3):
            push[i] = -gravity[i]
    for i in range(3):
        eye[i] = b.told.descent.eye[i]
        e.r[i] = eye[i] - p.camera[i]
    follow(head(m), lift, push, gravity, eye, view, p.filter, s.filter)
    know(p.filter, s.filter, s.plate)
    tell_plate(s.plate, e)
