"""Every row of the deviations does something, and where it belongs: in the model, in a device's record, or at the start."""

import mujoco
import numpy as np
import pytest

from armland.plant.scene.uav import PLAY
from armland.plant.simulator import Simulator
from armland.scenario.deviation import rows

HOME = np.deg2rad([-4.72, -109.96, -7.94, -71.39, 11.82, 39.34, -7.2])

MODEL = (
    *("body_mass", "body_inertia", "body_ipos", "body_pos", "body_quat", "dof_damping", "dof_frictionloss"),
    *("dof_armature", "jnt_stiffness", "jnt_range", "qpos_spring", "pair_friction"),
)

MOVES = {
    "uav.mass": {"body_mass", "integral"},
    "uav.cm_m": {"body_ipos", "rotors.mixer", "rotors.place"},
    "uav.inertia": {"body_inertia"},
    "uav.thrust": {"rotors.gain", "integral"},
    "uav.rotor": {"rotors.gain", "integral"},
    "uav.curve": {"rotors.curve"},
    "uav.sag_per_s": {"rotors.sag"},
    "uav.lag": {"rotors.lag"},
    "uav.tilt_deg": {"imu.bias", "integral"},
    "uav.heading_deg": {"imu.bias"},
    "uav.gyro_dps": {"imu.rate_bias"},
    "uav.drift_dps": {"imu.drift"},
    "uav.trim_mps2": {"onboard.trim", "integral"},
    "uav.speed_noise_mps": {"onboard.speed_sigma"},
    "uav.speed_bias_mps": {"onboard.speed_bias"},
    "uav.drag": {"rotors.drag"},
    "link.up_ms": {"link.up"},
    "link.down_ms": {"link.down"},
    "link.jitter_ms": {"link.jitter_down", "link.jitter_up"},
    "link.loss": {"link.loss_down", "link.loss_up"},
    "link.burst": {"link.burst"},
    "link.stamp_ms": {"link.stamp"},
    "camera.noise": {"camera.honesty"},
    "camera.exposure": {"camera.smear_scale"},
    "camera.lose": {"camera.lose"},
    "camera.outlier": {"camera.outlier"},
    "camera.outlier_m": {"camera.outlier_m"},
    "camera.flip": {"camera.flip"},
    "camera.delay_ms": {"camera.delay_max", "camera.delay_min"},
    "camera.stamp_ms": {"camera.stamp"},
    "camera.mount_m": {"camera.shift"},
    "camera.mount_deg": {"camera.askew", "camera.turn"},
    "camera.focal": {"camera.slope"},
    "camera.centre_px": {"camera.slope"},
    "wrench.gain": {"wrench.gain"},
    "wrench.cross": {"wrench.gain"},
    "wrench.drift_nps": {"wrench.drift"},
    "wrench.drift_nmps": {"wrench.drift"},
    "wrench.tool_kg": {"body_mass"},
    "wrench.tool_com_m": {"body_ipos"},
    "arm.encoder_rad": {"encoders.offset"},
    "arm.torque": {"motors.offset"},
    "arm.torque_noise": {"motors.odd", "motors.sigma"},
    "arm.torque_gain": {"motors.gain"},
    "arm.delay_ms": {"motors.delay"},
    "arm.coulomb": {"dof_frictionloss", "brake.free"},
    "arm.viscous_nms": {"dof_damping"},
    "arm.load_friction": {"motors.load", "motors.odd"},
    "arm.compliance": {"encoders.compliance"},
    "arm.inertia": {"body_inertia", "body_mass", "dof_armature"},
    "magnet.force": {"magnet.rated", "magnet.report_gain"},
    "magnet.residual_n": {"magnet.residual"},
    "magnet.gap_m": {"magnet.dirt"},
    "magnet.report": {"magnet.report_gain"},
    "hinge.friction_nm": {"dof_frictionloss"},
    "hinge.damping_nms": {"dof_damping"},
    "hinge.stiffness_nm": {"jnt_stiffness"},
    "hinge.askew_deg": {"qpos_spring"},
    "hinge.play_m": {"play"},
    "cradle.place_m": {"body_pos", "put_down"},
    "cradle.heading_deg": {"body_quat"},
    "cradle.friction": {"pair_friction"},
    "air.wind_mps": {"air.mean", "air.moves", "attitude", "integral"},
    "air.gust_mps": {"air.sigma", "air.moves"},
    "air.ground_effect": {"air.ground", "air.moves"},
    "air.downwash": {"air.wash"},
}
"""What each row changes of the plant, and nothing else."""


def flat(record, before=""):
    """All numbers of a record by dotted name."""
    out = {}
    for name in record.dtype.names:
        value = record[name]
        out |= flat(value, f"{before}{name}.") if value.dtype.names else {f"{before}{name}": value.copy()}
    return out


def apart_from_play(out, model):
    """Take the joint that only a hinge with play has out of the model's numbers, and put its range beside them."""
    joint = mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, PLAY)
    if joint >= 0:
        out["play"] = out["jnt_range"][joint].copy()
        for kind, at in (("jnt", joint), ("dof", model.jnt_dofadr[joint]), ("qpos", model.jnt_qposadr[joint])):
            for name in MODEL:
                if name.startswith(kind):
                    out[name] = np.delete(out[name], at, axis=0)


def made_of(scenario):
    """All numbers that a plant is made of, by name."""
    sim = Simulator(scenario, HOME, "air")
    out = {name: getattr(sim.scene.model, name).copy() for name in MODEL} | flat(sim.world["told"])
    apart_from_play(out, sim.scene.model)
    sim.connect()
    out["put_down"], out["attitude"] = sim.scene.put_down.copy(), sim.data.qpos[sim.scene.uav_qpos[3:]].copy()
    out["integral"] = sim.world["kept"]["onboard"]["integral"].copy()
    if not out["camera.askew"]:
        # What a camera that sits straight is turned by is not read.
        del out["camera.turn"]
    return out


@pytest.fixture(scope="module")
def nominal(landing):
    return made_of(landing())


def differing(a, b):
    return {name for name in a.keys() | b.keys() if not np.array_equal(a.get(name), b.get(name))}


@pytest.mark.parametrize("row", list(rows()), ids=lambda row: row.path)
def test_row_changes_what_it_is_about_and_nothing_else(landing, nominal, row):
    device, entry = row.path.split(".")
    extreme = row.told.high or row.told.low
    after = made_of(landing(deviation={device: {entry: [extreme, extreme]}}))
    assert differing(nominal, after) == MOVES[row.path]


def test_no_row_without_a_change():
    assert set(MOVES) == {row.path for row in rows()}


def test_hinged_uav_has_been_calibrated_there(landing):
    """On the arm's own hinge nothing deviates: the paper's experiments are flown in the world that they were fitted in."""
    sims = [Simulator(landing(deviation={"level": level}), HOME, "hinged") for level in ("nominal", "harsh")]
    assert sims[0].world.tobytes() == sims[1].world.tobytes()
    assert not sims[1].deviations
