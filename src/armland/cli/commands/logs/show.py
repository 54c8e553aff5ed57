"""The commands that read run logs: `report` and `log`."""

import json
from pathlib import Path
from typing import Any

from armland.cli import options
from armland.cli.exits import EXPLAINED
from armland.cli.results import Results, Work, publish
from armland.errors import ConfigurationError

REPORT_EPILOG = f"""**Examples**

`armland report out/land/landing.mcap` makes report.html, figures, tables and result.json of a landing anew, in out/report.

`armland report out/paper --out /tmp/again` does so for all logs of a folder; experiments share their figures and verdicts.

{EXPLAINED}
"""

LOG_EPILOG = """**Examples**

`armland log out/land/landing.mcap` says of which run a log is, how long it is, which phases were flown, and every field with its unit.

`armland log out/land/landing.mcap --json | jq .metadata.seed` prints the same as data.
"""


@options.taken(LOG_EPILOG, file=options.argument(Path, "Run log (MCAP).", ...), as_json=options.AS_JSON)
def log(**given: Any) -> None:
    """Say what a run log holds."""
    from armland.runtime.log import read_log
    from armland.view.tables.log import described, print_log

    found = read_log(given["file"])
    if given["as_json"]:
        print(json.dumps(described(found), indent=2))
    else:
        print_log(found, given["file"])


@options.taken(
    REPORT_EPILOG,
    files=options.argument(list[Path], "Run logs (MCAP), or folders of them.", ..., metavar="LOG..."),
    out=options.out("report"),
    **options.SHOWN,
)
def report(**given: Any) -> None:
    """Make report, figures, tables and result.json of a run, or of the paper's experiments together, from their logs."""
    from armland.runtime.log import read_log
    from armland.view.report import draw, print_run, result_of, succeeded, write_report

    logs = [read_log(file) for file in _logs(given["files"])]
    result = result_of(logs)

    def work(_: Results) -> Work:
        return Work(
            succeeded(result),
            result,
            lambda out: print_run(result, logs[0], out),
            lambda folder: draw(folder, logs),
            lambda folder: write_report(folder, logs, result),
        )

    publish(given, "result.json", ("*_overview.p??", "fig*.p??", "scene.png", "report.html"), work)


def _logs(files: list[Path]) -> list[Path]:
    found = []
    for file in files:
        inside = sorted(file.glob("*.mcap")) if file.is_dir() else [file]
        if not inside:
            raise ConfigurationError(f"folder {str(file)!r} holds no run log (*.mcap)")
        found += inside
    return found
