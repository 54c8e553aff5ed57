"""The pivot under a UAV without thrust: against an inverted pendulum, with the delay of its attitude, and near the rails."""

import numpy as np
import pytest

from armland.mission.reference.balance import BALANCED, GIVEN_UP, SETTLED, begin_balance, refer_balance
from armland.mission.reference.moves import BALANCE, move
from armland.rotations import from_rotation_vector, matrix
from armland.scenario import load_scenario

DT = 1e-3


class Pendulum:
    """Two inverted pendulums on the pivot that the reference moves, seen `late` ticks late and carried on by their rates.

    They stand at a tilt `stands` (2,); the UAV hovered with the acceleration `hovered` (2,), m/s².
    """

    def __init__(self, bench, lean, late, height=0.8, stands=(0.0, 0.0), hovered=(0.0, 0.0)):
        self.stands, self.hovered = np.array(stands), np.array(hovered)
        self.bench, self.late, self.claimed = bench, late, late
        self.told, self.kept, self.e, self.r = bench.told["refer"], bench.kept["refer"], bench.e, bench.tick.reference
        self.rate = self.told["balance"]["fall_rate"][0]
        self.theta, self.theta_dot, self.now = np.array(lean), np.zeros(2), 0
        self.past = [(self.theta.copy(), self.theta_dot.copy())] * (late + 1)
        self.e["r"], self.e["v"] = [0.6, 0.0, height], 0.0
        self.kept["r0"], self.kept["v0"] = self.e["r"], 0.0
        begin_balance(self.e[0], self.hovered, self.told["balance"][0], self.kept["balance"][0])

    def run(self, seconds):
        for _ in range(round(seconds / DT)):
            k, self.now = self.now, self.now + 1
            theta, theta_dot = self.past[-1 - self.late]
            seen = theta + theta_dot * self.late * DT
            # θ is the horizontal part of the body's z axis: towards x it turns about +y, towards y about −x.
            self.e["quat"][0] = from_rotation_vector(np.array([-seen[1], seen[0], 0.0]))
            self.e["omega"], self.e["tick"] = [-theta_dot[1], theta_dot[0], 0.0], 1000 + k
            move(BALANCE, k * DT, 0.0, 0, self.e[0], self.told[0], self.kept[0], self.r[0])
            refer_balance(k * DT, self.claimed, self.e[0], self.told[0], self.kept[0], self.r[0])
            push = self.kept["balance"]["sway_a"][0]
            self.theta_dot = self.theta_dot + self.rate**2 * (self.theta - self.stands - push / 9.81) * DT
            self.theta = self.theta + self.theta_dot * DT
            self.past.append((self.theta, self.theta_dot))
        return np.abs(self.theta).max()


@pytest.mark.parametrize("late", [0, 20])
def test_leaning_uav_is_righted_and_the_pivot_brought_back(bench, late):
    pendulum = Pendulum(bench, [0.03, -0.02], late)
    assert pendulum.run(3.0) < 1e-3
    np.testing.assert_allclose(pendulum.kept["balance"]["sway"][0], 0.0, atol=5e-3)


def test_without_a_push_it_falls(bench):
    pendulum = Pendulum(bench, [0.03, -0.02], 0)
    bench.told["refer"]["balance"]["gains"] = 0.0
    assert pendulum.run(1.0) > 0.5


WIND = (0.05, -0.02)
"""Tilts at which a UAV stands in a wind of about 1 m/s with a biased attitude."""


@pytest.mark.parametrize("late", [0, 20])
def test_b6_finds_the_tilt_at_which_it_stands_and_the_pivot_comes_back(bench, late):
    pendulum = Pendulum(bench, [0.0, 0.0], late, stands=WIND)
    pendulum.run(5.0)
    np.testing.assert_allclose(pendulum.kept["balance"]["upright"][0], WIND, atol=1e-3)
    np.testing.assert_allclose(pendulum.kept["balance"]["sway"][0], 0.0, atol=5e-3)


def test_without_b6_the_pivot_runs_away_with_the_wind(bench):
    pendulum = Pendulum(bench, [0.0, 0.0], 0, stands=WIND)
    for _ in range(3000):
        pendulum.kept["balance"]["upright"] = 0.0
        pendulum.run(DT)
    assert np.abs(pendulum.theta).max() > 0.5


def test_lean_of_the_hover_spares_the_pivot_its_way(bench):
    def way(hovered):
        pendulum = Pendulum(bench, WIND, 10, stands=WIND, hovered=hovered)
        ways = []
        for _ in range(200):
            pendulum.run(0.01)
            ways.append(np.abs(pendulum.kept["balance"]["sway"]).max())
        return max(ways)

    assert way(9.81 * np.array(WIND)) < 1e-4
    assert way((0.0, 0.0)) > 0.01


def test_what_rotors_still_give_while_they_run_down_is_not_taken_for_wind(bench):
    pendulum = Pendulum(bench, [0.0, 0.0], 0, stands=WIND)
    pendulum.run(0.12)
    np.testing.assert_array_equal(pendulum.kept["balance"]["upright"][0], 0.0)
    pendulum.run(0.2)
    assert pendulum.kept["balance"]["upright"][0, 0] > 0.01


def test_delay_that_is_not_reckoned_with_is_worse(bench):
    """(B.5): what the pivot did since the attitude was taken belongs to the present tilt."""
    reckoned = Pendulum(bench, [0.03, -0.02], 45)
    known = max(reckoned.run(0.05) for _ in range(40))
    blind = Pendulum(bench, [0.03, -0.02], 45)
    blind.claimed = 0
    assert known < 0.1
    assert max(blind.run(0.05) for _ in range(40)) > 2.0 * known


def test_pivot_stays_within_its_reach_and_its_strength(bench):
    pendulum = Pendulum(bench, [0.12, 0.0], 0)
    b = bench.told["refer"]["balance"]
    for _ in range(300):
        pendulum.run(DT)
        assert abs(pendulum.kept["balance"]["sway_a"][0]).max() <= b["push_max"][0] + 1e-9
        assert abs(pendulum.kept["balance"]["sway"][0]).max() <= b["sway_max"][0] * 1.05


def test_reference_is_consistent_and_sinks_on_the_wrists_circle(bench):
    pendulum = Pendulum(bench, [0.05, 0.0], 0)
    heights, rows = [], []
    for _ in range(200):
        pendulum.run(DT)
        rows.append(np.concatenate([pendulum.r["r"][0], pendulum.r["v"][0]]))
        heights.append(pendulum.r["r"][0, 2])
    rows = np.array(rows)
    rate = (rows[2:, 0] - rows[:-2, 0]) / (2.0 * DT)
    np.testing.assert_allclose(rate, rows[1:-1, 3], atol=2e-2)
    lean, wrist = pendulum.kept["balance"]["lean"][0], bench.told["refer"]["balance"]["wrist"][0]
    assert 0.8 - heights[-1] == pytest.approx(0.5 * wrist * (lean @ lean), rel=1e-6)
    # The tool leans towards where the pivot goes, the wrist making most of a small displacement.
    sway, swing = pendulum.kept["balance"]["sway"][0, 0], bench.told["refer"]["balance"]["swing"][0]
    most = bench.told["refer"]["balance"]["lean_most"][0]
    assert lean[1] == pytest.approx(most * np.tanh(swing * sway / (wrist * most)))


def test_tool_leaves_the_hinge_room_for_what_the_uav_leans(bench):
    """Near the end of the pivot's reach, too, where it would lean by the hinge's whole range; its rates are those of its lean."""
    p, rows = bench.told["refer"]["balance"][0], run_steadily(bench, (0.4, 0.0), ticks=360)
    lean, rate, acceleration = rows[:, 10], rows[:, 13], rows[:, 16]
    assert p["swing"] * (rows[-1, 0] - 0.6) / p["wrist"] > p["lean_most"]
    assert 0.7 * p["lean_most"] < lean.max() < p["lean_most"] < np.deg2rad(load_scenario("landing").hinge.range_deg)
    np.testing.assert_allclose(np.gradient(lean, DT)[2:-2], rate[2:-2], atol=1e-2)
    # Until the end of its reach brakes it.
    np.testing.assert_allclose(np.gradient(rate, DT)[2:240], acceleration[2:240], atol=2e-2)


def test_near_the_rails_it_is_set_down_and_pressed_on(bench):
    down = bench.told["refer"]["balance"]["down"][0]
    pendulum = Pendulum(bench, [0.02, 0.0], 0, height=down + 0.02)
    assert pendulum.kept["balance"]["state"][0] == SETTLED
    pendulum.run(1.0)
    assert pendulum.r["r"][0, 2] < down
    assert pendulum.r["v"][0, 2] == pytest.approx(0.0, abs=1e-9)
    assert Pendulum(bench, [0.02, 0.0], 0, height=down + 0.1).kept["balance"]["state"][0] == BALANCED


def test_uav_that_cannot_be_balanced_is_given_up_and_the_arm_comes_to_rest(bench):
    pendulum = Pendulum(bench, [1.5 * bench.told["refer"]["balance"]["lost"][0], 0.0], 0)
    bench.kept["refer"]["balance"]["sway_v"] = 0.3
    pendulum.run(0.5)
    assert pendulum.kept["balance"]["state"][0] == GIVEN_UP
    assert np.abs(pendulum.kept["balance"]["sway_v"]).max() < 1e-3


def run_steadily(bench, speed, gains=None, tilt=0.0, ticks=41):
    """References (ticks, 9) and leans with their rates (ticks, 9) of a pivot that starts at `speed` (2,), m/s: with gains (4,), and a
    tilt that stays as it is."""
    told, kept, e, r = bench.told["refer"], bench.kept["refer"], bench.e, bench.tick.reference
    e["r"], e["v"], kept["v0"] = [0.6, 0.0, 0.9], [*speed, 0.0], 0.0
    kept["r0"], told["coast"] = e["r"], 1e9
    e["quat"][0] = from_rotation_vector(np.array([0.0, tilt, 0.0]))
    told["balance"]["gains"] = 0.0 if gains is None else gains
    begin_balance(e[0], np.zeros(2), told["balance"][0], kept["balance"][0])
    rows = []
    for k in range(ticks):
        e["tick"] = 1000 + k
        move(BALANCE, k * DT, 0.0, 0, e[0], told[0], kept[0], r[0])
        refer_balance(k * DT, 0, e[0], told[0], kept[0], r[0])
        leans = (kept["balance"][name][0] for name in ("lean", "lean_v", "lean_a"))
        rows.append(np.concatenate([r["r"][0], r["v"][0], r["a"][0], *leans]))
    return np.array(rows)


@pytest.mark.parametrize("tilt", [0.0, 0.04])
def test_pivot_moves_by_its_own_velocity_and_acceleration_on_the_wrists_circle(bench, tilt):
    """Steady, and pushed by 20 m/s² per unit of tilt: all three axes are rates of what comes before."""
    rows = run_steadily(bench, (0.3, -0.2), (0.0, 0.0, 20.0, 0.0), tilt)
    np.testing.assert_allclose((rows[2:, :3] - rows[:-2, :3]) / (2.0 * DT), rows[1:-1, 3:6], atol=2e-5)
    # The acceleration of a row is that of the tick which ends there.
    middle = 0.5 * (rows[1:-1, 6:9] + rows[2:, 6:9])
    np.testing.assert_allclose((rows[2:, 3:6] - rows[:-2, 3:6]) / (2.0 * DT), middle, atol=5e-3)
    assert rows[-1, 6] == pytest.approx(20.0 * np.sin(tilt), rel=1e-6)
    assert rows[-1, 2] < 0.9
    assert rows[-1, 8] < -0.05


def test_balancing_begins_at_the_pivots_own_speed_and_upright(bench):
    bench.kept["refer"]["balance"]["lean"] = bench.kept["refer"]["balance"]["sway"] = 0.5
    rows = run_steadily(bench, (0.2, -0.1), ticks=1)
    np.testing.assert_allclose(rows[0, 3:5], [0.2, -0.1], atol=1e-9)
    np.testing.assert_allclose(rows[0, :2], [0.6 + 0.2 * DT, -0.1 * DT], atol=1e-9)
    # What the pivot did before is not taken for a push since.
    np.testing.assert_array_equal(bench.kept["refer"]["balance"]["sway_log"][0, :, 0], 0.2)
    np.testing.assert_array_equal(bench.kept["refer"]["balance"]["sway_log"][0, :, 1], -0.1)


@pytest.mark.parametrize("axis", [0, 1])
def test_tool_leans_towards_where_the_pivot_goes(bench, axis):
    """Of a small displacement the wrist makes its share: the tool's tip is at wrist × lean across its foot."""
    speed = np.zeros(2)
    speed[axis] = 0.05
    rows = run_steadily(bench, speed)
    b, p = bench.kept["refer"]["balance"], bench.told["refer"]["balance"][0]
    up = from_rotation_vector(b["lean"][0].copy())
    tip = p["wrist"] * matrix(up)[:2, 2]
    np.testing.assert_allclose(tip, p["swing"] * (rows[-1, :2] - [0.6, 0.0]), rtol=1e-3, atol=1e-9)
    turned = np.cross(b["lean_v"][0], [0.0, 0.0, p["wrist"]])
    np.testing.assert_allclose(turned[:2], p["swing"] * rows[-1, 3:5], rtol=1e-3, atol=1e-12)


@pytest.mark.parametrize(("age", "balanced"), [(50, True), (51, False)])
def test_attitude_that_is_too_old_brings_the_pivot_to_rest(bench, age, balanced):
    told, kept = bench.told["refer"], bench.kept["refer"]
    assert told["balance"]["attitude_age"][0] == 50
    bench.e["quat"][0] = from_rotation_vector(np.array([0.0, 0.03, 0.0]))
    bench.e["v"], bench.e["r"] = [0.1, 0.0, 0.0], [0.6, 0.0, 0.9]
    begin_balance(bench.e[0], np.zeros(2), told["balance"][0], kept["balance"][0])
    refer_balance(0.0, age, bench.e[0], told[0], kept[0], bench.tick.reference[0])
    slowing = -0.1 / told["coast"][0]
    assert (kept["balance"]["sway_a"][0, 0] == pytest.approx(slowing)) != balanced
    # At rest nothing is to be brought to rest.
    assert (kept["balance"]["sway_a"][0, 1] == 0.0) or balanced


@pytest.mark.parametrize(("rise", "height"), [(0.0, 0.02), (0.1, 0.02), (0.0, -0.02)])
def test_setting_down_is_smooth_and_ends_below_the_rails_with_its_mean_speed(bench, rise, height):
    """From a pivot that still rises: what it coasts on is part of the way. Down at 0.04 m/s on average."""
    down, told = bench.told["refer"]["balance"]["down"][0], bench.told["refer"]
    pendulum = Pendulum(bench, [0.0, 0.0], 0, height=down + height)
    pendulum.kept["v0"][0, 2] = rise
    way = abs(height + 0.0005 + rise * told["coast"][0])
    rows = []
    for k in range(round(1000 * way / 0.04) + 300):
        move(BALANCE, k * DT, 0.0, 0, bench.e[0], told[0], pendulum.kept[0], pendulum.r[0])
        refer_balance(k * DT, 0, bench.e[0], told[0], pendulum.kept[0], pendulum.r[0])
        rows.append([pendulum.r["r"][0, 2], pendulum.r["v"][0, 2]])
    rows = np.array(rows)
    np.testing.assert_allclose((rows[2:, 0] - rows[:-2, 0]) / (2.0 * DT), rows[1:-1, 1], atol=1e-3)
    assert rows[0, 0] == pytest.approx(down + height)
    assert rows[-1, 0] == pytest.approx(down - 0.0005, abs=1e-5)
    # Half of its time after the begin it is half-way.
    half = round(500 * way / 0.04)
    coasted = rise * told["coast"][0] * (1.0 - np.exp(-half * DT / told["coast"][0]))
    assert rows[half, 0] == pytest.approx(
        down + height + coasted + 0.5 * (-height - 0.0005 - rise * told["coast"][0]), abs=1e-4
    )
