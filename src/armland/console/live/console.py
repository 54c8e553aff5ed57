"""The console: the page on which a live flight is watched and steered."""

import sys
import threading
import time
from collections import deque

import numpy as np

from armland.console.gauges import (
    bars_html,
    bars_of,
    flags_of,
    lines_html,
    shares_html,
    strip_html,
)
from armland.console.live.choices import Choices
from armland.console.live.controls import Controls
from armland.console.live.forecast import AT_ONCE, Thrown, end_of, forecast, outcome, table_html, waits_html
from armland.console.live.pilot import Now, Pilot, Steered, drained, joined_rows
from armland.console.page.copying import command_html
from armland.console.page.look import look, plots_panel, put, put_camera
from armland.console.page.server import PageServer
from armland.console.plots import Charts, curves_of
from armland.console.stage.stage import Stage
from armland.experiments.judge.deck import seen_from_deck
from armland.mission.plan import Plan
from armland.mission.supervisor.operator import HELD_BY_HAND, OPERATOR
from armland.mission.supervisor.table import FAULTS
from armland.records import Records
from armland.rotations import Array
from armland.view.figures.flight import upward_forces_n

FRAME_S = 1.0 / 30.0

TURN_S = 2e-4
"""How long a thread of Python may keep another waiting."""

REST_EVERY = 4
"""Frames between two looks of plots and texts."""

SIGHT_EVERY = 10
"""Frames between two pictures of what the camera sees."""

WINDOW = 12 * 30
"""Points of the plots: 12 s."""

MESSAGES, ERROR_S = 4, 12.0
"""Lines of what was said that stay on the page, and for how long, s."""


class Console:
    """A console that is served.

    Args:
        server: with nothing on its page yet.
        pilot: who flies.
        first: what is chosen at first.
        settings: values of the scenario that the command line replaced, for the command that does it again.
    """

    def __init__(self, server: PageServer, pilot: Pilot, first: Choices, settings: tuple[str, ...] = ()) -> None:
        self._server, self._pilot, self._settings = server, pilot, settings
        self._said: deque[tuple[float, str]] = deque(maxlen=MESSAGES)
        self._flight: Steered | None = None
        self._stage: Stage | None = None
        self._rows: deque[Records] = deque(maxlen=WINDOW)
        self._phases: list[int] = []
        self._begun: list[int] = []
        self._thrown: deque[Thrown] = deque(maxlen=20)
        self._outcomes: deque[str] = deque(maxlen=5)
        self._fault, self._number, self._asked = 0, 0, (0.0, -1.0)
        self._closed = threading.Event()
        gui = server.viser.gui
        look(server.viser)
        self._status, self._errors, self._strip = (gui.add_html("") for _ in range(3))
        self.controls = Controls(gui, pilot, first, self.say)
        self.controls.picked, self.controls.thrown = self._forecast, self._note_thrown
        self._gauges = gui.add_html("")
        self._again = gui.add_html("")
        self.controls.build_rest()
        with plots_panel(server.viser):
            self._sight = gui.add_html("")
            self._charts = Charts(gui, ["now"])
        put_camera(server.viser, np.array([0.6, 0.0, 0.8]))

    def say(self, words: str) -> None:
        """Show something that a person should read."""
        self._said.append((time.monotonic(), words))

    def run(self) -> None:
        """Serve until `close`."""
        frame = 0
        # The thread that flies takes its turn at once, and need not wait until this one has drawn a whole picture.
        sys.setswitchinterval(TURN_S)
        while not self._closed.wait(FRAME_S):
            frame += 1
            flight = self._pilot.flight
            if flight is not None and flight is not self._flight:
                self._begin(flight)
            self._take_over()
            if self._flight is None or self._flight.now is None:
                if frame % REST_EVERY == 0:
                    self._show_texts(None)
                continue
            with self._server.viser.atomic():
                self._show(self._flight.now, frame)

    def _show(self, now: Now, frame: int) -> None:
        rest = frame % REST_EVERY == 0
        if self._server.pages:
            self._show_scene(now)
            if rest:
                self._show_plots()
            # Between two looks of plots and texts, so that no frame does all.
            if frame % SIGHT_EVERY == 1 and self._stage is not None:
                put(self._sight, self._stage.sight(now.tick[0], 1.0 / self._pilot.pace.rate_hz))
        if rest:
            self._show_texts(now)

    def close(self) -> None:
        """End `run`."""
        self._closed.set()

    def _begin(self, flight: Steered) -> None:
        self._flight, plan, scenario = flight, flight.flight.plan, flight.flight.scenario
        scene = flight.flight.simulator.scene
        envelope = float(plan.thresholds.get("align_offset_m", 0.0))
        if self._stage is None or not self._stage.take(scene, plan.weight_n, scenario, envelope):
            if self._stage is not None:
                self._stage.remove()
            self._number += 1
            name = f"/flight_{self._number}"
            self._stage = Stage(self._server.viser.scene, scene, name, plan.weight_n, scenario, envelope)
        self._rows.clear()
        self._phases, self._begun, self._fault = [], [], 0
        self._thrown.clear()
        self._outcomes.clear()
        self._way: Array | None = way_of(plan)
        self.controls.offer([p.name for p in plan.phases if not p.final and p.name not in HELD_BY_HAND])
        self._brief = flight.flight.brief
        self._shown = ("", "")
        self._forecast()

    def _take_over(self) -> None:
        if self._flight is None:
            return
        for rows in drained(self._flight.thinned):
            self._rows.extend(rows[i : i + 1] for i in range(len(rows)))
        if (now := self._flight.now) is not None:
            mission = now.tick["mission"]
            phase, fault = int(mission["phase"][0]), int(mission["fault"][0])
            if self._phases[-1:] != [phase]:
                self._phases.append(phase)
                self._begun.append(
                    int(mission["tick"][0]) - round(float(mission["elapsed"][0]) * self._pilot.pace.rate_hz)
                )
            if fault != self._fault:
                self._fault = fault
                self._note_outcome(now)

    def _show_scene(self, now: Now) -> None:
        assert self._stage is not None
        wind = now.air if np.isfinite(now.air).all() else None
        self._stage.show(now.tick[0], wind)
        assert self._flight is not None
        share = next((m.value for m in reversed(self._flight.done) if m.do == "sea"), 1.0)
        self._stage.wave(float(now.tick["measurement"]["tick"][0]) / self._pilot.pace.rate_hz, share)
        if self._way is not None:
            self._stage.draw_path(now.tick["truth"][0], self._way)
            # It stands still but on a deck that moves.
            if not now.tick["truth"]["deck_quat"][0, 1:].any():
                self._way = None

    def _show_plots(self) -> None:
        if len(self._rows) > 1 and self._flight is not None:
            rows = joined_rows(list(self._rows))
            period = 1.0 / self._flight.flight.scenario.run.rate_hz
            self._charts.show(curves_of(seen_from_deck(rows), period))  # type: ignore[arg-type]

    def _show_texts(self, now: Now | None) -> None:
        recent = [words for at, words in self._said if time.monotonic() - at < ERROR_S]
        put(self._errors, lines_html(recent, warning=True))
        if self._flight is None or now is None:
            ended = self._pilot.ended
            words = "preparing the flight" if self._pilot.preparing else "press start, or Enter"
            put(self._status, lines_html([words, *([f"✗ {ended.words}"] if ended is not None else [])]))
            return
        plan, tick = self._flight.flight.plan, now.tick[0]
        put(self._status, self._status_html(now))
        put(self._strip, strip_html(plan.names, self._phases[-16:], int(tick["mission"]["phase"])))
        rotors, arm, cradle = (float(f[0]) for f in upward_forces_n({"truth": now.tick["truth"]}))
        bars = bars_of(tick, self._brief.limits, 1e-3 * plan.scenario.limits.uav_age_ms)
        flags = flags_of(tick)
        put(
            self._gauges,
            waits_html(plan, now, plan.thresholds)
            + shares_html(rotors, arm, cradle)
            + bars_html(bars)
            + lines_html([f"limits at work: {', '.join(flags)}"] if flags else []),
        )
        put(self.controls.outcomes, lines_html(list(self._outcomes)))
        self._forecast()
        self._show_command()

    def _status_html(self, now: Now) -> str:
        pilot, seconds = self._pilot, float(now.tick["measurement"]["tick"][0]) / self._pilot.pace.rate_hz
        wall, before = time.perf_counter(), self._asked
        factor = (seconds - before[1]) / max(wall - before[0], 1e-6)
        self._asked = wall, seconds
        target = "as fast as it goes" if not pilot.pace.factor else f"{pilot.pace.factor:g} asked for"
        lines = [f"{seconds:.3f} s simulated, {max(factor, 0.0):.2f} × real time ({target})"]
        if pilot.preparing:
            lines = ["preparing the next flight"]
        elif pilot.ended is not None:
            lines = [f"{seconds:.3f} s simulated", f"{'✓' if pilot.ended.success else '✗'} {pilot.ended.words}"]
        elif pilot.pace.paused:
            lines = [f"{seconds:.3f} s simulated, paused"]
        return lines_html(lines)

    def _show_command(self) -> None:
        pilot = self._pilot
        if pilot.choices is None:
            return
        steered = self._flight is not None and bool(self._flight.done)
        command = pilot.choices.command(pilot.log if steered else None, self._settings)
        waits = "with the operator's messages when the log is whole" if steered and pilot.log is None else ""
        put(self._again, command_html(command, waits))

    def _forecast(self) -> None:
        if self._flight is None:
            return
        plan, (fault, phase) = self._flight.flight.plan, self.controls.cell()
        where = self._present(plan) if phase == AT_ONCE else phase
        if self._shown != (fault, where):
            self._shown = fault, where
            put(self.controls.forecast, lines_html([forecast(plan, fault, where)]))
            put(self.controls.table, table_html(plan, (fault, where)))

    def _present(self, plan: Plan) -> str:
        now = None if self._flight is None else self._flight.now
        return plan.names[0 if now is None else int(now.tick["mission"]["phase"][0])]

    def _note_thrown(self, fault: str, phase: str) -> None:
        if self._flight is not None:
            plan = self._flight.flight.plan
            where = self._present(plan) if phase == AT_ONCE else phase
            self._thrown.append(Thrown(fault, where, end_of(plan, fault, where)))

    def _note_outcome(self, now: Now) -> None:
        assert self._flight is not None
        plan, mission = self._flight.flight.plan, now.tick["mission"][0]
        names = (*FAULTS, OPERATOR)
        found, end = names[int(mission["fault"])], plan.names[int(mission["phase"])]
        before = plan.names[self._phases[-2]] if len(self._phases) > 1 else end
        if found == OPERATOR:
            self._outcomes.append(f"aborted by hand in {before}, went to {end}")
        elif self._thrown:
            thrown = self._thrown[-1]
            told = [m.tick for m in self._flight.done if m.do == "fault"][-1:]
            # It fails when the phase begins for which it was thrown in, if that is later.
            told += self._begun[-2:-1] if thrown.phase == before else []
            since = (self._begun[-1] - max(told, default=self._begun[-1])) / self._pilot.pace.rate_hz
            self._outcomes.append(outcome(thrown, found, before, end, since))
        else:
            self._outcomes.append(f"the supervisor found {found} in {before}, went to {end}")


def way_of(plan: Plan) -> Array | None:
    """Where the end effector is to go (k, 3), m, D: the points of the mission, or its path."""
    if len(plan.path) > 1:
        return np.array(plan.path[::50, :3])
    points = [
        np.array(getattr(plan.scenario.place, at.place)) + [0.0, 0.0, at.height(plan.scenario)]
        for at in plan.mission.points(plan.scenario)
    ]
    return np.array(points) if len(points) > 1 else None
