"""What a page may send: each message is checked before anything hears of it, and what is nonsense changes nothing.

| message | is let in if |
|---|---|
| where the page's camera is | all its numbers are finite |
| a new value of a control | the page steers, the control is there and not disabled, and the value is one that the control can have |
| a key or command | the page steers and the command is there |
| anything else | never |
"""

import math
import warnings
from typing import Any

from viser import (
    GuiButtonGroupHandle,
    GuiButtonHandle,
    GuiCheckboxHandle,
    GuiDropdownHandle,
    GuiNumberHandle,
    GuiSliderHandle,
    GuiTextHandle,
)
from viser import _messages as messages
from viser._gui_api import GuiApi

LONGEST_TEXT = 2000

LARGEST = 1 << 16
"""Bytes of a message from a page."""

READ_ONLY = "another page steers: this one is read-only"


def decoded(raw: Any) -> messages.Message | str:
    """The message that a page has sent, or what is wrong with it."""
    if not isinstance(raw, bytes):
        return "text in place of a message"
    try:
        # Whatever a parser makes of bytes that nobody has checked.
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            return messages.Message.deserialize(raw)  # type: ignore[return-value]
    except Exception as e:
        return f"{len(raw)} bytes that are no message ({type(e).__name__})"


def objection(message: Any, gui: GuiApi, steers: bool) -> str | None:
    """What is wrong with a message of a page; None where nothing is.

    Args:
        message: of `decoded`.
        gui: whose controls and commands there are.
        steers: whether the page may steer.
    """
    if isinstance(message, messages.ViewerCameraMessage):
        return None if _camera(message) else "a camera whose place is no number"
    if isinstance(message, messages.CommandTriggerMessage):
        command = gui._command_handle_from_uuid.get(message.uuid) if isinstance(message.uuid, str) else None
        if command is None:
            return "a command that there is not"
        return (None if steers else READ_ONLY) if not command.disabled else "a command that is switched off"
    if isinstance(message, messages.GuiUpdateMessage):
        return _update(message, gui, steers)
    return f"a message that no page of this console sends ({type(message).__name__})"


def _update(message: messages.GuiUpdateMessage, gui: GuiApi, steers: bool) -> str | None:
    handle = gui._gui_input_handle_from_uuid.get(message.uuid) if isinstance(message.uuid, str) else None
    if handle is None:
        return "a control that there is not"
    if not isinstance(message.updates, dict) or set(message.updates) != {"value"}:
        return "a control's value of an unknown form"
    if getattr(handle, "disabled", False):
        return "a control that is switched off"
    if not steers:
        return READ_ONLY
    value = message.updates["value"]
    return None if _possible(handle, value) else f"{str(value)[:40]}, which this control cannot have"


def _possible(handle: Any, value: Any) -> bool:
    match handle:
        case GuiButtonHandle() | GuiCheckboxHandle():
            return isinstance(value, bool)
        case GuiDropdownHandle() | GuiButtonGroupHandle():
            return isinstance(value, str) and value in handle.options
        case GuiTextHandle():
            return isinstance(value, str) and len(value) <= LONGEST_TEXT
        case GuiSliderHandle() | GuiNumberHandle():
            low = handle.min if handle.min is not None else -math.inf
            high = handle.max if handle.max is not None else math.inf
            return _number(value) and low - 1e-9 <= value <= high + 1e-9
    return False


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e15 and math.isfinite(value)


def _camera(m: messages.ViewerCameraMessage) -> bool:
    shapes = ((m.wxyz, 4), (m.position, 3), (m.look_at, 3), (m.up_direction, 3))
    rows = all(isinstance(row, tuple | list) and len(row) == n and all(map(_number, row)) for row, n in shapes)
    sizes = (m.fov, m.near, m.far, m.image_height, m.image_width)
    return rows and all(map(_number, sizes)) and 0 <= m.image_height < 1e5 and 0 <= m.image_width < 1e5
