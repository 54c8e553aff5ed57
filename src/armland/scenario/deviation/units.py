"""Units of deviations, from the endings of their keys."""

import re

ENDINGS = {
    "per_s": "1/s",
    "mps2": "m/s²",
    "mps": "m/s",
    "dps": "°/s",
    "nmps": "N·m/s",
    "nps": "N/s",
    "nms": "N·m·s/rad",
    "nm": "N·m",
    "deg": "°",
    "rad": "rad",
    "ms": "ms",
    "px": "px",
    "kg": "kg",
    "n": "N",
    "m": "m",
}

OTHERS = {"arm.compliance": "rad/(N·m)", "hinge.stiffness_nm": "N·m/rad"}

_ENDING = re.compile(rf"_({'|'.join(ENDINGS)})$")


def unit_of(path: str) -> str:
    """Unit of the deviation `device.key`; 1 for shares, probabilities and correlations."""
    found = _ENDING.search(path)
    return OTHERS.get(path) or (ENDINGS[found[1]] if found else "1")
