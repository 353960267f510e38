"""How do the bodies of a scene look in a position that somebody has put them in?"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.compile import Compiled
from watchsim.render.frame.filled_parts import Part, working
from watchsim.render.picture_style import LIGHT
from watchsim.scene.scene import Scene
from watchsim.simulation.record.body_frames import frames

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.path import Path

Array = NDArray[np.float64]

FINENESS = 2e-5  # of the scene's size: chords of arcs, in close-ups too
EDGE = 0.4  # pt


class Posed:
    """The parts of a scene that work, drawn in millimetres wherever coordinates put them."""

    def __init__(self, scene: Scene, compiled: Compiled) -> None:
        self.scene, self.compiled = scene, compiled
        self.parts = working(scene, FINENESS * compiled.size, 0.1 * compiled.size)

    def draw(self, axes: Axes, q: Array, bodies: Iterable[str] | None = None) -> None:
        """All bodies, or some, filled; q are absolute coordinates (n,)."""
        for part, path in self._placed(q, bodies):
            from matplotlib.patches import PathPatch

            look = LIGHT.worn(part.finish)
            axes.add_artist(  # the limits are set by who draws; working them out from all curves takes longer than drawing
                PathPatch(path, fill=not part.ground, facecolor=look.fill, edgecolor=look.edge, linewidth=EDGE, zorder=2)
            )

    def outline(self, axes: Axes, q: Array, bodies: Iterable[str], colour: str) -> None:
        """Where some bodies stood or will stand, as thin dashes."""
        from matplotlib.patches import PathPatch

        for _, path in self._placed(q, bodies):
            axes.add_patch(PathPatch(path, fill=False, edgecolor=colour, linewidth=0.5, linestyle=(0, (4, 2)), zorder=3))

    def _placed(self, q: Array, bodies: Iterable[str] | None) -> Iterable[tuple[Part, Path]]:
        from matplotlib.transforms import Affine2D

        wanted = None if bodies is None else set(bodies)
        places = frames(self.scene, self.compiled.slices, self.compiled.relative(q[None]))
        for part in self.parts:
            if wanted is not None and part.body not in wanted:
                continue
            x, y, angle = places[part.body][0].tolist()
            yield part, Affine2D().rotate(angle).translate(x, y).scale(1e3).transform_path(part.faces)
