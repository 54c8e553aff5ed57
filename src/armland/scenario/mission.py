"""Places, thresholds, limits and paths of the missions."""

from typing import Annotated

from pydantic import Field

from armland.scenario import quantities as of
from armland.scenario.quantities import Section, between, key


class Place(Section):
    """Where things are, deck frame; positions are those of the hinge's pivot."""

    rising = (("standoff_m", "wait_below_m", ""),)

    catch_m: of.Point = key((0.62, 0.0, 0.86), "where the UAV keeps its station and is caught")
    put_down_m: of.Point = key((0.68, 0.0, 0.701), "where the pivot is when the UAV stands on the cradle")
    home_deg: Annotated[tuple[of.Angle, ...], Field(max_length=64)] | None = key(
        None, "joint positions near the catch; searched for if absent"
    )
    wait_below_m: of.Length = key(0.24, "how far below the catch the arm waits")
    waits_above_m: of.Distance = key(
        0.4, "how far above the catch the UAV waits in wind, out of reach of the arm below should it sink"
    )
    standoff_m: of.Length = key(0.03, "gap from which the arm closes")
    above_m: of.Length = key(0.05, "height above the rails at which the descent begins")
    search_m: of.Length = key(0.015, "how far above and below its believed place the cradle is felt for")
    withdraw_m: of.Length = key(0.06, "displacement of the arm downwards after the release")
    keep_hold: bool = key(
        False, "whether the arm keeps hold of the UAV that it has put down; so it does in wind and on a deck unless set"
    )
    takeoff_velocity_mps: of.Velocity3 = key((0.0, 0.0, 0.0), "velocity that the arm gives to a UAV it lets go")
    launch_m: of.Point = key((0.40, 0.0, 0.92), "where the run-up to that velocity leads through")
    fly_on: bool = key(
        False, "whether the UAV keeps that velocity with all its thrust: it may then weigh more than can hover"
    )
    start_offset_m: tuple[of.Distance, of.Distance, of.Distance] = key(
        (0.10, 0.10, 0.15), "half widths of the box in which the UAV starts, about"
    )
    start_above_m: of.Distance = key(0.20, "this height above the catch")
    start_speed_mps: of.Speed = key(0.1, "largest speed at the start, each axis")
    start_heading_deg: of.Degrees = key(10.0, "largest heading error at the start")


class Bounds(Section):
    """Thresholds that end a phase; units in the names."""

    rising = (
        ("align_offset_m", "lost_offset_m", "closing would be given up where it begins"),
        ("pull_seen_n", "pull_test_n", ""),
    )

    uav_error_m: of.Length = key(0.06, "distance to the station from which the arm approaches")
    uav_speed_mps: of.PositiveSpeed = key(0.15, "speed of the UAV at which the arm approaches")
    flown_error_m: of.Length = key(0.06, "distance to its station at which a UAV that was let go has taken off")
    flown_speed_mps: of.PositiveSpeed = key(0.15, "its speed there")
    spare_least: of.Fraction = key(
        0.4,
        "share of the thrust to spare where nothing blows that must be left before the arm comes in wind; 0: it does not wait for it",
    )
    align_offset_m: of.Length = key(0.004, "horizontal offset at which the arm closes")
    align_speed_mps: of.PositiveSpeed = key(0.06, "relative speed at which the arm closes")
    align_tilt_deg: of.Tilt = key(10.0, "tilt of the UAV at which the arm closes")
    lost_offset_m: of.Length = key(0.006, "offset at which closing is given up")
    slipped_m: of.Length = key(
        0.010, "offset of a plate that was gripped, reckoned and in the images, at which the grip is tried anew"
    )
    pull_test_n: of.PositiveForce = key(0.8, "pull of the rotors that tests the grip")
    pull_seen_n: of.PositiveForce = key(0.35, "hinge force that proves it")
    share_carried: of.PositiveFraction = key(0.2, "share of the weight on the arm at which it carries")
    share_touched: of.PositiveFraction = key(0.15, "share on the cradle at which it has been touched")
    share_resting: Annotated[float, between(1e-6, 0.999)] = key(0.85, "share on the cradle at which the magnet opens")
    force_free_n: of.PositiveForce = key(1.2, "hinge force below which the magnet opens")
    force_balanced_n: of.PositiveForce = key(0.4, "hinge force below which a flying UAV is let go")
    force_light_n: of.PositiveForce = key(0.15, "hinge force below which a run-up begins")
    force_launched_n: of.PositiveForce = key(0.6, "hinge force below which a UAV is let go at speed")
    rotors_off_n: of.PositiveForce = key(0.3, "thrust below which the rotors count as stopped")
    thrust_left_n: of.PositiveForce = key(0.05, "distance of the thrust to the ramp's end at which it is over")
    arm_error_m: of.Length = key(0.005, "distance of the arm to its reference at which a move is over")
    let_go_m: of.Length = key(0.01, "gap at which a plate has come off the magnet")
    level_tilt_deg: of.Tilt = key(2.0, "lean against the attitude asked for below which a UAV is let go")
    settled_s: of.Seconds = key(0.3, "least time of a phase that waits for rest")
    coil_off_s: of.Seconds = key(0.2, "time after which a magnet that was switched off has surely let go")
    retries: Annotated[int, Field(ge=0, le=1000)] = key(6, "number of missed captures before the landing is given up")


class Limits(Section):
    """Limits that the supervisor enforces."""

    rising = (("camera_age_ms", "search_ms", "a UAV that is looked for may stay unseen for longer"),)

    hinge_force_share: of.PositiveFraction = key(0.6, "largest hinge force over the magnet's rating")
    joint_speed_share: of.PositiveFraction = key(0.9, "share of the joints' rated speed at which the arm is stopped")
    torque_rate_nm_s: of.Gain | None = key(None, "largest rate of all joints' torques; the arm's own if absent")
    joint_margin_rad: of.Fraction = key(0.02, "distance to a joint's end at which only motion away is left")
    sigma_min: Annotated[float, between(1e-6, 1.0)] = key(0.03, "ratio: smallest singular value of the Jacobian")
    uav_age_ms: of.PositiveMilliseconds = key(250.0, "age of the UAV's sample at which it counts as silent")
    camera_age_ms: of.PositiveMilliseconds = key(2000.0, "age of the camera's sample at which it counts as blind")
    search_ms: Annotated[float, between(1e-3, 60_000.0)] = key(
        8000.0, "likewise while the arm waits below and the UAV is looked for"
    )
    arm_age_ms: of.PositiveMilliseconds = key(5.0, "age of the joints' sample at which the arm is stopped")
    wrench_age_ms: of.PositiveMilliseconds = key(
        20.0, "age of the force-torque sensor's sample at which it counts as dead"
    )
    slip_m: of.Length = key(0.010, "offset of the held plate, as the camera sees it, that counts as slipped off")
    tilt_deg: of.Tilt = key(30.0, "tilt of the UAV at which it counts as out of control")
    balance_push_mps2: of.PositiveAcceleration = key(15.0, "largest acceleration with which the arm balances")
    balance_reach_m: of.Length = key(0.11, "how far the arm may move a UAV that it balances, each axis")
    carried_n: of.PositiveForce = key(20.0, "hinge force that no healthy flight makes while nothing meets")
    impact_n: of.PositiveForce = key(60.0, "hinge force that no healthy flight makes where faces meet")
    unexplained_n: of.PositiveForce = key(2.5, "hinge force that load and thrust need not explain")
    load_gone_n: of.PositiveForce = key(2.0, "a load of this much, of which less than a third is felt, is gone")
    shortfall_n: of.PositiveForce = key(
        0.3, "hinge force of a caught UAV from which on it is learnt what its rotors fail to carry"
    )
    stuck_n: of.PositiveForce = key(18.0, "pull of a plate that should have come off the magnet, at which it sticks")
    magnet_share: of.PositiveFraction = key(0.9, "share of the rating that the self-test must find")


class Move(Section):
    """A point-to-point move with rests: septic in time, so C³ at its ends."""

    to_m: of.Point = Field(description="end point relative to the trajectory's start")
    duration_s: of.PositiveSeconds = Field(description="time of the move")
    rest_s: of.Seconds = key(1.0, "rest at its end")


class Trajectory(Section):
    """Desired path r_d(t) of the pivot."""

    start_m: of.Point | None = key(None, "pivot position at the start; the home pose's if absent")
    moves: Annotated[tuple[Move, ...], Field(min_length=1, max_length=1000)] = Field(description="one after the other")


class Run(Section):
    """Time and randomness."""

    seed: Annotated[int, Field(ge=0, le=2**62)] = key(
        1, "number: seed of every random stream; each stream also has its own name"
    )
    rate_hz: Annotated[int, Field(ge=100, le=10_000)] = key(1000, "base rate of physics and control")
    duration_s: Annotated[float, between(1.0, 600.0)] = key(45.0, "after which a mission that has not ended is over")
    settle_s: of.Rest = key(1.0, "rest before a trajectory starts; not judged")
    tail_s: of.Rest = key(1.0, "rest after a trajectory ends; judged")
    watch_s: of.Rest = key(3.0, "how long a mission that has ended is watched further")
