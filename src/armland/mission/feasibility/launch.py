"""Plans the run-up of a take-off with speed: where it begins and how hard it accelerates, or why the arm cannot give that speed.

The path leads through `place.launch_m` along the velocity. The gentlest acceleration of `ACCELERATIONS` is taken for which some
begin of the path keeps the whole of it, with the longest wait for the release, within reach, ranges, joint speeds and torques.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.errors import ConfigurationError
from armland.mission.missions.takeoff import CURRENT_GONE_S
from armland.mission.reference.launch import leave, run_up
from armland.mission.reference.septic import PEAK
from armland.mission.table.phases import Phase
from armland.models.arm import ArmModel
from armland.models.nearby import body_of, reached
from armland.models.posture import lead
from armland.rotations import Array
from armland.scenario import Scenario

ACCELERATIONS = (1.5, 2.0, 3.0, 4.0, 6.0)
"""m/s². The magnet and the hinge bear far more; the UAV on its hinge shall not be thrown off its attitude."""

SHARES = (0.5, 0.6, 0.4, 0.7, 0.3, 0.8, 0.2, 0.9, 0.1, 1.0, 0.0)
"""Share of the path that lies before `place.launch_m`."""

WAIT_S, LEAVE_S = 0.2, 0.35
"""Longest wait for the release at speed; for going down by `place.withdraw_m`."""

SHORTEST_S = 0.2
"""Least duration of the run-up."""

SPEED_SHARE, TORQUE_SHARE, SIGMA_SHARE = 0.85, 0.9, 1.2
"""Of the joints' limits, and over the envelope's smallest singular value: what a plan may use."""

MARGIN_RAD = 0.15
"""Distance to the joints' ends that a plan leaves: the arm's null space need not be where the plan has it."""

BELOW_M = 0.15
"""How far all joints but the last stay below the end effector: the arm under the UAV."""

STEPS = 30
"""Newton steps to a point of the path, at most."""

POINTS, APPROACH = 41, 12
"""Of the path that is checked, and on the line from `launch_m` to its begin."""


class Launch(NamedTuple):
    """A run-up that the arm can do."""

    velocity: Array  # (3,) m/s
    start: Array  # (3,) m, where it begins
    run_up_s: float
    leave_s: float
    acceleration: float  # m/s², largest

    @property
    def leaving_s(self) -> float:
        """Duration of the phase in which the arm leaves and comes to rest."""
        return max(0.5 * self.leave_s + self.run_up_s, self.leave_s)


class _Refusal(NamedTuple):
    measure: float  # over its bound: above 1
    text: str


class Carrying(NamedTuple):
    """An arm at work: its model, its rated speeds (n,), rad/s, what it carries, kg, and the believed scenario."""

    arm: ArmModel
    speeds: Array
    mass: float
    scenario: Scenario

    @property
    def through(self) -> Array:
        """Where the run-up leads through (3,), m."""
        return np.array(self.scenario.place.launch_m)


def plan_launch(carrying: Carrying, q: Array) -> Launch:
    """The run-up of the scenario's `place.takeoff_velocity_mps`, `q` (n,), rad, being a pose that is near.

    Raises:
        ConfigurationError: the arm cannot give that velocity; says which limit stops it and what speed it can give.
    """
    velocity = np.array(carrying.scenario.place.takeoff_velocity_mps)
    q = lead(carrying.arm, q, carrying.through)
    found = _search(carrying, q, velocity)
    if isinstance(found, Launch):
        return found
    speed = float(np.linalg.norm(velocity))
    low = largest_speed(carrying, q, velocity / speed, speed)
    raise ConfigurationError(
        f"place.takeoff_velocity_mps = {_text(velocity)}: the arm cannot give {speed:.2f} m/s through place.launch_m = "
        f"{_text(carrying.through)}: {found.text}; in that direction it can give about {low:.2f} m/s"
    )


def largest_speed(carrying: Carrying, q: Array, direction: Array, below: float = 1.5) -> float:
    """Largest speed, m/s, below `below` that the arm can give along the unit vector `direction` (3,); `q` as above."""
    q = lead(carrying.arm, q, carrying.through)
    low, high = 0.0, below
    for _ in range(7):
        middle = 0.5 * (low + high)
        possible = isinstance(_search(carrying, q, middle * direction), Launch)
        low, high = (middle, high) if possible else (low, middle)
    return low


def _search(carrying: Carrying, q: Array, velocity: Array) -> Launch | _Refusal:
    speed, best = float(np.linalg.norm(velocity)), _Refusal(np.inf, "no path was tried")
    for acceleration in ACCELERATIONS:
        for share in SHARES if speed > 0.0 else SHARES[:1]:
            found = _try(carrying, q, velocity, acceleration, share)
            if isinstance(found, Launch):
                return found
            best = min(best, found, key=lambda refusal: refusal.measure)
    return best


def _try(carrying: Carrying, q: Array, velocity: Array, acceleration: float, share: float) -> Launch | _Refusal:
    arm, scenario = carrying.arm, carrying.scenario
    run_up_s = max(PEAK * float(np.linalg.norm(velocity)) / acceleration, SHORTEST_S)
    times = np.linspace(0.0, run_up_s + WAIT_S + CURRENT_GONE_S + max(0.5 * LEAVE_S + run_up_s, LEAVE_S), POINTS)
    along, down = displacement(times, run_up_s, scenario.place.withdraw_m)
    start = carrying.through - share * along[-1] * velocity
    points = start + along[:, None] * velocity - down[:, None] * np.array([0.0, 0.0, 1.0])
    qs = _follow(arm, q, points, scenario.limits.sigma_min)
    if isinstance(qs, _Refusal):
        return qs
    rate = np.gradient(qs, times, axis=0)
    speeds = np.abs(rate).max(axis=0)
    refusal = _beyond(arm, speeds, SPEED_SHARE * carrying.speeds, "turn at", "rad/s")
    held = times < run_up_s + WAIT_S + CURRENT_GONE_S
    gravity = np.array(scenario.environment.gravity_mps2)
    torques = _torques(arm, qs, times, points, carrying.mass * held, gravity)
    refusal = refusal or _beyond(arm, torques, TORQUE_SHARE * arm.tau_max, "need", "N·m")
    return refusal or Launch(velocity, start, run_up_s, LEAVE_S, acceleration)


def _beyond(arm: ArmModel, found: Array, bound: Array, verb: str, unit: str) -> _Refusal | None:
    j = int((found / bound).argmax())
    if found[j] <= bound[j]:
        return None
    text = f"joint {arm.joint_names[j]} would {verb} {found[j]:.2f} {unit}, where {bound[j]:.2f} {unit} may be planned with"
    return _Refusal(float(found[j] / bound[j]), text)


def displacement(times: Array, run_up_s: float, depth: float) -> tuple[Array, Array]:
    """Distance over the speed, s, and downwards, m, (k,) each, of the whole run-up with the longest wait.

    Args:
        times: at which, (k,), s.
        run_up_s: duration, s.
        depth: that the arm goes down, m.
    """
    along, down = np.empty(len(times)), np.zeros(len(times))
    leaves = run_up_s + WAIT_S + CURRENT_GONE_S
    for i, t in enumerate(times):
        along[i] = run_up(min(t, leaves), run_up_s)[0]
        if t > leaves:
            along[i] += leave(t - leaves, run_up_s, LEAVE_S)[0]
            # Downwards by the septic, which is the run-up's speed over V.
            down[i] = depth * run_up(t - leaves, LEAVE_S)[1]
    return along, down


def _follow(arm: ArmModel, q: Array, points: Array, sigma_min: float) -> NDArray | _Refusal:
    # From the pose at `launch_m` back to the begin, then along the path; on the branch of the kinematics that is known.
    still, q, body = np.zeros(arm.joints), q.copy(), body_of(arm)
    arm.update(q, still)
    length = float(np.linalg.norm(points[-1] - points[0]))
    for point in np.linspace(arm.position.copy(), points[0], APPROACH):
        if not reached(body, q, point, STEPS, 0.0):
            arm.update(q, still)
            return _short(arm, point, length, sigma_min)
    out = []
    for point in points:
        there = reached(body, q, point, STEPS, 0.0)
        arm.update(q, still)
        sigma = _smallest(arm)
        if there and arm.anchor[:-1, 2].max() > point[2] - BELOW_M:
            return _Refusal(5.0, f"at {_text(point)} m the arm would not stay {BELOW_M:g} m below the UAV")
        if not there or sigma < SIGMA_SHARE * sigma_min:
            return _short(arm, point, length, sigma_min)
        margin = np.minimum(q - arm.q_min, arm.q_max - q)
        if margin.min() < MARGIN_RAD:
            name = arm.joint_names[int(margin.argmin())]
            text = f"at {_text(point)} m joint {name} is {margin.min():.2f} rad from its end, bound {MARGIN_RAD:g}"
            return _Refusal(4.0, text)
        out.append(q.copy())
    return np.array(out)


def _short(arm: ArmModel, point: Array, length: float, sigma_min: float) -> _Refusal:
    # Further than any speed: how far, so that the nearest refusal is told.
    return _Refusal(
        10.0 + length,
        f"its path is {length:.2f} m long, and at {_text(point)} m the arm is {1e3 * _apart(arm, point):.0f} mm short or near a "
        f"singularity (smallest singular value {_smallest(arm):.3f}, bound {SIGMA_SHARE * sigma_min:.3f})",
    )


def _apart(arm: ArmModel, point: Array) -> float:
    return float(np.linalg.norm(arm.position - point))


def _smallest(arm: ArmModel) -> float:
    return float(np.linalg.svd(arm.jacobian, compute_uv=False)[-1])


def _torques(arm: ArmModel, qs: Array, times: Array, points: Array, masses: NDArray, gravity: Array) -> Array:
    # Largest of each joint, (n,), by the arm's model and the mass that it carries at each time.
    rate = np.gradient(qs, times, axis=0)
    second = np.gradient(rate, times, axis=0)
    push = np.gradient(np.gradient(points, times, axis=0), times, axis=0) - gravity
    largest = np.zeros(arm.joints)
    for q, qd, qdd, a, m in zip(qs, rate, second, push, masses, strict=True):
        arm.update(q, qd)
        tau = arm.mass_matrix @ qdd + arm.bias + arm.jacobian[:3].T @ (m * a)
        largest = np.maximum(largest, np.abs(tau))
    return largest


def timed(phases: tuple[Phase, ...], launch: Launch) -> tuple[Phase, ...]:
    """The phases with the plan's durations."""
    known: dict[str, dict[str, Any]] = {
        "launch": {"duration_s": launch.run_up_s, "timeout_s": launch.run_up_s + WAIT_S},
        "leave": {"duration_s": launch.leaving_s, "timeout_s": launch.leaving_s + 1.0},
    }
    return tuple(p._replace(**known.get(p.name, {})) for p in phases)


def _text(v: Array) -> str:
    return "(" + ", ".join(f"{x:.2f}" for x in v) + ")"
