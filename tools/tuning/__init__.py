"""Search for settings of the methods to land."""
