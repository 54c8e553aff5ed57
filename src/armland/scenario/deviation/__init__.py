"""How far the plant may differ from what the controller believes: for each device ranges, their sources, and four levels."""

from armland.scenario.deviation.levels import LEVELS, Deviation, Level, Row, ranges, rows
from armland.scenario.deviation.units import unit_of

__all__ = ["LEVELS", "Deviation", "Level", "Row", "ranges", "rows", "unit_of"]
