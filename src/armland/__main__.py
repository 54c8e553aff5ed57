"""`python -m armland`, the same as the command `armland`."""

from armland.cli import main

main()
