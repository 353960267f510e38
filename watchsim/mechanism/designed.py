"""What does a scene that is made from a design hold?

`[design] of = "swiss_lever"` stands for the design's own scene; other keys of the table are dimensions.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from watchsim import units
from watchsim.construction.design import Design
from watchsim.construction.dimension import Dimension
from watchsim.mechanism.errors import Faults
from watchsim.mechanism.schema import nearest
from watchsim.mechanism.table import shown
from watchsim.units import UnitError


def chosen(design: Design, given: Mapping[str, object], faults: Faults | None = None) -> Any:
    """The values of a design with some dimensions given as in a scene file; SceneError lists all that is wrong."""
    known = faults or Faults(design.name)
    before = len(known.found)
    numbers = {}
    for name, value in given.items():
        if name not in (one.name for one in design.dimensions):
            known.add(f"design.{name}", f"unknown dimension. {nearest(name, [one.name for one in design.dimensions])}")
            continue
        try:
            numbers[name] = number_of(design.dimension(name), value)
        except UnitError as error:
            known.add(f"design.{name}", str(error), shown(value))
    for conflict in design.refusals(numbers):
        name = conflict.dimension
        known.add(f"design.{name}" if name else "design", conflict.message, shown(given[name]) if name in given else "")
    if faults is None:
        known.raise_any()
    return None if len(known.found) > before else design.chosen(numbers)


def number_of(dimension: Dimension, value: object) -> float:
    """The number in the dimension's own unit; UnitError where the value is none."""
    unit = units.known_unit(dimension.unit)
    kind = next(one for one in units.DIMENSIONS if unit.powers in one.powers)
    if kind is units.NUMBER:
        return units.parse(value, kind)
    number, text = units.split(value)
    if text and units.known_unit(text, kind) == unit:
        return float(number)
    return float(f"{units.parse(value, kind) / unit.factor:.15g}")  # a place less than the rounding of the conversion
