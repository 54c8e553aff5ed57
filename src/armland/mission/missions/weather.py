"""Which limits of calm air give way where the user foretells wind, see `models.weather`: keys that he has not set, and criteria."""

from typing import Any

import numpy as np

from armland.mission.table.mission import Criterion, Mission
from armland.models.airframe.sizing import at, is_settled, nested
from armland.models.parameters import rotor_set, uav_parameters
from armland.models.weather import GUST, LENGTH_M, STRONGEST, Wind, expected, most_lean, swayed
from armland.scenario import Scenario
from armland.scenario.tables import update

STIFF = 1.5, 4.0, 2.0, 2.0
"""Gains of a station that is kept against gusts, 1/s, 1/s, 1/s², and those upwards over those sideways."""

OUT_DEG = 10.0
"""Beyond the largest lean that is asked for, from which on a UAV counts as out of control."""

SPARE_DEG = 5.0
"""Between the lean at which the arm closes and the one at which the UAV counts as out of control."""

LIFT = 0.3
"""Share of the weight by which the rotors' lift changes in a gust that sinks by 1 m/s, or blows along by three times that."""

MOST_CARRIED = 0.75
"""Largest share of the weight that the rotors carry meanwhile: the arm must feel that it holds the UAV."""

LOOKS = 2.0
"""For how many gusts a UAV that is out of view is looked for."""

LONGEST_MS = 6e4
"""Longest search, which is the scenario's bound of it."""

ROUGH_MPS, ROUGH_DEG = 0.25, 5.0
"""Largest speed and tilt at the touchdown of a landing in wind."""


def weathered(scenario: Scenario, mass: float, lands: bool = True) -> Scenario:
    """The believed scenario with the limits that its wind needs; those that the user has set stay, and so does what is wide enough.

    Args:
        scenario: believed.
        mass: kg, of all that flies.
        lands: whether it is flying when the arm takes it over, so that what its rotors really lift is learnt before they carry a share;
            the ramp of a take-off asks for less lift than there will be.
    """
    wind, g = expected(scenario), float(np.linalg.norm(scenario.environment.gravity_mps2))
    if wind.mean <= 0.0:
        return scenario
    rate = scenario.uav.drag_nspm / mass
    strongest = wind.lean(rate / g, STRONGEST)
    # m/s² of gusts, which a stiff station yields to in place and speed.
    gusts = rate * wind.sigma
    # N, of the lift of a UAV whose rotors carry it, in sinking air.
    sinks = LIFT * mass * g * wind.sinking
    share = scenario.control.thrust.carry_share
    share = min(share + _upright(scenario, wind) / (mass * g), MOST_CARRIED) if lands else share
    wanted = {
        "control.station.tilt_max_rad": most_lean(wind, rate / g),
        "limits.tilt_deg": float(np.rad2deg(most_lean(wind, rate / g))) + OUT_DEG,
        "control.station.gust_max_mps2": rate * wind.gust(STRONGEST),
        "bounds.align_tilt_deg": min(float(np.rad2deg(strongest)), scenario.limits.tilt_deg - SPARE_DEG),
        "control.station.k_position": STIFF[0],
        "control.station.k_velocity": STIFF[1],
        "control.station.k_integral": STIFF[2],
        "control.station.vertical": STIFF[3],
        # One skid meets its rail first: the arm goes down on until both do.
        "control.approach.give_way_max_m": scenario.control.approach.give_way_max_m
        + scenario.skids.x_m * float(np.sin(np.deg2rad(ROUGH_DEG))),
        "bounds.force_balanced_n": scenario.bounds.force_balanced_n + scenario.uav.drag_nspm * wind.sigma * GUST,
        "bounds.flown_error_m": scenario.bounds.flown_error_m + gusts / (STIFF[0] * STIFF[1]),
        "bounds.flown_speed_mps": scenario.bounds.flown_speed_mps + gusts / STIFF[1],
        "bounds.level_tilt_deg": 2.0 * scenario.bounds.level_tilt_deg,
        "control.thrust.carry_share": share,
        "bounds.share_touched": scenario.bounds.share_touched + share * LIFT * wind.sinking,
        # A UAV that a gust has taken out of view comes back when the gust is over, or the next.
        # Weak wind has long gusts, and takes none out of view.
        "limits.search_ms": min(scenario.limits.search_ms + 1e3 * LOOKS * LENGTH_M / wind.mean, LONGEST_MS),
        "limits.unexplained_n": scenario.limits.unexplained_n + sinks,
        "limits.shortfall_n": scenario.limits.shortfall_n + GUST * sinks,
    }
    changes: dict[str, Any] = {}
    for key, value in wanted.items():
        if value > at(scenario, key) and not is_settled(scenario, key):
            update(changes, nested(key, value))
    return scenario.replaced(changes) if changes else scenario


def _upright(scenario: Scenario, wind: Wind) -> float:
    # N, of the rotors' thrust that goes into holding a UAV upright that the arm carries below its centre of mass, where the wind
    # pushes: without it some stand still and none is left for the heading, by which its skids would miss the rails.
    place, lever = rotor_set(scenario).place, abs(float(uav_parameters(scenario).lever[2]))
    reach = float(np.abs(place[:, :2]).mean())
    return float(scenario.uav.drag_nspm * wind.gust(GUST) * lever / reach)


def judged(mission: Mission, scenario: Scenario, weight: float) -> Mission:
    """The mission with the criteria of its weather: a touchdown on gusts is harder, and a UAV that flies leans.

    Args:
        mission: of calm air.
        scenario: believed.
        weight: N, of all that flies.
    """
    wind = expected(scenario)
    if scenario.place.keep_hold and mission.judged_as == "landing":
        mission = mission._replace(judged_as="kept", praise="landed; the arm keeps hold of it")
    if wind.mean <= 0.0:
        return mission
    lean, blown = swayed(scenario, weight / float(np.linalg.norm(scenario.environment.gravity_mps2)))
    more = {
        "touchdown_speed": (ROUGH_MPS, 0.0),
        "touchdown_tilt": (ROUGH_DEG, 0.0),
        "flying_tilt": (0.0, lean),
        "flying_speed": (0.0, blown),
    }
    return mission._replace(criteria=tuple(_in_wind(c, *more.get(c.name, (0.0, 0.0))) for c in mission.criteria))


def _in_wind(c: Criterion, least: float, more: float) -> Criterion:
    return c._replace(bound=max(c.bound + more, least))
