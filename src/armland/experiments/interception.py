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

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from armland.errors import PlantError
from armland.experiments.snapshot import Flight, quiet
from armland.mission.landing_scenario import LandingScenario
from armland.mission.landing_setup import Setup
from armland.rotations import Array

FREQUENCIES_HZ = (0.3, 0.5, 0.7, 1.0, 1.4, 2.0)

SWING_M = 0.006
"""Amplitude of a free mass under the gusts: large against the camera's noise, small against what it sees."""

SETTLE_S, PERIODS = 2.5, 3
"""What is waited for before, and how many periods are fitted."""


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
    scenario: LandingScenario,
    frequencies: tuple[float, ...] = FREQUENCIES_HZ,
    progress: Callable[[str, int, int], None] | None = None,
) -> tuple[Tracked, ...]:
    """Follow a swinging plate at each frequency, with the camera as it is and everything else without imperfections."""
    still = quiet(scenario, camera=scenario.landing.imperfections.camera)
    # A tilt that is never small enough keeps the mission in its phase of tracking.
    bounds = still.landing.bounds.model_copy(update={"align_tilt_deg": 1e-9})
    flight = Flight(still._replace(landing=still.landing.model_copy(update={"bounds": bounds})))
    table, found = flight.setup.table, []
    table.phases["timeout"][table.names.index("align")] = np.inf
    flight.fly_until(lambda: flight.controller.phase == "align", "tracking")
    for k, frequency in enumerate(frequencies):
        found.append(_follow(flight, frequency))
        if progress is not None:
            progress("interception", k + 1, len(frequencies))
    return tuple(found)


def _follow(flight: Flight, frequency: float) -> Tracked:
    flight.restore()
    rate, omega, p = flight.rate, 2.0 * np.pi * frequency, flight.setup.parameters[0]
    force, span = float(p["mass"]) * SWING_M * omega**2, round(PERIODS / frequency * rate)
    plate, arm = [], []
    for k in range(round(SETTLE_S * rate) + span):
        flight.devices["force"][0, 0] = force * np.sin(omega * k / rate) * min(k / rate / SETTLE_S, 1.0)
        flight.step()
        plate.append(flight.tick.truth["r"][0, 0])
        arm.append(flight.tick.truth["ee"][0, 0])
    if flight.controller.phase != "align":
        raise PlantError(f"a gust of {frequency:g} Hz brought the mission from tracking to {flight.controller.phase!r}")
    seen, apart = np.array(plate[-span:]), np.array(plate[-span:]) - np.array(arm[-span:])
    swing = _amplitude(seen, omega / rate)
    missed = _amplitude(apart, omega / rate) / swing
    form = omega**2 / (omega**2 + float(p["track"]) ** 2)
    return Tracked(frequency, swing, missed, form, limits(flight.setup, omega, missed))


def _amplitude(y: Array, step: float) -> float:
    """Amplitude of the sinusoid of `step` rad per sample in `y`, beside a mean and a drift."""
    k = np.arange(len(y))
    basis = np.column_stack([np.cos(step * k), np.sin(step * k), np.ones(len(y)), k])
    c = np.linalg.lstsq(basis, y, rcond=None)[0]
    return float(np.hypot(c[0], c[1]))


def limits(setup: Setup, omega: float, missed: float) -> dict[str, float]:
    """Largest amplitude in m at `omega` rad/s by each limit, of a plate of whose motion the arm misses the share `missed`."""
    b, p, arm = setup.scenario.landing.bounds, setup.parameters[0], setup.arm
    arm.update(setup.home, np.zeros(arm.joints))
    # Joint speeds for 1 m/s along x at rest of the rest, torques for 1 m/s².
    M, J = arm.mass_matrix, arm.jacobian
    per_speed = np.linalg.solve(M, J.T @ arm.lambda_ee)[:, 0]
    per_acceleration = J.T @ arm.lambda_ee[:, 0]
    with np.errstate(divide="ignore"):
        speed = np.min(p["speed_share"] * p["qd_max"] / np.abs(per_speed))
        acceleration = np.min((arm.tau_max - np.abs(arm.gravity)) / np.abs(per_acceleration))
        jerk = np.min(p["torque_rate"] / np.abs(per_acceleration))
    return {
        "offset": b.align_offset_m / missed,
        "relative speed": b.align_speed_mps / (omega * missed),
        "joint speed": float(speed / omega),
        "joint torque": float(acceleration / omega**2),
        "torque rate": float(jerk / omega**3),
        "track filter": float(p["track_a"] / omega**2),
    }
