"""Landing without an arm: the UAV comes down by itself on a flat pad on the deck."""

from armland.mission.missions.keys import GEAR, ON_MAGNET, SHARED
from armland.mission.table.mission import Criterion, Mission
from armland.mission.table.phases import Phase
from armland.scenario import Scenario

USES = (*SHARED, *GEAR, *ON_MAGNET, "pad", "hexapod", "tether", "descent")
"""All that a landing by the arm uses, too: one scenario is flown by every method."""

PHASES = (
    Phase("find", "hold", "autonomous"),
    Phase("guide", "hold", "station"),
    Phase("ready", "hold", "station"),
    Phase("descend", "hold", "station", on_cradle=True),
    Phase("settle", "hold", "off", on_cradle=True),
    Phase("done", "hold", "off", kind="end", on_cradle=True, final=True),
    Phase("away", "hold", "autonomous", kind="end", final=True),
)
"""In the order of `mission.unaided.decide.PHASES`."""

CRITERIA = (
    Criterion("touchdown_speed", 0.15, "m/s", "speed of the pivot when the pad is touched first"),
    Criterion("touchdown_tilt", 3.0, "deg", "tilt of the UAV then"),
    Criterion("placed", 0.3, "m", "distance to the pad's middle at the end"),
    Criterion("rest", 0.01, "m/s", "speed at the end"),
)
"""Those of the landing by an arm, but for the place: rails need 15 mm, on a pad of 1 m the skids are to stand as a whole."""


def _phases(_: Scenario) -> tuple[Phase, ...]:
    return PHASES


UNASSISTED = Mission(
    name="unassisted",
    summary="land by itself on a flat pad",
    start="air",
    phases=_phases,
    uses=USES,
    criteria=CRITERIA,
    timeouts={
        "find": "the camera does not see the UAV",
        "guide": "the UAV did not come to its station",
        "ready": "no moment came to come down",
        "descend": "the UAV did not come down",
    },
    judged_as="unaided",
    praise="landed",
    doc="""The same UAV lands on a flat pad on the same deck, by the camera, link and motion reference that the arm's landing has, too;
the camera looks up through a window in the pad. It goes along with the deck, waits near the pad for a quiet moment, comes down
and stops its rotors.""",
)

HEXAPOD = UNASSISTED._replace(
    name="hexapod",
    summary="land by itself on a pad that six legs hold still",
    doc="""As `unassisted`, on a pad that stands on six legs. By a motion reference of its own on the hull the platform cancels what
the hull does, as far as stroke, speed and acceleration of its legs let it. Camera and the motion reference that the UAV is guided
by stand on the platform. Nothing clamps the UAV: it may slide and tip.""",
)

TETHER = UNASSISTED._replace(
    name="tether",
    summary="be pulled down on a flat pad by a rope",
    doc="""As `unassisted`, with a rope from a winch below the pad to the UAV's hinge. Until it comes down the winch keeps the rope just
taut. Then the UAV thrusts upwards by more than its weight and the winch reels in: its height above the pad is the rope's length,
whatever the deck does. Sideways it keeps its station. On the pad the rope holds it.""",
)
