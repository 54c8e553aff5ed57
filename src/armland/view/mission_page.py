"""The page on the landing: its phases and guards from the tables that the controller flies by.

Run: python -m armland.view.mission_page > docs/landing.md
"""

from typing import Literal

from armland.mission.bounds import thresholds
from armland.mission.landing_scenario import LandingScenario, landing_scenario
from armland.mission.landing_setup import set_up
from armland.mission.phases import SIGNALS, Guard, Phase

YES_OR_NO = ("uav_seen", "contact", "magnet_ready", "magnet_fault", "bias_known")

_HEAD = """# A landing, phase by phase

Made by `python -m armland.view.mission_page > docs/landing.md`; edit the tables in `mission/landing_procedure.py`,
`mission/takeoff_procedure.py` and `mission/bounds.py`.

A mission is data: phases, what arm, UAV and magnet do in each, guards with thresholds and units, time-outs. The tables are
checked before anything moves: contradictory thresholds, phases that are never reached or lead to no end are refused, all at
once. One compiled function evaluates them every millisecond.

![A landing over time](images/landing_overview.png)

## Who carries the weight

| phase | rotors | arm | cradle |
|---|---|---|---|
| up to `close` | all | nothing | nothing |
| `capture` | all, and a pull of some tenths of a newton that tests the grip | the pull | nothing |
| `hand_over` | ramp down to half, only as fast as the measured hinge force takes over | ramps up to half | nothing |
| `carry`, `set_down` | half: with thrust the UAV can keep itself upright on its hinge | half | nothing, then its part |
| `unload` | ramp down to nothing | gives way to the hinge force | takes over |
| from `release` | stopped | nothing | all |

The rotors never give away what nobody has taken: the ramp stops while the hinge force is behind what the missing thrust must
leave to the arm. A take-off does the reverse, and lets go when the thrust carries the weight and the hinge is nearly free of
force.

## Which laws

Free, the end effector follows its reference by impedance in operational space with Λ r̈_d fed forward (6). From the capture on
arm and UAV are one system: the exact law's force on the UAV (X.1), the disturbance observed (X.3), and Λ times the acceleration
that the law implies (X.2). The attitude feedback stays on board (X.6): what travels over the link is the attitude set-point and
the thrust. If a rotor fails while the UAV is held, the arm balances it ([balance.md](laws/balance.md)).

Limits are the last in the chain: joint position, speed, torque, torque rate. The supervisor may only take authority away; what
it looks for and where that leads is in [faults.md](faults.md).
"""

_TAIL = """## What a result holds

`success, reason, phases[{name, start_s, end_s}], retries, capture.{offset_m, relative_speed_mps, tilt_deg},
touchdown.{speed_mps, tilt_deg, offset_m}, hinge_force_max_n, joint_torque_max_ratio, limits_violated[], real_time_factor`, and
`fault, end, state, seed, release`. All figures are those of what really happened in the plant, never of what the controller
believed. `state` says where the UAV is in the end: `standing`, `held`, `flying` or `lost`.

A landing succeeds if it ends in `done`, touches down at most at 0.15 m/s and 3°, stands within 10 mm of the cradle's middle, at
rest and let go, and no limit was violated: joint position, speed, torque, torque rate, singularity, hinge force (0.6 of the
magnet's rating), and the arm touches neither cradle nor floor nor UAV.
"""


def mission_markdown(scenario: LandingScenario | None = None) -> str:
    """The page as Markdown."""
    scenario = scenario or landing_scenario()
    parts = [_HEAD]
    missions: tuple[tuple[str, Literal["landing", "takeoff"]], ...] = (("landing", "landing"), ("take-off", "takeoff"))
    for title, mission in missions:
        parts += [f"## The phases of a {title}", "", "| phase | kind | arm | UAV | magnet | ends when | or after |"]
        parts += ["|---|---|---|---|---|---|---|"]
        bounds = thresholds(scenario.landing)
        parts += [_row(p, bounds) for p in set_up(scenario, mission).phases if not p.final]
        parts.append("")
    return "\n".join([*parts, _TAIL])


def _row(p: Phase, bounds: dict[str, float]) -> str:
    uav = f"ramp to {p.share:.2f} of the weight" if p.uav == "ramp" else p.uav
    ends = "; ".join(_way(g, bounds) for g in p.guards)
    return f"| `{p.name}` | {p.kind} | {p.arm} | {uav} | {p.magnet} | {ends} | {p.timeout_s:g} s: `{p.on_timeout}` |"


def _way(guard: Guard, bounds: dict[str, float]) -> str:
    conditions = []
    for c in guard.conditions:
        unit = SIGNALS[c.signal]
        value = (
            ""
            if c.threshold == "half"
            else f" {c.relation} {bounds[c.threshold]:.4g}{'' if unit == '1' else ' ' + unit}"
        )
        no = "not " if c.signal in YES_OR_NO and c.relation == "<" else ""
        conditions.append(f"{no}{c.signal}{value}")
    held = f" for {guard.hold_s:g} s" if guard.hold_s else ""
    return f"{', '.join(conditions)}{held}: `{guard.target}`"


if __name__ == "__main__":
    print(mission_markdown(), end="")
