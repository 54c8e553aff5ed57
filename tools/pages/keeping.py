"""Records of flights in a file, a line each, so that a page whose flights take long can be stopped and goes on."""

import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

Record = dict[str, Any]


def completed(path: Path, flown: Callable[[list[Record]], Iterable[Record]]) -> list[Record]:
    """All records of the file, those among them that `flown` makes of what it is told is there; each is written as it comes."""
    there = [json.loads(line) for line in path.read_text("utf-8").splitlines()] if path.is_file() else []
    with path.open("a", encoding="utf-8") as file:
        for r in flown(list(there)):
            there.append(r)
            print(json.dumps(r), file=file, flush=True)
    return there
