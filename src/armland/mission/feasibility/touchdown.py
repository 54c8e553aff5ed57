"""How hard a landing touches down by closed forms: how slowly the arm feels for the cradle, so that the magnet holds the plate.

| symbol | name | unit |
|---|---|---|
| Λ (3, 3) | apparent mass of the end effector that does not turn, at the put-down | kg, D |
| k, c | stiffness and damping of all four buffers | N/m, N·s/m |
| v | `control.approach.lower_mps` | m/s |
| F, S | pull at the hinge, and shear, at the touchdown's peak | N |

The arm is what is stopped, its mass on the buffers' springs: F = v √(k Λ_zz) exp(−ζ arccos ζ/√(1 − ζ²)), ζ = c/(2 √(k Λ_zz)),
the first peak of a damped oscillator. The skids' friction holds the pivot where it is, so what slows it down pushes it aside, too:
S = F |(Λ_xz, Λ_yz)|/Λ_zz.

Afterwards the arm gives way by the rate g, m/(s·N), times the hinge's force. It is led by a double pole at ω and rests on a spring k:
s³ + 2ω s² + (ω² + k/Λ) s + g k ω² = 0, by Hurwitz stable where g < 2/(Λ ω) + 2ω/k. Downwards k is that of the buffers; sideways,
where the skids stick to the rails, it is beyond bounds.
"""

from typing import NamedTuple

import numpy as np

from armland.errors import ConfigurationError
from armland.models.airframe.sizing import is_settled
from armland.models.arm import ArmModel
from armland.models.posture import lead
from armland.rotations import Array
from armland.scenario import Scenario

BUFFERS = 4

LOWER_MPS = 0.03
"""Speed at which a well-held plate is lowered: slow enough for the force to be felt before it is large."""

SHARE = 0.8
"""Of the speed that the magnet just bears, what is taken by rule: a plant that differs touches down a quarter harder."""

YIELDING = 0.45
"""Share of the rate at which giving way would swing: the AR.Drone on the LWR takes 0.43 of it."""


class Blow(NamedTuple):
    """Peaks of a touchdown over its speed, N·s/m."""

    pull: float
    shear: float

    def speed(self, rating: float, share: float, shear_share: float) -> float:
        """Largest speed, m/s, at which a magnet of `rating` N holds with `share` of what it can; it holds `shear_share` sideways."""
        return rating / max(self.pull / share, self.shear / (share * shear_share) + self.pull)


def touchdown(scenario: Scenario, apparent: Array) -> Blow:
    """The peaks of a touchdown over its speed.

    Args:
        scenario: believed.
        apparent: Λ (3, 3), kg, D.
    """
    cradle, mass = scenario.cradle, float(apparent[2, 2])
    undamped = np.sqrt(BUFFERS * cradle.stiffness_npm * mass)
    # From the critical damping on the first peak is that of the damper, at once.
    ratio = min(BUFFERS * cradle.damping_nspm / (2.0 * undamped), 0.999)
    pull = undamped * np.exp(-ratio * np.arccos(ratio) / np.sqrt(1.0 - ratio**2))
    return Blow(float(pull), float(pull * np.hypot(apparent[0, 2], apparent[1, 2]) / mass))


def swinging(apparent: Array, stiffness: float, pole: float) -> float:
    """Rate of giving way, m/(s·N), from which on an arm on the cradle swings, in the axis in which it does so first.

    Args:
        apparent: Λ (3, 3), kg, D.
        stiffness: of all buffers, N/m, downwards.
        pole: ω, rad/s, of the free arm.
    """
    spring = np.array([0.0, 0.0, 2.0 * pole / stiffness])
    return float((2.0 / (np.diag(apparent) * pole) + spring).min())


def apparent_mass(arm: ArmModel) -> Array:
    """Λ (3, 3), kg, D, in the arm's present pose: what a force finds that may not turn the end effector."""
    mobility = arm.jacobian @ np.linalg.solve(arm.mass_matrix, arm.jacobian.T)
    return np.asarray(np.linalg.inv(mobility)[:3, :3])


def gently(scenario: Scenario, arm: ArmModel, home: Array) -> Scenario:
    """The scenario with a speed of lowering at which the magnet holds the plate through the touchdown, and a stable way of giving way.

    Args:
        scenario: believed.
        arm: believed; its state is overwritten.
        home: joint positions (n,), rad, from which the put-down is reached.

    Raises:
        ConfigurationError: the speed that was set is too high, with the peaks, and with the rating and the speed that would do.
    """
    magnet, share, asked = scenario.magnet, scenario.limits.hinge_force_share, scenario.control.approach.lower_mps
    arm.update(lead(arm, home, np.array(scenario.place.put_down_m)), np.zeros(arm.joints))
    apparent = apparent_mass(arm)
    blow, scenario = touchdown(scenario, apparent), _yielding(scenario, apparent)
    most = blow.speed(magnet.rating_n, share, magnet.shear_share)
    if asked is None:
        return scenario.replaced({"control": {"approach": {"lower_mps": min(LOWER_MPS, SHARE * most)}}})
    if asked > most:
        raise ConfigurationError(
            f"control.approach.lower_mps = {asked:g}: at the touchdown the arm, stopped by the cradle, would pull at the magnet with "
            f"{asked * blow.pull:.1f} N and shear with {asked * blow.shear:.1f} N; with magnet.rating_n = {magnet.rating_n:g}, "
            f"limits.hinge_force_share = {share:g} and magnet.shear_share = {magnet.shear_share:g} it may be at most {most:.3f} m/s, "
            f"or the rating at least {magnet.rating_n * asked / most:.0f} N"
        )
    return scenario


def _yielding(scenario: Scenario, apparent: Array) -> Scenario:
    approach = scenario.control.approach
    most = YIELDING * swinging(apparent, BUFFERS * scenario.cradle.stiffness_npm, scenario.control.free_rad_s)
    if is_settled(scenario, "control.approach.give_way_mpns") or approach.give_way_mpns <= most:
        return scenario
    return scenario.replaced({"control": {"approach": {"give_way_mpns": most}}})
