"""Standard output in any encoding, closed, or on a full disk; what is said on standard error while a search goes on."""

import errno
import io
import sys
import threading
import time

import pytest
from rich.console import Console

from armland.cli.console import patiently
from armland.cli.streams import Outlet, outlets, spelled


@pytest.mark.parametrize(
    ("character", "word"),
    [
        ("°", " deg"),
        ("≤", "<="),
        ("Δ", "Delta"),
        ("τ", "tau"),
        ("₂", "2"),
        ("²", "2"),
        ("é", "e"),
        ("\udcff", "\\xff"),
        ("漢", "?"),
    ],
)
def test_what_an_encoding_lacks_is_spelled(character: str, word: str) -> None:
    assert spelled(character) == word


def test_ascii_terminal_shows_every_line(monkeypatch) -> None:
    raw = io.BytesIO()
    monkeypatch.setattr(sys, "stdout", io.TextIOWrapper(raw, "ascii"))
    with outlets():
        print("tilt ≤ 3°, Δτ, V₂ \udcff")
    assert raw.getvalue() == b"tilt <= 3 deg, Deltatau, V2 \\xff\n"


class Broken(io.StringIO):
    """A stream that cannot be written after so many calls."""

    def __init__(self, number: int, calls: int) -> None:
        super().__init__()
        self.number, self.calls = number, calls

    def write(self, text: str) -> int:
        self.calls -= 1
        if self.calls < 0:
            raise OSError(self.number, "broken")
        return super().write(text)


@pytest.mark.parametrize(("number", "lost"), [(errno.EPIPE, False), (errno.ENOSPC, True)])
def test_stream_that_breaks_takes_the_rest_in_silence(number: int, lost: bool) -> None:
    stream = Broken(number, 2)
    outlet = Outlet(stream)
    for k in range(5):
        assert outlet.write(f"{k}") == 1
    outlet.flush()
    assert (stream.getvalue(), outlet.lost) == ("01", lost)


def test_streams_are_put_back(monkeypatch) -> None:
    before = sys.stdout, sys.stderr
    with pytest.raises(KeyError), outlets():
        raise KeyError
    assert (sys.stdout, sys.stderr) == before


def test_closed_streams_are_no_error(monkeypatch) -> None:
    monkeypatch.setattr(sys, "stdout", None)
    with outlets() as (out, _):
        print("nobody hears this")
    assert out.failure is None


def told_by(work, patience_s):
    said = io.StringIO()
    with patiently(Console(file=said, width=200), patience_s):
        work()
    return said.getvalue().splitlines()


def test_long_search_says_that_it_goes_on_and_a_short_one_nothing():
    """Each line comes after twice as long as the one before: in 0.5 s after 0.05, 0.15 and 0.35 s."""
    lines = told_by(lambda: time.sleep(0.5), 0.05)
    assert 1 <= len(lines) <= 3
    assert all(line.startswith("Looking for a place where this arm can catch") for line in lines)
    assert told_by(lambda: None, 60.0) == []


def test_search_that_is_refused_ends_its_lines_with_it():
    def refused():
        raise ValueError("no place")

    before = threading.active_count()
    with pytest.raises(ValueError, match="no place"):
        told_by(refused, 60.0)
    assert threading.active_count() == before
