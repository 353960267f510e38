"""How is the stop of a spring drawn: a pin of the colour of what never moves, over everything?"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from matplotlib.path import Path
from matplotlib.transforms import Affine2D
from numpy.typing import NDArray

from watchsim.render.frame.lasting_patch import LastingPatch
from watchsim.render.frame.pose_matrix import pose_matrix
from watchsim.render.frame.spring_stops import StopPin, stop_pins
from watchsim.render.palette import FIXED
from watchsim.render.picture_style import Style
from watchsim.scene.scene import Scene

Array = NDArray[np.float64]


class SpringStopPatches:
    """The pins of a scene; `own` makes a patch one of the picture's, `unit` is the size of everything drawn."""

    def __init__(self, scene: Scene, style: Style, unit: float, own: Callable[[LastingPatch], LastingPatch]) -> None:
        look = style.worn(FIXED)
        self._drawn: list[tuple[StopPin, Affine2D, LastingPatch]] = []
        for pin in stop_pins(scene):
            place, width = Affine2D(), max(1.1 * unit, 0.6)
            circle = Path.circle(pin.place, pin.radius)
            made = LastingPatch(circle, facecolor=look.fill, edgecolor=look.edge, linewidth=width, transform=place)
            self._drawn.append((pin, place, own(made)))

    def patches(self, frames: dict[str, Array], matrix: Array) -> Iterator[LastingPatch]:
        """To be drawn for the poses x, y, angle of one instant; `matrix` maps metres to pixels. The next call moves them."""
        for pin, place, patch in self._drawn:
            place.set_matrix(matrix if pin.on is None else matrix @ pose_matrix(frames[pin.on]))
            yield patch
