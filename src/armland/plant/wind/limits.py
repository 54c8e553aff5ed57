"""What the steady wind asks of a UAV that hovers in it: how far it leans, what its rotors gain, and whether it can."""

import numpy as np

from armland.errors import ConfigurationError
from armland.mission.belief import rotors_of
from armland.models.airframe.lift import lift_range
from armland.models.inflow import factor_at_speed, sustained
from armland.plant.wind.profile import height_of_catch, speed_at, towards
from armland.records import Record
from armland.rotations import Array
from armland.scenario import Scenario

SEARCHES = 40


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
