"""Which pieces of material do drawings hold, and about which points do they turn?

What is inserted as a block gets layers of its own, named after the block: scenes choose outlines by layer. A piece is an outer
outline with its holes; equal pieces that stand around a centre, such as single teeth, are one piece.
"""

from __future__ import annotations

import functools
import math
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.drawing.circles import circle_of
from watchsim.drawing.drawing import SNAP, Drawing
from watchsim.drawing.findings import Content, Finding, Inserted, Stroke
from watchsim.drawing.material import is_mark
from watchsim.drawing.read import FIT, assembled, read_content
from watchsim.geometry.loops import Loop, extents, winding
from watchsim.geometry.primitives import Arc, Line, Point
from watchsim.geometry.solids import area, section
from watchsim.mechanism.overlap import chord_points, material, placed
from watchsim.proposal.words import FIXED, part_of, part_word, shows_arbor, shows_pivot
from watchsim.units import known_unit

CROSSING = "crossing"  # the code of a finding
LIKELY = (0.5e-3, 1.0)  # m across: a drawing without units within these is taken to be in millimetres, else in inches


@dataclass(frozen=True)
class Mark:
    """A point, or a circle on a layer named for pivots; `layer` names it alone where `single`.

    Of a bore or an arbor `within` is the outline in which it lies; it says nothing about others drawn over it.
    """

    at: Point
    layer: str
    single: bool
    point: bool
    within: Loop | None = None


@dataclass(frozen=True)
class Source:
    """One drawing. `units` and `section` (m) are guesses where the file does not say; `blocks` names inserted blocks, by prefix
    of the layer."""

    path: Path
    drawing: Drawing
    units: str | None
    blocks: dict[str, str]
    marks: tuple[Mark, ...]
    section: float | None = None
    mended: tuple[str, ...] = ()  # what was closed so that its layer can be used
    marking: frozenset[str] = frozenset()  # layers that show pivots and hold no material

    @property
    def bad_layers(self) -> frozenset[str]:
        """Layers with faults that a scene would refuse, and that layers of their own for single outlines do not mend."""
        return self._with_errors() - self.crowded

    @property
    def crowded(self) -> frozenset[str]:
        """Layers on which outlines cross and nothing else is wrong: parts drawn over each other."""
        return self._with_errors() - self._with_errors(besides=CROSSING)

    def _with_errors(self, besides: str = "") -> frozenset[str]:
        errors = (f for f in self.drawing.findings if f.severity == "error" and f.code != besides)
        return frozenset(f.layer for f in errors if f.layer is not None)


def read_sources(paths: Sequence[Path]) -> list[Source]:
    """The drawings in some files. Those that do not say their unit have one and the same: what is likely of the largest."""
    found = [read_source(path) for path in paths]
    if len({source.units for source in found} - {None}) < 2:
        return found
    largest = max(
        (one for one in found if one.units), key=lambda one: size_of([one.drawing]) / known_unit(str(one.units)).factor
    )
    return [one if one.units in (None, largest.units) else read_source(one.path, largest.units) for one in found]


def read_source(path: Path, unit: str | None = None) -> Source:
    """The drawing in a file, in that unit where it does not say its own; whatever is wrong with it is among its findings."""
    ending = path.suffix.lower().lstrip(".")
    content = read_content(path, ending, None, FIT)
    units = None
    if content.strokes and content.units is None:
        units = unit or _likely_unit(content)
        content = read_content(path, ending, units, FIT)
    section = content.section if any(finding.code == "section-missing" for finding in content.findings) else None
    if section is not None:
        content = read_content(path, ending, units, FIT, section)
    blocks: dict[str, str] = {}
    if len(content.inserted) > 1:
        content, blocks = _by_blocks(content)
    drawing, mended = _mended(assembled(path, ending, lambda: content, SNAP))
    marks, marking = _marks(drawing)
    return Source(path, drawing, units, blocks, tuple(marks), section, tuple(mended), marking)


OPEN = "open-outline"  # the code of a finding
GAP = 0.05  # of what is drawn: an outline with a wider one is none


def _mended(drawing: Drawing) -> tuple[Drawing, list[str]]:
    """The drawing with open windows of its parts closed by a straight line, and which: nothing can touch them there.

    A gap in an outer outline may lie where something touches it, and stays a fault.
    """
    gaps = [(f, chain) for f in drawing.findings if f.code == OPEN and (chain := _chain_at(drawing, f)) is not None]
    closed: dict[int, Loop] = {}
    said: list[str] = []
    kept = list(drawing.findings)
    for finding, chain in gaps:
        start, end = chain.edges[0].start, chain.edges[-1].end
        around = [loop for loop in drawing.loops if loop.layer == chain.layer and not loop.hole]
        probes = [edge.point(share) for edge in chain.edges for share in (0.0, 0.5, 1.0)]
        within = any(all(winding(loop, probe) != 0 for probe in probes) for loop in around)
        if not within or math.dist(start, end) > GAP * chain.length:
            continue
        whole = Loop((*chain.edges, Line(*end, *start)), chain.layer)
        closed[id(chain)] = replace(whole if area(whole) < 0.0 else whole.reversed(), hole=True)
        kept.remove(finding)
        x, y = (1e3 * value for value in start)
        gap = f"open by {1e6 * math.dist(start, end):.3g} µm at ({x:.4g}, {y:.4g}) mm"
        said.append(
            f"an outline inside a part on layer {chain.layer} is {gap}; nothing touches it there, and it was closed by a "
            "straight line"
        )
    chains = tuple(chain for chain in drawing.open_chains if id(chain) not in closed)
    loops = (*drawing.loops, *closed.values())
    return (replace(drawing, loops=loops, open_chains=chains, findings=tuple(kept)) if closed else drawing), said


def _chain_at(drawing: Drawing, finding: Finding) -> Loop | None:
    """The open chain both ends of which a finding names."""
    if finding.x_mm is None or finding.y_mm is None or finding.other_mm is None:
        return None
    places = [(1e-3 * finding.x_mm, 1e-3 * finding.y_mm), (1e-3 * finding.other_mm[0], 1e-3 * finding.other_mm[1])]
    for chain in drawing.open_chains:
        ends = chain.edges[0].start, chain.edges[-1].end
        near = (math.dist(one, other) <= SNAP for way in (ends, ends[::-1]) for one, other in zip(way, places, strict=True))
        first, second, third, fourth = near
        if chain.layer == finding.layer and ((first and second) or (third and fourth)):
            return chain
    return None


def _likely_unit(content: Content) -> str:
    points = [stroke.edge.point(share) for stroke in content.strokes for share in (0.0, 0.25, 0.5, 0.75, 1.0)]
    across = max(max(column) - min(column) for column in zip(*points, strict=True))
    return "mm" if LIKELY[0] <= across <= LIKELY[1] else "inch"


def _by_blocks(content: Content) -> tuple[Content, dict[str, str]]:
    """The strokes of each inserted block on layers of their own; prefix of these layers -> block."""
    counts = Counter(one.block for one in content.inserted)
    seen: Counter[str] = Counter()
    named: list[tuple[Inserted, str]] = []
    for one in content.inserted:
        seen[one.block] += 1
        plain = one.block.replace("_", "-")
        named.append((one, plain if counts[one.block] == 1 else f"{plain}-{seen[one.block]}"))
    strokes = tuple(_renamed(stroke, named) for stroke in content.strokes)
    return replace(content, strokes=strokes), {prefix: one.block for one, prefix in named}


def _renamed(stroke: Stroke, named: Sequence[tuple[Inserted, str]]) -> Stroke:
    prefix = next((prefix for one, prefix in named if one.first <= stroke.run <= one.last), None)
    return stroke if prefix is None else replace(stroke, layer=prefix if stroke.layer == "0" else f"{prefix}_{stroke.layer}")


def _marks(drawing: Drawing) -> tuple[list[Mark], frozenset[str]]:
    """Points, and circles on layers called pivots, axes, bores or arbors; and their layers, which hold no material."""
    circles = [(loop, circle) for loop in drawing.loops if (circle := circle_of(loop)) is not None]
    shown = frozenset(loop.layer for loop, _ in circles if shows_pivot(loop.layer))
    shown -= {loop.layer for loop in drawing.loops if circle_of(loop) is None and not is_mark(loop.layer)}
    if shown >= {loop.layer for loop in drawing.loops}:
        shown = frozenset()
    on_layer = Counter([layer for layer, _, _ in drawing.points] + [loop.layer for loop, _ in circles])
    lines = {loop.layer for loop in drawing.loops}
    points = [Mark((x, y), name, on_layer[name] == 1 and name not in lines, True) for name, x, y in drawing.points]
    drawn = [
        Mark(circle.centre, loop.layer, on_layer[loop.layer] == 1, False) for loop, circle in circles if loop.layer in shown
    ]
    axes = [mark for mark in drawn if is_mark(mark.layer)]
    outlines = [loop for loop in drawing.loops if not loop.hole and loop.layer not in shown and part_of(loop.layer) != FIXED]
    taken = {_around(mark, outlines) for mark in points + axes}
    bores: dict[Loop, list[Mark]] = {}
    for mark in drawn:
        within = _around(mark, outlines)
        if mark not in axes and within is not None and within not in taken:
            bores.setdefault(within, []).append(replace(mark, within=within))
    middles = {loop: section((loop,)).centroid for loop in bores}
    central = [min(marks, key=lambda one: math.dist(one.at, middles[loop])) for loop, marks in bores.items()]
    # An arbor beside all that is drawn, as that of pallets without their arms, is no hole for a screw, as others are.
    loose = [one for one in drawn if one.single and one not in axes and shows_arbor(one.layer) and not _around(one, outlines)]
    return points + axes + central + loose, frozenset(mark.layer for mark in axes + central + loose)


def _around(mark: Mark, outlines: Sequence[Loop]) -> Loop | None:
    """The outline in which a mark lies: one about it, else the smallest; of the kind that its layer's name speaks of."""
    kind, word = part_of(mark.layer), part_word(mark.layer)
    fitting = [loop for loop in outlines if word and part_word(loop.layer) == word]
    fitting = fitting or [loop for loop in outlines if kind is None or part_of(loop.layer) in (kind, None)]
    sizes = {loop: abs(area(loop)) for loop in fitting if _is_in(mark.at, loop)}
    about = [loop for loop in sizes if math.dist(section((loop,)).centroid, mark.at) < BORED * math.sqrt(sizes[loop])]
    return min(about or sizes, key=sizes.__getitem__, default=None)


def _is_in(place: Point, loop: Loop) -> bool:
    """In the outline, or on it."""
    return winding(loop, place) != 0 or ring(chord_points(loop, DEVIATION * loop.length), place)[0] <= SAME


def size_of(drawings: Sequence[Drawing]) -> float:
    """How large everything together is, m."""
    box = extents(chain for drawing in drawings for chain in (*drawing.loops, *drawing.open_chains))
    return max(box[2] - box[0], box[3] - box[1]) if box else 0.0


Floats = NDArray[np.float64]
Region = Any  # a polygon, or several, of shapely
MOST = 400  # teeth
MISS = 6e-3  # of the radius: what teeth may fail to be alike, as where they are cut into a disc of thirty straight pieces
ROOTS = 0.4  # of their height: what lies below may be the straight pieces of a rim, which do not go with the teeth
ALIGNED = 0.1  # of a pitch, besides: with a quarter of a pitch any fold would do
RIM = np.linspace(0.0, math.tau, 361)
ROUND = 0.02  # of the radius: what differs less from a circle is a disc


@dataclass(frozen=True)
class Turned:
    """Turned by 1/fold of a turn about `centre` it lies on itself; `inner` and `outer` are its least and largest radius (m)."""

    fold: int
    centre: Point
    inner: float
    outer: float


def turned(loops: Sequence[Loop], rings: Sequence[Floats]) -> Turned | None:
    """Of closed outlines together, with their chords; None where they are a disc, or come back only after a whole turn.

    The centre of area of a wheel is its centre, whatever its teeth are like. No centre is known yet, and a tooth may have
    other edges than the next one: unlike `geometry.variation.fold` and `contact.symmetry` this compares areas.
    """
    centre = section(loops).centroid
    around = [points - np.array(centre) for points in rings]
    points = np.concatenate(around)
    radii = np.hypot(*points.T)
    outer = float(radii.max())
    if outer <= 0.0 or float(radii.min()) > (1.0 - ROUND) * outer:
        return None
    tip = points[int(radii.argmax())]
    floor = float(radii.min()) + ROOTS * (outer - float(radii.min()))
    rim = _region([floor * np.column_stack((np.cos(RIM), np.sin(RIM)))])
    teeth = _region(around).difference(rim)
    for fold in range(min(MOST, len(points)), 1, -1):
        angle = 2.0 * math.pi / fold
        miss = min(MISS, ALIGNED * angle) * outer
        # A turn by 1/60 brings a wheel of 59 teeth nearly onto itself; thirty such turns bring teeth into the gaps.
        turns = [angle * 2**k for k in range(fold.bit_length())]
        tips = (points - placed(tip[None], (0.0, 0.0, turn)) for turn in turns)
        if any(np.hypot(*apart.T).min() > miss for apart in tips):
            continue
        there = (_region([placed(ring, (0.0, 0.0, turn)) for ring in around]).difference(rim) for turn in turns)
        if all(one.hausdorff_distance(teeth) <= miss for one in there):
            return Turned(fold, centre, float(radii.min()), outer)
    return None


def united(parts: Iterable[Region]) -> Region:
    return functools.reduce(lambda one, other: one.union(other), parts)


def _region(rings: Sequence[Floats]) -> Region:
    return united(material([(points, False) for points in rings]))


DEVIATION = 2e-5  # of an outline's length: of chords from arcs
LEAST = 1e-7  # of the square of its length: a piece with less area has no material
ALIKE = 1e-3  # relative: areas and lengths of equal pieces
FEWEST = 5  # equal pieces around a centre


@dataclass(frozen=True, eq=False)
class Piece:
    """Outlines of one layer that hang together: outer ones, then their holes. `file` is the number of its drawing."""

    file: int
    layer: str
    loops: tuple[Loop, ...]

    @cached_property
    def area(self) -> float:
        """m²."""
        return abs(sum(area(loop) for loop in self.loops))

    @cached_property
    def points(self) -> Floats:
        """(n, 2) of all outer outlines, m."""
        return np.concatenate([points for points, hole in self.rings if not hole])

    @cached_property
    def rings(self) -> list[tuple[Floats, bool]]:
        deviation = DEVIATION * max(self.loops[0].length, 1e-6)
        return [(chord_points(loop, deviation), loop.hole) for loop in self.loops]

    @cached_property
    def region(self) -> Region:
        return united(material(self.rings))

    @cached_property
    def filled(self) -> Region:
        """The region without its holes."""
        return _region([points for points, hole in self.rings if not hole])

    @property
    def has_material(self) -> bool:
        """False of an outline that crosses itself so that nothing is left: two equal halves that run either way."""
        return min(self.area, float(self.region.area)) > LEAST * self.length**2

    @cached_property
    def centroid(self) -> Point:
        return section(self.loops).centroid

    @cached_property
    def turned(self) -> Turned | None:
        """By which part of a turn, about which centre, its outer outlines come back onto themselves; None of a disc."""
        return turned([loop for loop in self.loops if not loop.hole], [points for points, hole in self.rings if not hole])

    @cached_property
    def arcs(self) -> list[Arc]:
        """Its arcs, and the circles for which its polygons stand."""
        drawn = [edge for loop in self.loops for edge in loop.edges if isinstance(edge, Arc)]
        meant = [circle for loop in self.loops if (circle := circle_of(loop)) is not None and circle.sides]
        return drawn + [Arc(*circle.centre, circle.radius, 0.0, math.tau) for circle in meant]

    @cached_property
    def is_disc(self) -> bool:
        outer = [loop for loop in self.loops if not loop.hole]
        return len(outer) == 1 and circle_of(outer[0]) is not None

    @cached_property
    def length(self) -> float:
        return sum(loop.length for loop in self.loops)


def pieces_of(file: int, loops: Sequence[Loop], crowded: frozenset[str] = frozenset()) -> list[Piece]:
    """The pieces of closed outlines; layer by layer, in the order of the drawing.

    On `crowded` layers outlines cross: what is taken for a hole there, but leaves the outline around it, is a part of its own.
    """
    found: list[Piece] = []
    for layer in dict.fromkeys(loop.layer for loop in loops):
        own = [loop for loop in loops if loop.layer == layer and loop.closed]
        single = [Piece(file, layer, tuple(group)) for group in _with_holes(own, layer in crowded)]
        found += _around_a_centre([piece for piece in single if piece.has_material])
    return found


def _with_holes(loops: Sequence[Loop], crowded: bool) -> Iterator[list[Loop]]:
    outers = [loop for loop in loops if not loop.hole]
    groups: list[list[Loop]] = [[loop] for loop in outers]
    sizes = [abs(area(loop)) for loop in outers]
    for hole in (loop for loop in loops if loop.hole):
        place = hole.edges[0].point(0.5)
        around = [k for k, loop in enumerate(outers) if sizes[k] > abs(area(hole)) and winding(loop, place) != 0]
        within = min(around, key=lambda k: sizes[k], default=None)
        if within is None or (crowded and not _is_hole(hole, outers[within], loops)):
            groups.append([replace(hole.reversed(), hole=False)])
        else:
            groups[within].append(hole)
    yield from groups


def _is_hole(hole: Loop, outer: Loop, loops: Sequence[Loop]) -> bool:
    """Does it lie in the outline around it, and cross nothing else on its layer?"""
    inside, around = _filled(hole), _filled(outer)
    others = (_filled(loop) for loop in loops if loop is not hole and loop is not outer)
    return bool(around.covers(inside)) and not any(inside.boundary.crosses(other.boundary) for other in others)


def _filled(loop: Loop) -> Region:
    return _region([chord_points(loop, DEVIATION * loop.length)])


def _around_a_centre(pieces: Sequence[Piece]) -> list[Piece]:
    """The same, with equal pieces that stand around a centre put together."""
    classes: list[list[Piece]] = []
    for piece in pieces:
        alike = next((group for group in classes if _alike(piece, group[0])), None)
        if alike is None:
            classes.append([piece])
        else:
            alike.append(piece)
    found: list[Piece] = []
    for group in classes:
        loops = tuple(loop for piece in group for loop in piece.loops)
        whole = Piece(group[0].file, group[0].layer, loops)
        symmetry = whole.turned if len(group) >= FEWEST else None
        found += [whole] if symmetry is not None and symmetry.fold % len(group) == 0 else group
    return found


def _alike(one: Piece, other: Piece) -> bool:
    return math.isclose(one.area, other.area, rel_tol=ALIKE) and math.isclose(one.length, other.length, rel_tol=ALIKE)


SAME = 2e-6  # m: two centres this close are one, as in drawings with three decimals of a millimetre
SHARE = 0.1  # of a piece's outline must lie on arcs about a mark for these to name its centre
MANY, DEEP = 8, 0.65  # a wheel: so many teeth, or slots so deep (least by largest radius) that it is no nut and no square stone
DEEPER = 0.95  # of that of a nut with as many sides
BORED = 1e-3  # of its radius: a bore this close to the centre of a wheel's area is its centre, whatever facets do to the area
SURE, USUAL, WEAK, NONE = 3, 2, 1, 0  # how much a centre is worth


@dataclass(frozen=True)
class Centre:
    """A pivot: where, the mark that shows it, and why it is taken for one."""

    at: Point
    worth: int
    why: str
    mark: Mark | None = None

    def is_that_of(self, other: Centre) -> bool:
        return math.dist(self.at, other.at) <= SAME


def centre_of(piece: Piece, marks: Sequence[Mark]) -> Centre | None:
    """The centre that a piece shows: a mark with arcs about it, its own symmetry, the one mark in it, or its hole."""
    marks = [mark for mark in marks if mark.within is None or mark.within in piece.loops]
    shares = [(sum(arc.length for arc in piece.arcs if math.dist((arc.x, arc.y), mark.at) <= SAME), mark) for mark in marks]
    best = max(shares, key=lambda pair: pair[0], default=(0.0, None))
    symmetry = piece.turned
    if best[1] is not None and best[0] >= SHARE * piece.length:
        why = f"the drawing marks a point there, on layer {best[1].layer}, with arcs about it"
        return Centre(best[1].at, SURE, why, best[1])
    if symmetry is not None and is_toothed(symmetry):
        mark = next((one for one in marks if math.dist(one.at, symmetry.centre) <= SAME), None)
        hole = hole_of(piece)
        bored = hole is not None and math.dist(hole.at, symmetry.centre) <= BORED * symmetry.outer
        at = mark.at if mark is not None else hole.at if hole is not None and bored else symmetry.centre
        return Centre(at, SURE, f"the outline has {symmetry.fold}-fold rotational symmetry about it", mark)
    inside = [mark for mark in marks if holds(piece, mark.at) or ring(piece.points, mark.at)[0] <= SAME]
    if len(inside) == 1:
        why = f"the one point of layer {inside[0].layer} that lies in or on its outline"
        return Centre(inside[0].at, USUAL, why, inside[0])
    return None if marks else hole_of(piece)


def ring(points: Floats, centre: Point) -> tuple[float, float]:
    """The least and the largest distance of an outline from a point."""
    start, step = points[:-1] - np.array(centre), np.diff(points, axis=0)
    length = np.maximum((step**2).sum(axis=1), 1e-30)
    share = np.clip(-(start * step).sum(axis=1) / length, 0.0, 1.0)
    nearest = np.hypot(*(start + share[:, None] * step).T).min()
    return float(nearest), float(np.hypot(*(points - np.array(centre)).T).max())


def is_toothed(symmetry: Turned) -> bool:
    """Is it a wheel, with teeth or slots?"""
    deep = max(DEEP, DEEPER * math.cos(math.pi / symmetry.fold))
    return symmetry.fold >= MANY or (symmetry.fold >= 3 and symmetry.inner < deep * symmetry.outer)


def hole_of(piece: Piece) -> Centre | None:
    """The centre of the circular hole nearest to the centre of area."""
    circles = [circle for loop in piece.loops if loop.hole and (circle := circle_of(loop)) is not None]
    if not circles:
        return None
    nearest = min(circles, key=lambda circle: math.dist(circle.centre, piece.centroid))
    off = f", drawn as {nearest.sides} straight pieces, {1e6 * nearest.deviation:.3g} µm off" if nearest.sides else ""
    return Centre(nearest.centre, USUAL, f"the centre of its hole of radius {1e3 * nearest.radius:.4g} mm{off}")


def holds(piece: Piece, place: Point) -> bool:
    """Does an outer outline of the piece run round the place?"""
    return any(not loop.hole and winding(loop, place) != 0 for loop in piece.loops)
