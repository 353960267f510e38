"""Are the declared contacts those that two loops over all primitives find, in the same order and with the same bits?"""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest
from reference.cam import Piece
from simulation.cam_scenes import ECCENTRIC, cam_scene
from simulation.moving_scenes import profile

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Line, moved
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model.records import ARC, CORNER, LINE
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene

TWO_PIECES = (Piece(0.2e-3, 0.05e-3, 1.1e-3, 0.0, math.pi), Piece(0.2e-3, 0.05e-3, 1.1e-3, math.pi, 2.0 * math.pi))


def gear(teeth: int, arcs: int, radius: float, layer: str) -> Loop:
    """Teeth whose flanks are hollow and round by turns, cut into arcs of their own radii, with flat tops and roots."""
    step = 2.0 * math.pi / teeth
    edges: list[Arc | Line] = []
    for k in range(teeth):
        root, top = radius, 1.3 * radius
        x, y, reach = root, 0.0, 0.4 * step * root / arcs
        for i in range(arcs):
            sweep = 1.0 if i % 2 == 0 else -1.0
            r = reach * (1.0 + 0.1 * i)
            edges.append(moved(Arc(x - r, y, r, 0.0, sweep), k * step, (0.0, 0.0)))
            x, y = x - r + r * math.cos(sweep), y + r * math.sin(sweep)
        edges.append(moved(Line(x, y, top * math.cos(0.5 * step), top * math.sin(0.5 * step)), k * step, (0.0, 0.0)))
        end = (root * math.cos(step), root * math.sin(step))
        edges.append(moved(Line(top * math.cos(0.5 * step), top * math.sin(0.5 * step), *end), k * step, (0.0, 0.0)))
    return Loop(tuple(edges), layer)


def gears(twice: bool) -> Scene:
    """Two of them; `twice`: contacts of some layers are declared again by others, in another order of the bodies."""
    small = Body("small", "pivot", (4e-3, 0.0), 0.3, inertia=1e-9, loops=(gear(6, 3, 1e-3, "T"), gear(6, 2, 0.8e-3, "S")))
    large = Body("large", "pivot", inertia=1e-9, loops=(gear(15, 4, 2e-3, "T"),))
    contacts = [Contact((Side("small"), Side("large")), 0.1, 0.2)]
    if twice:
        contacts += [Contact((Side("large", "T"), Side("small", "S")), 0.3, 0.0), Contact((Side("small", "T"), Side("large")))]
    return Scene("gears", (small, large), contacts=tuple(contacts))


SCENES: dict[str, Callable[[], Scene]] = {
    "swiss lever": lambda: profile("swiss_lever"),
    "bench lever": lambda: profile("bench_lever"),
    "carriage": lambda: profile("carriage"),
    "cam": lambda: cam_scene(ECCENTRIC, 40, 1.0),
    "cam of two": lambda: cam_scene(TWO_PIECES, 7, 1.0),
    "gears": lambda: gears(False),
    "gears declared twice": lambda: gears(True),
}


def sides(scene: Scene, compiled: Compiled, side: Side) -> list[int]:
    layers = scene.body(side.body).layers if side.layer is None else (side.layer,)
    named = zip(compiled.owners, compiled.layers, strict=True)
    return [i for i, (owner, layer) in enumerate(named) if owner == side.body and layer in layers]


def plays_circle(rows: list[dict[str, float]], a: int, b: int, first: bool) -> bool:
    """Does primitive a, of the first side or not, play the circle against b?"""
    one, two = rows[a], rows[b]
    if one["kind"] == LINE or (one["kind"] == ARC and one["side"] < 0.0) or two["kind"] == CORNER:
        return False
    if two["kind"] == LINE:
        return True
    if two["side"] < 0.0:
        return one["radius"] < two["radius"]
    if one["kind"] == CORNER:
        return True
    return one["radius"] <= two["radius"] if first else one["radius"] < two["radius"]


@pytest.mark.parametrize("name", SCENES)
def test_contacts_are_those_of_two_loops(name: str) -> None:
    scene = SCENES[name]()
    compiled = compile_scene(scene)
    model = compiled.model
    fields = ("kind", "side", "radius", "body")
    rows = [dict(zip(fields, row, strict=True)) for row in zip(*(model.primitives[f].tolist() for f in fields), strict=True)]
    by_bodies: dict[tuple[int, int], set[tuple[int, int, int]]] = {}
    for group, contact in enumerate(scene.contacts):
        first, last = (sides(scene, compiled, side) for side in contact.sides)
        key = tuple(sorted((rows[first[0]]["body"], rows[last[0]]["body"])))
        found = by_bodies.setdefault(key, set())
        found |= {(a, b, group) for a in first for b in last if plays_circle(rows, a, b, True)}
        found |= {(a, b, group) for a in last for b in first if plays_circle(rows, a, b, False)}
    expected = [contact for found in by_bodies.values() for contact in sorted(found)]
    contacts = model.contacts
    assert list(zip(contacts.a.tolist(), contacts.b.tolist(), contacts.group.tolist(), strict=True)) == expected
    assert len(expected) >= 14
    ends = [(a, b, start, stop) for a, b, start, stop in model.pairs[["a", "b", "start", "stop"]].tolist()]
    count = 0
    for (bodies, found), end in zip(by_bodies.items(), ends, strict=True):
        assert end == (*bodies, count, count + len(found))
        count += len(found)
    for (a, b, _), curvature, reduced in zip(expected, contacts.curvature.tolist(), contacts.reduced.tolist(), strict=True):
        r, big, side = rows[a]["radius"], rows[b]["radius"], rows[b]["side"]
        if rows[b]["kind"] == LINE:
            assert (curvature, reduced) == (0.0, r)
        else:
            assert (curvature, reduced) == (side / (big + side * r), r * big / (big + side * r))


def test_no_contact_is_no_fault() -> None:
    compiled = compile_scene(Scene("bare", (Body("wheel", "pivot", inertia=1.0, loops=(gear(5, 2, 1e-3, "T"),)),)))
    assert [len(part) for part in (compiled.model.contacts, compiled.model.pairs, compiled.model.near)] == [0, 0, 0]
