"""What is told many times a second: it goes to pages without viser's own look at each value.

viser's handles check type, length, sameness and presence of each value that they are given, which takes ten times as long as to
queue the message. Who tells something 30 times a second knows all that.
"""

from collections.abc import Sequence
from typing import Any

from viser import GuiUplotHandle
from viser import _messages as messages

from armland.rotations import Array


def put_place(node: Any, place: Array) -> None:
    """Put a node of the scene at a place (3,), m, in its parent's frame."""
    impl = node._impl
    impl.position[:] = place
    x, y, z = place.tolist()
    impl.api._queue_scene_message(messages.SetPositionMessage(impl.name, (x, y, z)))


def put_turn(node: Any, turn: Array) -> None:
    """Turn a node of the scene to an attitude (4,), scalar first, in its parent's frame."""
    impl = node._impl
    impl.wxyz[:] = turn
    w, x, y, z = turn.tolist()
    impl.api._queue_scene_message(messages.SetOrientationMessage(impl.name, (w, x, y, z)))


def put_curves(chart: GuiUplotHandle, data: Sequence[Array]) -> None:
    """Let a chart show data: (k,) for its abscissa and for each of its series, float64, which nobody changes any more."""
    chart._impl.props.data = tuple(data)  # type: ignore[attr-defined]
    chart._queue_update("data", tuple(data))
