"""What counts as the failure, and how near a flight came."""

import math

import pytest

from armland.experiments.campaign.description import Failure
from armland.experiments.campaign.rare.failure import in_words, score
from armland.experiments.campaign.rows import REFUSED, Row

FAST = Failure(figure="touchdown.speed_mps", above=0.2)
FAR = Failure(figure="touchdown.offset_m", above=0.015)
BOUNDS = {"touchdown.speed_mps": 0.25, "touchdown.offset_m": 0.01}


def flown(success, **touchdown):
    return Row(0, 0, 1, {}, success, "done", {"success": success, "reason": "", "touchdown": touchdown})


def test_failure_in_words_has_the_unit_of_its_figure():
    assert in_words(FAST) == "touchdown speed above 0.2 m/s"
    assert in_words(FAR) == "off centre above 15 mm"
    assert in_words(Failure(figure="joint_torque_max_ratio", above=0.5)) == "torque ratio max above 0.5"
    assert in_words(None) == in_words(Failure()) == "no success"


@pytest.mark.parametrize(
    ("speed", "failed"), [(0.1, False), (0.2, False), (math.nextafter(0.2, 1.0), True), (0.5, True)]
)
def test_figure_fails_above_its_threshold_and_not_at_it(speed, failed):
    found = score(flown(True, speed_mps=speed), FAST, BOUNDS)
    assert (found >= 0.0) == failed
    assert found == pytest.approx(speed - 0.2)


def test_flight_without_the_figure_did_not_fail_so():
    assert score(flown(False), FAST, BOUNDS) == -math.inf
    assert score(Row(0, 0, 1, {}, False, REFUSED, error="no"), FAST, BOUNDS) == -math.inf


def test_by_the_missions_criteria_the_nearest_bound_says_how_near():
    assert score(flown(True, speed_mps=0.1, offset_m=0.009), None, BOUNDS) == pytest.approx(-0.1)
    assert score(flown(False, speed_mps=0.1, offset_m=0.02), None, BOUNDS) == pytest.approx(1.0)
    # Who fails by another criterion failed, and who succeeds did not.
    assert score(flown(False, speed_mps=0.1, offset_m=0.002), None, BOUNDS) == 0.0
    assert score(flown(True, speed_mps=0.25), None, BOUNDS) < 0.0
    assert score(flown(True), None, BOUNDS) == -math.inf
    assert score(Row(0, 0, 1, {}, False, REFUSED, error="no"), None, BOUNDS) == 0.0
