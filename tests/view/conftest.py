from collections.abc import Callable

import numpy as np
import pytest

from armland.records import tick_layout

RATE_HZ = 100
SETTLE_S = 0.5


@pytest.fixture(scope="session")
def make_log() -> Callable[..., np.ndarray]:
    """A made-up run of 3 s: rest, one move along all axes from 1.0 s to 2.0 s, rest; the UAV swings about x."""

    def make(swing_deg: float = 5.0, seconds: float = 3.0, offset_mm: float = 2.0) -> np.ndarray:
        time = np.arange(round(seconds * RATE_HZ)) / RATE_HZ
        log = np.zeros(len(time), tick_layout(7))
        path = np.array([0.6, 0.0, 0.7]) + np.clip(time - 1.0, 0.0, 1.0)[:, None] * np.array([0.1, 0.15, -0.06])
        log["reference"]["r"], log["truth"]["r"] = path, path + 1e-3 * offset_mm
        half = 0.5 * np.deg2rad(swing_deg) * np.sin(2.0 * np.pi * time) * (time > SETTLE_S)
        log["reference"]["quat"] = [1.0, 0.0, 0.0, 0.0]
        log["truth"]["quat"][:, 0], log["truth"]["quat"][:, 1] = np.cos(half), np.sin(half)
        log["truth"]["hinge_force"] = np.column_stack([np.sin(time), np.cos(time), 2.3 + 0.1 * np.sin(9.0 * time)])
        log["command"]["delta_tau"] = 0.02 * np.sin(20.0 * time)[:, None]
        log["health"]["torque_ratio"] = 0.3
        return log

    return make
