"""Numbers with bounds, and the strict section that all tables of a scenario are made of.

Every number has an upper bound as well as a lower one. A bound lies where no demonstrator of this kind can be, so that what is refused
is a slip of units or of the keyboard. Both bounds belong to the range: what a message names is allowed. A bound stands in a
number's type and nowhere else: pydantic lets one beside the default be overruled by the type's.
"""

from typing import Annotated, Any, ClassVar, Self

import numpy as np
from pydantic import AfterValidator, BaseModel, ConfigDict, Field, model_validator


class Section(BaseModel):
    """A table of a scenario: frozen, unknown keys are errors, numbers are never guessed from text."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True)

    rising: ClassVar[tuple[tuple[str, str, str], ...]] = ()
    """A key, another that must be above it, and why where that is not plain."""

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if found := self._contradictions():
            raise ValueError("\n".join(found))
        return self

    def _contradictions(self) -> list[str]:
        # A line for each; a section may have more of them.
        found = []
        for low, high, why in self.rising:
            a, b = getattr(self, low), getattr(self, high)
            if a >= b:
                found.append(f"{low} = {a:g} must be below {high} = {b:g}{why and f': {why}'}")
        return found


def between(low: float, high: float) -> object:
    """The finite numbers from `low` to `high`, both included, as pydantic's annotation of a type."""
    return Field(ge=low, le=high, allow_inf_nan=False)


def key(default: Any, meaning: str) -> Any:
    """A key of a section: its default, what it means, and its unit where the type does not say it."""
    return Field(default, description=meaning)


Fraction = Annotated[float, between(0.0, 1.0)]
PositiveFraction = Annotated[float, between(1e-6, 1.0)]
Coordinate = Annotated[float, between(-100.0, 100.0)]
"""m."""
Length = Annotated[float, between(1e-6, 100.0)]
"""m, above zero."""
Distance = Annotated[float, between(0.0, 100.0)]
"""m, zero allowed."""
Angle = Annotated[float, between(-1000.0, 1000.0)]
"""rad or deg, either sign."""
Degrees = Annotated[float, between(0.0, 180.0)]
Tilt = Annotated[float, between(1e-3, 90.0)]
"""deg, above zero."""
Mass = Annotated[float, between(1e-4, 1000.0)]
"""kg, above zero."""
Load = Annotated[float, between(0.0, 1000.0)]
"""kg, zero allowed."""
Force = Annotated[float, between(0.0, 1e5)]
"""N."""
PositiveForce = Annotated[float, between(1e-6, 1e5)]
SignedForce = Annotated[float, between(-1e5, 1e5)]
Torque = Annotated[float, between(0.0, 1e4)]
"""N·m."""
PositiveTorque = Annotated[float, between(1e-6, 1e4)]
SignedTorque = Annotated[float, between(-1e4, 1e4)]
Speed = Annotated[float, between(0.0, 100.0)]
"""m/s or rad/s."""
PositiveSpeed = Annotated[float, between(1e-6, 100.0)]
SignedSpeed = Annotated[float, between(-100.0, 100.0)]
PositiveAcceleration = Annotated[float, between(1e-6, 1000.0)]
"""m/s²."""
SignedAcceleration = Annotated[float, between(-1000.0, 1000.0)]
Seconds = Annotated[float, between(0.0, 3600.0)]
PositiveSeconds = Annotated[float, between(1e-6, 3600.0)]
Rest = Annotated[float, between(0.0, 60.0)]
"""s."""
Milliseconds = Annotated[float, between(0.0, 10_000.0)]
PositiveMilliseconds = Annotated[float, between(1e-3, 10_000.0)]
Hertz = Annotated[float, between(1e-3, 1e5)]
Rate = Annotated[int, Field(ge=1, le=10_000)]
"""Hz, a divisor of the base rate."""
Bandwidth = Annotated[float, between(0.0, 1e4)]
"""rad/s; zero is none."""
PositiveBandwidth = Annotated[float, between(1e-3, 1e4)]
Gain = Annotated[float, between(1e-9, 1e6)]
"""Above zero; unit in the key's name or description."""
Coefficient = Annotated[float, between(0.0, 1e6)]
"""Zero allowed; unit in the key's name or description."""
PositiveCoefficient = Annotated[float, between(1e-9, 1e3)]
Sigma = Annotated[float, between(0.0, 1e3)]
"""Standard deviation."""
Factor = Annotated[float, between(1e-3, 1e3)]
"""A ratio about one."""

Point = tuple[Coordinate, Coordinate, Coordinate]
Force3 = tuple[SignedForce, SignedForce, SignedForce]
Torque3 = tuple[SignedTorque, SignedTorque, SignedTorque]
Velocity3 = tuple[SignedSpeed, SignedSpeed, SignedSpeed]
Acceleration3 = tuple[SignedAcceleration, SignedAcceleration, SignedAcceleration]
Gain3 = tuple[Gain, Gain, Gain]
Gain6 = tuple[Gain, Gain, Gain, Gain, Gain, Gain]
Component = Annotated[float, between(-1.0, 1.0)]
Direction = tuple[Component, Component, Component]
Moment = Annotated[float, between(-1e4, 1e4)]
"""kg·m²."""
Row3 = tuple[Moment, Moment, Moment]
Text = Annotated[str, Field(max_length=500)]


def _inertia(value: tuple[Row3, Row3, Row3]) -> tuple[Row3, Row3, Row3]:
    J = np.array(value)
    if not np.allclose(J, J.T, rtol=0.0, atol=1e-12):
        raise ValueError("inertia must be symmetric")
    eigenvalues = np.linalg.eigvalsh(J)
    if eigenvalues[0] <= 0.0:
        raise ValueError(f"inertia must be positive definite; its smallest eigenvalue is {eigenvalues[0]:g} kg·m²")
    if eigenvalues[0] + eigenvalues[1] < eigenvalues[2] * (1.0 - 1e-9):
        raise ValueError(
            f"no rigid body has the principal inertias {eigenvalues[0]:g}, {eigenvalues[1]:g}, {eigenvalues[2]:g} kg·m²: "
            f"the largest can be {eigenvalues[0] + eigenvalues[1]:.6g} at most, the sum of the others"
        )
    return value


Inertia = Annotated[tuple[Row3, Row3, Row3], AfterValidator(_inertia)]
