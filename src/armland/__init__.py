"""armland simulates, proves, flies and judges the landing of a VTOL UAV that a robot arm catches and puts down."""

from importlib.metadata import version

from armland.compiled import drop_stale

__version__ = version("armland")

# Before anything compiled is imported.
drop_stale()
