"""What the pose filter knows, remembers and says: its settings, memory and output as structured records of shape (1,)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from armland.estimation.alignment import ALIGNMENT
from armland.estimation.late_fusion import RING, TRACK

PARAMETERS = np.dtype(
    [
        ("tick_s", "f8"),
        ("gravity", "f8"),
        ("driven", "i8"),
        ("mass", "f8"),
        ("marker_offset", "f8", (3,)),
        ("marker_quat", "f8", (4,)),
        ("plate_offset", "f8", (3,)),
        ("white", "f8"),
        ("blind", "f8"),
        ("walk", "f8"),
        ("sigma_attitude", "f8"),
        ("sigma_rate", "f8"),
        ("align_walk", "f8"),
        ("tilt_prior", "f8"),
        ("speed_prior", "f8"),
        ("bias_prior", "f8"),
        ("gate", "f8"),
        ("restart_after", "i8"),
        ("hold", "i8"),  # ticks
        ("age_max", "i8"),  # ticks
        ("sigma_position_max", "f8"),
        ("sigma_velocity_max", "f8"),
    ]
)

MEMORY = np.dtype(
    [
        ("track", TRACK),
        ("quat", "f8", (RING, 4)),  # q_imu, carried on where no sample has come yet
        ("thrust", "f8", (RING,)),  # N
        ("push", "f8", (RING, 3)),  # m/s², world: what else is known to accelerate it, written by the caller
        ("camera_position", "f8", (RING, 3)),  # m, world
        ("camera_quat", "f8", (RING, 4)),  # world<-camera
        ("first_tick", "i8"),
        ("imu_tick", "i8"),
        ("rate", "f8", (3,)),  # rad/s, body
        ("align", ALIGNMENT),
        ("seen", "f8", (7,)),  # the last sample's numbers, to know a frozen image
        ("sample_tick", "i8"),  # capture of the newest fused sample
        ("gated", "i8"),  # in a row
        ("distance", "f8", (2,)),  # squared innovation distances of the last sample: position, attitude; χ² of 3 each
    ]
)

PLATE = np.dtype(
    [
        ("tick", "i8"),
        ("valid", "i8"),
        ("position", "f8", (3,)),  # m, world
        ("velocity", "f8", (3,)),  # m/s, world
        ("acceleration", "f8", (3,)),  # m/s², world, of the centre of mass
        ("bias", "f8", (3,)),  # m/s², world, the part of it that no model explains: wind, thrust error
        ("quat", "f8", (4,)),  # world<-body
        ("omega", "f8", (3,)),  # rad/s, body
        ("sigma_position", "f8", (3,)),  # m, world axes
        ("sigma_velocity", "f8", (3,)),  # m/s, world axes
        ("sigma_attitude", "f8", (3,)),  # rad, about world axes
        ("age", "f8"),  # s, since the capture of the newest fused sample
    ]
)


class PoseFilter(NamedTuple):
    """Settings of the filter. Numbers without a source are assumptions."""

    mass: float = 0.480
    """kg."""
    driven: bool = True
    """Whether thrust and attitude predict the acceleration; otherwise the bias is the whole of it."""
    marker_offset: tuple[float, float, float] = (0.0, 0.0, -0.03)
    """Centre of mass to the marker's centre, m, body."""
    marker_quat: tuple[float, float, float, float] = (0.0, 1.0, 0.0, 0.0)
    """body<-marker: the printed face looks down."""
    plate_offset: tuple[float, float, float] = (0.0, 0.0, -0.06)
    """Centre of mass to the hinge, m, body."""
    white: float = 0.05
    """m/s²/√Hz: attitude noise times g, rotor ripple."""
    blind: float = 0.5
    """The same where the attitude is older than `hold_s`, and in predictions."""
    walk: float = 0.3
    """m/s³/√Hz: gusts; 1.5 m/s of turbulence, a drag of 0.45 1/s and 5 s of correlation make about 0.43."""
    sigma_attitude: float = 2e-3
    """rad."""
    sigma_rate: float = 1e-2
    """rad/s."""
    align_walk: float = 1e-3
    """rad/√s: gyro drift."""
    tilt_prior: float = 0.03
    """rad: how wrong the UAV's roll and pitch may be."""
    speed_prior: float = 1.0
    """m/s."""
    bias_prior: float = 2.0
    """m/s²."""
    gate: float = 16.27
    """χ² with 3 degrees of freedom exceeds it once in a thousand."""
    restart_after: int = 4
    """Gated samples in a row after which the filter begins anew."""
    hold_s: float = 0.05
    """How long a rate may carry an attitude on."""
    age_max_s: float = 0.25
    """Oldest sample and oldest attitude of a valid estimate."""
    sigma_position_max: float = 0.01
    """m, per axis; above it the estimate is not valid."""
    sigma_velocity_max: float = 0.10
    """m/s."""


def pose_filter_parameters(settings: PoseFilter, tick_s: float, gravity: float = 9.81) -> NDArray[np.void]:
    """`PARAMETERS` (1,) for a loop with ticks of `tick_s` seconds."""
    p: NDArray[np.void] = np.zeros(1, PARAMETERS)
    for name, value in settings._asdict().items():
        if name in (PARAMETERS.names or ()):
            p[name] = value
    p["tick_s"], p["gravity"] = tick_s, gravity
    p["hold"], p["age_max"] = round(settings.hold_s / tick_s), round(settings.age_max_s / tick_s)
    return p
