"""What are the outlines of a remontoir's stop wheel and stop lever?

Six pointed teeth, by default; pallets to the left of the lever's pivot, to its right a fork that holds the eccentric disc.
"""

from __future__ import annotations

import math

from watchsim.construction.design import Impossible
from watchsim.construction.outline import arc_between, circle, polar, rounded
from watchsim.construction.remontoir.remontoir_dimensions import Remontoir
from watchsim.construction.remontoir.remontoir_proportions import half_span, locking_radius
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line, Point

CORE, BORE, THICK = 8.0 / 15.0, 0.1, 2.0 / 15.0  # of the stop wheel's radius; thickness of a pallet
LEAN, BACK, REACH = 20.0, 45.0, 25.0  # degrees: front from the radius; foot of the back behind the tip; length of a pallet
PRONG, WALL = 1.75, 0.545  # of the disc's radius: half the length of a prong, its thickness
HUB, ROOT = 0.15, 0.3  # mm by an arm of 4.5 mm: half the beam, and how far it reaches behind the pivot


def stop_wheel(values: Remontoir) -> list[Loop]:
    """Pointed teeth that turn counter-clockwise, and the bore."""
    tip, core, pitch = values.stop_radius, CORE * values.stop_radius, 360.0 / values.stop_teeth
    lean = math.radians(LEAN)
    along = tip * math.cos(lean) - math.sqrt(core**2 - (tip * math.sin(lean)) ** 2)  # length of the front, down to the core
    front = math.degrees(math.atan2(-along * math.sin(lean), tip - along * math.cos(lean)))
    if front >= pitch - BACK:
        raise Impossible("stop_teeth", "are too many: they would overlap at their feet")
    edges: list[Edge] = []
    for turn in (pitch * i for i in range(values.stop_teeth)):
        foot, head, heel = polar(core, turn - BACK), polar(tip, turn), polar(core, turn + front)
        next_foot = polar(core, turn + pitch - BACK)
        edges += [Line(*foot, *head), Line(*head, *heel), arc_between(heel, next_foot, (0.0, 0.0), True)]
    return [Loop(tuple(edges), "TEETH"), circle("TEETH", (0.0, 0.0), BORE * tip, hole=True)]


def stop_lever(values: Remontoir) -> list[Loop]:
    """Pallets and fork; what holds them together touches nothing."""
    lock, radius, thick = values.stop_lock, locking_radius(values), THICK * values.stop_radius
    upper, lower = 90.0 + half_span(values), 270.0 - half_span(values)
    exit_ = _pallet(radius, radius + thick, upper + lock - REACH, upper + lock)
    entry = _pallet(radius - thick, radius, lower - lock, lower - lock + REACH)
    return [exit_, entry, _prong(values, 1), _prong(values, -1), *_arms(values, radius, upper, lower)]


def _pallet(inner: float, outer: float, first: float, last: float) -> Loop:
    """A sector of a ring about the pivot, mm and degrees."""
    a, b, c, d = polar(inner, first), polar(outer, first), polar(outer, last), polar(inner, last)
    edges = (Line(*a, *b), arc_between(b, c, (0.0, 0.0), True), Line(*c, *d), arc_between(d, a, (0.0, 0.0), False))
    return Loop(edges, "PALLETS")


def _prong(values: Remontoir, side: int) -> Loop:
    near, far = _slot(values), _outside(values)
    left, right = values.arm - PRONG * values.disc, values.arm + PRONG * values.disc
    return _polygon("FORK", [(left, side * near), (right, side * near), (right, side * far), (left, side * far)][::side])


def _arms(values: Remontoir, radius: float, upper: float, lower: float) -> tuple[Loop, ...]:
    hub, root = (share * values.arm / 4.5 for share in (HUB, ROOT))
    far, fork = _outside(values), values.arm - PRONG * values.disc
    neck, half = fork - PRONG * values.disc * 3.0 / 7.0, 0.5 * THICK * values.stop_radius
    beam = [(-root, -hub), (neck, -hub), (fork, -far), (fork, far), (neck, hub), (-root, hub)]
    above = [polar(radius - half, upper - 23.0), polar(hub, 60.0), polar(hub, 180.0), polar(radius + half, upper - 15.0)]
    below = [polar(radius - half, lower + 15.0), polar(hub, 180.0), polar(hub, 300.0), polar(radius - half, lower + 23.0)]
    return _polygon("ARM", beam), _polygon("UPPER", above), _polygon("LOWER", below)


def _slot(values: Remontoir) -> float:
    """Half of its width."""
    return values.disc + values.slot_play / 2.0


def _outside(values: Remontoir) -> float:
    return _slot(values) + WALL * values.disc


def _polygon(layer: str, corners: list[Point]) -> Loop:
    return Loop(tuple(rounded([(x, y, 0.0) for x, y in corners])), layer)
