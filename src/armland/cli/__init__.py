"""The command `armland`."""

import os
import sys


def main() -> None:
    """Run the command; whatever ends it becomes one message and an exit code."""
    # One flight is for one core. And the order of BLAS's sums, so the bits of a flight, depends on how many threads it has: a row that
    # a campaign's process flew is flown again here. NumPy reads it when it is first imported, which is later.
    for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
        os.environ[name] = "1"
    from armland.cli.exits import run_guarded

    def command() -> None:
        # Imported here, so that Ctrl-C while Python loads is a stop, too.
        from armland.cli.app import app

        app(prog_name="armland")

    sys.exit(run_guarded(command))
