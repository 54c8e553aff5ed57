"""`armland replay`, `armland console` and `--operator`: bad input ends with one message and exit code 2, and nothing is left behind."""

import socket
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from armland.console.replay import Replay
from armland.runtime.log import read_log

ROOT = Path(__file__).parents[2]

PLAIN = ("--no-browser", "--port", "0")


@pytest.fixture
def log(flown):
    return flown["landing"][0].log


@pytest.fixture
def shown(monkeypatch):
    """What a replay would show, without waiting for anybody to look."""
    seen = []
    monkeypatch.setattr(Replay, "run", lambda self: seen.append(self))
    return seen


def test_replay_prints_its_address_and_serves(armland, log, shown) -> None:
    done = armland("replay", str(log), *PLAIN)
    assert done.code == 0
    assert done.out.startswith("armland replay: http://localhost:")
    assert shown[0].events[0].words == "self test"


@pytest.mark.parametrize("mission", ["tether", "unassisted", "hexapod"])
def test_console_says_who_flies_what_it_does_not(armland, mission) -> None:
    done = armland("console", mission, *PLAIN)
    assert done.code == 2
    assert f"mission '{mission}' flies without an arm" in done.err
    assert f"`armland run {mission}` flies it" in done.err


def test_replay_of_two(armland, log, shown) -> None:
    assert armland("replay", str(log), str(log), *PLAIN).code == 0
    assert len(shown[0]._stages) == 2


def test_a_log_that_was_cut_off_is_shown_and_said(armland, log, shown, tmp_path) -> None:
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(log.read_bytes()[:2_000_000])
    done = armland("replay", str(cut), *PLAIN)
    assert done.code == 0
    assert "cut.mcap was cut off" in done.err
    assert len(shown) == 1


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "this is not an MCAP file"),
        (b"not a log at all", "this is not an MCAP file"),
        (b"\x89MCAP0\r\n", "it has no metadata of a run"),
        (None, "cannot read the run log"),
    ],
)
def test_what_is_no_log_is_refused(armland, tmp_path, content, words: str) -> None:
    file = tmp_path / "odd.mcap"
    if content is not None:
        file.write_bytes(content)
    done = armland("replay", str(file), *PLAIN)
    assert done.code == 2
    assert words in done.err
    assert done.err.count("\n") == 1
    assert done.out == ""


def test_a_log_of_a_run_that_holds_no_tick_is_refused(armland, log, tmp_path) -> None:
    head = tmp_path / "head.mcap"
    head.write_bytes(log.read_bytes()[:200_000])
    done = armland("replay", str(head), *PLAIN)
    assert done.code == 2
    assert done.err.count("\n") == 1


def test_three_logs_are_one_too_many(armland, log) -> None:
    done = armland("replay", str(log), str(log), str(log), *PLAIN)
    assert done.code == 2
    assert "3 logs; a page shows one, or two side by side" in done.err


@pytest.mark.parametrize("command", ["replay", "console"])
def test_a_port_in_use_is_refused(armland, log, command: str) -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        what = (str(log),) if command == "replay" else ()
        done = armland(command, *what, "--no-browser", "--port", str(port))
    assert done.code == 2
    assert f"port {port} of 127.0.0.1 is in use; --port {port + 1} may be free" in done.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("moonshot",), "moonshot"),
        (("landing", "--uav", "albatross"), "albatross"),
        (("landing", "--scenario", "none.toml"), "none.toml"),
        (("landing", "--set", "arm.colour=1"), "arm.colour"),
        (("landing", "--wind", "99"), "wind"),
    ],
)
def test_a_console_of_nonsense_is_refused_before_there_is_a_page(armland, tmp_path, arguments, words: str) -> None:
    done = armland("console", *arguments, *PLAIN)
    assert done.code == 2
    assert words in done.err
    assert done.out == ""
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_an_operator_s_log_is_flown_again(armland, tmp_path) -> None:
    script = tmp_path / "mine.jsonl"
    script.write_text('{"tick": 1500, "do": "wind", "value": 2.0}\n{"tick": 3000, "do": "abort"}\n')
    first = armland("land", "--seed", "5", "--operator", str(script), "--out", "one", "--no-figures", "--json")
    assert first.code == 1
    assert "the operator aborted it" in first.out
    log = tmp_path / "one" / "landing.mcap"
    again = armland("land", "--seed", "5", "--operator", str(log), "--out", "two", "--no-figures", "--json")
    assert f"the same ticks as in {log}" in again.err
    assert read_log(tmp_path / "two" / "landing.mcap").ticks.tobytes() == read_log(log).ticks.tobytes()
    other = armland("land", "--seed", "6", "--operator", str(log), "--out", "three", "--no-figures", "--json")
    assert "not the same from tick 0 on as in" in other.err


@pytest.mark.parametrize(
    ("text", "more", "words"),
    [
        ('{"do": "dance"}', (), "line 1: do"),
        ('{"do": "hold"}', ("--seeds", "3"), "--operator steers one flight; leave out --seeds"),
        (None, (), "cannot read the operator's script"),
    ],
)
def test_a_script_that_is_none_is_refused(armland, tmp_path, text, more, words: str) -> None:
    script = tmp_path / "mine.jsonl"
    if text is not None:
        script.write_text(text)
    done = armland("land", "--operator", str(script), *more, "--out", "out")
    assert done.code == 2
    assert words in done.err
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_it_ends_by_an_interrupt(log, tmp_path) -> None:
    command = [sys.executable, "-m", "armland", "replay", str(log), *PLAIN]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT) as run:
        address = run.stdout.readline().split()[2]
        assert urllib.request.urlopen(address, timeout=10).status == 200
        run.send_signal(2)
        assert run.wait(timeout=20) in (0, 130)
