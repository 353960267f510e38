"""What can be done with a design once its dimensions are chosen?"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

from watchsim.construction.design import Design
from watchsim.drawing.sheet import Sheet
from watchsim.mechanism.load import from_mapping
from watchsim.mechanism.scene import Scene
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

    def files(self) -> dict[str, bytes]:
        """Name -> content of everything that `write` writes."""
        drawings = {f"{name}.dxf": sheet.dxf() for name, sheet in self.sheets.items()}
        return {**drawings, SCENE: self.design.scene(self.values).encode()}

    def scene(self) -> Scene:
        """The scene, ready to be simulated; its dimensions can be changed: scene.set("design.lock", "2°")."""
        numbers = {one.name: one.shown(getattr(self.values, one.name)) for one in self.design.dimensions}
        return from_mapping({"design": {"of": self.design.name, **numbers}}, None)

    def write(self, folder: str | Path) -> Path:
        """Drawings and scene.toml in `folder`, whole or not at all; FileExistsError where it is there already."""
        target = Path(folder)
        if target.exists():
            raise FileExistsError(f"{target} is there already. Name a new folder")
        files = self.files()

        def fill(place: Path) -> None:
            for name, data in files.items():
                (place / name).write_bytes(data)

        write_folder(target, fill, lambda name: name in files, "the design")
        return target
