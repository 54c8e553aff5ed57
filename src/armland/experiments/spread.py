"""What the paper's experiments give over the whole range of what nobody has published, for two demonstrators.

`fitted` is the scenario `paper`, its values anywhere in the ranges of `calibration.toml`; `bench` is `paper_bench`, its data
anywhere in those of `bench.DATA`. The points are a Latin hypercube, each with its own seed; a value with several axes moves as one.
"""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np
from scipy.stats import qmc

from armland.experiments.bench import DATA, derived
from armland.experiments.paper import PUBLISHED, Outcome, Progress, prepare, resting, run_experiments, silent
from armland.scenario import SCENARIOS, Scenario
from armland.scenario.files.toml import read_toml

FIRST_SEED = 1000
NAMES = ("E1", "E2", "E3")
E1_DEG, E2_DEG = (PUBLISHED[name]["attitude_max_deg"] for name in NAMES[:2])
UPRIGHT_DEG = 45.0
E1_LARGEST, E2_LARGEST = (f"{name}: largest attitude error (°)" for name in NAMES[:2])
RATIO = "E3's z error over E2's (RMS)"
PAPER = {
    E1_LARGEST: f"{E1_DEG}",
    E2_LARGEST: f"{E2_DEG}",
    "E2 over E1, largest attitude error": f"{E2_DEG / E1_DEG:.2f}",
    **{f"E2's overshoot over E1's, {axis}": "below 1" for axis in "xyz"},
    RATIO: "clearly below 1",
    "E2: share of time at the torque limit": "not said",
    "E2: swing at rest (°)": "not said",
}
"""The figures, and what the paper says of them."""


class Knob(NamedTuple):
    """A value that nobody has published, from `low` to `high`, and the changes to a scenario that one of them makes."""

    name: str
    low: float
    high: float
    changes: Callable[[float], dict[str, Any]]


@dataclass(frozen=True)
class Demonstrator:
    """What one of the two gives at its own values and over its ranges."""

    name: str
    central: dict[str, float]
    """By the names of `PAPER`, at its own values and seed."""
    samples: list[dict[str, float]]
    """Likewise, at each point."""
    holds: dict[str, float]
    """Share of the points at which each claim of the paper holds."""

    @property
    def standing(self) -> list[dict[str, float]]:
        """The samples whose UAV keeps upright in E1 and in E2; some corners of the ranges are unstable already without the law."""
        return [s for s in self.samples if max(s[E1_LARGEST], s[E2_LARGEST]) < UPRIGHT_DEG]


@dataclass(frozen=True)
class Sensitivity:
    """The fitted demonstrator with one of its values elsewhere in its range; `biased` is `RATIO` with the force sensor's z biased."""

    knob: str
    value: float | None  # None: every value as calibrated
    figures: dict[str, float]
    biased: dict[str, float]


@dataclass(frozen=True)
class Spread:
    """Both demonstrators, and what each value of the fitted one does alone."""

    demonstrators: list[Demonstrator]
    sensitivity: list[Sensitivity]

    def result(self) -> dict[str, Any]:
        """The spread as plain data."""
        return {"paper": PAPER, **asdict(self)}


def spread(fitted: Scenario, bench: Scenario, samples: int, bias_n: float, progress: Progress = silent) -> Spread:
    """Fly E1 to E3 at `samples` points of each demonstrator, and the fitted one with each value at either end.

    Args:
        fitted: the scenario `paper`.
        bench: the scenario `paper_bench`.
        samples: points of each.
        bias_n: bias of the force sensor's z, N, by which the ratio of the z errors is tried as well.
        progress: called with (what, done, in all).
    """
    knobs = calibrated()
    demonstrators = [_fitted(fitted, knobs, samples, progress), _bench(bench, samples, progress)]
    return Spread(demonstrators, _sensitivity(fitted, knobs, bias_n, progress))


def calibrated() -> list[Knob]:
    """The values of `calibration.toml`, each with its range."""

    def knob(section: str, key: str, entry: dict[str, Any]) -> Knob:
        many, value = isinstance(entry["value"], list), np.array(entry["value"], ndmin=1)

        def changes(x: float) -> dict[str, Any]:
            return {section: {key: tuple(value * (x / value[0])) if many else x}}

        return Knob(f"{section}.{key}", entry["low"], entry["high"], changes)

    tables = read_toml(SCENARIOS / "calibration.toml")
    return [knob(section, key, entry) for section, keys in tables.items() for key, entry in keys.items()]


def merged(knobs: list[Knob], point: Any) -> dict[str, Any]:
    """The changes of all `knobs` at a `point` (d,) of the unit cube."""
    out: dict[str, Any] = {}
    for knob, u in zip(knobs, point, strict=True):
        for section, values in knob.changes(knob.low + float(u) * (knob.high - knob.low)).items():
            out.setdefault(section, {}).update(values)
    return out


def figures_of(outcome: Outcome, limit_nm: Any) -> dict[str, float]:
    """The figures by the names of `PAPER`; `limit_nm` (3,) N·m is the largest Δτ_att that the UAV accepts.

    The share of time at it is the mean of roll and pitch.
    """
    e1, e2, e3 = (outcome.metrics[name] for name in NAMES)
    asked = np.abs(outcome.episodes["E2"].ticks["command"]["delta_tau"])
    values = [
        e1.attitude_max_deg,
        e2.attitude_max_deg,
        e2.attitude_max_deg / e1.attitude_max_deg,
        *(two / max(one, 1e-6) for one, two in zip(e1.overshoot_m, e2.overshoot_m, strict=True)),
        e3.position_rms_m[2] / e2.position_rms_m[2],
        float(np.mean(asked[:, :2] >= np.array(limit_nm)[:2])),
        resting(outcome.episodes["E2"]).swing_deg,
    ]
    return dict(zip(PAPER, values, strict=True))


def _fly(scenario: Scenario) -> tuple[dict[str, float], dict[str, bool]]:
    outcome = run_experiments(prepare(scenario, NAMES))
    return figures_of(outcome, scenario.link.torque_limit_nm), {v.claim: v.holds is True for v in outcome.verdicts}


def _fitted(scenario: Scenario, knobs: list[Knob], samples: int, progress: Progress) -> Demonstrator:
    points = qmc.LatinHypercube(len(knobs), rng=1).random(samples)
    return _flown("fitted", scenario, [merged(knobs, point) for point in points], progress)


def _bench(scenario: Scenario, samples: int, progress: Progress) -> Demonstrator:
    low, high = (np.array([getattr(d, end) for d in DATA.values()]) for end in ("low", "high"))
    points = low + qmc.LatinHypercube(len(DATA), rng=1).random(samples) * (high - low)
    data = [dict(zip(DATA, map(float, point), strict=True)) for point in points]
    return _flown("bench", scenario, [derived(scenario, one) for one in data], progress)


def _flown(name: str, scenario: Scenario, changes: list[dict[str, Any]], progress: Progress) -> Demonstrator:
    progress(name, 0, len(changes))
    central, _ = _fly(scenario)
    samples, holds = [], []
    for i, change in enumerate(changes):
        figures, verdicts = _fly(scenario.replaced(change).with_seed(FIRST_SEED + i))
        samples.append(figures)
        holds.append(verdicts)
        progress(name, i + 1, len(changes))
    return Demonstrator(name, central, samples, {c: float(np.mean([v[c] for v in holds])) for c in holds[0]})


def _sensitivity(scenario: Scenario, knobs: list[Knob], bias_n: float, progress: Progress) -> list[Sensitivity]:
    tried: list[tuple[str, float | None, dict[str, Any]]] = [("as calibrated", None, {})]
    tried += [(knob.name, x, knob.changes(x)) for knob in knobs for x in (knob.low, knob.high)]
    out = []
    for done, (name, x, change) in enumerate(tried):
        progress("one at a time", done, len(tried))
        changed = scenario.replaced(change)
        biased = {f"{bias:+g} N": _biased_ratio(changed, bias) for bias in (bias_n, -bias_n)}
        out.append(Sensitivity(name, x, _fly(changed)[0], biased))
    progress("one at a time", len(tried), len(tried))
    return out


def _biased_ratio(scenario: Scenario, bias_n: float) -> float:
    # E2 does not use the force.
    wrong = scenario.replaced({"sensors": {"force_bias_n": (0.0, 0.0, bias_n)}})
    z = {name: m.position_rms_m[2] for name, m in run_experiments(prepare(wrong, NAMES[1:])).metrics.items()}
    return z["E3"] / z["E2"]
