"""What the attribution of V₂'s rate comes to: figures for the table, and channels as a file."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from armland.experiments.proof.attribution import CHANNELS, TERMS

NOTICEABLE_W = 1e-3
"""V₂ counts as rising if faster than this: with the arm at rest in E1, the sensors' noise makes less."""


def ledger(channels: NDArray[np.void]) -> dict[str, Any]:
    """Figures of `channels` (k,) of `CHANNELS`: how often and how fast V₂ rises, and what each term feeds it.

    `power_rms_w` is over all ticks, `power_rising_w` the mean over those in which V₂ rises noticeably: there (30), the
    terms and the remainder add up to the mean rate of rise. `closure` is the remainder's RMS over that of the measured rate.
    """
    measured = channels["measured"]
    rising = measured > NOTICEABLE_W
    kinds = ("measured", "law", *TERMS, "remainder")
    rms = {name: float(np.sqrt(np.mean(channels[name] ** 2))) for name in kinds}
    mean = {name: float(channels[name][rising].mean()) if rising.any() else 0.0 for name in kinds}
    return {
        "rising_share": float(rising.mean()),
        "largest_rise_w": float(measured.max()),
        "v2_largest_j": float(channels["v2"].max()),
        "power_rms_w": rms,
        "power_rising_w": mean,
        "closure": rms["remainder"] / rms["measured"] if rms["measured"] else 0.0,
    }


def save_channels(channels: NDArray[np.void], path: Path) -> Path:
    """Write `channels` (k,) of `CHANNELS` as CSV with a header that names units; PlotJuggler opens it. Returns `path`."""
    units = {"t": "s", "v2": "N·m"}
    header = ",".join(f"{name} [{units.get(name, 'W')}]" for name in CHANNELS.names or ())
    np.savetxt(path, channels, fmt="%.9g", delimiter=",", header=header, comments="", encoding="utf-8")
    return path
