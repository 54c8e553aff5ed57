"""Nested tables: merged, walked, and refused where no scenario needs what they hold."""

import json

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.scenario.tables import DEEPEST, as_json, leaves, orderly, put, take, update


def nest(levels, kind=dict):
    inner = {}
    for _ in range(levels):
        inner = {"a": inner} if kind is dict else [inner]
    return {"a": inner}


@pytest.mark.parametrize("kind", [dict, list])
def test_depth_is_bounded_without_recursion(kind) -> None:
    orderly(nest(DEEPEST - 3, kind), "x")
    for levels in (DEEPEST, 100_000):
        data = nest(levels, kind)
        with pytest.raises(ConfigurationError, match=r"x: tables or lists are nested too deeply"):
            orderly(data, "x")
        while data:
            # Taken apart by hand: a chain of this length cannot be freed by recursion everywhere.
            data = data.pop("a") if isinstance(data, dict) else data.pop()


@pytest.mark.parametrize(
    ("data", "says"),
    [
        ({"a": [2**64]}, "x: an integer of 65 bits; it may have 63"),
        ({"a": -(2**70000)}, "x: an integer of 70001 bits"),
        ({"a": {3: 1}}, "names of keys must be text"),
        ({"a": "\ud800"}, r"x: '\\ud800' is no Unicode text"),
        ({"\udcff": 1}, "is no Unicode text"),
    ],
)
def test_what_cannot_be_written_is_refused(data, says) -> None:
    with pytest.raises(ConfigurationError, match=says):
        orderly(data, "x")


def test_what_is_in_order_comes_back_as_it_is() -> None:
    data = {"a": {"b": [1, 2.5, "ü", True, None, (2**62,)]}}
    assert orderly(data, "x") is data


def test_json_knows_arrays_and_writes_the_rest_as_text() -> None:
    data = {"a": np.eye(2), "b": np.float64(0.5), "c": np.int64(3), "d": complex(1, 2)}
    assert json.loads(as_json(data)) == {"a": [[1.0, 0.0], [0.0, 1.0]], "b": 0.5, "c": 3, "d": "(1+2j)"}


def test_update_replaces_values_and_merges_tables() -> None:
    data = {"a": {"b": 1, "c": [1, 2]}, "d": 2}
    update(data, {"a": {"c": [3], "e": {"f": 4}}, "d": {"g": 5}})
    assert data == {"a": {"b": 1, "c": [3], "e": {"f": 4}}, "d": {"g": 5}}


def test_leaves_are_the_paths_of_values_and_of_empty_tables() -> None:
    assert leaves({"a": {"b": 1, "c": {"d": [{"e": 2}]}}, "f": {}, "g": 0}) == ["a.b", "a.c.d", "f", "g"]


def test_put_sets_what_is_not_set_and_take_takes_it_out_with_tables_that_are_empty_then() -> None:
    data = {"a": {"b": 1}}
    assert put(data, "c.d.e", 2.0)
    assert put(data, "a.f", 3)
    assert not put(data, "a.b", 4)
    assert not put(data, "a.b.c", 4)
    assert data == {"a": {"b": 1, "f": 3}, "c": {"d": {"e": 2.0}}}
    assert take(data, "c.d.e") == 2.0
    assert take(data, "a.b") == 1
    assert take(data, "a.zzz.b") is take(data, "zzz") is None
    assert data == {"a": {"f": 3}}
