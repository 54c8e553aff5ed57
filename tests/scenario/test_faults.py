"""A failure says what its kind makes use of, and nothing else."""

import re

import pytest
from pydantic import ValidationError

from armland.scenario.faults import FAILURES, SHAPES, Fault

SPOILT = {
    "rotor": 2,
    "direction": (1.0, 0.0, 0.0),
    "device": "wrench",
    "body": "uav",
    "joint": 2,
}

LEAST = {
    "gust": {"direction": (1.0, 0.0, 0.0), "lasts_s": 1.0},
    "camera_noise": {"size": 2.0},
    "wrench_gain": {"size": 2.0},
}
"""What a kind needs beside its name."""


def test_every_kind_has_a_shape() -> None:
    assert set(SHAPES) == set(FAILURES)
    for kind in FAILURES:
        assert Fault(kind=kind, **LEAST.get(kind, {})).kind == kind


@pytest.mark.parametrize("kind", FAILURES)
@pytest.mark.parametrize("key", SPOILT)
def test_key_without_effect_is_refused_by_name(kind, key) -> None:
    given = LEAST.get(kind, {}) | {key: SPOILT[key]}
    if key in SHAPES[kind].keys:
        assert getattr(Fault(kind=kind, **given), key) == SPOILT[key]
    else:
        with pytest.raises(ValidationError, match=f"{key} has no effect on `{kind}`"):
            Fault(kind=kind, **given)


@pytest.mark.parametrize("kind", FAILURES)
def test_size_without_effect_and_out_of_bounds_are_refused(kind) -> None:
    unit, most = SHAPES[kind].unit, SHAPES[kind].most
    assert unit in Fault.model_fields["size"].description
    assert (unit != "share") or most == 1.0
    least = LEAST.get(kind, {})
    if not unit:
        with pytest.raises(ValidationError, match=f"size has no effect on `{kind}`"):
            Fault(kind=kind, size=0.5)
    elif most is not None:
        assert Fault(kind=kind, **(least | {"size": 0.3})).size == 0.3
        for size in (1.001 * most, 0.0, -0.5):
            told = f"size = {size:g} is the {unit} of `{kind}`: above 0, at most {most:g}"
            with pytest.raises(ValidationError, match=re.escape(told)):
                Fault(kind=kind, **(least | {"size": size}))
    else:
        assert Fault(kind=kind, size=-6.0).size == -6.0


@pytest.mark.parametrize("kind", ["camera_noise", "wrench_gain"])
def test_factor_that_changes_nothing_is_refused(kind) -> None:
    with pytest.raises(ValidationError, match="size = 1 changes nothing"):
        Fault(kind=kind)


def test_gust_is_horizontal_and_short() -> None:
    with pytest.raises(ValidationError, match="a gust is horizontal"):
        Fault(kind="gust", size=3.0, direction=(1.0, 0.0, 0.1), lasts_s=1.0)
    with pytest.raises(ValidationError, match="rises and falls within at most 60 s"):
        Fault(kind="gust", size=3.0, direction=(1.0, 0.0, 0.0))
    assert Fault(kind="push", size=3.0).lasts_s > 60.0


@pytest.mark.parametrize("kind", [kind for kind, shape in SHAPES.items() if "direction" in shape.keys])
def test_direction_that_points_nowhere_is_refused(kind) -> None:
    with pytest.raises(ValidationError, match="points nowhere"):
        Fault(kind=kind, direction=(0.0, 0.0, 0.0))
