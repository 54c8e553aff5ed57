"""Where the UAV is asked to be for the camera's sake, held against the plant's own camera."""

import numpy as np
import pytest

from armland.mission.reference.view import ABOVE_M, ASIDE_M, LEAN_DEG, PASSES_M, RISE_MPS, RISEN_S, in_view, seek
from armland.plant.devices.camera import visible
from armland.plant.devices.camera_numbers import camera_told
from armland.plant.scene.eye import MARKER_DOWN
from armland.rotations import from_rotation_vector, matrix


@pytest.fixture
def below(bench):
    """The arm waits below the catch, and the UAV is level."""
    place = bench.plan.scenario.place
    bench.e["r"] = np.array(place.catch_m) - [0.0, 0.0, place.wait_below_m]
    return bench


def asked(bench, aside):
    """Where a UAV is asked to be that is `aside` (2,), m, of the arm."""
    bench.e["plate"][0] = bench.e["r"][0] + [*aside, 0.4]
    return in_view(bench.tick.buffer["estimate"][0], bench.told["act"]["uav"][0])


def seen(bench, aside, height, lean):
    """Whether the plant's camera sees the marker of a UAV whose pivot is there, leaning by `lean` (3,), rad."""
    camera, R = bench.plan.scenario.camera, matrix(from_rotation_vector(np.array(lean)))
    lever = bench.told["act"]["uav"]["lever"][0]
    pivot = np.array([*(bench.e["r"][0, :2] + aside), height])
    offset = pivot + R @ (np.array(camera.marker_m) - lever) - bench.e["r"][0] - camera.position_m
    return bool(visible(offset, np.ascontiguousarray(R @ matrix(MARKER_DOWN)), camera_told(camera, 1000)[0]))


AROUND = [0.3 * np.array([np.cos(a), np.sin(a)]) for a in np.arange(0.0, 2.0 * np.pi, np.pi / 6.0)]


@pytest.mark.parametrize("aside", AROUND)
@pytest.mark.parametrize("lean", [0.0, LEAN_DEG])
@pytest.mark.parametrize("towards", np.arange(0.0, 2.0 * np.pi, np.pi / 4.0))
def test_uav_beside_the_camera_is_asked_to_stay_where_it_is_seen_however_it_leans(below, aside, lean, towards):
    """Negative control: at the height of its station it is seen in none of these places."""
    turn = np.deg2rad(lean) * np.array([np.cos(towards), np.sin(towards), 0.0])
    assert seen(below, aside, asked(below, aside)[2], turn)
    assert not seen(below, aside, below.plan.scenario.place.catch_m[2], turn)


@pytest.mark.parametrize("aside", [(0.0, 0.0), (0.05, 0.05)])
def test_uav_above_the_camera_is_asked_to_come_to_its_station(below, aside):
    np.testing.assert_array_equal(asked(below, aside), below.plan.scenario.place.catch_m)


def test_uav_far_beside_is_asked_to_stay_within_the_depth_that_the_camera_sees(below):
    camera = below.plan.scenario.camera
    height = asked(below, (2.0, 0.0))[2]
    depth = (
        height
        + camera.marker_m[2]
        - below.told["act"]["uav"]["lever"][0, 2]
        - below.e["r"][0, 2]
        - camera.position_m[2]
    )
    assert depth == pytest.approx(0.8 * camera.depth_max_per_size * camera.marker_size_m)


def look_for(bench, plate, ticks=1, known=True, alone_s=0.0):
    bench.e["plate"][0] = plate
    for _ in range(ticks):
        seek(alone_s, bench.tick.buffer["estimate"][0], known, bench.told["act"]["uav"][0], bench.kept["act"][0])
    return bench.kept["act"]["step"][0].copy()


def test_lost_uav_is_sent_above_the_camera_where_the_view_is_wide(below):
    place = np.array(below.plan.scenario.place.catch_m)
    step = look_for(below, place + [0.2, -0.1, 0.05])
    np.testing.assert_allclose(step, [-0.2, 0.1, ABOVE_M - 0.05], atol=2.0 * RISE_MPS * 1e-3)


def test_lost_uav_goes_no_further_aside_than_one_can_be_that_has_just_left_the_view(below):
    step = look_for(below, np.array(below.plan.scenario.place.catch_m) + [2.0, -2.0, 0.0])
    np.testing.assert_array_equal(step[:2], [-ASIDE_M, ASIDE_M])


@pytest.mark.parametrize("drawn_back", [True, False])
def test_lost_uav_that_is_too_low_to_pass_the_arm_rises_first(below, drawn_back):
    plate = below.e["r"][0] + [0.2, 0.2, PASSES_M - 0.01]
    step = look_for(below, plate)
    np.testing.assert_array_equal(step[:2], 0.0)
    assert step[2] > ABOVE_M
    below.e["r"][0, 2] -= 0.02 if drawn_back else 0.0
    step = look_for(below, plate, alone_s=0.0 if drawn_back else RISEN_S + 0.01)
    np.testing.assert_allclose(step[:2], -0.2, atol=1e-12)


def test_lost_uav_rises_until_the_camera_would_not_see_so_far_and_is_never_told_to_come_down(below):
    highest = below.told["act"]["uav"]["sight"]["highest"][0]
    plate = np.array(below.plan.scenario.place.catch_m)
    first, later = look_for(below, plate)[2], look_for(below, plate, 1000)[2]
    assert later - first == pytest.approx(RISE_MPS)
    assert plate[2] + look_for(below, plate, 20000)[2] == pytest.approx(highest)
    below.kept["act"]["sought"] = 0
    assert look_for(below, plate + [0.0, 0.0, 3.0], 1000)[2] == 0.0


def test_uav_that_was_never_seen_is_sent_nowhere(below):
    np.testing.assert_array_equal(look_for(below, np.zeros(3), known=False), 0.0)
    assert below.kept["act"]["sought"] == 0


def test_step_is_measured_from_where_it_was_lost_and_not_from_where_reckoning_drifts(below):
    place = np.array(below.plan.scenario.place.catch_m)
    first = look_for(below, place + [0.2, 0.0, 0.0])
    np.testing.assert_array_equal(look_for(below, place + [1.0, 1.0, 0.0])[:2], first[:2])
