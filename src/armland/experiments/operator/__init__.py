"""What somebody who watches a flight tells it: checked messages, what each does, and the script by which a flight repeats them."""
