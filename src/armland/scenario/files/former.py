"""Former names of keys: files of before version 0.2 are read, each key at the place where it stands today."""

from typing import Any

from armland.scenario.tables import put, take

DEMONSTRATOR = "demonstrator"
"""Table whose tables stand at the top today."""

FORMER = {
    "seed": "run.seed",
    "duration_s": "run.duration_s",
    "eye.camera_m": "camera.position_m",
    "eye.marker_m": "camera.marker_m",
    "eye.marker_size_m": "camera.marker_size_m",
    "eye.rate_hz": "camera.rate_hz",
    "envelope.joint_speed_rad_s": "arm.joint_speed_rad_s",
    "envelope": "limits",
    "rotors.density_kgm3": "environment.air_density_kgm3",
    "rotors.drag_nspm": "uav.drag_nspm",
    "onboard_kp_nm": "onboard.kp_nm",
    "onboard_kd_nms": "onboard.kd_nms",
    "onboard_lead_s": "onboard.lead_s",
    "onboard_rotor_watch": "onboard.rotor_watch",
    "carry_share": "control.thrust.carry_share",
    "magnet_rating_n": "magnet.rating_n",
    "plate_mass_kg": "plate.mass_kg",
    "extra_mass_kg": "uav.extra_mass_kg",
    "control.model_inertia_scale": "belief.arm.inertia_scale",
}
"""Dotted path of a key or table -> where it stands today."""

LANDING = frozenset(
    {"place", "bounds", "eye", "envelope", "imperfections", "faults", "seed", "duration_s", DEMONSTRATOR, *FORMER}
) - {"control.model_inertia_scale"}
"""Tables and keys at the top of a landing's file. Its base was the demonstrator of the paper, which the landing's is today."""

COMPLETE = frozenset({"link", "trajectory", "calibration"})
"""Tables and keys at the top of a file that needs no base."""

BELIEVED = ("mass_kg", "inertia_kgm2", "lever_m")
"""Keys of `demonstrator.uav` that have always been what the law believes, and not what flies."""


def renamed(data: dict[str, Any]) -> list[str]:
    """Move keys with former names to where they stand today, in place; values stay as they are.

    Returns:
        What is wrong with them: a key that stands there under both names, or in a table that is none.
    """
    problems: list[str] = []

    def move(old: str, new: str, value: Any) -> None:
        if not put(data, new, value):
            problems.append(f"{old}: {new} is the same and set too; keep one of the two")

    tables = take(data, DEMONSTRATOR)
    if isinstance(tables, dict):
        for name, table in tables.items():
            for key, value in table.items() if isinstance(table, dict) else [("", table)]:
                path = f"{name}.{key}".rstrip(".")
                believed = name == "uav" and key in BELIEVED
                move(f"{DEMONSTRATOR}.{path}", f"belief.{path}" if believed else path, value)
    elif tables is not None:
        problems.append(f"{DEMONSTRATOR}: should be a table (got {tables!r:.60})")
    for old, new in FORMER.items():
        value = take(data, old)
        if isinstance(value, dict):
            for key, inner in value.items():
                move(f"{old}.{key}", f"{new}.{key}", inner)
        elif value is not None:
            move(old, new, value)
    return problems


def without_effect(data: dict[str, Any]) -> frozenset[str]:
    """Dotted paths, as they are today, of keys in the tables `data` of a file that a landing's file of before version 0.2 had to have.

    Every landing had a thrust on the hinge within what its rotors give, though only the paper's experiments use it.
    """
    control = data.get(DEMONSTRATOR)
    control = control.get("control") if isinstance(control, dict) else None
    return frozenset({"control.thrust_n"} if isinstance(control, dict) and "thrust_n" in control else ())


def rebased(data: dict[str, Any]) -> None:
    """Base a file on the landing that comes with armland where it names no base and needs one.

    A landing's file of before version 0.2 names the paper's demonstrator, or nothing, and means the same.
    """
    incomplete = not COMPLETE & data.keys()
    if incomplete and ("base" not in data or (data["base"] == "paper" and LANDING & data.keys())):
        data["base"] = "landing"
