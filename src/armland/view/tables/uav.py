"""A UAV on the terminal: each value with its source, what the UAV can do, what it needs, and what is suspicious."""

from typing import Any

from rich.text import Text

from armland.models.airframe.survey import SPEED_MPS, UavSurvey
from armland.models.airframe.table import UavRow
from armland.view.tables.verdicts import print_lines, terminal, titled


def uav_data(rows: list[UavRow], found: UavSurvey, notes: list[str], odd: list[str]) -> dict[str, Any]:
    """The same as plain data."""
    values = {row.key: {"value": row.value, "unit": row.unit, "source": row.source} for row in rows}
    return {"values": values, "survey": found._asdict(), "notes": notes, "suspicious": odd}


def print_uav(rows: list[UavRow], found: UavSurvey, notes: list[str], odd: list[str]) -> None:
    """Print it."""
    console = terminal()
    table = titled("UAV", "key", "value", "unit", "source")
    # A key that is cut off can be neither looked up nor set.
    table.columns[0].no_wrap = True
    for row in rows:
        table.add_row(Text(row.key), Text(_value(row.value)), Text(row.unit), Text(row.source))
    console.print(table)
    lines = [
        f"weighs {found.weight:.3g} N with plate and load; its rotors lift {found.thrust:.3g} N: hover takes {found.hover_share:.2f}",
        f"tilts by up to {found.tilt_deg:.0f}° without sinking; {SPEED_MPS:g} m/s through the air take {found.lean_deg:.0f}°",
        f"can carry {found.carries:.3g} kg more"
        if found.carries > 0.0
        else f"is {-found.carries:.3g} kg too heavy to fly",
        f"needs a magnet rated {found.magnet:.3g} N or more, and an arm that holds {found.payload:.3g} kg beside the tool",
    ]
    print_lines(console, lines, notes, odd)


def _value(value: Any) -> str:
    if isinstance(value, list):
        return ", ".join(f"({_value(v)})" if isinstance(v, list) else _value(v) for v in value)
    return f"{value:.4g}" if isinstance(value, float) else str(value)
