"""The thrust along body z that a UAV's rotors can give together without turning it."""

import numpy as np

from armland.errors import ModelError
from armland.models.airframe.allocation import allocation_layout, share_out, tell_allocation
from armland.models.parameters import rotor_effect
from armland.records import Records
from armland.rotations import Array
from armland.scenario import Scenario

KEPT = 1e-3
"""Share of the thrust, and of it times the rotors' distance, that may be missing where the rotors still hold the attitude."""

STEPS = 40


def lift_range(scenario: Scenario) -> tuple[float, float]:
    """Least and largest thrust, N, without torque. Four upright rotors: four times one's, as they are trimmed to be equal.

    Raises:
        ModelError: the file cannot be used, or its rotors cannot lift without turning the UAV; says which axis it turns about.
    """
    r, effect = scenario.rotors, rotor_effect(scenario)
    n, told = effect.shape[1], np.zeros(1, np.dtype(allocation_layout()))
    tell_allocation(told, effect, r.min_thrust_n, r.max_thrust_n)
    if told["exact"][0]:
        return n * r.min_thrust_n, n * r.max_thrust_n
    total = r.max_thrust_n * float(effect[0].sum())
    tried = np.linspace(0.0, total, 201)
    good = [f for f in tried if _holds(f, told, effect)]
    if not good:
        left = effect[1:4] @ share_out(0.5 * total, np.zeros(3), told[0])[:n]
        axis = ("roll", "pitch", "yaw")[int(np.argmax(np.abs(left)))]
        raise ModelError(
            f"UAV file {scenario.uav.file!r}: its {n} rotors turn it in {axis} at every thrust: the centre of mass must lie between "
            "them, and the reaction torques of those that turn either way must balance"
        )
    low, high = good[0], good[-1]
    least = r.min_thrust_n * float(effect[0].sum())
    lowest, highest = _edge(low, low - total / 200.0, told, effect), _edge(high, high + total / 200.0, told, effect)
    # What may be missing at the edge is not there.
    return max(lowest, least), min(highest, total)


def _holds(thrust: float, told: Records, effect: Array) -> bool:
    rotor = share_out(float(thrust), np.zeros(3), told[0])[: effect.shape[1]]
    given, reach = effect[:4] @ rotor, float(np.abs(effect[1:3]).max())
    size = KEPT * max(float(thrust), float(rotor.sum()))
    yaw = size * float(np.abs(effect[3]).max())
    return bool(abs(given[0] - thrust) <= size and np.abs(given[1:3]).max() <= size * reach and abs(given[3]) <= yaw)


def _edge(good: float, bad: float, told: Records, effect: Array) -> float:
    for _ in range(STEPS):
        middle = 0.5 * (good + bad)
        good, bad = (middle, bad) if _holds(middle, told, effect) else (good, middle)
    return good
