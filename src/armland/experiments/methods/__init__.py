"""Ways to land held against each other: which there are, and what comes of the same seeds."""
