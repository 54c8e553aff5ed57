"""The proof as a whole: on few states and a short path it holds, and a broken one is found out."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.experiments.proof.attribution import TERMS
from armland.experiments.proof.verification import CLOSURE, RATE_GAP, judge, loop_of, prove
from armland.scenario import load_scenario

SHORT = {"trajectory": {"moves": [{"to_m": [0.05, 0.03, 0.0], "duration_s": 0.6, "rest_s": 0.2}]}}


@cache
def scenario():
    return load_scenario("paper", SHORT)


@pytest.fixture(scope="module")
def proof():
    return prove(scenario(), samples=60)


def test_the_proof_holds_on_the_subsystem_and_adds_up_on_the_demonstrator(proof):
    assert [v.claim for v in proof.verdicts if not v.holds] == []
    assert proof.holds
    assert len(proof.verdicts) == 2 * 3 + 3
    assert len(proof.cases["paper"].paths) == 60
    assert len(proof.cases["exact"].paths) == 6


def test_v2_rises_on_the_demonstrator_and_that_is_no_verdict(proof):
    for book in proof.ledgers.values():
        assert book["rising_share"] > 0.1
        assert book["largest_rise_w"] > 0.05
        assert book["power_rms_w"]["arm"] > 10.0 * book["power_rms_w"]["remainder"]
    assert proof.ledgers["E1"]["power_rms_w"]["unsent"] > 0.0
    assert proof.ledgers["E2"]["power_rms_w"]["unsent"] == pytest.approx(0.0, abs=1e-12)
    assert proof.ledgers["E3"]["power_rms_w"]["support"] < 0.1 * proof.ledgers["E2"]["power_rms_w"]["support"]


def test_result_is_plain_data(proof):
    result = json.loads(json.dumps(proof.result(), allow_nan=False))
    assert set(result) == {"subsystem", "demonstrator", "verdicts", "run"}
    assert set(result["demonstrator"]["E1"]["power_rms_w"]) == {"measured", "law", *TERMS, "remainder"}


def test_channels_start_before_the_path_and_are_judged_since(proof):
    channels = proof.channels["E1"]
    assert channels["t"][0] < 0.01
    np.testing.assert_allclose(np.diff(channels["t"]), 1e-3)
    judged = channels[channels["t"] >= proof.start_s]
    assert proof.ledgers["E1"]["largest_rise_w"] == judged["measured"].max()


@pytest.mark.parametrize(
    ("flaw", "claims"),
    [
        ({"gaps": np.array([2.0 * RATE_GAP])}, 1),
        ({"gaps": np.array([0.5 * RATE_GAP])}, 0),
        ({"rise": 1e-3}, 1),
        ({"arrived": np.nan}, 1),
    ],
)
def test_a_flaw_fails_its_verdict(proof, flaw, claims):
    case = proof.cases["paper"]
    paths = case.paths.copy()
    for name, value in flaw.items():
        if name != "gaps":
            paths[name][3] = value
    flawed = replace(case, paths=paths, gaps=flaw.get("gaps", case.gaps))
    verdicts = judge({"paper": flawed}, {})
    assert sum(not v.holds for v in verdicts) == claims


def test_the_case_without_a_proof_is_reported_and_not_judged(proof):
    case = proof.cases["paper_true"]
    assert judge({"paper_true": case}, {}) == []
    assert case.figures()["rate_gap_median"] > 1e-3


def test_an_attribution_that_does_not_add_up_fails(proof):
    books = {"E1": proof.ledgers["E1"] | {"closure": 1.1 * CLOSURE}}
    assert [v.holds for v in judge({}, books)] == [False]


def test_experiments_with_other_laws_are_left_out():
    assert loop_of(scenario(), "E2").uplink == 25
    for change in ({"law": "exact"}, {"onboard": {"controller": "cascade"}}):
        assert loop_of(scenario().replaced({"experiments": {"E2": change}}), "E2") is None


def test_no_samples_are_refused(proof):
    with pytest.raises(ConfigurationError, match="samples is 0; it must be at least 1"):
        prove(scenario(), samples=0)
