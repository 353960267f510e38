"""How does a small SVG file look?"""

import numpy as np

from watchsim.drawing.drawing import Drawing
from watchsim.geometry.primitives import Arc, Edge, Line

XMLNS = 'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"'
INKSCAPE = 'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
MM = 'width="100mm" height="100mm" viewBox="0 0 100 100"'  # one user unit is one millimetre


def svg(content: str, page: str = MM) -> str:
    """A whole file."""
    return f"<svg {XMLNS} {INKSCAPE} {page}>{content}</svg>"


def path(d: str, more: str = "") -> str:
    return f'<path d="{d}" {more}/>'


def errors(drawing: Drawing) -> dict[str, str]:
    return {finding.code: finding.message for finding in drawing.findings if finding.severity == "error"}


def codes(drawing: Drawing) -> dict[str, str]:
    return {finding.code: finding.message for finding in drawing.findings}


def edges(drawing: Drawing) -> list[Edge]:
    return [edge for loop in (*drawing.loops, *drawing.open_chains) for edge in loop.edges]


def distances(points: np.ndarray, found: list[Edge]) -> np.ndarray:
    """From each point (n, 2), SVG's millimetres with y downwards, to the nearest edge; millimetres."""
    x, y = points[:, 0], -points[:, 1]
    nearest = np.full(len(points), np.inf)
    for edge in found:
        if isinstance(edge, Arc):
            cx, cy = 1e3 * edge.x, 1e3 * edge.y
            turn = np.remainder(np.sign(edge.sweep) * (np.arctan2(y - cy, x - cx) - edge.start_angle), 2 * np.pi)
            inside = turn <= abs(edge.sweep)
            apart = np.where(inside, np.abs(np.hypot(x - cx, y - cy) - 1e3 * edge.radius), np.inf)
            ends = [edge.start, edge.end]
        else:
            assert isinstance(edge, Line)
            ax, ay, bx, by = (1e3 * v for v in (edge.x0, edge.y0, edge.x1, edge.y1))
            square = (bx - ax) ** 2 + (by - ay) ** 2 or 1.0  # a line without length is a point
            share = np.clip(((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / square, 0.0, 1.0)
            apart = np.hypot(x - ax - share * (bx - ax), y - ay - share * (by - ay))
            ends = []
        for ex, ey in ends:
            apart = np.minimum(apart, np.hypot(x - 1e3 * ex, y - 1e3 * ey))
        nearest = np.minimum(nearest, apart)
    return nearest
