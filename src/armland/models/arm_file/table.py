"""The table of an arm's values: what each joint can do, from where it is known, and the stated rules where its file is silent.

| value | where the file says nothing, nothing that can be, or 0 |
|---|---|
| range | ± 2π rad, ± 1 m |
| speed | 2 rad/s, 2.5 rad/s for the last three joints, 0.5 m/s of a slide |
| torque | twice what holds the arm itself and a quarter of its moving mass at the end effector, 0.2 m from the joint at least |
| torque rate | ten times the torque each second, 1000 N·m/s at least (Franka's for all joints; no file says one) |
| friction, damping | none |
| armature | 0.1 kg·m², less for an arm below 5 kg of moving mass, in proportion, to 0.05 |

What holds the arm is the worst over its poses, for whatever direction its base is mounted in.

A limit is never taken as zero or infinite because the file does not name it. Files use 0, 1e4 N·m and more, and speeds below
0.01 or above 50 rad/s as placeholders, and torques that are all 1: those are no limits either.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from armland.errors import ConfigurationError, ModelError
from armland.models.arm_file.chain import Chain
from armland.models.arm_file.tree import DEFAULT, OPTION, RULE, Joint, Value
from armland.rotations import Array

TURN = 2.0 * np.pi
MOST_TURNS_RAD = 2.0 * TURN
"""Beyond two turns each way a range is a slip of units, or the file's word for none."""

ENDLESS_RAD = 1000.0
"""From here on it is the word for none."""

LEAST_SPEED, MOST_SPEED, MOST_TORQUE = 0.01, 50.0, 1e4
SPEED, WRIST_SPEED, SLIDE_SPEED = 2.0, 2.5, 0.5
TORQUE_FACTOR, LOAD_SHARE, LEAST_LEVER_M = 2.0, 0.25, 0.2
RATE, LEAST_RATE = 10.0, 1000.0
ARMATURE, LIGHT_KG, LEAST_ARMATURE = 0.1, 5.0, 0.05

FIELDS = ("low", "high", "speed", "torque", "torque_rate", "friction", "damping", "armature")


class Row(NamedTuple):
    """What one joint can do."""

    name: str
    kind: str  # hinge or slide
    low: Value  # rad or m
    high: Value
    speed: Value  # rad/s or m/s
    torque: Value  # N·m or N
    torque_rate: Value  # N·m/s or N/s
    friction: Value  # N·m or N, Coulomb
    damping: Value  # N·m·s/rad or N·s/m
    armature: Value  # kg·m² or kg, reflected inertia of the motor


def unit(field: str, kind: str) -> str:
    """The unit of a field of `Row`."""
    hinge = {"low": "rad", "high": "rad", "speed": "rad/s", "torque": "N·m", "torque_rate": "N·m/s", "friction": "N·m"}
    slide = {"low": "m", "high": "m", "speed": "m/s", "torque": "N", "torque_rate": "N/s", "friction": "N"}
    rest = {"damping": ("N·m·s/rad", "N·s/m"), "armature": ("kg·m²", "kg")}
    if field in rest:
        return rest[field][kind == "slide"]
    return (slide if kind == "slide" else hinge)[field]


class Asked(NamedTuple):
    """What the user wants of an arm file."""

    ee: str | None = None
    lock: tuple[tuple[str, float], ...] = ()
    torque: tuple[float, ...] | None = None  # N·m
    speed: tuple[float, ...] | None = None  # rad/s
    torque_rate: tuple[float, ...] | None = None  # N·m/s
    armature: float | None = None  # kg·m², where the file has none


def table(chain: Chain, asked: Asked, demand: Callable[[list[Row]], tuple[Array, Array]]) -> list[Row]:
    """A row for each driven joint of `chain`.

    Args:
        chain: from the file.
        asked: what the user says; it counts before the file.
        demand: from rows without torque, what `strength.demand` says, (n,) N·m and (n,) m; called only where a torque is missing.

    Raises:
        ModelError: a range that is reversed or in degrees.
        ConfigurationError: as many values asked for as the arm has joints, but another number.
    """
    joints = chain.joints
    names = [j.name for j in joints]
    torques = _given(asked.torque, "arm.torque_limits_nm", names)
    speeds = _given(asked.speed, "arm.joint_speed_rad_s", names)
    rates = _given(asked.torque_rate, "arm.torque_rate_nm_s", names)
    _check_units(chain)
    rows = []
    for i, j in enumerate(joints):
        low, high = _range(j, chain.what)
        wrist = i >= len(joints) - 3
        torque = torques[i] or _said(j.torque, 0.0, MOST_TORQUE) or Value(0.0, RULE)
        speed = speeds[i] or _said(j.speed, LEAST_SPEED, MOST_SPEED) or _speed(j, wrist)
        nothing = Value(0.0, DEFAULT)
        rate = rates[i] or j.torque_rate or nothing
        armature = _said(j.armature, 0.0, np.inf) or _armature(chain, asked.armature)
        rows.append(
            Row(j.name, j.kind, low, high, speed, torque, rate, j.friction or nothing, j.damping or nothing, armature)
        )
    if _commands(rows):
        # Commands from -1 to 1 are shares of a torque that the file does not say; programs that draw URDF write 1 for all.
        rows = [r._replace(torque=Value(0.0, RULE)) for r in rows]
    if any(r.torque.number == 0.0 for r in rows):
        rows = _with_torque(rows, chain, *demand(rows))
    return [r if r.torque_rate.number else r._replace(torque_rate=_rate(r)) for r in rows]


def _given(values: Sequence[float] | None, path: str, names: list[str]) -> list[Value | None]:
    if values is None:
        return [None] * len(names)
    if len(values) != len(names):
        raise ConfigurationError(
            f"{path} has {len(values)} value{'s' * (len(values) != 1)}; the arm has {len(names)} joints: {', '.join(names)}"
        )
    return [Value(float(v), OPTION) for v in values]


def _said(value: Value | None, low: float, high: float) -> Value | None:
    return value if value is not None and low < value.number < high else None


def _check_units(chain: Chain) -> None:
    # One endless joint is usual; several beyond two turns are degrees.
    ends = {
        j.name: max(abs(e.number) for e in (j.low, j.high) if e) for j in chain.joints if j.kind == "hinge" and j.low
    }
    large = {n: e for n, e in ends.items() if MOST_TURNS_RAD < e <= 720.0}
    if len(large) >= 2:
        name, end = next(iter(large.items()))
        raise ModelError(
            f"{chain.what}: the range of joint {name!r} reaches {end:g} rad, {end / TURN:.0f} turns, as that of {len(large)} of "
            f"{len(ends)} joints does: they look like degrees; {end:g}° are {np.deg2rad(end):.4f} rad"
            + (
                ", and URDF counts in rad"
                if chain.form == "URDF"
                else '; <compiler angle="degree"/> says that they are'
            )
        )


def _range(j: Joint, what: str) -> tuple[Value, Value]:
    most = TURN if j.kind == "hinge" else 1.0
    free = Value(-most, RULE), Value(most, RULE)
    if j.low is None or j.high is None:
        return free
    low, high = j.low.number, j.high.number
    if low > high:
        raise ModelError(
            f"{what}: the range of joint {j.name!r} is reversed: its lower end {low:g} lies above its upper end {high:g}"
        )
    if low == high or max(abs(low), abs(high)) > (MOST_TURNS_RAD if j.kind == "hinge" else ENDLESS_RAD):
        return free
    return j.low, j.high


def _speed(j: Joint, wrist: bool) -> Value:
    return Value(SLIDE_SPEED if j.kind == "slide" else WRIST_SPEED if wrist else SPEED, RULE)


def moving_mass(chain: Chain) -> float:
    """Mass of all links that move, kg."""
    return sum(link.inertial.mass for link in chain.links[1:] if link.inertial is not None)


def _armature(chain: Chain, asked: float | None) -> Value:
    if asked is not None:
        return Value(asked, OPTION)
    return Value(max(ARMATURE * min(moving_mass(chain) / LIGHT_KG, 1.0), LEAST_ARMATURE), RULE)


def _commands(rows: list[Row]) -> bool:
    return all(r.torque.number == 1.0 and r.torque.source != OPTION for r in rows)


def _with_torque(rows: list[Row], chain: Chain, own: Array, lever: Array) -> list[Row]:
    load = LOAD_SHARE * moving_mass(chain) * 9.81
    needed = TORQUE_FACTOR * (own + load * np.maximum(lever, LEAST_LEVER_M))
    # Two digits: a rule is no measurement.
    shown = [float(f"{x:.2g}") for x in needed]
    return [r if r.torque.number else r._replace(torque=Value(x, RULE)) for r, x in zip(rows, shown, strict=True)]


def _rate(r: Row) -> Value:
    return Value(max(RATE * r.torque.number, LEAST_RATE), RULE)
