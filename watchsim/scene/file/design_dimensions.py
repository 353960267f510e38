"""Which values has a design whose dimensions are given as texts with units?"""

from __future__ import annotations

from collections.abc import Mapping
from numbers import Real
from typing import Any

from watchsim import units
from watchsim.construction.design import Design
from watchsim.construction.dimension import Dimension
from watchsim.scene.errors import Faults
from watchsim.scene.file.keys.key_values import shown
from watchsim.scene.file.keys.schema import DESIGN, nearest
from watchsim.units import UnitError


def chosen(design: Design, given: Mapping[str, object], faults: Faults | None = None) -> Any:
    """The values with some dimensions given as in a scene file; None after a fault, without `faults` SceneError lists them."""
    noted = faults or Faults(design.name)
    before, names = len(noted.found), [one.name for one in design.dimensions]
    numbers = {}
    for name, value in given.items():
        if name not in names:
            noted.add(f"{DESIGN}.{name}", f"unknown dimension. {nearest(name, names)}")
            continue
        try:
            numbers[name] = number_of(design.dimension(name), value)
        except UnitError as error:
            noted.add(f"{DESIGN}.{name}", str(error), shown(value))
    for conflict in design.refusals(numbers):
        key = f"{DESIGN}.{conflict.dimension}" if conflict.dimension else DESIGN
        noted.add(key, conflict.message, _seen(design, conflict.dimension, given))
    if faults is None:
        noted.raise_any()
    return None if len(noted.found) > before else design.chosen(numbers)


def number_of(dimension: Dimension, value: object) -> float:
    """The number in the dimension's own unit; UnitError where the value is none."""
    unit, kind = units.known_unit(dimension.unit), kind_of(dimension)
    if kind is units.NUMBER:
        return units.parse(value, kind)
    number, text = units.split(value)
    if text and units.known_unit(text, kind) == unit:
        return float(number)
    return float(f"{units.parse(value, kind) / unit.factor:.15g}")  # the sixteenth place is rounding of the conversion


def kind_of(dimension: Dimension) -> units.Dimension:
    """The kind of quantity that its unit measures."""
    unit = units.known_unit(dimension.unit)
    return next(one for one in units.DIMENSIONS if unit.powers in one.powers)


def with_si(design: Design, name: str, value: object) -> object:
    """A number from Python as text in SI units, as with every other key of a scene; all else as it is."""
    dimension = next((one for one in design.dimensions if one.name == name), None)
    if dimension is None or isinstance(value, bool) or not isinstance(value, Real):
        return value
    kind = kind_of(dimension)
    return float(value) if kind is units.NUMBER else f"{float(value)!r} {kind.si}"


def _seen(design: Design, name: str, given: Mapping[str, object]) -> str:
    """The value as it was given, or the default that stands in the way."""
    if name in given:
        return shown(given[name])
    return f" = {design.dimension(name).shortly(design.dimension(name).default)} (default)" if name else ""
