"""The electromagnet on a bench: its face fixed in the world and facing up, a free steel plate upon it, forces on the plate."""

import mujoco
import numpy as np
import pytest

from armland.plant.magnet import (
    OFF,
    ON,
    RECESS_M,
    TEST,
    Magnet,
    breakaway_force,
    couple,
    device,
    energise,
    mount_face,
    peel_moment,
)

RATED = 177.0
WEIGHT = 0.048 * 9.81
UP, FACE = np.array([0.0, 0.0, 1.0]), (0.0, 0.0, -0.002)
PLATE = 2


class Bench:
    """The plate starts `gap` above the face, beside its middle by `offset`; the coil's current has risen unless told otherwise."""

    def __init__(self, gap=0.0, offset=0.0, magnet=None, current=1.0):
        magnet = magnet or Magnet()
        spec = mujoco.MjSpec()
        spec.option.timestep = 1e-3
        spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
        spec.option.cone, spec.option.impratio = mujoco.mjtCone.mjCONE_ELLIPTIC, 10.0
        mount_face(spec.worldbody.add_body(name="tool"), 0.0, magnet)
        plate = spec.worldbody.add_body(name="plate", pos=[offset, 0.0, 0.002 + gap])
        plate.add_freejoint()
        cylinder = mujoco.mjtGeom.mjGEOM_CYLINDER
        plate.add_geom(name="plate", type=cylinder, size=[0.022, 0.002, 0], mass=0.048, contype=0, conaffinity=0)
        couple(spec, "plate", magnet)
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        self.parameters, self.state = device(self.model, "plate", magnet)
        self.state["current"] = current
        mujoco.mj_forward(self.model, self.data)

    def step(self, count=1, force=(0.0, 0.0, 0.0), at=FACE, command=ON):
        d = self.data
        for _ in range(count):
            energise(command, d.geom_xpos, d.geom_xmat, d.xipos, self.parameters, self.state, d.xfrc_applied)
            arm = d.xmat[PLATE].reshape(3, 3) @ np.array(at)
            d.xfrc_applied[PLATE, :3] += force
            d.xfrc_applied[PLATE, 3:] += np.cross(arm, force)
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


def test_pull_falls_with_the_gap_as_in_the_data_sheet():
    for gap, sheet, misfit in ((0.0, 177.0, 0.001), (0.1e-3, 79.0, 0.01), (0.2e-3, 44.0, 0.01), (0.4e-3, 22.0, 0.11)):
        assert Bench(gap).step().state["pull"][0] == pytest.approx(sheet, rel=misfit)


def test_pull_acts_and_reacts():
    bench = Bench(gap=0.3e-3, offset=0.004).step()
    tool, plate = bench.data.xfrc_applied[1], bench.data.xfrc_applied[PLATE]
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
    assert load == pytest.approx(breakaway_force(Magnet(), np.pi / 4, 0.012), rel=0.05)


def test_breakaway_force_by_hand():
    assert breakaway_force(Magnet(), 0.0, 0.012) == pytest.approx(177.0)
    assert breakaway_force(Magnet(), np.pi / 2, 0.0) == pytest.approx(35.4)
    # 0.15 m above the face the plate peels before it slides: F h = F0 r / sqrt(2).
    assert breakaway_force(Magnet(), np.pi / 2, 0.15) == pytest.approx(177.0 * 0.0106066 / 0.15, rel=1e-4)


def test_breakaway_tilt_is_half_a_degree():
    # Lifted at one edge by g0, half the pads pull with a quarter of their force: 0.54 degrees.
    assert peel_moment(Magnet(), 0.0) == pytest.approx(177.0 * 0.015 / np.sqrt(2.0))
    tilt = 0.2e-3 / (np.sqrt(2.0) * 0.015)
    assert np.rad2deg(tilt) == pytest.approx(0.54, abs=0.01)
    assert peel_moment(Magnet(), tilt) == pytest.approx(0.25 * peel_moment(Magnet(), 0.0), rel=1e-3)


def test_stays_put_under_a_side_load():
    bench = Bench().step(100)
    start = bench.data.qpos[:3].copy()
    bench.step(10000, (3.0, 0.0, 0.0))
    assert np.linalg.norm(bench.data.qpos[:3] - start) < 5e-6


@pytest.mark.parametrize(("load", "closes"), [(15.0, True), (25.0, False)])
def test_attracts_over_a_gap_against_what_it_can_lift(load, closes):
    # At 0.4 mm it pulls with 177/9 = 19.7 N.
    bench = Bench(gap=0.4e-3).step(100, (load + WEIGHT) * UP)
    assert (bench.height < 1e-5) == closes
    assert (bench.state["touching"][0] == 4) == closes


def test_a_light_plate_lands_softly_only_because_of_the_cushion():
    deepest = {}
    for cushion in (True, False):
        bench = Bench(gap=1e-3)
        if not cushion:
            bench.model.pair_adhesion[:] = 0.0
        deepest[cushion] = -min(bench.step(1, WEIGHT * UP).height for _ in range(60))
    # The last RECESS_M are not cushioned: it arrives with RECESS_M over the contact's 4 ms, and goes a step further.
    assert deepest[True] < RECESS_M / 4.0
    assert deepest[False] > 5e-5


def test_a_pad_beyond_the_plates_edge_does_not_pull():
    assert Bench(offset=0.006).step().state["pull"][0] == pytest.approx(RATED)
    assert Bench(offset=0.009).step().state["pull"][0] == pytest.approx(0.75 * RATED)


def test_current_rises_with_its_time_constant():
    bench = Bench(current=0.0).step(20)
    assert bench.state["current"][0] == pytest.approx(1.0 - np.exp(-1.0), rel=1e-6)
    assert bench.state["pull"][0] == pytest.approx(0.3 + 176.7 * (1.0 - np.exp(-1.0)) ** 2, rel=1e-3)
    bench.step(20, command=OFF)
    assert bench.state["current"][0] == pytest.approx((1.0 - np.exp(-1.0)) * np.exp(-1.0), rel=1e-6)


def test_self_test_reports_the_rated_force_and_ends_by_itself():
    bench = Bench(gap=0.05, current=0.0)
    assert np.isnan(bench.state["report"][0])
    bench.step(100, WEIGHT * UP, command=TEST)
    assert bench.state["report"][0] == pytest.approx(RATED, rel=0.02)
    assert bench.state["fault"][0] == 0
    bench.step(100, WEIGHT * UP, command=TEST)
    assert bench.state["current"][0] < 0.01


@pytest.mark.parametrize("health", [0.0, 0.7])
def test_self_test_finds_a_weak_coil(health):
    bench = Bench(gap=0.05, magnet=Magnet(health=health), current=0.0).step(100, WEIGHT * UP, command=TEST)
    assert bench.state["fault"][0] == 1
    assert bench.state["report"][0] < 0.55 * RATED


def test_a_coil_that_fails_while_it_holds_is_found():
    bench = Bench().step(200)
    assert bench.state["fault"][0] == 0
    bench.parameters["health"] = 0.7
    assert bench.step(100).state["fault"][0] == 1
