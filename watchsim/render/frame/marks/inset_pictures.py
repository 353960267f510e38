"""How are insets drawn over a picture?

Every inset has shapes of its own, fine enough for its scale; those out of its sight at an instant are passed over.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from matplotlib.backend_bases import RendererBase
from matplotlib.figure import Figure
from matplotlib.path import Path
from matplotlib.transforms import Affine2D, Bbox, IdentityTransform
from numpy.typing import NDArray

from watchsim.render.frame.coil_patches import CoilPatches
from watchsim.render.frame.filled_parts import Part, parts
from watchsim.render.frame.lasting_patch import LastingPatch
from watchsim.render.frame.marks.changing_words import Words
from watchsim.render.frame.marks.insets import Inset
from watchsim.render.frame.pose_matrix import pose_matrix
from watchsim.render.frame.view import Frame
from watchsim.render.picture_style import Style
from watchsim.scene.scene import Scene

Array = NDArray[np.float64]
Pixels = NDArray[np.uint8]
Marks = Callable[[Array], list[LastingPatch]]  # what is drawn at contacts, for a map from metres to pixels

CHORD = 0.05  # pixels that a chord may stray from its arc
HATCH = 13.0  # pixels between hatch strokes


@dataclass(frozen=True)
class _Shape:
    body: str
    patches: tuple[LastingPatch, ...]
    middle: Array  # m, in the body's frame
    reach: float


class InsetPicture:
    """One inset of a figure; `unit` is the size of everything drawn, `words` write its name."""

    def __init__(self, figure: Figure, scene: Scene, inset: Inset, unit: float, words: Words, style: Style) -> None:
        self._figure, self._inset, self._words, self._style = figure, inset, words, style
        self._springs = CoilPatches(scene, inset.box, inset.view.scale, style, unit, self._own)
        self._thin = max(1.1 * unit, 0.6)
        self._transforms = {body.name: Affine2D() for body in scene.bodies}
        made = parts(scene, CHORD / inset.view.scale, HATCH * unit / inset.view.scale)
        self._shapes = [self._shape(part) for part in made]
        box = inset.box
        edge = Path([(box.left, box.bottom), (box.left + box.width, box.bottom + box.height)])
        frame = _rectangle(edge)
        self._sheet = self._own(
            LastingPatch(frame, facecolor=style.background, linewidth=0.0, transform=IdentityTransform()), False
        )
        look = {"fill": False, "edgecolor": style.faint, "linewidth": max(1.4 * unit, 1.0)}
        self._border = self._own(LastingPatch(frame, transform=IdentityTransform(), **look), False)

    def place_in(self, matrix: Array, centre: tuple[float, float], room: Frame) -> LastingPatch:
        """The rectangle of the picture (its map `matrix`) that the inset enlarges."""
        half = 0.5 * np.array([self._inset.box.width, self._inset.box.height]) / self._inset.view.scale
        scale = float(np.hypot(*matrix[:2, 0]))
        middle = matrix[:2, :2] @ np.array(centre) + matrix[:2, 2]
        corners = _rectangle(Path(np.array([middle - scale * half, middle + scale * half])))
        look = {"fill": False, "edgecolor": self._style.ink, "linewidth": 0.8 * self._thin, "alpha": 0.55}
        patch = LastingPatch(corners, transform=IdentityTransform(), **look)
        patch.set_figure(self._figure)
        patch.set_clip_box(Bbox.from_bounds(room.left, room.bottom, room.width, room.height))
        return patch

    def draw(self, renderer: RendererBase, frames: dict[str, Array], marks: Marks, out_pixels: Pixels) -> None:
        """Draw the inset for the poses x, y, angle of one instant."""
        matrix = self._inset.matrix(frames)
        self._sheet.draw(renderer)
        for body, transform in self._transforms.items():
            transform.set_matrix(matrix @ pose_matrix(frames[body]))
        for patch in self._springs.patches(frames, matrix):
            patch.draw(renderer)
        for shape in self._seen():
            for patch in shape.patches:
                patch.draw(renderer)
        for patch in marks(matrix):
            self._own(patch).draw(renderer)
        self._border.draw(renderer)
        box, size = self._inset.box, self._words.size
        self._words.write(self._inset.name, box.left + 0.5 * size, box.bottom + 0.55 * size, out_pixels)

    def _seen(self) -> Iterator[_Shape]:
        box = self._inset.box
        for shape in self._shapes:
            x, y = self._transforms[shape.body].transform(shape.middle)
            reach = shape.reach * self._inset.view.scale
            beside = abs(x - box.left - 0.5 * box.width) - 0.5 * box.width
            above = abs(y - box.bottom - 0.5 * box.height) - 0.5 * box.height
            if max(beside, above) <= reach:
                yield shape

    def _shape(self, part: Part) -> _Shape:
        points = np.asarray(part.faces.vertices)
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        look = self._style.worn(part.finish)
        edge = {
            "edgecolor": self._style.line(look) if part.ground else look.edge,
            "joinstyle": "round",
            "transform": self._transforms[part.body],
        }
        if part.ground:
            paths = [part.faces] if part.strokes is None else [part.strokes, part.faces]
            made = [LastingPatch(path, fill=False, linewidth=self._thin, **edge) for path in paths]
        else:
            made = [LastingPatch(part.faces, facecolor=look.fill, linewidth=self._thin, **edge)]
        return _Shape(part.body, tuple(map(self._own, made)), middle, float(np.hypot(*(points - middle).T).max()))

    def _own(self, patch: LastingPatch, clipped: bool = True) -> LastingPatch:
        patch.set_figure(self._figure)
        box = self._inset.box
        if clipped:
            patch.set_clip_box(Bbox.from_bounds(box.left, box.bottom, box.width, box.height))
        return patch


def _rectangle(diagonal: Path) -> Path:
    (x0, y0), (x1, y1) = np.asarray(diagonal.vertices)
    codes = [Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY]
    return Path([(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], codes)
