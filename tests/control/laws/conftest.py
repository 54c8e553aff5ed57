"""A UAV on the arm's hinge as the laws see it: messages, what they are told, and the arm's forward dynamics in Pinocchio."""

from types import SimpleNamespace

import numpy as np
import pytest


@pytest.fixture(scope="session")
def bench(dynamics):
    """`act` evaluates law and arm torque at a state, for switches of Table II; `wrench` says what the torques do."""
    from numba import njit

    from armland.control.laws import realisation, settings, table
    from armland.control.laws.rigid_body import ExactGains
    from armland.linking import head, link
    from armland.models.environment import on_land
    from armland.models.parameters import arm_model, uav_parameters
    from armland.models.posture import home_poses, upright
    from armland.records import tick_layout
    from armland.scenario import load_scenario
    from armland.scenario.control import Experiment

    scenario = load_scenario("paper").believed()
    arm = arm_model(scenario)
    link(arm.joints)
    home = home_poses(arm, None, None, realisation.elbow_of(scenario, arm))[0].q
    arm.update(home, np.zeros(arm.joints))
    R_d, c = upright(arm.rotation), scenario.control
    gains = ExactGains(np.array(c.k1), np.array(c.k2), 7.0, c.k3)
    uav, act, tick = (
        uav_parameters(scenario),
        realisation.told(scenario, arm, R_d),
        np.zeros(1, tick_layout(arm.joints)),
    )
    kept = np.zeros(1, table.kept_layout())

    @njit
    def evaluate(thrust, ahead, mu, t, environment, arm_state, p, s, pr):
        e, r, command = t[0].estimate, t[0].reference, head(t[0].command)
        table.held_law(thrust, ahead, e, r, environment[0], p[0], s[0], command)
        table.held_lyapunov(e, r, p[0], s[0], t[0].proof)
        m, a, wrench = t[0].measurement, arm_state[0], mu.copy()
        torque = realisation.orientation_torque(realisation.end_effector_rate(m.qd, a), a, pr[0])
        for i in range(3):
            wrench[i] += t[0].command.force[i]
            wrench[3 + i] += torque[i]
        wanted = table.end_effector_acceleration(t[0].reference, p[0], s[0])
        follows = p[0].acceleration == table.IMPLIED
        realisation.arm_torque(m.q, m.qd, wanted, wrench, follows, a, pr[0], t[0].command.tau)

    def run(
        law="paper", q=home, qd=0.0, r_e=0.0, r_v=0.0, r_a=0.0, quat=(1.0, 0.0, 0.0, 0.0), omega=0.0, hinge=0.0, tau_att=0.0,
        ahead=None, mu=0.0, disturbance=0.0, thrust=c.thrust_n, environment=None, changes=None, **switches,
    ):  # fmt: skip
        p = settings.told(scenario, Experiment(law="paper", **switches), settings.row_of(law), uav, gains)
        for name, value in (changes or {}).items():
            p[name] = value
        e, r, m = tick["estimate"], tick["reference"], tick["measurement"]
        m["q"], m["qd"] = q, qd
        arm.qpos[:], arm.qvel[:] = m["q"][0], m["qd"][0]
        arm.refresh(velocity_terms=True)
        e["r"], e["v"] = arm.position, arm.jacobian[:3] @ m["qd"][0]
        e["quat"], e["omega"], e["hinge_force"], e["tau_att"] = quat, omega, hinge, tau_att
        e["disturbance"] = disturbance
        r["r"], r["v"], r["a"], r["quat"] = e["r"] + r_e, r_v, r_a, (1.0, 0.0, 0.0, 0.0)
        kept[:] = np.zeros(1, table.kept_layout())
        tick["command"] = np.zeros(1, tick["command"].dtype)
        ahead = r["a"][0] if ahead is None else ahead
        vectors = [np.broadcast_to(np.asarray(v, float), n).copy() for v, n in ((ahead, 3), (mu, 6))]
        evaluate(thrust, *vectors, tick, on_land() if environment is None else environment, arm.state, p, kept, act)
        return SimpleNamespace(
            **{n: tick["command"][n][0].copy() for n in ("force", "delta_tau", "tau", "thrust")},
            v2=tick["proof"]["v2"][0], v2_rate=tick["proof"]["v2_rate"][0], implied=kept["implied"][0].copy(), kept=kept.copy(),
        )  # fmt: skip

    def wrench(found, q=home, qd=None):
        """The wrench (6,) that the torques put on the end effector, from the acceleration that they make."""
        qd = np.zeros(arm.joints) if qd is None else qd
        return np.linalg.solve(
            dynamics.mobility(q),
            dynamics.acceleration(q, qd, found.tau) - dynamics.acceleration(q, qd, dynamics.gravity(q)),
        )

    return SimpleNamespace(run=run, wrench=wrench, arm=arm, home=home, R_d=R_d, uav=uav, gains=gains, act=act)


@pytest.fixture(scope="session")
def states(bench):
    rng = np.random.default_rng(12)
    return [(bench.home + rng.normal(scale=0.05, size=7), rng.normal(scale=0.1, size=7)) for _ in range(10)]
