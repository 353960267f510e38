"""Which part is driven, which drives, which swings, which holds, and which stands between them?

Before, each outline on a layer that parts of several bodies share gets a layer of its own: a scene chooses by layer what can
touch.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.primitives import Point
from watchsim.proposal.parts import Part, distance, is_one_sided, teeth_of
from watchsim.proposal.pieces import SAME, Floats, is_toothed
from watchsim.proposal.words import (
    ANCHORS,
    CAMS,
    CLICK,
    DRIVER,
    FIXED,
    LEVER,
    OSCILLATOR,
    PASSING,
    WHEEL,
    part_of,
    part_word,
    tokens,
)

APART = "#"  # between the name of a layer and the number of an outline on it


def apart(parts: Sequence[Part], crowded: Sequence[frozenset[str]]) -> None:
    """Rename the layers of the pieces on layers that several parts share, or on which outlines cross; the largest is the first.

    `crowded` are the layers of each drawing on which they cross.
    """
    owners = Counter((part.file, layer) for part in parts for layer in part.layers)
    for part in parts:
        part.pieces.sort(key=lambda piece: -piece.area)
        numbers: Counter[str] = Counter()
        for k, piece in enumerate(part.pieces):
            if owners[piece.file, piece.layer] > 1 or piece.layer in crowded[piece.file]:
                numbers[piece.layer] += 1
                part.pieces[k] = replace(piece, layer=f"{piece.layer}{APART}{numbers[piece.layer]}")


def plain(layer: str) -> tuple[str, str]:
    """The layer as it was, and the number of the outline on it; empty where the layer was left as it is."""
    name, _, number = layer.partition(APART)
    return (name, number) if number.isdigit() else (layer, "")


SHARES = np.linspace(0.25, 0.9, 14)  # of a tooth's height: where its middle is taken
SYMMETRIC = 0.03  # of a pitch: teeth that lean less do not lean


def lean_of(part: Part) -> int:
    """+1 where the tips of a wheel's teeth stand ahead counter-clockwise of their roots, -1 clockwise; 0 where symmetric.

    An escape wheel is made to turn that way: its teeth lock with the tip. A tooth is followed from circle to circle, since a
    hook may lean over more than the pitch.
    """
    toothed = [(piece, piece.turned) for piece in part.pieces if piece.turned is not None and is_toothed(piece.turned)]
    if not toothed:
        return 0
    piece, symmetry = max(toothed, key=lambda pair: pair[1].outer)
    height = symmetry.outer - symmetry.inner
    radii = symmetry.inner + SHARES * height
    middles = [_middle(piece.rings, symmetry.centre, radius, symmetry.fold) for radius in radii.tolist()]
    pitch = 2.0 * math.pi / symmetry.fold
    way = np.unwrap([middle for middle in middles if middle is not None], period=pitch)
    lean = float(way[-1] - way[0]) if len(way) else 0.0
    return 0 if abs(lean) < SYMMETRIC * pitch else 1 if lean > 0.0 else -1


def _middle(rings: list[tuple[Floats, bool]], centre: Point, radius: float, fold: int) -> float | None:
    """The angle, modulo a pitch, of the middle of the material on a circle: the circular mean of what lies in it."""
    angles = np.linspace(0.0, 2.0 * math.pi, 64 * fold, endpoint=False)
    points = np.column_stack((centre[0] + radius * np.cos(angles), centre[1] + radius * np.sin(angles)))
    inside = np.zeros(len(points), bool)
    for ring, _ in rings:
        inside ^= _inside(ring, points)
    if not inside.any() or inside.all():
        return None
    mean = np.exp(1j * fold * angles[inside]).mean()
    return float(np.angle(mean)) / fold if abs(mean) > 1e-6 else None


def _inside(ring: Floats, points: Floats) -> NDArray[np.bool_]:
    """Even-odd rule, all points at once."""
    x, y = points[:, 0], points[:, 1]
    inside = np.zeros(len(points), bool)
    for (x0, y0), (x1, y1) in zip(ring[:-1].tolist(), ring[1:].tolist(), strict=True):
        if y0 != y1:
            inside ^= ((y0 > y) != (y1 > y)) & (x < x0 + (y - y0) * (x1 - x0) / (y1 - y0))
    return inside


FEWEST_TEETH = 8  # of an escape wheel; with fewer slots a wheel is driven step by step, as in a Geneva drive
ROUNDISH = 0.4  # of its outlines on arcs about its pivot: a part that may turn through whole turns
BY_NAME = "the names of its layers say so"
NAMES = {
    WHEEL: "wheel",
    LEVER: "lever",
    PASSING: "passing",
    OSCILLATOR: "balance",
    CLICK: "click",
    DRIVER: "driver",
    FIXED: "banking",
}


@dataclass(eq=False)
class Role:
    """A part with its name and task: wheel, lever, passing, oscillator, click, driver or fixed; `teeth` of a wheel, else 0.

    `little`: an oscillator that swings between the teeth, as an anchor or a pendulum does, not all round like a balance.
    `on`: what carries it, as a detent does its passing spring.
    """

    part: Part
    name: str
    task: str
    why: str
    teeth: int = 0
    little: bool = False
    on: Role | None = None

    @property
    def moves(self) -> bool:
        return self.part.centre is not None and self.task != FIXED


def first_of(roles: Sequence[Role], task: str) -> Role | None:
    return next((role for role in roles if role.task == task), None)


def roles_of(parts: Sequence[Part]) -> list[Role]:
    """The role of every part, wheels first, then lever, oscillator, click, others, and what stands still."""
    moving = [part for part in parts if part.centre is not None and part.kind != FIXED]
    still = "nothing in the drawing shows a pivot of it"
    found = [Role(part, "", FIXED, BY_NAME if part.kind == FIXED else still) for part in parts if part not in moving]
    wheels = [part for part in moving if part.kind in (WHEEL, None) and teeth_of(part) > 0]
    rest = [part for part in moving if part not in wheels]
    for part in wheels:
        count = teeth_of(part)
        found.append(Role(part, "", WHEEL, f"it has {count}-fold rotational symmetry", count))
    found += [Role(part, "", WHEEL, BY_NAME) for part in rest if part.kind == WHEEL]
    rest = [part for part in rest if part.kind != WHEEL]
    for part in list(rest):
        why = _click(part, rest, wheels)
        if why is not None:
            found.append(Role(part, "", CLICK, why))
            rest.remove(part)
    swinging = _oscillator(rest, wheels)
    driven = _driven(rest) if swinging is None and not wheels and not found else None
    for part in rest:
        if swinging is not None and part is swinging[0]:
            found.append(Role(part, "", OSCILLATOR, swinging[1]))
        elif driven is not None and part is driven[0]:
            found.append(Role(part, "", *driven[1:]))
        else:
            named = part.kind == LEVER and (swinging is not None or any(part_word(layer) for layer in part.layers))
            task = LEVER if named or swinging is not None else DRIVER
            found.append(Role(part, "", task, BY_NAME if named else "it turns and is no wheel"))
    levers = any(role.task == LEVER for role in found)
    for role in found:
        role.little = role.task == OSCILLATOR and bool(wheels) and not levers and _is_anchor(role.part)
    _carry_passing(found)
    order = [DRIVER, WHEEL, LEVER, PASSING, OSCILLATOR, CLICK, FIXED]
    found.sort(key=lambda role: order.index(role.task))
    _name(found)
    return found


LIGHT = 0.3  # of the area of a detent: a passing spring has less


def _carry_passing(roles: Sequence[Role]) -> None:
    """Of two levers the light one that lies against the other is its passing spring, which a chronometer's detent carries."""
    levers = sorted((role for role in roles if role.task == LEVER), key=lambda role: role.part.area)
    if len(levers) != 2 or not any(role.task == OSCILLATOR for role in roles):
        return
    leaf, detent = levers
    if leaf.part.area < LIGHT * detent.part.area and distance(leaf.part, detent.part) <= SAME:
        leaf.task, leaf.on = PASSING, detent
        leaf.why = "it lies against the other lever, and is much lighter"


def _click(part: Part, rest: Sequence[Part], wheels: Sequence[Part]) -> str | None:
    """Why this part is a click; None where it is none."""
    alone = len(rest) == 1 and len(wheels) == 1 and not any(part_word(layer) for layer in part.layers)
    if part.kind != CLICK and alone and is_one_sided(part, wheels[0]):
        return "it comes into the teeth when it is turned one way, and clear of them the other way, unlike an anchor"
    return BY_NAME if part.kind == CLICK else None


def _oscillator(rest: Sequence[Part], wheels: Sequence[Part]) -> tuple[Part, str] | None:
    """What swings: what is called so; else the roundest; a single part beside an escape wheel swings itself."""
    named = [part for part in rest if part.kind == OSCILLATOR]
    if named:
        return named[0], BY_NAME
    if not wheels or max(teeth_of(part) for part in wheels) < FEWEST_TEETH:
        return None
    free = [part for part in rest if part.kind is None or (len(rest) == 1 and part.kind != DRIVER)]
    if len(rest) == 1 and free:
        return free[0], "it is the only part beside the wheel: an anchor that swings itself"
    if not free:
        return None
    roundest = max(free, key=_roundness)
    if _roundness(roundest) >= ROUNDISH:
        return roundest, "most of its outline lies on arcs about its pivot"
    wheel = wheels[0]
    assert wheel.centre is not None
    at = wheel.centre.at
    farthest = max(free, key=lambda part: math.dist(part.centre.at, at) if part.centre else 0.0)
    return farthest, "it is the farthest from the wheel"


def _is_anchor(part: Part) -> bool:
    """Does it swing between teeth? By its names, else by its form: what turns all round is round."""
    return bool(_words(part) & ANCHORS) or (part.kind != OSCILLATOR and _roundness(part) < ROUNDISH)


def _words(part: Part) -> set[str]:
    return {word for layer in part.layers for word in tokens(layer)}


def _driven(rest: Sequence[Part]) -> tuple[Part, str, str] | None:
    """Of two parts of which one drives, by its name or by a pin away from its pivot: the other, its task, and why.

    What a cam moves is pressed on it.
    """
    if len(rest) != 2:
        return None
    for one, other in (rest, rest[::-1]):
        if _words(one) & CAMS and other.kind in (None, LEVER):
            return other, CLICK, "it follows the cam, as the names of the other's layers say"
        if one.kind == DRIVER and other.kind is None:
            return other, LEVER, "the names of the other's layers say that it drives"
        if _has_pin(one) and not _has_pin(other) and other.kind in (None, WHEEL):
            return other, WHEEL, "the other has a pin beside its pivot, which drives it"
    return None


def _has_pin(part: Part) -> bool:
    discs = [piece for piece in part.pieces if piece.is_disc]
    return any(part.centre is not None and math.dist(disc.centroid, part.centre.at) > 1e-2 * disc.length for disc in discs)


def _roundness(part: Part) -> float:
    if part.centre is None:
        return 0.0
    at = part.centre.at
    about = sum(arc.length for piece in part.pieces for arc in piece.arcs if math.dist((arc.x, arc.y), at) <= 1e-2 * arc.radius)
    return about / sum(piece.length for piece in part.pieces)


def _name(roles: Sequence[Role]) -> None:
    taken: set[str] = set()
    for role in roles:
        named = [(part_word(layer), part_of(layer)) for layer in role.part.layers]
        words = [word for word, kind in named if word is not None and role.task in (kind, DRIVER) and kind != FIXED]
        words = words or [word for word, _ in named if word is not None and role.task == FIXED]
        plain = words[0] if words else NAMES[role.task]
        if role.little and not words:
            plain = "anchor"
        name, k = plain, 1
        while name in taken:
            k += 1
            name = f"{plain}_{k}"
        taken.add(name)
        role.name = name
