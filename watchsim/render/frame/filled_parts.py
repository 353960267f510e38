"""Which shapes are filled to draw a body?

One shape per body and layer, holes and bores left empty wherever they were drawn, marks left out; an open outline (a plane, a
wall) becomes ground: a line with hatching on the side of its material.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.path import Path
from numpy.typing import NDArray

from watchsim.drawing.drawn_material import layer_roles
from watchsim.geometry.loop import Loop
from watchsim.geometry.polyline import polyline
from watchsim.geometry.primitives import Arc, Point
from watchsim.render.palette import Finish, finish, looks
from watchsim.scene.body import Body
from watchsim.scene.scene import Scene

Array = NDArray[np.float64]

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
    layers = dict.fromkeys(loop.layer for loop, _ in outer)
    made = []
    for layer in layers:
        members = [i for i, (loop, _) in enumerate(outer) if loop.layer == layer]
        followed = [_oriented(*own, hole=k > 0) for i in members for k, own in enumerate(owners[i])]
        area = max(abs(signed_area(outer[i][1])) for i in members)
        faces, outlines = compound([line for _, line in followed]), tuple(loop for loop, _ in followed)
        made.append(Part(body.name, faces, None, area, finish(body, layer, look), layer=layer, outlines=outlines))
    return made


def _oriented(loop: Loop, line: Array, hole: bool) -> tuple[Loop, Array]:
    """Outer outlines counter-clockwise, holes clockwise: the fill is by winding number, so overlapping pieces unite."""
    return (loop.reversed(), line[::-1]) if (signed_area(line) < 0.0) != hole else (loop, line)


def compound(lines: Sequence[Array]) -> Path:
    """One path of closed polylines."""
    codes = []
    for line in lines:
        code = np.full(len(line), Path.LINETO, dtype=np.uint8)
        code[0], code[-1] = Path.MOVETO, Path.CLOSEPOLY
        codes.append(code)
    return Path(np.concatenate(lines), np.concatenate(codes))


def _grounds(body: Body, look: Finish, chains: list[tuple[Loop, Array]], spacing: float) -> list[Part]:
    made = []
    for loop, line in chains:
        codes = np.full(len(line), Path.LINETO, dtype=np.uint8)
        codes[0] = Path.MOVETO
        own = finish(body, loop.layer, look)
        faces, strokes = Path(line, codes), hatching(line, spacing)
        made.append(Part(body.name, faces, strokes, math.inf, own, ground=True, layer=loop.layer, outlines=(loop,)))
    return made


def hatching(line: Array, spacing: float) -> Path:
    """Slanted strokes every `spacing` metres along a polyline, on its left, where the material is."""
    steps = np.diff(line, axis=0)
    lengths = np.hypot(steps[:, 0], steps[:, 1])
    along = np.concatenate(([0.0], np.cumsum(lengths)))
    marks = np.arange(0.5 * spacing, along[-1], spacing)
    piece = np.clip(np.searchsorted(along, marks, side="right") - 1, 0, len(lengths) - 1)
    unit = steps[piece] / lengths[piece, None]
    foot = line[piece] + unit * (marks - along[piece])[:, None]
    inward = np.column_stack((-unit[:, 1], unit[:, 0])) - HATCH_SLANT * unit
    strokes = np.stack((foot, foot + 0.8 * spacing * inward), axis=1).reshape(-1, 2)
    return Path(strokes, np.tile([Path.MOVETO, Path.LINETO], len(marks)).astype(np.uint8))


def is_round(body: Body) -> bool:
    """True where turning the body cannot be seen: nothing but circles about its own origin."""
    edges = [edge for loop in loops_of(body) for edge in loop.edges]
    return bool(edges) and all(isinstance(edge, Arc) and math.hypot(edge.x, edge.y) <= 1e-9 * edge.radius for edge in edges)
