"""The plant as it really is: what a seed makes of the scenario's `[deviation]`, in the scene and in the devices."""
