"""The sea, and the hull on it that carries the arm; the controller is told nothing of it."""

from typing import Annotated, ClassVar, Literal

from armland.scenario import quantities as of
from armland.scenario.environment import Bearing
from armland.scenario.quantities import Section, between, key

STATES: dict[str, tuple[float, float]] = {
    "ss1": (0.05, 2.5),
    "ss2": (0.3, 6.3),
    "ss3": (0.88, 7.5),
    "ss4": (1.88, 8.8),
}
"""Significant wave height, m, and modal period, s: the most probable of STANAG 4194; of sea state 1 it gives no period: assumption."""

State = Literal["calm", "ss1", "ss2", "ss3", "ss4", "tank"]


class Sea(Section):
    """How the deck moves. Angles of waves: towards where they travel, from the bow counter-clockwise; 180 is a head sea."""

    state: State = key(
        "calm", "sea state, by its most probable height and period; `tank`: a floating platform's own statistics"
    )
    height_m: Annotated[float, between(0.01, 15.0)] | None = key(
        None, "significant wave height in place of the state's"
    )
    period_s: Annotated[float, between(0.8, 25.0)] | None = key(None, "modal period in place of the state's")
    spectrum: Literal["bretschneider", "jonswap"] = key("bretschneider", "shape of the wave spectrum")
    peak: Annotated[float, between(1.0, 7.0)] = key(3.3, "γ of `jonswap`, a ratio")
    spectrum_file: of.Text | None = key(
        None, "own spectrum: CSV with omega_radps, density_m2s; in place of state, height, period and shape"
    )
    crests: Literal["short", "long"] = key(
        "short", "spread by cos² over ±90 degrees about the main direction, or all waves in it"
    )
    towards_deg: Bearing | None = key(
        None, "where the waves travel to, from the bow counter-clockwise; drawn for each seed if absent"
    )
    speed_mps: Annotated[float, between(0.0, 20.0)] = key(0.0, "of the hull, ahead")
    hull_m: Annotated[float, between(0.5, 50.0)] = key(4.0, "length of a hull that follows the waves' contour")
    beam_m: Annotated[float, between(0.2, 50.0)] | None = key(None, "its beam; 0.4 of its length if absent")
    response_file: of.Text | None = key(None, "the hull's response instead: CSV of `docs/sea.md`")
    trace: of.Text | None = key(None, "recorded motion of the deck instead of waves: CSV of `docs/sea.md`")
    base_m: of.Point = key((0.0, 0.0, 0.0), "the arm's base on the hull, from the point whose motion is stated")

    MADE_BY: ClassVar[tuple[str, ...]] = (
        *("spectrum", "peak", "crests", "towards_deg", "speed_mps", "hull_m", "beam_m", "response_file"),
        *("height_m", "period_s", "spectrum_file"),
    )

    @property
    def moves(self) -> bool:
        """Whether the deck moves at all."""
        return self.waves or self.state == "tank" or self.trace is not None

    @property
    def waves(self) -> bool:
        """Whether waves move it."""
        own = self.spectrum_file is not None or (self.height_m is not None and self.period_s is not None)
        return self.trace is None and (own or self.state in STATES)

    @property
    def height_period(self) -> tuple[float, float]:
        """Significant wave height, m, and modal period, s."""
        height, period = STATES.get(self.state, (0.0, 0.0))
        return self.height_m or height, self.period_s or period

    def _contradictions(self) -> list[str]:
        found = []
        changed = [n for n in (*self.MADE_BY, "base_m") if getattr(self, n) != type(self).model_fields[n].default]
        if self.trace is not None and self.state != "calm":
            found.append(f"trace: a recorded deck has a motion of its own; leave out state = {self.state!r}")
        if not self.moves:
            found += [f"{n} has no effect on a calm sea; say state = 'ss2', or give a trace" for n in changed]
        elif not self.waves:
            found += [f"{n} has no effect without waves" for n in changed if n != "base_m"]
        elif self.spectrum_file is not None:
            wrong = [n for n in ("height_m", "period_s", "spectrum", "peak") if n in changed]
            found += [f"{n} has no effect beside spectrum_file, which has its own" for n in wrong]
            if self.state != "calm":
                found.append(f"spectrum_file stands for the waves; leave out state = {self.state!r}")
        if self.spectrum == "bretschneider" and "peak" in changed:
            found.append("peak has no effect without spectrum = 'jonswap'")
        if self.response_file is not None:
            found += [f"{n} has no effect beside response_file" for n in ("hull_m", "beam_m") if n in changed]
        return list(dict.fromkeys(found))
