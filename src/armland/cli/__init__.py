"""The command `armland`."""

import sys


def main() -> None:
    """Run the command; whatever ends it becomes one message and an exit code."""
    from armland.cli.exits import run_guarded

    def command() -> None:
        # Imported here, so that Ctrl-C while Python loads is a stop, too.
        from armland.cli.app import app

        app(prog_name="armland")

    sys.exit(run_guarded(command))
