"""The command `envelope`: exit codes and what it writes."""

import json
from dataclasses import replace

import pytest

from armland.experiments.envelope import study as envelope_study
from armland.experiments.envelope.bench import Capture
from armland.experiments.envelope.bounds import Allowed, Axis, Edge
from armland.experiments.envelope.study import EnvelopeStudy

BOUNDS = {"offset": 0.0065, "speed": 0.2, "tilt": 0.4, "plate": 0.3, "fastest": 0.6, "slowest": 0.01}


@pytest.fixture
def found() -> EnvelopeStudy:
    axes = tuple(Axis(k, (Edge(v, "3 of 4 pads"),), (Edge(v, "3 of 4 pads"),), v, v) for k, v in BOUNDS.items())
    corner = (0.0, Capture(True, "held", 4, 15.0, 6.0, 0.005, 0.03))
    return EnvelopeStudy(Allowed(0.004, 0.06, 0.1, 0.006, 0.04, 0.16), 0.1, axes, (), (corner,), (), (), 1)


def test_all_inside_is_exit_code_0_and_json_alone(armland, monkeypatch, found, tmp_path):
    monkeypatch.setattr(envelope_study, "study", lambda *_, **__: found)
    done = armland("envelope", "--no-figures", "--json", "--out", "out")
    assert done.code == 0, done.err
    assert json.loads(done.out) == json.loads((tmp_path / "out" / "envelope.json").read_text())
    assert json.loads(done.out)["holds"] is True


def test_a_threshold_outside_is_exit_code_1_and_named(armland, monkeypatch, found):
    outside = replace(found, allowed=found.allowed._replace(offset=0.008))
    monkeypatch.setattr(envelope_study, "study", lambda *_, **__: outside)
    done = armland("envelope", "--no-figures", "--out", "out")
    assert done.code == 1
    assert "bounds.align_offset_m = 0.008 m lies outside" in " ".join(done.out.split())


WIDE = 'base = "landing"\n[bounds]\nalign_offset_m = 0.01\nlost_offset_m = 0.02'


@pytest.mark.parametrize(("text", "words"), [("title = 3", "title"), (WIDE, "0.007 m")])
def test_bad_input_is_refused_before_anything_is_written(armland, tmp_path, text, words):
    (tmp_path / "bad.toml").write_text(text)
    done = armland("envelope", "bad.toml", "--out", "out")
    assert done.code == 2
    assert words in done.err
    assert not (tmp_path / "out").exists()
