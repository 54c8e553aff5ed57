"""Where the UAV is asked to be for the camera's sake, held against the plant's own camera."""

import numpy as np
import pytest

from armland.cli.options import load
from armland.mission.reference.view import (
    ABOVE_M,
    ASIDE_M,
    HEAVES_M,
    LEAN_DEG,
    LOWERS_MPS,
    PASSES_M,
    RISE_MPS,
    RISEN_S,
    in_view,
    seek,
    told,
)
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


def asked(bench, aside, waits=True):
    """Where a UAV is asked to be that is `aside` (2,), m, of the arm."""
    bench.e["plate"][0] = bench.e["r"][0] + [*aside, 0.4]
    told, kept = bench.told["act"]["uav"][0], bench.kept["act"][0]
    return in_view(bench.tick.buffer["estimate"][0], waits, told, kept)


def seen(bench, aside, height, lean):
    """Whether the plant's camera sees the marker of a UAV with its pivot there, leaning by `lean` (3,), rad, past its skids."""
    camera, R = bench.plan.scenario.camera, matrix(from_rotation_vector(np.array(lean)))
    lever = bench.told["act"]["uav"]["lever"][0]
    pivot = np.array([*(bench.e["r"][0, :2] + aside), height])
    offset = pivot + R @ (np.array(camera.marker_m) - lever) - bench.e["r"][0] - camera.position_m
    told = camera_told(camera.model_copy(update={"incidence_max_deg": camera.hidden_from_deg}), 1000)[0]
    return bool(visible(offset, np.ascontiguousarray(R @ matrix(MARKER_DOWN)), told))


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


def test_lost_uav_rises_until_the_camera_would_not_see_so_far_and_comes_back_to_where_it_began(below):
    """Where it was lost may be wrong; it is never told to come down below the first step, nor from above what is seen."""
    highest = below.told["act"]["uav"]["sight"]["highest"][0]
    plate = np.array(below.plan.scenario.place.catch_m)
    first, later = look_for(below, plate)[2], look_for(below, plate, alone_s=1.0)[2]
    assert later - first == pytest.approx(RISE_MPS)
    top_s = (highest - plate[2] - first) / RISE_MPS
    assert plate[2] + look_for(below, plate, alone_s=top_s)[2] == pytest.approx(highest)
    assert look_for(below, plate, alone_s=2.0 * top_s - 1.0)[2] == pytest.approx(later)
    steps = [look_for(below, plate, alone_s=t)[2] for t in np.arange(0.0, 60.0, 0.3)]
    assert min(steps) == pytest.approx(first)
    below.kept["act"]["sought"] = 0
    assert look_for(below, plate + [0.0, 0.0, 3.0], alone_s=1.0)[2] == pytest.approx(0.0, abs=2e-3)


@pytest.mark.parametrize(("sea", "higher"), [("0", 0.0), ("3", HEAVES_M)])
def test_lost_uav_goes_higher_above_a_deck_that_heaves(sea, higher):
    scenario = load("landing", {"sea": sea, "hull": 4.0})
    assert told(scenario, np.array([0.0, 0.0, -0.1]))["lifts"] == pytest.approx(ABOVE_M + higher)


def test_uav_waits_above_its_station_in_wind_and_comes_down_at_its_pace(below):
    """Negative control: in calm air it is asked to be where it is caught from the first tick on."""
    station, uav = np.array(below.plan.scenario.place.catch_m), below.told["act"]["uav"]
    sight, samples = uav["sight"], 1.0 / (uav["period"][0] * uav["tick_s"][0])
    assert asked(below, (0.0, 0.0))[2] == station[2]
    sight["leans"], sight["above"], sight["level"] = 1, 0.4, 1.0
    for _ in range(round(samples)):
        before = asked(below, (0.0, 0.0))[2]
    assert before == pytest.approx(station[2] + LOWERS_MPS)
    for _ in range(round(2.0 * samples)):
        waiting = asked(below, (0.0, 0.0))[2]
    assert waiting == pytest.approx(station[2] + 0.4)
    assert below.kept["act"]["asked"][0, 2] == waiting
    assert waiting - asked(below, (0.0, 0.0), waits=False)[2] == pytest.approx(LOWERS_MPS / samples)
    for _ in range(round(2.0 * samples)):
        below_it = asked(below, (0.0, 0.0), waits=False)[2]
    assert below_it == pytest.approx(station[2])


def test_uav_that_was_never_seen_is_sent_nowhere(below):
    np.testing.assert_array_equal(look_for(below, np.zeros(3), known=False), 0.0)
    assert below.kept["act"]["sought"] == 0


def test_step_is_measured_from_where_it_was_lost_and_not_from_where_reckoning_drifts(below):
    place = np.array(below.plan.scenario.place.catch_m)
    first = look_for(below, place + [0.2, 0.0, 0.0])
    np.testing.assert_array_equal(look_for(below, place + [1.0, 1.0, 0.0])[:2], first[:2])


def kept_upwind(bench, towards, lean, height):
    """Where (2,), m, beside the arm a UAV is asked to be that leans by `lean` rad towards `towards` (2,), `height` m above it."""
    p = bench.told["act"]["uav"]
    p["sight"]["leans"], bench.kept["act"]["hovered"] = 1, 9.81 * np.tan(lean) * np.array(towards)
    bench.e["plate"][0] = bench.e["r"][0] + [0.0, 0.0, height]
    told, kept = p[0], bench.kept["act"][0]
    return in_view(bench.tick.buffer["estimate"][0], True, told, kept)[:2] - p["station"][0, :2]


def reach(bench, place, towards, lean, height):
    """How far (2,), m, the UAV may be blown from `place` (2,), downwind and upwind, before the plant's camera loses it."""
    turn = lean * np.array([-towards[1], towards[0], 0.0])
    steps = np.arange(0.0, 0.8, 0.002)
    top = bench.e["r"][0, 2] + height
    out = []
    for sign in (-1.0, 1.0):
        lost = [not seen(bench, np.asarray(place) + sign * x * np.array(towards), top, turn) for x in steps]
        out.append(steps[lost.index(True)])
    return np.array(out)


@pytest.mark.parametrize("angle", np.arange(0.0, 2.0 * np.pi, np.pi / 3.0))
def test_leaning_uav_is_kept_where_a_gust_takes_it_out_of_view_later(below, angle):
    """Negative control: right above the camera a UAV that leans by 20 degrees is lost downwind after half of that."""
    towards, lean, height = (np.cos(angle), np.sin(angle)), np.deg2rad(20.0), 0.9
    place = kept_upwind(below, towards, lean, height)
    assert place @ towards > 0.05
    there, above = reach(below, place, towards, lean, height), reach(below, [0.0, 0.0], towards, lean, height)
    # Half of the lean is made up for: it is still lost sooner downwind.
    assert 1.8 * above.min() < there.min() < there.max() < above.max()


def test_uav_that_hardly_leans_or_is_where_it_is_caught_is_kept_above_the_camera(below):
    np.testing.assert_array_equal(kept_upwind(below, (1.0, 0.0), np.deg2rad(5.0), 0.9), 0.0)
    np.testing.assert_array_equal(kept_upwind(below, (1.0, 0.0), np.deg2rad(20.0), 0.05), 0.0)
