"""Laws compared on the same demonstrator: two paths, a right and two wrong arm models, delays, a constant disturbance."""

from dataclasses import asdict, dataclass
from typing import Any

from armland.experiments.episode import Episode
from armland.experiments.judge.tracking import Metrics
from armland.experiments.paper import UNBOUNDED, Progress, Verdict, fly_all, metrics_of, prepare, resting, silent
from armland.scenario import Scenario

SCALES = (1.0, 0.8, 1.2)  # Factors on mass and inertia of the controller's arm model
DELAYS_MS = (0.0, 20.0, 40.0, 60.0)  # Uplink delays of the sweep

PUSH = {"force_n": (0.0, 2.0, 0.0), "torque_nm": (-0.05, 0.0, 0.0)}
"""Constant force and torque on the UAV; the torque adds to the one that the hinge makes of the force."""

FULL_THRUST_N = 7.44  # Total thrust at which the rotors have no room left for torque: four times the largest of one
HEAVY_TORQUE_NM = (0.12, 0.0, 0.0)  # Constant torque beside it

BEST, LAST_OF_PAPER, HOST = "observer", "E3", "implied"
"""Law that shall be best; the paper's; the one whose settings a law of one's own takes."""


@dataclass(frozen=True)
class Row:
    """One law under one condition."""

    condition: str
    law: str
    metrics: Metrics
    torque_ratio_max: float
    resting_swing_deg: float  # As of `paper.Resting`
    resting_error_m: float
    resting_tilt_deg: float


@dataclass(frozen=True)
class Comparison:
    """All rows and what they show."""

    rows: list[Row]
    verdicts: list[Verdict]

    def row(self, condition: str, law: str) -> Row:
        """The row of a law under a condition."""
        return next(r for r in self.rows if (r.condition, r.law) == (condition, law))

    def result(self) -> dict[str, Any]:
        """The comparison as plain data."""
        return {"rows": [asdict(r) for r in self.rows], "verdicts": [asdict(v) for v in self.verdicts]}


def conditions(scenario: Scenario) -> dict[str, tuple[Scenario, tuple[str, ...]]]:
    """The conditions by name: the changed scenario and the laws that fly under it."""
    everyone = tuple(scenario.experiments)
    own = tuple(name for name, e in scenario.experiments.items() if ":" in e.law)
    out: dict[str, tuple[Scenario, tuple[str, ...]]] = {}
    for scale in SCALES:
        out[f"model x {scale:g}"] = (scenario.replaced({"belief": {"arm": {"inertia_scale": scale}}}), everyone)
    if scenario.harder is not None:
        out["harder path"] = (scenario.replaced({"trajectory": scenario.harder.model_dump()}), everyone)
    for delay in DELAYS_MS:
        out[f"delay {delay:g} ms"] = (
            scenario.replaced({"link": {"uplink_delay_ms": delay}}),
            ("E3", "implied", "split", "observer", *own),
        )
    out["pushed"] = (scenario.replaced({"disturbance": PUSH}), ("E3", "split", "observer", *own))
    heavy = {"control": {"thrust_n": FULL_THRUST_N}, "disturbance": {"torque_nm": HEAVY_TORQUE_NM}}
    out["full thrust"] = (scenario.replaced(heavy), ("split", "limits", "observer", *own))
    return out


def compare(scenario: Scenario, law: str | None = None, progress: Progress = silent) -> Comparison:
    """Fly every law of a scenario under every condition.

    Args:
        scenario: with the laws as its experiments; the verdicts need those of the scenario `compare`.
        law: a law of one's own, FILE.py:FUNCTION, that joins them; it flies everywhere as `implied` does.
        progress: called with (condition, conditions done, conditions in all).
    """
    if law is not None:
        own = scenario.experiments[HOST].model_dump() | {"law": law}
        scenario = scenario.replaced({"experiments": {law.rpartition(":")[2]: own}})
    rows: list[Row] = []
    every = conditions(scenario)
    for done, (name, (changed, laws)) in enumerate(every.items()):
        progress(name, done, len(every))
        flown = fly_all(prepare(changed, [name for name in laws if name in changed.experiments]))
        rows += [_row(name, law, episode) for law, episode in flown.items()]
    progress("done", len(every), len(every))
    complete = {"E2", "E3", "implied", "split", "limits", "observer"} <= {r.law for r in rows}
    return Comparison(rows, _verdicts(Comparison(rows, [])) if complete else [])


def _row(condition: str, law: str, episode: Episode) -> Row:
    last = resting(episode)
    return Row(
        condition,
        law,
        metrics_of(episode),
        float(episode.ticks["health"]["torque_ratio"].max()),
        last.swing_deg,
        last.error_m,
        last.tilt_deg,
    )


def _verdicts(c: Comparison) -> list[Verdict]:
    out = []

    def below(claim: str, value: float, bound: float) -> None:
        out.append(Verdict.within(claim, value, 0.0, bound))

    def above(claim: str, value: float, bound: float) -> None:
        out.append(Verdict.within(claim, value, bound, UNBOUNDED))

    for scale in SCALES:
        name = f"model x {scale:g}"
        best, e3 = c.row(name, BEST).metrics, c.row(name, LAST_OF_PAPER).metrics
        for k, share in enumerate((20.0, 20.0, 10.0)):
            ratio = best.position_rms_m[k] / e3.position_rms_m[k]
            below(f"{name}: {'xyz'[k]} RMS error against E3's", ratio, 1.0 / share)
        attitude = best.attitude_max_deg / c.row(name, "E2").metrics.attitude_max_deg
        below(f"{name}: largest attitude error against E2's", attitude, 0.2)
        below(f"{name}: largest joint torque over its limit", c.row(name, BEST).torque_ratio_max, 0.99)
    for delay in DELAYS_MS:
        name = f"delay {delay:g} ms"
        below(f"{name}: swing at rest, split law (deg)", c.row(name, BEST).resting_swing_deg, 0.2)
    late = f"delay {DELAYS_MS[-1]:g} ms"
    swing = c.row(late, HOST).resting_swing_deg
    above(f"{late}: swing at rest, published gains over the link (deg)", swing, 0.2)
    below("pushed: position error left, observer (m)", c.row("pushed", BEST).resting_error_m, 1e-3)
    below("pushed: attitude error left, observer (deg)", c.row("pushed", BEST).resting_tilt_deg, 0.5)
    above("pushed: attitude error left, no observer (deg)", c.row("pushed", "split").resting_tilt_deg, 0.5)
    aware, unaware = (c.row("full thrust", law).metrics.position_rms_m[2] for law in ("limits", "split"))
    below("full thrust: z RMS error, aware of the rotors' limits against not", aware / unaware, 0.75)
    return out
