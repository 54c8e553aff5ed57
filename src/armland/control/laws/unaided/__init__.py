"""Laws of landings without an arm."""
