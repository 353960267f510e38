"""Which shapes are filled to draw a body?

One shape per body and layer, holes and bores left empty wherever they were drawn, marks left out; an open outline (a plane, a
wall) becomes ground: a line with hatching on the side of its material.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backend_bases import GraphicsContextBase, RendererBase
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.transforms import Affine2D, Bbox
from numpy.typing import NDArray

from watchsim.contact.cell_frames import chords
from watchsim.drawing.material import layer_roles
from watchsim.geometry.loops import Loop, polyline
from watchsim.geometry.primitives import Arc, Point
from watchsim.mechanism.compile import Compiled
from watchsim.model import Model
from watchsim.render.palette import LIGHT, Finish, finish, looks
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.trajectory import Array, frames


def pose_matrix(frame: Array) -> Array:
    """The 3 × 3 map from a body's frame to the plane, for its pose x, y, angle."""
    x, y, angle = frame
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, x], [s, c, y], [0.0, 0.0, 1.0]])


# A patch of matplotlib recomputes its look whenever it is drawn, which for small shapes costs more than the shape itself.


class LastingPatch(PathPatch):
    """A patch whose colours, lines and clip box are final when it is first drawn; its path and transform may go on changing."""

    _context: GraphicsContextBase | None = None
    _face: Any = None

    def drawn_on(self, figure: Figure, room: Bbox) -> LastingPatch:
        """The patch, as one of a figure, and only within `room` (pixels)."""
        self.set_figure(figure)
        self.set_clip_box(room)
        return self

    def draw(self, renderer: RendererBase) -> None:
        """Draw it with the look that it had when it was first drawn."""
        if self._context is None:
            self._context, self._face = self._look(renderer)
        renderer.draw_path(self._context, self.get_path(), self.get_transform(), self._face)

    def _look(self, renderer: RendererBase) -> tuple[GraphicsContextBase, Any]:
        """The context for its edge, and the colour of its face (None: left empty)."""
        context = renderer.new_gc()
        edge, face = to_rgba(self.get_edgecolor()), to_rgba(self.get_facecolor())
        if (alpha := self.get_alpha()) is not None:  # any other would take the place of what the colours have
            context.set_alpha(alpha)
        context.set_foreground(edge, isRGBA=True)
        context.set_linewidth(self.get_linewidth() if edge[3] else 0.0)
        context.set_capstyle(self.get_capstyle())
        context.set_joinstyle(self.get_joinstyle())
        context.set_clip_rectangle(self.get_clip_box())
        return context, face if face[3] else None


SMOOTH = 2000  # chords of one arc, at most: a circle larger than any picture still looks round


@dataclass(frozen=True)
class Edges:
    """Primitives of a model (`rows`) in one colour, and what a key says of them."""

    model: Model
    rows: NDArray[np.int64]
    colour: str
    meaning: str


def edge_paths(edges: Edges, deviation: float) -> dict[int, Path]:
    """By number of the body, its picked edges in the body's frame (m); chords stray at most `deviation` (m) from arcs.

    A corner becomes a stroke of length `deviation`: a dot.
    """
    bodies = edges.model.primitives.body[edges.rows]
    return {int(body): _path(edges, edges.rows[bodies == body], deviation) for body in np.unique(bodies)}


def _path(edges: Edges, rows: NDArray[np.int64], deviation: float) -> Path:
    drawn = chords(edges.model.primitives[rows], deviation, SMOOTH)
    lines = [drawn.points[first:last] for first, last in pairwise(drawn.first)]
    lines = [line if len(line) > 1 else np.stack([line[0], line[0] + np.array([deviation, 0.0])]) for line in lines]
    return compound(lines, closed=False)


LARGER = 1.0 + 1e-6  # in area: an outline in the very place of a hole fills it and is not around it
ALIKE = 6  # digits of two areas that are the same
HATCH_SLANT = 0.7  # tangential lean of a hatch stroke per unit of depth


@dataclass(frozen=True)
class Part:
    """A shape in its body's frame (m). `faces` is filled, `strokes` (may be None) is only drawn; `area` (m²) orders parts.

    `outlines` are the loops that `faces` follows, with their arcs: outer ones counter-clockwise, holes clockwise.
    """

    body: str
    faces: Path
    strokes: Path | None
    area: float
    finish: Finish
    ground: bool = False
    layer: str = ""
    outlines: tuple[Loop, ...] = ()


def parts(scene: Scene, deviation: float, spacing: float) -> tuple[Part, ...]:
    """All shapes of a scene, largest first, so that stones and pins lie on top.

    `deviation` (m) is the largest distance of a chord from its arc, `spacing` (m) that of hatch strokes.
    """
    worn = looks(scene)
    found = [part for body in scene.bodies for part in _of_body(body, worn[body.name], deviation, spacing)]
    # The same shape may be drawn of another section, too: what can touch is to be seen.
    return tuple(sorted(found, key=lambda part: (-float(f"{part.area:.{ALIKE}g}"), not part.finish.pale)))


def backdrop(shapes: Sequence[Part]) -> Sequence[Part]:
    """Of parts in the order of `parts`: the leading ones that cannot touch, such as a balance's rim; they lie behind."""
    return shapes[: next((k for k, part in enumerate(shapes) if not part.finish.pale), len(shapes))]


def working(scene: Scene, deviation: float, spacing: float) -> tuple[Part, ...]:
    """The same without what lies behind all else and cannot touch: from a balance's rim nothing is to be learnt."""
    found = parts(scene, deviation, spacing)
    behind = {id(part) for part in backdrop([part for part in found if scene.body(part.body).motion != "fixed"])}
    return tuple(part for part in found if id(part) not in behind)


def loops_of(body: Body) -> tuple[Loop, ...]:
    """Everything that was drawn of a body, whether it can touch or not."""
    return tuple(loop for loop in (*body.loops, *body.decoration) if loop.edges)


def outline(loops: Iterable[Loop], deviation: float) -> Array:
    """(n, 2) points of all loops, for extents."""
    lines = [polyline(loop, deviation) for loop in loops]
    return np.concatenate(lines) if lines else np.empty((0, 2))


def signed_area(points: Array) -> float:
    """Area inside a closed polyline (m²), positive counter-clockwise."""
    x, y = points[:, 0] - points[0, 0], points[:, 1] - points[0, 1]
    return 0.5 * float(np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]))


def _of_body(body: Body, look: Finish, deviation: float, spacing: float) -> list[Part]:
    loops = loops_of(body)
    roles = layer_roles(loop for loop in loops if loop.closed)
    lines = [(loop, polyline(loop, deviation)) for loop in loops]
    outer = [(loop, line) for loop, line in lines if loop.closed and not loop.hole and roles[loop.layer] == "material"]
    owners: list[list[tuple[Loop, Array]]] = [[own] for own in outer]
    ground = [(loop, line) for loop, line in lines if not loop.closed]
    for loop, line in lines:
        if loop.closed and (loop.hole or roles[loop.layer] == "bore"):
            # What lies around it on its own layer, if anything does: a window is not one of a smaller wheel on it.
            own = [i for i, (around, _) in enumerate(outer) if around.layer == loop.layer]
            owner = _owner(line, own, outer)
            if owner is None:
                owner = _owner(line, range(len(outer)), outer)
            if owner is not None:
                owners[owner].append((loop, line))
            elif loop.hole:
                ground.append((loop, line))
    return [*_solids(body, look, outer, owners), *_grounds(body, look, ground, spacing)]


def _owner(hole: Array, numbers: Iterable[int], outer: Sequence[tuple[Loop, Array]]) -> int | None:
    """The smallest of those outlines around a hole: a bore drawn on a layer of its own still empties the wheel."""
    inside, least = _inner_point(hole), LARGER * abs(signed_area(hole))
    areas = {i: abs(signed_area(outer[i][1])) for i in numbers}
    around = [i for i, area in areas.items() if area > least and Path(outer[i][1]).contains_point(inside)]
    return min(around, key=lambda i: areas[i], default=None)


def _inner_point(line: Array) -> Point:
    """A point well inside a closed polyline: half way between where it is entered and left again, at a height of no corner."""
    heights = np.unique(line[:, 1])
    if len(heights) < 2:
        return (float(line[0, 0]), float(line[0, 1]))
    k = int(np.argmax(np.diff(heights)))
    y = 0.5 * (heights[k] + heights[k + 1])
    (x0, y0), (x1, y1) = line[:-1].T, line[1:].T
    passes = (y0 < y) != (y1 < y)
    crossed = np.sort(x0[passes] + (y - y0[passes]) * (x1 - x0)[passes] / (y1 - y0)[passes])
    return (0.5 * float(crossed[0] + crossed[1]), float(y))


def _solids(body: Body, look: Finish, outer: list[tuple[Loop, Array]], owners: list[list[tuple[Loop, Array]]]) -> list[Part]:
    made = []
    for layer in dict.fromkeys(loop.layer for loop, _ in outer):
        members = [i for i, (loop, _) in enumerate(outer) if loop.layer == layer]
        followed = [_oriented(*own, hole=k > 0) for i in members for k, own in enumerate(owners[i])]
        area = max(abs(signed_area(outer[i][1])) for i in members)
        faces, outlines = compound([line for _, line in followed]), tuple(loop for loop, _ in followed)
        made.append(Part(body.name, faces, None, area, finish(body, layer, look), layer=layer, outlines=outlines))
    return made


def _oriented(loop: Loop, line: Array, hole: bool) -> tuple[Loop, Array]:
    """Outer outlines counter-clockwise, holes clockwise: the fill is by winding number, so overlapping pieces unite."""
    return (loop.reversed(), line[::-1]) if (signed_area(line) < 0.0) != hole else (loop, line)


def compound(lines: Sequence[Array], closed: bool = True) -> Path:
    """One path of polylines, closed or open."""
    codes = []
    for line in lines:
        code = np.full(len(line), Path.LINETO, dtype=np.uint8)
        code[0], code[-1] = Path.MOVETO, Path.CLOSEPOLY if closed else Path.LINETO
        codes.append(code)
    return Path(np.concatenate(lines), np.concatenate(codes))


def _grounds(body: Body, look: Finish, chains: list[tuple[Loop, Array]], spacing: float) -> list[Part]:
    made = []
    for loop, line in chains:
        faces, strokes, own = compound([line], closed=False), hatching(line, spacing), finish(body, loop.layer, look)
        made.append(Part(body.name, faces, strokes, math.inf, own, ground=True, layer=loop.layer, outlines=(loop,)))
    return made


def hatching(line: Array, spacing: float) -> Path:
    """Slanted strokes every `spacing` metres along a polyline, on its left, where the material is."""
    steps = np.diff(line, axis=0)
    lengths = np.hypot(*steps.T)
    along = np.concatenate(([0.0], np.cumsum(lengths)))
    marks = np.arange(0.5 * spacing, along[-1], spacing)
    piece = np.clip(np.searchsorted(along, marks, side="right") - 1, 0, len(lengths) - 1)
    unit = steps[piece] / lengths[piece, None]
    foot = line[piece] + unit * (marks - along[piece])[:, None]
    inward = np.column_stack((-unit[:, 1], unit[:, 0])) - HATCH_SLANT * unit
    strokes = np.stack((foot, foot + 0.8 * spacing * inward), axis=1).reshape(-1, 2)
    return Path(strokes, np.tile([Path.MOVETO, Path.LINETO], len(marks)).astype(np.uint8))


def spoke(body: Body, size: float) -> tuple[float, float]:
    """From where to where along its x axis (m) a radius is drawn on a round body of that size, from its bore on."""
    edges = (edge for loop in loops_of(body) if loop.hole for edge in loop.edges)
    bore = max((edge.radius for edge in edges if isinstance(edge, Arc)), default=0.0)
    return bore, bore + 0.9 * (0.5 * size - bore)


def is_round(body: Body) -> bool:
    """True where turning the body cannot be seen: nothing but circles about its own origin."""
    edges = [edge for loop in loops_of(body) for edge in loop.edges]
    return bool(edges) and all(isinstance(edge, Arc) and math.hypot(edge.x, edge.y) <= 1e-9 * edge.radius for edge in edges)


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
            look = LIGHT.worn(part.finish)
            axes.add_artist(  # the limits are set by who draws; working them out from all curves takes longer than drawing
                PathPatch(path, fill=not part.ground, facecolor=look.fill, edgecolor=look.edge, linewidth=EDGE, zorder=2)
            )

    def outline(self, axes: Axes, q: Array, bodies: Iterable[str], colour: str) -> None:
        """Where some bodies stood or will stand, as thin dashes."""
        for _, path in self._placed(q, bodies):
            axes.add_patch(PathPatch(path, fill=False, edgecolor=colour, linewidth=0.5, linestyle=(0, (4, 2)), zorder=3))

    def _placed(self, q: Array, bodies: Iterable[str] | None) -> Iterable[tuple[Part, Path]]:
        wanted = None if bodies is None else set(bodies)
        places = frames(self.scene, self.compiled.slices, self.compiled.relative(q[None]))
        for part in self.parts:
            if wanted is not None and part.body not in wanted:
                continue
            x, y, angle = places[part.body][0].tolist()
            yield part, Affine2D().rotate(angle).translate(x, y).scale(1e3).transform_path(part.faces)
