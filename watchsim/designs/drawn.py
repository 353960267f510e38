"""What can be done with a design once its dimensions are chosen?"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from watchsim.construction.design import Design
from watchsim.drawing.sheet import Sheet
from watchsim.scene.file.read_scene import from_mapping
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

    def files(self) -> dict[str, bytes]:
        """Name -> content of everything that `write` writes."""
        drawings = {f"{name}.dxf": sheet.dxf() for name, sheet in self.sheets.items()}
        return {**drawings, SCENE: self.design.scene(self.values).encode()}

    def scene(self) -> Scene:
        """The scene, ready to be simulated; its dimensions can be changed: scene.set("design.lock", "2°")."""
        return from_mapping({"design": {"of": self.design.name, **self.dimensions}}, None)

    def write(self, folder: str | Path, force: bool = False) -> Path:
        """Drawings and scene.toml in `folder`, whole or not at all. FileExistsError where something is there already;
        `force` replaces files of the same names and keeps the others."""
        target = Path(folder)
        if target.is_file():
            raise FileExistsError(f"{target} is a file; drawings and scene need a folder of their own")
        if not force and target.is_dir() and next(target.iterdir(), None) is not None:
            raise FileExistsError(f"{target} exists already and is left alone. Choose another folder, or replace with --force")
        files = self.files()

        def fill(place: Path) -> None:
            for name, data in files.items():
                (place / name).write_bytes(data)

        write_folder(target, fill, files.__contains__, "the design")
        return target
