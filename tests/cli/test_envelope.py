"""The command `envelope`: exit codes and what it writes."""

import json
from dataclasses import replace

import pytest
from typer.testing import CliRunner

from armland.cli import app
from armland.errors import ConfigurationError
from armland.experiments import envelope_study
from armland.experiments.capture_bench import Capture
from armland.experiments.envelope import Allowed, Axis, Edge
from armland.experiments.envelope_study import EnvelopeStudy

BOUNDS = {"offset": 0.0065, "speed": 0.2, "tilt": 0.4, "plate": 0.3, "fastest": 0.6, "slowest": 0.01}


@pytest.fixture
def found() -> EnvelopeStudy:
    axes = tuple(Axis(k, (Edge(v, "3 of 4 pads"),), (Edge(v, "3 of 4 pads"),), v, v) for k, v in BOUNDS.items())
    corner = (0.0, Capture(True, "held", 4, 15.0, 6.0, 0.005, 0.03))
    return EnvelopeStudy(Allowed(0.004, 0.06, 0.1, 0.006, 0.04, 0.16), 0.1, axes, (), (corner,), (), (), 1)


def run(monkeypatch, found, *args):
    monkeypatch.setattr(envelope_study, "study", lambda *_, **__: found)
    return CliRunner().invoke(app, ["envelope", "--no-figures", *args])


def test_all_inside_is_exit_code_0_and_json_alone(monkeypatch, found, tmp_path):
    done = run(monkeypatch, found, "--json", "--out", str(tmp_path))
    assert done.exit_code == 0
    assert json.loads(done.stdout) == json.loads((tmp_path / "envelope.json").read_text())
    assert json.loads(done.stdout)["holds"] is True


def test_a_threshold_outside_is_exit_code_1_and_named(monkeypatch, found, tmp_path):
    outside = replace(found, allowed=found.allowed._replace(offset=0.008))
    done = run(monkeypatch, outside, "--out", str(tmp_path))
    assert done.exit_code == 1
    assert "bounds.align_offset_m = 0.008 m lies outside" in " ".join(done.stdout.split())


WIDE = "[bounds]\nalign_offset_m = 0.01\nlost_offset_m = 0.02"


@pytest.mark.parametrize(("text", "words"), [("title = 3", "title"), (WIDE, "0.007 m")])
def test_bad_input_is_refused_before_anything_is_written(tmp_path, text, words):
    file = tmp_path / "bad.toml"
    file.write_text(text)
    done = CliRunner().invoke(app, ["envelope", str(file), "--out", str(tmp_path / "out")])
    # `main` turns it into exit code 2.
    assert isinstance(done.exception, ConfigurationError)
    assert words in str(done.exception)
    assert not (tmp_path / "out").exists()
