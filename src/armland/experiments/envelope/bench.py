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

from armland.experiments.envelope.closed_forms import ClosedForms
from armland.experiments.envelope.sight import hinge_angles
from armland.experiments.episode import prepare, quiet
from armland.experiments.judge.limits import limits_violated
from armland.experiments.judge.whereabouts import tilt_deg
from armland.experiments.snapshot import Run
from armland.mission.belief import flyer
from armland.mission.supervisor.table import FAULTS
from armland.models.capture import GATE_M, Grip
from armland.plant.scene.closing import RATE
from armland.plant.scene.gear import PADS
from armland.plant.scene.uav import PLATE
from armland.rotations import Array, from_rotation_vector, matrix
from armland.scenario import Scenario

STEADY_TICKS = 100  # Ticks at the end during which all pads must touch

SIGMA_M, SIGMA_MPS = 3e-3, 0.08
"""Standard deviations that the pose filter claims at the gate; small enough for a valid estimate."""

NO_CONTACT_TICKS = 300  # Ticks after which a capture without contact is given up


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
        scenario: of a landing; its imperfections and faults are left out.

    Raises:
        ConfigurationError: what planning a landing refuses.
        PlantError: the flight without imperfections does not reach the gate.
    """

    def __init__(self, scenario: Scenario) -> None:
        self.scenario = quiet(scenario)
        flight = prepare(self.scenario, "landing")
        self.run, self.plan = Run(flight), flight.plan
        self.simulator, self.controller, self.tick = self.run.simulator, self.run.controller, self.run.tick
        self.brief = flight.brief
        self._rows = np.empty(2500, self.tick.buffer.dtype)
        self.run.advance_to(self._at_the_gate, f"{1e3 * GATE_M:g} mm between magnet and plate")
        self.gate = self.run.keep()
        truth = self.tick.truth[0]
        self.closing = float(truth["ee_v"][2] - truth["v"][2])

    def _at_the_gate(self) -> bool:
        truth = self.tick.truth[0]
        return self.controller.phase == "close" and bool(truth["r"][2] - truth["ee"][2] < GATE_M)

    def closed_forms(self) -> ClosedForms:
        """The closed forms with the gear, the UAV and the arm of this landing, at the gate."""
        s, arm, known = self.scenario, self.plan.arm, flyer(self.plan.scenario)
        self.run.restore(self.gate)
        arm.update(self.simulator.data.qpos[self.simulator.scene.joint_qpos], np.zeros(arm.joints))
        mobility = np.linalg.inv(arm.lambda_ee)[:3, :3]
        lever, inertia = abs(known.body.lever[2]), known.body.inertia[0, 0]
        return ClosedForms(
            grip=self._grip(),
            mass=known.mass,
            body=known.body.mass,
            arm=float(np.linalg.inv(mobility)[2, 2]),
            force=float(self.brief.limits["hinge_max"]),
            righting=lever * s.onboard.kp_nm[0] / inertia,
            lag_s=s.rotors.time_constant_s,
            tilt_max=float(np.deg2rad(s.limits.tilt_deg)),
            closing=self.closing,
        )

    def _grip(self) -> Grip:
        plate, magnet = self.scenario.plate, self.scenario.magnet
        pull = magnet.rating_n, magnet.gap_scale_m, magnet.shear_share
        return Grip(plate.radius_m, magnet.pad_radius_m, plate.drop_m, *pull, 1.0 / RATE, magnet.reach_m)

    def capture(self, start: Start) -> Capture:
        """One capture from `start`; the same start gives the same result."""
        self.run.restore(self.gate)
        self._place(start)
        final, k, contact = "close", 0, np.nan
        dark = self.simulator.world["kept"]["faults"]["camera"]["lost"]
        while k < len(self._rows):
            dark[0] = final == "close"
            self.run.step()
            self._rows[k] = self.tick.buffer[0]
            k += 1
            if np.isnan(contact) and k > 2 and self.tick.truth["touching"][0] == PADS:
                contact = k / self.run.rate
            final = self.controller.phase
            if final not in ("close", "capture") or (final == "close" and k > NO_CONTACT_TICKS):
                break
        return self._judged(self._rows[2:k], final, contact)

    def _judged(self, rows: NDArray[np.void], final: str, contact: float) -> Capture:
        truth = rows["truth"]
        apart = truth["r"][-1] - truth["ee"][-1]
        pads = int(truth["touching"][-STEADY_TICKS:].min())
        # The magnet's reserve is the flight's to keep; whether it holds is what a capture shows.
        violated = [name for name in limits_violated(rows, self.brief) if not name.startswith("magnet_")]
        why = ", ".join([*_missed(final, pads, FAULTS[int(rows["mission"]["fault"][-1])]), *violated]) or "held"
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
        scene, d, truth = self.simulator.scene, self.simulator.data, self.tick.truth[0]
        quat = from_rotation_vector(start.tilt * _about(start.tilt_to))
        R = matrix(quat)
        d.qpos[scene.hinge_qpos] = hinge_angles(
            R.T @ matrix(from_rotation_vector(start.plate * _about(start.plate_to)))
        )
        closing = self.closing if start.closing is None else start.closing
        aside, drift = start.offset * _towards(start.offset_to), start.speed * _towards(start.speed_to)
        velocity = truth["ee_v"] + drift - [0.0, 0.0, closing]
        d.qpos[scene.uav_qpos[:3]] = truth["ee"] + aside + [0.0, 0.0, 0.05] - R @ scene.lever
        d.qpos[scene.uav_qpos[3:]] = quat
        d.qvel[scene.uav_dof], d.qvel[scene.hinge_dof] = [*velocity, 0.0, 0.0, 0.0], 0.0
        mujoco.mj_kinematics(scene.model, d)
        # Gaps are measured along the plate's normal.
        d.qpos[scene.uav_qpos[2]] -= (self._smallest_gap() - GATE_M) / np.cos(start.plate)
        mujoco.mj_forward(scene.model, d)
        self._tell(d.qpos[scene.uav_qpos[:3]] - aside, velocity - drift, quat)

    def _smallest_gap(self) -> float:
        model, d = self.simulator.scene.model, self.simulator.data
        plate, pads = model.geom(PLATE), [model.geom(f"pad_{i + 1}") for i in range(PADS)]
        normal = d.geom_xmat[plate.id].reshape(3, 3)[:, 2]
        heights = [normal @ (d.geom_xpos[plate.id] - d.geom_xpos[pad.id]) - pad.size[0] for pad in pads]
        return float(min(heights) - plate.size[1])

    def _tell(self, position: Array, velocity: Array, quat: Array) -> None:
        """Let link and pose filter believe in this position, velocity and attitude of the UAV's centre of mass."""
        kept, memory = self.simulator.world["kept"], self.controller.board["kept"]["estimate"]["filter"]
        tick = int(self.tick.measurement["tick"][0])
        for sample in (kept["imu"], kept["link"]["down"]):
            sample["quat"], sample["rate"] = quat, 0.0
        kept["onboard"]["filtered"] = 0.0
        memory["quat"], memory["rate"], memory["align"]["quat"] = quat, 0.0, [1.0, 0.0, 0.0, 0.0]
        x, P = np.array([*position, *velocity, 0.0, 0.0, 0.0]), np.diag(np.repeat([SIGMA_M**2, SIGMA_MPS**2, 1e-4], 3))
        memory["track"]["marks"], mark = 1, memory["track"]["mark"][..., 0]
        mark["tick"], mark["measured"], mark["x"], mark["P"] = tick, 1, x, P
        mark["z"], mark["R"] = x[:3], SIGMA_M**2 * np.eye(3)
        memory["sample_tick"] = tick


def _missed(final: str, pads: int, fault: str) -> list[str]:
    if final != "hand_over":
        return [f"no grip: {final}" + f" ({fault})" * (fault != "none")]
    return [] if pads == PADS else [f"{pads} of {PADS} pads"]


def _towards(angle: float) -> Array:
    return np.array([np.cos(angle), np.sin(angle), 0.0])


def _about(angle: float) -> Array:
    """Axis of a tilt towards `angle`."""
    return np.array([-np.sin(angle), np.cos(angle), 0.0])
