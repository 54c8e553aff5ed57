"""The wind of the section `[air]`: what is worked out before a flight; `plant.devices.air` lets it blow."""
