"""Values that no source publishes, each inside the range that a source or an argument supports."""

from pathlib import Path
from typing import Annotated, Any

from pydantic import BeforeValidator, Field, ValidationError

from armland.scenario.quantities import Section, Text, between
from armland.scenario.refusal import problems
from armland.scenario.tables import as_json

Number = Annotated[float, between(-1e9, 1e9)]


class Calibrated(Section):
    """A value that no source publishes, inside the range that a source or an argument supports."""

    value: Annotated[
        tuple[Number, ...],
        Field(min_length=1, max_length=64, description="one number, or several of a kind"),
        BeforeValidator(lambda value: tuple(value) if isinstance(value, list) else (value,)),
    ]
    low: Number = Field(description="least value that is supported")
    high: Number = Field(description="largest value that is supported")
    unit: Text = Field(description="of the three; 1 for a ratio")
    because: str = Field(min_length=10, max_length=2000, description="source or argument for the range")

    def _contradictions(self) -> list[str]:
        supported = f"its supported range {self.low:g} to {self.high:g}{'' if self.unit == '1' else f' {self.unit}'}"
        return [f"value {v:g} lies outside {supported}" for v in self.value if not self.low <= v <= self.high]


def merge_calibration(data: dict[str, Any], calibration: dict[str, Any], file: Path) -> list[str]:
    """Put the values of `calibration` into the tables of `data`, in place; returns what is wrong with them."""
    found, name = [], file.name
    for section, entries in calibration.items():
        target = data.setdefault(section, {})
        if not isinstance(entries, dict) or not isinstance(target, dict):
            found.append(f"{name}: {section}: expected a table of calibrated values")
            continue
        for key, entry in entries.items():
            try:
                Calibrated.model_validate_json(as_json(entry))
            except ValidationError as e:
                found += problems(e, Calibrated, f"{name}: {section}.{key}")
                # The value itself is judged with the scenario, so that it is not also called missing.
                if isinstance(entry, dict) and "value" in entry:
                    target.setdefault(key, entry["value"])
                continue
            if key in target:
                found.append(f"{section}.{key} is set here and in {name}; keep one of the two")
            target[key] = entry["value"]
    return found
