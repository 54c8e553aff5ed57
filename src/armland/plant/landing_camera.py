"""The camera of a landing: the measurement model with what mounting and calibration left wrong in it for this seed."""

import numpy as np
from numpy.typing import NDArray

from armland.mission.landing_scenario import Landing
from armland.plant.camera import Camera
from armland.plant.noise import stream


def landing_camera(landing: Landing) -> Camera:
    """The measurement model's settings for a landing; with `imperfections.camera` off it is exact and at once."""
    eye, bad = landing.eye, landing.imperfections
    plain = Camera(rate_hz=eye.rate_hz, marker_size_m=eye.marker_size_m)
    if not bad.camera:
        return plain._replace(delay_ms=(0.0, 0.0), honesty=0.01, lose=0.0, exposure_s=0.0)
    u = stream(landing.seed, "camera mounting").uniform(-1.0, 1.0, 6)
    angle = np.deg2rad(bad.camera_angle_deg)
    shift = tuple((bad.camera_mount_m * u[:3]).tolist())
    return plain._replace(shift_m=shift, slope=(angle * u[3], angle * u[4], bad.camera_scale * u[5]))


def see_all(p: NDArray[np.void]) -> None:
    """Let the camera of `PARAMETERS` (1,) see a marker wherever it is before it, and lose none."""
    p["depth_min"], p["depth_max"], p["cos_incidence"] = 0.0, np.inf, -1.0
    p["half_width"] = p["half_height"] = np.inf
    p["lose"] = p["stay_lost"] = p["smear_scale"] = 0.0
