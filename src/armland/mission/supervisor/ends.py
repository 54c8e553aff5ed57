"""How a mission can end: its goal, and the safe states to which the supervisor's fault table leads."""

from typing import Any

from armland.mission.table.phases import Phase

DOWN: dict[str, Any] = {
    "kind": "end",
    "uav": "ramp",
    "share": "none",
    "magnet": "on",
    "link": "landed",
    "on_cradle": True,
    "final": True,
}
"""The UAV stands on the cradle, its rotors run down."""

FINALS = (
    Phase("done", kind="end", arm="hold", uav="off", on_cradle=True, final=True),
    Phase("refused", kind="end", arm="hold", uav="autonomous", final=True),
    Phase("abort", kind="end", arm="back_off", uav="autonomous", duration_s=1.0, final=True),
    Phase("holding", kind="end", arm="hold", uav="level", magnet="on", link="held", final=True),
    Phase("balancing", kind="end", arm="balance", uav="off", magnet="on", link="landed", on_cradle=True, final=True),
    Phase("let_fly", kind="end", arm="back_off", uav="autonomous", duration_s=1.0, final=True),
    Phase("secured", **DOWN, arm="yield"),
    Phase("braked_refused", kind="end", arm="brake", uav="autonomous", final=True),
    Phase("braked_free", kind="end", arm="brake", uav="autonomous", final=True),
    Phase("braked_held", kind="end", arm="brake", uav="level", magnet="on", link="held", final=True),
    Phase("braked_down", **DOWN, arm="brake"),
)
"""Ends of a landing: reached the goal, or one of the safe states. Below each, the arm's part, the UAV's and the magnet's.

`abort`: the arm draws back and holds, the UAV flies by itself. `holding`: the arm holds the UAV, which stays level with the
thrust it has: without it, it would topple over its hinge.
`balancing`: rotors stopped, the arm moves the pivot below the UAV so that it stays upright; near the rails it sets it down.
`let_fly`: the magnet has lost its grip, so the UAV gets its thrust back and the arm makes room.
`secured`: the UAV stands on the cradle, the arm gives way, the magnet stays on. `braked_…`: the arm's brakes are on.
`refused`, `braked_refused`: nothing has begun, the UAV does what it did before.
"""

TAKEOFF_FINALS = tuple(
    p._replace(uav="off", on_cradle=True)
    if p.name in ("refused", "braked_refused")
    else p._replace(kind="flight", uav="station", on_cradle=False)
    if p.name == "done"
    else p
    for p in FINALS
)
"""Ends of a take-off: the UAV that is refused stays off; the one that has taken off flies guided, and is watched like one."""

HINGED_FINALS = (
    Phase("done", kind="hinge", arm="follow", uav="hinged", link="hinged", held=True, observe=True, final=True),
    Phase("resting", kind="end", arm="hold", uav="hinged", link="hinged", final=True),
)
"""Ends of a mission with the UAV bound to the arm: the path's end is held by the law; `resting`: the arm comes to rest by its own
impedance, without the law of the held UAV."""
