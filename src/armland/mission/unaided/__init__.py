"""Landings without an arm: the controller of a UAV that comes down by itself."""
