"""The world around: gravity, air and sea and how they move, a constant disturbance."""

import math
from typing import Annotated, ClassVar, Literal

from pydantic import AfterValidator, Field

from armland.scenario import quantities as of
from armland.scenario.quantities import Section, between, key

LEAST_GRAVITY = 0.1
"""m/s²."""

MOST_MPS = 50.0
"""Fastest air, m/s, of gusts and recordings: beyond, units or keyboard have slipped."""

Bearing = Annotated[float, between(-360.0, 360.0)]

STATES: dict[str, tuple[float, float]] = {
    "ss1": (0.05, 2.5),
    "ss2": (0.3, 6.3),
    "ss3": (0.88, 7.5),
    "ss4": (1.88, 8.8),
}
"""Significant wave height, m, and modal period, s: the most probable of STANAG 4194; of sea state 1 it gives no period: assumption."""

State = Literal["calm", "ss1", "ss2", "ss3", "ss4", "tank", "usv"]

MEASURED = ("tank", "usv")
"""Decks that move by their own published statistics, not by waves."""


def _gravity(value: of.Acceleration3) -> of.Acceleration3:
    if value[2] > -LEAST_GRAVITY or -value[2] < 0.5 * math.hypot(*value):
        raise ValueError(
            f"gravity must point downwards, within 60 degrees of -z and with at least {LEAST_GRAVITY:g} m/s² along it: "
            "loads are counted in shares of the UAV's weight"
        )
    return value


class Environment(Section):
    """What acts on everything."""

    gravity_mps2: Annotated[of.Acceleration3, AfterValidator(_gravity)] = key((0.0, 0.0, -9.81), "world axes")
    air_density_kgm3: Annotated[float, between(1e-3, 100.0)] = key(1.225, "of the air that the rotors move")


class Disturbance(Section):
    """A constant force and torque on the UAV that no model knows of."""

    force_n: of.Force3 = key((0.0, 0.0, 0.0), "at the centre of mass, world axes")
    torque_nm: of.Torque3 = key((0.0, 0.0, 0.0), "body axes")


class Gust(Section):
    """One gust of the shape ½A(1 − cos 2πx/l), 0 ≤ x ≤ l, carried along by the mean wind. Source: CS-25.341, l = 2H."""

    at_s: of.Seconds = Field(description="time at which it begins")
    peak_mps: Annotated[float, between(1e-3, MOST_MPS)] = Field(description="A, its largest speed")
    length_m: Annotated[float, between(0.1, 1000.0)] = Field(
        description="l, from its begin to its end along the mean wind"
    )
    direction: of.Direction | None = key(
        None,
        "components of the way it pushes, world, a ratio; along the mean wind if absent; [0, 0, 1] is an updraught",
    )

    def _contradictions(self) -> list[str]:
        return (
            ["direction = [0, 0, 0] points nowhere"] if self.direction is not None and not any(self.direction) else []
        )


class Forecast(Section):
    """What the user on site knows of the weather and tells the controller before a flight."""

    wind_mps: Annotated[float, between(0.0, 40.0)] | None = key(
        None, "mean wind at 20 ft that the controller is told, W20; air.wind_mps if absent, and never its direction"
    )
    deck_moves: bool | None = key(
        None, "whether the controller is told that the deck moves; as the sea has it if absent"
    )


class Air(Section):
    """Wind, of which the controller knows what the user foretells. Its heights are above ground or sea."""

    wind_mps: Annotated[float, between(0.0, 40.0)] = key(0.0, "mean speed at reference_m")
    reference_m: Annotated[float, between(0.5, 300.0)] = key(
        6.096, "height of that speed; 20 ft, where MIL-F-8785C measures its W20"
    )
    towards_deg: Bearing | None = key(
        None, "where the wind blows to, from the world's x axis counter-clockwise; drawn for each seed if absent"
    )
    profile: Literal["log", "power", "even"] = key(
        "log", "mean speed over height: ln(h/z0), (h/reference_m)^exponent, or the same everywhere"
    )
    roughness_m: Annotated[float, between(1e-5, 3.0)] = key(
        0.04572, "z0 of `log`; 0.15 ft, MIL-F-8785C for landing; 0.0002 over the open sea"
    )
    exponent: Annotated[float, between(0.01, 1.0)] = key(0.143, "of `power`, a ratio; 1/7 over open land")
    floor_m: Annotated[float, between(0.0, 200.0)] = key(0.0, "height of the world's z = 0 above ground or sea")
    turbulence: Literal["none", "by_wind", "light", "moderate", "severe"] = key(
        "none",
        "Dryden's, MIL-F-8785C at low altitude: as strong as its rule says of this wind, or of W20 = 15, 30 or 45 kt",
    )
    gusts: Annotated[tuple[Gust, ...], Field(max_length=20)] = key((), "single gusts on top")
    trace: of.Text | None = key(
        None,
        "recorded wind at the UAV: CSV with time_s, x, y, z in m/s, world axes, in place of mean wind and turbulence",
    )

    @property
    def blows(self) -> bool:
        """Whether there is any wind."""
        return self.steady or bool(self.gusts) or self.trace is not None

    @property
    def steady(self) -> bool:
        """Whether there is mean wind or turbulence."""
        return self.wind_mps > 0.0 or self.turbulence != "none"

    def _contradictions(self) -> list[str]:
        found, windy, turbulent = [], self.wind_mps > 0.0, self.turbulence != "none"
        if self.trace is not None and self.steady:
            found.append("trace: a recorded wind has mean and turbulence of its own; leave out wind_mps and turbulence")
        if self.turbulence == "by_wind" and not windy:
            found.append("turbulence = 'by_wind' is none without wind; say wind_mps = 8, or turbulence = 'light'")
        if self.profile == "log" and self.reference_m <= self.roughness_m:
            found.append(f"reference_m = {self.reference_m:g} must be above roughness_m = {self.roughness_m:g}")
        even, carried = self.profile == "even", any(gust.direction is None for gust in self.gusts)
        needed: dict[str, tuple[bool, str]] = {
            "reference_m": (windy and not even, "wind_mps, and a profile over height"),
            "profile": (windy, "wind_mps"),
            "roughness_m": (windy and self.profile == "log", "wind_mps and profile = 'log'"),
            "exponent": (windy and self.profile == "power", "wind_mps and profile = 'power'"),
            "floor_m": (turbulent or (windy and not even), "wind_mps or turbulence"),
            "towards_deg": (self.steady or carried, "wind_mps, turbulence, or a gust without a direction of its own"),
        }
        for name, (given, what) in needed.items():
            if not given and getattr(self, name) != type(self).model_fields[name].default:
                found.append(f"{name} has no effect without {what}")
        return found


class Sea(Section):
    """The sea, and the hull on it that carries the arm; the controller is told nothing of it.

    Angles of waves: towards where they travel, from the bow counter-clockwise; 180 is a head sea."""

    state: State = key(
        "calm",
        "sea state, by its most probable height and period; `tank` and `usv`: a platform's and a small vessel's own"
        " statistics",
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
        return self.waves or self.state in MEASURED or self.trace is not None

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
