"""MuJoCo's sensors in the scene, and where each one's first number is in `sensordata`.

| sensor | what, frame |
|---|---|
| `q_*`, `qd_*`, `tau_*` | position, velocity and torque of each of the arm's joints |
| `force`, `torque` | flange on tool at the force-torque sensor's origin, sensor axes |
| `r` `v`, `r_cm` `v_cm`, `ee_pos` `ee_vel` | position, velocity of the pivot on the UAV, of its CM, of the end effector [W] |
| `quat`, `plate_quat`, `ee_quat` | attitudes of UAV, hinge plate, end effector, W<-body |
| `gyro` | angular velocity of the UAV [B] |
| `hinge_force` | hinged: force of the arm on the UAV [B]; free: force of the UAV on the plate [plate axes] |
| `plate_pos`, `plate_vel`, `plate_rate` | position, velocity of the middle of the plate's lower face, plate's angular velocity [W] |
| `magnet_force` | contact force of the face on the plate [W], without the magnet's pull: `xfrc_applied[plate_body]` holds that |
| `cradle_force`, `ground_force` | contact force of the rails, of the floor on UAV and plate [W] |
| `plate_cradle_force` | the share of `cradle_force` that bears on the plate [W] |
| `deck_pos` `deck_quat`, `deck_vel` `deck_rate`, `deck_acc` `deck_alpha` | of the deck, if any [W]; `deck_acc` less gravity |
| `arm_cradle_force`, `arm_floor_force`, `arm_uav_force` | contact forces of the arm on what it should not touch [W] |
"""

import mujoco

from armland.models.description import EE_SITE
from armland.plant.scene.deck import DECK, ground
from armland.plant.scene.uav import PLATE, UAV

NET_FORCE = 3
"""MuJoCo's code for a contact sensor that sums up the forces of all its contacts, in world axes."""

S, O = mujoco.mjtSensor, mujoco.mjtObj

DECK_SENSORS = {
    "deck_pos": S.mjSENS_FRAMEPOS,
    "deck_quat": S.mjSENS_FRAMEQUAT,
    "deck_vel": S.mjSENS_FRAMELINVEL,
    "deck_rate": S.mjSENS_FRAMEANGVEL,
    "deck_acc": S.mjSENS_FRAMELINACC,
    "deck_alpha": S.mjSENS_FRAMEANGACC,
}


def add_sensors(spec: mujoco.MjSpec, joints: list[str], free: bool, cradle: bool, magnet: bool) -> None:
    """Add the sensors of an arm with `joints` and of a UAV that is `free` or hinged, with or without cradle and magnet."""
    for prefix, kind in (("q", S.mjSENS_JOINTPOS), ("qd", S.mjSENS_JOINTVEL), ("tau", S.mjSENS_JOINTACTFRC)):
        for name in joints:
            spec.add_sensor(name=f"{prefix}_{name}", type=kind, objtype=O.mjOBJ_JOINT, objname=name)
    add_frames(spec, free)
    if free:
        _add_contact_sensors(spec, spec.joint(joints[0]).parent, cradle, magnet)


def add_frames(spec: mujoco.MjSpec, free: bool) -> None:
    """Add the sensors of places, speeds, attitudes and forces of UAV, end effector and deck; `free`: of a UAV that has a plate."""
    cm, pivot, fts = f"{UAV}cm", f"{UAV}pivot", "armland_fts"
    for kind, places in (
        (S.mjSENS_FORCE, {"force": fts, "hinge_force": f"{UAV}hinge" if free else pivot}),
        (S.mjSENS_TORQUE, {"torque": fts}),
        (S.mjSENS_GYRO, {"gyro": cm}),
        (S.mjSENS_FRAMEQUAT, {"quat": cm, "ee_quat": EE_SITE, **({"plate_quat": PLATE} if free else {})}),
        (S.mjSENS_FRAMEPOS, {"r": pivot, "r_cm": cm, "ee_pos": EE_SITE, **({"plate_pos": PLATE} if free else {})}),
        (S.mjSENS_FRAMELINVEL, {"v": pivot, "v_cm": cm, "ee_vel": EE_SITE, **({"plate_vel": PLATE} if free else {})}),
        (S.mjSENS_FRAMEANGVEL, {"plate_rate": PLATE} if free else {}),
    ):
        for name, site in places.items():
            spec.add_sensor(name=name, type=kind, objtype=O.mjOBJ_SITE, objname=site)
    if ground(spec) is not spec.worldbody:
        for name, kind in DECK_SENSORS.items():
            spec.add_sensor(name=name, type=kind, objtype=O.mjOBJ_XBODY, objname=DECK)


def _add_contact_sensors(spec: mujoco.MjSpec, arm: mujoco.MjsBody, cradle: bool, magnet: bool) -> None:
    arm.name = arm.name or "armland_arm"
    body, tree, uav = O.mjOBJ_BODY, O.mjOBJ_XBODY, f"{UAV}uav"
    for name, one, on, other, under, fitted in (
        ("magnet_force", body, "armland_tool", body, PLATE, magnet),
        ("cradle_force", body, "cradle", tree, uav, cradle),
        ("plate_cradle_force", body, "cradle", body, PLATE, cradle),
        ("ground_force", O.mjOBJ_GEOM, "floor", tree, uav, True),
        ("arm_cradle_force", tree, arm.name, body, "cradle", cradle),
        ("arm_floor_force", tree, arm.name, O.mjOBJ_GEOM, "floor", True),
        ("arm_uav_force", tree, arm.name, body, uav, True),
    ):
        if fitted:
            sensor = spec.add_sensor(name=name, type=S.mjSENS_CONTACT, objtype=one, objname=on)
            sensor.reftype, sensor.refname = other, under
            sensor.intprm[:3] = [1 << int(mujoco.mjtConDataField.mjCONDATA_FORCE), NET_FORCE, 1]


def sensor_addresses(model: mujoco.MjModel) -> dict[str, int]:
    """Address of each sensor's first element in `sensordata`, by name."""
    return {model.sensor(i).name: int(model.sensor_adr[i]) for i in range(model.nsensor)}
