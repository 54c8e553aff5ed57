"""The folder of a command's files: made beside an earlier result, and put in its place when they are all there.

Everything is written into a folder of its own inside `--out`, so no link is followed and nothing is written elsewhere.
"""

import json
import os
import shutil
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple, NoReturn

from armland.cli.exits import Judged, attempted, in_words, say
from armland.errors import ConfigurationError


class Work(NamedTuple):
    """What came of a command's work."""

    success: bool
    data: dict[str, Any]  # Plain data, for JSON
    show: Callable[[Path], object]  # Prints tables; takes the folder of the results
    draw: Callable[[Path], object] | None = None  # Draws figures into a folder
    page: Callable[[Path], object] | None = None  # Writes the report as a page into a folder
    film: Callable[[Path], object] | None = None  # Makes a film in a folder


def publish(given: dict[str, Any], file: str, owned: Sequence[str], work: Callable[["Results"], Work]) -> NoReturn:
    """Do a command's work, write its data into `file` and its figures beside it, print it, and end the command by its verdict.

    Args:
        given: the command's options `out` and `as_json`, and `figures` where they may be left out.
        file: name of the JSON file.
        owned: patterns of other files that an earlier run of the same command may have left.
        work: the work; it may write logs into the folder of the results.

    Raises:
        ConfigurationError: `out` cannot be used.
        Judged: always, at the end.
    """
    with Results(given["out"], (file, *owned)) as results:
        done = work(results)
        text = json.dumps(done.data, indent=2)
        results.write(file, text + "\n")
        results.keep()
        extras = {"figures": done.draw, "report": done.page} if given.get("figures", True) else {}
        for what, make in {**extras, "film": done.film}.items():
            if make is not None:
                with attempted(what):
                    make(results.folder)
    if given["as_json"]:
        print(text)
    else:
        done.show(given["out"])
    raise Judged(done.success)


UNFINISHED = "unfinished"  # Folder in `--out` that holds the log of a run that came to no result


class Results:
    """The files of one command. Use it in a `with` statement, write into `folder`, and call `keep` when a result is there.

    Args:
        out: the folder that the user names.
        owned: patterns of the files that an earlier run of the same command may have left there.

    Raises:
        ConfigurationError: `out` is a file or a link, or cannot be written to.
    """

    def __init__(self, out: Path, owned: Sequence[str] = ()) -> None:
        self.out, self._owned, self._kept = out, owned, False
        try:
            if out.is_symlink():
                raise ConfigurationError(
                    f"--out {str(out)!r} is a link, and links are not followed; name the folder itself: {str(out.resolve())!r}"
                )
            self._new = [p for p in (out, *out.parents) if not p.exists()]
            out.mkdir(parents=True, exist_ok=True)
            self.folder = out / f"part-{os.getpid()}"
            """Where the files are written."""
            shutil.rmtree(self.folder, ignore_errors=True)
            self.folder.mkdir()
        except (OSError, ValueError) as e:
            why = (e.strerror if isinstance(e, OSError) else None) or str(e)
            raise ConfigurationError(f"--out {str(out)!r} cannot be made a folder to write to: {why}") from e

    def __enter__(self) -> "Results":
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: BaseException | TracebackType | None) -> None:
        if kind is None or issubclass(kind, SystemExit):
            self.keep()
        elif self._worth():
            self._set_aside()
            return
        shutil.rmtree(self.folder, ignore_errors=True)
        # Of a run that wrote nothing nothing is left; a folder that holds something stays.
        for path in self._new:
            with suppress(OSError):
                path.rmdir()

    def write(self, name: str, text: str) -> None:
        """Write a text file, whole or not at all; where that fails, say so."""
        try:
            (self.folder / name).write_text(text, encoding="utf-8")
        except OSError as e:
            say(f"no {name}: {in_words(e)}")
            with suppress(OSError):
                (self.folder / name).unlink()

    def scratch(self, name: str) -> Path:
        """Where a file may be written that nobody keeps."""
        folder = self.folder / "scratch"
        folder.mkdir(exist_ok=True)
        return folder / name

    def keep(self) -> None:
        """Put the files written so far in the place of an earlier result's; where that fails, say so."""
        made = sorted(p.name for p in self.folder.iterdir() if p.is_file()) if self.folder.is_dir() else []
        for name in made:
            try:
                os.replace(self.folder / name, self.out / name)
            except OSError as e:
                say(f"no {name} in {self.out}/: {e.strerror}")
        if not self._kept:
            stale = {p for pattern in self._owned for p in self.out.glob(pattern) if p.name not in made}
            for path in stale:
                with suppress(OSError):
                    path.unlink()
        self._kept = True

    def _worth(self) -> list[Path]:
        # Of a run that came to no result logs and stores are worth keeping, whole or not.
        return [p for pattern in ("*.mcap*", "*.sqlite*") for p in self.folder.glob(pattern)]

    def _set_aside(self) -> None:
        worth = self._worth()
        for path in self.folder.iterdir():
            if path.is_file() and path not in worth:
                path.unlink()
        shutil.rmtree(self.folder / "scratch", ignore_errors=True)
        place = self.out / UNFINISHED
        with suppress(OSError):
            shutil.rmtree(place, ignore_errors=True)
            self.folder = self.folder.rename(place)
        print(f"armland: what was recorded until then is in {self.folder}/", file=sys.stderr)
