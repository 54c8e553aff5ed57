"""What the board of a landing without an arm is told, from the believed scenario."""

import numpy as np

from armland.estimation import deck
from armland.estimation.plate import layouts
from armland.mission.belief import Flyer
from armland.mission.told import ATTITUDE_LEAP_RAD, FELT, tell_station
from armland.mission.unaided.board import board_layout
from armland.models.airframe.slope import tell_slope
from armland.models.weather import STRONGEST, expected
from armland.records import Records
from armland.rotations import Array
from armland.scenario import Scenario

FIND_S = 40.0
"""For which a UAV that is not seen is waited for, as by an arm in wind."""

ON_STATION_MPS = 0.25
"""Speed of a UAV that is on its station: that of a touchdown."""


def tell(scenario: Scenario, flyer: Flyer, stand: Array, eye: Array, pull: float = 0.0) -> Records:
    """The board's `told` (1,).

    Args:
        scenario: believed.
        flyer: what flies.
        stand: pivot of a UAV that stands on the pad (3,), m, D.
        eye: optical centre (3,), m, D.
        pull: thrust beyond the weight, N, against a rope; 0: there is none.
    """
    told = np.zeros(1, board_layout(0)["told"])
    _estimate(told["estimate"], scenario, flyer)
    _descent(told["descent"], scenario, stand, eye)
    told["descent"]["pull"] = pull
    tell_station(told["act"]["uav"], scenario, flyer, stand)
    told["limit"]["tick_s"], limit = 1.0 / scenario.run.rate_hz, told["limit"]
    for name in ("q_max", "qd_max", "tau_max", "torque_rate", "hinge_max"):
        limit[name] = np.inf
    limit["q_min"], limit["sigma_min"] = -np.inf, -np.inf
    return told


def _estimate(p: Records, s: Scenario, flyer: Flyer) -> None:
    rate, tick_s = s.run.rate_hz, 1.0 / s.run.rate_hz
    p["gravity"], p["tick_s"], p["fused"] = s.environment.gravity_mps2, tick_s, 1
    p["joint_leap"], p["attitude_leap"] = np.inf, ATTITUDE_LEAP_RAD
    p["mass"], p["weight"] = flyer.mass, flyer.weight
    p["body_mass"], p["lever"] = flyer.body.mass, flyer.body.lever
    p["uplink"], p["learns"] = round(s.link.uplink_delay_ms * rate / 1000.0), 1
    p["rotor_gain"] = 1.0 - np.exp(-1.0 / (rate * s.rotors.time_constant_s))
    p["drag"], p["camera"], p["windy"] = s.uav.drag_nspm, s.camera.position_m, expected(s).mean > 0.0
    p["onboard_kp"], p["onboard_kd"] = s.onboard.kp_nm, s.onboard.kd_nms
    tell_slope(p, s, flyer.body.mass * flyer.gravity, 4)
    gust = FELT * s.uav.drag_nspm / flyer.mass * expected(s).gust(STRONGEST)
    p["filter"], p["deck"] = layouts.told(s, flyer.mass, flyer.body.lever, gust), deck.told(s)


def _descent(p: Records, s: Scenario, stand: Array, eye: Array) -> None:
    d = s.descent
    p["tick_s"], p["stand"], p["eye"] = 1.0 / s.run.rate_hz, stand, eye
    p["wait"], p["ready"], p["sink"], p["align"], p["speed"] = (
        d.wait_m,
        d.ready_m,
        d.sink_mps,
        d.align_m,
        ON_STATION_MPS,
    )
    p["give_up"], p["timed"], p["quiet"], p["patience"] = d.give_up_m, d.timed, d.quiet, d.patience_s
    p["cut"], p["level"], p["find_s"], p["retries"] = d.cut_m, d.level_m, FIND_S, s.bounds.retries
