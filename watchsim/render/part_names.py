"""What are the places of an escapement called, and where are they? By what they do, not by the names of layers.

A stone locks the wheel, a pin enters the fork, a safety roller faces the guard pin: each follows from roles and contacts.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Point
from watchsim.geometry.solids import mass_properties
from watchsim.render.marks import STONES, PalletStones
from watchsim.render.parts import loops_of
from watchsim.render.view import hairsprings
from watchsim.scene.roles import Roles, with_anchor
from watchsim.scene.scene import Body, Scene

OFF_PIVOT = 0.3  # of a layer's reach: a pin's middle is farther from the pivot, that of a roller is not
ALONE = 0.5  # of all the lever's outlines by length: a shorter one is a stone of its own, a longer one carries its pallets


@dataclass(frozen=True)
class PartName:
    """A place by its name: `point` (m) in the frame of `body`, or in the movement where that is None."""

    text: str
    body: str | None
    point: Point


def part_names(scene: Scene) -> list[PartName]:
    """Wheel, lever and oscillator at their pivots, and what they touch each other with; empty without an oscillator."""
    found = with_anchor(scene)
    if found.oscillator is None or found.wheel is None:
        return []
    whole = [PartName("escape wheel", found.wheel, (0.0, 0.0))]
    whole.append(PartName("pendulum" if any(scene.gravity) else "balance", found.oscillator, (0.0, 0.0)))
    if found.lever is not None:
        if found.lever != found.oscillator:
            whole.append(PartName("lever", found.lever, (0.0, 0.0)))
        whole += _pallets(scene, found)
    return [*whole, *_touching(scene, found), *_studs(scene)]


def _pallets(scene: Scene, found: Roles) -> Iterator[PartName]:
    stones = PalletStones(scene)
    for name in STONES:
        try:
            lever, loop = stones.stone(name)
            place = stones.place(name)
        except ValueError:
            return
        alone = loop.length < ALONE * sum(one.length for one in loops_of(lever))
        kind = (
            "pin"
            if isinstance(loop.edges[0], Arc) and loop.edges[0].is_circle
            else "stone"
            if alone and found.lever != found.oscillator
            else "pallet"
        )
        yield PartName(name.replace("stone", kind), lever.name, _middle([loop]) if alone else place)


def _touching(scene: Scene, found: Roles) -> Iterator[PartName]:
    """Fork and pin, guard and roller, banking, and stones that the wheel pushes besides the pallets."""
    for contact in scene.contacts:
        sides = {side.body: side for side in contact.sides}
        layers = {name: _layer(scene.body(name), side.layer) for name, side in sides.items()}
        fixed = next((name for name in sides if scene.body(name).motion == "fixed"), None)
        if fixed is not None and found.lever in sides:
            yield from (PartName("banking", fixed, _middle([loop])) for loop in layers[fixed])
        elif {found.lever, found.oscillator} == set(sides) and found.lever and found.oscillator:
            own, other = layers[found.oscillator], layers[found.lever]
            is_pin = math.hypot(*_middle(own)) > OFF_PIVOT * _reach(own)
            yield PartName(
                "roller jewel" if is_pin else "safety roller", found.oscillator, _middle(own) if is_pin else _edge(own)
            )
            yield PartName("horn" if is_pin else "guard pin", found.lever, _tip(other))
        elif found.wheel in sides and found.oscillator in sides and found.lever not in (None, found.oscillator):
            yield PartName("impulse stone", found.oscillator, _middle(layers[found.oscillator]))


def _studs(scene: Scene) -> Iterator[PartName]:
    for spring in hairsprings(scene):
        coil = spring.coil
        x, y = coil.outer * math.cos(coil.stud), coil.outer * math.sin(coil.stud)
        if spring.on is None:
            px, py = scene.body(spring.body).position
            yield PartName("stud", None, (px + x, py + y))


def _layer(body: Body, layer: str | None) -> list[Loop]:
    return [loop for loop in body.loops if layer is None or loop.layer == layer]


def _middle(loops: list[Loop]) -> Point:
    """The centre of the face; of an open outline the middle of its first edge."""
    closed = [loop for loop in loops if loop.closed]
    return mass_properties(closed, 1.0, 1.0).centre if closed else loops[0].edges[0].point(0.5)


def _corners(loops: list[Loop]) -> list[Point]:
    return [edge.point(share) for loop in loops for edge in loop.edges for share in (0.0, 0.5)]


def _reach(loops: list[Loop]) -> float:
    return max(math.hypot(*point) for point in _corners(loops))


def _tip(loops: list[Loop]) -> Point:
    """What lies farthest from the pivot: the end of a fork, of a guard pin."""
    return max(_corners(loops), key=lambda point: math.hypot(*point))


def _edge(loops: list[Loop]) -> Point:
    """A point of a roller's rim."""
    return min(_corners(loops), key=lambda point: point[1])
