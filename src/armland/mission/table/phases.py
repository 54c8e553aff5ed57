"""A mission's phases as data: what each of them does, the guards between them, and their time-outs.

A guard is a conjunction of conditions `signal relation threshold` that must hold for `hold_s`. Signals are numbers that the
controller computes every tick; thresholds have a name, a value and the signal's unit (`thresholds`). `checks` finds
contradictions, `arrays` compiles the table.
"""

from typing import NamedTuple

SIGNALS = {
    "progress": "1",
    "elapsed": "s",
    "uav_seen": "1",
    "uav_error": "m",
    "uav_speed": "m/s",
    "offset": "m",
    "relative_speed": "m/s",
    "tilt": "deg",
    "gap": "m",
    "contact": "1",
    "pull": "N",
    "thrust_left": "N",
    "arm_share": "1",
    "ground_share": "1",
    "hinge_force": "N",
    "retreat": "m",
    "magnet_ready": "1",
    "magnet_fault": "1",
    "arm_error": "m",
    "retries": "1",
    "bias_known": "1",
    "rotors": "N",
    "lean": "deg",
    "image_offset": "m",
    "image_gap": "m",
    "spare": "1",
}
"""What guards may ask for, and the unit. `offset` is horizontal, as reckoned; `image_offset` what the newest images show of it along
the magnet's face, `image_gap` across it; `pull` the vertical hinge force that pulls the UAV down, `lean` the angle of the UAV's z axis
to the one that was asked for, `spare` the thrust that the rotors have left, over what they have left where nothing blows."""

SIGNAL = {name: i for i, name in enumerate(SIGNALS)}

ARM = (
    "hold",
    "join",
    "track",
    "close",
    "move",
    "back_off",
    "yield",
    "brake",
    "launch",
    "leave",
    "balance",
    "follow",
    "lower",
    "nod",
    "flee",
)
"""Reference of the arm: rest where it is; septic blend from rest to below the plate; below the plate; the gap to the plate closes;
septic move to the phase's target; septic move away downwards from where it is; give way to the hinge force; brakes on; run-up to
the speed that the UAV is given, then on at it; down from below the UAV at its speed, and to rest; balance the UAV; the mission's
path; septic move to the phase's target, then on downwards at a steady speed; a nod, by which the tool is weighed;
away from below the plate, along with it."""

UAV = ("autonomous", "station", "level", "ramp", "balance", "off", "run_up", "cruise", "hinged")
"""The UAV hovers by itself; keeps its station by the ground's estimate; level with the thrust it has; level with a
thrust ramp; level with the thrust that frees the hinge of force; stops; as level, tilted against its drag; flies on; level on the
hinge with the thrust that the law is told."""

MAGNET = ("off", "on", "test")

LINK = ("guided", "held", "landed", "caught", "hinged")
"""A UAV without link hovers by itself; stays level with the thrust it has; lets its rotors run down; hovers by itself though the
magnet has gripped it; goes on with what it heard last."""

KINDS = ("ground", "flight", "touch", "held", "cradle", "grip", "hinge")
"""Rows of the supervisor's fault table: nobody flies on the ground's word; the UAV flies guided, nothing touches; the magnet works
on the plate, the rotors carry; the arm carries; the rails carry, the landing is nearly over; the rails carry, the take-off has hardly
begun; the UAV is bound to the arm for good."""

SHARES = ("none", "carry", "whole", "test")
"""Share of the weight that a ramp leads to: none; `control.thrust.carry_share`; all; all and `bounds.pull_test_n`."""

LOADS = ("carried", "impact")
"""Hinge force that no healthy flight of the phase makes: `limits.carried_n` where nothing meets, `limits.impact_n` where faces meet."""


class Condition(NamedTuple):
    """`signal` below (`<`) or above (`>`) the threshold of that name, in the signal's unit."""

    signal: str
    relation: str
    threshold: str


class Guard(NamedTuple):
    """Leads to phase `target`; open when all conditions have held for `hold_s`."""

    target: str
    conditions: tuple[Condition, ...]
    hold_s: float = 0.0


class Phase(NamedTuple):
    """What happens in a phase, and how it ends.

    The fields from `arm` to `observe` say what the controller does; each is an index or a number of the controller's own tables.
    """

    name: str
    arm: str
    """Where the arm's reference comes from, see `ARM`."""
    uav: str
    """What the UAV is asked to do, see `UAV`."""
    kind: str = "flight"
    """Row of the supervisor's fault table, see `KINDS`; `end` in an end that only a graver one follows."""
    magnet: str = "off"
    """`off`, `on` or `test`."""
    link: str = "guided"
    """What the UAV is told to do should it hear nothing more, see `LINK`."""
    held: bool = False
    """Whether the UAV hangs on the arm: the controller's model is then arm and UAV together."""
    free: bool = False
    """Whether the end effector is known to touch nothing: the force-torque sensor's bias is learnt."""
    sight: bool = True
    """Whether the camera should see the UAV."""
    seeks: bool = False
    """Whether a UAV that is not seen is waited and looked for as long as `limits.search_ms`."""
    observe: bool = False
    """Whether the disturbance observer learns."""
    load: str = "carried"
    """Largest hinge force, see `LOADS`."""
    share: str = "whole"
    """Where the UAV's thrust ramps to, see `SHARES`."""
    duration_s: float = 0.0
    """Duration of the phase's move; 0 where there is none."""
    timeout_s: float = 10.0
    on_timeout: str = "abort"
    guards: tuple[Guard, ...] = ()
    on_cradle: bool = False
    """Whether the UAV may touch the cradle; to the judge a contact in another phase is a failure."""
    final: bool = False
    """Whether the mission ends here."""

    def to(self, target: str, conditions: str, hold_s: float = 0.0) -> "Phase":
        """The phase with one more guard: to `target` when `conditions`, `signal relation threshold, …`, have held for `hold_s`."""
        made = tuple(Condition(*condition.split()) for condition in conditions.split(", "))
        return self._replace(guards=(*self.guards, Guard(target, made, hold_s)))
