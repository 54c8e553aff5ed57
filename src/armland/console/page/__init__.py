"""The page in the browser: who may open it, what may come from it, and what stands on it whatever it shows."""
