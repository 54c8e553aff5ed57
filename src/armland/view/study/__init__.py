"""A study for the eye: its table and its figure."""
