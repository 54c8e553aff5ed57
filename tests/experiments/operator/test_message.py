"""Messages of an operator: what is one, what is none, and that a thousand made-up ones are told apart."""

import random

import numpy as np
import pytest

from armland.errors import ConfigurationError
from armland.experiments.operator.message import RANGES, Message, asked, message_of
from armland.scenario.faults import Fault

GUST = {"kind": "gust", "size": 3.0, "direction": [1.0, 0.0, 0.0], "lasts_s": 2.0}


@pytest.mark.parametrize(
    ("data", "words"),
    [
        ({"do": "hold"}, "hold"),
        ({"do": "abort", "tick": 12}, "abort"),
        ({"do": "wind", "value": 4.0}, "wind 4 m/s at 20 ft"),
        ({"do": "sea", "value": 1.5}, "sea 1.5 times the sea of the scenario"),
        ({"do": "delay", "value": 40}, "delay 40 ms more, each way"),
        ({"do": "noise", "value": 0.0}, "noise 0 times the sensors' noise"),
        ({"do": "mass", "value": 1.1}, "mass 1.1 times the UAV's mass"),
        ({"do": "fault", "fault": GUST}, "gust thrown in, at once"),
        ({"do": "fault", "fault": {"kind": "link_loss", "phase": "carry"}}, "link loss thrown in, when carry begins"),
    ],
)
def test_is_said_in_words(data: dict, words: str) -> None:
    assert message_of(data).words() == words


@pytest.mark.parametrize(
    ("data", "complaint"),
    [
        ({}, "do: is missing"),
        ({"do": "fly"}, "do"),
        ({"do": "hold", "value": 1.0}, "value has no effect on hold"),
        ({"do": "hold", "fault": GUST}, "fault has no effect on hold"),
        ({"do": "fault"}, "fault has to be there"),
        ({"do": "fault", "fault": {"kind": "magic"}}, "fault.kind"),
        ({"do": "wind", "value": -1.0}, "value = -1 of wind lies outside 0 to 40 m/s"),
        ({"do": "wind", "value": 41.0}, "lies outside 0 to 40"),
        ({"do": "wind", "value": float("nan")}, "value"),
        ({"do": "wind", "value": "4"}, "value"),
        ({"do": "mass", "value": 0.1}, "lies outside 0.5 to 2"),
        ({"do": "abort", "tick": -1}, "tick"),
        ({"do": "abort", "tick": 1.5}, "tick"),
        ({"do": "abort", "tock": 1}, "unknown key"),
        ({"do": "abort", 1: 2}, "unknown key"),
        ({"do": b"abort"}, "no plain data"),
        ([1, 2], "message"),
        ("hold", "message"),
        (None, "message"),
        ({"do": {1, 2}}, "no plain data"),
    ],
)
def test_what_is_none_is_refused_with_what_would_do(data: object, complaint: str) -> None:
    with pytest.raises(ConfigurationError, match=complaint):
        message_of(data)


def test_cyclic_data_is_refused() -> None:
    data: dict = {"do": "hold"}
    data["fault"] = data
    with pytest.raises(ConfigurationError, match="no plain data"):
        message_of(data)


@pytest.mark.parametrize("verb", RANGES)
def test_both_ends_of_a_range_belong_to_it(verb: str) -> None:
    low, high, _ = RANGES[verb]
    assert message_of({"do": verb, "value": low}).value == low
    assert message_of({"do": verb, "value": high}).value == high
    with pytest.raises(ConfigurationError):
        message_of({"do": verb, "value": np.nextafter(high, np.inf)})


def test_moves_to_another_tick_and_stays_what_it_is() -> None:
    message = asked("fault", fault=Fault(kind="power_loss"))
    assert message.tick == 0
    moved = message.at(77)
    assert (moved.tick, moved.do, moved.fault) == (77, "fault", message.fault)
    with pytest.raises(ConfigurationError):
        asked("wind", 99.0)


SCRAPS = (
    None,
    True,
    -1,
    0,
    3,
    10**9,
    10**400,
    0.5,
    41.0,
    float("nan"),
    float("inf"),
    "",
    "hold",
    "4",
    b"x",
    [],
    {},
    [1, [2]],
)
KEYS = ("tick", "do", "value", "fault", "more", "kind", "", "__class__")
VALUES = {
    "tick": (0, 7, -5, 10**9),
    "do": ("hold", "resume", "abort", "fault", *RANGES),
    "value": (0.0, 1.0, 2.5, 39.0, -1.0),
    "fault": (GUST, {"kind": "link_loss"}, {"kind": "link_loss", "size": 2.0}, {"kind": []}),
}


def made_up(rng: random.Random, depth: int = 0) -> object:
    """Nonsense, of which some is nearly a message, and some is one."""
    if depth > 2 or rng.random() < 0.15:
        return rng.choice(SCRAPS)
    if rng.random() < 0.1:
        return [made_up(rng, depth + 1) for _ in range(rng.randrange(3))]
    data = {}
    for key in rng.sample(KEYS[:4] if rng.random() < 0.8 else KEYS, rng.randrange(1, 4)):
        right = key in VALUES and rng.random() < 0.7
        data[key] = rng.choice(VALUES[key]) if right else made_up(rng, depth + 1)
    return data


def test_a_thousand_made_up_ones_are_messages_within_bounds_or_refused() -> None:
    rng, taken = random.Random(12), []
    for _ in range(1000):
        data = made_up(rng)
        try:
            message = message_of(data)
        except ConfigurationError:
            continue
        taken.append(message)
        assert isinstance(data, dict)
        assert message == Message.model_validate_json(message.model_dump_json())
        if message.do in RANGES:
            low, high, _ = RANGES[message.do]
            assert low <= message.value <= high
    # Both happen.
    assert 30 < len(taken) < 700
    assert len({m.do for m in taken}) > 4
