"""The electromagnet on a bench: its face fixed in the world and facing up, a free steel plate upon it, forces on the plate."""

from types import SimpleNamespace

import mujoco
import numpy as np
import pytest
from numba import njit

from armland.plant.devices.magnet import OFF, ON, TEST, TOUCHING_M, energise, kept_layout, pull, tell, told_layout
from armland.plant.faults import table as faults
from armland.plant.scene.gear import CUSHION_BELOW_M, couple, mount_face
from armland.plant.scene.uav import PLATE
from armland.scenario import load_scenario
from armland.scenario.gear import Magnet

RATED = 177.0
WEIGHT = 0.048 * 9.81
UP, FACE = np.array([0.0, 0.0, 1.0]), (0.0, 0.0, -0.002)
BODY = 2


@njit(cache=True)
def tick(command, geom_xpos, geom_xmat, xipos, told, kept, faults, xfrc):
    energise(command, geom_xpos, geom_xmat, xipos, told[0], kept[0], faults[0], xfrc)


class Bench:
    """The plate starts `gap` above the face, beside its middle by `offset`; the coil's current has risen unless told otherwise."""

    def __init__(self, gap=0.0, offset=0.0, current=1.0, **told):
        spec = mujoco.MjSpec()
        spec.option.timestep = 1e-3
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        spec.option.cone, spec.option.impratio = mujoco.mjtCone.mjCONE_ELLIPTIC, 10.0
        mount_face(spec.worldbody.add_body(name="tool"), 0.0, Magnet())
        plate = spec.worldbody.add_body(name=PLATE, pos=[offset, 0.0, 0.002 + gap])
        plate.add_freejoint()
        cylinder = mujoco.mjtGeom.mjGEOM_CYLINDER
        plate.add_geom(name=PLATE, type=cylinder, size=[0.022, 0.002, 0], mass=0.048)
        for geom in spec.geoms:
            geom.contype, geom.conaffinity = 0, 0
        couple(spec, Magnet())
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.told, self.kept = np.zeros(1, told_layout(7)), np.zeros(1, kept_layout(7))
        self.faults = np.zeros(1, faults.kept_layout(7))
        faults.reset(self.faults, np.zeros(1, faults.told_layout(7)))
        scene = SimpleNamespace(model=self.model, parts=("magnet",), plate_body=BODY, tool_body=1)
        tell(self.told, load_scenario("landing"), scene)
        for name, value in told.items():
            self.told[name] = value
        self.kept["current"] = current
        mujoco.mj_forward(self.model, self.data)

    def step(self, count=1, force=(0.0, 0.0, 0.0), at=FACE, command=ON):
        d = self.data
        for _ in range(count):
            tick(command, d.geom_xpos, d.geom_xmat, d.xipos, self.told, self.kept, self.faults, d.xfrc_applied)
            arm = d.xmat[BODY].reshape(3, 3) @ np.array(at)
            d.xfrc_applied[BODY, :3] += force
            d.xfrc_applied[BODY, 3:] += np.cross(arm, force)
            mujoco.mj_step(self.model, d)
        return self

    def breaks_at(self, direction, at=FACE, rate=60.0, held=(0.0, 0.0, 0.0)):
        """Load in N along `direction`, raised at `rate` N/s on top of `held`, that moves the plate by a millimetre."""
        start, load = self.data.qpos[:3].copy(), 0.0
        while np.linalg.norm(self.data.qpos[:3] - start) < 1e-3:
            load += rate * 1e-3
            assert load < 3.0 * RATED
            self.step(1, load * np.array(direction) + held, at)
        return load

    @property
    def height(self):
        return self.data.qpos[2] - 0.002


def breakaway_force(angle, lever):
    """Load in N at `angle` rad from the face's normal, `lever` m above the face: the smaller of peeling and sliding.

    Peeling about the pads' nearest edge, F (cos + sin h/r') = F₀ with r' = r/√2; sliding, F sin = μ (F₀ − F cos).
    """
    c, s = np.cos(angle), np.sin(angle)
    return RATED / max(c + s * lever * np.sqrt(2.0) / 0.015, s / 0.2 + c)


def test_pull_falls_with_the_gap_as_in_the_data_sheet():
    for gap, sheet, misfit in ((0.0, 177.0, 0.001), (0.1e-3, 79.0, 0.01), (0.2e-3, 44.0, 0.01), (0.4e-3, 22.0, 0.11)):
        assert Bench(gap).step().kept["pull"][0] == pytest.approx(sheet, rel=misfit)


def test_pull_acts_and_reacts():
    bench = Bench(gap=0.3e-3, offset=0.004).step()
    tool, plate = bench.data.xfrc_applied[1], bench.data.xfrc_applied[BODY]
    assert plate[2] < -20.0
    np.testing.assert_allclose(tool[:3], -plate[:3], atol=1e-12)
    about_origin = [w[3:] + np.cross(p, w[:3]) for w, p in ((tool, [0, 0, 0]), (plate, [0.004, 0, 0.0023]))]
    np.testing.assert_allclose(about_origin[0], -about_origin[1], atol=1e-9)


def test_pull_off_force_is_the_rating():
    assert Bench().step(100).breaks_at(UP) == pytest.approx(RATED + WEIGHT, rel=0.01)


def test_switched_off_it_holds_no_more_than_its_residual_force():
    bench = Bench(current=0.0)
    bench.step(200, (WEIGHT + 0.2) * UP, command=OFF)
    assert bench.height < 1e-5
    bench.step(200, (WEIGHT + 0.4) * UP, command=OFF)
    assert bench.height > 1e-3


@pytest.mark.parametrize("angle", [0.0, 0.4, np.pi / 4])
def test_slides_at_a_fifth_of_its_pull_in_every_direction(angle):
    load = Bench().step(100).breaks_at((np.cos(angle), np.sin(angle), 0.0), rate=30.0)
    assert load == pytest.approx(0.2 * (RATED + WEIGHT), rel=0.02)


def test_friction_lasts_under_tension():
    # MuJoCo's own adhesion fails here: its contacts lose their friction as soon as the load pulls.
    held = 100.0 * UP
    load = Bench().step(100, held).breaks_at((1.0, 0.0, 0.0), rate=30.0, held=held)
    assert load == pytest.approx(0.2 * (RATED + WEIGHT - 100.0), rel=0.02)


@pytest.mark.parametrize(("direction", "edge"), [((1.0, 0.0), 0.015), ((1.0, 1.0), 0.015 / np.sqrt(2.0))])
def test_peels_under_a_lever(direction, edge):
    # A pull 0.1 m beside the middle turns the plate about the pads' edge on that side: F (0.1 - edge) = (F0 + W) edge.
    x, y = 0.1 * np.array(direction) / np.linalg.norm(direction)
    load = Bench().step(100).breaks_at(UP, at=(x, y, -0.002), rate=20.0)
    assert load == pytest.approx((RATED + WEIGHT) * edge / (0.1 + edge), rel=0.05)


def test_breakaway_force_predicts_the_bench():
    load = Bench().step(100).breaks_at((np.sqrt(0.5), 0.0, np.sqrt(0.5)), at=(0.0, 0.0, 0.010), rate=30.0)
    assert load == pytest.approx(breakaway_force(np.pi / 4, 0.012), rel=0.05)


def test_lifted_by_its_gap_scale_a_pad_pulls_with_a_quarter():
    assert pull(0.2e-3, 1.0, RATED, 0.2e-3, 0.3) == pytest.approx(0.25 * RATED)
    # Half a degree at one edge does that: so much a plate may tilt before it peels.
    assert np.rad2deg(0.2e-3 / (np.sqrt(2.0) * 0.015)) == pytest.approx(0.54, abs=0.01)


def test_stays_put_under_a_side_load():
    bench = Bench().step(100)
    start = bench.data.qpos[:3].copy()
    bench.step(10000, (3.0, 0.0, 0.0))
    assert np.linalg.norm(bench.data.qpos[:3] - start) < 5e-6


@pytest.mark.parametrize("below", [True, False])
def test_a_sliding_load_stops_by_friction_only_because_the_cushions_lie_below_the_pads(below):
    # As heavy as the UAV: m v²/2 = μ F₀ s.
    bench, mass, speed = Bench(), 0.5, 0.15
    bench.model.body_mass[BODY], bench.model.body_inertia[BODY] = mass, 1e-2
    mujoco.mj_setConst(bench.model, bench.data)
    if not below:
        for i in range(4):
            bench.model.geom(f"cushion_{i + 1}").pos[2] += CUSHION_BELOW_M
    bench.step(30).data.qvel[0] = speed
    path = bench.step(200).data.qpos[0]
    theory = 0.5 * mass * speed**2 / (0.2 * (RATED + 9.81 * mass))
    assert abs(bench.data.qvel[0]) < 1e-4
    assert (path < 1.5 * theory) == below
    assert path > 0.5 * theory
    assert below or path > 5.0 * theory


@pytest.mark.parametrize(("load", "closes"), [(15.0, True), (25.0, False)])
def test_attracts_over_a_gap_against_what_it_can_lift(load, closes):
    # At 0.4 mm it pulls with 177/9 = 19.7 N.
    bench = Bench(gap=0.4e-3).step(100, (load + WEIGHT) * UP)
    assert (bench.height < 1e-5) == closes
    assert (bench.kept["touching"][0] == 4) == closes


def test_a_light_plate_lands_softly_only_because_of_the_cushion():
    deepest = {}
    for cushion in (True, False):
        bench = Bench(gap=1e-3)
        if not cushion:
            bench.model.pair_adhesion[:] = 0.0
        deepest[cushion] = -min(bench.step(1, WEIGHT * UP).height for _ in range(60))
    # Half of what counts as touching: the cushions end below the pads.
    assert deepest[True] < 0.5 * TOUCHING_M
    assert deepest[False] > 5e-5


def test_a_pad_beyond_the_plates_edge_does_not_pull():
    assert Bench(offset=0.006).step().kept["pull"][0] == pytest.approx(RATED)
    assert Bench(offset=0.009).step().kept["pull"][0] == pytest.approx(0.75 * RATED)


def test_current_rises_with_its_time_constant():
    bench = Bench(current=0.0).step(20)
    assert bench.kept["current"][0] == pytest.approx(1.0 - np.exp(-1.0), rel=1e-6)
    assert bench.kept["pull"][0] == pytest.approx(0.3 + 176.7 * (1.0 - np.exp(-1.0)) ** 2, rel=1e-3)
    bench.step(20, command=OFF)
    assert bench.kept["current"][0] == pytest.approx((1.0 - np.exp(-1.0)) * np.exp(-1.0), rel=1e-6)


def test_self_test_reports_the_rated_force_and_ends_by_itself():
    bench = Bench(gap=0.05, current=0.0)
    assert bench.kept["report"][0] == 0.0
    bench.step(100, WEIGHT * UP, command=TEST)
    assert bench.kept["report"][0] == pytest.approx(RATED, rel=0.02)
    assert bench.kept["fault"][0] == 0
    bench.step(100, WEIGHT * UP, command=TEST)
    assert bench.kept["current"][0] < 0.01


@pytest.mark.parametrize("coil", [0.0, 0.7])
def test_self_test_finds_a_weak_coil(coil):
    bench = Bench(gap=0.05, current=0.0, coil=coil).step(100, WEIGHT * UP, command=TEST)
    assert bench.kept["fault"][0] == 1
    assert bench.kept["report"][0] < 0.55 * RATED


def test_a_coil_that_fails_while_it_holds_is_found():
    bench = Bench().step(200)
    assert bench.kept["fault"][0] == 0
    bench.told["coil"] = 0.7
    assert bench.step(100).kept["fault"][0] == 1


def test_report_may_be_wrong_in_scale_and_zero():
    bench = Bench(gap=0.05, current=0.0, report_gain=0.95, report_offset=-2.0).step(100, WEIGHT * UP, command=TEST)
    assert bench.kept["report"][0] == pytest.approx(0.95 * RATED - 2.0, rel=0.02)


def test_fault_of_coil_and_of_rating_act_on_the_pull():
    for name, value, expected in (("coil", 0.5, 0.3 + 176.7 * 0.25), ("rating", 0.5, 0.5 * RATED)):
        bench = Bench()
        bench.faults[name] = value
        assert bench.step(300, -10.0 * UP).kept["pull"][0] == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("share", [0.05, 0.3])
def test_stuck_magnet_holds_a_share_of_its_rating_when_it_is_off(share):
    held, pulled_off, well = Bench(), Bench(), Bench()
    for bench in (held, pulled_off):
        bench.faults["residual"] = share
    held.step(500, (0.8 * share * RATED + WEIGHT) * UP, command=OFF)
    pulled_off.step(500, (1.2 * share * RATED + WEIGHT) * UP, command=OFF)
    well.step(500, (0.8 * share * RATED + WEIGHT) * UP, command=OFF)
    assert held.height < 1e-4
    assert held.kept["pull"][0] == pytest.approx(share * RATED, rel=0.05)
    assert min(pulled_off.height, well.height) > 0.01


def test_stuck_magnet_is_as_strong_as_any_and_reports_the_same_while_it_is_on():
    well, stuck = Bench(), Bench()
    stuck.faults["residual"] = 0.3
    for bench in (well, stuck):
        bench.step(500, 0.5 * RATED * UP)
    np.testing.assert_array_equal(stuck.data.qpos, well.data.qpos)
    assert (stuck.kept["report"], stuck.kept["fault"]) == (well.kept["report"], well.kept["fault"])
