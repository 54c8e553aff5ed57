"""How every page looks: light or dark, the panel at the side, where the camera stands."""

from collections.abc import Callable, Coroutine
from typing import Any

import numpy as np
import viser

from armland.rotations import Array

BLUE = (0, 114, 178)

NARROW = """<style>@media (max-width: 36em) {
  .mantine-Paper-root[style*="20em"] { width: 100% !important; max-height: 55% !important; }
  .mantine-Paper-root[style*="20em"] div[style="width: 20em;"] { width: 100% !important; }
  div[style*="flex-grow: 1"][style*="height: 100%"]:has(canvas) { height: 45% !important; }
}</style>"""
"""In a narrow window viser's panel is a sheet over the scene's lower right: it goes below the scene, as wide as the window."""


def look(server: viser.ViserServer) -> None:
    """Set theme, light and background, and the switch between light and dark."""
    _theme(server, dark=False)
    server.gui.main_panel.dock_right()
    server.gui.main_panel.set_width(430)
    server.gui.add_html(NARROW)
    switch = server.gui.add_checkbox("dark", initial_value=False)
    switch.on_update(in_order(lambda event: _theme(server, dark=event.target.value)))
    server.gui.add_command("light or dark", hotkey="L").on_trigger(in_order(lambda _: _toggle(switch)))


def in_order(act: Callable[[Any], object]) -> Callable[[Any], Coroutine[Any, Any, None]]:
    """Let `act` take each event as it comes, with the value that it came with: in viser's pool of threads a later one may overtake it.

    It must not wait for anything.
    """

    async def take(event: Any) -> None:
        act(event)

    return take


def _toggle(switch: Any) -> None:
    switch.value = not switch.value


def _theme(server: viser.ViserServer, dark: bool) -> None:
    server.gui.configure_theme(dark_mode=dark, show_logo=False, show_share_button=False, brand_color=BLUE)


def put(html: Any, content: str) -> None:
    """Let a piece of HTML say `content`; what has not changed is not sent again."""
    if getattr(html, "content", None) != content:
        html.content = content


def put_camera(server: viser.ViserServer, target: Array) -> None:
    """Let new pages look at `target` (3,), m, W, from where arm, UAV and cradle are seen."""
    aim = target if np.isfinite(target).all() else np.zeros(3)
    aim = np.array([aim[0], aim[1], 0.6 * aim[2]])
    server.initial_camera.position = tuple(aim + [1.05, -1.35, 0.65])
    server.initial_camera.look_at = tuple(aim)
    server.initial_camera.up = (0.0, 0.0, 1.0)


def plots_panel(server: viser.ViserServer) -> viser.GuiTabHandle:
    """A panel for plots at the other side of the scene: what is added inside its `with` block stands in it."""
    panel = server.gui.add_panel()
    tab = panel.add_tab("plots")
    panel.dock_left()
    panel.set_width(400)
    return tab
