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


def test_every_kind_has_a_shape() -> None:
    assert set(SHAPES) == set(FAILURES)
    for kind in FAILURES:
        assert Fault(kind=kind).kind == kind


@pytest.mark.parametrize("kind", FAILURES)
@pytest.mark.parametrize("key", SPOILT)
def test_key_without_effect_is_refused_by_name(kind, key) -> None:
    if key in SHAPES[kind].keys:
        assert getattr(Fault(kind=kind, **{key: SPOILT[key]}), key) == SPOILT[key]
    else:
        with pytest.raises(ValidationError, match=f"{key} has no effect on `{kind}`"):
            Fault(kind=kind, **{key: SPOILT[key]})


@pytest.mark.parametrize("kind", FAILURES)
def test_size_without_effect_and_share_above_one_are_refused(kind) -> None:
    unit = SHAPES[kind].unit
    assert unit in Fault.model_fields["size"].description or unit == "share"
    if not unit:
        with pytest.raises(ValidationError, match=f"size has no effect on `{kind}`"):
            Fault(kind=kind, size=0.5)
    elif unit == "share":
        assert Fault(kind=kind, size=0.3).size == 0.3
        for size in (1.001, 0.0, -0.5):
            with pytest.raises(ValidationError, match=re.escape(f"size = {size:g} is the share that `{kind}` takes")):
                Fault(kind=kind, size=size)
    else:
        assert Fault(kind=kind, size=-6.0).size == -6.0


@pytest.mark.parametrize("kind", [kind for kind, shape in SHAPES.items() if "direction" in shape.keys])
def test_direction_that_points_nowhere_is_refused(kind) -> None:
    with pytest.raises(ValidationError, match="points nowhere"):
        Fault(kind=kind, direction=(0.0, 0.0, 0.0))
