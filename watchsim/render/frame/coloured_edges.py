"""How are some edges of a scene picked out in colour?"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.path import Path
from numpy.typing import NDArray

from watchsim.candidates.chords import chords
from watchsim.model.records import Model

Array = NDArray[np.float64]
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
    lines = [drawn.points[first:last] for first, last in zip(drawn.first[:-1], drawn.first[1:], strict=True)]
    lines = [line if len(line) > 1 else np.stack([line[0], line[0] + np.array([deviation, 0.0])]) for line in lines]
    codes = np.full(sum(map(len, lines)), Path.LINETO, Path.code_type)
    codes[np.cumsum([0, *map(len, lines[:-1])])] = Path.MOVETO
    return Path(np.concatenate(lines), codes)
