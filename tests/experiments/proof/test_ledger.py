"""The ledger's figures on channels made by hand."""

import csv

import numpy as np
import pytest

from armland.experiments.proof.attribution import CHANNELS, TERMS
from armland.experiments.proof.ledger import NOTICEABLE_W, ledger, save_channels


def channels():
    """Random terms that add up, over 200 ticks."""
    c, rng = np.zeros(200, CHANNELS), np.random.default_rng(4)
    for name in ("law", *TERMS, "remainder"):
        c[name] = rng.normal(size=len(c))
        c["measured"] += c[name]
    c["t"], c["v2"] = np.arange(200) * 1e-3, rng.uniform(size=200)
    return c


def test_what_feeds_v2_while_it_rises_adds_up_to_its_mean_rise():
    c = channels()
    book = ledger(c)
    rising = c["measured"] > NOTICEABLE_W
    power = book["power_rising_w"]
    assert power["measured"] == pytest.approx(c["measured"][rising].mean())
    assert sum(power[name] for name in ("law", *TERMS, "remainder")) == pytest.approx(power["measured"])
    assert book["rising_share"] == pytest.approx(rising.mean())
    assert book["largest_rise_w"] == c["measured"].max()
    assert book["v2_largest_j"] == c["v2"].max()
    assert book["power_rms_w"]["arm"] == pytest.approx(np.sqrt(np.mean(c["arm"] ** 2)))
    assert book["closure"] == pytest.approx(np.std(c["remainder"]) / np.std(c["measured"]), rel=0.1)


def test_v2_that_never_rises():
    c = np.zeros(3, CHANNELS)
    c["measured"] = c["law"] = -1.0
    book = ledger(c)
    assert book["rising_share"] == book["closure"] == 0.0
    assert set(book["power_rising_w"].values()) == {0.0}
    assert ledger(np.zeros(3, CHANNELS))["closure"] == 0.0


def test_channels_as_csv(tmp_path):
    c = channels()
    with save_channels(c, tmp_path / "E1.csv").open(encoding="utf-8") as file:
        rows = list(csv.reader(file))
    assert rows[0][:3] == ["t [s]", "v2 [N·m]", "measured [W]"]
    assert len(rows[0]) == len(CHANNELS.names)
    np.testing.assert_allclose(np.array(rows[1:], dtype=float), np.array(c.tolist()), rtol=1e-8)
