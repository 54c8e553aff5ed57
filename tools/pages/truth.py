"""Which names are true of what fails or differs in the plant: the diagonal of two confusion tables.

A name is true that says what failed, or what that does to the flight as anybody beside the demonstrator could see it.
"""

from collections import Counter
from collections.abc import Iterable

from armland.scenario.deviation import rows
from armland.scenario.faults import Fault

NONE = "none"
"""The procedure itself gives up or copes: a self-test that is not passed, too many missed captures, a goal that is reached."""

_PUSHED = {"near_limit", "overload", "arm_blocked", "wrench_drift", "slip", "uav_tilt"}

TRUE_OF_FAILURE: dict[str, set[str]] = {
    # A link that is late is silent when it is later than a command may be.
    "link_loss": {"uav_silent"},
    "uplink_loss": {"uav_silent"},
    "downlink_loss": {"uav_silent"},
    "link_delay": {"uav_silent", "link_late"},
    "camera_frozen": {"camera_stale"},
    "camera_lost": {"camera_stale"},
    "camera_noise": {"camera_noise"},
    # Single images far off are what noise is, and what a leap is.
    "camera_outliers": {"camera_noise", "camera_leap"},
    "camera_flip": {"camera_noise", "camera_leap"},
    "wrong_marker": {"camera_leap", "camera_stale"},
    "wrench_frozen": {"wrench_stale"},
    # What the sensor says too much is a force that is too large, or one that nothing explains, or a load that is gone.
    "wrench_drift": {"wrench_drift", "overload", "slip"},
    "wrench_dead": {"wrench_wrong", "wrench_drift"},
    "wrench_reversed": {"wrench_wrong", "wrench_drift"},
    "wrench_gain": {"wrench_wrong", "wrench_drift"},
    "arm_stale": {"arm_stale"},
    "magnet_coil": {"magnet_coil", "slip"},
    "magnet_slip": {"slip"},
    "magnet_stuck": {"magnet_stuck"},
    "rotor_loss": {"rotor_lost", "thrust_lost", "thrust_short"},
    "thrust_loss": {"thrust_lost", "thrust_short", "rotor_lost"},
    "power_loss": {"power_lost", "uav_silent"},
    "overload": {"overload"},
    "unreachable": {"wrench_drift", "slip"},
    "non_finite": {"non_finite", "arm_stale", "camera_stale", "wrench_stale", "uav_silent"},
    "encoder_offset": {"arm_stale"},
    # The arm stands elsewhere than it says: it pulls at what it holds, and the marker moves in the camera.
    "encoder_drift": {"wrench_drift", "arm_blocked"},
    "encoder_frozen": {"encoder_frozen"},
    "attitude_offset": {"uav_tilt", "uav_silent"},
    "push": _PUSHED,
    "twist": {"uav_tilt"},
    "gust": _PUSHED | {"camera_stale"},
}
"""Kind of a failure -> names that are true of it; `NONE` besides, where the procedure itself ends or goes on."""


_FLIES_BADLY = {"camera_stale", "uav_tilt", "thrust_lost", "thrust_short"}
"""What a UAV does that leaves its station: it leaves the view, leans too far, or asks for all its thrust."""

_PULLS = {"wrench_drift", "overload", "slip", "rotor_lost"}
"""What a held UAV does whose thrust or lean is not what it says."""

TRUE_OF_DEVICE: dict[str, set[str]] = {
    "uav": _FLIES_BADLY | _PULLS,
    "link": {"uav_silent", "link_late"} | _FLIES_BADLY,
    "camera": {"camera_noise", "camera_leap", "camera_stale"},
    "wrench": {"wrench_wrong", "wrench_drift", "overload"},
    "arm": {"near_limit", "arm_blocked", "wrench_wrong", "wrench_drift", "overload", "camera_leap"},
    "magnet": {"magnet_coil", "magnet_stuck", "slip"},
    "hinge": {"uav_tilt", "slip", "wrench_drift", "overload"},
    "cradle": {"overload", "wrench_drift", "uav_tilt", "near_limit"},
    "air": _FLIES_BADLY | _PULLS,
}
"""Device -> names that are true of it or its effect, where it differs too much."""


def true_of_row(path: str) -> set[str]:
    """Names that are true of a deviation `device.key`, `NONE` besides."""
    return {NONE} | TRUE_OF_DEVICE[path.partition(".")[0]]


def devices() -> set[str]:
    """All devices that deviate."""
    return {r.path.partition(".")[0] for r in rows()}


def untrue(names: Iterable[str], faults: Iterable[Fault], copes: bool) -> set[str]:
    """Of the names that a trial found those that are not true of its faults; none at all is untrue unless it `copes`."""
    false = set(names) - true_of(faults)
    return false | ({NONE} if set(names) == {NONE} and not copes else set())


def true_of(faults: Iterable[Fault]) -> set[str]:
    """Names that are true of all that fails."""
    return {NONE}.union(*(TRUE_OF_FAILURE[f.kind] for f in faults))


def confusion(flown: Iterable[tuple[str, str]]) -> str:
    """A table of what failed or differed, and how often each name was found, as Markdown.

    Args:
        flown: what it was, in words or as a name, and the name that was found.
    """
    counts = Counter(flown)
    rows, names = sorted({r for r, _ in counts}), sorted({n for _, n in counts}, key=lambda n: (n == NONE, n))
    lines = [f"| | {' | '.join(f'`{n}`' if n != NONE else 'none' for n in names)} |", "|---" * (len(names) + 1) + "|"]
    # What is more than one word is no name.
    lines += [f"| {r if ' ' in r else f'`{r}`'} | {' | '.join(str(counts[r, n] or '') for n in names)} |" for r in rows]
    return "\n".join(lines)
