"""Which values of which key does a sweep go through?

KEY=FROM:TO:N or KEY=A,B,C, with the unit behind the last number, behind TO, or behind each of them. KEY is a path, or the
name of a dimension of the scene's design.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from watchsim.scene.assign import dimension_of, full_key
from watchsim.scene.errors import Fault, SceneError
from watchsim.scene.keys import DESIGN
from watchsim.scene.scene import Scene
from watchsim.units import NUMBER, Dimension, UnitError, parse, show, split

MOST = 100_000  # points of a sweep

Value = float | str


@dataclass(frozen=True)
class Axis:
    """One key of the scene and its values: SI numbers, or texts as in the file where the key holds no quantity."""

    key: str
    values: tuple[Value, ...]
    si: str = ""  # unit of the values, "" for plain numbers and texts
    usual: str = ""  # unit in which people read them

    @property
    def column(self) -> str:
        """Name of the column in a table, with its unit."""
        return f"{self.key}_{slug(self.si)}" if self.si else self.key

    @property
    def is_numeric(self) -> bool:
        return all(not isinstance(value, str) for value in self.values)


def as_typed(value: Value, unit: str) -> Value:
    """The value in the unit that it was typed in, so that what is said of it is said in that unit."""
    return value if isinstance(value, str) or not unit else show(value, unit, 12)


def slug(unit: str) -> str:
    """A unit as the end of a column's name: "N·m/rad" is "N_m_per_rad"."""
    plain = unit.replace("·", "_").replace("/", "_per_").replace("²", "2").replace("³", "3").replace("°", "deg")
    return plain.replace("µ", "u").strip("_")


def axes_from_texts(scene: Scene, texts: Iterable[str]) -> tuple[Axis, ...]:
    """The axes of KEY=... texts; SceneError lists all that is wrong with them."""
    axes, faults = [], []
    for text in texts:
        key, equals, values = (part.strip() for part in text.partition("="))
        try:
            if not equals or not key or not values:
                raise UnitError('write KEY=FROM:TO:N or KEY=A,B,C, such as "torques.0.value=-0.6:-1.4:9 µN·m"')
            axes.append(_axis(scene, full_key(scene.source, key), values))
        except UnitError as error:
            faults.append(Fault(key or text, str(error), f" = {values}" if values else "", place="sweep"))
    return checked(scene, axes, faults)


def axes_from_values(scene: Scene, values: Mapping[str, Sequence[Any]]) -> tuple[Axis, ...]:
    """The axes of a mapping from keys to values: SI numbers, or texts with their units."""
    axes, faults = [], []
    for key, listed in values.items():
        dimension = dimension_of(scene, key)
        try:
            axes.append(_made(key, [_si(value, dimension) for value in listed], dimension))
        except (UnitError, TypeError) as error:
            faults.append(Fault(key, str(error), place="sweep"))
    return checked(scene, axes, faults)


def checked(scene: Scene, axes: Sequence[Axis], found: Sequence[Fault] = ()) -> tuple[Axis, ...]:
    """The axes, where each key is one of the scene and takes a value of it; SceneError lists all faults and those `found`.

    Dimensions that a design refuses are points of a study, with their reason, unless the first, the middle and the last are.
    """
    faults = list(found)
    for i, axis in enumerate(axes):
        if any(axis.key == earlier.key for earlier in axes[:i]):
            faults.append(Fault(axis.key, "is given twice; name each key once", place="sweep"))
            continue
        refused = []
        last = len(axis.values) - 1 if axis.key.startswith(f"{DESIGN}.") else 0
        for k in sorted({0, last // 2, last}):
            try:
                scene.set(axis.key, as_typed(axis.values[k], axis.usual))
                break
            except SceneError as error:
                refused.append(error)
        else:
            faults += (replace(fault, place="sweep") for fault in refused[0].faults)
    points = int(np.prod([len(axis.values) for axis in axes], dtype=float)) if axes else 0
    if points > MOST:
        faults.append(Fault(axes[0].key, f"these are {points} points; a sweep takes at most {MOST}", place="sweep"))
    if faults:
        raise SceneError(faults)
    return tuple(axes)


def _axis(scene: Scene, key: str, values: str) -> Axis:
    dimension = dimension_of(scene, key)
    parts = [part.strip() for part in values.split(":")]
    if dimension is not None and len(parts) == 3:
        count, unit = split(parts[2])
        unit = unit or split(parts[1])[1]
        start, end = (_quantity(part, unit, dimension) for part in parts[:2])
        if not count.isdigit() or int(count) < 1:
            raise UnitError(f'"{parts[2]}": the number of values must be a whole number, 1 or more')
        if int(count) > MOST:
            raise UnitError(f"{count} values are more than the {MOST} a sweep takes")
        if int(count) == 1 and start != end:
            raise UnitError("one value cannot go from one number to another; write at least 2, or the value itself")
        return _made(key, [float(value) for value in np.linspace(start, end, int(count))], dimension, unit)
    if dimension is not None and len(parts) != 1:
        raise UnitError("write FROM:TO:N, such as 0.1:0.2:5, or values with commas between them")
    items = [item.strip() for item in values.split(",")]
    if dimension is None:
        return _made(key, items, None)
    unit = split(items[-1])[1]
    return _made(key, [_quantity(item, unit, dimension) for item in items], dimension, unit)


def _quantity(text: str, unit: str, dimension: Dimension) -> float:
    """A number with its own unit, else with `unit`."""
    number, own = split(text)
    return parse(text if own or not unit else f"{number} {unit}", dimension)


def _si(value: Any, dimension: Dimension | None) -> Value:
    if isinstance(value, str):
        return parse(value, dimension) if dimension is not None else value
    return float(value)


def _made(key: str, values: list[Any], dimension: Dimension | None, typed: str = "") -> Axis:
    """`typed`: the unit that the values were given in."""
    if not values:
        raise UnitError("no values are given")
    if dimension is None or dimension is NUMBER:
        return Axis(key, tuple(values))
    return Axis(key, tuple(values), dimension.si, typed or dimension.usual[1])
