"""The table of laws with Table II's switches: what each row and each switch asks of arm and rotors."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from armland.control.laws.backstepping import paper_law
from armland.control.laws.exact import Reference, exact_law, exact_lyapunov
from armland.control.laws.rigid_body import BacksteppingGains
from armland.control.laws.settings import row_of
from armland.control.laws.table import ACCELERATIONS, end_effector_acceleration, kept_layout, told_layout
from armland.errors import ConfigurationError
from armland.models.environment import on_land
from armland.records import layout as record_layout

STIFFNESS, DAMPING = 935.0, 44.4
QUAT = Rotation.from_rotvec([0.05, -0.03, 0.02]).as_quat(scalar_first=True)
OMEGA = np.array([0.2, -0.1, 0.3])
R_E, R_V = np.array([0.01, -0.02, 0.03]), np.array([0.1, 0.05, -0.02])
MASS, G, F_T, LEVER = 0.48, 9.81, 2.35, np.array([0.0, 0.0, -0.06])


def speed(bench, qd):
    return bench.arm.jacobian[:3] @ qd


def test_eq33_paper_is_spring_on_the_error_and_damper_on_the_velocity(bench, states):
    for q, qd in states:
        found = bench.run(q=q, qd=qd, r_e=R_E, r_v=R_V)
        np.testing.assert_allclose(found.force, STIFFNESS * R_E - DAMPING * speed(bench, qd), atol=1e-9)
        np.testing.assert_array_equal(found.delta_tau, 0.0)


def test_eq6_classical_damps_the_error_and_not_the_velocity(bench, states):
    for q, qd in states:
        found = bench.run("classical", q=q, qd=qd, r_e=R_E, r_v=R_V)
        np.testing.assert_allclose(found.force, STIFFNESS * R_E - DAMPING * (speed(bench, qd) - R_V), atol=1e-9)


@pytest.mark.parametrize("law", ["classical", "paper"])
def test_support_is_none_the_measured_z_force_or_the_models(bench, law):
    hinge = np.array([0.4, -0.3, 1.7])
    none, measured, model = (
        bench.run(law, quat=QUAT, hinge=hinge, support=s).force for s in ("none", "measured", "model")
    )
    np.testing.assert_allclose(measured - none, [0.0, 0.0, hinge[2]], atol=1e-12)
    up = Rotation.from_quat(QUAT, scalar_first=True).apply([0.0, 0.0, 1.0])
    np.testing.assert_allclose(model - none, [0.0, 0.0, MASS * G] - F_T * up, atol=1e-12)


def test_eq29_full_extra_torque_is_the_laws_at_the_estimate(bench, states):
    q, qd = states[0]
    tau_att, k = np.array([0.01, -0.02, 0.03]), np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0])
    found = bench.run(q=q, qd=qd, r_e=R_E, quat=QUAT, omega=OMEGA, tau_att=tau_att, extra_torque="full")
    r, upright = bench.arm.position.copy(), np.array([1.0, 0.0, 0.0, 0.0])
    gains = BacksteppingGains(k, k, 35.0)
    expected, _ = paper_law(QUAT, OMEGA, r, speed(bench, qd), upright, r + R_E, F_T, tau_att, bench.uav, gains)
    np.testing.assert_allclose(found.delta_tau, expected, atol=1e-12)
    assert found.thrust == F_T


def test_x1_exact_takes_the_cms_velocity_and_the_moving_reference(bench, states):
    q, qd = states[1]
    tau_att, a_d = np.array([0.01, -0.02, 0.03]), np.array([0.5, 0.2, -0.3])
    arguments = {"q": q, "qd": qd, "r_e": R_E, "r_v": R_V, "r_a": a_d, "quat": QUAT, "omega": OMEGA, "tau_att": tau_att}
    found = bench.run("exact", **arguments, extra_torque="full")
    r, still = bench.arm.position.copy(), np.zeros(3)
    v_cm = speed(bench, qd) - Rotation.from_quat(QUAT, scalar_first=True).apply(np.cross(OMEGA, LEVER))
    reference = Reference(np.array([1.0, 0.0, 0.0, 0.0]), still, still, r + R_E, R_V, a_d)
    delta_tau, force = exact_law(QUAT, OMEGA, r, v_cm, reference, F_T, tau_att, bench.uav, bench.gains)
    np.testing.assert_allclose(found.force, force, atol=1e-12)
    np.testing.assert_allclose(found.delta_tau, delta_tau, atol=1e-12)
    v2, v2_rate = exact_lyapunov(QUAT, OMEGA, r, v_cm, reference, bench.uav, bench.gains)
    assert found.v2 == pytest.approx(v2, rel=1e-12)
    assert found.v2_rate == pytest.approx(v2_rate, rel=1e-12)
    # Where the attitude is the board's, the law finds no error in it.
    left = bench.run("exact", **arguments, changes={"attitude": 0})
    _, expected = exact_law(QUAT, OMEGA, r, v_cm, reference._replace(q_d=QUAT), F_T, tau_att, bench.uav, bench.gains)
    np.testing.assert_allclose(left.force, expected, atol=1e-12)
    assert np.abs(left.force - found.force).max() > 1e-3


def test_x3_exact_takes_the_disturbance_off_and_the_published_laws_do_not(bench):
    d = np.array([0.5, -1.0, 2.0])
    for law, share in (("exact", 1.0), ("paper", 0.0), ("classical", 0.0)):
        plain, pushed = bench.run(law, r_e=R_E), bench.run(law, r_e=R_E, disturbance=d)
        np.testing.assert_allclose(plain.force - pushed.force, share * d, atol=1e-12)


def test_x6_feed_forward_cancels_what_the_hinge_will_put_on_the_body(bench):
    """The measured force less the tool's inertia, and the reference's acceleration ahead on the body's mass; each axis limited."""
    hinge, r_a, ahead = np.array([0.2, -0.1, 1.0]), np.array([0.3, 0.1, -0.2]), np.array([0.6, -0.4, 0.5])
    found = bench.run("exact", quat=QUAT, hinge=hinge, r_a=r_a, ahead=ahead, extra_torque="feedforward")
    coming = Rotation.from_quat(QUAT, scalar_first=True).inv().apply(hinge - 0.30 * r_a + MASS * (ahead - r_a))
    np.testing.assert_allclose(found.delta_tau, -np.cross(LEVER, coming), atol=1e-12)
    strong = bench.run("exact", hinge=[100.0, 100.0, 0.0], extra_torque="feedforward")
    assert np.abs(strong.delta_tau).max() < 0.5


def test_x2_implied_acceleration_makes_the_hinge_force_what_the_law_asks(bench, states):
    """Newton on the UAV, its pivot accelerated as implied and its rates steady: the force at the hinge is then F_EE."""
    q, qd = states[2]
    d = np.array([0.3, -0.2, 0.1])
    found = bench.run("exact", q=q, qd=qd, r_e=R_E, quat=QUAT, omega=OMEGA, disturbance=d, acceleration="implied")
    R = Rotation.from_quat(QUAT, scalar_first=True)
    v_dot = found.implied - R.apply(np.cross(OMEGA, np.cross(OMEGA, LEVER)))
    force = MASS * (v_dot + [0.0, 0.0, G]) - F_T * R.apply([0.0, 0.0, 1.0]) - d
    np.testing.assert_allclose(force, found.force, atol=1e-12)


def test_x4_limited_thrust_and_torque_are_made_up_for_by_the_arm(bench):
    """Force and moment on the body are the same with limits as without, as long as the arm may push; yaw stays lost."""
    strong = {"tau_att": np.array([0.5, -0.4, 0.0]), "quat": QUAT, "thrust": 7.2}
    free = bench.run(**strong, changes={"takeover_limit": 100.0})
    limited = bench.run(**strong, limits=True, changes={"takeover_limit": 100.0})
    R = Rotation.from_quat(QUAT, scalar_first=True)
    assert limited.thrust < 7.0 < free.thrust
    lift = R.apply([0.0, 0.0, 1.0])
    push = limited.force - free.force - (7.2 - limited.thrust) * lift
    assert np.linalg.norm(push) > 0.5
    assert abs(push @ R.apply(LEVER)) < 1e-9
    small = bench.run(**strong, limits=True, changes={"takeover_limit": 0.2})
    assert np.linalg.norm(small.force - free.force - (7.2 - small.thrust) * lift) == pytest.approx(0.2)


def test_x4_rotors_and_arm_together_turn_the_body_as_was_asked(bench):
    """About roll and pitch: what the four rotors then give, and the arm's push at its lever. The wrong way round it would be less."""
    R, asked = Rotation.from_quat(QUAT, scalar_first=True), np.array([0.5, -0.4, 0.0])
    changes = {"takeover_limit": 100.0}
    free = bench.run(tau_att=asked, quat=QUAT, thrust=7.2, changes=changes)
    found = bench.run(tau_att=asked, quat=QUAT, thrust=7.2, limits=True, changes=changes)
    push = R.inv().apply(found.force - free.force - (7.2 - found.thrust) * R.apply([0.0, 0.0, 1.0]))
    # The paper's rotors, 127 mm off both axes: on the lifted side all of 1.86 N, on the other the least.
    given = asked - np.cross(LEVER, push)
    rotor = 0.25 * (found.thrust + np.array([[1, -1], [1, 1], [-1, 1], [-1, -1]]) @ given[:2] / 0.127)
    assert (rotor > 0.09 - 1e-6).all()
    assert (rotor < 1.86 + 1e-6).all()
    assert rotor.max() == pytest.approx(1.86, abs=1e-6)
    # Of a roll and pitch that is beyond them the rotors keep the direction.
    assert given[1] / given[0] == pytest.approx(-0.8, rel=1e-6)
    assert np.cross(LEVER, push)[0] > 0.1


def test_x5_on_a_deck_that_accelerates_the_arm_carries_more(bench):
    deck = on_land()
    deck["base_a"] = [0.4, -0.2, 0.6]
    for law, switches in (("exact", {}), ("paper", {"support": "model"})):
        more = bench.run(law, environment=deck, **switches).force - bench.run(law, **switches).force
        np.testing.assert_allclose(more, MASS * deck["base_a"][0], atol=1e-12)


def test_eq26_proof_is_that_of_the_row_and_none_for_a_users_law(bench, tmp_path):
    found = bench.run("paper", r_e=R_E)
    assert found.v2 == pytest.approx(0.5 * 35.0 * R_E @ R_E + 0.5 * MASS * (30.0 * R_E) @ (30.0 * R_E))
    assert found.v2_rate == pytest.approx(-35.0 * 30.0 * R_E @ R_E - 30.0 * (30.0 * R_E) @ (30.0 * R_E))
    file = tmp_path / "own.py"
    file.write_text(OWN, encoding="utf-8")
    assert np.isnan(bench.run(f"{file}:spring", r_e=R_E).v2)


OWN = """
import numpy as np

def spring(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    return np.full(3, 0.01), 100.0 * (reference.r_d - r)

def fails(q, omega, r, v, reference, thrust, tau_att, uav, gains):
    return np.full(3, np.nan), 100.0 * (reference.r_d - r)
"""


def test_a_users_law_flies_like_a_row_and_gives_way_to_exact_where_it_fails(bench, tmp_path):
    file = tmp_path / "own.py"
    file.write_text(OWN, encoding="utf-8")
    good = bench.run(f"{file}:spring", r_e=R_E, extra_torque="full")
    np.testing.assert_allclose(good.force, 100.0 * R_E, atol=1e-12)
    np.testing.assert_allclose(good.delta_tau, 0.01)
    assert good.kept["failed"] == 0
    bad, exact = (bench.run(law, r_e=R_E, extra_torque="full") for law in (f"{file}:fails", "exact"))
    np.testing.assert_array_equal(bad.force, exact.force)
    np.testing.assert_array_equal(bad.delta_tau, exact.delta_tau)
    assert bad.kept["failed"] != 0
    row = row_of(f"{file}:fails")
    kept = bad.kept[0]
    said = row.own.explain(int(kept["failed"]), int(kept["tick"]), kept["given"], kept["returned"])
    assert "returned delta_tau[0] = nan" in said
    assert bad.v2 == exact.v2


def test_row_that_is_none_is_refused_with_those_that_are():
    with pytest.raises(ConfigurationError, match=r"law 'pid': there is classical, paper, exact, or a law of one's own"):
        row_of("pid")


@pytest.mark.parametrize(("switch", "fed"), [("none", (0, 0, 0)), ("reference", (1, 2, 3)), ("implied", (4, 5, 6))])
def test_arm_is_fed_forward_nothing_the_reference_or_what_the_law_implied(switch, fed):
    """Each whatever the other is, and never a turn."""
    r, p, s = (np.zeros(1, layout) for layout in (record_layout("reference", 7), told_layout(), kept_layout()))
    r["a"], s["implied"], p["acceleration"] = [1.0, 2.0, 3.0], [4.0, 5.0, 6.0], ACCELERATIONS.index(switch)
    np.testing.assert_array_equal(end_effector_acceleration(r[0], p[0], s[0]), [*fed, 0.0, 0.0, 0.0])
