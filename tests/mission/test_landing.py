"""Parts of the landing's controller: references without jumps, thrust ramp tied to the hinge, refusals before anything moves."""

import numpy as np
import pytest

from armland.errors import ConfigurationError, WorkspaceError
from armland.mission.landing_arm import BACK_OFF, CLOSE, HOLD, JOIN, MOVE, TRACK, refer, septic, track
from armland.mission.landing_estimate import quaternion_of
from armland.mission.landing_scenario import landing_scenario
from armland.mission.landing_setup import set_up
from armland.mission.landing_state import memory_layout, parameters_layout
from armland.mission.landing_uav import HELD, RAMP, command_uav, thrust_in_force
from armland.mission.records import UavMode, landing_layout
from armland.rotations import from_rotation_vector, matrix

LEVEL = np.array([1.0, 0.0, 0.0, 0.0])


def records():
    p, s = np.zeros(1, parameters_layout(7, 3)), np.zeros(1, memory_layout(7))
    p["tick_s"], p["coast"], p["standoff"], p["beyond"], p["depth"] = 1e-3, 0.06, 0.03, 0.006, 0.06
    p["targets"] = [0.7, 0.1, 0.8]
    s["r0"], s["v0"] = [0.6, 0.0, 0.7], [0.05, -0.02, 0.1]
    s["p"], s["pv"] = [0.62, 0.01, 0.86], [0.02, 0.01, -0.01]
    return p, s


def test_septic_is_its_own_derivative_and_ends_at_rest():
    u, h, duration = np.linspace(0.02, 0.98, 9), 1e-5, 2.5
    for x in u:
        ahead, behind = septic(x + h / duration, duration), septic(x - h / duration, duration)
        _, speed, acceleration = septic(x, duration)
        assert (ahead[0] - behind[0]) / (2.0 * h) == pytest.approx(speed, abs=1e-7)
        assert (ahead[1] - behind[1]) / (2.0 * h) == pytest.approx(acceleration, abs=1e-6)
    assert septic(0.0, duration) == (0.0, 0.0, 0.0)
    assert septic(1.0, duration) == (1.0, 0.0, 0.0)


@pytest.mark.parametrize("mode", [HOLD, JOIN, TRACK, CLOSE, MOVE, BACK_OFF])
def test_reference_velocity_is_the_rate_of_its_position(mode):
    p, s = records()
    e, r = np.zeros(1, landing_layout("estimate", 7)), np.zeros((2, 1), landing_layout("reference", 7))
    h = 1e-6
    for t in (0.1, 0.7, 1.3):
        for k, shift in enumerate((-h, h)):
            # The plate moves on at its own speed.
            moved = s.copy()
            moved["p"] += shift * s["pv"]
            refer(mode, t + shift, 1.5, 1, e[0], p[0], moved[0], r[k][0])
        rate = (r[1]["r"] - r[0]["r"]) / (2.0 * h)
        np.testing.assert_allclose(rate, r[0]["v"], atol=1e-5)


@pytest.mark.parametrize("mode", [HOLD, MOVE, BACK_OFF])
def test_reference_begins_where_the_last_one_was(mode):
    p, s = records()
    e, r = np.zeros(1, landing_layout("estimate", 7)), np.zeros(1, landing_layout("reference", 7))
    refer(mode, 0.0, 1.5, 1, e[0], p[0], s[0], r[0])
    np.testing.assert_allclose(r["r"], s["r0"])
    np.testing.assert_allclose(r["v"], s["v0"])


def test_move_ends_at_its_target():
    p, s = records()
    e, r = np.zeros(1, landing_layout("estimate", 7)), np.zeros(1, landing_layout("reference", 7))
    assert refer(MOVE, 1.5, 1.5, 1, e[0], p[0], s[0], r[0]) == 1.0
    np.testing.assert_allclose(r["r"][0], [0.7, 0.1, 0.8], atol=1e-9)


def test_closing_ends_beyond_the_face():
    p, s = records()
    e, r = np.zeros(1, landing_layout("estimate", 7)), np.zeros(1, landing_layout("reference", 7))
    refer(CLOSE, 0.0, 1.0, 1, e[0], p[0], s[0], r[0])
    assert r["r"][0, 2] == pytest.approx(0.83)
    refer(CLOSE, 1.0, 1.0, 1, e[0], p[0], s[0], r[0])
    assert r["r"][0, 2] == pytest.approx(0.866)


class Hover:
    """The UAV's part on its own, at the weight of 5 N."""

    def __init__(self):
        self.p, self.s = records()
        self.e, self.c = np.zeros(1, landing_layout("estimate", 7)), np.zeros(1, landing_layout("command", 7))
        self.p["weight"], self.p["thrust_rate"], self.p["force_slack"], self.p["uplink"] = 5.0, 3.0, 1.5, 25
        self.p["rotor_gain"], self.p["thrust_min"], self.p["thrust_max"] = 0.02, 0.5, 7.0
        self.s["hover"] = self.s["thrust"] = self.s["acting"] = self.s["thrust_log"] = 5.0
        self.tick = 0

    def run(self, ticks, carries, share=0.5):
        """Ramp for some ticks while the arm `carries` a share of what the rotors leave; returns the thrust commanded."""
        for _ in range(ticks):
            self.e["thrust"] = thrust_in_force(self.tick, self.p[0], self.s[0])
            self.e["hinge_force"][0, 2] = carries * (5.0 - self.e["thrust"][0])
            command_uav(self.tick, RAMP, share, HELD, LEVEL, self.e[0], self.p[0], self.s[0], self.c[0])
            self.tick += 1
        return float(self.c["thrust"][0])


def test_thrust_ramps_down_where_the_arm_takes_over():
    hover = Hover()
    assert hover.run(1500, carries=1.0) == pytest.approx(2.5, abs=1e-6)
    assert hover.c["uav_mode"][0] == UavMode.HELD


def test_thrust_waits_where_nobody_takes_over():
    assert Hover().run(3000, carries=0.0) > 5.0 - 1.6


def test_rotors_stop_at_the_end_of_the_last_ramp():
    hover = Hover()
    assert hover.run(4000, carries=1.0, share=0.0) == 0.0
    assert hover.c["uav_mode"][0] == UavMode.OFF


def test_thrust_that_acts_is_late_by_link_and_rotors():
    hover = Hover()
    hover.run(26, carries=1.0)
    assert hover.s["acting"][0] == pytest.approx(5.0, abs=1e-3)
    hover.run(400, carries=1.0)
    lag = 25e-3 + 1e-3 / 0.02
    assert hover.s["acting"][0] == pytest.approx(hover.c["thrust"][0] + 3.0 * lag, abs=0.02)


@pytest.mark.parametrize("turn", [[0.1, -0.2, 0.3], [3.0, 0.2, 0.0], [0.0, 3.1, 0.1], [0.0, 0.1, 3.1]])
def test_quaternion_of_a_rotation(turn):
    R = matrix(from_rotation_vector(np.array(turn)))
    np.testing.assert_allclose(matrix(quaternion_of(R)), R, atol=1e-12)


@pytest.mark.parametrize(
    ("overrides", "refusal", "words"),
    [
        ({"place": {"catch_m": [1.2, 0.0, 0.86]}}, WorkspaceError, "out of reach by"),
        ({"extra_mass_kg": 0.3}, ConfigurationError, r"the UAV weighs 8\.\d+ N; its rotors give 7\.44 N"),
        ({"magnet_rating_n": 8.0}, ConfigurationError, r"the magnet may be loaded with 4\.8 N"),
        ({"bounds": {"lost_offset_m": 0.003}}, ConfigurationError, "lost_offset_m = 0.003 must exceed"),
        ({"bounds": {"share_carried": 0.6}}, ConfigurationError, "share_carried = 0.6 must be below"),
        ({"bounds": {"pull_seen_n": 1.0}}, ConfigurationError, "pull_seen_n = 1 must be below"),
        ({"place": {"home_deg": [0.0, 1.0]}}, ConfigurationError, "home_deg has 2 values; the arm has 7 joints"),
        ({"wings": 2}, ConfigurationError, "wings"),
        ({"bounds": {"align_offset_m": 0.0075, "lost_offset_m": 0.01}}, ConfigurationError, "it must be below 0.007 m"),
        ({"bounds": {"align_speed_mps": 0.5}}, ConfigurationError, "carries the plate off the magnet"),
        ({"bounds": {"align_tilt_deg": 30.0}}, ConfigurationError, "must be below envelope.tilt_deg = 30"),
    ],
)
def test_refusals_before_anything_moves(overrides, refusal, words):
    with pytest.raises(refusal, match=words):
        set_up(landing_scenario("landing", overrides))


def test_unknown_scenario_is_refused():
    with pytest.raises(ConfigurationError, match="does not exist"):
        landing_scenario("nowhere")


@pytest.mark.parametrize(("valid", "way"), [(1, 0.3), (0, 0.0)])
def test_plate_is_followed_only_while_somebody_vouches_for_it(valid, way):
    p, s = records()
    p["track"], p["track_a"] = 12.0, 3.0
    e = np.zeros(1, landing_layout("estimate", 7))
    e["plate"], e["plate_valid"] = s["p"], valid
    e["plate"][0, 0] += 0.3
    start = s["p"].copy()
    for _ in range(3000):
        track(e[0], p[0], s[0], False)
    # Without one it comes to rest: v / (2 track) further.
    rest = way if valid else 0.02 / 24.0
    assert s["p"][0, 0] - start[0, 0] == pytest.approx(rest, abs=1e-3)
    assert np.abs(s["pv"]).max() < 1e-3
