"""What is a dimension of a design: which number may a designer choose, and within which limits?"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any

_KEY = "dimension"


@dataclass(frozen=True, slots=True)
class Dimension:
    """A number that a designer chooses. `default`, `low` and `high` are in `unit`, a spelling of watchsim.units ("" for plain
    numbers and counts); `source` says where the default or the limits come from. A `count` must be a whole number."""

    name: str
    meaning: str
    unit: str
    default: float
    low: float
    high: float
    source: str
    count: bool = False

    @property
    def option(self) -> str:
        """As an option of the command line: "tip_radius" is --tip-radius."""
        return f"--{self.name.replace('_', '-')}"

    def shown(self, value: float) -> str:
        """The value with the unit, as a scene file has it: "1.5°", "2.4 mm", "15"."""
        number = repr(value).removesuffix(".0")
        return f"{number}{'' if self.unit in ('', '°') else ' '}{self.unit}"

    def shortly(self, value: float) -> str:
        """The same with six digits, to read."""
        return self.shown(float(f"{value:.6g}"))


def dim(default: float, unit: str, low: float, high: float, meaning: str, source: str) -> Any:
    """The field of a design's values that holds one dimension; a whole number as default makes it a count."""
    told = {"meaning": meaning, "unit": unit, "default": default, "low": low, "high": high, "source": source}
    return field(default=default, metadata={_KEY: {**told, "count": isinstance(default, int)}})


def dimensions_of(values: type[Any]) -> tuple[Dimension, ...]:
    """The dimensions that a dataclass of values declares with `dim`, in its order."""
    return tuple(Dimension(one.name, **one.metadata[_KEY]) for one in fields(values) if _KEY in one.metadata)
