"""The 3D scene of a flight, posed from the ticks of its log."""
