"""The commands that open a page in the browser: `replay` of recorded flights, and the `console` of a live one."""

from pathlib import Path
from typing import Any

from armland.cli import options
from armland.cli.console import diagnostics

REPLAY_EPILOG = """**Examples**

`armland replay out/land/landing.mcap` opens a page on which the flight is scrubbed through; space plays and pauses.

`armland replay out/paper/E1.mcap mine.mcap` shows two flights in one scene, and their difference in the plots.

`armland replay out/land/landing.mcap --port 0 --no-browser` serves on any free port and prints the address.

Exit code: 0 when it is stopped by Ctrl-C, 2 for a log that cannot be read or a port in use.
"""

SERVED = {
    "host": options.option(
        str, "Address to serve on; any but this machine's own asks pages for a token.", default="127.0.0.1"
    ),
    "port": options.option(int, "Port; 0 takes any that is free.", default=8080, min=0, max=65535),
    "token": options.option(
        str | None, "Token that pages have to know; made anew if absent, and none on this machine itself."
    ),
    "browser": options.option(bool, "Open the page in the browser.", "--browser/--no-browser", default=True),
}
"""Options that say where a page is served."""


@options.taken(
    REPLAY_EPILOG,
    files=options.argument(list[Path], "Run log (MCAP), or two that are compared.", ..., metavar="LOG [LOG2]"),
    **SERVED,
)
def replay(**given: Any) -> None:
    """Scrub through a recorded flight in the browser, or through two in one scene."""
    from armland.console.recording import Recording
    from armland.console.replay import Replay
    from armland.errors import ConfigurationError
    from armland.runtime.log import read_log

    if len(given["files"]) > 2:
        raise ConfigurationError(f"{len(given['files'])} logs; a page shows one, or two side by side")
    runs = [Recording(read_log(file), file) for file in given["files"]]
    for note in (note for run in runs for note in run.notes):
        diagnostics().print(note, highlight=False, markup=False, soft_wrap=True)
    server = _serve(given, "armland replay")
    try:
        Replay(server, runs).run()
    except KeyboardInterrupt:
        pass
    finally:
        server.stop()


def _serve(given: dict[str, Any], title: str) -> Any:
    from armland.console.page.door import token_for
    from armland.console.page.server import PageServer

    server = PageServer(given["host"], given["port"], token_for(given["host"], given["token"]), title)
    print(f"{title}: {server.address}  (Ctrl-C ends it)", flush=True)
    if given["browser"]:
        import webbrowser

        webbrowser.open(server.address)
    return server
