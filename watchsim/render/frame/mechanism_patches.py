"""Of which patches is the mechanism in a picture made, and in which order do they lie?

From behind: the hairspring, what cannot touch and is larger than all that can (a balance's rim), what never moves, then the
moving parts with their shadows, the largest first, stops of springs, and springs between points.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.backend_bases import RendererBase
from matplotlib.figure import Figure
from matplotlib.path import Path
from matplotlib.transforms import Affine2D, Bbox, IdentityTransform, Transform
from numpy.typing import NDArray

from watchsim.geometry.primitives import Arc
from watchsim.render.frame.coil_patches import CoilPatches
from watchsim.render.frame.coloured_edges import Edges, edge_paths
from watchsim.render.frame.filled_parts import Part, backdrop, is_round, loops_of, parts
from watchsim.render.frame.lasting_patch import LastingPatch
from watchsim.render.frame.line_spring_patches import LineSpringPatches
from watchsim.render.frame.pose_matrix import pose_matrix
from watchsim.render.frame.spring_stop_patches import SpringStopPatches
from watchsim.render.frame.view import Frame, View, size_of
from watchsim.render.picture_style import Style
from watchsim.scene.carriers import at_start, is_still
from watchsim.scene.scene import Scene

Array = NDArray[np.float64]

CHORD = 0.05  # pixels that a chord may stray from its arc
HATCH = 13.0  # pixels between hatch strokes
PICKED = 3.0  # pixels: width of picked edges
SHADOW = (2.0, -3.0)  # pixels


class Mechanism:
    """All bodies of a scene as `view` sees them in `room` (pixels) of a figure; `unit` is the size of everything drawn.

    `picked` edges are drawn over everything. What never moves and lies behind all else is given to the figure itself.
    """

    def __init__(
        self, figure: Figure, scene: Scene, view: View, room: Frame, unit: float, style: Style, picked: Sequence[Edges]
    ) -> None:
        self._figure, self._scene, self._view, self._room, self._unit, self._style = figure, scene, view, room, unit, style
        self._transforms = {body.name: Affine2D() for body in scene.bodies}
        self._springs = CoilPatches(scene, room, view.scale, style, unit, self.own)
        self._lines = LineSpringPatches(scene, style, unit, self.own)
        self._stops = SpringStopPatches(scene, style, unit, self.own)
        self._patches = [*self._compose(), *(patch for edges in picked for patch in self._picked(edges))]

    def draw(self, renderer: RendererBase, frames: dict[str, Array], matrix: Array) -> None:
        """Draw everything that may move, for the poses x, y, angle of one instant; `matrix` maps metres to pixels."""
        for body, transform in self._transforms.items():
            transform.set_matrix(matrix @ pose_matrix(frames[body]))
        for patch in self._springs.patches(frames, matrix):
            patch.draw(renderer)
        for patch in (*self._patches, *self._stops.patches(frames, matrix), *self._lines.patches(frames, matrix)):
            patch.draw(renderer)

    def rings(self, points: Array, colour: str) -> list[LastingPatch]:
        """Rings around points (n, 2), pixels, with a pale rim, to be seen on steel, brass and ruby alike."""
        path, width = _rings(points, 7.0 * max(self._unit, 0.5)), max(2.4 * self._unit, 1.2)
        looks = ((self._style.background, 2.2 * width), (colour, width))
        place = IdentityTransform()
        return [LastingPatch(path, fill=False, edgecolor=shade, linewidth=line, transform=place) for shade, line in looks]

    def own(self, patch: LastingPatch) -> LastingPatch:
        """The patch, drawn on this figure and only between the bands of words."""
        room = self._room
        patch.set_figure(self._figure)
        patch.set_clip_box(Bbox.from_bounds(room.left, room.bottom, room.width, room.height))
        return patch

    def _compose(self) -> list[LastingPatch]:
        """Patches to draw in every frame, in order; those that never move go to the figure itself."""
        shapes = parts(self._scene, CHORD / self._view.scale, HATCH * self._unit / self._view.scale)
        start = at_start(self._scene).bodies
        still = {body.name for body in self._scene.bodies if is_still(self._scene, body) and self._view.follow is None}
        frames = {body.name: np.array([*body.position, body.angle]) for body in start}
        for body in still:
            self._transforms.pop(body)
        live: list[LastingPatch] = []
        unmoved: list[LastingPatch] = []
        for part in shapes:
            if part.body in still:
                fixed = Affine2D(self._view.matrix(self._view.centre) @ pose_matrix(frames[part.body]))
                unmoved += self._of_part(part, fixed)
        moving = [part for part in shapes if part.body not in still]
        behind = backdrop(moving)
        for part in behind:
            live += [self._shadow(part), *self._of_part(part, self._transforms[part.body])]
        if behind or self._springs:
            live += unmoved
        else:
            for patch in unmoved:
                self._figure.add_artist(patch)
        moving = moving[len(behind) :]
        live += [self._shadow(part) for part in moving if not part.ground]
        live += [patch for part in moving for patch in self._of_part(part, self._transforms[part.body])]
        live += [self._spoke(name) for name in self._transforms if is_round(self._scene.body(name))]
        live += self._pivots()
        return live

    def _of_part(self, part: Part, transform: Transform) -> list[LastingPatch]:
        look = self._style.worn(part.finish)
        edge = {"edgecolor": look.edge, "joinstyle": "round", "capstyle": "round", "transform": transform}
        thin = max(1.1 * self._unit, 0.6)
        if not part.ground:
            return [self.own(LastingPatch(part.faces, facecolor=look.fill, linewidth=thin, **edge))]
        edge["edgecolor"] = self._style.line(look)
        made = [] if part.strokes is None else [LastingPatch(part.strokes, fill=False, linewidth=0.8 * thin, alpha=0.7, **edge)]
        return [self.own(patch) for patch in (*made, LastingPatch(part.faces, fill=False, linewidth=1.8 * thin, **edge))]

    def _picked(self, edges: Edges) -> list[LastingPatch]:
        """Edges in colour, on top of their bodies."""
        look = {"fill": False, "edgecolor": edges.colour, "linewidth": max(PICKED * self._unit, 1.5), "capstyle": "round"}
        made = []
        for number, path in edge_paths(edges, CHORD / self._view.scale).items():
            if number >= len(self._scene.bodies):
                continue  # the rack of a gear or a stop, which is nowhere
            body = self._scene.bodies[number]
            place = Affine2D(self._view.matrix(self._view.centre) @ pose_matrix(np.array([*body.position, body.angle])))
            made.append(self.own(LastingPatch(path, transform=self._transforms.get(body.name, place), **look)))
        return made

    def _shadow(self, part: Part) -> LastingPatch:
        shift = Affine2D().translate(SHADOW[0] * self._unit, SHADOW[1] * self._unit)
        return self.own(
            LastingPatch(part.faces, facecolor=self._style.shade, linewidth=0.0, transform=self._transforms[part.body] + shift)
        )

    def _spoke(self, name: str) -> LastingPatch:
        """A radius drawn on a body so round that its turning could not be seen."""
        body = self._scene.body(name)
        bore = max(
            (edge.radius for loop in loops_of(body) if loop.hole for edge in loop.edges if isinstance(edge, Arc)), default=0.0
        )
        reach = 0.5 * size_of(body)
        path = Path([(bore, 0.0), (bore + 0.9 * (reach - bore), 0.0)])
        width = max(2.0 * self._unit, 1.0)
        return self.own(
            LastingPatch(
                path, fill=False, edgecolor=self._style.ink, linewidth=width, capstyle="round", transform=self._transforms[name]
            )
        )

    def _pivots(self) -> list[LastingPatch]:
        """A small ring at every pivot; those on carriers move with them."""
        pivoted = [body for body in self._scene.bodies if body.motion == "pivot"]
        if not pivoted or self._view.follow is not None:
            return []
        radius, matrix = 3.2 * max(self._unit, 0.5), self._view.matrix(self._view.centre)
        look = {"facecolor": self._style.background, "edgecolor": self._style.ink, "linewidth": max(1.3 * self._unit, 0.8)}
        places = [body.position for body in pivoted if body.on is None]
        patches = []
        if places:
            rings = _rings(np.array(places) @ matrix[:2, :2].T + matrix[:2, 2], radius)
            patches.append(self.own(LastingPatch(rings, transform=IdentityTransform(), **look)))
        moved = _rings(np.zeros((1, 2)), radius / self._view.scale)
        names = [body.name for body in pivoted if body.on is not None]
        return patches + [self.own(LastingPatch(moved, transform=self._transforms[name], **look)) for name in names]


def _rings(points: Array, radius: float) -> Path:
    """Circles of `radius` pixels around points given in pixels."""
    circle = Path.unit_circle()
    vertices = radius * np.asarray(circle.vertices)
    return Path.make_compound_path(*(Path(vertices + point, circle.codes) for point in points))
