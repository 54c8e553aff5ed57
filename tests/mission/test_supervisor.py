"""The supervisor: fault table, signs of faults with their debouncing, and limits that only take away."""

import numpy as np
import pytest

from armland.mission.finals import FINALS
from armland.mission.landing_procedure import LANDING
from armland.mission.landing_state import memory_layout, parameters_layout
from armland.mission.phases import CARRIED_N
from armland.mission.records import Limit, landing_layout
from armland.mission.supervisor import (
    DEBOUNCE_TICKS,
    ESCALATION,
    FAULT_TABLE,
    FAULTS,
    GRAVITY_OF,
    KINDS,
    fault_rows,
    find_fault,
    limit,
)
from armland.mission.takeoff_procedure import TAKEOFF

JOINTS = 7
DEBOUNCE = np.array(DEBOUNCE_TICKS, np.int64)
ALL = np.zeros(len(FAULTS), np.int64)


class Bench:
    """Records of a healthy moment at tick 1000."""

    def __init__(self):
        self.p = np.zeros(1, parameters_layout(JOINTS, 4))
        self.s = np.zeros(1, memory_layout(JOINTS))
        self.m, self.e, self.c, self.h = (
            np.zeros(1, landing_layout(name, JOINTS)) for name in ("measurement", "estimate", "command", "health")
        )
        p = self.p
        p["tick_s"], p["tau_max"], p["qd_max"], p["q_min"], p["q_max"] = 1e-3, 100.0, 2.0, -2.0, 2.0
        p["torque_rate"], p["speed_share"], p["joint_margin"], p["sigma_min"] = 1500.0, 0.9, 0.02, 0.03
        p["uav_age"], p["camera_age"], p["arm_age"], p["wrench_age"] = 250, 0.5, 5, 20
        p["hinge_max"], p["tilt_max"], p["slip"], p["free_tolerance"] = 106.0, np.deg2rad(30.0), 0.01, 2.5
        for name in ("tick", "arm_tick", "wrench_tick", "uav_tick", "uav_heard"):
            self.m[name] = 1000
        self.e["quat"][0, 0], self.e["plate_valid"], self.h["joint_margin"] = 1.0, 1, 1.0
        self.s["sigma"], self.s["seen"], self.s["started"], self.s["held"] = 0.2, 1, 1, 1
        p["fall_rate"], p["capture_max"] = 6.0, np.deg2rad(3.0)
        self.s["grip_tick"] = 950

    def find(self, ticks=1, matters=ALL, bad=0, expected=np.nan, magnet_on=False, force_max=1e9):
        for _ in range(ticks):
            fault = find_fault(
                bad,
                magnet_on,
                expected,
                force_max,
                self.m[0],
                self.e[0],
                self.h[0],
                self.p[0],
                self.s[0],
                DEBOUNCE,
                matters,
            )
        return FAULTS[fault]

    def limited(self, tau):
        self.c["tau"] = tau
        limit(0, np.zeros(JOINTS), self.m[0], self.e[0], self.p[0], self.s[0], self.c[0], self.h[0])
        return self.c["tau"][0], int(self.h["flags"][0])


@pytest.fixture
def bench():
    return Bench()


def provoke(bench, fault):
    """Let the sign of a fault show; returns the arguments of `find`."""
    match fault:
        case "non_finite":
            return {"bad": 1}
        case "arm_stale":
            bench.m["arm_tick"] = 990
        case "uav_silent":
            bench.m["uav_tick"] = 700
        case "camera_stale":
            bench.e["plate_age"] = 0.6
        case "wrench_stale":
            bench.m["wrench_tick"] = 970
        case "wrench_drift":
            bench.e["hinge_force"][0, 2] = 5.0
            return {"expected": 2.0}
        case "magnet_coil":
            bench.m["magnet_fault"] = 1
            return {"magnet_on": True}
        case "overload":
            bench.e["hinge_force"][0, 0] = 107.0
        case "rotor_lost":
            # 0.6 rad/s at 6 rad/s of fall: 5.7 degrees that are still to come.
            bench.e["omega"][0] = [0.0, 0.6, 0.0]
        case "uav_tilt":
            bench.s["held"] = 0
            bench.e["quat"][0] = [np.cos(0.3), np.sin(0.3), 0.0, 0.0]
        case "slip":
            bench.s["grip_far"] = 2
        case "near_limit":
            bench.s["sigma"] = 0.02
    return {}


def test_table_has_every_fault_and_every_kind_and_leads_to_ends_only():
    ends = {p.name for p in FINALS if p.name != "done"} | {"-"}
    assert set(FAULT_TABLE) == set(FAULTS[1:])
    for row in FAULT_TABLE.values():
        assert set(row) == set(KINDS)
        assert set(row.values()) <= ends


@pytest.mark.parametrize("phases", [LANDING, TAKEOFF])
def test_every_phase_has_a_row(phases):
    rows, names = fault_rows(phases), [p.name for p in phases]
    for k, phase in enumerate(phases):
        assert phase.kind in KINDS or (phase.final and phase.kind == "end")
        expected = (
            ESCALATION.get(phase.name, {})
            if phase.kind == "end"
            else {f: r[phase.kind] for f, r in FAULT_TABLE.items()}
        )
        found = {f: names[rows[i, k]] for i, f in enumerate(FAULTS) if rows[i, k] >= 0}
        assert found == {f: end for f, end in expected.items() if end != "-"}


def test_second_fault_only_leads_to_graver_ends_so_there_is_no_cycle():
    assert {p.name for p in FINALS} == set(GRAVITY_OF)
    for end, row in ESCALATION.items():
        for fault, worse in row.items():
            assert fault in FAULTS[1:]
            assert GRAVITY_OF[worse] > GRAVITY_OF[end]


def test_an_arm_that_cannot_be_felt_is_braked_wherever_it_is():
    braked = {p.name for p in FINALS if p.arm == "brake"}
    assert set(FAULT_TABLE["arm_stale"].values()) <= braked
    assert {p.name for p in FINALS if p.name not in braked} == {
        e for e, row in ESCALATION.items() if "arm_stale" in row
    }
    assert {ESCALATION[e]["arm_stale"] for e in ESCALATION if "arm_stale" in ESCALATION[e]} <= braked


def test_refused_take_off_leaves_the_rotors_off():
    for name in ("refused", "braked_refused"):
        assert next(p for p in TAKEOFF if p.name == name).uav == "off"
        assert next(p for p in LANDING if p.name == name).uav == "autonomous"


def test_no_end_lets_a_held_uav_go_without_its_thrust():
    for fault, row in FAULT_TABLE.items():
        end = next((p for p in FINALS if p.name == row["held"]), None)
        assert end is None or end.magnet == "on" or end.uav == "autonomous", fault


def test_no_end_stops_a_flying_uav():
    for fault, row in FAULT_TABLE.items():
        end = next((p for p in FINALS if p.name == row["flight"]), None)
        assert end is None or end.uav == "autonomous", fault


def test_no_end_leaves_the_arm_without_stiffness():
    for end in FINALS:
        assert end.arm in ("hold", "back_off", "yield", "brake", "balance")


def test_healthy_moment_has_no_fault(bench):
    assert bench.find(1000) == "none"


@pytest.mark.parametrize("fault", FAULTS[1:])
def test_fault_is_found_after_its_debouncing_and_not_before(bench, fault):
    arguments = provoke(bench, fault)
    needed = DEBOUNCE_TICKS[FAULTS.index(fault)]
    assert needed == 1 or bench.find(needed - 1, **arguments) == "none"
    assert bench.find(1, **arguments) == fault


@pytest.mark.parametrize("fault", FAULTS[1:])
def test_fault_that_does_not_matter_is_let_pass(bench, fault):
    matters = ALL.copy()
    matters[FAULTS.index(fault)] = -1
    assert bench.find(1000, matters, **provoke(bench, fault)) == "none"


def test_sign_that_goes_away_is_forgotten(bench):
    bench.e["hinge_force"][0, 0] = 107.0
    assert bench.find(2) == "none"
    bench.e["hinge_force"][0, 0] = 0.0
    bench.find(1)
    bench.e["hinge_force"][0, 0] = 107.0
    assert bench.find(2) == "none"


def test_torque_within_all_limits_is_not_touched(bench):
    tau, flags = bench.limited(np.full(JOINTS, 1.0))
    np.testing.assert_array_equal(tau, 1.0)
    assert flags == 0


def test_torque_cannot_jump_and_arrives_in_time(bench):
    tau, flags = bench.limited(np.full(JOINTS, 50.0))
    np.testing.assert_allclose(tau, 1.5)
    assert flags == Limit.TORQUE_RATE
    for _ in range(40):
        tau, _ = bench.limited(np.full(JOINTS, 50.0))
    np.testing.assert_allclose(tau, 50.0)


def test_torque_stays_below_its_limit(bench):
    bench.s["tau"] = 99.5
    tau, flags = bench.limited(np.full(JOINTS, 200.0))
    np.testing.assert_allclose(tau, 100.0)
    assert flags == Limit.JOINT_TORQUE
    assert bench.h["torque_ratio"][0] == 2.0


@pytest.mark.parametrize(("speed", "cut"), [(1.9, True), (-1.9, True), (1.7, False)])
def test_fast_joint_is_damped(bench, speed, cut):
    bench.m["qd"][0, 2] = speed
    tau, flags = bench.limited(np.zeros(JOINTS))
    assert bool(flags & Limit.JOINT_SPEED) == cut
    assert (tau[2] * speed < 0.0) == cut


@pytest.mark.parametrize(
    ("q", "tau", "allowed"), [(1.995, 1.0, False), (1.995, -1.0, True), (-1.995, -1.0, False), (1.9, 1.0, True)]
)
def test_joint_at_its_end_is_driven_back_only(bench, q, tau, allowed):
    bench.m["q"][0, 3] = q
    bench.m["qd"][0, 3] = 0.05 * np.sign(tau)
    given, flags = bench.limited(np.full(JOINTS, tau))
    assert bool(flags & Limit.JOINT_POSITION) == (abs(q) > 1.98)
    assert (given[3] == tau) == allowed


def test_largest_force_follows_the_phase(bench):
    bench.e["hinge_force"][0, 2] = 12.0
    assert bench.find(10, force_max=20.0) == "none"
    assert bench.find(10, force_max=5.0) == "overload"


def test_no_phase_allows_more_force_where_nothing_may_touch():
    for phases in (LANDING, TAKEOFF):
        for p in phases:
            if p.kind == "flight" and not p.final:
                assert p.force_n <= CARRIED_N, p.name


def test_link_that_is_silent_on_the_way_up_is_found_as_well(bench):
    bench.m["uav_heard"] = 700
    assert bench.find() == "uav_silent"


def test_plate_of_a_silent_uav_is_left_where_it_is(bench):
    bench.s["grip_far"], bench.m["uav_heard"] = 2, 700
    only = np.full(len(FAULTS), -1, np.int64)
    only[FAULTS.index("slip")] = 0
    assert bench.find(1000, only) == "none"
    bench.m["uav_heard"] = 1000
    assert bench.find(1000, only) == "slip"


@pytest.mark.parametrize(
    ("age", "force", "expected", "found"),
    [
        (500, 0.2, 2.5, "slip"),
        (500, 1.9, 2.5, "none"),
        (500, 0.2, 0.5, "none"),
        (500, 0.2, np.nan, "none"),
        (50, 0.2, 2.5, "none"),
    ],
)
def test_load_that_is_gone_is_a_slip_only_where_no_image_says_otherwise(bench, age, force, expected, found):
    bench.s["grip_tick"], bench.e["hinge_force"][0, 2] = 1000 - age, force
    assert bench.find(100, expected=expected) == found


def test_joint_beyond_its_speed_is_near_its_limit(bench):
    bench.h["speed_ratio"] = 0.95
    assert bench.find(100) == "near_limit"


def test_one_image_that_is_far_off_is_no_slip(bench):
    bench.s["grip_far"] = 1
    assert bench.find(1000) == "none"


@pytest.mark.parametrize(("images", "found"), [(0, "rotor_lost"), (1, "none")])
def test_uav_whose_plate_slides_off_has_lost_no_rotor(bench, images, found):
    bench.e["quat"][0] = [np.cos(0.05), np.sin(0.05), 0.0, 0.0]
    bench.s["grip_far"] = images
    assert bench.find(10) == found
