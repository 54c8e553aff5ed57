"""The plant of landings without an arm: the same UAV, devices, wind and sea, over a pad."""
