"""How pages look: light and dark, and where their camera stands."""

import numpy as np

from armland.console.page.look import look, plots_panel, put_camera


def themes(server) -> list[bool]:
    messages = server.viser._websock_server._broadcast_buffer.message_from_id.values()
    return [m.dark_mode for m in messages if type(m).__name__ == "ThemeConfigurationMessage"]


def test_light_at_first_and_dark_by_the_switch(server, fake_page, wait_until) -> None:
    look(server.viser)
    assert themes(server) == [False]
    gui, page = server.viser.gui, fake_page(server)
    (switch,) = gui._gui_input_handle_from_uuid.values()
    page.set(switch, True)
    assert wait_until(lambda: themes(server) == [True])
    (key,) = gui._command_handle_from_uuid.values()
    assert key.hotkey == "L"
    page.press(key)
    assert wait_until(lambda: themes(server) == [False])


def test_the_camera_looks_at_what_is_shown(server) -> None:
    put_camera(server.viser, np.array([0.5, 0.1, 0.8]))
    camera = server.viser.initial_camera
    np.testing.assert_allclose(camera.look_at[:2], [0.5, 0.1])
    assert 0.5 < np.linalg.norm(np.array(camera.position) - camera.look_at) < 3.0
    put_camera(server.viser, np.full(3, np.nan))
    assert np.isfinite(server.viser.initial_camera.look_at).all()


def test_plots_stand_in_a_panel_of_their_own(server) -> None:
    with plots_panel(server.viser):
        html = server.viser.gui.add_html("x")
    assert html._impl.parent_container_id != "root"
