"""Sections of landings without an arm."""
