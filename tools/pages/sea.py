"""The figure of `docs/sea.md`: how the deck of a 4 m hull moves over time, and its spectra beside those of the sea through the hull.

`PYTHONPATH=tools python -m pages.sea [FOLDER]` draws it, into docs/images where FOLDER is absent, and prints significant amplitudes.
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.signal import welch

from armland.plant.sea.hull import MOTIONS, contour
from armland.plant.sea.timed import deck_motion
from armland.rotations import Array
from armland.scenario import Scenario, load_scenario
from armland.view.figures.canvas import PAGE_IN, drawn, sheet

IMAGES = Path(__file__).parents[2] / "docs" / "images"

STATES = ("ss1", "ss2", "ss3", "ss4", "tank")

SHOWN = {"ss2": "#0072B2", "ss3": "#D55E00", "tank": "#009E73"}

SHOWN_S = 40.0

SEAS = 16


def scenario(state: str, **keys: object) -> Scenario:
    """The landing at sea, seed 3."""
    return load_scenario("landing", {"sea": {"state": state, **keys}}).with_seed(3)


def over_time(axes: Axes, motion: int, factor: float, unit: str) -> None:
    """One motion of all that are shown."""
    times = np.arange(0.0, SHOWN_S, 0.02)
    for state, colour in SHOWN.items():
        axes.plot(
            times, factor * deck_motion(scenario(state)).at(times)[:, motion], color=colour, linewidth=0.9, label=state
        )
    axes.set(xlabel="time (s)", ylabel=f"{MOTIONS[motion]} ({unit})", xlim=(0.0, SHOWN_S))


def spectra() -> tuple[Array, Array, Array]:
    """Frequencies (k,), rad/s, Welch's estimate of heave and pitch over several seas, and theory by hand, (k, 2)."""
    rate, found = 4.0, []
    for seed in range(SEAS):
        sea = scenario("ss3", crests="long", towards_deg=180.0).with_seed(seed)
        q = deck_motion(sea).sampled(rate, 0, 20000)[:, [2, 4]]
        frequency, power = welch(q, rate, nperseg=512, axis=0)
        found.append(power)
    omega = 2.0 * np.pi * frequency[1:]
    H = np.abs(contour(omega, np.full_like(omega, np.pi), 4.0, 1.6)[:, [2, 4]]) ** 2
    at = 2.0 * np.pi / 7.5 / omega
    sea = 0.3125 * 0.88**2 * at**4 / omega * np.exp(-1.25 * at**4)
    return omega, np.mean(found, axis=0)[1:] / (2.0 * np.pi), sea[:, None] * H


def page() -> Figure:
    """Heave and roll over time, spectra of heave and pitch."""
    figure = sheet(PAGE_IN, 4.6)
    (a, b), (c, d) = figure.subplots(2, 2)
    over_time(a, 2, 1.0, "m")
    over_time(b, 3, float(np.rad2deg(1.0)), "deg")
    a.legend(loc="upper right", ncols=3)
    omega, power, theory = spectra()
    for axes, name, i, unit in ((c, "heave", 0, "m²·s"), (d, "pitch", 1, "rad²·s")):
        axes.semilogy(omega, power[:, i], color=SHOWN["ss3"], linewidth=0.8)
        axes.semilogy(omega, theory[:, i], color="k", linewidth=1.0, linestyle=(0, (4.0, 2.0)))
        top = 2.0 * theory[:, i].max()
        axes.set(xlabel="frequency (rad/s)", ylabel=f"{name} ({unit})", xlim=(0.3, 5.0), ylim=(1e-4 * top, top))
    return figure


def main(out: Path) -> None:
    """Draw the figure into `out` and print significant single amplitudes, heave in m, angles in degrees."""
    for state in STATES:
        size = deck_motion(scenario(state)).significant()
        print(
            state,
            *(
                f"{n} {s * (1.0 if i < 3 else 180.0 / np.pi):.3f}"
                for i, (n, s) in enumerate(zip(MOTIONS, size, strict=True))
            ),
        )
    for path in drawn(out, {"sea_deck": page}):
        if path.suffix == ".pdf":
            path.unlink()


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else IMAGES)
