"""Which mechanisms can be drawn from dimensions, and what is one drawn to mine?

    import watchsim as ws
    mine = ws.designs.swiss_lever(lock="2°", teeth=20)
    mine.write("my_lever")          # drawings (DXF) and scene.toml; scene.toml with [design] alone: drawings=False
    run = ws.simulate(mine.scene())

`ws.designs.names()` lists them; `help(ws.designs.swiss_lever)` lists the dimensions of one. In: dimensions. Out: drawings and a
scene. Imports `construction`, `scene` and below.
"""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from watchsim.construction import registry
from watchsim.construction import scene_builder as toml
from watchsim.construction.design import Design, Dimension
from watchsim.drawing.write import Sheet
from watchsim.scene.designed import chosen, designed
from watchsim.scene.load import from_mapping
from watchsim.scene.read_tolerances import usual
from watchsim.scene.scene import Scene
from watchsim.storage.write import write_folder

SCENE = "scene.toml"


@dataclass(frozen=True)
class Drawn:
    """A design with its values (one field per dimension, in the dimension's unit)."""

    design: Design
    values: Any

    @cached_property
    def sheets(self) -> dict[str, Sheet]:
        """The outlines of each drawing by its file name without ending, millimetres."""
        return dict(self.design.draw(self.values))

    @property
    def dimensions(self) -> dict[str, str]:
        """Every dimension with its unit, as in the [design] table of a scene."""
        return {one.name: one.shown(getattr(self.values, one.name)) for one in self.design.dimensions}

    def files(self, drawings: bool = True) -> dict[str, bytes]:
        """Name -> content of everything that `write` writes."""
        known = self.design.name in registry.names()  # a design that is still being written has no scene of its name
        tolerances = usual(self.scene()) if known else ""
        sheets = self.sheets if drawings else {}
        text = self.design.scene(self.values) if drawings else self._dimensioned()
        return {**{f"{name}.dxf": sheet.dxf() for name, sheet in sheets.items()}, SCENE: (text + tolerances).encode()}

    def _dimensioned(self) -> str:
        """The text of a scene that holds the dimensions, each with its meaning, in place of drawings."""
        head = f"# {self.design.title}, drawn to the dimensions below whenever the scene is read.\n"
        entries: Any = {one.name: self._noted(one) for one in self.design.dimensions}
        return f"{head}\n{toml.table('[design]', of=self.design.name, **entries)}"

    def _noted(self, one: Dimension) -> toml.Noted:
        written = self.written(one)
        gap = max(2, 16 - len(str(written)) - 2 * isinstance(written, str))
        return toml.Noted(written, f"{one.meaning} (default {one.shortly(one.default)})", gap)

    def written(self, one: Dimension) -> str | float:
        """The value of a dimension as a scene file holds it: text with its unit, or a plain number."""
        value: float = getattr(self.values, one.name)
        return one.shown(value) if one.unit else value

    def scene(self) -> Scene:
        """The scene, ready to be simulated; its dimensions can be changed: scene.set("design.lock", "2°")."""
        return from_mapping({"design": {"of": self.design.name, **self.dimensions}}, None)

    def write(self, folder: str | Path, force: bool = False, drawings: bool = True) -> Path:
        """Drawings and scene.toml in `folder`, whole or not at all, without `drawings` a scene.toml that holds the dimensions
        under [design]. FileExistsError where something is there already; `force` replaces files of the same names and keeps
        the others."""
        target = Path(folder)
        if target.is_file():
            raise FileExistsError(f"{target} is a file; drawings and scene need a folder of their own")
        if not force and target.is_dir() and next(target.iterdir(), None) is not None:
            raise FileExistsError(
                f"{target} already exists and was not changed. Choose another folder, or replace with --force"
            )
        files = self.files(drawings)

        def fill(place: Path) -> None:
            for name, data in files.items():
                (place / name).write_bytes(data)

        write_folder(target, fill, files.__contains__, "the design")
        return target


class Maker:
    """A design waiting for dimensions: called with them it draws. `maker.dimensions` lists them."""

    def __init__(self, design: Design) -> None:
        self.design = design
        self.dimensions = design.dimensions
        self.__name__ = design.name
        self.__doc__ = _doc(design)
        self.__signature__ = inspect.Signature(
            [
                inspect.Parameter(one.name, inspect.Parameter.KEYWORD_ONLY, default=one.shown(one.default))
                for one in design.dimensions
            ]
        )

    def __call__(self, **dimensions: object) -> Drawn:
        """The design drawn with these dimensions: texts with a unit ("2°"), plain numbers where none is needed.

        SceneError lists all that is unknown, out of range or in conflict.
        """
        return Drawn(self.design, chosen(self.design, dimensions))

    def __repr__(self) -> str:
        return f"<design {self.design.name}: {self.design.title}, {len(self.dimensions)} dimensions>"


def _doc(design: Design) -> str:
    rows = []
    for one in design.dimensions:
        default, low, high = map(one.shortly, (one.default, one.low, one.high))
        rows.append(f"{one.name} = {default}  ({low} to {high}): {one.meaning}. {one.source}")
    return "\n".join([f"{design.title}. Dimensions, each optional:", "", *rows])


def names() -> tuple[str, ...]:
    """The names of all designs."""
    return registry.names()


def __getattr__(name: str) -> Maker:
    if name not in registry.names():
        raise AttributeError(f"there is no design {name!r}; known are {', '.join(registry.names())}")
    return Maker(designed(name))


def __dir__() -> list[str]:
    return sorted(["names", *registry.names()])
