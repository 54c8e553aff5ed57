"""What is called by address has one before it is called: a symbol without address would be a jump to nowhere."""

import pytest
from numba import njit, types

from armland.compiled import set_up
from armland.linking import LINKED, Linked, linked

set_up()

NUMBER = (types.float64,)


@pytest.fixture
def tripled():
    """A linked function, and what calls it."""

    @linked(lambda _: NUMBER, types.float64)
    @njit
    def tripled(x):
        return 3.0 * x

    yield tripled
    LINKED.remove(tripled)


def caller_of(function):
    @njit
    def call(x):
        return function(x) + 1.0

    return call


def test_linked_function_is_called_by_address(tripled) -> None:
    tripled.link(7)
    assert caller_of(tripled)(2.0) == 7.0
    assert tripled(2.0) == 6.0


def test_what_calls_one_without_address_is_refused_and_works_once_there_is_one(tripled, monkeypatch) -> None:
    """As when it comes from the cache of sources that have changed since: it knows a name that nobody has."""
    monkeypatch.setattr(Linked, "symbol", lambda self, _: f"armland.made_up.{id(self)}")
    tripled._known.add(NUMBER)
    with pytest.raises(RuntimeError, match=r"call calls armland\.made_up\.\d+, whose address is not known"):
        caller_of(tripled)(2.0)
    tripled.link(7)
    assert caller_of(tripled)(2.0) == 7.0


def test_linking_that_fails_is_tried_again(tripled) -> None:
    types_of = tripled.types_of
    tripled.types_of = lambda _: 1 / 0
    with pytest.raises(ZeroDivisionError):
        tripled.link(7)
    tripled.types_of = types_of
    with pytest.raises(Exception, match="tripled is not linked for"):
        caller_of(tripled)(2.0)
    tripled.link(7)
    assert caller_of(tripled)(2.0) == 7.0


def test_what_is_expected_only_keeps_the_address_that_it_has(tripled) -> None:
    tripled.link(7)
    tripled.expect(7)
    assert caller_of(tripled)(2.0) == 7.0
