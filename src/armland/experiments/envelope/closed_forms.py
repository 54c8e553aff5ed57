"""Closed forms of the capture's bounds beside the captures: `models.capture` with the mission's own numbers."""

from typing import NamedTuple

import numpy as np

from armland.models import capture
from armland.models.capture import GATE_M, Grip


class ClosedForms(NamedTuple):
    """What the closed forms need to know; masses in kg."""

    grip: Grip
    mass: float  # Of all that flies
    body: float  # Without the plate
    arm: float  # Effective mass of the arm along the approach
    force: float  # Largest hinge force, N
    righting: float  # Acceleration of the pivot per rad of tilt with which a tilted UAV rights itself, m/s²
    lag_s: float  # Of the rotors
    tilt_max: float  # Tilt at which the supervisor gives up, rad
    closing: float  # Closing speed of the flight, m/s

    def bound(
        self, name: str, offset: float = 0.0, speed: float = 0.0, tilt: float = 0.0, closing: float | None = None
    ) -> float:
        """Bound of the quantity `name` of `bounds.QUANTITIES` with the others as given; in the unit of `bench.Start`."""
        closing = self.closing if closing is None else closing
        fastest = capture.closing_speed_bound(self.grip, self.mass, self.body, self.arm, self.force, GATE_M)
        clearance = capture.covered_offset(self.grip) - offset
        if name == "fastest":
            return fastest
        if closing > fastest:
            return 0.0
        time = capture.closing_time(self.grip, self.mass, closing, GATE_M)
        if name == "offset":
            return max(clearance - self._drift(speed, tilt, time), 0.0)
        if name == "speed":
            taken = offset + self._drift(0.0, tilt, time)
            return capture.lateral_speed_bound(self.grip, self.mass, closing, GATE_M, taken)
        if name == "plate":
            return capture.covered_tilt(self.grip, offset)
        if name == "tilt":
            grid = np.linspace(0.0, self.tilt_max, 200)
            return float(max((t for t in grid if self._drift(speed, t, time) <= clearance), default=0.0))
        return self._slowest(fastest, speed, tilt, clearance)

    def _slowest(self, fastest: float, speed: float, tilt: float, clearance: float) -> float:
        # The slower the approach, the longer the plate drifts before it is gripped.
        for v in np.linspace(0.0, fastest, 100):
            if self._drift(speed, tilt, capture.closing_time(self.grip, self.mass, v, GATE_M)) <= clearance:
                return float(v)
        return fastest

    def _drift(self, speed: float, tilt: float, time: float) -> float:
        """Displacement in m of the pivot aside during `time` s until contact, and of the sliding after it.

        A tilted UAV rights itself about its centre of mass and throws its pivot aside. That its thrust's slope accelerates it the
        arm knows from the attitude, and follows.
        """
        moved, v = capture.righting(self.righting * tilt, self.lag_s, time)
        return speed * time + moved + capture.slide(self.grip, self.mass, speed + v)
