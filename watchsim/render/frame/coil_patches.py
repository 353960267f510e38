"""How is a hairspring drawn: the strip, its collet and its stud?"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.transforms import IdentityTransform
from numpy.typing import NDArray

from watchsim.render.frame.coils import Hairspring
from watchsim.render.palette import BLUED, FIXED, mixed
from watchsim.render.style import PALE, Style

Array = NDArray[np.float64]

THINNEST = 1.1  # pixels at 1280 × 720: a strip seen from far is narrower than a line can be


def coil_patches(
    springs: Sequence[Hairspring], frames: dict[str, Array], matrix: Array, style: Style, unit: float
) -> Iterator[PathPatch]:
    """Patches in pixels for the poses x, y, angle of one instant; `matrix` maps metres to pixels."""
    scale = float(np.hypot(*matrix[:2, 0]))
    for spring in springs:
        line, stud = (_seen(points, matrix) for points in (spring.line(frames), spring.stud(frames)))
        x, y, _ = frames[spring.body]
        width = max(scale * spring.coil.width, THINNEST * unit, 0.7)
        collet = Path.circle(tuple(_seen(np.array([[x, y]]), matrix)[0]), scale * spring.coil.inner)
        colour = mixed(BLUED.line if style.name == "light" else BLUED.fill, style.background, PALE)
        look = {"fill": False, "edgecolor": colour, "capstyle": "round", "joinstyle": "round"}
        yield PathPatch(Path(line), linewidth=width, transform=IdentityTransform(), **look)
        yield PathPatch(collet, linewidth=2.0 * width, transform=IdentityTransform(), **look)
        yield PathPatch(Path(stud), facecolor=FIXED.fill, edgecolor=FIXED.edge, linewidth=0.5, transform=IdentityTransform())


def _seen(points: Array, matrix: Array) -> Array:
    return points @ matrix[:2, :2].T + matrix[:2, 2]
