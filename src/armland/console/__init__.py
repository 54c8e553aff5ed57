"""A flight in the browser: a recorded one that is scrubbed through, or a live one that is watched and steered."""
