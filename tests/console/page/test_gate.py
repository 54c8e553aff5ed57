"""What a page may send: right messages pass, a thousand wrong ones change nothing."""

import random

import msgspec
import pytest
from viser import _messages as messages

from armland.console.page.gate import LONGEST_TEXT, READ_ONLY, decoded, objection


@pytest.fixture
def gui(server):
    return server.viser.gui


def update(handle, value) -> messages.GuiUpdateMessage:
    return messages.GuiUpdateMessage(handle._impl.uuid, {"value": value})


def test_each_control_takes_what_it_can_have_and_nothing_else(gui) -> None:
    slider = gui.add_slider("s", min=0.0, max=2.0, step=0.1, initial_value=1.0)
    number = gui.add_number("n", 3, min=0, max=9)
    free = gui.add_number("f", 1.0)
    box, text = gui.add_checkbox("c", False), gui.add_text("t", "a")
    menu, group, button = gui.add_dropdown("d", ("x", "y")), gui.add_button_group("g", ("p", "q")), gui.add_button("b")
    right = [
        (slider, 0.0), (slider, 2), (number, 9), (free, -1e9), (box, True), (text, ""), (text, "a" * LONGEST_TEXT),
        (menu, "y"), (group, "q"), (button, True),
    ]  # fmt: skip
    for handle, value in right:
        assert objection(update(handle, value), gui, True) is None
        assert objection(update(handle, value), gui, False) == READ_ONLY
    wrong = [
        (slider, 2.1), (slider, -0.1), (slider, "1"), (slider, True), (slider, None), (slider, float("nan")), (slider, [1.0]),
        (slider, float("inf")), (number, 10), (number, 1e300), (free, 1e16), (box, 1), (box, "true"), (text, 1),
        (text, "a" * (LONGEST_TEXT + 1)), (menu, "z"), (menu, 0), (menu, ["x"]), (group, ""), (button, "x"),
    ]  # fmt: skip
    for handle, value in wrong:
        assert "which this control cannot have" in (objection(update(handle, value), gui, True) or ""), value


def test_a_control_that_is_switched_off_or_gone_takes_nothing(gui) -> None:
    off, gone = gui.add_button("b", disabled=True), gui.add_checkbox("c", False)
    uuid = gone._impl.uuid
    gone.remove()
    assert "switched off" in str(objection(update(off, True), gui, True))
    assert "there is not" in str(objection(messages.GuiUpdateMessage(uuid, {"value": True}), gui, True))
    assert "there is not" in str(objection(messages.GuiUpdateMessage(["a"], {"value": True}), gui, True))


@pytest.mark.parametrize(
    "updates", [{}, {"value": 1.0, "min": 0}, {"removed": True}, {"update_cb": []}, [], None, {"max": 9}]
)
def test_nothing_but_a_value_is_set(gui, updates) -> None:
    slider = gui.add_slider("s", min=0.0, max=2.0, step=0.1, initial_value=1.0)
    message = messages.GuiUpdateMessage(slider._impl.uuid, updates)
    assert "unknown form" in str(objection(message, gui, True))


def test_commands_are_known_and_of_who_steers(gui) -> None:
    command, off = gui.add_command("abort", hotkey="escape"), gui.add_command("no", disabled=True)
    trigger = messages.CommandTriggerMessage
    assert objection(trigger(command._impl.uuid), gui, True) is None
    assert objection(trigger(command._impl.uuid), gui, False) == READ_ONLY
    assert "switched off" in str(objection(trigger(off._impl.uuid), gui, True))
    for uuid in ("nobody", 3, None, []):
        assert "there is not" in str(objection(trigger(uuid), gui, True))


def test_cameras_are_of_anybody_and_of_numbers(gui) -> None:
    good = ((1, 0, 0, 0), (1, 1, 1), 1.0, 0.1, 10.0, 600, 800, (0, 0, 0), (0, 0, 1))
    assert objection(messages.ViewerCameraMessage(*good), gui, False) is None
    for at, bad in (
        (0, (1, 0, 0)),
        (1, (1, 1, float("nan"))),
        (2, "wide"),
        (5, -1),
        (6, 1e9),
        (7, None),
        (8, (0, 0, "z")),
    ):
        fields = list(good)
        fields[at] = bad
        assert "no number" in str(objection(messages.ViewerCameraMessage(*fields), gui, True))


@pytest.mark.parametrize(
    "message",
    [
        messages.ShareUrlRequest() if hasattr(messages, "ShareUrlRequest") else messages.ResetGuiMessage(),
        messages.ResetGuiMessage(),
        messages.RunJavascriptMessage("alert(1)"),
        messages.GuiFormSubmitMessage("x"),
        messages.RemoveSceneNodeMessage("/flight"),
    ],
)
def test_what_a_page_never_sends_is_never_let_in(gui, message) -> None:
    assert "no page of this console sends" in str(objection(message, gui, True))


@pytest.mark.parametrize(
    "raw", ["text", b"", b"\x00", b"\xc1", b"\x93\x01\x02\x03", msgspec.msgpack.encode({"type": "Nothing"}), None,
            msgspec.msgpack.encode({"type": "GuiUpdateMessage"}), msgspec.msgpack.encode({"type": ["a"]}),
            msgspec.msgpack.encode({"type": "CommandTriggerMessage", "uuid": "a", "more": 1})]
)  # fmt: skip
def test_bytes_that_are_no_message_are_said_to_be_none(raw) -> None:
    assert isinstance(decoded(raw), str)


def nonsense(rng: random.Random, uuids: list[str]) -> bytes:
    """Bytes, maps, or messages with wrong fields."""
    if rng.random() < 0.2:
        return rng.randbytes(rng.randrange(60))
    scraps = (
        None,
        True,
        -1,
        1e300,
        float("nan"),
        "x",
        "y" * 300,
        [],
        {},
        [1, "a"],
        {"value": 1.0},
        {"max": 3},
        {"value": {}},
    )
    kinds = ["GuiUpdateMessage", "CommandTriggerMessage", "ViewerCameraMessage", "ShareUrlRequest", "RunJavascriptMessage",
             "GuiFormSubmitMessage", "FileTransferStartUpload", "SceneNodeClickMessage", "Gibberish"]  # fmt: skip
    fields = ("uuid", "updates", "wxyz", "position", "source", "name", "value", "fov", "transfer_uuid", "removed")
    body = {name: rng.choice([*scraps, rng.choice(uuids)]) for name in rng.sample(fields, rng.randrange(len(fields)))}
    if rng.random() < 0.5:
        body = {"uuid": rng.choice(uuids), "updates": rng.choice([{"value": rng.choice(scraps)}, rng.choice(scraps)])}
    return msgspec.msgpack.encode({"type": rng.choice(kinds), **body})


def test_a_thousand_of_them_change_nothing_but_an_error_that_is_shown(server, fake_page, wait_until) -> None:
    gui, heard = server.viser.gui, []
    controls = [
        gui.add_slider("s", min=0.0, max=2.0, step=0.1, initial_value=1.0),
        gui.add_dropdown("d", ("p", "q")),
        gui.add_number("n", 3, min=0, max=9),
        gui.add_text("t", "a"),
    ]
    for control in controls:
        control.on_update(lambda _: heard.append("update"))
    gui.add_command("abort", hotkey="escape").on_trigger(lambda _: heard.append("command"))
    before = [control.value for control in controls]
    page, rng = fake_page(server), random.Random(12)
    # A text control takes texts: those are no nonsense, and not among what is sent to it.
    uuids = [c._impl.uuid for c in controls[:3]]
    sent = 0
    for _ in range(1000):
        raw = nonsense(rng, uuids)
        message = decoded(raw)
        if isinstance(message, str) or objection(message, gui, True) is not None:
            page.socket.send(raw)
            sent += 1
    assert sent > 900
    assert wait_until(lambda: server.ignored == sent, 20.0), (server.ignored, sent)
    assert [control.value for control in controls] == before
    assert heard == []
    assert server.pages == 1
    assert len(server.said) == sent
    assert all(words.endswith("it was ignored") for words in server.said)
    # It is as alive as before.
    page.set(controls[0], 1.5)
    assert wait_until(lambda: controls[0].value == 1.5)
    assert wait_until(lambda: heard == ["update"])
