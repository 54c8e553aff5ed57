"""Standard output and error that never end a run: any encoding, a closed pipe, a full disk.

What a terminal's encoding lacks is written in letters (`°` as ` deg`, `Δτ` as `Deltatau`). A stream that cannot be written
any more says so once, in `Outlet.failure`, and takes the rest in silence.
"""

import codecs
import errno
import os
import sys
import unicodedata
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

WORDS = {
    "°": " deg",
    "≤": "<=",
    "≥": ">=",
    "·": "*",
    "×": "x",
    "−": "-",
    "–": "-",
    "±": "+/-",
    "→": "->",
    "•": "*",
    "√": "sqrt",
}


def spelled(character: str) -> str:
    """What stands for a character in plain letters."""
    if character in WORDS:
        return WORDS[character]
    if 0xDC80 <= ord(character) <= 0xDCFF:
        # A byte of a file's name that is no text.
        return f"\\x{ord(character) - 0xDC00:02x}"
    name = unicodedata.name(character, "").split()
    if name[:1] == ["GREEK"] and "LETTER" in name:
        letter = name[name.index("LETTER") + 1].lower()
        return letter.capitalize() if "CAPITAL" in name else letter
    return unicodedata.normalize("NFKD", character).encode("ascii", "ignore").decode() or (
        "" if unicodedata.combining(character) else "?"
    )


def _spell(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return "".join(spelled(c) for c in error.object[error.start : error.end]), error.end


codecs.register_error("spelled", _spell)


class Outlet:
    """A text stream; once it cannot be written, what follows is dropped."""

    def __init__(self, stream: Any) -> None:
        self._stream = stream
        self.failure: OSError | None = None
        """Why it cannot be written."""

    @property
    def lost(self) -> bool:
        """Whether somebody misses what was dropped: who closes a pipe has read enough."""
        return self.failure is not None and self.failure.errno != errno.EPIPE

    def write(self, text: str) -> int:
        """Write, or drop, the text."""
        self._attempt(lambda: self._stream.write(text))
        return len(text)

    def flush(self) -> None:
        """Hand on what was written."""
        self._attempt(self._stream.flush)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._stream, name)

    def _attempt(self, act: Callable[[], object]) -> None:
        if self.failure is not None:
            return
        try:
            act()
        except OSError as e:
            self.failure = e
            with suppress(OSError, ValueError):
                # What is still in the buffer would be tried again when Python ends.
                hole = os.open(os.devnull, os.O_WRONLY)
                os.dup2(hole, self._stream.fileno())
                os.close(hole)


@contextmanager
def outlets() -> Iterator[tuple[Outlet, Outlet]]:
    """Standard output and error as outlets while a command runs."""
    before = sys.stdout, sys.stderr
    made = []
    for given in before:
        # A stream that was closed leaves its number to the next file that is opened, which must not be a result.
        stream = open(os.devnull, "w", encoding="utf-8") if given is None else given  # noqa: SIM115
        with suppress(AttributeError, ValueError):
            stream.reconfigure(errors="spelled")  # type: ignore[union-attr]
        made.append(Outlet(stream))
    sys.stdout, sys.stderr = made
    try:
        yield made[0], made[1]
    finally:
        for outlet in made:
            outlet.flush()
        sys.stdout, sys.stderr = before
