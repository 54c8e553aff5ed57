"""What is refused of body and gains."""

import numpy as np
import pytest

from armland.control.laws import rigid_body
from armland.control.laws.rigid_body import BacksteppingGains, ExactGains, UavParameters
from armland.errors import ConfigurationError, ModelError

INERTIA = np.array([[0.006, 0.0004, -0.0003], [0.0004, 0.007, 0.0002], [-0.0003, 0.0002, 0.012]])
UAV = UavParameters(0.48, INERTIA, np.array([0.004, -0.007, -0.06]))
PUBLISHED = BacksteppingGains(
    np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0]), np.array([1.0, 1.0, 1.0, 30.0, 30.0, 30.0]), 35.0
)


@pytest.mark.parametrize("gains", [PUBLISHED, ExactGains(PUBLISHED.k1, PUBLISHED.k2, 1.0, 35.0)])
@pytest.mark.parametrize("moments", [(0.006, 0.007, 0.012), (0.006, 0.006, 0.012)])
def test_check_takes_the_published_values_and_a_flat_plate_and_nothing_flatter(gains, moments):
    rigid_body.check(UAV._replace(inertia=np.diag(moments)), gains)
    flatter = np.diag([*moments[:2], 1.00001 * (moments[0] + moments[1])])
    with pytest.raises(ModelError, match="must not exceed the sum of the others"):
        rigid_body.check(UAV._replace(inertia=flatter), gains)


def changed(array, index, value):
    array = array.copy()
    array[index] = value
    return array


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"mass": 0.0}, "uav.mass is 0.0 kg"),
        ({"mass": -0.48}, "above 0"),
        ({"mass": np.nan}, "finite"),
        ({"inertia": INERTIA[:2]}, r"shape \(2, 3\).*\(3, 3\)"),
        ({"inertia": changed(INERTIA, (0, 1), 0.001)}, "symmetric"),
        ({"inertia": changed(INERTIA, (1, 1), np.inf)}, "finite"),
        ({"inertia": np.diag([0.006, 0.0, 0.006])}, "principal moments.*above 0"),
        ({"inertia": np.diag([0.006, -0.007, 0.012])}, "principal moments.*above 0"),
        ({"inertia": np.diag([0.006, 0.007, 0.0131])}, "sum of the others, 0.013"),
        ({"lever": np.zeros(2)}, r"uav.lever has the shape \(2,\)"),
        ({"lever": np.array([0.0, 0.0, np.nan])}, "uav.lever.*finite"),
    ],
)
def test_check_refuses_a_body_that_cannot_be(change, says):
    with pytest.raises(ModelError, match=says) as refusal:
        rigid_body.check(UAV._replace(**change), PUBLISHED)
    assert isinstance(refusal.value, ConfigurationError)


@pytest.mark.parametrize(
    ("gains", "says"),
    [
        (PUBLISHED._replace(k1=changed(PUBLISHED.k1, 2, 0.0)), "gains.k1.*above 0"),
        (PUBLISHED._replace(k2=changed(PUBLISHED.k2, 5, -30.0)), "gains.k2.*-30.0.*above 0"),
        (PUBLISHED._replace(k2=changed(PUBLISHED.k2, 0, np.nan)), "gains.k2.*finite"),
        (PUBLISHED._replace(k1=PUBLISHED.k1[:3]), r"gains.k1 has the shape \(3,\); it must have the shape \(6,\)"),
        (PUBLISHED._replace(k3=0.0), "gains.k3 is 0.0"),
        (PUBLISHED._replace(k3=np.array([1.0, 35.0])), "gains.k3 has the shape"),
        (ExactGains(PUBLISHED.k1, PUBLISHED.k2, -1.0, 35.0), "gains.k3_attitude is -1.0"),
        (ExactGains(PUBLISHED.k1, PUBLISHED.k2, 1.0, np.inf), "gains.k3_position.*finite"),
    ],
)
def test_check_refuses_gains_that_break_the_proof(gains, says):
    with pytest.raises(ConfigurationError, match=says):
        rigid_body.check(UAV, gains)
