"""What the UAV is asked: ramps tied to the hinge, station keeping at its station, flying on, set-points in its own world."""

import numpy as np
import pytest

from armland.mission.uav import command_uav
from armland.records import UavMode
from armland.rotations import from_rotation_vector, matrix, multiply

LEVEL = np.array([1.0, 0.0, 0.0, 0.0])


def ask(bench, phase, ticks=1, align=LEVEL):
    """Be in a phase for some ticks; returns the thrust commanded."""
    row = bench.enter(phase)
    for _ in range(ticks):
        command_uav(row, align, bench.b)
        bench.m["tick"] += 1
    return float(bench.c["thrust"][0])


class Hanging:
    """A UAV whose arm `carries` a share of what the rotors leave."""

    def __init__(self, bench, carries):
        self.bench, self.carries = bench, carries
        self.weight = bench.told["act"]["uav"]["weight"][0]
        bench.kept["act"]["hover"] = bench.kept["act"]["thrust"] = self.weight

    def run(self, ticks, phase="hand_over"):
        bench = self.bench
        for _ in range(ticks):
            bench.e["thrust"] = bench.kept["act"]["thrust"]
            bench.e["hinge_force"][0, 2] = self.carries * (self.weight - bench.e["thrust"][0])
            thrust = ask(bench, phase)
        return thrust


def test_thrust_ramps_down_where_the_arm_takes_over(bench):
    share = bench.plan.scenario.control.thrust.carry_share
    hanging = Hanging(bench, 1.0)
    assert hanging.run(2000) == pytest.approx(share * hanging.weight, abs=1e-6)
    assert bench.c["uav_mode"][0] == UavMode.HELD


def test_ramp_has_its_rate(bench):
    hanging = Hanging(bench, 1.0)
    assert hanging.weight - hanging.run(100) == pytest.approx(0.1 * bench.plan.scenario.control.thrust.rate_nps)


def test_thrust_waits_where_nobody_takes_over(bench):
    hanging = Hanging(bench, 0.0)
    assert hanging.run(3000) > hanging.weight - bench.plan.scenario.control.thrust.slack_n - 0.1


def test_rotors_stop_at_the_end_of_the_last_ramp(bench):
    assert Hanging(bench, 1.0).run(4000, "unload") == 0.0
    assert bench.c["uav_mode"][0] == UavMode.OFF


def test_uav_that_nobody_vouches_for_hovers_by_itself(bench):
    bench.kept["act"]["hover"], bench.e["plate_valid"] = 5.0, 0
    assert ask(bench, "guide") == 5.0
    assert bench.c["uav_mode"][0] == UavMode.AUTONOMOUS
    bench.e["plate_valid"] = 1
    ask(bench, "guide")
    assert bench.c["uav_mode"][0] == UavMode.GUIDED


def at_station(bench, away=(0.0, 0.0, 0.0), lean=(0.0, 0.0, 0.0), rate=(0.0, 0.0, 0.0)):
    """A UAV `away` from its station, leaning and turning about its centre of mass, which is at rest."""
    p = bench.told["act"]["uav"]
    R, lever = matrix(from_rotation_vector(np.array(lean))), p["lever"][0]
    bench.e["quat"][0], bench.e["omega"] = from_rotation_vector(np.array(lean)), rate
    cm = p["station"][0] - lever + away
    bench.e["plate"], bench.e["plate_v"] = cm + R @ lever, R @ np.cross(rate, lever)
    bench.m["tick"] = 1000


def test_uav_at_its_station_is_asked_to_hover_there(bench):
    at_station(bench)
    assert ask(bench, "guide") == pytest.approx(bench.told["act"]["uav"]["weight"][0])
    np.testing.assert_allclose(bench.c["uav_quat"][0], LEVEL, atol=1e-12)


def test_swing_of_the_plate_below_the_uav_is_no_motion_of_the_uav(bench):
    at_station(bench, lean=(0.1, 0.0, 0.0), rate=(1.0, 0.0, 0.0))
    ask(bench, "guide")
    np.testing.assert_allclose(bench.c["uav_quat"][0], LEVEL, atol=1e-12)


@pytest.mark.parametrize(("away", "axis"), [((0.1, 0.0, 0.0), 0), ((0.0, -0.1, 0.0), 1)])
def test_uav_beside_its_station_is_tilted_towards_it(bench, away, axis):
    at_station(bench, away)
    ask(bench, "guide")
    lift = matrix(bench.c["uav_quat"][0].copy())[:, 2]
    assert lift[axis] * away[axis] < 0.0


def test_station_keeping_has_its_own_rate(bench):
    at_station(bench, (0.1, 0.0, 0.0))
    ask(bench, "guide")
    first = bench.c["uav_quat"][0].copy()
    bench.e["plate"] += 0.05
    for _ in range(int(bench.told["act"]["uav"]["period"][0]) - 1):
        ask(bench, "guide")
        np.testing.assert_array_equal(bench.c["uav_quat"][0], first)
    ask(bench, "guide")
    assert not np.array_equal(bench.c["uav_quat"][0], first)


def test_thrust_that_carries_the_weight_is_learnt_while_the_station_is_kept(bench):
    at_station(bench)
    weight = bench.told["act"]["uav"]["weight"][0]
    bench.kept["act"]["hover"] = 0.9 * weight
    ask(bench, "guide", 5000)
    assert bench.kept["act"]["hover"][0] == pytest.approx(weight, rel=1e-2)


def test_set_points_travel_in_the_uavs_own_idea_of_the_world(bench):
    align = from_rotation_vector(np.array([0.0, 0.0, 0.3]))
    at_station(bench, (0.1, 0.0, 0.0))
    ask(bench, "guide", align=align)
    np.testing.assert_allclose(multiply(align, bench.c["uav_quat"][0].copy()), bench.kept["act"]["q_d"][0], atol=1e-12)


@pytest.mark.parametrize(("force", "sign"), [(1.0, 1.0), (-1.0, -1.0)])
def test_hinge_is_freed_of_force_by_more_thrust_where_the_arm_lifts(cradle_bench, force, sign):
    bench = cradle_bench
    bench.kept["act"]["thrust"], bench.e["hinge_force"][0, 2] = 3.0, force
    thrust = ask(bench, "hand_back")
    rate = bench.plan.scenario.control.thrust.balance_nps_per_n
    assert thrust - 3.0 == pytest.approx(sign * rate * 1e-3)
    # What carries the weight by then is where the station keeping takes over.
    p = bench.told["act"]["uav"]
    assert bench.kept["act"]["hover"][0] == thrust
    assert bench.kept["act"]["integral"][0, 2] == pytest.approx(thrust / p["mass"][0] - 9.81)
