"""How fast a plate may move for the arm to follow it closely enough to close: amplitude against frequency.

While the arm tracks, gusts push the UAV to and fro. From the plate's motion and the arm's, both fitted with a sinusoid of the
gust's frequency, follows the share ε of the motion that the arm misses; offset εA and speed εωA must stay within the mission's
thresholds. What the arm itself can do at most follows from its model: joint speed, torque and torque rate are linear in A.

| symbol | name | unit |
|---|---|---|
| A, ω | amplitude and frequency of the plate, horizontal | m, rad/s |
| ε | `missed`: amplitude of plate minus end effector, over A | 1 |
| w | bandwidth of the filter on the plate's motion, `track` | rad/s |
"""

from typing import NamedTuple

import numpy as np

from armland.errors import PlantError
from armland.experiments.episode import prepare, quiet
from armland.experiments.paper import Progress, silent
from armland.experiments.snapshot import Run, Snapshot
from armland.mission.belief import flyer
from armland.models.arm import ArmModel
from armland.rotations import Array
from armland.scenario import Scenario

FREQUENCIES_HZ = (0.3, 0.5, 0.7, 1.0, 1.4, 2.0)

SWING_M = 0.006
"""Amplitude of a free mass under the gusts: large against the camera's noise, small against what it sees."""

SWINGS = (1.0, 0.5, 0.25)
"""Shares of it: the first at which the mission goes on tracking. What is missed does not depend on the width."""

SETTLE_S, PERIODS = 2.5, 3  # What is waited for before, and how many periods are fitted


class Tracked(NamedTuple):
    """The arm behind a plate that swings along x."""

    frequency: float  # Hz
    swing: float  # m, amplitude that the plate had
    missed: float  # ε
    filter_form: float  # ε of the filter alone without acceleration, ω²/(ω² + w²)
    limits: dict[str, float]  # m, largest amplitude by what limits it

    @property
    def amplitude(self) -> float:
        """Largest amplitude, m."""
        return min(self.limits.values())

    @property
    def limit(self) -> str:
        """What cuts it."""
        return min(self.limits, key=lambda name: self.limits[name])


def intercept(
    scenario: Scenario, frequencies: tuple[float, ...] = FREQUENCIES_HZ, progress: Progress = silent
) -> tuple[Tracked, ...]:
    """Follow a swinging plate at each frequency, with the camera as it is and everything else without imperfections."""
    # A tilt that is never small enough keeps the mission in its phase of tracking.
    still = quiet(scenario, scenario.imperfections.camera).replaced({"bounds": {"align_tilt_deg": 1e-3}})
    run, found = Run(prepare(still, "landing")), []
    run.controller.board["table"]["phases"]["timeout"][0, run.plan.names.index("align")] = np.inf
    run.advance_to(lambda: run.controller.phase == "align", "tracking")
    start = run.keep()
    for k, frequency in enumerate(frequencies):
        found.append(_follow(run, start, frequency))
        progress("interception", k + 1, len(frequencies))
    return tuple(found)


def _follow(run: Run, start: Snapshot, frequency: float) -> Tracked:
    rate, omega, track = run.rate, 2.0 * np.pi * frequency, run.plan.scenario.control.approach.track_rad_s
    for share in SWINGS:
        plate, arm = _swung(run, start, frequency, share * SWING_M)
        if run.controller.phase == "align":
            break
    else:
        raise PlantError(f"a gust of {frequency:g} Hz brought the mission from tracking to {run.controller.phase!r}")
    apart, amplitude = plate - arm, _amplitude(plate, omega / rate)
    missed = _amplitude(apart, omega / rate) / amplitude
    bounds = limits(run.plan.arm, run.plan.home, run.plan.scenario, omega, missed)
    return Tracked(frequency, amplitude, missed, omega**2 / (omega**2 + track**2), bounds)


def _swung(run: Run, start: Snapshot, frequency: float, swing: float) -> tuple[Array, Array]:
    # Plate and end effector along x, m, over the last periods of a swing about as wide as `swing`, m.
    run.restore(start)
    rate, omega = run.rate, 2.0 * np.pi * frequency
    force, span = flyer(run.plan.scenario).mass * swing * omega**2, round(PERIODS / frequency * rate)
    plate, arm, gust = [], [], run.simulator.world["told"]["rotors"]["force"]
    for k in range(round(SETTLE_S * rate) + span):
        gust[0, 0] = force * np.sin(omega * k / rate) * min(k / rate / SETTLE_S, 1.0)
        run.step()
        plate.append(run.tick.truth["r"][0, 0])
        arm.append(run.tick.truth["ee"][0, 0])
    return np.array(plate[-span:]), np.array(arm[-span:])


def _amplitude(y: Array, step: float) -> float:
    """Amplitude of the sinusoid of `step` rad per sample in `y`, beside a mean and a drift."""
    k = np.arange(len(y))
    basis = np.column_stack([np.cos(step * k), np.sin(step * k), np.ones(len(y)), k])
    c = np.linalg.lstsq(basis, y, rcond=None)[0]
    return float(np.hypot(c[0], c[1]))


def limits(arm: ArmModel, home: Array, scenario: Scenario, omega: float, missed: float) -> dict[str, float]:
    """Largest amplitude in m by each limit, of a plate that swings at `omega` and of whose motion the arm misses the share `missed`.

    Args:
        arm: its model.
        home: joint positions (n,), rad.
        scenario: believed.
        omega: rad/s.
        missed: ε.
    """
    b, v = scenario.bounds, scenario.limits
    arm.update(home, np.zeros(arm.joints))
    # Joint speeds for 1 m/s along x at rest of the rest, torques for 1 m/s².
    M, J = arm.mass_matrix, arm.jacobian
    per_speed = np.linalg.solve(M, J.T @ arm.lambda_ee)[:, 0]
    per_acceleration = J.T @ arm.lambda_ee[:, 0]
    rate = arm.torque_rate if v.torque_rate_nm_s is None else np.full(arm.joints, v.torque_rate_nm_s)
    with np.errstate(divide="ignore"):
        speed = np.min(v.joint_speed_share * arm.qd_max / np.abs(per_speed))
        acceleration = np.min((arm.tau_max - np.abs(arm.gravity)) / np.abs(per_acceleration))
        jerk = np.min(rate / np.abs(per_acceleration))
    return {
        "offset": b.align_offset_m / missed,
        "relative speed": b.align_speed_mps / (omega * missed),
        "joint speed": float(speed / omega),
        "joint torque": float(acceleration / omega**2),
        "torque rate": float(jerk / omega**3),
        "track filter": float(scenario.control.approach.track_max_mps2 / omega**2),
    }
