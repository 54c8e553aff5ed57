"""Machines of landings without an arm: six legs, a rope."""
