"""The stage: what stands in the browser's scene, and what is told of it anew."""

import numpy as np
import pytest

from armland.console.stage.stage import LOST, SEEN, WEIGHT_M, Stage


@pytest.fixture
def stage(server, recording):
    return Stage(server.viser.scene, recording.scene, "/one", 10.0, recording.scenario, 0.02)


def test_bodies_stand_where_the_tick_has_them(stage, recording) -> None:
    tick = recording.at(7.0)
    stage.show(tick)
    uav = stage._frames[recording.scene.uav_body]
    np.testing.assert_allclose(uav.wxyz, tick["truth"]["quat"], atol=1e-12)
    np.testing.assert_allclose(stage._disc.position, tick["truth"]["ee"], atol=1e-9)


def test_what_stands_still_is_told_once(stage, recording, server) -> None:
    stage.show(recording.at(7.0))
    buffer = server.viser._websock_server._broadcast_buffer
    before = buffer.message_counter
    stage.show(recording.at(7.0))
    # The frustum and the disc are set as they are; no body is.
    assert buffer.message_counter - before < 10
    before = buffer.message_counter
    stage.show(recording.at(7.3))
    assert buffer.message_counter - before > 20


def test_the_force_s_arrow_is_as_long_as_the_force_is_large(stage, recording) -> None:
    tick = recording.ticks[7000:7001].copy()
    tick["truth"]["hinge_force"] = [0.0, 0.0, -20.0]
    stage.show(tick[0])
    start, end = stage._force.points[0]
    np.testing.assert_allclose(end - start, [0.0, 0.0, -2.0 * WEIGHT_M], atol=1e-6)
    assert stage._force.visible
    for force in ([0.0, 0.0, 0.1], [np.nan, 0.0, 9.0]):
        tick["truth"]["hinge_force"] = force
        stage.show(tick[0])
        assert not stage._force.visible


def test_wind_is_an_arrow_where_it_is_known(stage, recording) -> None:
    stage.show(recording.at(1.0), np.array([4.0, 0.0, 0.0]))
    assert stage._wind.visible
    stage.show(recording.at(1.0))
    assert not stage._wind.visible


def test_the_camera_says_whether_it_sees(stage, recording) -> None:
    tick = recording.ticks[3000:3001].copy()
    for valid, color in ((1, SEEN), (0, LOST), (1, SEEN)):
        tick["estimate"]["plate_valid"] = valid
        stage.show(tick[0])
        assert stage._eye.color == color


def test_what_the_camera_sees_is_of_the_tick_that_is_shown(stage, recording, server) -> None:
    pictures = []
    for time in (2.0, 7.0):
        stage.show(recording.at(time))
        pictures.append(stage.sight(recording.at(time), recording.period_s))
    assert pictures[0] != pictures[1]
    blind = Stage(server.viser.scene, recording.scene, "/blind", 10.0)
    assert blind.sight(recording.at(2.0), recording.period_s) == ""


def test_a_way_of_points(stage, recording) -> None:
    truth = recording.at(0.0)["truth"]
    way = np.array([[0.6, 0.0, 0.7], [0.6, 0.0, 0.8], [np.nan, 0.0, 0.0], [0.5, 0.0, 0.8]])
    stage.draw_path(truth, way)
    assert stage._path.points.shape == (2, 2, 3)
    assert stage._path.visible
    stage.draw_path(truth, way[:1])
    assert not stage._path.visible


def test_a_second_flight_is_pale_and_has_no_floor_of_its_own(server, recording) -> None:
    ghost = Stage(server.viser.scene, recording.scene, "/two", float("nan"), ghost=True)
    ghost.show(recording.at(3.0))
    created = [
        m
        for m in server.viser._websock_server._broadcast_buffer.message_from_id.values()
        if getattr(m, "name", "").startswith("/two/")
    ]
    names = {m.name.split("/")[2] for m in created}
    assert not names & {"floor", "eye", "envelope", "sea"}
    meshes = [m for m in created if type(m).__name__ == "MeshMessage"]
    assert meshes
    assert all(m.props.opacity == 0.3 for m in meshes)


def test_a_deck_carries_the_floor_above_water_that_moves(server, landing_scenario) -> None:
    from armland.plant.scene.composition import build_scene

    scenario = landing_scenario.replaced({"sea": {"state": "ss1"}})
    stage = Stage(server.viser.scene, build_scene(scenario, "free"), "/sea", 5.0, scenario)
    before = stage._water._meshes[0].vertices.copy()
    stage.wave(2.0)
    assert np.abs(stage._water._meshes[0].vertices - before).max() > 0.01
    names = {getattr(m, "name", "") for m in server.viser._websock_server._broadcast_buffer.message_from_id.values()}
    assert "/sea/sea" in names
    assert any(n.startswith("/sea/body_") and n.endswith("/floor") for n in names)


def test_it_stands_for_the_next_flight_whose_scene_looks_the_same(stage, recording, server) -> None:
    from armland.plant.scene.composition import build_scene

    stage.show(recording.at(7.0))
    other = recording.scenario.with_seed(5)
    buffer = server.viser._websock_server._broadcast_buffer
    before = buffer.message_counter
    assert stage.take(build_scene(other, "free"), 20.0, other, 0.02)
    assert buffer.message_counter == before
    tick = recording.ticks[7000:7001].copy()
    tick["truth"]["hinge_force"] = [0.0, 0.0, -20.0]
    stage.show(tick[0])
    # The new flight's weight, and its poses for the camera too.
    np.testing.assert_allclose(np.diff(stage._force.points[0], axis=0), [[0.0, 0.0, -WEIGHT_M]], atol=1e-6)
    assert stage._sight.poses is stage.poses
    assert "polygon" in stage.sight(tick[0], 1e-3)


@pytest.mark.parametrize(
    ("changes", "bond", "envelope"),
    [
        ({"plate": {"radius_m": 0.03}}, "free", 0.02),
        ({"camera": {"field_of_view_deg": [50.0, 40.0]}}, "free", 0.02),
        ({"sea": {"state": "ss1"}}, "free", 0.02),
        ({}, "hinged", 0.02),
        ({}, "free", 0.03),
    ],
)
def test_it_does_not_stand_for_one_that_looks_otherwise(stage, recording, changes, bond, envelope) -> None:
    from armland.plant.scene.composition import build_scene

    poses, scenario = stage.poses, recording.scenario.replaced(changes)
    assert not stage.take(build_scene(scenario, bond), 20.0, scenario, envelope)
    assert stage.poses is poses


def test_a_sea_that_is_taken_over_has_the_next_flight_s_waves(server, landing_scenario) -> None:
    from armland.plant.scene.composition import build_scene

    scenario = landing_scenario.replaced({"sea": {"state": "ss1"}})
    stage = Stage(server.viser.scene, build_scene(scenario, "free"), "/sea", 5.0, scenario)
    stage.wave(2.0)
    before = stage._water._meshes[0].vertices.copy()
    other = scenario.with_seed(scenario.run.seed + 1)
    assert stage.take(build_scene(other, "free"), 5.0, other, 0.0)
    stage.wave(2.0)
    assert np.abs(stage._water._meshes[0].vertices - before).max() > 0.01


def test_removed_it_is_gone(stage, server) -> None:
    stage.remove()
    with pytest.warns(UserWarning, match="already removed"):
        stage.remove()
