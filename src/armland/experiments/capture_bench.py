"""Short captures in the landing's own scene, under the landing's own controller, from chosen states just before contact.

A landing without imperfections is flown until the plate is `GATE_M` above the face: from there the magnet closes the gap faster
than a camera sample travels, so what offset and speed there are at the gate the arm has to take. That state is kept. For each
capture it is put back and the UAV is set beside, moving or askew as asked for. The pose filter learns height, closing speed and
attitude, but believes the plate above the face and at rest beside it: the camera is dark until contact. Then mission, laws, UAV
and magnet run on as in flight until the mission's pull test has passed or failed.
"""

from typing import NamedTuple

import mujoco
import numpy as np
from numpy.typing import NDArray

from armland.estimation.late_fusion import insert
from armland.estimation.plate import MEMORY as FILTER
from armland.experiments.landing_judge import limits_violated, tilt_deg
from armland.experiments.snapshot import Flight, quiet
from armland.mission.landing_scenario import LandingScenario
from armland.models.capture import GATE_M
from armland.plant.landing_scene import PLATE
from armland.plant.magnet import PADS
from armland.rotations import Array, from_rotation_vector, matrix

STEADY_TICKS = 100
"""Ticks at the end during which all pads must touch."""

SIGMA_M, SIGMA_MPS = 3e-3, 0.08
"""Standard deviations that the pose filter claims at the gate; small enough for a valid estimate."""

NO_CONTACT_TICKS = 300
"""Ticks after which a capture without contact is given up."""


class Start(NamedTuple):
    """State at the gate, of the UAV relative to the end effector; angles in rad, directions about the vertical from x."""

    offset: float = 0.0  # m, of the pivot, horizontal
    offset_to: float = 0.0
    speed: float = 0.0  # m/s, horizontal
    speed_to: float = 0.0
    closing: float | None = None  # m/s, downwards; the flight's own if absent
    tilt: float = 0.0  # of the UAV
    tilt_to: float = 0.0
    plate: float = 0.0  # tilt of the plate
    plate_to: float = 0.0


class Capture(NamedTuple):
    """What came of it."""

    held: bool  # all pads touch through the pull test, no limit violated
    why: str
    touching: int  # pads at the end
    force: float  # N, largest at the hinge
    tilt: float  # deg, largest of the UAV
    slip: float  # m, horizontal, of pivot from end effector at the end
    contact: float  # s, until all pads touched; NaN if they never did


class CaptureBench:
    """Flies to the gate once, then captures as often as asked.

    Args:
        scenario: of `landing_scenario`; its imperfections and faults are left out.

    Raises:
        ConfigurationError: what `set_up` refuses.
        PlantError: the flight without imperfections does not reach the gate.
    """

    def __init__(self, scenario: LandingScenario) -> None:
        self.flight = Flight(quiet(scenario))
        self.scenario, self.setup, self.tick = self.flight.scenario, self.flight.setup, self.flight.tick
        self.plant = self.flight.plant
        self._rows = np.empty(2500, self.tick.buffer.dtype)
        self.flight.fly_until(self._at_the_gate, f"{1e3 * GATE_M:g} mm between magnet and plate")
        truth = self.tick.truth[0]
        self.closing = float(truth["ee_v"][2] - truth["v"][2])

    def _at_the_gate(self) -> bool:
        truth = self.tick.truth[0]
        return self.flight.controller.phase == "close" and bool(truth["r"][2] - truth["ee"][2] < GATE_M)

    @property
    def arm_inertia(self) -> Array:
        """The arm's effective mass (3, 3) kg, world, at the gate."""
        self.flight.restore()
        self.setup.arm.update(self.plant.data.qpos[self.plant.scene.joint_qpos], np.zeros(self.setup.arm.joints))
        return np.linalg.inv(np.linalg.inv(self.setup.arm.lambda_ee)[:3, :3])

    def capture(self, start: Start) -> Capture:
        """One capture from `start`; the same start gives the same result."""
        self.flight.restore()
        self._place(start)
        final, k, contact = "close", 0, np.nan
        while k < len(self._rows):
            self.flight.devices["camera_lost"] = final == "close"
            self.flight.step()
            self._rows[k] = self.tick.buffer[0]
            k += 1
            if np.isnan(contact) and k > 2 and self.tick.truth["touching"][0] == 4:
                contact = k / self.flight.rate
            final = self.flight.controller.phase
            if final not in ("close", "capture") or (final == "close" and k > NO_CONTACT_TICKS):
                break
        return self._judged(self._rows[2:k], final, contact)

    def _judged(self, rows: NDArray[np.void], final: str, contact: float) -> Capture:
        truth = rows["truth"]
        apart = truth["r"][-1] - truth["ee"][-1]
        pads = int(truth["touching"][-STEADY_TICKS:].min())
        violated = limits_violated(rows, self.setup)
        why = "held"
        if final != "hand_over":
            why = f"no grip: {final}"
        elif pads < 4:
            why = f"{pads} of 4 pads"
        elif violated:
            why = ", ".join(violated)
        return Capture(
            held=why == "held",
            why=why,
            touching=pads,
            force=float(np.linalg.norm(truth["hinge_force"], axis=1).max()),
            tilt=float(tilt_deg(truth["quat"]).max()),
            slip=float(np.hypot(apart[0], apart[1])),
            contact=contact,
        )

    def _place(self, start: Start) -> None:
        s, d, truth = self.plant.scene, self.plant.data, self.tick.truth[0]
        quat = from_rotation_vector(start.tilt * _about(start.tilt_to))
        R, lever = matrix(quat), np.array(self.scenario.demonstrator.uav.lever_m)
        d.qpos[s.hinge_qpos] = _hinge_angles(R.T @ matrix(from_rotation_vector(start.plate * _about(start.plate_to))))
        closing = self.closing if start.closing is None else start.closing
        pivot = truth["ee"] + start.offset * _towards(start.offset_to) + [0.0, 0.0, 0.05]
        velocity = truth["ee_v"] + start.speed * _towards(start.speed_to) - [0.0, 0.0, closing]
        d.qpos[s.uav_qpos[:3]], d.qpos[s.uav_qpos[3:]] = pivot - R @ lever, quat
        d.qvel[s.uav_dof], d.qvel[s.hinge_dof] = [*velocity, 0.0, 0.0, 0.0], 0.0
        mujoco.mj_kinematics(s.model, d)
        # Gaps are measured along the plate's normal.
        d.qpos[s.uav_qpos[2]] -= (self._smallest_gap() - GATE_M) / np.cos(start.plate)
        mujoco.mj_forward(s.model, d)
        aside = start.offset * _towards(start.offset_to)
        self._tell(d.qpos[s.uav_qpos[:3]] - aside, velocity - start.speed * _towards(start.speed_to), quat)

    def _smallest_gap(self) -> float:
        model, d = self.plant.scene.model, self.plant.data
        plate, pads = model.geom(PLATE), [model.geom(f"pad_{i + 1}") for i in range(PADS)]
        normal = d.geom_xmat[plate.id].reshape(3, 3)[:, 2]
        heights = [normal @ (d.geom_xpos[plate.id] - d.geom_xpos[pad.id]) - pad.size[0] for pad in pads]
        return float(min(heights) - plate.size[1])

    def _tell(self, position: Array, velocity: Array, quat: Array) -> None:
        """Let link and pose filter believe in this position, velocity and attitude of the UAV's centre of mass."""
        devices, memory, tick = self.flight.devices, self.flight.memory(FILTER), int(self.tick.measurement["tick"][0])
        devices["imu"], devices["down"], devices["rate"] = [*quat, 0.0, 0.0, 0.0], [*quat, 0.0, 0.0, 0.0], 0.0
        memory["quat"], memory["rate"], memory["align"]["quat"] = quat, 0.0, [1.0, 0.0, 0.0, 0.0]
        track = memory["track"][0]
        track["marks"] = 0
        x, P = np.array([*position, *velocity, 0.0, 0.0, 0.0]), np.diag(np.repeat([SIGMA_M**2, SIGMA_MPS**2, 1e-4], 3))
        insert(track, 0, tick, x, P, x[:3].copy(), SIGMA_M**2 * np.eye(3), True)
        memory["sample_tick"] = tick


def _towards(angle: float) -> Array:
    return np.array([np.cos(angle), np.sin(angle), 0.0])


def _about(angle: float) -> Array:
    """Axis of a tilt towards `angle`."""
    return np.array([-np.sin(angle), np.cos(angle), 0.0])


def _hinge_angles(R: Array) -> Array:
    """The hinge's angles (3,) rad of the plate's attitude in the body's, R = Ry Rx Rz."""
    return np.array([np.arctan2(R[0, 2], R[2, 2]), -np.arcsin(R[1, 2]), np.arctan2(R[1, 0], R[1, 1])])
