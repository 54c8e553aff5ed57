"""Plans the run-up of a take-off with speed: where it begins and how hard it accelerates, or why the arm cannot give that speed.

The way leads through `place.launch_m` along the velocity. The gentlest acceleration of `ACCELERATIONS` is taken for which some begin
of the way keeps the whole of it, with the longest wait for the release, within reach, ranges, joint speeds and torques.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.errors import ConfigurationError
from armland.mission.landing_scenario import Landing
from armland.mission.launch_procedure import CURRENT_GONE_S
from armland.mission.launch_reference import leave, run_up
from armland.mission.phases import Phase
from armland.models.arm import ArmModel
from armland.models.inflow import Rotors, advance_of, disc_of
from armland.models.uav import GRAVITY
from armland.rotations import Array, rotation_error
from armland.scenario import Scenario

ACCELERATIONS = (1.5, 2.0, 3.0, 4.0, 6.0)
"""m/s². The magnet and the hinge bear far more; the UAV on its hinge shall not be thrown off its attitude."""

SHARES = (0.5, 0.6, 0.4, 0.7, 0.3, 0.8, 0.2, 0.9, 0.1, 1.0, 0.0)
"""Share of the way that lies before `place.launch_m`."""

WAIT_S, LEAVE_S = 0.2, 0.35
"""Longest wait for the release at speed; for going down by `place.withdraw_m`."""

SHORTEST_S = 0.2
"""Least duration of the run-up."""

SPEED_SHARE, TORQUE_SHARE, SIGMA_SHARE = 0.85, 0.9, 1.2
"""Of the joints' limits, and over the envelope's smallest singular value: what a plan may use."""

PEAK = 2.1875
"""Largest rate of the septic from 0 to 1 over its mean."""

MARGIN_RAD = 0.15
"""Distance to the joints' ends that a plan leaves: the arm's null space need not be where the plan has it."""

BELOW_M = 0.15
"""How far all joints but the last stay below the end effector: the arm under the UAV."""

POINTS = 41


class Launch(NamedTuple):
    """A run-up that the arm can do."""

    velocity: Array  # (3,) m/s
    start: Array  # (3,) m, where it begins
    run_up_s: float
    leave_s: float
    acceleration: float  # m/s², largest
    speed_ratio: float  # largest joint speed over its limit
    torque_ratio: float  # largest joint torque over its limit

    @property
    def leaving_s(self) -> float:
        """Duration of the phase in which the arm leaves and comes to rest."""
        return max(0.5 * self.leave_s + self.run_up_s, self.leave_s)


class _Refusal(NamedTuple):
    measure: float  # over its bound: above 1
    text: str


def plan_launch(arm: ArmModel, q: Array, landing: Landing, mass: float) -> Launch:
    """The run-up of the scenario's `place.takeoff_velocity_mps`, `q` (n,) being a pose that is near.

    Raises:
        ConfigurationError: the arm cannot give that velocity; says which limit stops it and what speed it can give.
    """
    velocity = np.array(landing.place.takeoff_velocity_mps)
    q = _led(arm, q, np.array(landing.place.launch_m))
    found = _search(arm, q, landing, mass, velocity)
    if isinstance(found, Launch):
        return found
    speed = float(np.linalg.norm(velocity))
    low = largest_speed(arm, q, landing, mass, velocity / speed, speed)
    raise ConfigurationError(
        f"place.takeoff_velocity_mps = {_text(velocity)}: the arm cannot give {speed:.2f} m/s through place.launch_m = "
        f"{_text(np.array(landing.place.launch_m))}: {found.text}; in that direction it can give about {low:.2f} m/s"
    )


def largest_speed(
    arm: ArmModel, q: Array, landing: Landing, mass: float, direction: Array, below: float = 1.5
) -> float:
    """Largest speed, m/s, below `below` that the arm can give along the unit vector `direction` (3,); other arguments as above."""
    q = _led(arm, q, np.array(landing.place.launch_m))
    low, high = 0.0, below
    for _ in range(7):
        middle = 0.5 * (low + high)
        possible = isinstance(_search(arm, q, landing, mass, middle * direction), Launch)
        low, high = (middle, high) if possible else (low, middle)
    return low


def _search(arm: ArmModel, q: Array, landing: Landing, mass: float, velocity: Array) -> Launch | _Refusal:
    speed, best = float(np.linalg.norm(velocity)), _Refusal(np.inf, "no way was tried")
    for acceleration in ACCELERATIONS:
        run_up_s = max(PEAK * speed / acceleration, SHORTEST_S)
        for share in SHARES if speed > 0.0 else SHARES[:1]:
            found = _try(arm, q, landing, mass, velocity, run_up_s, share)
            if isinstance(found, Launch):
                return found._replace(acceleration=acceleration)
            best = min(best, found, key=lambda refusal: refusal.measure)
    return best


def _try(
    arm: ArmModel, q: Array, landing: Landing, mass: float, velocity: Array, run_up_s: float, share: float
) -> Launch | _Refusal:
    times = np.linspace(0.0, run_up_s + WAIT_S + CURRENT_GONE_S + max(0.5 * LEAVE_S + run_up_s, LEAVE_S), POINTS)
    along, down = way(times, run_up_s, landing.place.withdraw_m)
    start = np.array(landing.place.launch_m) - share * along[-1] * velocity
    points = start + along[:, None] * velocity - down[:, None] * np.array([0.0, 0.0, 1.0])
    qs = _follow(arm, q, points, landing.envelope.sigma_min)
    if isinstance(qs, _Refusal):
        return qs
    rate = np.gradient(qs, times, axis=0)
    limit = np.resize(landing.envelope.joint_speed_rad_s, arm.joints)
    speeds = np.abs(rate).max(axis=0)
    refusal = _beyond(arm, speeds, SPEED_SHARE * limit, "turn at", "rad/s")
    held = times < run_up_s + WAIT_S + CURRENT_GONE_S
    torques = _torques(arm, qs, rate, times, points, mass * held)
    refusal = refusal or _beyond(arm, torques, TORQUE_SHARE * arm.tau_max, "need", "N·m")
    if refusal is not None:
        return refusal
    ratio = float((torques / arm.tau_max).max())
    return Launch(velocity, start, run_up_s, LEAVE_S, 0.0, float((speeds / limit).max()), ratio)


def _beyond(arm: ArmModel, found: Array, bound: Array, verb: str, unit: str) -> _Refusal | None:
    j = int((found / bound).argmax())
    if found[j] <= bound[j]:
        return None
    text = f"joint {arm.joint_names[j]} would {verb} {found[j]:.2f} {unit}, where {bound[j]:.2f} {unit} may be planned with"
    return _Refusal(float(found[j] / bound[j]), text)


def way(times: Array, run_up_s: float, depth: float) -> tuple[Array, Array]:
    """Distance over the speed, s, and way down, m, (k,) each, of the whole run-up with the longest wait."""
    along, down = np.empty(len(times)), np.zeros(len(times))
    leaves = run_up_s + WAIT_S + CURRENT_GONE_S
    for i, t in enumerate(times):
        along[i] = run_up(min(t, leaves), run_up_s)[0]
        if t > leaves:
            along[i] += leave(t - leaves, run_up_s, LEAVE_S)[0]
            # The septic's way down, by the run-up's speed over V: the same polynomial.
            down[i] = depth * run_up(t - leaves, LEAVE_S)[1]
    return along, down


def _follow(arm: ArmModel, q: Array, points: Array, sigma_min: float) -> NDArray | _Refusal:
    # From the pose at `launch_m` back to the begin, then along the way; on the branch of the kinematics that is known.
    q = _led(arm, q, points[0])
    out = []
    for point in points:
        q = pose(arm, q, point)
        arm.update(q, np.zeros(arm.joints))
        apart = float(np.linalg.norm(arm.position - point))
        sigma = float(np.linalg.svd(arm.jacobian, compute_uv=False)[-1])
        if apart <= 1e-4 and arm.anchor[:-1, 2].max() > point[2] - BELOW_M:
            return _Refusal(5.0, f"at {_text(point)} m the arm would not stay {BELOW_M:g} m below the UAV")
        if apart > 1e-4 or sigma < SIGMA_SHARE * sigma_min:
            # Further than any speed: how far, so that the nearest refusal is told.
            length = np.linalg.norm(points[-1] - points[0])
            return _Refusal(
                10.0 + float(length),
                f"its way is {length:.2f} m long, and at {_text(point)} m the arm is {1e3 * apart:.0f} mm short or near a "
                f"singularity (smallest singular value {sigma:.3f}, bound {SIGMA_SHARE * sigma_min:.3f})",
            )
        margin = np.minimum(q - arm.q_min, arm.q_max - q)
        if margin.min() < MARGIN_RAD:
            name = arm.joint_names[int(margin.argmin())]
            return _Refusal(
                4.0, f"at {_text(point)} m joint {name} is {margin.min():.2f} rad from its end, bound {MARGIN_RAD:g}"
            )
        out.append(q)
    return np.array(out)


def _led(arm: ArmModel, q: Array, point: Array) -> Array:
    arm.update(q, np.zeros(arm.joints))
    for between in np.linspace(arm.position.copy(), point, 12):
        q = pose(arm, q, between)
    return q


def pose(arm: ArmModel, q: Array, point: Array) -> Array:
    """Joint positions (n,) near `q` with the end effector upright at `point` (3,) m, as far as the ranges allow."""
    for _ in range(30):
        arm.update(q, np.zeros(arm.joints))
        e = np.concatenate([point - arm.position, rotation_error(arm.rotation.copy(), np.eye(3))])
        if np.abs(e).max() < 1e-8:
            break
        J = arm.jacobian
        q = np.clip(q + J.T @ np.linalg.solve(J @ J.T + 1e-8 * np.eye(6), e), arm.q_min, arm.q_max)
    return q


def _torques(arm: ArmModel, qs: Array, rate: Array, times: Array, points: Array, masses: NDArray) -> Array:
    # Largest of each joint, (n,), by the arm's model and the mass that it carries at each time.
    second = np.gradient(rate, times, axis=0)
    push = np.gradient(np.gradient(points, times, axis=0), times, axis=0) + np.array([0.0, 0.0, GRAVITY])
    largest = np.zeros(arm.joints)
    for q, qd, qdd, a, m in zip(qs, rate, second, push, masses, strict=True):
        arm.update(q, qd)
        tau = arm.mass_matrix @ qdd + arm.bias + arm.jacobian[:3].T @ (m * a)
        largest = np.maximum(largest, np.abs(tau))
    return largest


def timed(phases: tuple[Phase, ...], launch: Launch) -> tuple[Phase, ...]:
    """The phases with the plan's durations."""
    out = []
    for p in phases:
        if p.name == "launch":
            p = p._replace(duration_s=launch.run_up_s, timeout_s=launch.run_up_s + WAIT_S)
        elif p.name == "leave":
            p = p._replace(duration_s=launch.leaving_s, timeout_s=launch.leaving_s + 1.0)
        out.append(p)
    return tuple(out)


def set_launch(p: NDArray[np.void], launch: Launch, landing: Landing, demonstrator: Scenario, names: list[str]) -> None:
    """Write the plan into the controller's parameters `p` (1,) of a mission with the phases `names`."""
    p["launch"], p["launch_s"], p["leave_s"] = launch.velocity, launch.run_up_s, launch.leave_s
    p["targets"][0, names.index("carry_up")] = landing.place.launch_m
    p["targets"][0, names.index("bring")] = p["targets"][0, names.index("hand_back")] = launch.start
    # A speed that has to be given up runs out no faster than it was gained.
    p["coast"] = max(p["coast"][0], float(np.linalg.norm(launch.velocity)) / launch.acceleration)
    if landing.place.fly_on:
        p["fly_on"], p["thrust_max"] = 1, rotors_of(landing, demonstrator).static


def rotors_of(landing: Landing, demonstrator: Scenario) -> Rotors:
    """The scenario's rotors as momentum theory sees them."""
    r = landing.rotors
    static = 4.0 * demonstrator.rotors.max_thrust_n
    return Rotors(4, static, disc_of(r.radius_m, r.density_kgm3), r.slope, advance_of(r.slope, r.inflow_ratio))


def _text(v: Array) -> str:
    return "(" + ", ".join(f"{x:.2f}" for x in v) + ")"
