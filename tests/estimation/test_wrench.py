"""Bias and tool removal against MuJoCo's force and torque sensors and against statistics."""

import mujoco
import numpy as np
import pytest
from numba import njit
from scipy.signal import lfilter
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from armland.estimation.wrench import compensate, kept_layout, told
from armland.scenario import load_scenario

H, MASS, COM, TIP = 1e-3, 0.30, (0.01, -0.02, 0.025), 0.056
RATE, SIGMA, BLOCK_S = (0.5, 0.02), (0.05, 0.002), 0.2


def settings(rate=RATE, block_s=BLOCK_S, filter_gain=1.0):
    """What the filter is told: a sensor whose low pass makes `filter_gain` of a step in one tick."""
    wanted = {"rate_nps": rate[0], "rate_nmps": rate[1], "block_s": block_s}
    sensors = {"force_n": SIGMA[0], "torque_nm": SIGMA[1]}
    if filter_gain < 1.0:
        sensors["force_filter_hz"] = -np.log(1.0 - filter_gain) / (2.0 * np.pi * H)
    p = told(
        load_scenario("landing", {"estimation": {"wrench": wanted}, "sensors": sensors, "tool": {"tool_mass_kg": MASS}})
    )
    p["com"] = COM
    if filter_gain == 1.0:
        p["sigma"], p["correlation"] = np.repeat(SIGMA, 3), 1.0
    return p


UPRIGHT = np.eye(3)
SCENE = f"""
<mujoco>
  <option gravity="0 0 -9.81"/>
  <worldbody>
    <body name="flange">
      <joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 1 0"/><joint type="slide" axis="0 0 1"/>
      <joint type="ball"/>
      <inertial pos="0 0 0" mass="2" diaginertia="0.01 0.01 0.01"/>
      <body name="tool">
        <inertial pos="{COM[0]} {COM[1]} {COM[2]}" mass="{MASS}" diaginertia="2e-4 2e-4 1e-4"/>
        <site name="sensor"/>
        <site name="tip" pos="0 0 {TIP}"/>
      </body>
    </body>
  </worldbody>
  <sensor><force site="sensor"/><torque site="sensor"/></sensor>
</mujoco>
"""


@pytest.fixture(scope="module")
def model():
    return mujoco.MjModel.from_xml_string(SCENE)


def reading(model, R, acceleration=(0.0, 0.0, 0.0), on_tip=(0.0, 0.0, 0.0)):
    """What the sensor reads (6,), with a force `on_tip` (3,) N, world, that somebody puts on the tool's tip."""
    data = mujoco.MjData(model)
    data.qpos[3:] = R.as_quat(scalar_first=True)
    # Whatever force it takes to move the flange like that.
    data.qacc[:3] = acceleration
    mujoco.mj_inverse(model, data)
    pushed, force = np.zeros(model.nv), np.array(on_tip, float)
    mujoco.mj_applyFT(model, data, force, np.zeros(3), data.site("tip").xpos, model.body("tool").id, pushed)
    data.qfrc_applied[:] = data.qfrc_inverse - pushed
    tool = model.body("tool").id
    data.xfrc_applied[tool] = [*force, *np.cross(data.site("tip").xpos - data.xipos[tool], force)]
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.qacc[:3], acceleration, atol=1e-9)
    return data.sensordata.copy()


def orientations(count, seed=0):
    return Rotation.random(count, rng=np.random.default_rng(seed))


def external_of(measured, R=UPRIGHT, acceleration=(0.0, 0.0, 0.0), gravity=(0.0, 0.0, -9.81)):
    external, sigma, lifted = np.zeros(6), np.zeros(6), np.subtract(acceleration, gravity)
    compensate(
        measured, np.ascontiguousarray(R), lifted, False, settings()[0], np.zeros(1, kept_layout())[0], external, sigma
    )
    return external


def test_free_tool_reads_nothing_in_any_orientation_and_acceleration(model):
    rng = np.random.default_rng(1)
    for R in orientations(20):
        acceleration = 2.0 * rng.normal(size=3)
        measured = reading(model, R, acceleration)
        np.testing.assert_allclose(external_of(measured, R.as_matrix(), acceleration), 0.0, atol=1e-9)
        # Controls: what each term is worth.
        still = external_of(measured, R.as_matrix())
        assert np.linalg.norm(still[:3]) == pytest.approx(MASS * np.linalg.norm(acceleration))
        turned = external_of(measured, UPRIGHT, acceleration)
        assert np.linalg.norm(turned[:3]) > 0.1


def test_force_on_the_uav_comes_out_and_has_no_torque_about_the_tip(model):
    rng = np.random.default_rng(2)
    for R in orientations(20):
        on_uav, acceleration = 5.0 * rng.normal(size=3), rng.normal(size=3)
        measured = reading(model, R, acceleration, on_tip=-on_uav)
        external = external_of(measured, R.as_matrix(), acceleration)
        np.testing.assert_allclose(R.apply(external[:3]), on_uav, atol=1e-9)
        np.testing.assert_allclose(external[3:], np.cross([0.0, 0.0, TIP], external[:3]), atol=1e-9)
        assert np.linalg.norm(external[3:]) > 1e-3


@njit
def stream(measured, free, p, s):
    """Outputs, claimed deviations and biases (ticks, 6) each, upright and at rest."""
    ticks = len(measured)
    out, sigma, bias = np.empty((ticks, 6)), np.empty((ticks, 6)), np.empty((ticks, 6))
    R, lifted = np.eye(3), np.array([0.0, 0.0, 9.81])
    for k in range(ticks):
        compensate(measured[k], R, lifted, free[k], p[0], s[0], out[k], sigma[k])
        bias[k] = s[0].bias
    return out, sigma, bias


WEIGHT = np.array([0.0, 0.0, MASS * 9.81, *np.cross(COM, [0.0, 0.0, MASS * 9.81])])


def played(
    seconds,
    bias=(1.0, -0.5, 2.0, 0.02, -0.03, 0.01),
    load=0.0,
    free=True,
    p=None,
    noise=1.0,
    seed=4,
    drift=0.0,
    memory=None,
):
    """`load` and `bias`: (6,) or (ticks, 6); `free`: bool or (ticks,)."""
    ticks = round(seconds / H)
    rng, p = np.random.default_rng(seed), settings() if p is None else p
    share = 1.0 / p["correlation"][0]
    g = 2.0 * share / (1.0 + share)
    white = lfilter([g], [1.0, g - 1.0], rng.normal(size=(ticks, 6)) * np.repeat(SIGMA, 3), axis=0)
    walk = drift * np.cumsum(rng.normal(size=(ticks, 6)) * np.sqrt(p["drift"][0] ** 2 * H), axis=0)
    true_bias = np.broadcast_to(bias, (ticks, 6)) + walk
    measured = WEIGHT + true_bias + load + noise * white
    s = np.zeros(1, kept_layout()) if memory is None else memory
    out, sigma, found = stream(measured, np.broadcast_to(free, ticks).copy(), p, s)
    return out, sigma, found, measured, true_bias


def test_bias_is_learnt_while_free():
    out, sigma, found, _, bias = played(20.0)
    np.testing.assert_allclose(found[-1, :3], bias[-1, :3], atol=0.006)
    np.testing.assert_allclose(found[-1, 3:], bias[-1, 3:], atol=3e-4)
    # 2 N at 0.5 N/s.
    assert np.abs(found[3900, 2] - 2.0) > 0.02 > np.abs(found[4700, 2] - 2.0)
    assert (np.abs(out[10_000:].mean(axis=0)) < 0.3 * sigma[-1]).all()
    untold = played(20.0, free=False)[0]
    np.testing.assert_allclose(untold.mean(axis=0), bias[0], atol=0.01)


@pytest.mark.parametrize("rate", [RATE, (1e6, 1e6)])
def test_output_never_jumps_because_of_the_bias(rate):
    """Bias steps, loads and a flickering `free`: the correction moves at most at its rate."""
    rng, ticks = np.random.default_rng(5), 30_000
    bias, load = np.zeros((ticks, 6)), np.zeros((ticks, 6))
    bias[8000:], load[15_000:20_000] = [0.8, -1.0, 0.5, 0.05, 0.0, 0.02], [0.0, 0.0, 1.5, 0.0, 0.1, 0.0]
    free = np.repeat(rng.random(ticks // 250) < 0.8, 250)
    free[15_000:20_000] = False
    out, _, _, measured, _ = played(30.0, bias=bias, load=load, free=free, p=settings(rate=rate))
    correction = measured - WEIGHT - out
    jump = np.abs(np.diff(correction, axis=0)).max(axis=0)
    smooth = (jump <= np.repeat(RATE, 3) * H * (1.0 + 1e-6)).all()
    assert smooth == (rate == RATE)
    assert np.abs(correction).max() > 0.3


@pytest.mark.parametrize("told", [True, False])
def test_load_is_not_learnt_away(told):
    ticks = 40_000
    load = np.zeros((ticks, 6))
    load[10_000:, 2] = 2.0
    free = np.ones(ticks, bool)
    free[10_000:] = not told
    out, _, found, _, _ = played(40.0, bias=np.zeros(6), load=load, free=free)
    if told:
        assert np.ptp(found[10_000:], axis=0).max() == 0.0
        assert out[10_000:, 2].mean() == pytest.approx(2.0, abs=0.02)
    else:
        assert out[-1000:, 2].mean() < 0.3


@pytest.mark.parametrize("block_s", [BLOCK_S, 0.02])
def test_contact_noticed_within_a_block_teaches_nothing(block_s):
    """The contact is noticed 150 ms late: more than a short block, less than the one that is set."""
    ticks = 12_000
    load, free = np.zeros((ticks, 6)), np.ones(ticks, bool)
    load[10_000:, 2] = 2.5
    free[10_150:] = False
    touched = played(12.0, np.zeros(6), load, free, settings(block_s=block_s), noise=0.0)[2]
    assert (np.abs(touched[-1]).max() == 0.0) == (block_s == BLOCK_S)


def test_implausible_reading_teaches_nothing_and_is_reported():
    load = np.zeros(6)
    load[0] = 4.0
    s = np.zeros(1, kept_layout())
    _, _, found, _, _ = played(3.0, bias=np.zeros(6), load=load, memory=s)
    assert np.abs(found).max() == 0.0
    assert s["implausible"][0] == 1
    s = np.zeros(1, kept_layout())
    assert np.abs(played(3.0, bias=np.zeros(6), load=0.5 * load, memory=s)[2]).max() > 0.5
    assert s["implausible"][0] == 0
    assert not np.abs(played(1.0, bias=np.full(6, np.nan))[2]).max() > 0.0


@pytest.mark.parametrize(("real_drift", "consistent"), [(1.0, True), (4.0, False)])
def test_noise_of_the_output_is_what_is_claimed(real_drift, consistent):
    """Learnt for 12 s, then loaded for 30 s; the sensor's 100 Hz filter colours the noise. Control: a bias that drifts faster."""
    p = settings(filter_gain=1.0 - np.exp(-2.0 * np.pi * 0.1))
    free = np.arange(42_000) < 12_000
    early, late = [], []
    for seed in range(12):
        out, sigma, _, _, _ = played(42.0, np.zeros(6), 0.0, free, p, seed=seed, drift=real_drift)
        early.append(out[11_999] / sigma[11_999])
        late.append(out[-1] / sigma[-1])
    # The drift between a block's middle and now is not in the claim: it is what `early` may be off by.
    assert chi2(72).cdf(np.sum(np.square(early))) < 0.9999 or not consistent
    level = chi2(72).cdf(np.sum(np.square(late)))
    assert (0.0005 < level < 0.9995) == consistent


def test_variance_of_the_bias_is_that_of_the_blocks_and_grows_with_the_drift():
    """First block: σ²/N alone. While nothing is learnt it grows by drift² a second; each block then weighs in by its gain."""
    p, s = settings(), np.zeros(1, kept_layout())
    block, drift = SIGMA[0] ** 2 / (BLOCK_S / H), p["drift"][0, 0] ** 2
    # Two blocks: the second releases the first; drift counts from then on only.
    played(2 * BLOCK_S, np.zeros(6), memory=s)
    np.testing.assert_allclose(s["variance"][0, 0], block, rtol=1e-9)
    played(2.0, np.zeros(6), free=False, memory=s)
    np.testing.assert_allclose(s["variance"][0, 0], block + 2.0 * drift, rtol=1e-6)
    s["blocks"] = 9
    before = s["variance"][0, 0] + 2 * BLOCK_S * drift
    played(2 * BLOCK_S, np.zeros(6), memory=s)
    np.testing.assert_allclose(s["variance"][0, 0], 0.9**2 * before + 0.1**2 * block, rtol=1e-6)


def test_w1_apparent_gravity_takes_the_decks_acceleration_off(model):
    """A tool at rest on a deck that accelerates reads as one that accelerates on land."""
    deck = np.array([0.5, -0.3, 0.8])
    for R in orientations(5):
        measured = reading(model, R, deck)
        np.testing.assert_allclose(
            external_of(measured, R.as_matrix(), gravity=[0.0, 0.0, -9.81] - deck), 0.0, atol=1e-9
        )
        assert np.linalg.norm(external_of(measured, R.as_matrix())[:3]) > 0.1


@pytest.mark.parametrize("cut_off_hz", [20.0, 100.0])
def test_noise_that_is_told_is_what_a_low_pass_leaves_of_white_noise(cut_off_hz):
    """By its answer to an impulse: its squares add up to the variance of a reading, its sum to that of a long mean."""
    sensors = {"force_n": 0.05, "torque_nm": 0.002, "force_filter_hz": cut_off_hz}
    p = told(load_scenario("landing", {"sensors": sensors}))[0]
    kept = np.exp(-2.0 * np.pi * cut_off_hz * H)
    answer = (1.0 - kept) * kept ** np.arange(2000)
    one = np.sqrt(answer @ answer)
    np.testing.assert_allclose(p["sigma"], one * np.repeat([0.05, 0.002], 3), rtol=1e-9)
    assert p["correlation"] == pytest.approx(answer.sum() ** 2 / (answer @ answer))


def test_sensor_without_noise_is_told_a_least_one():
    p = told(load_scenario("landing", {"sensors": {"force_n": 0.0, "torque_nm": 0.0}}))[0]
    share = 1.0 / p["correlation"]
    np.testing.assert_allclose(p["sigma"], np.sqrt(share) * np.repeat([1e-3, 1e-4], 3))


def test_uncertainty_of_the_output_is_that_of_reading_and_bias_together():
    s, external, sigma, p = np.zeros(1, kept_layout()), np.zeros(6), np.zeros(6), settings()
    s["variance"] = np.square([0.03, 0.04, 0.05, 1e-3, 2e-3, 3e-3])
    compensate(WEIGHT, UPRIGHT, np.array([0.0, 0.0, 9.81]), False, p[0], s[0], external, sigma)
    drifted = p["drift"][0] ** 2 * H
    np.testing.assert_allclose(sigma**2, np.repeat(SIGMA, 3) ** 2 + s["variance"][0], rtol=1e-12)
    np.testing.assert_allclose(s["variance"][0][:3] - np.square([0.03, 0.04, 0.05]), drifted[:3], rtol=1e-6)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_bias_follows_its_estimate_at_its_rate_and_stops_there(sign):
    """0.5 N/s and 0.02 N·m/s, 100 ms long; while nothing is learnt it stands still."""
    s, external, sigma, p = np.zeros(1, kept_layout()), np.zeros(6), np.zeros(6), settings()
    s["target"] = sign * np.array([1.0, 0.02, 0.05, 0.01, 0.001, 0.002])
    for free in (False, True):
        for _ in range(100):
            compensate(WEIGHT, UPRIGHT, np.array([0.0, 0.0, 9.81]), free, p[0], s[0], external, sigma)
        moved = sign * np.array([0.05, 0.02, 0.05, 0.002, 0.001, 0.002]) * free
        np.testing.assert_allclose(s["bias"][0], moved, atol=1e-12)
        np.testing.assert_allclose(external, -moved, atol=1e-12)


def test_block_that_was_interrupted_is_forgotten():
    """What was summed up before somebody touched it, and what was waiting, counts for nothing afterwards."""
    s, external, sigma, p = np.zeros(1, kept_layout()), np.zeros(6), np.zeros(6), settings()
    block, up = int(p["block"][0]), np.array([0.0, 0.0, 9.81])
    for free, load, ticks in ((True, 1.0, block + 10), (False, 1.0, 1), (True, 0.0, 2 * block)):
        for _ in range(ticks):
            compensate(WEIGHT + load, UPRIGHT, up, free, p[0], s[0], external, sigma)
    assert s["blocks"][0] == 1
    np.testing.assert_allclose(s["target"][0], 0.0, atol=1e-12)
    assert (s["count"][0], s["has_waiting"][0]) == (0, 1)


def test_estimate_is_the_mean_of_the_first_blocks_and_then_forgets_slowly():
    """Of blocks of 0.3, 0.6 and 0.9 N the mean; with a tenth block's weight for ever, a tenth of each newer one."""
    s, external, sigma, p = np.zeros(1, kept_layout()), np.zeros(6), np.zeros(6), settings()
    load, found = np.array([1.0, -1.0, 0.5, 0.0, 0.0, 0.0]), []
    for size in (0.3, 0.6, 0.9, 0.0):
        for _ in range(int(p["block"][0])):
            compensate(WEIGHT + size * load, UPRIGHT, np.array([0.0, 0.0, 9.81]), True, p[0], s[0], external, sigma)
        found.append(s["target"][0].copy())
    np.testing.assert_allclose(found, np.outer([0.0, 0.3, 0.45, 0.6], load), atol=1e-12)
    s["blocks"], s["waiting"] = 50, 0.1 * load
    for _ in range(int(p["block"][0])):
        compensate(WEIGHT, UPRIGHT, np.array([0.0, 0.0, 9.81]), True, p[0], s[0], external, sigma)
    np.testing.assert_allclose(s["target"][0], (0.9 * 0.6 + 0.1 * 0.1) * load, atol=1e-12)
