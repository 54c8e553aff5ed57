"""The platform's own controller and legs, from the motion reference on the hull to the pose that the scene is given; compiled.

| symbol | name | unit |
|---|---|---|
| l, l̇ | `length`, `speed` (6,) of the legs | m, m/s |
| x | `pose` (3, 6): of the tick before, of this one, of the next | m, rad |

Speeds and accelerations of the scene's joints are the differences that lead from pose to pose, as the deck's are.
"""

import numpy as np
from numba import njit

from armland.control.laws.unaided.compensation import follow_length, wanted
from armland.estimation import deck as known
from armland.models.environment import environment_layout
from armland.models.unaided.hexapod import leg_rates, legs, pose
from armland.plant.scene.composition import Scene
from armland.plant.scene.deck import INERTIA
from armland.plant.scene.platform import JOINTS, geometry
from armland.plant.sea import deck, reference
from armland.records import Record, Records
from armland.rotations import Array, from_rotation_vector, matrix, multiply, turned
from armland.scenario import Scenario

HULL = np.dtype([("deck_quat", "f8", (4,)), *((f"deck_{name}", "f8", (3,)) for name in ("omega", "v", "a"))])
"""Truth of the hull, as the motion reference samples it."""

SEEN = np.dtype(
    [
        ("tick", "i8"),
        ("deck_known", "i8"),
        ("deck_tick", "i8"),
        ("deck_quat", "f8", (4,)),
        *((f"deck_{name}", "f8", (3,)) for name in ("rate", "v", "a")),
    ]
)
"""What it says."""


def layout() -> np.dtype:
    """What the platform is told and keeps."""
    three = [(name, "f8", (3,)) for name in ("middle", "moved")]
    six = [(name, "f8", (6,)) for name in ("length", "speed")]
    return np.dtype(
        [
            ("fitted", "i8"),
            ("joints", deck.told_layout(0)),
            ("reference", reference.told_layout(0)),
            ("samples", reference.kept_layout(0)),
            ("hull", HULL),
            ("seen", SEEN),
            ("feet", "f8", (6, 3)),
            ("heads", "f8", (6, 3)),
            ("limits", "f8", (5,)),
            ("times", "f8", (3,)),
            ("pose", "f8", (3, 6)),
            *three,
            *six,
            ("filter", known.told_layout()),
            ("tracked", known.kept_layout()),
            ("environment", environment_layout()),
            ("gravity", "f8", (3,)),
        ]
    )


def tell(told: Records, scenario: Scenario, scene: Scene, like: Records) -> None:
    """Fill `told` (1,) of `layout`; its motion reference is as good as `like` (1,), of `reference.told_layout`."""
    h, model = scenario.hexapod, scene.model
    first = model.joint(JOINTS[0]).id
    told["fitted"], told["reference"] = 1, like
    joints = told["joints"]
    joints["moves"], joints["inertia"] = 1, INERTIA
    joints["qpos"], joints["dof"] = model.jnt_qposadr[first], model.jnt_dofadr[first]
    told["middle"], told["feet"], told["heads"] = geometry(scenario)
    neutral = legs(np.zeros(6), told["middle"][0], told["feet"][0], told["heads"][0])
    low, high = neutral.min() - 0.5 * h.stroke_m, neutral.max() + 0.5 * h.stroke_m
    told["limits"] = low, high, h.speed_mps, h.acceleration_mps2, h.servo_rad_s
    told["times"] = 1.0 / scenario.run.rate_hz, h.fade_s, h.travel_m
    told["filter"], told["gravity"] = known.told(scenario), scenario.environment.gravity_mps2


def forget(kept: Records) -> None:
    """Put the platform of `kept` (1,) to its neutral pose at rest."""
    for name in ("moved", "speed", "pose", "samples", "seen", "tracked", "environment"):
        kept[name] = np.zeros_like(kept[name])
    zero = np.zeros(6)
    kept["length"] = legs(zero, kept["middle"][0], kept["feet"][0], kept["heads"][0])


@njit(cache=True)
def compensate(
    k: int, p: Record, row: Array, noise: Array, qpos: Array, qvel: Array, applied: Array, bias: Array
) -> None:
    """One tick of the platform.

    Args:
        k: present tick.
        p: of `layout`, updated.
        row: of the hull (18,), as `sea.deck.move` takes it, m, rad, per s and s².
        noise: standard normal numbers (12,) of its motion reference.
        qpos: MuJoCo's (nq,), m, rad, written.
        qvel: MuJoCo's (nv,), m/s, rad/s, written.
        applied: MuJoCo's `qfrc_applied` (nv,), N, N·m, written.
        bias: MuJoCo's `qfrc_bias` (nv,), N, N·m.
    """
    _see(row, p.hull)
    reference.sample(k, p.reference, p.samples, noise, p.seen, p.hull)
    tick_s, middle = p.times[0], p.middle.copy()
    moved, times = p.moved.copy(), (p.times[0], p.times[1], p.times[2])
    p.seen.tick = k
    known.know_deck(p.seen, p.gravity, tick_s, p.filter, p.tracked, p.environment)
    hull = p.environment
    x_d, rate_d = wanted(hull.base_quat.copy(), hull.base_omega.copy(), hull.base_v.copy(), middle, moved, times)
    feet, heads, limits = p.feet.copy(), p.heads.copy(), p.limits.copy()
    asked, rates = legs(x_d, middle, feet, heads), leg_rates(x_d, middle, feet, heads)
    for i in range(6):
        rate = 0.0
        for j in range(6):
            rate += rates[i, j] * rate_d[j]
        held = min(max(asked[i], limits[0]), limits[1])
        p.speed[i] = follow_length(p.length[i], p.speed[i], held, rate, limits, tick_s)
        p.length[i] += p.speed[i] * tick_s
    for i in range(3):
        p.moved[i] = moved[i]
    last = p.pose[2].copy()
    coming = pose(p.length.copy(), last, middle, feet, heads)
    out = np.empty(18)
    for i in range(6):
        p.pose[0, i], p.pose[1, i], p.pose[2, i] = p.pose[1, i], p.pose[2, i], coming[i]
        now, after = (p.pose[1, i] - p.pose[0, i]) / tick_s, (p.pose[2, i] - p.pose[1, i]) / tick_s
        out[i], out[6 + i], out[12 + i] = p.pose[1, i], now, (after - now) / tick_s
    deck.move(p.joints, out, qpos, qvel, applied, bias)


@njit(cache=True)
def _see(row: Array, hull: Record) -> None:
    # Attitude Rz Ry Rx, rate, velocity and acceleration of the hull.
    quat = np.array([1.0, 0.0, 0.0, 0.0])
    omega, axis = np.zeros(3), np.zeros(3)
    for i in range(3):
        axis[:] = 0.0
        axis[2 - i] = 1.0
        along = turned(matrix(quat), axis)
        for j in range(3):
            omega[j] += along[j] * row[9 + i]
        quat = multiply(quat, from_rotation_vector(axis * row[3 + i]))
    for i in range(4):
        hull.deck_quat[i] = quat[i]
    for i in range(3):
        hull.deck_omega[i], hull.deck_v[i], hull.deck_a[i] = omega[i], row[6 + i], row[12 + i]
