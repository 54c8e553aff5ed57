"""Each failure sets the fields that it says and no others, while it acts; and what the devices make of them, from begin to end."""

import numpy as np
import pytest

BEGIN, END = 100, 200
"""Ticks from and before which the faults below act; a sensor, sampled before, shows it one tick later."""

WINDOW = {"after_s": 0.1, "lasts_s": 0.0995}


def one_hot(i, n=7, value=1.0):
    out = np.zeros(n)
    out[i] = value
    return out


SET = {
    "link_delay": ({"size": 400.0}, {"late": lambda t: round(400.0 * t)}),
    "camera_noise": ({"size": 3.0}, {"camera.noise": 3.0}),
    "camera_outliers": ({"size": 0.02}, {"camera.outlier": 0.02}),
    "camera_flip": ({}, {"camera.flipped": 1}),
    "wrong_marker": ({"size": 0.5, "direction": [0.0, 1.0, 0.0]}, {"camera.marker": [0.0, 0.5, 0.0]}),
    "wrench_dead": ({}, {"bridge": 0.0}),
    "wrench_reversed": ({}, {"bridge": -1.0}),
    "wrench_gain": ({"size": 1.5}, {"bridge": 1.5}),
    "magnet_stuck": ({"size": 0.2}, {"residual": 0.2}),
    "thrust_loss": ({"size": 0.3}, {"rotor": [0.7] * 8}),
    "power_loss": ({}, {"rotor": [0.0] * 8, "unpowered": 1}),
    "encoder_offset": ({"joint": 3, "size": 0.1}, {"encoder_off": one_hot(2, value=0.1)}),
    "encoder_drift": (
        {"joint": 3, "size": 0.1},
        {"encoder_off": lambda t: one_hot(2, value=0.1 * t), "encoder_creep": one_hot(2, value=0.1)},
    ),
    "encoder_frozen": ({"joint": 3}, {"encoder_stuck": one_hot(2)}),
    "gust": (
        {"size": 4.0, "direction": [0.6, 0.8, 0.0]},
        {"wind": lambda t: 2.0 * (1.0 - np.cos(2.0 * np.pi * t / 0.0995)) * np.array([0.6, 0.8, 0.0])},
    ),
}
"""Kind -> its keys, and the fields that it sets, as values or as functions of the time since it began."""


def fields(record, prefix=""):
    for name in record.dtype.names:
        if record.dtype[name].names:
            yield from fields(record[name], f"{name}.")
        else:
            yield prefix + name, record[name].copy()


def failing(b):
    return {n: v for n, v in fields(b.kept["faults"][0]) if n not in ("armed", "acting", "acted", "turned")}


@pytest.mark.parametrize("kind", SET)
def test_kind_sets_its_fields_while_it_acts_and_no_others(bench_in_air, kind):
    keys, expected = SET[kind]
    b = bench_in_air(faults=[{"kind": kind, **WINDOW, **keys}])
    well = failing(b)
    for k in range(END + 20):
        b.act(k)
        if k % 10:
            continue
        now, acts = failing(b), BEGIN <= k < END
        for name, value in now.items():
            if acts and name in expected:
                wanted = expected[name]((k - BEGIN) / 1000) if callable(expected[name]) else expected[name]
            else:
                wanted = well[name]
            np.testing.assert_allclose(value, wanted, rtol=1e-9, atol=1e-12, err_msg=f"{name} at {k}")


def test_faults_of_one_device_add_up(bench_in_air):
    faults = [{"kind": "rotor_loss", "size": 0.5}, {"kind": "thrust_loss", "size": 0.2}]
    faults += [{"kind": "wrench_gain", "size": 2.0}, {"kind": "wrench_reversed"}]
    faults += [{"kind": "encoder_offset", "size": 0.1, "joint": 2}, {"kind": "encoder_offset", "size": 0.2, "joint": 2}]
    b = bench_in_air(faults=faults)
    b.act(0)
    now = failing(b)
    np.testing.assert_allclose(now["rotor"], [0.4] + [0.8] * 7)
    assert now["bridge"] == -2.0
    assert now["encoder_off"][1] == pytest.approx(0.3)


def both(hinged, sway, ticks, *faults):
    """Ticks of the swaying arm with and without the faults, and the fields of the measurement that ever differ."""
    with_it, without = (hinged(sway, faults=list(f)).step(ticks) for f in (faults, ()))
    m, w = with_it["measurement"], without["measurement"]
    return m, w, {n for n in m.dtype.names if not np.array_equal(m[n], w[n], equal_nan=True)}


def test_frozen_encoder_keeps_its_position_reads_no_speed_and_leaves_the_other_joints(hinged, sway):
    m, w, changed = both(hinged, sway, 300, {"kind": "encoder_frozen", "joint": 3, **WINDOW})
    assert changed == {"q", "qd"}
    shown = slice(BEGIN + 1, END + 1)
    assert (m["q"][shown, 2] == w["q"][BEGIN, 2]).all()
    assert (m["qd"][shown, 2] == 0.0).all()
    assert np.ptp(w["q"][shown, 2]) > 1e-3
    m["q"][shown, 2], m["qd"][shown, 2] = w["q"][shown, 2], w["qd"][shown, 2]
    np.testing.assert_array_equal(m["q"], w["q"])
    np.testing.assert_array_equal(m["qd"], w["qd"])


def test_encoder_drifts_in_position_and_speed_alike(hinged, sway):
    m, w, changed = both(hinged, sway, 300, {"kind": "encoder_drift", "joint": 3, "size": 0.5, **WINDOW})
    assert changed == {"q", "qd"}
    off = np.zeros(300)
    off[BEGIN + 1 : END + 1] = 0.5e-3 * np.arange(END - BEGIN)
    np.testing.assert_allclose(m["q"] - w["q"], np.outer(off, one_hot(2)), atol=1e-12)
    # The speed is that of the reading.
    inside = slice(BEGIN + 2, END)
    np.testing.assert_allclose((m["qd"] - w["qd"])[inside, 2], np.diff(off)[BEGIN + 1 : END - 1] / 1e-3, atol=1e-9)


def test_offset_of_an_arm_that_sends_nothing_does_not_pile_up(hinged, sway):
    m, _, _ = both(hinged, sway, 150, {"kind": "encoder_offset", "size": 0.1}, {"kind": "arm_stale", "after_s": 0.1})
    assert (m["q"][BEGIN + 2 :] == m["q"][BEGIN]).all()


LOAD, BIAS = np.array([1.0, -2.0, 30.0, 0.1, 0.2, -0.3]), np.array([0.5, 0.0, -0.5, 0.01, 0.02, 0.03])


@pytest.mark.parametrize(
    ("kind", "size", "factor"), [("wrench_dead", 1.0, 0.0), ("wrench_reversed", 1.0, -1.0), ("wrench_gain", 1.5, 1.5)]
)
def test_bridge_scales_the_load_and_not_the_bias_and_the_stamps_go_on(bench, kind, size, factor):
    b = bench(faults=[{"kind": kind, "size": size, **WINDOW}])
    b.told["wrench"]["bias"] = BIAS
    at = int(b.told["wrench"]["at_force"][0]), int(b.told["wrench"]["at_torque"][0])
    b.data[at[0] : at[0] + 3], b.data[at[1] : at[1] + 3] = LOAD[:3], LOAD[3:]
    for k in range(END + 20):
        m = b.read(k)
        acted = factor if BEGIN < k <= END else 1.0
        np.testing.assert_allclose(m["wrench"][0], acted * LOAD + BIAS, atol=1e-9, err_msg=str(k))
        assert m["wrench_tick"] == k
        b.act(k)


GROWING = {"kind": "link_delay", "size": 100.0, "after_s": 0.1, "lasts_s": 0.4995}


def grown(k):
    """A tenth of a tick per tick from tick 100 to tick 600."""
    return 0.1 * (k - 100) if 100 <= k < 600 else 0.0


def test_delay_downwards_grows_and_ends(bench):
    b = bench(link={"downlink_delay_ms": 12.0}, faults=[GROWING])
    for k in range(800):
        b.put("gyro", [float(k)] * 3)
        m = b.read(k)
        if k >= 12:
            assert m["uav_rate"][0, 0] == m["uav_tick"]
            assert abs(k - 12 - grown(k - 1) - m["uav_tick"]) <= (0.51 if 100 < k <= 600 else 0.0)
        b.act(k)


def test_delay_upwards_grows_and_ends(bench):
    """The thrust of tick k is 2 N + k mN."""
    b = bench(link={"uplink_delay_ms": 25.0}, faults=[GROWING])
    for k in range(800):
        lift = b.act(k, thrust=2.0 + 1e-3 * k)[2]
        if k >= 25:
            assert lift == pytest.approx(2.0 + 1e-3 * (k - 25 - grown(k)), abs=0.51e-3 if 100 <= k < 600 else 1e-9)


def test_delay_ends_at_what_the_lines_hold(bench):
    b = bench(faults=[{"kind": "link_delay", "size": 900.0}])
    for k in range(3000):
        m = b.read(k)
        lift = b.act(k, thrust=2.0 + 1e-3 * k)[2]
    assert m["uav_tick"] == 2999 - 1023
    assert lift == pytest.approx(2.0 + 1e-3 * (2999 - 1023), abs=1e-9)


def test_lost_thrust_is_lost_on_all_rotors_alike(bench):
    b = bench(faults=[{"kind": "thrust_loss", "size": 0.3, **WINDOW}])
    rest = b.sim.scenario.control.thrust_n
    for k in range(END + 20):
        share = 0.7 if BEGIN <= k < END else 1.0
        np.testing.assert_allclose(b.act(k), [0.0, 0.0, share * rest, 0.0, 0.0, 0.0], atol=1e-9, err_msg=str(k))


def test_power_that_is_lost_stops_the_rotors_with_their_lag(bench):
    b = bench(rotors={"time_constant_s": 0.05}, faults=[{"kind": "power_loss", **WINDOW}])
    rest = b.sim.scenario.control.thrust_n
    lift = np.array([b.act(k)[2] for k in range(END + 600)])
    np.testing.assert_allclose(lift[BEGIN:END], rest * np.exp(-1e-3 * np.arange(1, END - BEGIN + 1) / 0.05), rtol=1e-9)
    assert lift[END + 300] > lift[END - 1]
    assert lift[-1] == pytest.approx(rest, rel=1e-3)


def test_uav_without_power_neither_sends_nor_hears_and_does_so_again_with_it(bench):
    """What was under way downwards still arrives; what was under way upwards finds nobody."""
    link = {"uplink_delay_ms": 25.0, "downlink_delay_ms": 12.0}
    b = bench(link=link, faults=[{"kind": "power_loss", **WINDOW}])
    for k in range(END + 50):
        m = b.read(k)
        if BEGIN + 12 <= k <= END + 12:
            assert m["uav_tick"] == BEGIN
        elif k >= 12:
            assert m["uav_tick"] == k - 12
        b.act(k)
        heard = b.kept["link"]["heard"][0]
        assert heard == (BEGIN - 1 if BEGIN <= k < END else k) or k < 25
    # The rest of the plant goes on.
    assert m["arm_tick"] == m["wrench_tick"] == k
