"""From a scenario to what the laws are told: the row of the table, Table II's switches, body, gains, limits."""

from typing import NamedTuple

import numpy as np

from armland.control.laws.own import OwnLaw, load
from armland.control.laws.rigid_body import BacksteppingGains, ExactGains, UavParameters, check
from armland.control.laws.table import ACCELERATIONS, EXTRA_TORQUES, LAWS, OWN, SUPPORTS, told_layout
from armland.errors import ConfigurationError
from armland.models.airframe.allocation import tell_allocation
from armland.models.parameters import rotor_effect
from armland.records import Records
from armland.scenario import Scenario
from armland.scenario.control import Experiment


class Row(NamedTuple):
    """A row of the table of laws."""

    name: str
    law: int
    """Index into `table.LAWS`, or `table.OWN`."""
    own: OwnLaw | None
    """A user's law; whoever flies it keeps it."""


def row_of(name: str) -> Row:
    """The row `name`: one of `table.LAWS`, or FILE.py:FUNCTION.

    Raises:
        ConfigurationError: no such row, or a file that gives no law; says what would have worked.
    """
    if name in LAWS:
        return Row(name, LAWS.index(name), None)
    if ".py:" not in name:
        raise ConfigurationError(f"law {name!r}: there is {', '.join(LAWS)}, or a law of one's own as FILE.py:FUNCTION")
    return Row(name, OWN, load(name))


def told(scenario: Scenario, experiment: Experiment, row: Row, uav: UavParameters, gains: ExactGains) -> Records:
    """The record (1,) of `table.told_layout`.

    Args:
        scenario: as the controller believes it.
        experiment: the switches of Table II.
        row: of `row_of`.
        uav: the body that the hinge carries.
        gains: of the law; the published laws use the k₃ of the position.

    Raises:
        ConfigurationError: gains or body for which the proof does not hold.
    """
    check(uav, gains)
    check(uav, BacksteppingGains(gains.k1, gains.k2, gains.k3_position))
    c, rotors, link, p = scenario.control, scenario.rotors, scenario.link, np.zeros(1, told_layout())
    p["law"], p["address"], p["attitude"] = row.law, row.own.address if row.own else 0, 1
    p["extra_torque"] = EXTRA_TORQUES.index(experiment.extra_torque)
    p["acceleration"] = ACCELERATIONS.index(experiment.acceleration)
    p["support"], p["limited"] = SUPPORTS.index(experiment.support), experiment.limits
    p["mass"], p["inertia"], p["lever"] = uav
    p["k1"], p["k2"], p["k3_attitude"], p["k3"] = gains
    tell_allocation(p["allocation"], rotor_effect(scenario), rotors.min_thrust_n, rotors.max_thrust_n)
    p["torque_limit"], p["takeover_limit"] = link.torque_limit_nm, c.takeover_limit_n
    p["tool_mass"], p["preview"] = scenario.tool.tool_mass_kg, preview(scenario)
    return p


def preview(scenario: Scenario) -> int:
    """Ticks by which a fed-forward torque is late: the uplink, half a cycle on board, and the rotors' lag."""
    late_s = 1e-3 * scenario.link.uplink_delay_ms + 0.5 / scenario.onboard.rate_hz + scenario.rotors.time_constant_s
    return round(late_s * scenario.run.rate_hz)
