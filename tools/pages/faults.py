"""The page `docs/faults.md`: what can fail, how it is seen, what happens then, and what trials in the plant measured."""

from armland.mission.supervisor import faults as sign
from armland.mission.supervisor import reading, rising
from armland.mission.supervisor.ends import FINALS, HINGED_FINALS
from armland.mission.supervisor.faults import LOAD_LEFT, SEEN_S
from armland.mission.supervisor.remedies import REMEDIES, STANDING
from armland.mission.supervisor.table import DEBOUNCE_S, ESCALATION, FAULT_TABLE, FAULTS, GRAVITY_OF
from armland.mission.table.phases import KINDS
from armland.mission.told import LATE_S, LATER_S, MISSED_SHARE
from armland.scenario.control import Thrust
from armland.scenario.deviation import LEVELS
from armland.scenario.faults import Fault
from armland.scenario.mission import Limits
from pages.flights import Flight
from pages.trials import OPEN, OTHERWISE, Trial

_HEAD = """\
# Faults

Made by `make pages`, which flies every trial; edit the tables in `mission/supervisor/` and `tools/pages/trials.py`.

The supervisor looks for faults at every tick, the gravest first, and ends the mission in the final phase that its table names for
the kind of phase that is flown. It may only take authority away. A mission that has ended is watched further: a second fault
leads on to a graver end and never back.

Kinds of phases: `ground` (nobody flies on the ground's word, nothing is gripped), `flight` (the UAV flies guided, nothing touches),
`touch` (the magnet works on the plate, the rotors carry), `held` (the arm carries), `cradle` (the rails carry, the landing is nearly
over), `grip` (the rails carry, the take-off has hardly begun), `hinge` (the UAV is bound to the arm for good).
"""

_NOTES = """\
## What the figures say

- **A sample that cannot be used has not come.** Numbers that are none, and a joint that leaps by more than 50 rad/s, are replaced by
  the last good value and stop their device's clock: a dead encoder ends in brakes after 5 ms, not in a law that runs on old angles.
- **A link is silent when either direction is.** Each sample of the UAV says when the newest command had reached it; a UAV that no
  longer hears is found as fast as one that no longer speaks.
- **A magnet that dies while it carries is not felt at once.** Half the weight still presses the plate onto the face, the force does not
  change, and the plate slides off at 1 to 4 cm/s. Images alone show it. At 10 mm the plate still rests on its pads; the UAV gets
  its thrust back while it stands there, and the arm draws back below it: it sinks by 10 cm at 0.3 m/s at most while its hover
  takes over, and is not touched. With the camera blind as
  well, the missing load is all there is to see, the UAV is 50 ms further on its way, sinks at 0.7 m/s and touches the tool.
- **A silent UAV on a dead magnet is left lying on it**: it could not be given its thrust back.
- **A UAV that does not obey** is found as a force that load and thrust do not explain. It is held, and nothing else is decided: it
  cannot be put down with its rotors running. When it has stopped or listens again, a person takes it from there. On the cradle, without
  force in the hinge, it is released, and flies by itself.
- **A UAV with a weak rotor** (70 %) is landed as any other; the take-off does not let it go, because it does not stand level.
- **A lean is no fault while the UAV is held**: a gust, a blow and a push make a healthy one lean. What it says of its motors counts.
- **A UAV without power is silent too.** Held, the hinge bears all its weight at once; it leans on the hinge's stops and stays there.
  Where it falls onto a magnet that is about to grip, the magnet stays on. In flight it falls.
- **A plate that sticks in the air pulls with what the UAV's thrust exceeds its weight**: it follows the arm down. So does a UAV that
  has lost a quarter of its thrust while it hung on the arm; the force at the hinge tells them apart, and both are held again.
- **Images that scatter are told from a marker that leaps** by whether they agree with each other: noise is learnt from the
  differences of consecutive innovations, of place and of attitude, and a leap is one that comes time and again at the same place.
- **A loss of thrust that the rotors can make up for is learnt**, by the ground's station keeping in flight and by the arm's force on
  the magnet. 15 % cost 0.15 m of height before they are made up for; where arm and UAV are near each other they may touch meanwhile.
  30 % of the thrust leave less than the weight: on the magnet such a UAV is held; in flight it falls, and nothing on the ground can
  hold it.
- **A force sensor that breaks in flight** reads another tool at once: the tool weighs 2.9 N, and a bridge that is dead, reversed or at
  half or twice its gain reads 1.5 to 5.9 N more or less than before, straight down, though nothing touches the arm. While the arm
  carries, a dead one reads nothing at all; a reversed or badly scaled one only contradicts load and thrust, which a UAV that does not
  obey does as well: the reason says by how much.
- **A link that slows down is told from one that is silent** by the stamps of the samples that still come.
- **An encoder that drifts is not found as such.** Camera and arm move together, so the UAV is still caught. What is wrong is where the
  arm is on the deck. The one thing that shows it is the UAV's attitude seen through the arm, which turns against the one that it
  reports; at 0.02 rad/s in the second joint that turn is as large as an image's noise after three seconds, when the arm is 4 cm off
  already, and a joint about the vertical turns like a heading that drifts. What protects is contact: the force of the rails is felt,
  limited, and ends the mission, with reasons that say what was felt and not the encoder.
- **A force sensor that falls below what is expected while three images in a row are missing** passes for a load that is gone: the UAV
  is let go, flying.
- **A UAV that is shoved off a dead magnet while its rotors still carry it** leaves the camera's view before three smoothed images show
  it. The last two by themselves, ever further the same way, and nothing felt, say it as well.
- **Brakes stop an arm that was struck within milliseconds**, hard enough for the plate to slide by 13 mm on the face (shear is a fifth
  of the pull); that slip is seen and the UAV let go, flying.
"""


def faults_markdown(flights: list[Flight]) -> str:
    """The page as Markdown, with the figures of `flights`."""
    return "\n".join([static_part(), measured_part(flights), _NOTES])


def static_part() -> str:
    """What stands in the tables."""
    parts = [
        _HEAD,
        "## How a fault is seen",
        "",
        "| fault | what it means | sign | for | remedy |",
        "|---|---|---|---|---|",
    ]
    for fault in FAULTS[1:]:
        means, remedy = REMEDIES[fault]
        held = f"{1e3 * DEBOUNCE_S[fault]:g} ms" if fault in DEBOUNCE_S else "one tick"
        parts.append(f"| `{fault}` | {means} | {signs()[fault]} | {held} | {remedy} |")
    parts += ["", "## Where it leads", "", f"| fault | {' | '.join(KINDS)} |", "|---" * (len(KINDS) + 1) + "|"]
    for fault, row in FAULT_TABLE.items():
        parts.append(f"| `{fault}` | {' | '.join(row[k] for k in KINDS)} |")
    parts += [
        "",
        "`-`: the fault does not matter there, or the procedure itself copes; the trials below show what becomes of it.",
    ]
    parts += ["", "## The ends", "", "| end | what holds there | rank | a second fault leads on |", "|---|---|---|---|"]
    for p in (*FINALS, *(p for p in HINGED_FINALS if p.name not in {f.name for f in FINALS})):
        on = ", ".join(f"`{f}` to `{e}`" for f, e in ESCALATION.get(p.name, {}).items()) or "-"
        parts.append(f"| `{p.name}` | {STANDING[p.name]} | {GRAVITY_OF[p.name]} | {on} |")
    parts += ["", "A take-off that is `done` flies guided still and is watched as in `flight`.", ""]
    return "\n".join(parts)


def signs() -> dict[str, str]:
    """Fault -> its sign with its thresholds."""
    v = Limits()
    missed = min(v.load_gone_n, MISSED_SHARE * Thrust().slack_n)
    return {
        "non_finite": "any number in the measurement that is not finite",
        "encoder_frozen": "a joint's position repeats bit by bit in two samples, its speed none, while samples arrive",
        "power_lost": f"silent, and sinking at more than {sign.FALLS_MPS:g} m/s in view; or silent, and the hinge bears "
        f"more than {sign.WEIGHT_FELT:g} of the weight where the rotors should carry a quarter or more",
        "camera_leap": f"marker found elsewhere after images that could not be believed, for {reading.LEAPT_S:g} s; "
        "never with a silent UAV",
        "camera_noise": f"variance of the images above {sign.NOISY:g} times what the camera claims",
        "wrench_wrong": f"force over the tool's inertia force outside {sign.WEIGHED[0]:g} to {sign.WEIGHED[1]:g} on any axis, "
        f"{sign.WEIGHED_S:g} s into the self-test's nod, of which the arm made {sign.NODDED[0]:g} to {sign.NODDED[1]:g}; "
        f"or, on an arm that touches nothing and follows its reference, a vertical "
        f"force that leaps by {reading.ALIVE_N:g} of the tool's weight; or a reading of nothing, not even of the tool "
        f"(for {reading.PRESSES_S:g} s where the arm gives way to the cradle)",
        "link_late": f"samples come, and say that commands came, but both ways together more than {1e3 * LATE_S:g} ms late (or "
        f"{1e3 * LATER_S:g} ms more than the scenario says), or one way more than {v.uav_age_ms:g} ms",
        "thrust_short": f"as `magnet_stuck`, after {1e3 * sign.SANK_M:g} mm, and the hinge force says that the rotors give less "
        f"than asked by {sign.SHORT:g} of the weight",
        "magnet_stuck": f"the magnet off for {sign.STUCK_S:g} s and the arm drawing back: above "
        f"{v.stuck_n:g} N {1e3 * sign.STUCK_M:g} mm away, "
        f"or the plate within {1e3 * sign.TOUCHES_M:g} mm after {1e3 * sign.FOLLOWED_M:g} mm, "
        "pulling with what the thrust exceeds the weight",
        "arm_blocked": f"end effector more than {1e3 * sign.BLOCKED_M:g} mm off its reference; or a nod of which the arm made less "
        f"than {sign.NODDED[0]:g}, or more than {sign.NODDED[1]:g}, and the sensor felt the tool accordingly; or a torque on a joint "
        "that neither its motor, nor "
        f"the arm's model, nor the force sensor of an end effector that may touch explain, beyond {LEVELS['harsh']:g} times what the "
        "published deviations make of it together ([momentum.md](laws/momentum.md))",
        "thrust_lost": f"sinking at more than {sign.SINKS_MPS:g} m/s with all the thrust, or at more than {sign.PLUNGES_MPS:g} m/s "
        f"with {sign.STRAINS:g} times the hover thrust; or a UAV that needs nearly all that its rotors give, by itself or as the "
        "arm feels it on the magnet, where the force falls as the thrust rises",
        "arm_stale": f"joint sample older than {v.arm_age_ms:g} ms",
        "uav_silent": f"sample of the UAV, or the command that it had heard by then, older than {v.uav_age_ms:g} ms",
        "camera_stale": f"newest fused image older than {v.camera_age_ms:g} ms, once there was one; "
        f"{v.search_ms:g} ms in `guide`, `miss` and `clear`, where the UAV is looked for",
        "wrench_stale": f"force sample older than {v.wrench_age_ms:g} ms",
        "wrench_drift": f"vertical hinge force {v.unexplained_n:g} N off what load and thrust explain, where they do; "
        f"or, while the hinge is freed of force, one that does not fall by {rising.GIVES:g} of what the thrust gains, once both "
        f"together are more than may go into hovering, {rising.DRIFTS_S:g} s long",
        "magnet_coil": f"coil current below what {v.magnet_share:g} of the rated pull needs, 0.15 s after it was switched on",
        "overload": f"hinge force above what healthy flights of the phase make, at most {v.hinge_force_share:g} of the magnet's rating",
        "rotor_lost": "the UAV says that a motor turns slower than it should, while it is held, heard, "
        "and lies on the magnet",
        "uav_tilt": f"tilt above {v.tilt_deg:g}°",
        "slip": f"plate more than {1e3 * v.slip_m:g} mm off in three smoothed images in a row, or in one, and less than "
        f"{LOAD_LEFT:g} felt of an expected load above {missed:g} N; "
        f"without an image of the last {1e3 * SEEN_S:g} ms, such a load that is gone, or two images before that which show it "
        "far off, ever further the same way, and nothing felt; "
        "never with a silent UAV",
        "near_limit": f"joint within {v.joint_margin_rad:g} rad of its end, singular value below {v.sigma_min:g}, or joint speed "
        f"above {v.joint_speed_share:g} of its limit",
        "law_failed": "the law in use, a user's own, raised an exception or returned a number that is not finite",
    }


def provoked(faults: tuple[Fault, ...]) -> str:
    """What was made to fail, in words."""
    return ", then ".join(f"{_words(f)} {f.after_s:g} s into {f.phase}" for f in faults)


def _words(f: Fault) -> str:
    match f.kind:
        case "non_finite":
            return f"NaN from {f.device}"
        case "push":
            return f"push of {f.size:g} N on the {f.body}"
        case "overload":
            return f"{'jerk' if f.size < 0 else 'load'} of {abs(f.size):g} N on the UAV"
        case "wrench_drift":
            return f"force sensor drifting {f.size:+g} N/s"
        case "unreachable":
            return "UAV that does not obey"
        case "encoder_offset" | "attitude_offset":
            return f"{f.kind.replace('_', ' ')} of {f.size:g} rad"
        case "wrong_marker":
            return f"other marker {f.size:g} m aside"
        case "camera_noise":
            return f"{f.size:g} times the camera's noise"
        case "wrench_gain":
            return f"force sensor at {100 * f.size:g} %"
        case "camera_outliers":
            return f"images scattered by {f.size:g} m"
        case "encoder_drift":
            return f"encoder drifting {f.size:+g} rad/s"
        case "link_delay":
            return f"link slower by {f.size:g} ms/s"
        case "gust":
            return f"gust of {f.size:g} m/s"
        case "magnet_coil" | "magnet_slip" | "magnet_stuck" | "rotor_loss" | "thrust_loss":
            return f"{f.kind.replace('_', ' ')} of {100 * f.size:g} %"
        case kind:
            return kind.replace("_", " ")


def measured_part(flights: list[Flight]) -> str:
    """The table of trials; the figures are those of seed 1."""
    head = ["trial", "provoked by", "ends in", "found", "UAV", "after s", "sinks m/s", "drop mm", "tilt °", "hinge N"]
    parts = [
        "## Trials in the plant",
        "",
        "*after* counts from the (last) failure to the end, *sinks* is the UAV's largest downward speed, *drop* how far it went",
        "below where the end found it. A fall is 1.2 m/s. Each trial also shows finite commands, joint torques within their limits",
        "and their rate, an arm at rest, and a magnet that does what the end says; with the supervisor blind to the fault the same",
        "failure comes out differently.",
        "",
        f"| {' | '.join(head)} |",
        "|---" * len(head) + "|",
    ]
    parts += [row(f) for f in flights]
    parts += [
        "",
        *(f"Not here: {mission} `{fault}` `{kind}` ({what})." for (mission, fault, kind), what in OPEN.items()),
        "",
        "Trials that end or are found otherwise than the table says, and why:",
        "",
        *(f"- {mission} `{fault}` `{kind}`: {what}." for (mission, fault, kind), what in OTHERWISE.items()),
        "",
    ]
    return "\n".join(parts)


def row(f: Flight) -> str:
    """One line of the table of trials."""
    t: Trial = f.trial
    figures = f"{f.reaction_s:.2f} | {f.sink_mps:.2f} | {1e3 * f.drop_m:.0f} | {f.tilt_deg:.1f} | {f.force_n:.1f}"
    ends, found = ", ".join(f.ends), ", ".join(f.found)
    return f"| {t.name} | {provoked(t.faults)} | {ends} | {found} | {f.judgement.state} | {figures} |"
