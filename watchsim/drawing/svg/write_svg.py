"""How are outlines written as an SVG file?

A page in real millimetres whose user unit is the millimetre, y turned down as SVG has it; one Inkscape layer per layer, in it
one path with straight lines and circular A commands. Arcs are divided into parts of at most a quarter turn: A gives ends and
radius only, and the centre of a half turn would be lost in their rounding.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from xml.sax.saxutils import quoteattr

from watchsim.geometry.extent import extents
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line, Point

MM = 1e3
MARGIN = 0.05  # of the larger side, around the outlines
STROKE = 0.002  # of the larger side


def svg_text(
    loops: Iterable[Loop], points: Iterable[tuple[str, Point]] = (), colours: Mapping[str, str] | None = None, title: str = ""
) -> str:
    """The SVG file of loops and open chains (metres) and of points (layer, place), these as small circles on a hidden layer.

    `colours` are "#rrggbb" of layers, to fill them.
    """
    layers: dict[str, list[Loop]] = {}
    for loop in loops:
        layers.setdefault(loop.layer, []).append(loop)
    x0, y0, x1, y1 = extents(loop for members in layers.values() for loop in members) or (0.0, 0.0, 1e-3, 1e-3)
    size = MM * max(x1 - x0, y1 - y0) or 1.0
    margin = MARGIN * size
    left, top = MM * x0 - margin, -MM * y1 - margin
    width, height = MM * (x1 - x0) + 2.0 * margin, MM * (y1 - y0) + 2.0 * margin
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<svg xmlns="http://www.w3.org/2000/svg" xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"',
        f'  width="{width!r}mm" height="{height!r}mm" viewBox="{left!r} {top!r} {width!r} {height!r}">',
    ]
    lines += [f"  <title>{_escaped(title)}</title>"] if title else []
    for layer, members in layers.items():
        fill = (colours or {}).get(layer, "#d0d4d8")
        lines += _group(layer, f'fill="{fill}" stroke="#23272c" stroke-width="{STROKE * size:.4g}"', _path(members))
    marks: dict[str, list[str]] = {}
    for layer, (x, y) in points:
        marks.setdefault(layer, []).append(f'<circle cx="{MM * x!r}" cy="{-MM * y + 0.0!r}" r="{5.0 * STROKE * size:.4g}"/>')
    for layer, circles in marks.items():
        lines += _group(layer, f'fill="none" stroke="#e8590c" stroke-width="{STROKE * size:.4g}"', circles)
    return "\n".join([*lines, "</svg>", ""])


def _group(layer: str, look: str, content: Iterable[str]) -> list[str]:
    head = f'  <g inkscape:groupmode="layer" inkscape:label={quoteattr(layer)} {look}>'
    return [head, *(f"    {line}" for line in content), "  </g>"]


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;")


def _path(loops: list[Loop]) -> Iterator[str]:
    """One path with all closed loops of a layer, so that holes stay empty; one for each open chain."""
    circles = [loop for loop in loops if loop.closed and not loop.hole and _is_disc(loop, loops)]
    for loop in circles:
        arc = loop.edges[0]
        assert isinstance(arc, Arc)
        yield f'<circle cx="{MM * arc.x!r}" cy="{-MM * arc.y + 0.0!r}" r="{MM * arc.radius!r}"/>'
    closed = [loop for loop in loops if loop.closed and loop not in circles]
    if closed:
        yield f'<path d="{" ".join(_commands(loop) for loop in closed)}"/>'
    for chain in loops:
        if not chain.closed:
            yield f'<path fill="none" d="{_commands(chain)}"/>'


def _is_disc(loop: Loop, loops: list[Loop]) -> bool:
    """A full circle on a layer without holes may be a circle element; with holes it must share their path."""
    edge = loop.edges[0]
    return len(loop.edges) == 1 and isinstance(edge, Arc) and edge.is_circle and not any(other.hole for other in loops)


def _commands(loop: Loop) -> str:
    """M, L, A and Z of one loop; holes run the other way, so that the non-zero rule leaves them empty."""
    words = [f"M {_xy(loop.edges[0].start)}"]
    for k, edge in enumerate(loop.edges):
        last = loop.closed and k == len(loop.edges) - 1
        if isinstance(edge, Line):
            words += [] if last else [f"L {_xy(edge.end)}"]
            continue
        parts = max(1, math.ceil(abs(edge.sweep) / (0.5 * math.pi) - 1e-9))
        radius, flag = MM * edge.radius, 0 if edge.sweep > 0.0 else 1  # mirrored: left turns become right turns
        for part in range(1, parts + 1):
            closing = last and part == parts
            end = loop.edges[0].start if closing else edge.point(part / parts)
            words.append(f"A {radius!r} {radius!r} 0 0 {flag} {_xy(end)}")
    return " ".join([*words, "Z"] if loop.closed else words)


def _xy(p: Point) -> str:
    return f"{MM * p[0]!r} {-MM * p[1] + 0.0!r}"
