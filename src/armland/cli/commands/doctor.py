"""The command `doctor`: what this machine has and lacks of what armland needs."""

import json
from typing import Any

from rich.text import Text

from armland.cli import options
from armland.cli.console import diagnostics
from armland.cli.exits import Judged

DOCTOR_EPILOG = """**Examples**

`armland doctor` looks at versions, OpenGL, cores, the timing of a 1 kHz loop, disk and compiled code, and says how to
get what is missing.

`armland doctor --json | jq '.[] | select(.state != "good")'` prints what is not as it should be.

Exit code: 0 if nothing is missing without which armland does not work, 1 if something is, 3 if something broke, 130 if it was stopped.
"""

LOOKS = {"good": ("good", "green"), "lacks": ("lacks", "yellow"), "bad": ("bad", "bold red")}
"""State -> word and style."""


@options.taken(DOCTOR_EPILOG, as_json=options.AS_JSON)
def doctor(**given: Any) -> None:
    """Look at this machine: versions, OpenGL, cores, timing, disk, compiled code; and how to get what is missing."""
    from armland.view.machine import checks
    from armland.view.tables.verdicts import terminal

    console, found = terminal(), []
    with diagnostics().status("Looking", spinner="line"):
        for check in checks():
            found.append(check)
            if not given["as_json"]:
                word, style = LOOKS[check.state]
                console.print(
                    Text(f"{word:5}  ", style).append(f"{check.name}: {check.found}", "default"), soft_wrap=True
                )
                if check.remedy:
                    console.print(Text(f"       {check.remedy}", "dim"), soft_wrap=True)
    if given["as_json"]:
        print(json.dumps([check._asdict() for check in found], indent=2))
    raise Judged(all(check.state != "bad" for check in found))
