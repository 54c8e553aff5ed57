"""The phases of missions without an arm for their pages: what leads on stands in `mission.unaided.decide`, here it is in words.

Every number is the one that the controller is told. A test holds the targets against those of the compiled code.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from armland.mission.table.phases import Phase
from armland.mission.unaided import decide
from armland.mission.unaided.plan import UnaidedPlan

UAV = {
    "autonomous": "flies by itself",
    "station": "keeps the place and the height that it is told, along with the deck",
    "off": "rotors stop, or stand",
}

HEIGHTS = {
    "guide": "{wait:g} m",
    "ready": "comes down to {ready:g} m",
    "descend": "falls by {sink:g} m/s to {under:g} m below standing",
}
"""Phase -> height above standing that is asked for."""

WAYS_OUT: Mapping[str, tuple[tuple[str, str], ...]] = {
    "find": (
        ("guide", "the camera's pose of the UAV is known for {held:g} s"),
        ("away", "after {find_s:g} s"),
    ),
    "guide": (
        (
            "ready",
            "seen, aside < {align:g} m, height within {align:g} m of what is asked for and speed < {speed:g} m/s for {held:g} s; "
            "or seen, after {guide_s:g} s",
        ),
    ),
    "ready": (
        ("descend", "seen, aside < {align:g} m and height < {ready_below:.3g} m{calm}"),
        ("guide", "not seen"),
    ),
    "descend": (
        ("settle", "{down}"),
        ("guide", "not seen, or aside > {give_up:g} m, higher than {low:g} m: the first {retries} times"),
        ("away", "the same once more"),
    ),
    "settle": (("done", "after {settle_s:g} s"),),
}
"""Phase -> each phase that may follow, and when."""


def phase_table(plan: UnaidedPlan) -> Iterator[str]:
    """The table of phases of a mission without an arm, and what its words mean, line by line."""
    numbers = numbers_of(plan)
    yield from ("| phase | UAV | height asked for | ends when |", "|---|---|---|---|")
    for phase in plan.phases:
        if not phase.final:
            yield _row(phase, numbers)
    yield from (
        "",
        "Heights are those of the skids above the pad and, as `aside`, the distance to its middle, what the ground believes of them. "
        f"`seen`: the newest image is younger than {decide.UNSEEN_S:g} s.",
    )
    if numbers["timed"]:
        yield (
            "`unrest` is (Q.2): how much tilt, rise and speed are expected at the touchdown that would follow a descent from now on, "
            "each as a share of what is allowed."
        )
    yield ""


def numbers_of(plan: UnaidedPlan) -> dict[str, Any]:
    """All numbers of the ways out, by the names that `WAYS_OUT` and `HEIGHTS` have for them."""
    told = plan.told["descent"][0]
    scalars = [name for name in told.dtype.names if told[name].ndim == 0]
    numbers: dict[str, Any] = {name: told[name].item() for name in scalars}
    numbers |= {"held": decide.HELD_S, "guide_s": decide.GUIDE_S, "settle_s": decide.SETTLE_S}
    numbers |= {"low": decide.LOW_M, "under": decide.UNDER_M, "ready_below": told["ready"] + 0.5 * told["align"]}
    timed = f" and unrest < {told['quiet']:g}, or {told['patience']:g} s have passed"
    return {**numbers, "calm": timed if told["timed"] else "", "down": _down(told)}


def _down(told: Any) -> str:
    under = f"{0.9 * decide.UNDER_M:g} m below standing are asked for"
    if told["pull"] > 0.0:
        return f"{under}, and height < {decide.PRESSED_M:g} m or not seen: the rope presses it on the pad"
    return (
        f"height < {told['cut']:g} m; or below {decide.LOW_M:g} m it has sunk by less than {decide.STOPPED * told['sink']:.2g} m/s "
        f"for {decide.TOUCHED_S:g} s; or {under}"
    )


def _row(phase: Phase, numbers: Mapping[str, Any]) -> str:
    ways = "; ".join(f"{words.format(**numbers)}: `{target}`" for target, words in WAYS_OUT[phase.name])
    height = HEIGHTS.get(phase.name, "-").format(**numbers)
    return f"| `{phase.name}` | {UAV[phase.uav]} | {height} | {ways} |"
