"""Which pairs of primitives do the contacts of a scene declare, and which of them can ever touch?

There are as many as the primitives of one side times those of the other. Only whole columns are worked on.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.reachable_pairs import Drawn, reachable
from watchsim.model.records import ARC, BODY_PAIR, CONTACT, CORNER, LAW, TANGENTIAL_CODE, Records, records
from watchsim.scene.carriers import Ride
from watchsim.scene.force import Side
from watchsim.scene.scene import Scene

Integers = NDArray[np.int64]


def declared_contacts(
    scene: Scene, hung: tuple[Ride, ...], sides: dict[Side, Integers], primitives: Records
) -> tuple[Records, Records, Records]:
    """Every declared pair (circle on A, line or arc on B), grouped by pair of bodies; the laws; the pairs of bodies."""
    laws = records(LAW, len(scene.contacts))
    found: dict[tuple[int, int], list[tuple[Integers, Integers, int]]] = {}
    number = {body.name: i for i, body in enumerate(scene.bodies)}
    for group, contact in enumerate(scene.contacts):
        # One write of a record instead of one for each of its fields.
        kind = TANGENTIAL_CODE[scene.tangential_law]
        laws[group] = (contact.friction, contact.restitution, contact.tangential_restitution, kind, scene.nu)
        first, last = (sides[side] for side in contact.sides)
        i, j = (hung[number[side.body]].part_of for side in contact.sides)
        found.setdefault((min(i, j), max(i, j)), []).append((*_touching(primitives, first, last), group))
    pairs = records(BODY_PAIR, len(found))
    blocks = [_ascending(parts, len(primitives), len(scene.contacts)) for parts in found.values()]
    ends = np.cumsum([len(a) for a, _, _ in blocks], dtype=np.int64)
    contacts = records(CONTACT, int(ends[-1]) if blocks else 0)
    if blocks:
        pairs.a, pairs.b = np.array(list(found)).T
        pairs.start, pairs.stop = np.append(0, ends[:-1]), ends
        contacts.a, contacts.b, contacts.group = (np.concatenate(parts) for parts in zip(*blocks, strict=True))
        _add_shapes(primitives, contacts)
    return contacts, laws, pairs


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


def _touching(primitives: Records, first: Integers, last: Integers) -> tuple[Integers, Integers]:
    """All pairs (circle, other) between two sets of primitives that have a gap function."""
    # Two convex arcs are one contact, not two: the rounder one plays the circle, of equal ones the first set's.
    a, b = _circles_and_edges(primitives, first, last, np.less_equal)
    c, d = _circles_and_edges(primitives, last, first, np.less)
    return np.concatenate([a, c]), np.concatenate([b, d])


def _circles_and_edges(
    primitives: Records, circles: Integers, edges: Integers, rounder: Callable[..., NDArray[np.bool_]]
) -> tuple[Integers, Integers]:
    """The pairs whose first plays the circle; of two convex arcs only where its radius is `rounder` than the other one's."""
    kind, radius, convex = primitives.kind, primitives.radius, primitives.side > 0.0
    circles = circles[(kind[circles] == CORNER) | ((kind[circles] == ARC) & convex[circles])]
    edges = edges[kind[edges] != CORNER]
    r, straight, arc = radius[circles][:, None], kind[edges] != ARC, (kind[circles] == ARC)[:, None]
    fits = straight | convex[edges] | (r < radius[edges])
    fits &= ~(arc & ~straight & convex[edges]) | rounder(r, radius[edges])
    row, column = np.nonzero(fits)
    return circles[row], edges[column]


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
