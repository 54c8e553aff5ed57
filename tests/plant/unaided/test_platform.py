"""The platform in the plant: still on a hull that moves, within its legs' limits, and seen by all as the deck."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.experiments.episode import prepare
from armland.models.unaided.hexapod import legs
from armland.plant.scene.pad import build_pad_scene
from armland.plant.scene.platform import geometry, has_platform
from armland.scenario import load_scenario

SS2 = {"sea": {"state": "ss2", "hull_m": 4.0}}
SS3 = {"sea": {"state": "ss3", "hull_m": 4.0}}


def truths(mission, sea, ticks=9000, **more):
    """Truth of a flight's first ticks, and the platform's leg lengths at each hundredth of them."""
    flight = prepare(load_scenario(mission, {**sea, **more}), mission, 5)
    simulator, controller = flight.simulator, flight.controller
    simulator.connect()
    rows, k, lengths = np.zeros(ticks, controller.tick.buffer.dtype), 0, []
    while k < ticks:
        flown, error = simulator.advance(controller, rows[k : k + 10])
        assert error is None
        k += flown
        lengths.append(simulator.machine["length"][0].copy())
    return rows["truth"], np.array(lengths)


def motion(truth):
    """Speed of the pad's middle (k, 3), m/s, and tilt of the deck (k,), degrees."""
    R = Rotation.from_quat(truth["deck_quat"], scalar_first=True)
    v = truth["deck_v"] + np.cross(truth["deck_omega"], R.apply([0.62, 0.0, 0.45]))
    return v, np.rad2deg(np.arccos(np.clip(R.as_matrix()[:, 2, 2], -1.0, 1.0)))


@pytest.fixture(scope="module")
def swings():
    return {m: truths(m, SS3) for m in ("unassisted", "hexapod")}


def test_platform_is_level_where_the_hull_is_not(swings):
    tilt = {m: motion(t)[1][2000:] for m, (t, _) in swings.items()}
    assert tilt["hexapod"].max() < 1.0
    assert tilt["unassisted"].max() > 3.0 * tilt["hexapod"].max()


def test_platform_moves_less_than_the_hull(swings):
    speed = {m: np.sqrt(np.mean(motion(t)[0][2000:] ** 2)) for m, (t, _) in swings.items()}
    assert speed["hexapod"] < 0.85 * speed["unassisted"]


def test_legs_keep_stroke_and_speed(swings):
    lengths, h = swings["hexapod"][1], load_scenario("hexapod").hexapod
    neutral = legs(np.zeros(6), *geometry(load_scenario("hexapod")))
    assert np.abs(lengths - neutral).max() <= 0.5 * h.stroke_m + 1e-3
    assert np.abs(np.diff(lengths, axis=0)).max() / 0.01 <= h.speed_mps * 1.01
    # They are used: that is no platform that stands still.
    assert np.ptp(lengths, axis=0).max() > 0.05


def test_legs_that_hardly_move_cancel_little():
    stiff, _ = truths("hexapod", SS3, hexapod={"speed_mps": 0.01})
    free, _ = truths("unassisted", SS3)
    assert motion(stiff)[1][2000:].max() > 0.5 * motion(free)[1][2000:].max()


def test_platform_moves_as_the_step_would_move_it():
    # Speed at a tick is the way of the tick before, or each step would lead it elsewhere than the next tick puts it: contacts chatter.
    truth, _ = truths("hexapod", SS2, ticks=4000)
    way = np.diff(truth["deck"], axis=0) * 1000.0
    late = slice(1000, None)
    behind, ahead = (np.abs(way[late] - v[late]).max() for v in (truth["deck_v"][1:], truth["deck_v"][:-1]))
    assert behind < 1e-3
    assert behind < ahead


def test_on_land_there_is_no_platform():
    assert not has_platform(build_pad_scene(load_scenario("hexapod"), True).model)
    assert has_platform(build_pad_scene(load_scenario("hexapod", SS2), True).model)


def test_in_its_neutral_pose_the_platform_is_the_deck():
    plain, on_legs = (build_pad_scene(load_scenario("hexapod", SS2), legged) for legged in (False, True))
    import mujoco

    places = []
    for scene in (plain, on_legs):
        data = mujoco.MjData(scene.model)
        data.qpos[scene.uav_qpos[3]] = 1.0
        mujoco.mj_forward(scene.model, data)
        places.append([data.body("pad").xpos.copy(), data.sensordata[scene.sensor["deck_pos"] :][:3].copy()])
    np.testing.assert_allclose(places[0], places[1], atol=1e-12)
