"""How a mission can end: its goal, and the safe states to which the supervisor's fault table leads."""

from armland.mission.phases import Phase

FINALS = (
    Phase("done", arm="hold", uav="off", final=True),
    Phase("refused", arm="hold", uav="autonomous", final=True),
    Phase("abort", arm="back_off", uav="autonomous", duration_s=1.0, final=True),
    Phase("holding", arm="hold", uav="level", magnet="on", link="held", final=True),
    Phase("hanging", arm="hold", uav="off", magnet="on", link="held", final=True),
    Phase("balancing", arm="balance", uav="off", magnet="on", link="landed", final=True),
    Phase("let_fly", arm="hold", uav="autonomous", final=True),
    Phase("secured", arm="yield", uav="ramp", share=0.0, magnet="on", link="landed", final=True),
    Phase("braked_free", arm="brake", uav="autonomous", final=True),
    Phase("braked_held", arm="brake", uav="level", magnet="on", link="held", final=True),
    Phase("braked_down", arm="brake", uav="ramp", share=0.0, magnet="on", link="landed", final=True),
)
"""Ends: reached the goal, or one of the safe states. Below each, the arm's part, the UAV's and the magnet's.

`abort`: the arm draws back and holds, the UAV flies by itself. `holding`: the arm holds the UAV, which stays level with the
thrust it has: without it, it would topple over its hinge. `hanging`: the arm holds a UAV that cannot stay level, rotors stopped.
`balancing`: rotors stopped, the arm moves the pivot below the UAV so that it stays upright; near the rails it sets it down.
`let_fly`: the magnet has lost its grip, so the UAV gets its thrust back.
`secured`: the UAV stands on the cradle, the arm gives way, the magnet stays on. `braked_…`: the arm's brakes are on.
"""
