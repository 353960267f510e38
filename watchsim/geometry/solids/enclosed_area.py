"""Which area do outlines enclose, as polygons?

Solids for other programs and overlaps of layers seen from above need plane regions; arcs become chords here. Nothing that
is computed exactly passes through this file.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import shapely

from watchsim.geometry.loop import Loop
from watchsim.geometry.polyline import polyline
from watchsim.geometry.solids.mass import area

Region = Any  # a shapely geometry of polygons


def region(loops: Iterable[Loop], deviation: float, scale: float = 1.0) -> Region:
    """The material of the closed loops (metres), chords within `deviation` metres of their arcs, times `scale`.

    Larger loops come first: a hole empties what is around it, an island in a hole is material again.
    """
    found: Region = shapely.Polygon()
    for loop in sorted((loop for loop in loops if loop.closed and loop.edges), key=lambda loop: -abs(area(loop))):
        shape = shapely.make_valid(shapely.Polygon(scale * polyline(loop, deviation)))
        found = found.difference(shape) if loop.hole else found.union(shape)
    return found


def pieces(found: Region) -> Iterator[Region]:
    """The polygons of a region that have an area."""
    parts = getattr(found, "geoms", [found])
    yield from (part for part in parts if part.geom_type == "Polygon" and part.area > 0.0)
