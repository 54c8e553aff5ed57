"""A film of a run, and stills of its phases, from its log."""
