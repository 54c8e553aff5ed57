"""Settings of the estimators. Numbers without a source are assumptions."""

from typing import Annotated

from pydantic import Field, model_validator

from armland.scenario.quantities import Bandwidth, Gain, PositiveFraction, PositiveSeconds, Seconds, Section, Sigma


class PlateFilter(Section):
    """Pose filter of the plate, see `estimation.plate`."""

    white: Sigma = Field(0.05, description="m/s²/√Hz: attitude noise times g, rotor ripple")
    blind: Sigma = Field(0.5, description="m/s²/√Hz, where the attitude is older than hold_s, and in predictions")
    walk: Sigma = Field(
        0.3, description="m/s³/√Hz: gusts; 1.5 m/s of turbulence, 0.45 1/s of drag, 5 s make about 0.43"
    )
    align_walk: Sigma = Field(1e-3, description="rad/√s: gyro drift")
    tilt_prior_rad: Sigma = Field(0.03, description="how wrong the UAV's roll and pitch may be")
    speed_prior_mps: Sigma = Field(1.0, description="how fast the plate may move when it is first seen, each axis")
    bias_prior_mps2: Sigma = Field(2.0, description="acceleration that thrust and attitude may miss, each axis")
    gate: Gain = Field(16.27, description="squared ratio: χ² with 3 degrees of freedom exceeds it once in a thousand")
    restart_after: Annotated[int, Field(ge=1, le=1000)] = Field(
        4, description="number of gated samples in a row after which it begins anew"
    )
    hold_s: Seconds = Field(0.05, description="how long a rate may carry an attitude on")
    age_max_s: Seconds = Field(0.25, description="oldest sample and oldest attitude of a valid estimate")
    sigma_position_max_m: Sigma = Field(0.01, description="per axis; above it the estimate is not valid")
    sigma_velocity_max_mps: Sigma = Field(0.10, description="likewise")


class WrenchBias(Section):
    """Learning of the force-torque sensor's bias, see `estimation.wrench`."""

    block_s: PositiveSeconds = Field(0.2, description="longer than a contact goes unnoticed")
    gain: PositiveFraction = Field(0.1, description="share of a block, once the first ones have been averaged")
    rate_nps: Gain = Field(5.0, description="N/s at which the output follows the estimate")
    rate_nmps: Gain = Field(0.2, description="N·m/s, likewise")
    plausible_n: Gain = Field(3.0, description="a free end effector that reads further from its bias touches something")
    plausible_nm: Gain = Field(0.2, description="likewise")
    drift_n: Sigma = Field(0.01, description="N/√s: random walk of the bias")
    drift_nm: Sigma = Field(0.0003, description="N·m/√s")


class Switching(Section):
    """Thresholds and debouncing of one trigger: on above `on` for `on_s`, off below `off` for `off_s`."""

    on: Gain = Field(description="threshold above which it switches on; N, or a share of the weight")
    off: Gain = Field(description="threshold below which it switches off; likewise")
    on_s: Seconds = Field(description="how long the value stays above it before")
    off_s: Seconds = Field(description="how long the value stays below it before")

    @model_validator(mode="after")
    def _order(self) -> "Switching":
        if not self.on > self.off:
            raise ValueError(f"on = {self.on:g} must be above off = {self.off:g}")
        return self


class ContactDetection(Section):
    """Who carries the UAV, see `estimation.contact`."""

    share_s: PositiveSeconds = Field(0.02, description="time constant of the shares' low pass")
    clearance_m: Gain = Field(0.01, description="retreat after which a magnet without force has surely let go")
    contact_n: Switching = Field(Switching(on=1.2, off=0.6, on_s=0.004, off_s=0.10), description="hinge force: contact")
    touchdown: Switching = Field(
        Switching(on=0.15, off=0.05, on_s=0.03, off_s=0.10),
        description="share of the weight on the cradle: it has been touched",
    )
    resting: Switching = Field(
        Switching(on=0.85, off=0.70, on_s=0.10, off_s=0.05),
        description="share of the weight on the cradle: the UAV rests",
    )
    release_n: Switching = Field(
        Switching(on=0.6, off=0.4, on_s=0.0, off_s=0.10),
        description="hinge force whose absence says that the plate is free",
    )


class Estimation(Section):
    """All estimators of a landing."""

    plate: PlateFilter = Field(PlateFilter(), description="pose filter of the plate")
    wrench: WrenchBias = Field(WrenchBias(), description="bias of the force-torque sensor")
    contact: ContactDetection = Field(ContactDetection(), description="who carries the UAV")
    load_observer_rad_s: Bandwidth = Field(
        8.0, description="disturbance observer (X.3) of the held UAV, landing; 0: none"
    )
    load_observer_limit_n: Gain = Field(6.0, description="largest force that it holds responsible")
