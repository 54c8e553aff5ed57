"""What a landing at sea gains or loses by: each term of the control taken away, each device exchanged, with the same seeds."""
