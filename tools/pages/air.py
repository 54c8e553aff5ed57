"""The figure of `docs/air.md`: turbulence as the plant makes it beside the published spectra.

`PYTHONPATH=tools python -m pages.air [FOLDER]` draws it, into docs/images where FOLDER is absent, and prints how far each band is off.
"""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numba import njit
from scipy.signal import welch

from armland.plant.devices.air import blow, kept_layout, tell_wind, told_layout
from armland.plant.faults import table as faults
from armland.plant.noise import stream
from armland.records import Records, layout
from armland.rotations import Array
from armland.scenario import Scenario, load_scenario
from armland.view.figures.canvas import PAGE_IN, drawn, sheet

IMAGES = Path(__file__).parents[2] / "docs" / "images"

NAMES = ("along the mean wind", "across it", "upwards")

WIND = {"wind_mps": 8.0, "turbulence": "by_wind", "towards_deg": 0.0}

SEGMENT_S, SEGMENTS = 100, 400

BANDS_HZ = (0.05, 0.2, 0.4, 0.8, 1.6, 3.2, 6.0)


def spectra(scenario: Scenario) -> tuple[Array, Array, Array]:
    """Frequencies (k,) Hz, Welch's estimate of the turbulence and the published spectra, (k, 3) (m/s)²/Hz."""
    told, kept = np.zeros(1, told_layout(7)), np.zeros(1, kept_layout(7))
    tell_wind(told, scenario)
    told["speed"] = 0.0
    rate, fails, truth = scenario.run.rate_hz, np.zeros(1, faults.kept_layout(7)), np.zeros(1, layout("truth", 7))
    generator, power = stream(scenario.run.seed, "turbulence"), 0.0
    for _ in range(SEGMENTS // 10):
        wind = np.empty((10 * SEGMENT_S * rate, 3))
        _blow(told, kept, fails, truth, generator.standard_normal((len(wind), 5)), wind)
        frequency, found = welch(wind, rate, nperseg=SEGMENT_S * rate, axis=0, detrend=False)
        power = power + found * 10 / SEGMENTS
    return frequency[1:], np.asarray(power)[1:], published(frequency[1:], 4.80)


@njit
def _blow(told: Records, kept: Records, fails: Records, truth: Records, fresh: Array, out: Array) -> None:
    calm = np.zeros(3)
    for k in range(len(fresh)):
        blow(told[0], kept[0], fails[0], (calm, fresh[k], calm), truth[0])
        out[k] = kept[0].velocity


def published(frequency: Array, speed: float) -> Array:
    """Spectra (k, 3), (m/s)²/Hz, of MIL-F-8785C at 10 ft and W20 = 8 m/s, by hand, as a field at `speed` m/s sees them pass."""
    sigma, lengths = np.array([1.570, 1.570, 0.8]), np.array([23.05, 23.05, 3.048])
    x = (2.0 * np.pi * frequency[:, None] * lengths / speed) ** 2
    shape = (1.0 + np.array([0.0, 3.0, 3.0]) * x) / (1.0 + x) ** np.array([1.0, 2.0, 2.0])
    return np.array([4.0, 2.0, 2.0]) * sigma**2 * lengths / speed * shape


def page(frequency: Array, power: Array, theory: Array) -> Figure:
    """One panel for each component."""
    figure = sheet(PAGE_IN, 2.4)
    for axes, name, found, wanted in zip(figure.subplots(1, 3, sharey=True), NAMES, power.T, theory.T, strict=True):
        axes.loglog(frequency, found, color="#0072B2", linewidth=0.7)
        axes.loglog(frequency, wanted, color="k", linewidth=1.0, linestyle=(0, (4.0, 2.0)))
        axes.set(xlabel="frequency (Hz)", title=name, xlim=(0.01, 10.0), ylim=(1e-4, 50.0))
    figure.axes[0].set_ylabel("(m/s)²/Hz")
    return figure


def main(out: Path) -> None:
    """Draw the figure into `out` and print the bands."""
    frequency, power, theory = spectra(load_scenario("landing", {"air": WIND, "run": {"rate_hz": 200}}))
    for low, high in pairwise(BANDS_HZ):
        band = (frequency >= low) & (frequency < high)
        ratio = (power[band] / theory[band]).mean(axis=0)
        print(f"{low:g} to {high:g} Hz: {', '.join(f'{100.0 * (r - 1.0):+.1f} %' for r in ratio)}")
    for path in drawn(out, {"air_spectrum": lambda: page(frequency, power, theory)}):
        if path.suffix == ".pdf":
            path.unlink()


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else IMAGES)
