"""The cases in which the proof is run on the subsystem: law, kinematics, random states to start from, and what came of them."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.control.laws.attitude import QuaternionPdGains
from armland.control.laws.rigid_body import BacksteppingGains, check
from armland.experiments.paper import Progress, silent
from armland.experiments.proof.jumps import across
from armland.experiments.proof.lyapunov_rate import rate_gaps
from armland.experiments.proof.paths import NEAR_M, SUMMARY, survey_paths
from armland.experiments.proof.subsystem import PROBLEM, Setting
from armland.models.parameters import uav_parameters
from armland.models.uav import UavParameters
from armland.plant.noise import stream
from armland.rotations import Array
from armland.scenario import Scenario

TOLERANCE = 1e-6  # Error that the integrator allows itself per step, relative and in SI units

HORIZON_S = 10.0

OMEGA, DISTANCE, SPEED, PLACE = 20.0, 0.3, 2.0, 0.5
"""Starts are uniform within ± these on each axis: rad/s; m from r_d; m/s; m of r_d. Attitudes are uniform on the sphere."""

SWING_M, SWING_RAD, PULSATION = 0.15, 0.5, (0.5, 3.0)
"""Largest amplitudes of a moving reference, m and rad, and the range of its pulsations, rad/s."""


CHUNK = 250  # Paths between two reports of progress


class Kind(NamedTuple):
    """What makes a case."""

    title: str
    exact: bool  # Law (X.1); else law (29) of the paper
    lever_moves: bool  # True kinematics, or the paper's ṙ = v
    swings: bool  # Whether the reference moves
    proven: bool  # Whether (30) is said to hold


CASES = {
    "paper": Kind("(29), paper's kinematics", False, False, False, True),
    "paper_true": Kind("(29), true kinematics", False, True, False, False),
    "exact": Kind("(X.1), true kinematics, moving reference", True, True, True, True),
}
"""(29) where the paper proves it; where nobody does; (X.1) where its own proof says that (30) holds."""


@dataclass(frozen=True)
class Case:
    """What came of one case of the subsystem, from k starts."""

    kind: Kind
    setting: Setting
    problems: NDArray[np.void]
    paths: NDArray[np.void]  # of `SUMMARY`
    gaps: Array  # (2k,) between V̇₂ and (30), relative; of `rate_gaps`, at the starts and along the paths
    jump_v2: Array  # (k,) jump of V₂ at η_e = 0 from random states, relative
    jump_torque: Array  # (k,) N·m, of Δτ_att there
    jump_force: Array  # (k,) N, of F_EE there

    def figures(self) -> dict[str, Any]:
        """The case in numbers."""
        p, eta = self.paths, np.einsum("ki,ki->k", self.problems["start"][:, :4], self.problems["q_d"])
        return {
            "title": self.kind.title,
            "states": len(p),
            "negative_eta_starts": int(np.sum(eta < 0.0)),
            "rates_checked": int(np.isfinite(self.gaps).sum()),
            "rate_gap_largest": float(np.nanmax(self.gaps)),
            "rate_gap_median": float(np.nanmedian(self.gaps)),
            "v2_rise_largest": float(p["rise"].max()),
            "paths_rising": int(np.sum(p["rise"] > TOLERANCE)),
            "not_arrived": int(np.isnan(p["arrived"]).sum()),
            "followed_longest_s": float(p["end"].max()),
            "settled_s": _spread(p["settled"]),
            "arrived_s": _spread(p["arrived"]),
            "sign_changes": int(p["jumps"].sum()),
            "sign_changes_per_path_largest": int(p["jumps"].max()),
            "sign_changes_raising_v2": int(np.sum(p["jump_rise"] > 0.0)),
            "jump_v2_largest": float(self.jump_v2.max()),
            "jump_v2_rising_share": float(np.mean(self.jump_v2 > 0.0)),
            "jump_torque_nm": _spread(self.jump_torque),
            "jump_force_n": _spread(self.jump_force),
        }


def run_case(kind: Kind, scenario: Scenario, count: int, progress: Progress = silent) -> Case:
    """Follow `count` paths of a case and check V̇₂ at their starts and along them.

    Raises:
        ConfigurationError: gains or UAV parameters for which the proof does not hold.
    """
    setting, problems = setting_of(kind, scenario), draw(kind, scenario, count)
    paths = np.zeros(count, SUMMARY)
    for k in range(0, count, CHUNK):
        survey_paths(problems[k : k + CHUNK], setting, paths[k : k + CHUNK])
        progress(kind.title, min(k + CHUNK, count), count)
    starts = rate_gaps(problems, np.zeros(count), problems["start"], setting)
    along = rate_gaps(problems, paths["visited_t"], paths["visited"], setting)
    return Case(kind, setting, problems, paths, np.concatenate([starts, along]), *across(problems, setting))


def parts(scenario: Scenario) -> tuple[UavParameters, BacksteppingGains, QuaternionPdGains]:
    """The UAV that the law believes in, the law's gains and those of the UAV's own attitude controller.

    Raises:
        ConfigurationError: gains or UAV parameters for which the proof does not hold.
    """
    c, onboard, uav = scenario.control, scenario.onboard, uav_parameters(scenario.believed())
    gains = BacksteppingGains(np.array(c.k1), np.array(c.k2), c.k3)
    check(uav, gains)
    return uav, gains, QuaternionPdGains(np.array(onboard.kp_nm), np.array(onboard.kd_nms))


def setting_of(kind: Kind, scenario: Scenario) -> Setting:
    """The setting of a case with the scenario's UAV and gains.

    Raises:
        ConfigurationError: gains or UAV parameters for which the proof does not hold.
    """
    uav, gains, onboard = parts(scenario)
    return Setting(
        exact=kind.exact,
        lever_moves=kind.lever_moves,
        uav=uav,
        inverse=np.asarray(np.linalg.inv(uav.inertia), dtype=np.float64),
        gains=gains,
        told_uav=uav,
        told_gains=gains,
        onboard=onboard,
        gravity=scenario.environment.gravity_mps2,
        tolerance=TOLERANCE,
        horizon=HORIZON_S,
        # V₂ ≥ k₃/2 |r_e|²: from here on, V₂ itself keeps the pivot at the goal, and the attitude with it.
        enough=0.5 * gains.k3 * NEAR_M**2,
    )


def draw(kind: Kind, scenario: Scenario, count: int) -> NDArray[np.void]:
    """Random problems (count,) of `PROBLEM`, from the scenario's seed. Both signs of η_e come up alike.

    The thrust is anything that the four rotors can give.
    """
    g = stream(scenario.run.seed, "proof")
    p = np.zeros(count, PROBLEM)
    p["q_d"], p["start"][:, :4] = _attitudes(g, count), _attitudes(g, count)
    p["r_d"] = g.uniform(-PLACE, PLACE, (count, 3))
    p["start"][:, 4:7] = g.uniform(-OMEGA, OMEGA, (count, 3))
    p["start"][:, 7:10] = p["r_d"] + g.uniform(-DISTANCE, DISTANCE, (count, 3))
    p["start"][:, 10:] = g.uniform(-SPEED, SPEED, (count, 3))
    p["thrust"] = g.uniform(4.0 * scenario.rotors.min_thrust_n, 4.0 * scenario.rotors.max_thrust_n, count)
    if kind.swings:
        p["amplitude"] = g.uniform(0.0, 1.0, (count, 5)) * np.array([SWING_M] * 3 + [SWING_RAD] * 2)
        p["pulsation"] = g.uniform(*PULSATION, (count, 5))
        p["phase"] = g.uniform(0.0, 2.0 * np.pi, (count, 5))
    return p


def _attitudes(g: np.random.Generator, count: int) -> Array:
    q = g.standard_normal((count, 4))
    return q / np.linalg.norm(q, axis=1)[:, None]


def _spread(values: Array) -> dict[str, float | None]:
    """Smallest, median, 95th percentile and largest of the finite values; None if there are none."""
    finite = values[np.isfinite(values)]
    levels = np.percentile(finite, [0, 50, 95, 100]).tolist() if len(finite) else [None] * 4
    return dict(zip(("smallest", "median", "p95", "largest"), levels, strict=True))
