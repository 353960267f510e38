"""How is a hairspring drawn: the strip, its collet and its stud?"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from matplotlib.path import Path
from matplotlib.transforms import IdentityTransform
from numpy.typing import NDArray

from watchsim.render.frame.coils import Hairspring, hairsprings
from watchsim.render.frame.lasting_patch import LastingPatch
from watchsim.render.frame.view import Frame
from watchsim.render.palette import BLUED, FIXED, mixed
from watchsim.render.picture_style import PALE, Style
from watchsim.scene.scene import Scene

Array = NDArray[np.float64]

THINNEST = 1.1  # pixels at 1280 × 720: a strip seen from far is narrower than a line can be
DEVIATION = 0.25  # pixels that a chord may stray from the coil


class CoilPatches:
    """The hairsprings of a scene in a picture with room `room` (pixels) and so many pixels to the metre; `own` makes a patch
    one of the picture's, `unit` is the size of everything drawn."""

    def __init__(
        self, scene: Scene, room: Frame, scale: float, style: Style, unit: float, own: Callable[[LastingPatch], LastingPatch]
    ) -> None:
        self._room, self._scale = room, scale
        colour = mixed(style.curve(BLUED), style.background, PALE)
        thin = {"fill": False, "edgecolor": colour, "capstyle": "round", "joinstyle": "bevel", "transform": IdentityTransform()}
        held = {"facecolor": FIXED.fill, "edgecolor": FIXED.edge, "linewidth": 0.5, "transform": IdentityTransform()}
        blank = Path(np.zeros((1, 2)))
        self._drawn: list[tuple[Hairspring, int, tuple[LastingPatch, LastingPatch, LastingPatch]]] = []
        for spring in hairsprings(scene):
            width = max(scale * spring.coil.width, THINNEST * unit, 0.7)
            looks = ({**thin, "linewidth": width}, {**thin, "linewidth": 2.0 * width}, held)
            strip, collet, stud = (own(LastingPatch(blank, **look)) for look in looks)
            self._drawn.append((spring, spring.coil.chords(DEVIATION / scale), (strip, collet, stud)))

    def __bool__(self) -> bool:
        return bool(self._drawn)

    def patches(self, frames: dict[str, Array], matrix: Array) -> Iterator[LastingPatch]:
        """To be drawn for the poses x, y, angle of one instant; `matrix` maps metres to pixels. The next call moves them."""
        for spring, chords, (strip, collet, stud) in self._drawn:
            x, y = _seen(frames[spring.body][None, :2], matrix)[0].tolist()
            if not self._in_sight(x, y, 1.1 * self._scale * spring.coil.outer):
                continue
            strip.set_path(Path(_seen(spring.line(frames, chords), matrix)))
            collet.set_path(Path.circle((x, y), self._scale * spring.coil.inner))
            stud.set_path(Path(_seen(spring.stud(frames), matrix)))
            yield from (strip, collet, stud)

    def _in_sight(self, x: float, y: float, reach: float) -> bool:
        room = self._room
        return (
            room.left - reach < x < room.left + room.width + reach
            and room.bottom - reach < y < room.bottom + room.height + reach
        )


def _seen(points: Array, matrix: Array) -> Array:
    return points @ matrix[:2, :2].T + matrix[:2, 2]
