"""What wind asks of a UAV that hovers in it: how far it leans, what its rotors gain, whether it can, and up to which gusts."""

import numpy as np

from armland.errors import ConfigurationError
from armland.mission.belief import rotors_of
from armland.models.airframe.lift import lift_range
from armland.models.inflow import factor_at_speed, sustained
from armland.models.weather import expected
from armland.plant.wind.profile import height_of_catch, speed_at, towards
from armland.records import Record
from armland.rotations import Array
from armland.scenario import Scenario

SEARCHES = 40

LEANS = np.deg2rad(np.arange(0.0, 90.0, 0.25))
"""Leans that are tried against a gust, rad."""

STRONGEST_MPS = 40.0
"""W₂₀ that is looked at at most: the strongest that a scenario may foretell."""


def steady_wind(scenario: Scenario, height: float, timed: Array) -> Array:
    """Steady horizontal wind (3,), m/s, W, at `height` m above ground or sea: the mean wind, and the mean of a recorded one.

    Args:
        scenario: its section `[air]`.
        height: where.
        timed: (k, 3) m/s, W, of `wind.timed.timed_wind`.
    """
    wind = speed_at(scenario, height) * towards(scenario)
    if scenario.air.trace is not None:
        wind[:2] += timed[:, :2].mean(axis=0)
    return wind


def lift_gain(rotors: Record, pull: float, wind: Array, up: Array) -> float:
    """Thrust of rotors that stand still in the air over their static thrust, 1.

    Args:
        rotors: of `devices.rotors.told_layout`.
        pull: N, of all together.
        wind: (3,) m/s, W.
        up: (3,) body z axis, 1, W.
    """
    gain = 1.0
    if not rotors["inflow"]:
        return gain
    axial = -float(wind @ up)
    in_plane = float(np.sqrt(max(float(wind @ wind) - axial**2, 0.0)))
    for _ in range(SEARCHES):
        static = pull / (gain * int(rotors["count"]))
        gain = factor_at_speed(static, in_plane, axial, rotors["disc"], rotors["slope"], rotors["advance"])
    return float(gain)


def check_wind(scenario: Scenario, mass: float, timed: Array, lean: float = 0.0) -> None:
    """Refuse a steady wind in which the UAV cannot hover within its own limits.

    Args:
        scenario: as it flies.
        mass: kg, of all that flies.
        timed: (k, 3) m/s, W, of `wind.timed.timed_wind`.
        lean: rad, that the ground asks of the UAV at most, where that is more than in calm air.

    Raises:
        ConfigurationError: the wind at the catch, what it asks for, the bound, and the strongest wind that can be flown.
    """
    if not scenario.air.blows:
        return
    speed = float(np.linalg.norm(steady_wind(scenario, height_of_catch(scenario), timed)))
    lean = max(lean, scenario.control.station.tilt_max_rad)
    found = _beyond(scenario, mass, speed, lean)
    if not found:
        return
    low, high = 0.0, speed
    for _ in range(SEARCHES):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if _beyond(scenario, mass, middle, lean) else (middle, high)
    a = scenario.air
    where = f"air.wind_mps = {a.wind_mps:g}" if a.trace is None else "air.trace"
    most = (
        f", air.wind_mps = {np.floor(10.0 * a.wind_mps * low / speed) / 10.0:g}" if a.trace is None else " on average"
    )
    raise ConfigurationError(
        f"{where}: {speed:.2f} m/s of steady wind at the catch, {height_of_catch(scenario):.2f} m above the ground: {found}; "
        f"this UAV can fly in {low:.2f} m/s there{most}"
    )


def _beyond(scenario: Scenario, mass: float, speed: float, most: float) -> str:
    # What a steady wind of `speed` m/s asks for too much; empty where nothing. The ground asks for a lean of up to `most` rad.
    own, weight = scenario.onboard.hover, -mass * scenario.environment.gravity_mps2[2]
    drag, (_, static) = scenario.uav.drag_nspm * speed, lift_range(scenario)
    lean = float(np.arctan2(drag, weight))
    bounds = {"onboard.hover.tilt_max_rad": own.tilt_max_rad, "control.station.tilt_max_rad": most}
    name = min(bounds, key=lambda n: bounds[n])
    if lean > bounds[name]:
        return f"{drag:.2f} N of drag, against which the UAV would lean {lean:.3f} rad; {name} = {bounds[name]:.3g}"
    thrust = min(own.thrust_max_n, scenario.control.thrust.ceiling * static)
    lift = sustained(rotors_of(scenario)._replace(static=thrust), speed, scenario.uav.drag_nspm)
    if not scenario.rotors.inflow:
        lift = float(np.sqrt(max(thrust**2 - drag**2, 0.0)))
    if lift <= 0.0:
        return f"its rotors hold {drag:.2f} N of drag at no lean"
    if lift < weight:
        return f"leaning against {drag:.2f} N of drag its rotors carry {lift:.2f} N of its {weight:.2f} N"
    return ""


def left_in_gust(scenario: Scenario, mass: float, w20: float, gust: float) -> float:
    """Force upwards, N, that is left of all its thrust to a UAV that keeps its place in a gust, beyond its weight and drag.

    The gust blows along the wind and down at once, by `gust` standard deviations of each, and lasts. What the rotors give depends on
    the air through them by (I.2): a UAV that leans into the wind has it blow down through its rotors.

    Args:
        scenario: its UAV, rotors and the height of its catch.
        mass: kg, of all that flies.
        w20: mean wind at 20 ft, m/s.
        gust: 1.

    Returns:
        Minus its weight where no lean holds the drag.
    """
    own, drag, (_, static) = rotors_of(scenario), scenario.uav.drag_nspm, lift_range(scenario)
    thrust = min(scenario.onboard.hover.thrust_max_n, scenario.control.thrust.ceiling * static)
    weight = -mass * scenario.environment.gravity_mps2[2]
    air = expected(scenario.replaced({"forecast": {"wind_mps": w20}}))
    along, down, one = air.gust(gust), gust * air.sinking, thrust / own.number
    for lean in LEANS:
        c, s = np.cos(lean), np.sin(lean)
        gain = 1.0
        if scenario.rotors.inflow:
            gain = factor_at_speed(
                one, abs(along * c - down * s), along * s + down * c, own.disc, own.slope, own.advance
            )
        if gain * thrust * s >= drag * along:
            return float(gain * thrust * c - weight - drag * down)
    return -weight


def holds_height_in(scenario: Scenario, mass: float, gust: float) -> float:
    """Strongest W₂₀, m/s, in which the UAV holds its height through a gust.

    Args:
        scenario: as for `left_in_gust`.
        mass: kg, of all that flies.
        gust: standard deviations of it, 1.
    """
    low, high = 0.0, STRONGEST_MPS
    for _ in range(SEARCHES):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if left_in_gust(scenario, mass, middle, gust) >= 0.0 else (low, middle)
    return low


def told_gusts(scenario: Scenario, mass: float) -> str:
    """A sentence on a wind whose gusts take the UAV down with all its thrust; empty where those of two standard deviations do not.

    Args:
        scenario: as it flies, with the wind that its user foretells.
        mass: kg, of all that flies.
    """
    w20 = scenario.foretold_mps
    if w20 <= 0.0 or left_in_gust(scenario, mass, w20, 2.0) >= 0.0:
        return ""
    often, seldom = (holds_height_in(scenario, mass, k) for k in (1.0, 2.0))
    return (
        f"in {w20:g} m/s at 20 ft gusts take this UAV down with all its thrust: it holds its height in those of two standard "
        f"deviations up to {seldom:.1f} m/s, of one up to {often:.1f} m/s"
    )
