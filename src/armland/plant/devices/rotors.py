"""The UAV's rotors, and what the air and what no model knows do to it.

| symbol | name | unit, frame |
|---|---|---|
| T_i* | `asked` (8,): thrust that the controller on board asks of each rotor | N |
| g_i | `gain` (8,): thrust given over thrust asked for | 1 |
| T_i | `static` (8,): thrust that each would give at rest, T ← T + α (g h T* − T) with h its health | N |
| α | `lag`: share of a step that a rotor makes in one tick | 1 |
| | `due` (8,): the same where all is well: what each is expected to give | N |
| | `lift` (8,): thrust that each gives, moving through the air, `models.inflow` (I.2) | N |
| c | `drag`: linear, horizontal | N·s/m |
| c_T, T_h | `curve`, `hover`: g grows by c_T (T*/T_h − 1), T_h what each gives in hover | 1, N |
| | `sag`: share of the thrust that the battery loses in a tick | 1 |
| | `force` (3,), `moment` (3,): constant disturbance at the centre of mass | N [W], N·m [B] |
"""

import numpy as np
from numba import njit

from armland.models.airframe.rotor_set import effect_of
from armland.models.inflow import advance_of, disc_of, factor_at_speed
from armland.models.parameters import rotor_set
from armland.plant.scene.composition import Scene
from armland.records import MOST_ROTORS, Record, Records
from armland.rotations import Array, cross, from_rotation_vector, matrix, multiply
from armland.scenario import Scenario


def told_layout(joints: int) -> np.dtype:
    """What the rotors are told."""
    return np.dtype(
        [
            ("count", "i8"),  # number of rotors
            (
                "mixer",
                "f8",
                (4, MOST_ROTORS),
            ),  # [thrust, torque] of the rotors' thrusts, `models.airframe.rotor_set.effect_of`
            ("tilted", "i8"),  # 1 where some rotor does not push along body z
            ("lateral", "f8", (2, MOST_ROTORS)),  # force along body x and y of each one's thrust
            ("place", "f8", (MOST_ROTORS, 3)),  # m, from the centre of mass
            ("axis", "f8", (MOST_ROTORS, 3)),
            ("lag", "f8"),
            ("tick_s", "f8"),
            ("gain", "f8", (MOST_ROTORS,)),
            ("curve", "f8"),
            ("hover", "f8"),
            ("sag", "f8"),
            ("inflow", "i8"),  # 1 where the rotors feel their own motion
            ("disc", "f8"),  # 2ρA of one rotor, kg/m
            ("slope", "f8"),
            ("advance", "f8"),
            ("drag", "f8"),
            ("force", "f8", (3,)),
            ("moment", "f8", (3,)),
        ]
    )


def kept_layout(joints: int) -> np.dtype:
    """What the rotors keep."""
    return np.dtype([(name, "f8", (MOST_ROTORS,)) for name in ("asked", "static", "due", "lift")])


def tell(told: Records, scenario: Scenario, scene: Scene, thrust_factor: float) -> None:
    """Fill `told` (1,); `thrust_factor`, of all rotors, is the ratio of thrust given to thrust asked for."""
    r, rate = scenario.rotors, scenario.run.rate_hz
    own = rotor_set(scenario)
    effect, n = effect_of(own, r.drag_torque_m), own.number
    told["count"], told["tilted"] = n, not own.upright
    told["mixer"][0, :, :n], told["lateral"][0, :, :n] = effect[:4], effect[4:]
    told["place"][0, :n], told["axis"][0, :n] = own.place, own.axis
    told["lag"], told["tick_s"] = 1.0 - np.exp(-1.0 / (rate * r.time_constant_s)), 1.0 / rate
    told["gain"], told["drag"] = thrust_factor, scenario.uav.drag_nspm
    told["hover"] = -scenario.environment.gravity_mps2[2] * scene.uav_mass / n
    told["inflow"], told["slope"] = r.inflow, r.slope
    told["disc"] = disc_of(r.radius_m, scenario.environment.air_density_kgm3)
    told["advance"] = advance_of(r.slope, r.inflow_ratio)
    told["force"], told["moment"] = scenario.disturbance.force_n, scenario.disturbance.torque_nm


@njit(cache=True)
def spin(k: int, told: Record, kept: Record, faults: Record, air: Record, t: Record, applied: Array) -> None:
    """One tick of the rotors.

    The wrench comes from outside (MuJoCo's `xfrc_applied`), because MuJoCo's force sensors do not see actuators that act at a site.

    Args:
        k: present tick.
        told: of `told_layout`.
        kept: of `kept_layout`, updated.
        faults: what fails, of `faults.table.kept_layout`.
        air: what the air does, of `air.kept_layout`.
        t: truth of the present tick.
        applied: (6,) N, N·m, W: wrench on the UAV at its centre of mass, written.
    """
    # The truth is one step old; the attitude now is a step of the angular velocity further.
    turn = np.empty(3)
    for i in range(3):
        turn[i] = t.omega[i] * told.tick_s
    R = matrix(multiply(t.quat, from_rotation_vector(turn)))
    charge = max(1.0 - told.sag * k, 0.0)
    for i in range(told.count):
        kept.due[i] += told.lag * (kept.asked[i] - kept.due[i])
        gain = told.gain[i] * (1.0 + told.curve * (kept.asked[i] / told.hover - 1.0)) * charge
        kept.static[i] += told.lag * (kept.asked[i] * gain * faults.rotor[i] - kept.static[i])
    _move_through_air(R, t, told, kept, air)
    thrust, x, y, z = 0.0, 0.0, 0.0, 0.0
    for i in range(told.count):
        thrust += told.mixer[0, i] * kept.lift[i]
        x += told.mixer[1, i] * kept.lift[i]
        y += told.mixer[2, i] * kept.lift[i]
        z += told.mixer[3, i] * kept.lift[i]
    x, y, z = x + told.moment[0], y + told.moment[1], z + told.moment[2]
    for i in range(3):
        applied[i] = R[i, 2] * thrust + (told.force[i] + faults.force[i])
        if i < 2:
            applied[i] -= told.drag * (t.v_cm[i] - air.velocity[i])
        applied[3 + i] = faults.torque[i] + R[i, 0] * x + R[i, 1] * y + R[i, 2] * z
    if told.tilted:
        for k in range(told.count):
            for i in range(3):
                sideways = R[i, 0] * told.lateral[0, k] + R[i, 1] * told.lateral[1, k]
                applied[i] += sideways * kept.lift[k]


@njit(cache=True)
def _move_through_air(R: Array, t: Record, told: Record, kept: Record, air: Record) -> None:
    # What each rotor gives of its static thrust, by the velocity of its hub through the air and by what is below it.
    if not told.inflow:
        for i in range(told.count):
            kept.lift[i] = kept.static[i] * air.lift
        return
    x, y, z = 0.0, 0.0, 0.0
    for i in range(3):
        v = t.v_cm[i] - air.velocity[i]
        x, y, z = x + R[i, 0] * v, y + R[i, 1] * v, z + R[i, 2] * v
    in_plane = np.sqrt(x * x + y * y)
    for k in range(told.count):
        axial = z + t.omega[0] * told.mixer[1, k] + t.omega[1] * told.mixer[2, k]
        if told.tilted:
            hub = np.array([x, y, z]) + cross(t.omega.copy(), told.place[k].copy())
            axial, square = 0.0, 0.0
            for i in range(3):
                axial += hub[i] * told.axis[k, i]
                square += hub[i] * hub[i]
            in_plane = np.sqrt(max(square - axial * axial, 0.0))
        f = factor_at_speed(kept.static[k], in_plane, axial, told.disc, told.slope, told.advance)
        kept.lift[k] = kept.static[k] * f * air.lift
