"""How is a spring between two points drawn: its wire, over everything, and the pins that it is hooked to?"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from matplotlib.path import Path
from matplotlib.transforms import IdentityTransform
from numpy.typing import NDArray

from watchsim.render.frame.lasting_patch import LastingPatch
from watchsim.render.frame.line_spring_shapes import Zigzag, zigzags
from watchsim.render.palette import BLUED
from watchsim.render.picture_style import Style
from watchsim.scene.scene import Scene

Array = NDArray[np.float64]

WIRE, HALO = 1.8, 3.8  # pixels at 1280 × 720: the wire, and the pale rim that parts it from what lies below
PIN = 3.0


class LineSpringPatches:
    """The springs between points of a scene; `own` makes a patch one of the picture's, `unit` is the size of everything
    drawn."""

    def __init__(self, scene: Scene, style: Style, unit: float, own: Callable[[LastingPatch], LastingPatch]) -> None:
        self._pin = PIN * max(unit, 0.5)
        place = IdentityTransform()
        line = {"fill": False, "capstyle": "round", "joinstyle": "round", "transform": place}
        wire = {"edgecolor": style.curve(BLUED), "linewidth": max(WIRE * unit, 0.8), **line}
        halo = {"edgecolor": style.background, "linewidth": max(HALO * unit, 1.8), **line}
        pin = {"facecolor": style.curve(BLUED), "edgecolor": style.background, "linewidth": 0.8, "transform": place}
        blank = Path(np.zeros((1, 2)))
        self._drawn: list[tuple[Zigzag, list[LastingPatch]]] = [
            (spring, [own(LastingPatch(blank, **look)) for look in (halo, wire, pin, pin)]) for spring in zigzags(scene)
        ]

    def patches(self, frames: dict[str, Array], matrix: Array) -> Iterator[LastingPatch]:
        """To be drawn for the poses x, y, angle of one instant; `matrix` maps metres to pixels. The next call moves them."""
        for spring, (halo, wire, *pins) in self._drawn:
            line = spring.line(frames) @ matrix[:2, :2].T + matrix[:2, 2]
            halo.set_path(Path(line))
            wire.set_path(Path(line))
            for pin, place in zip(pins, (line[0], line[-1]), strict=True):
                pin.set_path(Path.circle(tuple(place.tolist()), self._pin))
            yield from (halo, wire, *pins)
