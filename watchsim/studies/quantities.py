"""Which numbers of a scene can be varied by a little, and by how little?"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from watchsim.construction import known
from watchsim.construction.dimension import Dimension as DesignDimension
from watchsim.scene.body import Body
from watchsim.scene.oscillation import nominal_frequency
from watchsim.scene.scene import Scene
from watchsim.studies.axes import DESIGN, dimension_of
from watchsim.units import ANGLE, LENGTH, NUMBER, Dimension, UnitError, known_unit, parse

SECTIONS = ("scene", "bodies", "springs", "torques", "damping", "contacts", DESIGN)
# What is no dimension of the mechanism: how a drawing is read, how a body starts, vertices, what must stay a whole number.
LEFT_OUT = {"schema", "snap", "material", "axis", "polygon", "line", "count", "turns", "velocity", "spin", "table", "pivot"}
OF_DESIGN = {"embraced", "start"}  # a whole number and a half; where the balance is let go
RELATIVE = 1e-3  # of a value: the larger of the two steps
SHORT, SLIGHT, SMALL = 5e-7, 2e-4, 1e-4  # steps of lengths (m), angles (rad) and of numbers that are zero
PERCENT, USUAL_LENGTH, USUAL_ANGLE = 0.01, 1e-5, 0.1  # what is compared: 1 %, 10 µm, 0.1°
BOUNDED = {"friction": (0.0, None), "restitution": (0.0, 1.0), "tangential_restitution": (0.0, 1.0), "coulomb": (0.0, None)}


@dataclass(frozen=True)
class Quantity:
    """One number of a scene: its dotted path, its SI value, and what it is.

    `step` is the larger of the two by which it is varied; `low` and `high` bound it; `change` is what a maker may get wrong:
    1 % more, 10 µm or 0.1°, in SI, worded by `change_words`.
    """

    key: str
    value: float
    dimension: Dimension
    step: float
    change: float
    change_words: str
    low: float | None = None
    high: float | None = None


def fixed_nominal(scene: Scene) -> Scene:
    """The same scene with springs by their stiffness, damping by its coefficient, and the rate against a frequency that stays.

    With a frequency instead, a heavier balance would be given a stiffer spring, and nothing would go wrong.
    """
    nominal = nominal_frequency(scene)
    if nominal is not None:
        scene = scene.set("timegrapher.frequency", nominal)
    for i, (spring, entry) in enumerate(zip(scene.springs, scene.source.get("springs", []), strict=True)):
        if "frequency" in entry:
            scene = scene.set(f"springs.{i}.stiffness", spring.stiffness)
    for i, (damping, entry) in enumerate(zip(scene.damping, scene.source.get("damping", []), strict=True)):
        if "q_factor" in entry:
            scene = scene.set(f"damping.{i}.viscous", damping.viscous)
    return scene


def quantities(scene: Scene) -> tuple[Quantity, ...]:
    """All that can be varied, in the order of the file."""
    found = []
    for section in SECTIONS:
        for key, value in _leaves(scene.source.get(section, {}), section):
            quantity = quantity_at(scene, key, value)
            if quantity is not None:
                found.append(quantity)
    return tuple(found)


def quantity_at(scene: Scene, key: str, value: Any) -> Quantity | None:
    """The quantity at a path that holds that value; None where it is none, or no dimension of the mechanism."""
    path, dimension = key.split("."), dimension_of(scene, key)
    if dimension is None or LEFT_OUT & set(path) or _is_start(scene, path) or (path[0] == "springs" and "draw" in path):
        return None
    if path[0] == DESIGN and (path[-1] in OF_DESIGN or _of_design(scene, path[-1]).count):
        return None
    try:
        number = parse(value, dimension)
    except UnitError:
        return None
    change, words = _change(number, dimension)
    return Quantity(key, number, dimension, _step(number, dimension), change, words, *_bounds(scene, path))


def _bounds(scene: Scene, path: list[str]) -> tuple[float | None, float | None]:
    if path[0] != DESIGN:
        return BOUNDED.get(path[-1], (None, None))
    one = _of_design(scene, path[-1])
    factor = known_unit(one.unit).factor
    return factor * one.low, factor * one.high


def _of_design(scene: Scene, name: str) -> DesignDimension:
    return known.design(scene.source[DESIGN]["of"]).dimension(name)


def _leaves(value: Any, path: str) -> Iterator[tuple[str, Any]]:
    """Dotted paths of everything that is no table and no list."""
    if isinstance(value, dict):
        for key, item in value.items():
            yield from _leaves(item, f"{path}.{key}")
    elif isinstance(value, (list, tuple)):
        for i, item in enumerate(value):
            yield from _leaves(item, f"{path}.{i}")
    elif isinstance(value, (int, float, str)) and not isinstance(value, bool):
        yield path, value


def _is_start(scene: Scene, path: list[str]) -> bool:
    """Where a moving body starts decides nothing about a cycle."""
    if path[0] != "bodies":
        return False
    body: Body = scene.body(path[1])
    return (path[2] == "angle" and body.motion != "fixed") or (path[2] == "position" and body.motion == "free")


def _step(value: float, dimension: Dimension) -> float:
    if dimension is LENGTH:
        return SHORT
    if dimension is ANGLE:
        return SLIGHT
    return RELATIVE * abs(value) if value else SMALL


def _change(value: float, dimension: Dimension) -> tuple[float, str]:
    if dimension is LENGTH:
        return USUAL_LENGTH, "10 µm"
    if dimension is ANGLE:
        return parse(f"{USUAL_ANGLE}°", ANGLE), "0.1°"
    if value:
        return PERCENT * value, "1 %"
    return (PERCENT, "0.01") if dimension is NUMBER else (1.0, f"1 {dimension.si}")
