"""What does a page draw of every part?

The very lines and arcs of the drawing, as codes and numbers for a canvas, and once more as a still picture in SVG, which
prints, and which stands there where a mail program runs no scripts.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc
from watchsim.pages.player.packed import floats, small
from watchsim.render.frame.filled_parts import Part, loops_of, parts
from watchsim.scene.scene import Scene

MOVE, LINE, ARC, CLOSE = range(4)
ROUGH = 1e-3  # of the picture: chords where only the order and the nesting of parts matter
HATCH = 0.01  # of the picture: distance of hatch strokes
MOST_STROKES = 4000  # along the longest open outline


def drawn_parts(scene: Scene, size: float) -> tuple[Part, ...]:
    """All parts of a scene, largest first; `size` (m) is that of the picture."""
    longest = max((loop.length for body in scene.bodies for loop in loops_of(body) if not loop.closed), default=0.0)
    return parts(scene, ROUGH * size, max(HATCH * size, longest / MOST_STROKES))


def packed_part(part: Part, bodies: Sequence[str]) -> dict[str, object]:
    """Codes and numbers of a part, in metres and radians in its body's frame."""
    codes, numbers = _instructions(part.outlines)
    found: dict[str, object] = {
        "body": bodies.index(part.body),
        "layer": part.layer,
        "fill": part.finish.fill,
        "edge": part.finish.edge,
        "codes": small(codes),
        "numbers": floats(numbers),
    }
    if part.finish.pale:
        found["pale"] = True
    if part.ground:
        strokes = np.zeros(0) if part.strokes is None else np.asarray(part.strokes.vertices).reshape(-1)
        found["ground"] = floats(strokes)
    return found


def _instructions(loops: Sequence[Loop]) -> tuple[list[int], list[float]]:
    """MOVE x y, LINE x y, ARC x y radius start sweep, CLOSE."""
    codes: list[int] = []
    numbers: list[float] = []
    for loop in loops:
        codes.append(MOVE)
        numbers += loop.edges[0].start
        for edge in loop.edges:
            if isinstance(edge, Arc):
                codes.append(ARC)
                numbers += (edge.x, edge.y, edge.radius, math.remainder(edge.start_angle, math.tau), edge.sweep)
            else:
                codes.append(LINE)
                numbers += edge.end
        if loop.closed:
            codes.append(CLOSE)
    return codes, numbers


def path_data(loops: Sequence[Loop]) -> str:
    """The same as SVG path data, in mm."""
    return "".join(piece for loop in loops for piece in _path(loop))


def _path(loop: Loop) -> Iterator[str]:
    yield f"M{_place(loop.edges[0].start)}"
    for edge in loop.edges:
        if not isinstance(edge, Arc):
            yield f"L{_place(edge.end)}"
            continue
        radius, turn = _number(edge.radius), int(edge.sweep > 0.0)
        # An arc is given by its ends: of a circle they are the same, and near half a turn they say little about the centre.
        pieces = math.ceil(abs(edge.sweep) / (0.75 * math.pi))
        for k in range(1, pieces + 1):
            yield f"A{radius} {radius} 0 0 {turn} {_place(edge.point(k / pieces))}"
    if loop.closed:
        yield "Z"


def _place(point: tuple[float, float]) -> str:
    return f"{_number(point[0])} {_number(point[1])}"


def _number(metres: float) -> str:
    return f"{1e3 * metres:.6f}".rstrip("0").rstrip(".")
