"""What a landing's scenario holds beyond the demonstrator's: place, gear, imperfections of the sensors, thresholds, faults."""

import json
import tomllib
from pathlib import Path
from typing import Any, Literal, NamedTuple

from pydantic import Field, ValidationError, model_validator

from armland.config import SCENARIOS, load_scenario
from armland.errors import ConfigurationError
from armland.scenario import Finite, NonNegative, Positive, Positive3, Scenario, Section, Vector3

FAULTS = (
    "link_loss",
    "uplink_loss",
    "downlink_loss",
    "camera_frozen",
    "camera_lost",
    "wrench_frozen",
    "wrench_drift",
    "arm_stale",
    "magnet_coil",
    "magnet_slip",
    "rotor_loss",
    "overload",
    "unreachable",
)
"""What can be made to fail in the plant."""


class Fault(Section):
    """One failure: when it begins, how long it lasts, how bad it is."""

    kind: Literal[
        "link_loss",
        "uplink_loss",
        "downlink_loss",
        "camera_frozen",
        "camera_lost",
        "wrench_frozen",
        "wrench_drift",
        "arm_stale",
        "magnet_coil",
        "magnet_slip",
        "rotor_loss",
        "overload",
        "unreachable",
    ]
    phase: str | None = Field(None, description="phase at whose begin it is armed; the run's begin if absent")
    after_s: NonNegative = Field(0.0, description="time from there")
    lasts_s: Positive = Field(1e6, description="how long it lasts")
    rotor: int = Field(1, ge=1, le=4, description="which rotor; only for `rotor_loss`")
    size: Finite = Field(
        1.0,
        description="drift in N/s, coil or magnet or rotor's share that is lost, load in N, distance in m; not used by the others",
    )


class Place(Section):
    """Where things are, world frame; positions are those of the hinge's pivot."""

    catch_m: Vector3 = Field((0.62, 0.0, 0.86), description="where the UAV keeps its station and is caught")
    put_down_m: Vector3 = Field((0.68, 0.0, 0.701), description="where the pivot is when the UAV stands on the cradle")
    home_deg: tuple[Finite, ...] = Field(
        (-3.0, -83.0, -6.0, -49.0, 11.0, 35.0, -11.0), description="joint positions near the catch"
    )
    wait_below_m: Positive = Field(0.20, description="how far below the catch the arm waits")
    standoff_m: Positive = Field(0.03, description="gap from which the arm closes")
    above_m: Positive = Field(0.05, description="height above the rails at which the descent begins")
    withdraw_m: Positive = Field(0.06, description="way of the arm downwards after the release")
    start_offset_m: Vector3 = Field(
        (0.10, 0.10, 0.15), description="half widths of the box in which the UAV starts, about"
    )
    start_above_m: NonNegative = Field(0.20, description="this height above the catch")
    start_speed_mps: NonNegative = Field(0.1, description="largest speed at the start, each axis")
    start_heading_deg: NonNegative = Field(10.0, description="largest heading error at the start")


class Eye(Section):
    """Camera on the tool and marker under the UAV. Both beside the axis, on the same side, so that it sees until contact."""

    camera_m: Vector3 = Field(
        (0.07, 0.0, -0.10), description="optical centre in the end effector's frame; it looks along its z"
    )
    marker_m: Vector3 = Field(
        (0.07, 0.0, -0.025), description="marker's centre from the centre of mass, body frame; it looks down"
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
    noise: bool = Field(True, description="white noise of encoders, force-torque sensor and attitude")


class Bounds(Section):
    """Thresholds of the mission; units in the names."""

    uav_error_m: Positive = Field(0.06, description="distance to the station from which the arm approaches")
    uav_speed_mps: Positive = 0.15
    align_offset_m: Positive = Field(0.004, description="horizontal offset at which the arm closes")
    align_speed_mps: Positive = Field(0.06, description="relative speed at which the arm closes")
    align_tilt_deg: Positive = Field(6.0, description="tilt of the UAV at which the arm closes")
    lost_offset_m: Positive = Field(0.015, description="offset at which closing is given up")
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
    joint_speed_rad_s: tuple[Positive, ...] = (1.92, 1.92, 2.23, 2.23, 2.27, 3.14, 3.14)
    torque_rate_nm_s: Positive = Field(1500.0, description="largest rate of a joint torque")
    joint_margin_rad: NonNegative = Field(
        0.02, description="distance to a joint's end at which only motion away is left"
    )
    sigma_min: Positive = Field(0.03, description="smallest singular value of the Jacobian")
    uav_age_ms: Positive = 250.0
    camera_age_ms: Positive = 500.0
    arm_age_ms: Positive = 5.0
    wrench_age_ms: Positive = 20.0
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
    duration_s: Positive = Field(45.0, description="after which a mission that has not ended counts as not landed")
    place: Place = Place()
    eye: Eye = Eye()
    imperfections: Imperfections = Imperfections()
    bounds: Bounds = Bounds()
    envelope: Envelope = Envelope()
    onboard_kp_nm: Positive3 = (2.0, 2.0, 1.2)
    onboard_kd_nms: Positive3 = (0.18, 0.18, 0.20)
    onboard_lead_s: NonNegative = 0.05
    onboard_rotor_watch: NonNegative = Field(
        0.75, le=0.95, description="share of its due thrust below which a rotor counts as lost on board; 0: no watch"
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


def landing_scenario(path: str | Path = "landing", overrides: dict[str, Any] | None = None) -> LandingScenario:
    """Load a landing's scenario from a TOML file, or by the name of one that comes with armland.

    Args:
        path: file, or name without suffix.
        overrides: nested values that replace those of the file.

    Raises:
        ConfigurationError: one message that lists every error with its path.
    """
    candidates = (Path(path), SCENARIOS / path, SCENARIOS / f"{path}.toml")
    file = next((c for c in candidates if c.is_file()), None)
    if file is None:
        raise ConfigurationError(f"scenario file {str(path)!r} does not exist; armland comes with 'landing'")
    try:
        data = tomllib.loads(file.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as e:
        raise ConfigurationError(f"{file.name} is not valid TOML: {e}") from e
    _update(data, overrides or {})
    demonstrator_overrides = data.pop("demonstrator", {})
    try:
        landing = Landing.model_validate_json(json.dumps(data))
    except ValidationError as e:
        lines = [
            f"{'.'.join(map(str, x['loc'])) or file.stem}: {x['msg'].removeprefix('Value error, ')}" for x in e.errors()
        ]
        raise ConfigurationError("\n  ".join([f"{file.name}: {len(lines)} problem(s)", *lines])) from e
    return LandingScenario(load_scenario(landing.base, demonstrator_overrides), landing)


def _update(data: dict[str, Any], extra: dict[str, Any]) -> None:
    for key, value in extra.items():
        if isinstance(value, dict) and isinstance(data.get(key), dict):
            _update(data[key], value)
        else:
            data[key] = value
