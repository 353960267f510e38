"""Which edges hang together, by the plainest rule?

Everything whose ends lie within a reach of each other is one component, on whatever layer; doubles are kept. A component is a
loop where exactly two edges meet everywhere, an open chain where only its two ends are free, and branched otherwise. Areas
by Green's formula edge by edge, from the origin, gaps left open.
"""

import math
from collections import defaultdict
from collections.abc import Sequence
from itertools import product
from typing import NamedTuple

from watchsim.geometry.primitives import Arc, Edge

Point = tuple[float, float]


class Component(NamedTuple):
    kind: str  # "loop", "chain", "branched" or "double": one line drawn there and back
    edges: list[Edge]
    area: float
    gaps: float  # the area that closing its gaps by straight lines would add


def components(edges: Sequence[Edge], reach: float) -> list[Component]:
    places = Places(reach)
    others = [e for e in edges if e.length > 0.0]
    ends = [(places.number(e.start), places.number(e.end)) for e in others]
    at: dict[int, list[int]] = defaultdict(list)
    for number, pair in enumerate(ends):
        for node in pair:
            at[node].append(number)
    found: list[Component] = []
    left = set(range(len(others)))
    while left:
        members = hanging_together(min(left), ends, at)
        left.difference_update(members)
        degrees = [len(at[node]) for number in members for node in ends[number]]
        kind = "branched" if max(degrees) > 2 else "chain" if min(degrees) == 1 else "loop"
        double = kind == "loop" and len(members) == 2 and not any(isinstance(others[m], Arc) for m in members)
        row = walk(members, ends, at, others) if kind == "loop" else [others[m] for m in members]
        found.append(component("double" if double else kind, row))
    return found


class Places:
    """Points, of which those within a reach of each other are one."""

    def __init__(self, reach: float) -> None:
        self.reach = reach
        self.points: list[Point] = []
        self.cells: dict[tuple[int, int], list[int]] = defaultdict(list)

    def number(self, p: Point) -> int:
        x, y = (math.floor(c / self.reach) for c in p)
        for cell in product((x - 1, x, x + 1), (y - 1, y, y + 1)):
            for k in self.cells[cell]:
                if math.dist(self.points[k], p) <= self.reach:
                    return k
        self.points.append(p)
        self.cells[(x, y)].append(len(self.points) - 1)
        return len(self.points) - 1


def hanging_together(first: int, ends: list[tuple[int, int]], at: dict[int, list[int]]) -> list[int]:
    """The edges that can be reached from one of them."""
    members, seen, ahead = [], {first}, [first]
    while ahead:
        number = ahead.pop()
        members.append(number)
        for node in ends[number]:
            ahead += [n for n in at[node] if n not in seen]
            seen.update(at[node])
    return members


def walk(members: list[int], ends: list[tuple[int, int]], at: dict[int, list[int]], edges: Sequence[Edge]) -> list[Edge]:
    """The edges of a loop in travel order and direction."""
    number, node = members[0], ends[members[0]][1]
    result, left = [edges[number]], set(members[1:])
    while left:
        number = next(n for n in at[node] if n in left)
        left.discard(number)
        forward = ends[number][0] == node
        node = ends[number][1] if forward else ends[number][0]
        result.append(edges[number] if forward else edges[number].reversed())
    return result


def component(kind: str, edges: list[Edge]) -> Component:
    if kind not in ("loop", "double"):
        return Component(kind, edges, 0.0, 0.0)
    area = math.fsum(swept(edge) for edge in edges)
    pairs = zip(edges, [*edges[1:], edges[0]], strict=True)
    gaps = math.fsum(0.5 * (a.end[0] * b.start[1] - a.end[1] * b.start[0]) for a, b in pairs)
    side = math.copysign(1.0, area)
    return Component(kind, edges, abs(area), side * gaps)


def swept(edge: Edge) -> float:
    """Half the integral of x dy - y dx along the edge."""
    (x0, y0), (x1, y1) = edge.start, edge.end
    if not isinstance(edge, Arc):
        return 0.5 * (x0 * y1 - y0 * x1)
    a, b = edge.start_angle, edge.start_angle + edge.sweep
    turn = edge.x * (math.sin(b) - math.sin(a)) - edge.y * (math.cos(b) - math.cos(a))
    return 0.5 * edge.radius * (edge.radius * edge.sweep + turn)
