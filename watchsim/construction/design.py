"""What is a design: dimensions, and how drawings and a scene follow from them?

A design is a module of this package, or one that an entry point of the group "watchsim.designs" names, which defines DESIGN:

    @dataclass(frozen=True)
    class Pendulum:                                    # its values: one field per dimension, in the dimension's own unit
        length: float = dim(200.0, "mm", 10.0, 2000.0, "from the pivot to the middle of the bob", CHOSEN)

    def draw(values: Pendulum) -> dict[str, Sheet]: ...     # file name without ending -> outlines, millimetres
    def scene(values: Pendulum) -> str: ...                 # by scene_builder; `drawing = "bob.dxf"` names a sheet
    def conflicts(values: Pendulum) -> Iterator[Conflict]: ...  # what cannot be drawn or cannot work, and why

    DESIGN = Design("pendulum", "Simple pendulum", Pendulum, draw, scene, conflicts)

Limits of single dimensions are checked before `conflicts` is called, and nothing is drawn where either objects. Everything is a
function of the values alone, so that equal values give equal bytes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, fields
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

from watchsim.drawing.drawing import SNAP, Drawing
from watchsim.drawing.read import read_sheet
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop

_KEY = "dimension"
CHOSEN, ESTIMATE = "chosen for this design", "estimate: not published"  # sources of many dimensions


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
    metadata = {"meaning": meaning, "unit": unit, "default": default, "low": low, "high": high, "source": source}
    return field(default=default, metadata={_KEY: {**metadata, "count": isinstance(default, int)}})


def dimensions_of(values: type[Any]) -> tuple[Dimension, ...]:
    """The dimensions that a dataclass of values declares with `dim`, in its order."""
    return tuple(Dimension(one.name, **one.metadata[_KEY]) for one in fields(values) if _KEY in one.metadata)


def sheets_of(**parts: Iterable[Loop]) -> dict[str, Sheet]:
    """Outlines by the file name of their part, as sheets."""
    return {name: Sheet(tuple(loops)) for name, loops in parts.items()}


@lru_cache(maxsize=256)
def drawing_of(sheet: Sheet, name: str, snap: float = SNAP) -> Drawing:
    """The drawing of a sheet, as its DXF file would be read: what is simulated is what a file of it holds, to the last bit.

    Made once per sheet: of a design of which one dimension changes, most sheets stay as they are.
    """
    return read_sheet(sheet, Path(name), snap)


def unsound(sheet: Sheet, name: str) -> Iterator[str]:
    """What is wrong with the outlines, a sentence for each layer."""
    wrong = [finding for finding in drawing_of(sheet, name, SNAP).findings if finding.severity == "error"]
    for layer in dict.fromkeys(finding.layer for finding in wrong):
        first = next(finding for finding in wrong if finding.layer == layer)
        at = "" if first.x_mm is None else f" at ({first.x_mm:.3f}, {first.y_mm:.3f}) mm"
        what = "cross itself" if first.code == "crossing" else "not be sound"
        yield f"the outline of {name}, layer {layer}, would {what}{at}"


Values = Any  # a frozen dataclass whose fields are declared with `dim`


@dataclass(frozen=True, slots=True)
class Conflict:
    """Why values cannot be drawn or cannot work; `dimension` is the one to change first ("" if none stands out)."""

    dimension: str
    message: str


class Impossible(ValueError):
    """A construction that has no solution; `dimension` is the one to change first ("" if none stands out)."""

    def __init__(self, dimension: str, message: str) -> None:
        self.dimension = dimension
        super().__init__(message)


def no_conflicts(_values: Values) -> tuple[Conflict, ...]:
    """Of a design whose limits say it all."""
    return ()


@lru_cache(maxsize=4)
def _sheets(design: Design, values: Values) -> dict[str, Sheet]:
    return {f"{design.name}/{file}.dxf": sheet for file, sheet in design.draw(values).items()}


@dataclass(frozen=True)
class Design:
    """A mechanism with dimensions. `draw` gives the sheets by file name (without ".dxf"), `scene` the text of scene.toml."""

    name: str
    title: str
    values: type[Any]
    draw: Callable[[Any], Mapping[str, Sheet]]
    scene: Callable[[Any], str]
    conflicts: Callable[[Any], Iterable[Conflict]] = no_conflicts

    @cached_property
    def dimensions(self) -> tuple[Dimension, ...]:
        return dimensions_of(self.values)

    def dimension(self, name: str) -> Dimension:
        """The dimension of that name; KeyError if there is none."""
        return next(one for one in self.dimensions if one.name == name)

    def refusals(self, chosen: Mapping[str, float]) -> tuple[Conflict, ...]:
        """All that is wrong with these numbers (in the dimensions' own units; the others at their defaults).

        KeyError for a name that is no dimension.
        """
        out = [conflict for name, number in chosen.items() for conflict in _beyond(self._known(name), number)]
        if out:
            return tuple(out)
        found: list[Conflict] = []
        try:
            values = self.chosen(chosen)
            found += self.conflicts(values)
            if not found:
                sheets = self.sheets(values)
                found += [Conflict("", words) for name, sheet in sheets.items() for words in unsound(sheet, name)]
        except Impossible as error:
            found.append(Conflict(error.dimension, str(error)))
        except ValueError as error:  # the square root of a negative number, a fillet that does not fit
            found.append(Conflict("", f"these dimensions cannot be drawn together: {error}"))
        return tuple(found)

    def sheets(self, values: Values) -> dict[str, Sheet]:
        """The sheets by the names that drawings have in a scene made from the design, such as "swiss_lever/lever.dxf"."""
        return _sheets(self, values)

    def chosen(self, chosen: Mapping[str, float]) -> Values:
        """The values with these numbers in place of the defaults."""
        return self.values(**{name: round(x) if self._known(name).count else float(x) for name, x in chosen.items()})

    def _known(self, name: str) -> Dimension:
        return self._by_name[name]

    @cached_property
    def _by_name(self) -> dict[str, Dimension]:
        return {one.name: one for one in self.dimensions}


def _beyond(dimension: Dimension, number: float) -> list[Conflict]:
    low, high = dimension.shortly(dimension.low), dimension.shortly(dimension.high)
    if dimension.count and number != round(number):
        return [Conflict(dimension.name, f"must be a whole number from {low} to {high}: {dimension.meaning}")]
    if dimension.low <= number <= dimension.high:
        return []
    return [Conflict(dimension.name, f"must be from {low} to {high}: {dimension.meaning}")]
