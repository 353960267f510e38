"""What does one frame show?

The background (fixed bodies, title, scale, names) is drawn once; then one patch per part is moved by its transform and
the changing numbers are copied in. Frames do not depend on one another.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.transforms import Affine2D, Bbox, IdentityTransform, Transform
from numpy.typing import NDArray

from watchsim.geometry.primitives import Arc
from watchsim.render.frame.coil_patches import CoilPatches
from watchsim.render.frame.coloured_edges import Edges, edge_paths
from watchsim.render.frame.filled_parts import Part, backdrop, is_round, loops_of, parts
from watchsim.render.frame.marks.extras import NOTHING, Extras
from watchsim.render.frame.marks.mechanism_extras import Beside
from watchsim.render.frame.marks.readouts import Clock
from watchsim.render.frame.marks.word_layout import draw_key, draw_notes, draw_rules, draw_scale, lay_out, relative_size
from watchsim.render.frame.pose_history import Window
from watchsim.render.frame.pose_matrix import pose_matrix
from watchsim.render.frame.view import size_of, view
from watchsim.render.style import LIGHT, Style
from watchsim.scene.carriers import at_start, is_still
from watchsim.simulation.record.trajectory import Trajectory

Array = NDArray[np.float64]
Pixels = NDArray[np.uint8]

DPI = 72.0  # one point is one pixel
CHORD = 0.05  # pixels that a chord may stray from its arc
HATCH = 13.0  # pixels between hatch strokes
PICKED = 3.0  # pixels: width of picked edges
SHADOW = (2.0, -3.0)  # pixels


class Stage:
    """Draws a run at any instant of a window, always in the same frame.

    `size` is (width, height) in pixels; `speed` and `step` (s between frames) are only told, not used. `picked` edges are
    drawn over everything, with a key below the title. With `extras` the mechanism leaves room for them.
    `clock` reports something other than the time of the run, `style` is light or dark.
    """

    def __init__(
        self,
        run: Trajectory,
        size: tuple[int, int],
        window: Window,
        *,
        zoom: Sequence[str] | None = None,
        turn: float | None = None,
        speed: float | None = None,
        step: float | None = None,
        picked: Sequence[Edges] = (),
        extras: Extras = NOTHING,
        clock: Clock | None = None,
        style: Style = LIGHT,
    ) -> None:
        self._style = style
        self._figure = Figure(figsize=((size[0] + 0.5) / DPI, (size[1] + 0.5) / DPI), dpi=DPI, facecolor=style.background)
        self._canvas = FigureCanvasAgg(self._figure)
        self._unit = relative_size(*size)
        self._layout = lay_out(self._figure, run, window, step or (window[1] - window[0]) / 2000.0, style)
        if clock is not None:
            self._layout = replace(self._layout, clock=clock)
        size_of_text = self._layout.small.size
        self._beside = Beside(self._figure, run, window, extras, self._layout.frame, size_of_text, self._unit, style)
        self._room = self._beside.room
        self.view = view(run, window, self._room, zoom, turn)
        self._beside.look_at(self.view)
        draw_scale(self._figure, self.view.scale, style)
        draw_notes(self._figure, self._layout.frame, speed, self.view.turn, style)
        endless = any(not loop.closed for body in run.scene.bodies for loop in loops_of(body))
        if zoom is not None or endless or self.view.follow is not None:
            draw_rules(self._figure, self._room, style)
        self._transforms = {body.name: Affine2D() for body in run.scene.bodies}
        self._springs = CoilPatches(run.scene, self._room, self.view.scale, style, self._unit, self._own)
        self._patches = [*self._compose(run), *(patch for edges in picked for patch in self._picked(run, edges))]
        draw_key(self._figure, [(edges.colour, edges.meaning) for edges in picked], style)
        self._canvas.draw()
        self._background = self._canvas.copy_from_bbox(self._figure.bbox)

    def draw(
        self,
        t: float,
        frames: dict[str, Array],
        contacts: Array | None = None,
        mark: str | None = None,
        press: tuple[Array, Array] | None = None,
        speed: float | None = None,
    ) -> Pixels:
        """The picture (height, width, 4) of the instant `t`; the next call overwrites it.

        `frames` gives every body's pose x, y, angle; `contacts` (n, 2) points to mark, in metres, in the colour `mark` (default: of contacts); `press`
        points (n, 2), m, and the forces there (n, 2), N; `speed` is told where it changes from frame to frame.
        """
        self._canvas.restore_region(self._background)
        renderer = self._canvas.get_renderer()
        matrix = self.view.matrix(self.view.centre_at(frames))
        for body, transform in self._transforms.items():
            transform.set_matrix(matrix @ pose_matrix(frames[body]))
        for patch in self._springs.patches(frames, matrix):
            patch.draw(renderer)
        for patch in self._patches:
            patch.draw(renderer)

        def touching(matrix: Array) -> list[PathPatch]:
            marked = contacts is not None and len(contacts) > 0
            made = self._marks(contacts @ matrix[:2, :2].T + matrix[:2, 2], mark or self._style.contact) if contacts is not None and marked else []
            return made if press is None else made + self._beside.arrows(matrix, *press)

        for patch in touching(matrix):
            self._own(patch).draw(renderer)
        pixels = np.asarray(self._canvas.buffer_rgba())
        self._beside.draw(renderer, t, frames, matrix, touching, pixels)
        if speed is not None:
            self._beside.tell_speed(speed, self._layout.frame, pixels)
        self._layout.write(t, frames, pixels)
        return pixels

    def _compose(self, run: Trajectory) -> list[PathPatch]:
        """Patches to draw in every frame, in order; those that never move go to the figure itself."""
        shapes = parts(run.scene, CHORD / self.view.scale, HATCH * self._unit / self.view.scale)
        start = at_start(run.scene).bodies
        still = {body.name for body in run.scene.bodies if is_still(run.scene, body) and self.view.follow is None}
        frames = {body.name: np.array([*body.position, body.angle]) for body in start}
        for body in still:
            self._transforms.pop(body)
        live: list[PathPatch] = []
        unmoved: list[PathPatch] = []
        for part in shapes:
            if part.body in still:
                fixed = Affine2D(self.view.matrix(self.view.centre) @ pose_matrix(frames[part.body]))
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
        live += [self._spoke(run, name) for name in self._transforms if is_round(run.scene.body(name))]
        live += self._pivots(run)
        return live

    def _of_part(self, part: Part, transform: Transform) -> list[PathPatch]:
        look = self._style.worn(part.finish)
        edge = {"edgecolor": look.edge, "joinstyle": "round", "capstyle": "round", "transform": transform}
        thin = max(1.1 * self._unit, 0.6)
        if not part.ground:
            return [self._own(PathPatch(part.faces, facecolor=look.fill, linewidth=thin, **edge))]
        edge["edgecolor"] = self._style.line(look)
        strokes = [] if part.strokes is None else [PathPatch(part.strokes, fill=False, linewidth=0.8 * thin, alpha=0.7, **edge)]
        return [self._own(patch) for patch in (*strokes, PathPatch(part.faces, fill=False, linewidth=1.8 * thin, **edge))]

    def _picked(self, run: Trajectory, edges: Edges) -> list[PathPatch]:
        """Edges in colour, on top of their bodies."""
        look = {"fill": False, "edgecolor": edges.colour, "linewidth": max(PICKED * self._unit, 1.5), "capstyle": "round"}
        made = []
        for number, path in edge_paths(edges, CHORD / self.view.scale).items():
            body = run.scene.bodies[number]
            place = Affine2D(self.view.matrix(self.view.centre) @ pose_matrix(np.array([*body.position, body.angle])))
            made.append(self._own(PathPatch(path, transform=self._transforms.get(body.name, place), **look)))
        return made

    def _shadow(self, part: Part) -> PathPatch:
        shift = Affine2D().translate(SHADOW[0] * self._unit, SHADOW[1] * self._unit)
        return self._own(PathPatch(part.faces, facecolor=self._style.shade, linewidth=0.0, transform=self._transforms[part.body] + shift))

    def _spoke(self, run: Trajectory, name: str) -> PathPatch:
        """A radius drawn on a body so round that its turning could not be seen."""
        body = run.scene.body(name)
        bore = max(
            (edge.radius for loop in loops_of(body) if loop.hole for edge in loop.edges if isinstance(edge, Arc)), default=0.0
        )
        reach = 0.5 * size_of(body)
        path = Path([(bore, 0.0), (bore + 0.9 * (reach - bore), 0.0)])
        width = max(2.0 * self._unit, 1.0)
        return self._own(
            PathPatch(path, fill=False, edgecolor=self._style.ink, linewidth=width, capstyle="round", transform=self._transforms[name])
        )

    def _pivots(self, run: Trajectory) -> list[PathPatch]:
        """A small ring at every pivot; those on carriers move with them."""
        pivoted = [body for body in run.scene.bodies if body.motion == "pivot"]
        if not pivoted or self.view.follow is not None:
            return []
        radius, matrix = 3.2 * max(self._unit, 0.5), self.view.matrix(self.view.centre)
        look = {"facecolor": self._style.background, "edgecolor": self._style.ink, "linewidth": max(1.3 * self._unit, 0.8)}
        places = [body.position for body in pivoted if body.on is None]
        patches = []
        if places:
            rings = _rings(np.array(places) @ matrix[:2, :2].T + matrix[:2, 2], radius)
            patches.append(self._own(PathPatch(rings, transform=IdentityTransform(), **look)))
        moved = _rings(np.zeros((1, 2)), radius / self.view.scale)
        names = [body.name for body in pivoted if body.on is not None]
        return patches + [self._own(PathPatch(moved, transform=self._transforms[name], **look)) for name in names]

    def _marks(self, points: Array, mark: str) -> list[PathPatch]:
        """Rings with a pale rim, to be seen on steel, brass and ruby alike."""
        rings, width = _rings(points, 7.0 * max(self._unit, 0.5)), max(2.4 * self._unit, 1.2)
        looks = ((self._style.background, 2.2 * width), (mark, width))
        place = IdentityTransform()
        return [PathPatch(rings, fill=False, edgecolor=colour, linewidth=line, transform=place) for colour, line in looks]

    def _own(self, patch: PathPatch) -> PathPatch:
        """The patch, drawn on this figure and only between the bands of words."""
        room = self._room
        patch.set_figure(self._figure)
        patch.set_clip_box(Bbox.from_bounds(room.left, room.bottom, room.width, room.height))
        return patch


def _rings(points: Array, radius: float) -> Path:
    """Circles of `radius` pixels around points given in pixels."""
    circle = Path.unit_circle()
    vertices = radius * np.asarray(circle.vertices)
    return Path.make_compound_path(*(Path(vertices + point, circle.codes) for point in points))
