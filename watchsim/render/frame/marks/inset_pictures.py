"""How are insets drawn over a picture?

Every inset has shapes of its own, fine enough for its scale; those out of its sight at an instant are passed over.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from matplotlib.backend_bases import RendererBase
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
from watchsim.render.style import Style
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
    """One inset beside a mechanism in `room`; `unit` is the size of everything drawn, `words` write its name."""

    def __init__(self, scene: Scene, inset: Inset, room: Frame, unit: float, words: Words, style: Style) -> None:
        self._inset, self._words, self._style = inset, words, style
        self._springs = CoilPatches(scene, inset.box, inset.view.scale, style, unit, self._own)
        self._thin = max(1.1 * unit, 0.6)
        self._transforms = {body.name: Affine2D() for body in scene.bodies}
        made = parts(scene, CHORD / inset.view.scale, HATCH * unit / inset.view.scale)
        self._shapes = [self._shape(part) for part in made]
        box, still = inset.box, IdentityTransform()
        frame = _rectangle(np.array([box.left, box.bottom]), np.array([box.left + box.width, box.bottom + box.height]))
        self._sheet = LastingPatch(frame, facecolor=style.background, linewidth=0.0, transform=still)
        look = {"fill": False, "edgecolor": style.faint, "linewidth": max(1.4 * unit, 1.0)}
        self._border = LastingPatch(frame, transform=still, **look)
        look = {"fill": False, "edgecolor": style.ink, "linewidth": 0.8 * self._thin, "alpha": 0.55}
        self._place = LastingPatch(frame, transform=still, **look)
        self._place.set_clip_box(Bbox.from_bounds(room.left, room.bottom, room.width, room.height))
        self._kept: Pixels = np.zeros((0, 0, 4), dtype=np.uint8)
        self._kept_places: list[tuple[int, bytes]] = []

    def place_in(self, matrix: Array, centre: tuple[float, float]) -> LastingPatch:
        """The rectangle of the picture (its map `matrix`) that the inset enlarges. The next call moves it."""
        half = 0.5 * np.array([self._inset.box.width, self._inset.box.height]) / self._inset.view.scale
        scale = float(np.hypot(*matrix[:2, 0]))
        middle = matrix[:2, :2] @ np.array(centre) + matrix[:2, 2]
        self._place.set_path(_rectangle(middle - scale * half, middle + scale * half))
        return self._place

    def draw(self, renderer: RendererBase, frames: dict[str, Array], marks: Marks, out_pixels: Pixels) -> None:
        """Draw the inset for the poses x, y, angle of one instant; while nothing in it moves it is copied."""
        matrix = self._inset.matrix(frames)
        for body, transform in self._transforms.items():
            transform.set_matrix(matrix @ pose_matrix(frames[body]))
        seen = list(self._seen())
        behind, over = list(self._springs.patches(frames, matrix)), [self._own(patch) for patch in marks(matrix)]
        places = [] if behind or over else [(id(shape), self._transforms[shape.body].get_matrix().tobytes()) for shape in seen]
        area = self._area(out_pixels)
        if places and places == self._kept_places:
            area[:] = self._kept
            return
        for patch in (self._sheet, *behind, *(patch for shape in seen for patch in shape.patches), *over, self._border):
            patch.draw(renderer)
        box, size = self._inset.box, self._words.size
        self._words.write(self._inset.name, box.left + 0.5 * size, box.bottom + 0.55 * size, out_pixels)
        self._kept_places, self._kept = places, area.copy()

    def _area(self, pixels: Pixels) -> Pixels:
        """The part of the picture that the inset covers, its border included."""
        box, edge = self._inset.box, math.ceil(0.5 * self._border.get_linewidth()) + 1
        bottom, top = (math.floor(box.bottom) - edge, math.ceil(box.bottom + box.height) + edge)
        left, right = max(math.floor(box.left) - edge, 0), math.ceil(box.left + box.width) + edge
        return pixels[max(len(pixels) - top, 0) : len(pixels) - bottom, left:right]

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

    def _own(self, patch: LastingPatch) -> LastingPatch:
        """The patch, drawn only within the inset."""
        box = self._inset.box
        patch.set_clip_box(Bbox.from_bounds(box.left, box.bottom, box.width, box.height))
        return patch


def _rectangle(low: Array, high: Array) -> Path:
    (x0, y0), (x1, y1) = low, high
    codes = [Path.MOVETO, Path.LINETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY]
    return Path([(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], codes)
