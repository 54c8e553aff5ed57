"""armland simulates, proves, flies and judges the landing of a VTOL UAV that a robot arm catches and puts down."""

from importlib.metadata import version

__version__ = version("armland")
