"""The controls of the console: what is chosen, pressed, moved and thrown in; each hands a checked message on, or says what is wrong."""

import contextlib
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from viser import GuiApi

from armland.console.gauges import lines_html
from armland.console.live.choices import OWN, SEAS, Choices, chosen
from armland.console.live.forecast import AT_ONCE, failure
from armland.console.live.pace import FACTORS, FASTEST
from armland.console.live.pilot import Pilot
from armland.console.page.look import in_order
from armland.control.laws.table import LAWS
from armland.errors import ArmlandError, ConfigurationError
from armland.experiments.operator.message import Message, asked
from armland.experiments.operator.provoked import PROVOKED
from armland.mission.registry import MISSIONS
from armland.scenario import SCENARIOS
from armland.scenario.files.airframe import AIRFRAMES

SLIDERS = {
    "wind": ("wind (m/s)", 0.0, 12.0, 0.1, 0.0),
    "sea": ("sea (share)", 0.0, 2.0, 0.05, 1.0),
    "delay": ("link delay (+ms)", 0.0, 200.0, 1.0, 0.0),
    "noise": ("sensor noise (×)", 0.0, 5.0, 0.1, 1.0),
    "mass": ("UAV mass (×)", 0.5, 1.5, 0.01, 1.0),
}
"""Verb -> label, lowest, highest, step and resting value of its slider."""

AS_SCENARIO = "as in the scenario"

Said = Callable[[str], None]


class Controls:
    """The controls.

    Args:
        gui: where they are added.
        pilot: whom they tell.
        first: what is chosen at first.
        said: takes what is wrong, for the page.
    """

    def __init__(self, gui: GuiApi, pilot: Pilot, first: Choices, said: Said) -> None:
        self._gui, self._pilot, self._said, self._first = gui, pilot, said, first
        self.picked: Callable[[], None] = lambda: None
        """Called when another cell of the fault table was chosen."""
        self.thrown: Callable[[str, str], None] = lambda fault, phase: None
        """Called with fault and phase when one was thrown in."""
        self._build_buttons()
        self._build_keys()

    def build_rest(self) -> None:
        """Add what stands below the gauges: sliders, faults and the next flight, each in a tab."""
        tabs = self._gui.add_tab_group()
        with tabs.add_tab("steer"):
            self._build_sliders()
        with tabs.add_tab("faults"):
            self._build_faults()
        with tabs.add_tab("next flight"):
            self._build_choices()

    def choices(self) -> Choices:
        """What is chosen for the next flight.

        Raises:
            ConfigurationError: all that is wrong with it.
        """
        values: dict[str, Any] = {name: control.value for name, control in self._choice.items()}
        for name, default in (("law", OWN), ("uav", AS_SCENARIO), ("sea", SEAS[0])):
            values[name] = "" if values[name] == default else values[name]
        values["seed"] = int(values["seed"])
        values["wind"] = float(self._slider["wind"].value)
        return chosen(values)

    def cell(self) -> tuple[str, str]:
        """Fault and phase that are chosen in the table."""
        return str(self._fault.value), str(self._phase.value)

    def offer(self, phases: list[str]) -> None:
        """Let faults be thrown in at the begin of these phases of the flight, too."""
        self._phase.options = [AT_ONCE, *phases]

    def start(self, seed: int | None = None) -> None:
        """Fly what is chosen, with another seed if one is given."""
        with self._telling():
            if seed is not None:
                self._choice["seed"].value = seed
            self._pilot.start(self.choices(), self._resting_sliders())

    def _resting_sliders(self) -> list[Message]:
        # What the sliders say besides the wind, which the scenario takes over, holds for the next flight as well.
        told = []
        for verb, (_, _, _, _, rest) in SLIDERS.items():
            value = float(self._slider[verb].value)
            if verb != "wind" and value != rest and (verb != "sea" or self._choice["sea"].value != SEAS[0]):
                told.append(asked(verb, value))
        return told

    def _build_buttons(self) -> None:
        gui = self._gui
        run = gui.add_button_group("flight", ("start", "hold", "go on", "abort"))
        run.on_click(in_order(lambda event: self._press(event.target.value)))
        again = gui.add_button_group("seed", ("retry", "next seed"))
        again.on_click(in_order(lambda event: self._press(event.target.value)))
        clock = gui.add_button_group("time", ("pause", "run", "1 tick", "10 ticks"))
        clock.on_click(in_order(lambda event: self._press(event.target.value)))
        speed = gui.add_dropdown("times real time", (*FACTORS, FASTEST), initial_value="1")
        speed.on_update(in_order(lambda event: self._pilot.pace.set(FACTORS.get(event.target.value))))

    def _press(self, name: str) -> None:
        pace, seed = self._pilot.pace, int(self._choice["seed"].value)
        match name:
            case "start":
                self.start()
            case "retry":
                self.start(seed if self._pilot.choices is None else self._pilot.choices.seed)
            case "next seed":
                self.start(seed + 1)
            case "pause" | "run":
                pace.pause(name == "pause")
            case "1 tick" | "10 ticks":
                pace.pause(True)
                pace.step(int(name.split()[0]))
            case _:
                self._tell({"go on": "resume"}.get(name, name))

    def _build_choices(self) -> None:
        gui, first = self._gui, self._first
        uavs, scenarios = (
            sorted(p.stem for p in AIRFRAMES.glob("*.toml")),
            sorted(p.stem for p in SCENARIOS.glob("*.toml")),
        )
        known = [s for s in scenarios if s != "calibration"]
        uav, law = first.uav or AS_SCENARIO, first.law or OWN
        self._choice: dict[str, Any] = {
            "mission": gui.add_dropdown("mission", tuple(MISSIONS), initial_value=first.mission),
            "scenario": gui.add_dropdown("scenario", _with(known, first.scenario), initial_value=first.scenario),
            "arm": gui.add_text("arm (file, name)", first.arm),
            "ee": gui.add_text("tool frame", first.ee),
            "uav": gui.add_dropdown("UAV", _with([AS_SCENARIO, *uavs], first.uav), initial_value=uav),
            "law": gui.add_dropdown("law", _with([OWN, *LAWS], first.law), initial_value=law),
            "sea": gui.add_dropdown("sea state", SEAS, initial_value=first.sea or SEAS[0]),
            "seed": gui.add_number("seed", first.seed, min=0, max=2**31, step=1),
        }
        gui.add_html(lines_html(["What is chosen here acts from the next flight on."]))

    def _build_sliders(self) -> None:
        self._slider: dict[str, Any] = {}
        for verb, (label, low, high, step, rest) in SLIDERS.items():
            value = self._first.wind if verb == "wind" else rest
            slider = self._gui.add_slider(label, min=low, max=high, step=step, initial_value=min(value, high))
            slider.on_update(in_order(partial(self._slide, verb)))
            self._slider[verb] = slider
        self._gui.add_html(lines_html(["They act at once, and hold for the next flight; the log keeps each."]))

    def _slide(self, verb: str, event: Any) -> None:
        if event.client is None:
            return
        if not self._pilot.flying:
            self._said(f"{verb}: nothing flies; it acts from the next flight on")
            return
        self._tell(verb, float(event.target.value))

    def _build_faults(self) -> None:
        self._fault = self._gui.add_dropdown("fault", tuple(PROVOKED), initial_value="uav_silent")
        self._phase = self._gui.add_dropdown("phase", (AT_ONCE,), initial_value=AT_ONCE)
        for control in (self._fault, self._phase):
            control.on_update(in_order(lambda _: self.picked()))
        self.forecast = self._gui.add_html("")
        """Where the page says what the supervisor will do."""
        self._gui.add_button("throw it in").on_click(in_order(lambda _: self._throw()))
        self.outcomes = self._gui.add_html("")
        """Where it says what he did."""
        self.table = self._gui.add_html("")
        """Where the table fault × phase stands."""

    def _throw(self) -> None:
        with self._telling():
            fault, phase = self.cell()
            self._pilot.tell(asked("fault", fault=failure(fault, phase)))
            self.thrown(fault, phase)

    def _build_keys(self) -> None:
        gui = self._gui
        gui.add_command("hold, or go on", hotkey="space").on_trigger(in_order(lambda _: self._toggle_hold()))
        gui.add_command("abort", hotkey="escape").on_trigger(in_order(lambda _: self._tell("abort")))
        gui.add_command("start", hotkey="enter").on_trigger(in_order(lambda _: self.start()))
        pace = self._pilot.pace
        gui.add_command("pause, or run", hotkey="P").on_trigger(in_order(lambda _: pace.pause(not pace.paused)))
        gui.add_command("one tick", hotkey="N").on_trigger(in_order(lambda _: self._press("1 tick")))

    def _toggle_hold(self) -> None:
        flight = self._pilot.flight
        done = [m.do for m in flight.done if m.do in ("hold", "resume", "abort")] if flight is not None else []
        self._tell("resume" if done[-1:] == ["hold"] else "hold")

    def _tell(self, verb: str, value: float = 0.0) -> None:
        with self._telling():
            self._pilot.tell(asked(verb, value))

    @contextlib.contextmanager
    def _telling(self) -> Iterator[None]:
        try:
            yield
        except (ArmlandError, ConfigurationError) as no:
            self._said(str(no))


def _with(names: list[str], one: str) -> tuple[str, ...]:
    return tuple(names if not one or one in names else [*names, one])
