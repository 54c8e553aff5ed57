"""Deviations of the moved bodies against mechanics: what is heavier, out of centre, stiffer, elsewhere."""

import mujoco
import numpy as np
import pytest

from armland.plant.scene.uav import PLAY, play_stop
from armland.plant.simulator import Simulator

HOME = np.deg2rad([-4.72, -109.96, -7.94, -71.39, 11.82, 39.34, -7.2])
G = 9.81


@pytest.fixture
def made(landing):
    """A plant with the UAV level in the air and deviations that are just so: `device={entry: number}`."""

    def build(start="air", **devices):
        exact = {d: {e: [x, x] for e, x in entries.items()} for d, entries in devices.items()}
        sim = Simulator(landing(deviation=exact), HOME, start)
        sim.connect()
        return sim

    return build


def bias(sim):
    """Generalised gravity (6,) on the UAV's free joint at rest: force, W, and moment about the body's origin, B."""
    sim.data.qvel[:] = 0.0
    mujoco.mj_forward(sim.scene.model, sim.data)
    return sim.data.qfrc_bias[sim.scene.uav_dof].copy()


@pytest.mark.parametrize("share", [0.2, -0.2])
def test_heavier_uav_weighs_that_much_more_and_falls_no_faster(made, share):
    plain, other = made(), made(uav={"mass": share})
    body = plain.scene.uav_body
    hull = plain.scene.model.body_mass[body]
    assert bias(other)[2] - bias(plain)[2] == pytest.approx(share * hull * G)
    # Pushed by one newton beyond its weight: a = F/m of hull and plate together.
    for sim, more in ((plain, 0.0), (other, share * hull)):
        whole = sim.scene.model.body_subtreemass[body]
        assert whole == pytest.approx(plain.scene.model.body_subtreemass[body] + more)
        sim.data.xfrc_applied[body] = [0.0, 0.0, whole * G + 1.0, 0.0, 0.0, 0.0]
        mujoco.mj_forward(sim.scene.model, sim.data)
        assert sim.data.qacc[sim.scene.uav_dof[2]] == pytest.approx(1.0 / whole, rel=1e-6)


def test_centre_of_mass_beside_the_pivot_makes_the_moment_of_its_weight(made):
    """x forwards: gravity turns about y by m g x, of which MuJoCo's bias is the negative; each axis alike."""
    plain, other = made(), made(uav={"cm_m": 0.003})
    weight = plain.scene.model.body_mass[plain.scene.uav_body] * G
    np.testing.assert_allclose((bias(other) - bias(plain))[3:], [weight * 0.003, -weight * 0.003, 0.0], atol=1e-9)


def test_rotors_turn_the_uav_about_where_its_mass_really_is(made):
    """Four equal thrusts T push at the rotors' middle: seen from a centre of mass at s they make −s × 4T z."""
    plain, other = (
        s.world["told"]["rotors"]["mixer"][0][:, :4] @ np.full(4, 1.2) for s in (made(), made(uav={"cm_m": 0.003}))
    )
    np.testing.assert_allclose(other[1:] - plain[1:], [-0.003 * 4.8, 0.003 * 4.8, 0.0], atol=1e-12)
    assert other[0] == plain[0]


@pytest.mark.parametrize("share", [0.1, -0.1])
def test_inertia_scales_the_uavs_answer_to_a_torque(made, share):
    sims = made(), made(uav={"inertia": share})
    body = sims[0].scene.uav_body
    np.testing.assert_allclose(
        *(s.scene.model.body_inertia[body] / k for s, k in zip(sims, (1.0, 1.0 + share), strict=True))
    )


def test_arm_scales_as_a_whole_with_its_tool_and_without_the_uav(made):
    """Mass matrix and gravity of the joints grow by the share; the UAV in the air does not."""
    plain, other = made(), made(arm={"inertia": 0.1})
    dense = []
    for sim in (plain, other):
        M = np.zeros((sim.scene.model.nv, sim.scene.model.nv))
        mujoco.mj_fullM(sim.scene.model, sim.data, M)
        dense.append((M, bias(sim)))
    dof = plain.scene.joint_dof
    np.testing.assert_allclose(
        dense[1][0][np.ix_(dof, dof)], 1.1 * dense[0][0][np.ix_(dof, dof)], rtol=1e-9, atol=1e-12
    )
    np.testing.assert_allclose(other.data.qfrc_bias[dof], 1.1 * plain.data.qfrc_bias[dof], rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(dense[1][1], dense[0][1], atol=1e-12)


def test_tool_that_weighs_more_shows_at_the_force_sensor(made):
    plain, other = made(), made(wrench={"tool_kg": 0.1})
    tool = plain.scene.tool_body
    assert other.scene.model.body_mass[tool] - plain.scene.model.body_mass[tool] == pytest.approx(0.1)
    at = int(plain.world["told"]["wrench"]["at_force"][0])
    seen = [np.linalg.norm(s.data.sensordata[at : at + 3]) for s in (plain, other)]
    assert seen[1] - seen[0] == pytest.approx(0.1 * G, rel=1e-3)


def test_tool_never_weighs_nothing(made):
    tool = made().scene.tool_body
    assert made(wrench={"tool_kg": -0.2}).scene.model.body_mass[tool] >= 0.02


def test_friction_is_a_share_of_each_joints_torque(made):
    plain, other = made(), made(arm={"coulomb": 0.01, "viscous_nms": 0.5})
    dof, limits = plain.scene.joint_dof, np.array([176.0, 176.0, 100.0, 100.0, 100.0, 38.0, 38.0])
    more = other.scene.model.dof_frictionloss[dof] - plain.scene.model.dof_frictionloss[dof]
    np.testing.assert_allclose(more, 0.01 * limits)
    np.testing.assert_allclose(other.scene.model.dof_damping[dof] - plain.scene.model.dof_damping[dof], 0.5)
    # Brakes that let go leave that friction, too.
    np.testing.assert_array_equal(other.world["told"]["brake"]["free"][0], other.scene.model.dof_frictionloss[dof])


def test_cable_across_the_hinge_turns_the_plate_to_its_own_angle(made):
    """k (askew − angle) about both crossed axes and none about the swivel, on which the cable turns along."""
    plain, other = (
        made(),
        made(hinge={"stiffness_nm": 0.01, "askew_deg": 3.0, "friction_nm": 2e-4, "damping_nms": 1e-5}),
    )
    dof = plain.scene.hinge_dof
    torque = other.data.qfrc_passive[dof] - plain.data.qfrc_passive[dof]
    np.testing.assert_allclose(torque, [0.01 * np.deg2rad(3.0)] * 2 + [0.0], atol=1e-12)
    m, n = other.scene.model, plain.scene.model
    np.testing.assert_allclose(m.dof_frictionloss[dof] - n.dof_frictionloss[dof], [2e-4, 2e-4, 0.0], atol=1e-15)
    np.testing.assert_allclose(m.dof_damping[dof] - n.dof_damping[dof], [1e-5, 1e-5, 0.0], atol=1e-15)


def joint_of_play(sim):
    return mujoco.mj_name2id(sim.scene.model, mujoco.mjtObj.mjOBJ_JOINT, PLAY)


def test_plate_moves_freely_over_the_play_and_no_farther(made):
    """It hangs at the lower end; pushed up, it comes to rest at the upper one."""
    sim = made("cradle", hinge={"play_m": 4e-4})
    m, d, plate = sim.scene.model, sim.data, sim.scene.plate_body
    assert joint_of_play(made("cradle")) < 0 <= joint_of_play(sim)

    def rests(push):
        d.xfrc_applied[plate, 2] = push
        mujoco.mj_step(m, d, nstep=2000)
        return float(d.joint(PLAY).qpos[0])

    weight, stiff = 9.81 * float(m.body_mass[plate]), play_stop(float(m.body_mass[sim.scene.uav_body]))[0]
    assert rests(0.0) == pytest.approx(-2e-4 - weight / stiff, abs=1e-8)
    assert rests(weight + 1.0) == pytest.approx(2e-4 + 1.0 / stiff, abs=1e-7)
    assert rests(weight + 2.0) == pytest.approx(2e-4 + 2.0 / stiff, abs=1e-7)


def test_cradle_stands_beside_and_turned_and_the_uav_on_it_with_it(made):
    plain, other = made("cradle"), made("cradle", cradle={"place_m": 0.003, "heading_deg": 10.0})
    np.testing.assert_allclose(other.scene.put_down - plain.scene.put_down, 0.003)
    rails = [[s.data.geom(f"rail_{i}").xpos.copy() for i in (1, 2)] for s in (plain, other)]
    np.testing.assert_allclose(np.mean(rails[1], axis=0) - np.mean(rails[0], axis=0), 0.003, atol=1e-9)
    apart = [r[1] - r[0] for r in rails]
    turn = np.rad2deg(np.arctan2(np.cross(apart[0], apart[1])[2], apart[0] @ apart[1]))
    assert turn == pytest.approx(10.0, abs=1e-6)


def test_rails_are_as_slippery_as_they_are_said_to_be(made):
    plain, other = made().scene.model, made(cradle={"friction": -0.4}).scene.model
    changed = np.any(plain.pair_friction != other.pair_friction, axis=1)
    np.testing.assert_allclose(other.pair_friction[changed, :2], 0.6 * plain.pair_friction[changed, :2])
    rails = {plain.geom(f"rail_{i}").id for i in (1, 2)}
    of = [bool(rails & {int(a), int(b)}) for a, b in zip(plain.pair_geom1, plain.pair_geom2, strict=True)]
    np.testing.assert_array_equal(changed, of)
    assert any(of)
