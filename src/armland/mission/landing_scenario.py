"""What a landing's scenario holds beyond the demonstrator's: place, gear, imperfections of the sensors, thresholds, faults."""

import json
from copy import deepcopy
from pathlib import Path
from typing import Any, NamedTuple

from pydantic import Field, ValidationError, model_validator

from armland.config import SCENARIOS, load_scenario, problem, read_toml, update
from armland.errors import ConfigurationError
from armland.mission.failures import Fault
from armland.scenario import Finite, NonNegative, Positive, Positive3, Scenario, Section, Vector3


class Place(Section):
    """Where things are, world frame; positions are those of the hinge's pivot."""

    catch_m: Vector3 = Field((0.62, 0.0, 0.86), description="where the UAV keeps its station and is caught")
    put_down_m: Vector3 = Field((0.68, 0.0, 0.701), description="where the pivot is when the UAV stands on the cradle")
    home_deg: tuple[Finite, ...] | None = Field(
        None, description="joint positions near the catch; searched for if absent"
    )
    wait_below_m: Positive = Field(0.20, description="how far below the catch the arm waits")
    standoff_m: Positive = Field(0.03, description="gap from which the arm closes")
    above_m: Positive = Field(0.05, description="height above the rails at which the descent begins")
    withdraw_m: Positive = Field(0.06, description="way of the arm downwards after the release")
    takeoff_velocity_mps: Vector3 = Field(
        (0.0, 0.0, 0.0), description="velocity that the arm gives to a UAV it lets go"
    )
    launch_m: Vector3 = Field((0.40, 0.0, 0.92), description="where the run-up to that velocity leads through")
    fly_on: bool = Field(
        False,
        description="whether the UAV keeps that velocity with all its thrust: it may then weigh more than can hover",
    )
    start_offset_m: Vector3 = Field(
        (0.10, 0.10, 0.15), description="half widths of the box in which the UAV starts, about"
    )
    start_above_m: NonNegative = Field(0.20, description="this height above the catch")
    start_speed_mps: NonNegative = Field(0.1, description="largest speed at the start, each axis")
    start_heading_deg: NonNegative = Field(10.0, description="largest heading error at the start")


class RotorsInAir(Section):
    """What motion through the air does to the rotors' thrust and to the body. Not in the paper's experiments."""

    inflow: bool = Field(True, description="thrust by momentum theory at constant rotor speed, models.inflow (I.2)")
    radius_m: Positive = Field(0.1, description="of a rotor; assumption, no source gives the AR.Drone's")
    slope: Positive = Field(
        0.7,
        description="relative loss of thrust per relative rise of the inflow; assumption: σa/(8λ) of two blades of 2 cm by 10 cm",
    )
    inflow_ratio: Positive = Field(
        0.115, description="v_h/ΩR; assumption: 3300 turns a minute where the AR.Drone hovers"
    )
    density_kgm3: Positive = 1.225
    drag_nspm: NonNegative = Field(
        0.22, description="linear drag, horizontal; assumption: 0.45 1/s of quadrotors of this mass"
    )


class Eye(Section):
    """Camera on the tool and marker under the UAV. Both beside the axis, on the same side, so that it sees until contact."""

    camera_m: Vector3 = Field(
        (0.075, 0.0, -0.10), description="optical centre in the end effector's frame; it looks along its z"
    )
    marker_m: Vector3 = Field(
        (0.075, 0.0, -0.03), description="marker's centre from the centre of mass, body frame; it looks down"
    )
    marker_size_m: Positive = Field(0.06, description="edge of the black square")
    rate_hz: int = Field(30, ge=1)


class Imperfections(Section):
    """What the sensors and the UAV get wrong; drawn for each seed within these bounds."""

    force_bias_n: NonNegative = Field(1.0, description="of the force-torque sensor, each axis")
    torque_bias_nm: NonNegative = Field(0.05, description="each axis")
    heading_error_deg: NonNegative = Field(10.0, description="heading that the UAV believes, against the world")
    tilt_error_deg: NonNegative = Field(0.5, description="roll and pitch that the UAV believes")
    thrust_error: NonNegative = Field(0.05, description="thrust given over thrust asked for, less one")
    hover_noise_m: NonNegative = Field(
        0.01, description="white noise of the position that the UAV believes when it hovers by itself"
    )
    camera: bool = Field(True, description="noise, delay and drop-outs of the camera; false: exact, at once")
    camera_mount_m: NonNegative = Field(
        0.0005, description="error of the places of camera and marker together, each axis, which the arm does not know"
    )
    camera_angle_deg: NonNegative = Field(
        0.1, description="error of the direction in which the camera looks, about its x and y, mounting and calibration"
    )
    camera_scale: NonNegative = Field(0.003, description="error of its focal length, as a share of it")
    noise: bool = Field(True, description="white noise of encoders, force-torque sensor and attitude")


class Bounds(Section):
    """Thresholds of the mission; units in the names."""

    uav_error_m: Positive = Field(0.06, description="distance to the station from which the arm approaches")
    uav_speed_mps: Positive = 0.15
    align_offset_m: Positive = Field(0.004, description="horizontal offset at which the arm closes")
    align_speed_mps: Positive = Field(0.06, description="relative speed at which the arm closes")
    align_tilt_deg: Positive = Field(6.0, description="tilt of the UAV at which the arm closes")
    lost_offset_m: Positive = Field(0.006, description="offset at which closing is given up")
    pull_test_n: Positive = Field(0.8, description="pull of the rotors that tests the grip")
    pull_seen_n: Positive = Field(0.35, description="hinge force that proves it")
    share_carried: Positive = Field(0.3, description="share of the weight on the arm at which it carries")
    share_resting: Positive = Field(0.85, description="share on the cradle at which the magnet opens")
    force_free_n: Positive = Field(1.2, description="hinge force below which the magnet opens")
    retries: int = Field(3, ge=0, description="missed captures before the landing is given up")


class Envelope(Section):
    """Limits that the supervisor enforces."""

    hinge_force_share: Positive = Field(0.6, description="largest hinge force over the magnet's rating")
    joint_speed_share: Positive = Field(0.9, description="of the joints' rated speed at which the arm is stopped")
    joint_speed_rad_s: tuple[Positive, ...] = Field((1.92, 1.92, 2.23, 2.23, 2.27, 3.14, 3.14), min_length=1)
    torque_rate_nm_s: Positive = Field(1500.0, description="largest rate of a joint torque")
    joint_margin_rad: NonNegative = Field(
        0.02, description="distance to a joint's end at which only motion away is left"
    )
    sigma_min: Positive = Field(0.03, description="smallest singular value of the Jacobian")
    uav_age_ms: Positive = 250.0
    camera_age_ms: Positive = 500.0
    arm_age_ms: Positive = 5.0
    wrench_age_ms: Positive = 20.0
    slip_m: Positive = Field(
        0.010, description="offset of the held plate, as the camera sees it, that counts as slipped off"
    )
    tilt_deg: Positive = Field(30.0, description="tilt of the UAV at which it counts as out of control")
    capture_deg: Positive = Field(
        3.0, description="tilt plus tilt rate over the rate of fall at which a UAV on the hinge counts as falling"
    )
    balance_push_mps2: Positive = Field(15.0, description="largest acceleration with which the arm balances a UAV")
    balance_reach_m: Positive = Field(0.11, description="how far the arm may move a UAV that it balances, each axis")


class Landing(Section):
    """A landing (or take-off): everything beyond the demonstrator's scenario."""

    title: str = "landing"
    base: str = Field("paper", description="scenario of arm, tool, UAV and link")
    seed: int = Field(1, ge=0)
    duration_s: Finite = Field(
        45.0, ge=1.0, description="after which a mission that has not ended counts as not landed"
    )
    place: Place = Place()
    eye: Eye = Eye()
    imperfections: Imperfections = Imperfections()
    bounds: Bounds = Bounds()
    envelope: Envelope = Envelope()
    rotors: RotorsInAir = RotorsInAir()
    onboard_kp_nm: Positive3 = (2.0, 2.0, 1.2)
    onboard_kd_nms: Positive3 = (0.18, 0.18, 0.20)
    onboard_lead_s: NonNegative = 0.05
    onboard_rotor_watch: NonNegative = Field(
        0.6, le=0.95, description="share of its due thrust below which a rotor counts as lost on board; 0: no watch"
    )
    carry_share: Positive = Field(
        0.5, description="share of the weight that the rotors carry while the arm moves the UAV"
    )
    magnet_rating_n: Positive = Field(177.0, description="pull of the magnet in contact")
    plate_mass_kg: NonNegative = Field(0.0478, description="mass of the hinge plate, which the UAV carries in flight")
    extra_mass_kg: NonNegative = Field(
        0.0, description="mass that the UAV carries beyond its own, known to the controller"
    )
    faults: tuple[Fault, ...] = ()

    @model_validator(mode="after")
    def _consistent(self) -> "Landing":
        problems, b, p = [], self.bounds, self.place
        if b.lost_offset_m <= b.align_offset_m:
            problems.append(
                f"bounds.lost_offset_m = {b.lost_offset_m:g} must exceed bounds.align_offset_m = {b.align_offset_m:g}: "
                "closing would be given up where it begins"
            )
        if b.pull_seen_n >= b.pull_test_n:
            problems.append(
                f"bounds.pull_seen_n = {b.pull_seen_n:g} must be below bounds.pull_test_n = {b.pull_test_n:g}"
            )
        if b.share_carried >= 1.0 - self.carry_share:
            problems.append(
                f"bounds.share_carried = {b.share_carried:g} must be below 1 - carry_share = {1.0 - self.carry_share:g}: "
                "the rotors carry the rest"
            )
        if b.share_resting >= 1.0:
            problems.append(
                f"bounds.share_resting = {b.share_resting:g} must be below 1: the cradle carries no more than all"
            )
        if p.standoff_m >= p.wait_below_m:
            problems.append(
                f"place.standoff_m = {p.standoff_m:g} must be below place.wait_below_m = {p.wait_below_m:g}"
            )
        if problems:
            raise ValueError("\n".join(problems))
        return self


class LandingScenario(NamedTuple):
    """Demonstrator and landing together."""

    demonstrator: Scenario
    landing: Landing
    text: str = ""
    """The file as it was read."""
    overrides: str = ""
    """What replaced values of the file, as JSON."""


def landing_scenario(path: str | Path = "landing", overrides: dict[str, Any] | None = None) -> LandingScenario:
    """Load a landing's scenario from a TOML file, or by the name of one that comes with armland.

    Args:
        path: file, or name without suffix.
        overrides: nested values that replace those of the file.

    Raises:
        ConfigurationError: one message that lists every error with its path.
    """
    file = _find(path)
    data = read_toml(file)
    update(data, deepcopy(overrides or {}))
    demonstrator = data.pop("demonstrator", {})
    head = f"{file.name} as overridden" if overrides else file.name
    problems = [] if isinstance(demonstrator, dict) else [f"demonstrator: should be a table (got {demonstrator!r})"]
    try:
        landing = Landing.model_validate_json(json.dumps(data, default=str))
    except ValidationError as e:
        problems += [line for x in e.errors() for line in problem(x, Landing).split("\n")]
    if problems:
        raise ConfigurationError(
            "\n  ".join([f"{head}: {len(problems)} problem{'s' if len(problems) > 1 else ''}", *problems])
        )
    text = json.dumps(overrides, sort_keys=True, default=str) if overrides else ""
    return LandingScenario(
        _demonstrator(landing.base, demonstrator, file, head), landing, file.read_text("utf-8"), text
    )


def _find(path: str | Path) -> Path:
    for candidate in (Path(path), SCENARIOS / path, SCENARIOS / f"{path}.toml"):
        if candidate.is_file():
            return candidate
    known = ", ".join(sorted(p.stem for p in SCENARIOS.glob("*.toml") if "base" in read_toml(p)))
    raise ConfigurationError(f"scenario file {str(path)!r} does not exist; armland comes with {known}")


def _demonstrator(base: str, extra: dict[str, Any], file: Path, head: str) -> Scenario:
    # Files are relative to the folder of the scenario that names them.
    for section in ("arm", "uav"):
        part = extra.get(section)
        if isinstance(part, dict) and isinstance(part.get("file"), str) and (file.parent / part["file"]).is_file():
            part["file"] = str((file.parent / part["file"]).resolve())
    beside = file.parent / base
    try:
        return load_scenario(beside if beside.is_file() else base, extra)
    except ConfigurationError as e:
        raise ConfigurationError(f"{head}: base and [demonstrator]: {e}") from e
