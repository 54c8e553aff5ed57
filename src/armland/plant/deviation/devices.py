"""Deviations of what devices are told: rotors, UAV on board, link, camera, force-torque sensor, arm, magnet, air."""

import numpy as np

from armland.errors import ConfigurationError
from armland.models.parameters import rotor_count
from armland.plant.deviation.bodies import torque_limits, value
from armland.plant.deviation.drawn import Values, direction
from armland.plant.devices import motors
from armland.plant.devices.camera_numbers import QUEUE
from armland.plant.devices.link import RING
from armland.plant.scene.composition import Scene
from armland.records import MOST_ROTORS, Records
from armland.rotations import from_rotation_vector, multiply
from armland.scenario import Scenario

DISCS_M2 = 4 * 0.1**2
"""Rotors times the square of their radius, of the UAV for which the share of the downwash is stated: the AR.Drone."""

VERTICAL = 0.5
"""Vertical gusts over horizontal ones, near the ground."""

GEARED_NM = 176.0
"""Torque of the joint whose gear the published compliance stands for, the LWR's largest; the gear of a stronger joint is stiffer in
proportion, so that its full torque winds it up as far: assumption."""


def deviate_devices(values: Values, scenario: Scenario, scene: Scene, told: Records) -> None:
    """Write the deviations into `told` (1,), the devices' part of the plant's record; the scene has them already.

    Raises:
        ConfigurationError: a delay that the simulated device cannot hold.
    """
    _rotors(values, scenario, scene, told["rotors"])
    _on_board(values, scenario, told)
    _link(values, scenario, told["link"])
    if "camera" in scene.parts:
        _camera(values, scenario, told["camera"])
    _wrench(values, told["wrench"])
    _arm(values, scenario, scene, told)
    if "magnet" in scene.parts:
        _magnet(values, told["magnet"])
    _air(values, scenario, told["air"])


def _rotors(values: Values, scenario: Scenario, scene: Scene, told: Records) -> None:
    told["gain"] *= (1.0 + value(values, "uav.thrust")) * (1.0 + values.get("uav.rotor", np.zeros(MOST_ROTORS)))
    told["curve"], rate = value(values, "uav.curve"), scenario.run.rate_hz
    told["sag"], told["drag"] = value(values, "uav.sag_per_s") / rate, told["drag"] * (1.0 + value(values, "uav.drag"))
    constant = scenario.rotors.time_constant_s * (1.0 + value(values, "uav.lag"))
    told["lag"] = 1.0 - np.exp(-1.0 / (rate * constant))
    # The wrench acts at the true centre of mass, about which the rotors' arms are other ones.
    shift = np.zeros(3) + values.get("uav.cm_m", 0.0)
    told["mixer"][0, 1:] -= np.cross(shift, told["axis"][0]).T
    told["place"] -= shift


def _on_board(values: Values, scenario: Scenario, told: Records) -> None:
    imu, onboard = told["imu"], told["onboard"]
    tilt = np.deg2rad(np.append(values.get("uav.tilt_deg", np.zeros(2)), 0.0))
    heading = np.array([0.0, 0.0, np.deg2rad(value(values, "uav.heading_deg"))])
    imu["bias"][0] = multiply(multiply(from_rotation_vector(heading), imu["bias"][0]), from_rotation_vector(tilt))
    imu["rate_bias"] += np.deg2rad(values.get("uav.gyro_dps", np.zeros(3)))
    imu["drift"] = np.deg2rad(value(values, "uav.drift_dps"))
    onboard["trim"] = value(values, "uav.trim_mps2")
    onboard["speed_sigma"] = value(values, "uav.speed_noise_mps")
    onboard["speed_bias"][0, :2] = values.get("uav.speed_bias_mps", np.zeros(2))


def _link(values: Values, scenario: Scenario, told: Records) -> None:
    rate = scenario.run.rate_hz
    for way in ("up", "down"):
        told[way] = _late(f"link.{way}_ms", int(told[way][0]), values, rate)
        told[f"jitter_{way}"] = _ticks(value(values, "link.jitter_ms"), rate)
        told[f"loss_{way}"] = value(values, "link.loss")
        longest = int(told[way][0] + told[f"jitter_{way}"][0])
        if longest >= RING:
            raise ConfigurationError(
                f"deviation.link: {way} {1000 * longest // rate} ms with jitter; the link's delay line holds "
                f"{1000 * (RING - 1) // rate} ms"
            )
    told["burst"], told["stamp"] = value(values, "link.burst"), _ticks(value(values, "link.stamp_ms"), rate)


def _camera(values: Values, scenario: Scenario, told: Records) -> None:
    rate, camera = scenario.run.rate_hz, scenario.camera
    told["honesty"] *= 1.0 + value(values, "camera.noise")
    told["smear_scale"] *= 1.0 + value(values, "camera.exposure")
    told["lose"] = min(told["lose"][0] + value(values, "camera.lose"), 1.0)
    told["stay_lost"] = max(told["stay_lost"][0], told["lose"][0])
    told["outlier"], told["outlier_m"] = value(values, "camera.outlier"), value(values, "camera.outlier_m")
    told["flip"] = value(values, "camera.flip")
    for name in ("delay_min", "delay_max"):
        told[name] = _late("camera.delay_ms", int(told[name][0]), values, rate)
    if told["delay_max"][0] * camera.rate_hz >= (QUEUE - 1) * rate:
        raise ConfigurationError(
            f"deviation.camera.delay_ms: images {1000 * int(told['delay_max'][0]) // rate} ms late; "
            f"{1000 * (QUEUE - 1) // camera.rate_hz} ms can be under way"
        )
    told["stamp"] = _ticks(value(values, "camera.stamp_ms"), rate)
    told["shift"] += values.get("camera.mount_m", np.zeros(3))
    told["slope"][0, :2] += values.get("camera.centre_px", np.zeros(2)) / camera.focal_px
    told["slope"][0, 2] += value(values, "camera.focal")
    turn = np.deg2rad(values.get("camera.mount_deg", np.zeros(3)))
    told["turn"], told["askew"] = from_rotation_vector(turn), bool(turn.any())


def _wrench(values: Values, told: Records) -> None:
    told["gain"][0] += np.diag(values.get("wrench.gain", np.zeros(6)))
    cross = iter(values.get("wrench.cross", np.zeros(12)))
    for block in (range(3), range(3, 6)):
        for i in block:
            for j in block:
                if i != j:
                    told["gain"][0, i, j] += next(cross)
    told["drift"][0] += np.append(
        values.get("wrench.drift_nps", np.zeros(3)), values.get("wrench.drift_nmps", np.zeros(3))
    )


def _arm(values: Values, scenario: Scenario, scene: Scene, told: Records) -> None:
    nothing, limits, motor = np.zeros(scene.joints), torque_limits(scene), told["motors"]
    told["encoders"]["offset"] += values.get("arm.encoder_rad", nothing)
    stiffer = GEARED_NM / np.maximum(limits, GEARED_NM) if scenario.deviation.arm.compliance is None else 1.0
    told["encoders"]["compliance"] = stiffer * values.get("arm.compliance", nothing)
    motor["offset"] += values.get("arm.torque", nothing) * limits
    motor["gain"] *= 1.0 + values.get("arm.torque_gain", nothing)
    motor["sigma"], motor["load"] = value(values, "arm.torque_noise") * limits, value(values, "arm.load_friction")
    motor["delay"] = _ticks(value(values, "arm.delay_ms"), scenario.run.rate_hz)
    if motor["delay"][0] >= motors.RING:
        raise ConfigurationError(
            f"deviation.arm.delay_ms: {motor['delay'][0]} ticks; a motor's delay line holds {motors.RING - 1}"
        )
    motor["odd"] = bool(motor["sigma"].any() or motor["load"][0] > 0.0)
    # Friction that the brakes leave when they are off.
    told["brake"]["free"] = scene.model.dof_frictionloss[scene.joint_dof]


def _magnet(values: Values, told: Records) -> None:
    force = 1.0 + value(values, "magnet.force")
    told["rated"] *= force
    # What it reports follows from the current, which knows nothing of a weak plate or a warm coil.
    told["report_gain"] *= (1.0 + value(values, "magnet.report")) / force
    told["residual"] += value(values, "magnet.residual_n")
    told["dirt"] = value(values, "magnet.gap_m")


def _air(values: Values, scenario: Scenario, told: Records) -> None:
    wind, gust = value(values, "air.wind_mps"), value(values, "air.gust_mps")
    told["mean"] = wind * direction(scenario.run.seed)
    told["sigma"] = gust * np.array([1.0, 1.0, VERTICAL])
    told["ground"], rotors = value(values, "air.ground_effect"), scenario.rotors
    # The tool meets the wake's pressure, which is the thrust over the area of the discs.
    area = rotor_count(scenario) * rotors.radius_m**2
    told["wash"] = value(values, "air.downwash") * min(DISCS_M2 / area, 1.0)
    told["moves"] |= bool(wind or gust or told["ground"][0])


def _late(path: str, believed: int, values: Values, rate_hz: int) -> int:
    # Ticks of a delay that is believed to be so many.
    ticks = believed + _ticks(value(values, path), rate_hz)
    if ticks < 0:
        milliseconds = 1000 / rate_hz
        raise ConfigurationError(
            f"deviation.{path}: {value(values, path):.4g} ms of a delay believed to be {believed * milliseconds:.4g} ms arrives "
            f"{-ticks * milliseconds:.4g} ms before it was sent; at least {-believed * milliseconds:.4g} ms is possible"
        )
    return ticks


def _ticks(milliseconds: float, rate_hz: int) -> int:
    return round(milliseconds * rate_hz / 1000.0)
