"""What the pose filter is told, keeps and says: structured records."""

from functools import lru_cache

import numpy as np

from armland.estimation.plate.alignment import ALIGNMENT
from armland.estimation.plate.late_fusion import RING, TRACK
from armland.records import Records
from armland.rotations import Array
from armland.scenario import Scenario

FORGOTTEN_S, FELT_S = 0.5, 2.0
"""Time without a sample after which the filter begins anew: the gust that it knew may be over, and the UAV, told to hover by its own
means by then, is nearly at rest. Likewise where the UAV says what it feels: a gust that ends is known, and what is left of its
accelerometers' bias, 0.05 m/s², makes 0.1 m."""

UNFELT_MPS2 = 0.5
"""Acceleration that a UAV may miss which says what it feels: its accelerometers' bias of up to 50 mg, and 0.03 rad of tilt. With the
2 m/s² of one that does not, three images that scatter more than they claim made a UAV that hovers one that is 10 m away in 2 s."""

FACE_DOWN = (0.0, 1.0, 0.0, 0.0)
"""body<-marker: the printed face looks down."""


@lru_cache
def told_layout() -> np.dtype:
    """What the filter is told."""
    return np.dtype(
        [
            ("tick_s", "f8"),
            ("mass", "f8"),
            ("marker_offset", "f8", (3,)),
            ("marker_quat", "f8", (4,)),
            ("plate_offset", "f8", (3,)),
            ("gust_max", "f8"),  # m/s², most that is felt beyond the model; 0: accelerometers are not asked
            ("forgotten", "f8"),  # s without a sample after which it begins anew
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


@lru_cache
def kept_layout() -> np.dtype:
    """What it keeps; zeros at first."""
    return np.dtype(
        [
            ("track", TRACK),
            ("quat", "f8", (RING, 4)),  # q_imu, carried on where no sample has come yet
            ("lift", "f8", (RING,)),  # N
            ("push", "f8", (RING, 3)),  # m/s² [D]: gravity and what else is known to accelerate it
            ("camera_position", "f8", (RING, 3)),  # m, D
            ("camera_quat", "f8", (RING, 4)),  # D<-camera
            ("first_tick", "i8"),
            ("fused", "i8"),  # samples that were fused since it began, or began anew
            ("leapt", "i8"),  # tick at which the marker was last found far from where it had just been
            ("noise", "f8"),  # real variance of the camera over the claimed one, by what is seen; 0: not yet begun
            ("scattered", "i8"),  # samples since the last one that was believed that are far from the one before
            ("innovation", "f8", (3,)),  # m, D, of the last sample
            ("turn", "f8", (3,)),  # rad, D, of the last sample's attitude
            ("compared", "i8"),  # 1 where there is one
            ("gust", "f8", (3,)),  # m/s², body, what the UAV felt beyond the model at its newest sample
            ("felt", "f8", (3,)),  # m/s², D, that at the present tick
            ("imu_tick", "i8"),
            ("rate", "f8", (3,)),  # rad/s, body
            ("align", ALIGNMENT),
            ("seen", "f8", (7,)),  # the last sample's numbers, to know a frozen image
            ("sample_tick", "i8"),  # capture of the newest fused sample
            ("gated", "i8"),  # in a row
            (
                "distance",
                "f8",
                (2,),
            ),  # squared innovation distances of the last sample: position, attitude; χ² of 3 each
        ]
    )


@lru_cache
def plate_layout() -> np.dtype:
    """Pose, twist and certainty of the plate, as `pose_filter.predict` fills them in."""
    return np.dtype(
        [
            ("tick", "i8"),
            ("valid", "i8"),
            ("position", "f8", (3,)),  # m, D
            ("velocity", "f8", (3,)),  # m/s, D
            ("acceleration", "f8", (3,)),  # m/s², D, of the centre of mass
            ("bias", "f8", (3,)),  # m/s², D, the part of it that no model explains, felt or found: wind, thrust error
            ("quat", "f8", (4,)),  # D<-body
            ("omega", "f8", (3,)),  # rad/s, body
            ("sigma_position", "f8", (3,)),  # m, D axes
            ("sigma_velocity", "f8", (3,)),  # m/s, D axes
            ("sigma_attitude", "f8", (3,)),  # rad, about deck axes
            ("age", "f8"),  # s, since the capture of the newest fused sample
        ]
    )


def told(scenario: Scenario, mass: float, lever: Array, gust: float = 0.0) -> Records:
    """The record (1,) of `told_layout`.

    Args:
        scenario: as the controller believes it.
        mass: of all that flies, kg.
        lever: centre of mass to the hinge's pivot (3,), m, body.
        gust: m/s², largest that its accelerometers are believed; 0: they are not asked.
    """
    f, tick_s = scenario.estimation.plate, 1.0 / scenario.run.rate_hz
    p: Records = np.zeros(1, told_layout())
    gust = gust if f.accelerometer else 0.0
    p["tick_s"], p["mass"], p["gust_max"] = tick_s, mass, gust
    p["forgotten"] = FELT_S if gust > 0.0 else FORGOTTEN_S
    p["marker_offset"], p["marker_quat"], p["plate_offset"] = scenario.camera.marker_m, FACE_DOWN, lever
    p["sigma_attitude"], p["sigma_rate"] = scenario.sensors.attitude_rad, scenario.sensors.rate_rad_s
    for name in ("white", "blind", "walk", "align_walk", "gate", "restart_after"):
        p[name] = getattr(f, name)
    p["tilt_prior"], p["speed_prior"], p["bias_prior"] = f.tilt_prior_rad, f.speed_prior_mps, f.bias_prior_mps2
    if gust > 0.0:
        p["bias_prior"] = min(f.bias_prior_mps2, UNFELT_MPS2)
    # An attitude that comes late for good is not a stale one.
    late = round(1e-3 * scenario.link.downlink_delay_ms / tick_s)
    p["hold"], p["age_max"] = round(f.hold_s / tick_s) + late, round(f.age_max_s / tick_s) + late
    p["sigma_position_max"], p["sigma_velocity_max"] = f.sigma_position_max_m, f.sigma_velocity_max_mps
    return p
