"""A whole scenario: hardware, environment, control, mission, what the controller believes, what fails."""

import json
import re
from typing import Annotated, Any

from pydantic import AfterValidator, Field, PrivateAttr, ValidationError

from armland.scenario import quantities as of
from armland.scenario.arm import Arm, Tool
from armland.scenario.control import Control, Experiment
from armland.scenario.deviation import Deviation
from armland.scenario.environment import Air, Disturbance, Environment, Forecast, Sea
from armland.scenario.estimation import Estimation
from armland.scenario.faults import Fault
from armland.scenario.gear import Cradle, Hinge, Magnet, Plate, Skids
from armland.scenario.mission import Bounds, Limits, Place, Run, Trajectory
from armland.scenario.quantities import Section, key
from armland.scenario.refusal import problems, refusal
from armland.scenario.sensing import Camera, Imperfections, MotionReference, Sensors
from armland.scenario.tables import as_json, leaves, orderly, update
from armland.scenario.uav import Link, Onboard, Rotors, Uav
from armland.scenario.unaided.landing import Descent, Hexapod, Pad, Tether

HARDWARE = (
    "arm",
    "tool",
    "hinge",
    "plate",
    "magnet",
    "skids",
    "cradle",
    "pad",
    "hexapod",
    "tether",
    "camera",
    "uav",
    "rotors",
    "onboard",
    "link",
    "sensors",
    "motion_reference",
    "environment",
)
"""Sections of which the controller has a belief of its own."""

PLANT_ONLY = ("imperfections", "deviation", "disturbance", "air", "sea", "faults")
"""Sections that the controller never sees."""


def _file_name(value: str) -> str:
    if not re.fullmatch(r"[A-Za-z0-9_+-][A-Za-z0-9_.+-]{0,59}", value):
        raise ValueError(
            "the name becomes part of a file's name: 1 to 60 letters, digits and _ . + -, the first of them no full stop"
        )
    return value


FileName = Annotated[str, AfterValidator(_file_name)]


class Scenario(Section):
    """A whole scenario. Sections have the same names as the parts that they describe."""

    title: Annotated[str, Field(max_length=200)] = key("untitled", "of figures and reports")
    calibration: of.Text | None = key(None, "file of calibrated values, relative to the scenario's folder")
    airframe: of.Text | None = key(
        None, "UAV: a file of its own (TOML or MJCF), or the name of one that comes with armland"
    )
    run: Run = Run()
    arm: Arm = Arm()
    tool: Tool = Tool()
    hinge: Hinge = Hinge()
    plate: Plate = Plate()
    magnet: Magnet = Magnet()
    skids: Skids = Skids()
    cradle: Cradle = Cradle()
    pad: Pad = Pad()
    hexapod: Hexapod = Hexapod()
    tether: Tether = Tether()
    camera: Camera = Camera()
    uav: Uav = Uav()
    rotors: Rotors = Rotors()
    onboard: Onboard = Onboard()
    link: Link
    sensors: Sensors = Sensors()
    motion_reference: MotionReference = MotionReference()
    environment: Environment = Environment()
    imperfections: Imperfections = Imperfections()
    deviation: Deviation = Deviation()
    disturbance: Disturbance = Disturbance()
    air: Air = Air()
    sea: Sea = Sea()
    forecast: Forecast = Forecast()
    control: Control = Control()
    estimation: Estimation = Estimation()
    place: Place = Place()
    descent: Descent = Descent()
    bounds: Bounds = Bounds()
    limits: Limits = Limits()
    trajectory: Trajectory | None = key(None, "path of the missions that follow one")
    harder: Trajectory | None = key(None, "second path for the comparison of laws")
    experiments: Annotated[dict[FileName, Experiment], Field(max_length=100)] = Field(
        default_factory=dict, description="controllers to try; the name of each is part of its results' file names"
    )
    faults: Annotated[tuple[Fault, ...], Field(max_length=100)] = key((), "what fails in the plant")
    belief: dict[str, dict[str, Any]] = Field(
        default_factory=dict,
        description="what the controller takes for true of the hardware where that differs: tables with the hardware's names",
    )

    _text: str = PrivateAttr("")
    _overrides: str = PrivateAttr("")
    _own: frozenset[str] = PrivateAttr(frozenset())
    _asked: frozenset[str] = PrivateAttr(frozenset())
    _changed: frozenset[str] = PrivateAttr(frozenset())
    _sized: bool = PrivateAttr(False)

    @property
    def text(self) -> str:
        """The file as it was read."""
        return self._text

    @property
    def overrides(self) -> str:
        """What replaced values of the file, as JSON; empty where nothing did."""
        return self._overrides

    @property
    def own(self) -> frozenset[str]:
        """Dotted paths of the keys that the user set, in the file or beside it; those of a base are not among them."""
        return self._own

    @property
    def asked(self) -> frozenset[str]:
        """Dotted paths of the keys that the user set, in any file of his own or beside it: none that only armland's files set."""
        return self._asked

    @property
    def settled(self) -> frozenset[str]:
        """Dotted paths of the keys that no rule may set: those of `asked`, and those that `replaced` has changed."""
        return self._asked | self._changed

    @property
    def foretold_mps(self) -> float:
        """Mean wind at 20 ft, m/s, that the controller is told: the forecast's, or that of the air; never what it is like."""
        return self.air.wind_mps if self.forecast.wind_mps is None else self.forecast.wind_mps

    @property
    def foretold_deck(self) -> bool:
        """Whether the controller is told that the deck moves; never how."""
        return self.sea.moves if self.forecast.deck_moves is None else self.forecast.deck_moves

    @property
    def sized(self) -> bool:
        """Whether the rules of `models.airframe.sizing` have been applied."""
        return self._sized

    def resolved(self, changes: dict[str, Any]) -> "Scenario":
        """The scenario with the nested `changes` that the rules of `models.airframe.sizing` make; errors as for `replaced`."""
        changed, out = self._changed, self.replaced(changes) if changes else self._with(self.model_copy())
        out._changed, out._sized = changed, True
        return out

    def replaced(self, changes: dict[str, Any]) -> "Scenario":
        """The scenario with nested `changes`, checked.

        Raises:
            ConfigurationError: all that is wrong with the result.
        """
        data = json.loads(self.model_dump_json())
        update(data, json.loads(as_json(orderly(changes, "the changes"))))
        try:
            out = self._with(Scenario.model_validate_json(json.dumps(data)))
        except ValidationError as e:
            raise refusal(e, Scenario, "the scenario as changed") from e
        out._changed = self._changed | set(leaves(changes))
        return out

    def with_seed(self, seed: int) -> "Scenario":
        """The same scenario with another seed.

        Raises:
            ConfigurationError: a negative seed, or one beyond 2⁶².
        """
        return self.replaced({"run": {"seed": seed}})

    def frozen(self) -> str:
        """The scenario as JSON, with what is known of where its values come from: `thawed` makes the same of it anywhere."""
        own = {name: sorted(getattr(self, name)) for name in ("_own", "_asked", "_changed")}
        texts = {"_text": self._text, "_overrides": self._overrides, "_sized": self._sized}
        return json.dumps({"values": json.loads(self.model_dump_json()), **own, **texts}, sort_keys=True)

    @staticmethod
    def thawed(text: str) -> "Scenario":
        """The scenario of which `frozen` made the `text`.

        Raises:
            ConfigurationError: the values are none of a scenario, as those of another version of armland may be.
        """
        data = json.loads(text)
        try:
            out = Scenario.model_validate_json(json.dumps(data.pop("values")))
        except ValidationError as e:
            raise refusal(e, Scenario, "the scenario as it was kept") from e
        for name, value in data.items():
            setattr(out, name, frozenset(value) if isinstance(value, list) else value)
        return out

    def believed(self) -> "Scenario":
        """What the controller takes for true: the hardware as `belief` has it, and nothing that only the plant has."""
        return self._with(Scenario.model_validate_json(self._belief()))

    def _belief(self) -> str:
        data = json.loads(self.model_dump_json(exclude={*PLANT_ONLY, "belief"}))
        data["forecast"]["wind_mps"], data["forecast"]["deck_moves"] = self.foretold_mps, self.foretold_deck
        update(data, self.belief)
        return json.dumps(data)

    def _with(self, other: "Scenario") -> "Scenario":
        # Another scenario of the same source.
        other._text, other._overrides, other._own, other._asked = self._text, self._overrides, self._own, self._asked
        other._changed, other._sized = self._changed, self._sized
        return other

    def _contradictions(self) -> list[str]:
        found = _problems(self)
        known = f"no section of the hardware; those are {', '.join(HARDWARE)}"
        found += [f"belief.{name}: {known}" for name in self.belief if name not in HARDWARE]
        if self.belief and not found:
            try:
                Scenario.model_validate_json(self._belief())
            except ValidationError as e:
                found = [f"belief.{line}" for line in problems(e, Scenario)]
        return found


def _problems(s: Scenario) -> list[str]:
    # What contradicts itself across sections.
    problems, rate = [], s.run.rate_hz
    devices = {"onboard.rate_hz": s.onboard.rate_hz, "link.rate_hz": s.link.rate_hz}
    devices["motion_reference.rate_hz"] = s.motion_reference.rate_hz
    devices["control.station.rate_hz"] = s.control.station.rate_hz
    for name, experiment in s.experiments.items():
        if experiment.onboard is not None:
            devices[f"experiments.{name}.onboard.rate_hz"] = experiment.onboard.rate_hz
    for name, device in devices.items():
        if device > rate or rate % device:
            divisors = [d for d in range(1, rate + 1) if rate % d == 0]
            near = ", ".join(map(str, sorted(sorted(divisors, key=lambda d: abs(d - device))[:3])))
            problems.append(f"{name} = {device} does not divide run.rate_hz = {rate}; nearest that do: {near}")
    for i, gust in enumerate(s.air.gusts):
        if gust.at_s >= s.run.duration_s:
            problems.append(f"air.gusts.{i}.at_s = {gust.at_s:g} must be below run.duration_s = {s.run.duration_s:g}")
    if not s.uav.file:
        given: dict[str, object] = {
            "uav.mass_kg": s.uav.mass_kg,
            "uav.inertia_kgm2": s.uav.inertia_kgm2,
            "uav.lever_m": s.uav.lever_m,
        }
        given["rotors.place_m"] = s.rotors.place_m
        missing = ", ".join(name for name, value in given.items() if value is None)
        if missing:
            problems.append(f"uav.file is empty, so nothing says {missing}")
    carried = 1.0 - s.control.thrust.carry_share
    if s.bounds.share_carried >= carried:
        problems.append(
            f"bounds.share_carried = {s.bounds.share_carried:g} must be below 1 - control.thrust.carry_share = {carried:g}: "
            "the rotors carry the rest"
        )
    return problems
