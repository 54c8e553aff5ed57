"""Units of deviations, held against what the rows' meanings say."""

import re

import pytest

from armland.scenario.deviation import rows, unit_of

SAID = r"(share|correlation|probability|rad/\(N·m\)|N·m·s/rad|N·m/rad|N·m/s|N·m|N/s|N|m/s|m|1/s|deg/s|deg|px|ms|kg)(?=[ ,;])"
WORDS = {"share": "1", "correlation": "1", "probability": "1", "deg": "°", "deg/s": "°/s"}
ROWS = list(rows())


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row.path)
def test_unit_is_the_one_that_the_meaning_begins_with(row):
    said = re.match(SAID, row.meaning)
    if said is not None:
        assert unit_of(row.path) == WORDS.get(said[1], said[1])


def test_most_meanings_begin_with_a_unit():
    assert sum(re.match(SAID, row.meaning) is not None for row in ROWS) > 0.6 * len(ROWS)


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        ("uav.sag_per_s", "1/s"),
        ("uav.trim_mps2", "m/s²"),
        ("uav.tilt_deg", "°"),
        ("camera.mount_m", "m"),
        ("wrench.drift_nmps", "N·m/s"),
        ("arm.encoder_rad", "rad"),
        ("camera.noise", "1"),
    ],
)
def test_units_by_hand(path, unit):
    assert unit_of(path) == unit
