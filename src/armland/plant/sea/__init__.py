"""The sea of the section `[sea]`: how the deck moves, worked out before a flight; `plant.devices.deck` moves it."""
