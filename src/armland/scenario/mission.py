"""Places, thresholds, limits and paths of the missions."""

from typing import Annotated

from pydantic import Field

from armland.scenario.quantities import (
    Angle,
    Degrees,
    Distance,
    Fraction,
    Gain,
    Length,
    Point,
    PositiveAcceleration,
    PositiveForce,
    PositiveFraction,
    PositiveMilliseconds,
    PositiveSeconds,
    PositiveSpeed,
    Rest,
    Seconds,
    Section,
    Speed,
    Tilt,
    Velocity3,
    between,
)


class Place(Section):
    """Where things are, deck frame; positions are those of the hinge's pivot."""

    catch_m: Point = Field((0.62, 0.0, 0.86), description="where the UAV keeps its station and is caught")
    put_down_m: Point = Field((0.68, 0.0, 0.701), description="where the pivot is when the UAV stands on the cradle")
    home_deg: Annotated[tuple[Angle, ...], Field(max_length=64)] | None = Field(
        None, description="joint positions near the catch; searched for if absent"
    )
    wait_below_m: Length = Field(0.20, description="how far below the catch the arm waits")
    standoff_m: Length = Field(0.03, description="gap from which the arm closes")
    above_m: Length = Field(0.05, description="height above the rails at which the descent begins")
    withdraw_m: Length = Field(0.06, description="displacement of the arm downwards after the release")
    takeoff_velocity_mps: Velocity3 = Field(
        (0.0, 0.0, 0.0), description="velocity that the arm gives to a UAV it lets go"
    )
    launch_m: Point = Field((0.40, 0.0, 0.92), description="where the run-up to that velocity leads through")
    fly_on: bool = Field(
        False,
        description="whether the UAV keeps that velocity with all its thrust: it may then weigh more than can hover",
    )
    start_offset_m: tuple[Distance, Distance, Distance] = Field(
        (0.10, 0.10, 0.15), description="half widths of the box in which the UAV starts, about"
    )
    start_above_m: Distance = Field(0.20, description="this height above the catch")
    start_speed_mps: Speed = Field(0.1, description="largest speed at the start, each axis")
    start_heading_deg: Degrees = Field(10.0, description="largest heading error at the start")


class Bounds(Section):
    """Thresholds that end a phase; units in the names."""

    uav_error_m: Length = Field(0.06, description="distance to the station from which the arm approaches")
    uav_speed_mps: PositiveSpeed = Field(0.15, description="speed of the UAV at which the arm approaches")
    align_offset_m: Length = Field(0.004, description="horizontal offset at which the arm closes")
    align_speed_mps: PositiveSpeed = Field(0.06, description="relative speed at which the arm closes")
    align_tilt_deg: Tilt = Field(6.0, description="tilt of the UAV at which the arm closes")
    lost_offset_m: Length = Field(0.006, description="offset at which closing is given up")
    pull_test_n: PositiveForce = Field(0.8, description="pull of the rotors that tests the grip")
    pull_seen_n: PositiveForce = Field(0.35, description="hinge force that proves it")
    share_carried: PositiveFraction = Field(0.3, description="share of the weight on the arm at which it carries")
    share_touched: PositiveFraction = Field(0.15, description="share on the cradle at which it has been touched")
    share_resting: Annotated[float, between(1e-6, 0.999)] = Field(
        0.85, description="share on the cradle at which the magnet opens"
    )
    force_free_n: PositiveForce = Field(1.2, description="hinge force below which the magnet opens")
    force_balanced_n: PositiveForce = Field(0.4, description="hinge force below which a flying UAV is let go")
    force_light_n: PositiveForce = Field(0.15, description="hinge force below which a run-up begins")
    force_launched_n: PositiveForce = Field(0.6, description="hinge force below which a UAV is let go at speed")
    rotors_off_n: PositiveForce = Field(0.3, description="thrust below which the rotors count as stopped")
    thrust_left_n: PositiveForce = Field(
        0.05, description="distance of the thrust to the ramp's end at which it is over"
    )
    arm_error_m: Length = Field(0.005, description="distance of the arm to its reference at which a move is over")
    let_go_m: Length = Field(0.01, description="gap at which a plate has come off the magnet")
    level_tilt_deg: Tilt = Field(2.0, description="tilt below which a UAV is let go")
    settled_s: Seconds = Field(0.3, description="least time of a phase that waits for rest")
    coil_off_s: Seconds = Field(0.2, description="time after which a magnet that was switched off has surely let go")
    retries: Annotated[int, Field(ge=0, le=1000)] = Field(
        3, description="number of missed captures before the landing is given up"
    )


class Limits(Section):
    """Limits that the supervisor enforces."""

    hinge_force_share: PositiveFraction = Field(0.6, description="largest hinge force over the magnet's rating")
    joint_speed_share: PositiveFraction = Field(
        0.9, description="share of the joints' rated speed at which the arm is stopped"
    )
    torque_rate_nm_s: Gain = Field(1500.0, description="largest rate of a joint torque")
    joint_margin_rad: Fraction = Field(0.02, description="distance to a joint's end at which only motion away is left")
    sigma_min: Annotated[float, between(1e-6, 1.0)] = Field(
        0.03, description="ratio: smallest singular value of the Jacobian"
    )
    uav_age_ms: PositiveMilliseconds = Field(250.0, description="age of the UAV's sample at which it counts as silent")
    camera_age_ms: PositiveMilliseconds = Field(
        500.0, description="age of the camera's sample at which it counts as blind"
    )
    arm_age_ms: PositiveMilliseconds = Field(5.0, description="age of the joints' sample at which the arm is stopped")
    wrench_age_ms: PositiveMilliseconds = Field(
        20.0, description="age of the force-torque sensor's sample at which it counts as dead"
    )
    slip_m: Length = Field(
        0.010, description="offset of the held plate, as the camera sees it, that counts as slipped off"
    )
    tilt_deg: Tilt = Field(30.0, description="tilt of the UAV at which it counts as out of control")
    capture_deg: Tilt = Field(
        3.0, description="tilt plus tilt rate over the rate of fall at which a UAV on the hinge falls"
    )
    balance_push_mps2: PositiveAcceleration = Field(
        15.0, description="largest acceleration with which the arm balances"
    )
    balance_reach_m: Length = Field(0.11, description="how far the arm may move a UAV that it balances, each axis")
    carried_n: PositiveForce = Field(20.0, description="hinge force that no healthy flight makes while nothing meets")
    impact_n: PositiveForce = Field(60.0, description="hinge force that no healthy flight makes where faces meet")
    unexplained_n: PositiveForce = Field(2.5, description="hinge force that load and thrust need not explain")
    load_gone_n: PositiveForce = Field(
        2.0, description="a load of this much, of which less than a third is felt, is gone"
    )
    magnet_share: PositiveFraction = Field(0.9, description="share of the rating that the self-test must find")


class Move(Section):
    """A point-to-point move with rests: septic in time, so C³ at its ends."""

    to_m: Point = Field(description="end point relative to the trajectory's start")
    duration_s: PositiveSeconds = Field(description="time of the move")
    rest_s: Seconds = Field(1.0, description="rest at its end")


class Trajectory(Section):
    """Desired path r_d(t) of the pivot."""

    start_m: Point | None = Field(None, description="pivot position at the start; the home pose's if absent")
    moves: Annotated[tuple[Move, ...], Field(min_length=1, max_length=1000)] = Field(description="one after the other")


class Run(Section):
    """Time and randomness."""

    seed: Annotated[int, Field(ge=0, le=2**62)] = Field(
        1, description="number: seed of every random stream; each stream also has its own name"
    )
    rate_hz: Annotated[int, Field(ge=100, le=10_000)] = Field(1000, description="base rate of physics and control")
    duration_s: Annotated[float, between(1.0, 600.0)] = Field(
        45.0, description="after which a mission that has not ended is over"
    )
    settle_s: Rest = Field(1.0, description="rest before a trajectory starts; not judged")
    tail_s: Rest = Field(1.0, description="rest after a trajectory ends; judged")
    watch_s: Rest = Field(3.0, description="how long a mission that has ended is watched further")
