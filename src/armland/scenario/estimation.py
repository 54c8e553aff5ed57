"""Settings of the estimators. Numbers without a source are assumptions."""

from typing import Annotated

from pydantic import Field

from armland.scenario import quantities as of
from armland.scenario.quantities import Section, key


class PlateFilter(Section):
    """Pose filter of the plate, see `estimation.plate`."""

    white: of.Sigma = key(0.05, "m/s²/√Hz: attitude noise times g, rotor ripple")
    blind: of.Sigma = key(0.5, "m/s²/√Hz, where the attitude is older than hold_s, and in predictions")
    walk: of.Sigma = key(0.3, "m/s³/√Hz: gusts; 1.5 m/s of turbulence, 0.45 1/s of drag, 5 s make about 0.43")
    align_walk: of.Sigma = key(1e-3, "rad/√s: gyro drift")
    tilt_prior_rad: of.Sigma = key(0.03, "how wrong the UAV's roll and pitch may be")
    speed_prior_mps: of.Sigma = key(1.0, "how fast the plate may move when it is first seen, each axis")
    bias_prior_mps2: of.Sigma = key(2.0, "acceleration that thrust and attitude may miss, each axis")
    gate: of.Gain = key(16.27, "squared ratio: χ² with 3 degrees of freedom exceeds it once in a thousand")
    restart_after: Annotated[int, Field(ge=1, le=1000)] = key(
        4, "number of gated samples in a row after which it begins anew"
    )
    accelerometer: bool = key(True, "whether the UAV's accelerometers are asked, where wind is foretold")
    hold_s: of.Seconds = key(0.05, "how long a rate may carry an attitude on")
    age_max_s: of.Seconds = key(0.25, "oldest sample and oldest attitude of a valid estimate")
    sigma_position_max_m: of.Sigma = key(0.01, "per axis; above it the estimate is not valid")
    sigma_velocity_max_mps: of.Sigma = key(0.10, "likewise")


class WrenchBias(Section):
    """Learning of the force-torque sensor's bias, see `estimation.wrench`."""

    block_s: of.PositiveSeconds = key(0.2, "longer than a contact goes unnoticed")
    gain: of.PositiveFraction = key(0.1, "share of a block, once the first ones have been averaged")
    rate_nps: of.Gain = key(5.0, "N/s at which the output follows the estimate")
    rate_nmps: of.Gain = key(0.2, "N·m/s, likewise")
    plausible_n: of.Gain = key(3.0, "a free end effector that reads further from its bias touches something")
    plausible_nm: of.Gain = key(0.2, "likewise")
    drift_n: of.Sigma = key(0.01, "N/√s: random walk of the bias")
    drift_nm: of.Sigma = key(0.0003, "N·m/√s")


class Switching(Section):
    """Thresholds and debouncing of one trigger: on above `on` for `on_s`, off below `off` for `off_s`."""

    rising = (("off", "on", ""),)

    on: of.Gain = Field(description="threshold above which it switches on; N, or a share of the weight")
    off: of.Gain = Field(description="threshold below which it switches off; likewise")
    on_s: of.Seconds = Field(description="how long the value stays above it before")
    off_s: of.Seconds = Field(description="how long the value stays below it before")


class ContactDetection(Section):
    """Who carries the UAV, see `estimation.contact`."""

    share_s: of.PositiveSeconds = key(0.02, "time constant of the shares' low pass")
    calm_s: of.Seconds = key(
        0.0, "time constant in which the hinge force is averaged where it is waited for, or must be explained; 0: none"
    )
    clearance_m: of.Gain = key(0.01, "retreat after which a magnet without force has surely let go")
    contact_n: Switching = key(Switching(on=1.2, off=0.6, on_s=0.004, off_s=0.10), "hinge force: contact")
    touchdown: Switching = key(
        Switching(on=0.15, off=0.05, on_s=0.03, off_s=0.10), "share of the weight on the cradle: it has been touched"
    )
    resting: Switching = key(
        Switching(on=0.85, off=0.70, on_s=0.10, off_s=0.05), "share of the weight on the cradle: the UAV rests"
    )
    release_n: Switching = key(
        Switching(on=0.6, off=0.4, on_s=0.0, off_s=0.10), "hinge force whose absence says that the plate is free"
    )


class Estimation(Section):
    """All estimators of a landing."""

    plate: PlateFilter = key(PlateFilter(), "pose filter of the plate")
    wrench: WrenchBias = key(WrenchBias(), "bias of the force-torque sensor")
    contact: ContactDetection = key(ContactDetection(), "who carries the UAV")
    load_observer_rad_s: of.Bandwidth = key(8.0, "disturbance observer (X.3) of the held UAV, landing; 0: none")
    load_observer_limit_n: of.Gain = key(6.0, "largest force that it holds responsible")
