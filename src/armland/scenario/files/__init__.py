"""Scenario files: read, put on their base, given the names of today, described for editors."""
