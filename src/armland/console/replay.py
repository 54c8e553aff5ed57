"""The replay: one recorded flight, or two in one scene, scrubbed through in the browser."""

import contextlib
import threading
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

from armland.console.gauges import (
    bars_html,
    bars_of,
    flags_of,
    lines_html,
    runs_of,
    shares_html,
    strip_html,
)
from armland.console.page.copying import command_html
from armland.console.page.look import in_order, look, plots_panel, put, put_camera
from armland.console.page.server import PageServer
from armland.console.plots import Charts, Curves, cut
from armland.console.recording import Event, Recording, threshold
from armland.console.stage.stage import Stage
from armland.errors import LogError
from armland.experiments.judge.brief import brief_of
from armland.view.figures.flight import upward_forces_n

SPEEDS = ("1/16", "1/8", "1/4", "1/2", "1", "2", "4", "8")

FRAME_S = 1.0 / 30.0
"""Of the scene; plots and texts follow at a third of it."""

WINDOW_S = 12.0

SILENT_S = 0.25
"""Age of the UAV's sample at which it counts as silent where a log does not say."""

WHOLE = "whole flight"


class Replay:
    """A replay that is served.

    Args:
        server: with nothing on its page yet.
        recordings: one, or two that are compared.
    """

    def __init__(self, server: PageServer, recordings: Sequence[Recording]) -> None:
        self._server, self._runs = server, list(recordings)
        self._first = self._runs[0]
        self.time = self._first.begin
        """What is shown, s."""
        self.playing = False
        """Whether time goes on."""
        self._speed, self._moved, self._closed = 1.0, True, threading.Event()
        self._notes = [note for run in self._runs for note in run.notes]
        self._limits: dict[str, Any] = {}
        with contextlib.suppress(LogError):
            self._limits = brief_of(self._first.log.metadata).limits
        self._other = _beside(self._first, self._runs[1]) if len(self._runs) > 1 else None
        gui = server.viser.gui
        look(server.viser)
        self._build_stages()
        self._build_controls(gui)
        self._status = gui.add_html("")
        gui.add_html("".join(command_html(run.command) for run in self._runs if run.command))
        with plots_panel(server.viser):
            self._sight = gui.add_html("")
            numbers = [str(i) for i, _ in enumerate(self._runs, start=1)]
            self._charts = Charts(gui, numbers, any(run.joints for run in self._runs))

    @property
    def events(self) -> list[Event]:
        """What happened, in both flights."""
        if len(self._runs) == 1:
            return self._first.events
        marked = [(e, i) for i, run in enumerate(self._runs, start=1) for e in run.events]
        return sorted(Event(e.time, e.kind, f"{e.words} [{i}]") for e, i in marked)

    def run(self) -> None:
        """Serve until `close`."""
        frame, last = 0, time.perf_counter()
        while not self._closed.wait(FRAME_S):
            now = time.perf_counter()
            if self.playing:
                self.go_to(self.time + self._speed * (now - last))
            last = now
            if self._moved and self._server.pages:
                frame += 1
                self._moved = False
                self._show_scene()
                self._show_rest(frame % 3 == 0 or not self.playing)

    def close(self) -> None:
        """End `run`."""
        self._closed.set()

    def go_to(self, to: float) -> None:
        """Show a time, s, or the nearest that there is."""
        self.time = float(np.clip(to, self._first.begin, self._first.end))
        self._moved = True
        if self.time >= self._first.end:
            self._play(False)

    def _play(self, on: bool) -> None:
        if on and self.time >= self._first.end:
            self.go_to(self._first.begin)
        if on != self.playing:
            self.playing, self._moved = on, True
            self._button.label = "Pause" if on else "Play"

    def _build_stages(self) -> None:
        self._stages: list[tuple[Recording, Stage]] = []
        for i, run in enumerate(self._runs):
            if run.scene is None:
                continue
            envelope = threshold(run.log.metadata, "align_offset_m")
            api = self._server.viser.scene
            stage = Stage(api, run.scene, f"/flight_{i + 1}", run.weight, run.scenario, envelope, i > 0, run.armless)
            self._stages.append((run, stage))
        if self._stages:
            first, stage = self._stages[0]
            seen = first.at(0.0)["truth"]["ee"] if first.joints else stage.poses.scene.put_down
            put_camera(self._server.viser, np.array(seen))

    def _build_controls(self, gui: Any) -> None:
        names = [run.name for run in self._runs]
        gui.add_html(
            lines_html(names if len(names) == 1 else [f"{i}: {name}" for i, name in enumerate(names, start=1)])
        )
        if self._notes:
            gui.add_html(lines_html(self._notes, warning=True))
        self._strip = gui.add_html("")
        self._slider = gui.add_slider(
            "time (s)", min=self._first.begin, max=self._first.end, step=0.001, initial_value=self._first.begin
        )
        self._slider.on_update(
            in_order(lambda event: self.go_to(event.target.value) if event.client is not None else None)
        )
        self._button = gui.add_button("Play")
        self._button.on_click(in_order(lambda _: self._play(not self.playing)))
        speed = gui.add_dropdown("speed", SPEEDS, initial_value="1")
        speed.on_update(in_order(lambda event: self._set_speed(event.target.value)))
        events = [f"{e.time:8.3f} s  {e.kind}: {e.words}" for e in self.events]
        jump = gui.add_dropdown("jump to", ["-", *dict.fromkeys(events)], initial_value="-")
        jump.on_update(in_order(lambda event: self._jump(event.target.value)))
        steps = gui.add_button_group("event", ("previous", "next"))
        steps.on_click(in_order(lambda event: self._step(1 if event.target.value == "next" else -1)))
        self._window = gui.add_dropdown("plots show", (f"{WINDOW_S:g} s", WHOLE), initial_value=WHOLE)
        self._window.on_update(in_order(lambda _: self.go_to(self.time)))
        for label, key, act in (
            ("play or pause", "space", lambda _: self._play(not self.playing)),
            ("a tenth of a second back", "J", lambda _: self.go_to(self.time - 0.1)),
            ("a tenth of a second on", "K", lambda _: self.go_to(self.time + 0.1)),
        ):
            gui.add_command(label, hotkey=key).on_trigger(in_order(act))

    def _set_speed(self, text: str) -> None:
        over, _, under = text.partition("/")
        self._speed = float(over) / float(under or 1)

    def _jump(self, text: str) -> None:
        if text != "-":
            self._play(False)
            self.go_to(float(text.split(" s ")[0]))

    def _step(self, way: int) -> None:
        times = sorted({e.time for e in self.events})
        ahead = [t for t in times if (t > self.time + 1e-6 if way > 0 else t < self.time - 1e-6)]
        if ahead:
            self._play(False)
            self.go_to(ahead[0] if way > 0 else ahead[-1])

    def _show_scene(self) -> None:
        with self._server.viser.atomic():
            for run, stage in self._stages:
                tick = run.at(self.time)
                stage.show(tick, run.wind(self.time))
                stage.draw_path(tick["truth"], run.ahead(self.time))
                stage.wave(self.time, run.share_of_sea(self.time))

    def _show_rest(self, all_of_it: bool) -> None:
        if not all_of_it:
            return
        self._slider.value = self.time
        run = self._first
        tick = run.at(self.time)
        k = int(np.searchsorted(run.curves.time, self.time))
        phase = tick["mission"]["phase"]
        # Thinned, a phase shows a moment after its begin.
        flown = runs_of(np.append(run.curves.phase[:k], phase))
        self._strip.content = strip_html(run.phases, flown, int(phase))
        self._status.content = self._status_html(run)
        if self._stages and self._stages[0][0] is run:
            put(self._sight, self._stages[0][1].sight(tick, run.period_s))
        curves, other = run.curves, self._other
        if self._window.value != WHOLE:
            begin = max(run.begin, min(self.time - 0.5 * WINDOW_S, run.end - WINDOW_S))
            curves = cut(curves, begin, begin + WINDOW_S)
            other = None if other is None else cut(other, begin, begin + WINDOW_S)
        self._charts.show(curves, other, self.time)

    def _status_html(self, run: Recording) -> str:
        tick = run.at(self.time)
        rotors, arm, cradle = (float(f[0]) for f in upward_forces_n({"truth": tick["truth"][None]}))
        done = [
            f"{e.time:.2f} s  {e.kind}: {e.words}" for e in self.events if e.kind != "phase" and e.time <= self.time
        ]
        flags = flags_of(tick)
        lines = [f"{self.time:.3f} s, {run.phase(tick).replace('_', ' ')} for {tick['mission']['elapsed']:.2f} s"]
        lines += [f"limits at work: {', '.join(flags)}"] if flags else []
        return (
            lines_html(lines)
            + shares_html(rotors, arm, cradle, not run.joints)
            + bars_html(bars_of(tick, self._limits, SILENT_S))
            + lines_html(done[-4:], warning=True)
        )


def _beside(first: Recording, second: Recording) -> Curves:
    """The curves of the second flight at the times of the first; where it was over, as it ended: a chart knows no gaps."""
    time, own = first.curves.time, second.curves
    lines = tuple(tuple(np.interp(time, own.time, line) for line in panel) for panel in own.lines)
    return Curves(time, first.curves.phase, first.curves.fault, lines)
