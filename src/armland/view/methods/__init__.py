"""Methods to land side by side, for the eye."""
