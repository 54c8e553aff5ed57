"""What is told many times a second reaches pages as what viser's own handles would have told."""

import numpy as np

from armland.console.page.often import put_curves, put_place, put_turn


def buffered(server) -> list:
    return list(server.viser._websock_server._broadcast_buffer.message_from_id.values())


def of(server, kind: str) -> list:
    return [m for m in buffered(server) if type(m).__name__ == kind]


def test_a_node_s_place_and_turn_are_as_by_its_handle(server) -> None:
    by_hand, by_viser = (server.viser.scene.add_frame(name) for name in ("/hand", "/viser"))
    place, turn = np.array([1.0, -2.0, 3.5]), np.array([0.5, 0.5, -0.5, 0.5])
    put_place(by_hand, place)
    put_turn(by_hand, turn)
    by_viser.position, by_viser.wxyz = place, turn
    for kind, field in (("SetPositionMessage", "position"), ("SetOrientationMessage", "wxyz")):
        hand, viser = ([m for m in of(server, kind) if m.name == name] for name in ("/hand", "/viser"))
        assert len(hand) == len(viser) == 1
        assert getattr(hand[0], field) == getattr(viser[0], field)
        assert hand[0].owner == viser[0].owner
    # And so that the handle knows it.
    np.testing.assert_array_equal(by_hand.position, place)
    np.testing.assert_array_equal(by_hand.wxyz, turn)


def test_a_chart_s_curves_are_as_by_its_handle(server) -> None:
    series = ({"label": "s"}, {"label": "a"})
    by_hand, by_viser = (server.viser.gui.add_uplot((np.zeros(2), np.zeros(2)), series) for _ in range(2))
    data = (np.arange(3.0), np.array([1.0, np.nan, 2.0]))
    put_curves(by_hand, data)
    by_viser.data = data
    sent = {m.uuid: m.updates["data"] for m in of(server, "GuiUpdateMessage") if "data" in m.updates}
    hand, viser = sent[by_hand._impl.uuid], sent[by_viser._impl.uuid]
    for a, b in zip(hand, viser, strict=True):
        np.testing.assert_array_equal(a, b)
        assert a.dtype == b.dtype
    assert by_hand.data is hand
