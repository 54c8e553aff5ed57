"""Frames: they stand where their bodies are, and are told of it when they have moved."""

import numpy as np
import pytest

from armland.console.stage.frames import STILL, Frames


@pytest.fixture
def frames(server):
    made = Frames()
    for body in (2, 0):
        made.add(body, server.viser.scene.add_frame(f"/body_{body}"))
    made.messages = lambda: server.viser._websock_server._broadcast_buffer.message_counter
    return made


PLACES = np.array([[0.0, 0.0, 0.5], [9.0, 9.0, 9.0], [1.0, 2.0, 3.0]])
TURNS = np.tile([1.0, 0.0, 0.0, 0.0], (3, 1))


def test_each_stands_where_its_body_is(frames) -> None:
    frames.show(PLACES, TURNS)
    for body in (0, 2):
        np.testing.assert_array_equal(frames[body].position, PLACES[body])
        np.testing.assert_array_equal(frames[body].wxyz, TURNS[body])
    assert 1 not in frames
    assert 2 in frames


def test_what_stands_still_is_told_once_and_what_creeps_when_it_has_moved(frames) -> None:
    frames.show(PLACES, TURNS)
    before = frames.messages()
    frames.show(PLACES, TURNS)
    assert frames.messages() == before
    moved = PLACES.copy()
    for _ in range(3):
        moved[2, 0] += 0.6 * STILL
        frames.show(moved, TURNS)
    assert frames.messages() == before + 1
    assert frames[2].position[0] == pytest.approx(1.0 + 1.2 * STILL, abs=1e-9)
    frames.show(moved, np.tile([0.0, 1.0, 0.0, 0.0], (3, 1)))
    assert frames.messages() == before + 3


def test_a_place_that_is_no_number_is_not_told(frames) -> None:
    frames.show(PLACES, TURNS)
    frames.show(np.full((3, 3), np.nan), TURNS)
    np.testing.assert_array_equal(frames[2].position, PLACES[2])
