"""How does Python choose the dimensions of a design?"""

from __future__ import annotations

import inspect

from watchsim.construction.design import Design
from watchsim.designs.drawn import Drawn
from watchsim.scene.file.design_dimensions import chosen


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
