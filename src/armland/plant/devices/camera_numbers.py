"""What the camera of `devices.camera` is told and keeps, and how a scenario's camera becomes that."""

import numpy as np

from armland.errors import PlantError
from armland.plant.devices.detector_errors import DETECTOR
from armland.plant.noise import stream
from armland.plant.scene.composition import Scene
from armland.plant.sight import AZIMUTHS, clear_angles
from armland.records import Records
from armland.rotations import Array
from armland.scenario import Scenario
from armland.scenario.sensing import Camera, Imperfections

QUEUE = 16
"""Images that can be under way between capture and delivery."""

CELLS = 8.0
"""Cells along an edge of the marker's black square."""

SAMPLE = np.dtype(
    [
        ("fresh", "i8"),  # 1 in the tick in which the sample arrives, else 0
        ("capture", "i8"),  # tick of the exposure
        ("position", "f8", (3,)),  # m, marker's centre in the camera frame
        ("quat", "f8", (4,)),  # camera<-marker, scalar first
        ("sigma", "f8", (6,)),  # claimed standard deviations in camera axes: position m, rotation rad
    ]
)


ERRORS = np.dtype(
    [
        ("frozen", "i8"),  # 1: what the last image showed is delivered again and again, with stamps that look new
        ("lost", "i8"),  # 1: nothing is delivered
        ("flipped", "i8"),  # 1: attitudes are the second solution, `detector_errors.second_pose`
        ("noise", "f8"),  # factor on the noise, not on what is claimed
        ("outlier", "f8"),  # m, standard deviation of what each position is off by, each axis; 0: not at all
        ("marker", "f8", (3,)),  # m, W, from the marker to what is found
    ]
)
"""What fails in the camera."""


def well() -> Records:
    """`ERRORS` (1,) of a camera without faults."""
    errors: Records = np.zeros(1, ERRORS)
    errors["noise"] = 1.0
    return errors


def told_layout(joints: int) -> np.dtype:
    """What the camera is told."""
    return np.dtype(
        [
            ("fitted", "i8"),  # 0 where the scene has none
            ("base_hz", "i8"),
            ("rate_hz", "i8"),
            ("delay_min", "i8"),  # ticks
            ("delay_max", "i8"),  # ticks
            ("eye", "f8", (3,)),  # m, optical centre, E
            ("mark", "f8", (3,)),  # m, marker's centre from the centre of mass, B
            ("half_width", "f8"),  # tangent of half the field of view, image x
            ("half_height", "f8"),  # the same, image y
            ("marker_size", "f8"),  # m
            ("depth_min", "f8"),  # m
            ("depth_max", "f8"),  # m
            ("cos_incidence", "f8"),
            ("cos_clear", "f8", (AZIMUTHS,)),  # likewise of what its own UAV hides, by azimuth in the marker's frame
            ("lateral", "f8", (2,)),
            ("depth", "f8", (2,)),
            ("detector", "f8", (4, 2)),  # lateral, depth, tilt, yaw: `PowerLaw`
            ("smeared", "f8", (3,)),
            ("smear_scale", "f8"),  # px per rad/s of the line of sight
            ("cell", "f8"),  # px·m: width of the marker's cells at a depth of 1 m
            ("shift", "f8", (3,)),  # m
            ("slope", "f8", (3,)),  # direction in which it looks, rad, and focal length, as a share
            ("honesty", "f8"),  # real noise over claimed noise
            ("lose", "f8"),  # probability that a marker seen in the last image is not found in this one
            ("stay_lost", "f8"),  # probability that a marker not found in the last image is not found in this one
            ("outlier", "f8"),  # probability that what is found lies elsewhere
            ("outlier_m", "f8"),  # standard deviation of how far, each axis, m
            ("flip", "f8"),  # probability of the second solution of the pose
            ("askew", "i8"),  # 1 where the camera is turned on its mount
            ("turn", "f8", (4,)),  # by which, camera<-camera as believed
            ("stamp", "i8"),  # ticks by which its stamps are late
        ]
    )


def kept_layout(joints: int) -> np.dtype:
    """What the camera keeps."""
    return np.dtype(
        [
            ("queue", SAMPLE, (QUEUE,)),
            ("due", "i8", (QUEUE,)),  # tick of delivery
            ("first", "i8"),  # images delivered so far
            ("end", "i8"),  # images captured so far that showed a marker
            ("lost", "i8"),
            ("chance", "f8"),  # standard normal, by which the second solution is taken or not
            ("gaze", "f8", (2,)),  # x/z, y/z of the marker at the last exposure
            ("gazed", "i8"),  # tick after it, 0: none yet
            ("image", SAMPLE),  # what the last image with a marker showed
            ("sample", SAMPLE),  # what arrives
            ("eye", "f8", (3,)),  # m, W, true optical centre at the last exposure
            ("eye_quat", "f8", (4,)),  # W<-camera
            ("mark", "f8", (3,)),  # m, W, true centre of the marker then
            ("mark_quat", "f8", (4,)),  # W<-marker
        ]
    )


def tell(told: Records, scenario: Scenario, scene: Scene) -> None:
    """Fill `told` (1,); it stays empty where the scene has no camera.

    Raises:
        PlantError: numbers that the model cannot have.
    """
    if "camera" not in scene.parts:
        return
    told[:] = camera_told(drawn_camera(scenario.camera, scenario.imperfections), scenario.run.rate_hz)
    told["fitted"] = 1
    if scene.uav_body >= 0:
        told["cos_clear"] = np.cos(
            clear_angles(scene.model, scene.uav_body, np.deg2rad(scenario.camera.incidence_max_deg))
        )
    if scenario.imperfections.camera:
        told["shift"], told["slope"] = mounting(scenario)


def drawn_camera(camera: Camera, bad: Imperfections) -> Camera:
    """The camera with its imperfections, or exact and at once where they are switched off."""
    exact = {"delay_ms": (0.0, 0.0), "honesty": 0.01, "lose": 0.0, "exposure_s": 0.0}
    return camera if bad.camera else camera.model_copy(update=exact)


def mounting(scenario: Scenario) -> tuple[Array, Array]:
    """What mounting and calibration left wrong for the scenario's seed: b_s (3,) m and b_z (3,)."""
    bad = scenario.imperfections
    u = stream(scenario.run.seed, "camera mounting").uniform(-1.0, 1.0, 6)
    angle = np.deg2rad(bad.camera_angle_deg)
    return bad.camera_mount_m * u[:3], np.array([angle * u[3], angle * u[4], bad.camera_scale * u[5]])


def camera_told(camera: Camera, base_hz: int) -> Records:
    """What `camera` is told (1,) in a loop at `base_hz`, without errors of mounting.

    Raises:
        PlantError: a rate above the base rate, more images under way than the queue holds, noise that the law cannot fit.
    """
    if not 0 < camera.rate_hz <= base_hz:
        raise PlantError(f"camera.rate_hz = {camera.rate_hz} must lie in [1, {base_hz}], the loop's rate")
    low, high = (round(ms * base_hz / 1000.0) for ms in camera.delay_ms)
    if not 0 <= low <= high or high * camera.rate_hz >= (QUEUE - 1) * base_hz:
        longest = 1000.0 * (QUEUE - 1) / camera.rate_hz
        raise PlantError(f"camera.delay_ms = {camera.delay_ms} must rise, within 0 and {longest:g} ms")
    p: Records = np.zeros(1, told_layout(0))
    p["base_hz"], p["rate_hz"], p["delay_min"], p["delay_max"] = base_hz, camera.rate_hz, low, high
    p["eye"], p["mark"] = camera.position_m, camera.marker_m
    p["half_width"], p["half_height"] = np.tan(0.5 * np.deg2rad(camera.field_of_view_deg))
    p["marker_size"], p["depth_min"] = camera.marker_size_m, camera.depth_min_m
    p["depth_max"] = camera.depth_max_per_size * camera.marker_size_m
    p["cos_incidence"], p["cos_clear"] = np.cos(np.deg2rad(camera.incidence_max_deg)), -1.0
    p["lateral"] = noise_through(camera.reference_m, camera.lateral_m, 1)
    p["depth"] = noise_through(camera.reference_m, camera.depth_m, 2)
    p["detector"], p["smeared"] = DETECTOR[:4], DETECTOR.smeared
    p["smear_scale"], p["cell"] = camera.focal_px * camera.exposure_s, camera.focal_px * camera.marker_size_m / CELLS
    p["honesty"], p["lose"], p["stay_lost"] = camera.honesty, camera.lose, camera.stay_lost
    return p


def noise_through(reference: tuple[float, float], sigma: tuple[float, float], power: int) -> Array:
    """(c₀, c₁) of σ² = c₀² + (c₁ z^power)² through σ (2,) m at depths `reference` (2,) m.

    Raises:
        PlantError: no real c₀ and c₁: σ grows more than z^power does, or falls.
    """
    z = np.array(reference) ** power
    squares = np.linalg.solve(np.column_stack([np.ones(2), z * z]), np.square(sigma))
    if squares.min() < 0.0:
        largest = sigma[0] * z[1] / z[0]
        raise PlantError(f"camera noise {sigma[1]:g} m at {reference[1]:g} m must lie in [{sigma[0]:g}, {largest:g}] m")
    return np.sqrt(squares)


def see_all(told: Records) -> None:
    """Let the camera of `told` (1,) see a marker wherever it is before it, and lose none."""
    told["depth_min"], told["depth_max"], told["cos_incidence"] = 0.0, np.inf, -1.0
    told["cos_clear"] = -1.0
    told["half_width"] = told["half_height"] = np.inf
    told["lose"] = told["stay_lost"] = told["smear_scale"] = 0.0
