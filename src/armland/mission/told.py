"""What each stage of the controller is told, from the believed scenario: the numbers of the board's `told`."""

from typing import NamedTuple

import numpy as np

from armland.control.design.balance import balance_gains, fall_rate
from armland.control.design.gains import Wanted, exact_gains
from armland.control.laws.realisation import told as realisation_told
from armland.control.laws.rigid_body import ExactGains
from armland.control.laws.settings import Row
from armland.control.laws.settings import told as law_told
from armland.estimation import contact, deck, disturbance, momentum, wrench
from armland.estimation.plate import layouts
from armland.estimation.plate.layouts import FELT_S
from armland.mission.belief import Flyer
from armland.mission.board import board_layout
from armland.mission.feasibility.launch import Launch
from armland.mission.feasibility.pace import downwards
from armland.mission.feasibility.path import room
from armland.mission.feasibility.weight import hover_max
from armland.mission.reference import view
from armland.mission.reference.guided import SEEN_S
from armland.mission.reference.moves import FLOOR_M
from armland.mission.supervisor.faults import GUSTS_S, PLUNGES_MPS, SINKS_MPS
from armland.mission.table.mission import Start
from armland.mission.uav import LEANT_MPS2, RECKONED_S
from armland.models.airframe.lift import lift_range
from armland.models.airframe.slope import tell_slope
from armland.models.arm import ArmModel
from armland.models.parameters import rotor_count
from armland.models.weather import GUST, STRONGEST, expected
from armland.records import Records
from armland.rotations import Array
from armland.scenario import Scenario
from armland.scenario.control import Experiment

JOINT_LEAP_RAD_S = 50.0
"""Speed that no joint has, where the fastest is rated 3.14 rad/s: a sample that asks for more leaps."""

ATTITUDE_LEAP_RAD = 0.15
"""Turn of the UAV's attitude between two samples, beyond what its rates explain, that no UAV makes."""

LATE_S, LATER_S = 0.2, 0.1
"""Delay of the link, both ways, with which no UAV is guided; by how much it may exceed the one that it is told."""

SWING = 0.75
"""The wrist's share of a balancing pivot's displacement. At this one the pivot may be fastest: 0.9 to 1.1 m/s across the corners
of its reach, against 0.6 m/s of the wrist alone and 0.3 m/s of the arm without it."""

APART_RAD = np.deg2rad(6.0)
"""Of the hinge's range, kept for a UAV that is balanced and leans away from the tool. With 12 degrees the arm moves too far."""

COMING_MPS2 = 3.0
"""Largest acceleration of the UAV that is carried on over the uplink's delay: what its largest tilt makes."""

ASTRAY_M = 0.15
"""Standard deviation beyond which a UAV that is reckoned in wind is left to its own hover: until its accelerometers' bias is known
that is soon."""

FELT = 2.0
"""Of the strongest gust's acceleration: what the UAV's accelerometers may feel beyond the model. The arm pulls as hard."""

FLEES_SHARE = 0.75
"""Of the height at which the arm waits below the plate, how far it draws away from a plate that it has missed."""

BALANCE_AGE_S = 0.05
"""Oldest attitude that can be balanced by."""

SETTLE_M = 0.025
"""Height above the rails below which a UAV is set down and not balanced."""

MISSED_SHARE = 0.6
"""Of the slack that stops the rotors' ramp: a load of so much that is not felt is missed before the ramp comes to its stop."""

CLEAR_M = 0.01
"""Height above them from which the cradle carries nothing."""


class Telling(NamedTuple):
    """What the numbers are made of."""

    scenario: Scenario
    """Believed, with the experiment's gains."""
    arm: ArmModel
    flyer: Flyer
    speeds: Array
    """Rated speed (n,), rad/s, of each joint."""
    R_d: Array
    """(3, 3), D<-E, where the end effector points."""
    targets: Array
    """(phases, 3), m, deck, of the phases that move."""
    switches: Experiment
    """Table II's."""
    row: Row
    """Of the table of laws."""
    start: Start
    launch: Launch | None
    home: Array | None = None
    """Pose (n,), rad, from which the arm approaches."""

    @property
    def hinged(self) -> bool:
        """Whether the UAV is bound to the arm for good."""
        return self.start == "hinged"

    @property
    def tick_s(self) -> float:
        """Period of the control loop, s."""
        return 1.0 / self.scenario.run.rate_hz

    def ticks(self, milliseconds: float) -> int:
        """Number of ticks, rounded, in `milliseconds`, ms."""
        return round(milliseconds * self.scenario.run.rate_hz / 1000)


def tell(t: Telling) -> Records:
    """The board's `told` (1,)."""
    told = np.zeros(1, board_layout(t.arm.joints)["told"])
    _estimate(told["estimate"], t)
    _decide(told["decide"], t)
    _refer(told["refer"], t)
    _uav(told["act"]["uav"], t)
    _law(told["act"]["law"], t)
    c = t.scenario.control
    told["act"]["realisation"] = realisation_told(t.scenario, t.arm, t.R_d, t.home)
    k, d = c.free_rad_s**2, 2.0 * c.free_damping * c.free_rad_s
    told["act"]["stiffness"], told["act"]["damping"] = k, d
    told["act"]["lean_stiffness"], told["act"]["lean_damping"] = k, d
    _limit(told["limit"], t)
    return told


def _estimate(p: Records, t: Telling) -> None:
    s, hinged = t.scenario, t.hinged
    p["gravity"] = s.environment.gravity_mps2
    p["tick_s"], p["fused"], p["coriolis"] = t.tick_s, not hinged, hinged and s.control.coriolis_feedforward
    p["velocity_terms"], p["carried"] = t.switches.acceleration == "implied", s.control.deck_feedforward
    p["joint_leap"] = np.inf if hinged else JOINT_LEAP_RAD_S * t.tick_s
    p["attitude_leap"] = np.inf if hinged else ATTITUDE_LEAP_RAD
    p["mass"], p["weight"] = t.flyer.mass, t.flyer.weight
    p["body_mass"], p["lever"] = t.flyer.body.mass, t.flyer.body.lever
    # What is asked of a hinged UAV counts as given: what is not, is a disturbance.
    p["uplink"], p["learns"] = (1, 0) if hinged else (t.ticks(s.link.uplink_delay_ms), 1)
    p["rotor_gain"] = 1.0 if hinged else 1.0 - np.exp(-1.0 / (s.run.rate_hz * s.rotors.time_constant_s))
    p["drag"], p["camera"], p["slip"] = s.uav.drag_nspm, s.camera.position_m, s.limits.slip_m
    p["launch"] = 0.0 if t.launch is None else t.launch.velocity
    p["wrench_age"], calm_s = t.ticks(s.limits.wrench_age_ms), s.estimation.contact.calm_s
    p["calm_gain"] = 1.0 - np.exp(-t.tick_s / calm_s) if calm_s > 0.0 else 1.0
    # The published laws take the reading as it is; (X.6) takes the tool's inertia force off by itself.
    p["tool_follows"] = 0.0 if hinged else 1.0
    p["onboard_kp"], p["onboard_kd"] = s.onboard.kp_nm, s.onboard.kd_nms
    tell_slope(p, s, t.flyer.body.mass * t.flyer.gravity, rotor_count(s))
    p["windy"] = expected(s).mean > 0.0
    gust = FELT * s.uav.drag_nspm / t.flyer.mass * expected(s).gust(STRONGEST)
    p["filter"] = layouts.told(s, t.flyer.mass, t.flyer.body.lever, gust)
    p["wrench"], p["contact"], p["deck"] = wrench.told(s), contact.told(s), deck.told(s)
    p["momentum"] = momentum.told(s, t.arm, t.flyer.weight)
    bandwidth, most = s.estimation.load_observer_rad_s, s.estimation.load_observer_limit_n
    if hinged:
        bandwidth, most = (s.control.observer_rad_s if t.switches.observer else 0.0), s.control.observer_limit_n
    p["observer"] = disturbance.told(t.flyer.body.mass, bandwidth, most, t.tick_s, by_axis=not hinged)


def _decide(p: Records, t: Telling) -> None:
    s, limits, watch = t.scenario, t.scenario.limits, p["watch"]
    p["tick_s"], p["station"], p["weight"] = t.tick_s, _station(t), t.flyer.weight
    p["magnet_ready"], p["clear_z"] = limits.magnet_share * s.magnet.rating_n, s.place.put_down_m[2] + CLEAR_M
    watch["tick_s"] = t.tick_s
    watch["uav_age"], watch["camera_age"] = t.ticks(limits.uav_age_ms), 1e-3 * limits.camera_age_ms
    watch["search_age"] = 1e-3 * limits.search_ms
    watch["arm_age"], watch["wrench_age"] = t.ticks(limits.arm_age_ms), t.ticks(limits.wrench_age_ms)
    link = 1e-3 * (s.link.uplink_delay_ms + s.link.downlink_delay_ms)
    watch["late"], watch["uav_late"] = max(LATE_S, link + LATER_S), 1e-3 * limits.uav_age_ms
    watch["unexplained"], watch["load_gone"], watch["stuck"] = limits.unexplained_n, limits.load_gone_n, limits.stuck_n
    # Where the arm does not take the load over, the ramp stops at its slack: what is gone must be missed before.
    watch["load_missed"] = min(limits.load_gone_n, MISSED_SHARE * s.control.thrust.slack_n)
    watch["hinge_max"], watch["tilt_max"] = limits.hinge_force_share * s.magnet.rating_n, np.deg2rad(limits.tilt_deg)
    _, static = lift_range(s)
    air, windy = GUST * expected(s).sinking, expected(s).mean > 0.0
    watch["sinks"], watch["plunges"] = SINKS_MPS + air, PLUNGES_MPS + air
    watch["thrust_max"] = s.control.thrust.ceiling * static
    # One that flies on with all its thrust need not hover.
    watch["gust"], watch["hover_max"] = windy * GUSTS_S, np.inf if s.place.fly_on else hover_max(s, windy)
    watch["joint_margin"], watch["sigma_min"] = limits.joint_margin_rad, limits.sigma_min
    watch["speed_share"] = limits.joint_speed_share


def _refer(p: Records, t: Telling) -> None:
    s, a, place, limits = t.scenario, t.scenario.control.approach, t.scenario.place, t.scenario.limits
    p["tick_s"], p["standoff"], p["beyond"], p["depth"] = t.tick_s, place.standoff_m, a.beyond_m, place.withdraw_m
    p["targets"][0, : len(t.targets)] = t.targets
    p["track"], p["track_max"], p["coast"] = a.track_rad_s, a.track_max_mps2, a.coast_s
    p["lowest"] = min(place.catch_m[2] - place.wait_below_m, place.put_down_m[2] - place.search_m - place.withdraw_m)
    p["flees"], p["floor"] = FLEES_SHARE * place.wait_below_m, place.catch_m[2] - place.wait_below_m - 0.25 * FLOOR_M
    p["flees_mps"] = np.inf if t.home is None else downwards(t.arm, t.home, limits.joint_speed_share * t.speeds)
    p["lower"], p["search"] = a.lower_mps, place.search_m
    p["track_speed"], p["room"] = a.track_max_mps, room(s, t.start)
    p["give_way"], p["give_way_max"] = a.give_way_mpns, a.give_way_max_m
    if t.launch is not None:
        p["launch"], p["launch_s"], p["leave_s"] = t.launch.velocity, t.launch.run_up_s, t.launch.leave_s
        # A speed that has to be given up runs out no faster than it was gained.
        p["coast"] = max(a.coast_s, float(np.linalg.norm(t.launch.velocity)) / t.launch.acceleration)
    b, rate = p["balance"], _fall_rate(t)
    b["fall_rate"], b["gains"] = rate, balance_gains(rate) if np.isfinite(rate) else 0.0
    b["gravity"] = t.flyer.gravity
    b["push_max"], b["sway_max"] = limits.balance_push_mps2, limits.balance_reach_m
    # The last joint but one tilts the tool: where it sits is the wrist.
    b["swing"], b["wrist"] = SWING, np.linalg.norm(t.arm.position - t.arm.anchor[-2])
    hinge = np.deg2rad(s.hinge.range_deg)
    b["lean_most"] = max(hinge - APART_RAD, 0.5 * hinge)
    b["attitude_age"], b["lost"] = t.ticks(1e3 * BALANCE_AGE_S), limits.balance_reach_m * rate**2 / t.flyer.gravity
    b["down"], b["settle"] = place.put_down_m[2], SETTLE_M


def _uav(p: Records, t: Telling) -> None:
    tell_station(p, t.scenario, t.flyer, _station(t))
    p["sight"]["above"] *= t.start == "air"
    if t.launch is not None:
        p["launch"] = t.launch.velocity
        if t.scenario.place.fly_on:
            p["fly_on"], p["thrust_max"] = 1, lift_range(t.scenario)[1]


def tell_station(p: Records, s: Scenario, flyer: Flyer, station: Array) -> None:
    """Fill `p` (1,) of `uav.told_layout`: what commanding a UAV is told, whoever lands it.

    Args:
        p: written.
        s: believed scenario.
        flyer: what flies.
        station: (3,), m, D, of the pivot.
    """
    c, k, thrust = s.control, s.control.station, s.control.thrust
    p["tick_s"], p["mass"], p["weight"], p["gravity"] = 1.0 / s.run.rate_hz, flyer.mass, flyer.weight, flyer.gravity
    p["lever"], p["drag"], p["station"], p["heading"] = flyer.body.lever, s.uav.drag_nspm, station, 0.0
    p["thrust_rate"], p["force_slack"], p["balance_rate"] = thrust.rate_nps, thrust.slack_n, thrust.balance_nps_per_n
    idle, full = lift_range(s)
    p["shortfall"] = s.limits.shortfall_n
    p["thrust_min"] = idle + thrust.floor_n
    p["thrust_max"], p["hinged"] = thrust.ceiling * full, c.thrust_n
    p["lift_min"] = p["thrust_min"]
    if s.foretold_mps > 0.0 or s.foretold_deck:
        # A deck that falls away is followed no faster than can be braked when it comes back.
        p["lift_min"] = np.maximum(p["thrust_min"], 2.0 * flyer.weight - p["thrust_max"])
    p["period"], p["hover_s"] = s.run.rate_hz // k.rate_hz, k.hover_s
    p["k_position"], p["k_velocity"], p["k_integral"] = k.k_position, k.k_velocity, k.k_integral
    p["speed_max"], p["integral_max"] = k.speed_max_mps, k.integral_max_mps2
    wind, drag = expected(s), s.uav.drag_nspm / flyer.mass
    feels = wind.mean > 0.0 and s.estimation.plate.accelerometer
    p["reckoned"], p["fades"] = (FELT_S, FELT_S) if feels else (RECKONED_S, SEEN_S)
    p["astray"] = ASTRAY_M if wind.mean > 0.0 else np.inf
    p["leant"] = max(LEANT_MPS2, drag * wind.gust(STRONGEST))
    p["rides"], p["ahead"], p["coming_max"], p["vertical"] = k.rides_rad_s, k.ahead, COMING_MPS2, k.vertical
    # An attitude under kp and kd is late by kd/kp, whatever it turns; thrust by the rotors' lag.
    uplink, o = 1e-3 * s.link.uplink_delay_ms, s.onboard
    p["lags"] = uplink + np.array([o.kd_nms[0] / o.kp_nm[0], o.kd_nms[1] / o.kp_nm[1], s.rotors.time_constant_s])
    p["tilt_max"], p["gust_share"], p["gust_max"] = k.tilt_max_rad, k.gust_share, k.gust_max_mps2
    p["sight"] = view.told(s, flyer.body.lever, wind.lean(drag / flyer.gravity, GUST))


def _law(p: Records, t: Telling) -> None:
    s, c, body = t.scenario, t.scenario.control, t.flyer.body
    if t.hinged:
        gains = ExactGains(np.array(c.k1), np.array(c.k2), c.k3_attitude or c.k3, c.k3)
    else:
        wanted = Wanted(c.position_rad_s, c.position_damping)
        gains = exact_gains(wanted, np.array(s.onboard.kp_nm), np.array(s.onboard.kd_nms), body)
    p[:] = law_told(s, t.switches, t.row, body, gains)
    # The attitude of a UAV on the magnet is the onboard controller's: the law takes it as it is.
    p["attitude"] = t.hinged


def _limit(p: Records, t: Telling) -> None:
    s, limits, arm = t.scenario, t.scenario.limits, t.arm
    p["tick_s"], p["q_min"], p["q_max"] = t.tick_s, arm.q_min, arm.q_max
    p["qd_max"], p["tau_max"], p["sigma_min"] = t.speeds, arm.tau_max, limits.sigma_min
    if t.hinged:
        # As the paper's controller: the torque's limit alone.
        p["joint_margin"], p["speed_share"], p["torque_rate"], p["hinge_max"] = -np.inf, np.inf, np.inf, np.inf
        p["uav_age"] = t.ticks(s.link.watchdog_ms)
        return
    p["joint_margin"], p["speed_share"] = limits.joint_margin_rad, limits.joint_speed_share
    p["torque_rate"] = arm.torque_rate if limits.torque_rate_nm_s is None else limits.torque_rate_nm_s
    p["hinge_max"] = limits.hinge_force_share * s.magnet.rating_n
    p["uav_age"] = t.ticks(limits.uav_age_ms)


def _station(t: Telling) -> Array:
    # A UAV that takes off flies off upwards, out of the arm's way.
    place = t.scenario.place
    return np.array(place.catch_m) + [0.0, 0.0, place.start_above_m if t.start == "cradle" else 0.0]


def _fall_rate(t: Telling) -> float:
    # A UAV on the hinge for good has its own attitude controller and is never balanced.
    return np.inf if t.hinged else fall_rate(t.flyer.body)
