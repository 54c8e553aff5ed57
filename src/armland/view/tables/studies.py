"""What the capture envelope looks like on the terminal."""

from pathlib import Path

from rich.table import Table
from rich.text import Text

from armland.experiments.envelope.study import UNITS, EnvelopeStudy, shown
from armland.experiments.takeoff_weight.study import TakeoffWeight
from armland.view.tables.verdicts import mark, terminal, titled

SCALES = {"m": (1e3, "mm"), "m/s": (1.0, "m/s"), "deg": (1.0, "°")}  # Factor and unit in which values are shown

LABELS = {
    "offset": "offset",
    "speed": "lateral speed",
    "tilt": "tilt of the UAV",
    "plate": "tilt of the plate",
    "fastest": "closing speed, highest",
    "slowest": "closing speed, lowest",
}


def print_envelope(found: EnvelopeStudy, out: Path) -> None:
    """Print verdict, thresholds, bounds, the moving plate, and where the rest is."""
    console = terminal()
    if found.holds:
        console.print("[bold green]holds[/]: every threshold of the mission lies inside the capture envelope")
    for line in found.outside:
        console.print(Text.from_markup("[bold red]fails[/]: ").append(line))
    for table in envelope_tables(found):
        console.print(table)
    console.print(corners_in_words(found))
    console.print(f"The data is in {out}/", markup=False)


def envelope_tables(found: EnvelopeStudy) -> list[Table]:
    """The mission's thresholds, the bounds, and the moving plate."""
    return [_thresholds(found), _bounds(found), _interception(found)]


def corners_in_words(found: EnvelopeStudy) -> str:
    """How many captures hold at all thresholds at once, and how much was tried."""
    return (
        f"All thresholds at once: {found.corners_held} of {len(found.corners)} captures hold. "
        f"{found.captures} captures, {len(found.flown)} landings."
    )


def _cell(value: float, unit: str) -> str:
    scale, name = SCALES[unit]
    return f"{scale * value:.3g} {name}"


def _thresholds(found: EnvelopeStudy) -> Table:
    title = "Thresholds of the mission, the others at theirs"
    table = titled(title, "", "threshold", "bound", "closed form", "margin", "", left=(0, 5))
    for m in found.margins:
        cells = (_cell(x, m.unit) for x in (m.value, m.bound, m.closed_form, m.margin))
        table.add_row(Text(m.threshold), *cells, mark(m.holds))
    return table


def _bounds(found: EnvelopeStudy) -> Table:
    title = "Bounds, everything else as in flight"
    table = titled(title, "", "bound", "closed form", "flown, worst", "what fails beyond", left=(0, 4))
    for a in found.axes:
        unit = UNITS[a.name]
        key = "closing" if a.name in ("fastest", "slowest") else a.name
        values = [getattr(f, key) for f in found.flown]
        most = "-" if not values else _cell(min(values) if a.name == "slowest" else max(values), unit)
        cells = (_cell(shown(a.name, x), unit) for x in (a.bound.bound, a.closed))
        table.add_row(Text(LABELS[a.name]), *cells, most, Text(a.bound.why))
    return table


def _interception(found: EnvelopeStudy) -> Table:
    title = "Largest swing of the plate that the arm matches"
    table = titled(title, "frequency", "fraction missed", "amplitude", "cut by", left=(0, 3))
    for t in found.tracked:
        table.add_row(f"{t.frequency:g} Hz", f"{t.missed:.2f}", f"{1e3 * t.amplitude:.3g} mm", t.limit)
    return table


def print_takeoff_weight(found: TakeoffWeight, out: Path) -> None:
    """Print theory beside flights, the verdict, and where the rest is."""
    console = terminal()
    table = titled("Take-off weight over the static thrust", "speed given", "[m/s]", "theory", "flown")
    for x in found.flights:
        table.add_row(x.name, f"{x.speed_mps:.2f}", f"{x.theory:.4f}", f"{x.flown:.4f} ± {x.half_width:.4f}")
    if found.flights:
        console.print(table)
    console.print(found.verdict, markup=False)
    console.print(f"The data is in {out}/", markup=False)
