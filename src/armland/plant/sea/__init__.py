"""The sea of the section `[sea]`: how the deck moves, worked out before a flight; `deck` moves it, `reference` measures it."""
