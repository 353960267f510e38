"""Which pairs of primitives do the contacts of a scene declare, and which of them can ever touch?

There are as many as the primitives of one side times those of the other. Only whole columns are worked on.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.broad_phase import Drawn, reach, reachable
from watchsim.contact.cell_frames import choose_frames
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line, Point, middle
from watchsim.model import (
    ARC,
    BODY_PAIR,
    CONTACT,
    CORNER,
    FULL,
    LAW,
    LINE,
    LINE_SPRING,
    PART,
    PRIMITIVE,
    TANGENTIAL_CODE,
    Records,
    records,
)
from watchsim.scene.forces import Side
from watchsim.scene.scene import Scene
from watchsim.scene.trains import Bond, Ride
from watchsim.tolerances import JOINT_RESOLUTION

# Which primitives of an outline can touch something?
#
# Every edge; and every convex corner, as an arc of radius 0 whose fan of normals fills the turn between its neighbours.

FLAT = 8.0  # of the size: for larger radii than that the centre's rounding would show on the outline


def features(loop: Loop, body: int, size: float) -> Records:
    """Primitive records of one outline (metres, body frame). `size` turns the angles of corners into lengths.

    Edges shorter than a joint's tolerance have no primitive; their neighbours reach across.
    """
    edges = _watertight(loop, JOINT_RESOLUTION * size)
    rows = [_line(edge) if isinstance(edge, Line) else _arc(edge, size) for edge in edges]
    count = len(edges)
    for i in range(count if loop.closed else count - 1):
        j = (i + 1) % count
        turn = _turn(edges[i], edges[j], size)
        if turn > 0.0:
            corner = len(rows)
            rows.append(_corner(edges[i], edges[j], turn, size))
            if _parts_from_corner(edges[i]):
                rows[i]["after"], rows[corner]["before"] = corner, i
            if _parts_from_corner(edges[j]):
                rows[corner]["after"], rows[j]["before"] = j, corner
        elif turn == 0.0 and i != j and not (_is_hollow(edges[i]) or _is_hollow(edges[j])):
            rows[i]["after"], rows[j]["before"] = j, i
    empty = {**dict.fromkeys(PRIMITIVE.names or (), 0), "body": body, "before": -1, "after": -1}
    # Whole rows at once: writing one field of a record takes microseconds.
    return np.array([tuple({**empty, **row}.values()) for row in rows], PRIMITIVE).view(np.recarray)


def _watertight(loop: Loop, joint: float) -> list[Edge]:
    """The edges with length, and a short line wherever one does not start where the last one ends."""
    kept = [edge for edge in loop.edges if edge.length > joint]
    edges: list[Edge] = []
    for i, edge in enumerate(kept):
        edges.append(edge)
        if i == len(kept) - 1 and not loop.closed:
            break
        following = kept[(i + 1) % len(kept)]
        if math.dist(edge.end, following.start) > joint:
            edges.append(Line(*edge.end, *following.start))
    return edges


def _line(edge: Line) -> dict[str, float]:
    tx, ty = edge.tangent(0.0)
    point = {"x": edge.x0, "y": edge.y0, "px": edge.x0, "py": edge.y0}
    return {"kind": LINE, **point, "tx": tx, "ty": ty, "nx": ty, "ny": -tx, "length": edge.length}


def _arc(edge: Arc, size: float) -> dict[str, float]:
    side = 1.0 if edge.sweep > 0.0 else -1.0
    px, py, c, s = middle(edge, exact=edge.radius > FLAT * size)
    half = 0.5 * min(abs(edge.sweep), 2.0 * math.pi)
    fan = {"nx": side * c, "ny": side * s, "half_cos": math.cos(half), "half_sin": math.sin(half)}
    extent = FULL if edge.is_circle else PART
    return {
        "kind": ARC,
        "x": edge.x,
        "y": edge.y,
        "px": px,
        "py": py,
        "radius": edge.radius,
        "side": side,
        "extent": extent,
        **fan,
    }


def _direction(angle: float) -> Point:
    return math.cos(angle), math.sin(angle)


def _turn(before: Edge, after: Edge, size: float) -> float:
    """The angle by which the outline turns between two edges, positive at convex corners; 0 where they join smoothly."""
    (ax, ay), (bx, by) = before.tangent(1.0), after.tangent(0.0)
    turn = math.atan2(ax * by - ay * bx, ax * bx + ay * by)
    # A turn that no contact would notice: normals of a flat arc notice less.
    flattest = max(size, *(edge.radius for edge in (before, after) if isinstance(edge, Arc)), 0.0)
    return turn if abs(turn) * flattest >= JOINT_RESOLUTION * size else 0.0


def _is_hollow(edge: Edge) -> bool:
    return isinstance(edge, Arc) and edge.sweep < 0.0


def _parts_from_corner(edge: Edge) -> bool:
    """True if what touches the corner at the edge's end never touches the edge too: all but hollows of over half a turn."""
    return not (isinstance(edge, Arc) and edge.sweep < -math.pi)


def _corner(before: Edge, after: Edge, turn: float, size: float) -> dict[str, float]:
    """The corner between two edges, at which the outline turns by `turn`."""
    ax, ay = before.tangent(1.0)
    # Normals are tangents turned by -90 degrees; the fan fills the turn from the one before to the one after.
    nx, ny = _direction(math.atan2(ay, ax) - 0.5 * math.pi + 0.5 * turn)
    fan = {"nx": nx, "ny": ny, "half_cos": math.cos(0.5 * turn), "half_sin": math.sin(0.5 * turn), "extent": PART}
    x, y = after.start
    return {"kind": CORNER, "x": x, "y": y, "px": x, "py": y, "length": size, "side": 1.0, **fan}


# How many pairs of primitives of two bodies have to be looked at?

HEADINGS = {"declared": "declared", "reachable": "can ever touch", "typical": "candidates at a time"}


class PairCount(NamedTuple):
    """Numbers of pairs of primitives between two bodies."""

    bodies: tuple[str, str]
    declared: int
    reachable: int  # at any pose
    typical: int  # candidates: the median over the cells of configuration space around the start position
    most: int  # the largest number there
    start: int  # in the cell of the start position itself

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {**self._asdict(), "bodies": list(self.bodies)}


def pairs_entry(counts: Sequence[PairCount]) -> dict[str, Any]:
    """The `pairs` of `check --json`: sums, and the numbers `between` two bodies."""
    sums = {name: sum(getattr(count, name) for count in counts) for name in HEADINGS}
    return {**sums, "between": [count.as_dict() for count in counts]}


def pair_lines(entry: Mapping[str, Any]) -> Iterator[str]:
    """The same as a table for people, in which only two pairs of bodies or more need a sum."""
    rows = [(" - ".join(count["bodies"]), count) for count in entry["between"]]
    if not rows:
        yield "pairs of edges and corners: no contact is declared"
        return
    rows += [("together", entry)] if len(rows) > 1 else []
    title = "pairs of edges and corners"
    width = max(len(title), *(2 + len(name) for name, _ in rows))
    yield f"{title:{width}}" + "".join(f"   {heading}" for heading in HEADINGS.values())
    for name, numbers in rows:
        cells = (f"   {numbers[key]:>{len(heading)},}" for key, heading in HEADINGS.items())
        yield f"{'  ' + name:{width}}" + "".join(cells)


# How do the springs between points of bodies become records, and which coordinates do they hold how stiffly?

MOVEMENT = -1


def line_springs(scene: Scene) -> Records:
    """A record for each."""
    numbers = {body.name: i for i, body in enumerate(scene.bodies)}
    rows = records(LINE_SPRING, len(scene.line_springs))
    for row, spring in zip(rows, scene.line_springs, strict=True):
        first, second = spring.between
        row.a, row.b = numbers[first], MOVEMENT if second is None else numbers[second]
        (row.xa, row.ya), (row.xb, row.yb) = spring.points
        row.stiffness, row.length, row.viscous = spring.stiffness, spring.length, spring.viscous
    return rows


def coordinates_of_lines(
    scene: Scene, lines: Records, slices: dict[str, slice], bound: tuple[Bond, ...]
) -> list[tuple[int, float]]:
    """(coordinate, most stiffness that a line spring gives it) for each end on a body that moves."""
    found = []
    for line in lines:
        for b, x, y in ((int(line.a), line.xa, line.ya), (int(line.b), line.xb, line.yb)):
            if b == MOVEMENT or scene.bodies[b].motion == "fixed":
                continue
            part = slices[scene.bodies[bound[b].to].name]
            turns = scene.bodies[b].motion in ("pivot", "free")
            arm = bound[b].ratio * (math.hypot(x, y) if turns else 1.0)
            found += [
                (k, float(line.stiffness) * (arm if k == part.stop - 1 else 1.0) ** 2) for k in range(part.start, part.stop)
            ]
    return found


Integers = NDArray[np.int64]


MOST_LISTED = 4_000_000  # pairs of primitives of one contact; of more, only those are listed that come near each other
SLAB = 1 << 22  # pairs of primitives that are looked at together
Near = Callable[[Integers, Integers], NDArray[np.bool_]]  # of primitives by their numbers, broadcast


class Declared(NamedTuple):
    """What the contacts of a scene declare; `counts`: how many pairs of primitives of each pair of bodies, listed or not."""

    contacts: Records
    laws: Records
    pairs: Records
    counts: tuple[int, ...]


def declared_contacts(
    scene: Scene, bodies: Records, riding: tuple[Ride, ...], sides: dict[Side, Integers], primitives: Records, clearance: float
) -> Declared:
    """Every declared pair (circle on A, line or arc on B), grouped by pair of bodies; the laws; the pairs of bodies.

    Outlines of thousands of edges declare tens of millions: of so many only those that could come near each other are listed.
    """
    laws = records(LAW, len(scene.contacts))
    found: dict[tuple[int, int], list[tuple[Integers, Integers, int]]] = {}
    number = {body.name: i for i, body in enumerate(scene.bodies)}
    for group, contact in enumerate(scene.contacts):
        # One write of a record instead of one for each of its fields.
        kind = TANGENTIAL_CODE[scene.tangential_law]
        slip = (contact.slip.drop, contact.slip.decay, contact.slip.rise)
        laws[group] = (contact.friction, *slip, contact.restitution, contact.tangential_restitution, kind, scene.nu)
        first, last = (sides[side] for side in contact.sides)
        i, j = (riding[number[side.body]].part_of for side in contact.sides)
        found.setdefault((min(i, j), max(i, j)), []).append((first, last, group))
    pairs = records(BODY_PAIR, len(found))
    if not found:
        return Declared(records(CONTACT, 0), laws, pairs, ())
    pairs.a, pairs.b = np.array(list(found)).T
    pairs.clearance = clearance
    choose_frames(bodies, pairs)
    blocks, counts = [], []
    for pair, named in zip(pairs, found.values(), strict=True):
        parts, count = [], 0
        for first, last, group in named:
            near = _near(bodies, primitives, pair, first, last) if len(first) * len(last) > MOST_LISTED else None
            a, b, declared = _touching(primitives, first, last, near)
            parts.append((a, b, group))
            count += declared
        blocks.append(_ascending(parts, len(primitives), len(scene.contacts)))
        counts.append(count)
    ends = np.cumsum([len(a) for a, _, _ in blocks], dtype=np.int64)
    contacts = records(CONTACT, int(ends[-1]))
    pairs.start, pairs.stop = np.append(0, ends[:-1]), ends
    contacts.a, contacts.b, contacts.group = (np.concatenate(parts) for parts in zip(*blocks, strict=True))
    _add_shapes(primitives, contacts)
    return Declared(contacts, laws, pairs, tuple(counts))


def _near(bodies: Records, primitives: Records, pair: Any, first: Integers, last: Integers) -> Near:
    """Can two primitives of two sides come within twice the pair's clearance at any pose? Twice: what `near_contacts` takes,
    and what symmetry makes of it, is then listed whatever the rounding."""
    on_a = primitives.body == pair.a
    rows = (first, last) if on_a[first[0]] else (last, first)
    meet = reach(bodies, primitives, pair, rows, 2.0 * float(pair.clearance), {})
    place = np.zeros(len(primitives), np.int64)
    for part in rows:
        place[part] = np.arange(len(part))

    def near(circles: Integers, edges: Integers) -> NDArray[np.bool_]:
        one, two = (circles, edges) if on_a[circles.flat[0]] else (edges, circles)
        return meet(place[one], place[two])

    return near


def _ascending(
    parts: list[tuple[Integers, Integers, int]], primitives: int, groups: int
) -> tuple[Integers, Integers, Integers]:
    """a, b and group of all contacts of one pair of bodies, sorted by a, b and group, each once."""
    a, b = (np.concatenate(columns) for columns in list(zip(*parts, strict=True))[:2])
    group = np.concatenate([np.full(len(part[0]), part[2]) for part in parts])
    name = (a * primitives + b) * groups + group
    if not (name[1:] > name[:-1]).all():
        _, rows = np.unique(name, return_index=True)
        a, b, group = a[rows], b[rows], group[rows]
    return a, b, group


def _add_shapes(primitives: Records, contacts: Records) -> None:
    """Curvature of B's curve with A's radius added to it, and the reduced radius of the two."""
    own, met = np.array(primitives.radius), contacts.b
    radius, side = own[contacts.a], np.array(primitives.side)[met]
    arcs = (primitives.kind == ARC)[met]
    total = np.where(arcs, own[met] + side * radius, 1.0)
    contacts.curvature = np.where(arcs, side / total, 0.0)
    contacts.reduced = np.where(arcs, radius * own[met] / total, radius)


def _touching(primitives: Records, first: Integers, last: Integers, near: Near | None) -> tuple[Integers, Integers, int]:
    """All pairs (circle, other) between two sets of primitives that have a gap function, of these those that are `near` each
    other; and how many there are."""
    # Two convex arcs are one contact, not two: the rounder one plays the circle, of equal ones the first set's.
    a, b, some = _circles_and_edges(primitives, first, last, np.less_equal, near)
    c, d, others = _circles_and_edges(primitives, last, first, np.less, near)
    return np.concatenate([a, c]), np.concatenate([b, d]), some + others


def _circles_and_edges(
    primitives: Records, circles: Integers, edges: Integers, rounder: Callable[..., NDArray[np.bool_]], near: Near | None
) -> tuple[Integers, Integers, int]:
    """The pairs whose first plays the circle; of two convex arcs only where its radius is `rounder` than the other one's."""
    kind, radius, convex = primitives.kind, primitives.radius, primitives.side > 0.0
    circles = circles[(kind[circles] == CORNER) | ((kind[circles] == ARC) & convex[circles])]
    edges = edges[kind[edges] != CORNER]
    straight, found, count = kind[edges] != ARC, [(circles[:0], edges[:0])], 0
    for part in np.split(circles, range(step := max(1, SLAB // max(1, len(edges))), len(circles), step)):
        r, arc = radius[part][:, None], (kind[part] == ARC)[:, None]
        fits = straight | convex[edges] | (r < radius[edges])
        fits &= ~(arc & ~straight & convex[edges]) | rounder(r, radius[edges])
        count += int(np.count_nonzero(fits))
        if near is not None and fits.size:
            fits &= near(part[:, None], edges[None, :])
        row, column = np.nonzero(fits)
        found.append((part[row], edges[column]))
    a, b = (np.concatenate(columns) for columns in zip(*found, strict=True))
    return a, b, count


def near_contacts(bodies: Records, primitives: Records, contacts: Records, pairs: Records) -> Integers:
    """The contacts that can ever touch, by pair of bodies."""
    found = [np.zeros(0, np.int64)]
    count = 0
    drawn: Drawn = {}
    for pair in pairs:
        ids = np.flatnonzero(reachable(bodies, primitives, contacts, pair, drawn)) + pair.start
        pair.near_start, pair.near_stop = count, count + len(ids)
        count += len(ids)
        found.append(ids)
    return np.concatenate(found)
