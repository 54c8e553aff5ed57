"""Figures of a recorded mission by what really happened, in groups; None where a mission never came to it."""

from collections.abc import Callable
from dataclasses import asdict, fields
from typing import Any

import numpy as np

from armland.experiments.judge.brief import Brief, Ticks
from armland.experiments.judge.limits import FALL_M
from armland.experiments.judge.tracking import Metrics, measure
from armland.experiments.judge.whereabouts import least, tilt_deg

Figures = dict[str, Any]

CRADLE_N, CRADLE_SHARE = (
    0.2,
    0.04,
)  # Force on the rails that counts as a touchdown, or share of the weight where that is less
APART_S = 0.5  # Pads that touch again within this time bounce: it is the same capture
DROP_S = 2.0  # For how long after the release the pivot's lowest point is looked for


def capture(ticks: Ticks, brief: Brief) -> Figures:
    """State just before pads touched for the last time while the UAV flew."""
    truth = ticks["truth"]
    high = truth["r"][1:, 2] > truth["r"][-1, 2] + 0.02
    found = np.flatnonzero((truth["touching"][1:] > 0) & (truth["touching"][:-1] == 0) & high)
    if not len(found):
        return dict.fromkeys(("offset_m", "relative_speed_mps", "tilt_deg"))
    breaks = np.flatnonzero(np.diff(found) >= APART_S * brief.rate_hz)
    first = int(found[breaks[-1] + 1] if len(breaks) else found[0])
    t, before = truth[first], truth[max(first - 2, 0)]
    return {
        "offset_m": float(np.hypot(*(t["r"] - t["ee"])[:2])),
        "relative_speed_mps": float(np.linalg.norm(before["v"] - before["ee_v"])),
        "tilt_deg": float(tilt_deg(t["plate_quat"])),
    }


def touchdown(ticks: Ticks, brief: Brief) -> Figures:
    """State just before the rails first bore in a phase of the touchdown, and how far from the cradle's middle the UAV was placed."""
    truth = ticks["truth"]
    due = np.array([name in brief.on_cradle for name in brief.phases])[ticks["mission"]["phase"]]
    touched = np.flatnonzero((truth["cradle_force"][:, 2] > least(CRADLE_N, CRADLE_SHARE, brief)) & due)
    if not len(touched):
        return dict.fromkeys(("speed_mps", "tilt_deg", "offset_m"))
    before = truth[max(touched[0] - 2, 0)]
    return {
        "speed_mps": float(np.linalg.norm(before["v"])),
        "tilt_deg": float(tilt_deg(before["quat"])),
        "offset_m": float(np.hypot(*(truth["r"][-1] - brief.put_down)[:2])),
    }


def rest(ticks: Ticks, brief: Brief) -> Figures:
    """Speed at the end, and how many pads still touch."""
    truth = ticks["truth"][-1]
    return {"speed_mps": float(np.linalg.norm(truth["v"])), "touching": float(truth["touching"])}


def release(ticks: Ticks, brief: Brief) -> Figures:
    """Hinge force when the magnet was switched off, speed when the plate came off, and how far the UAV dropped after it."""
    truth = ticks["truth"]
    left = np.flatnonzero((truth["touching"][:-1] > 0) & (truth["touching"][1:] == 0))
    if not len(left) or truth["touching"][-1]:
        return dict.fromkeys(("hinge_force_n", "speed_mps", "drop_m"))
    free = int(left[-1]) + 1
    off = int(np.flatnonzero(ticks["command"]["magnet"][:free])[-1])
    height = truth["r"][:, 2]
    return {
        "hinge_force_n": float(np.linalg.norm(truth["hinge_force"][off])),
        "speed_mps": float(np.linalg.norm(truth["v"][free])),
        "drop_m": float(height[free] - height[free : free + round(DROP_S * brief.rate_hz)].min()),
    }


def steady(ticks: Ticks, brief: Brief) -> Figures:
    """Largest speed beyond the one that the UAV was given, and largest tilt, in the last half second."""
    late = ticks["truth"][-brief.rate_hz // 2 :]
    v = late["v"] - [*brief.given[:2], 0.0]
    return {"speed_mps": float(np.linalg.norm(v, axis=1).max()), "tilt_deg": float(tilt_deg(late["quat"]).max())}


def tracking(ticks: Ticks, brief: Brief) -> Figures:
    """Truth against reference along the path, see `tracking.Metrics`; a record that ends before the path begins has none."""
    if len(ticks["truth"]) <= round(brief.legs[0].start_s * brief.rate_hz):
        return dict.fromkeys(f.name for f in fields(Metrics))
    return asdict(measure(ticks, brief.legs, brief.rate_hz))


MEASURES: dict[str, Callable[[Ticks, Brief], Figures]] = {
    "capture": capture,
    "touchdown": touchdown,
    "rest": rest,
    "release": release,
    "steady": steady,
    "tracking": tracking,
}
"""Groups of figures."""


def bounds(brief: Brief) -> dict[str, float]:
    """Largest allowed values of the figures of a flight, by where they stand in its result."""
    out = {NAMES.get(c.name, c.name): c.bound for c in brief.criteria}
    if "hinge_max" in brief.limits:
        out["hinge_force_max_n"] = float(brief.limits["hinge_max"])
    if brief.hold is not None:
        out |= {"magnet_pull_max_n": brief.hold.share * brief.hold.rating_n, "magnet_shear_max_ratio": brief.hold.share}
        out["fall_m"] = FALL_M
    return out | ({"joint_torque_max_ratio": 1.0} if "tau_max" in brief.limits else {})


NAMES = {
    "touchdown_speed": "touchdown.speed_mps",
    "touchdown_tilt": "touchdown.tilt_deg",
    "placed": "touchdown.offset_m",
    "rest": "rest.speed_mps",
    "touching": "rest.touching",
    "flying_speed": "steady.speed_mps",
    "flying_tilt": "steady.tilt_deg",
    "attitude_max": "tracking.attitude_max_deg",
}
"""Name of a mission's criterion -> group and figure; a criterion may also name them itself."""
