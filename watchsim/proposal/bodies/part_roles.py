"""Which part is driven, which drives, which swings, which holds, and which stands between them?"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from watchsim.proposal.bodies.one_sided import is_one_sided
from watchsim.proposal.bodies.part import Part
from watchsim.proposal.bodies.part_names import CLICK, DRIVER, FIXED, LEVER, OSCILLATOR, WHEEL, part_of, part_word
from watchsim.proposal.bodies.toothed import teeth_of

FEWEST_TEETH = 8  # of an escape wheel; with fewer slots a wheel is driven step by step, as in a Geneva drive
ROUNDISH = 0.4  # of its outlines on arcs about its pivot: a part that may turn through whole turns
NAMES = {WHEEL: "wheel", LEVER: "lever", OSCILLATOR: "balance", CLICK: "click", DRIVER: "driver", FIXED: "banking"}


@dataclass(eq=False)
class Role:
    """A part with its name and task: wheel, lever, oscillator, click, driver or fixed. `teeth` is 0 where it is no wheel."""

    part: Part
    name: str
    task: str
    why: str
    teeth: int = 0

    @property
    def moves(self) -> bool:
        return self.part.centre is not None and self.task != FIXED


def roles_of(parts: Sequence[Part]) -> list[Role]:
    """The role of every part, wheels first, then lever, oscillator, click, others, and what stands still."""
    moving = [part for part in parts if part.centre is not None and part.kind != FIXED]
    found = [Role(part, "", FIXED, _still(part)) for part in parts if part not in moving]
    wheels = [part for part in moving if part.kind in (WHEEL, None) and teeth_of(part) > 0]
    rest = [part for part in moving if part not in wheels]
    for part in wheels:
        count = teeth_of(part)
        found.append(Role(part, "", WHEEL, f"it comes back onto itself {count} times in a turn", count))
    for part in list(rest):
        if part.kind == WHEEL:
            found.append(Role(part, "", WHEEL, "the names of its layers say so"))
            rest.remove(part)
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
            named = part.kind == LEVER
            task = LEVER if named or swinging is not None else DRIVER
            found.append(Role(part, "", task, "the names of its layers say so" if named else "it turns and is no wheel"))
    order = [DRIVER, WHEEL, LEVER, OSCILLATOR, CLICK, FIXED]
    found.sort(key=lambda role: order.index(role.task))
    _name(found)
    return found


def _still(part: Part) -> str:
    return "the names of its layers say so" if part.kind == FIXED else "nothing in the drawing shows a pivot of it"


def _click(part: Part, rest: Sequence[Part], wheels: Sequence[Part]) -> str | None:
    """Why this part is a click; None where it is none."""
    if part.kind == CLICK:
        return "the names of its layers say so"
    alone = len(rest) == 1 and len(wheels) == 1 and not any(part_word(layer) for layer in part.layers)
    if alone and is_one_sided(part, wheels[0]):
        return "it comes into the teeth when it is turned one way, and clear of them the other way, unlike an anchor"
    return None


def _oscillator(rest: Sequence[Part], wheels: Sequence[Part]) -> tuple[Part, str] | None:
    """What swings: what is called so; else the roundest; a single part beside an escape wheel swings itself."""
    named = [part for part in rest if part.kind == OSCILLATOR]
    if named:
        return named[0], "the names of its layers say so"
    if not wheels or max(teeth_of(part) for part in wheels) < FEWEST_TEETH:
        return None
    free = [part for part in rest if part.kind is None] or (list(rest) if len(rest) == 1 else [])
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


def _driven(rest: Sequence[Part]) -> tuple[Part, str, str] | None:
    """Of two parts of which one drives, by its name or by a pin away from its pivot: the other, its task, and why."""
    if len(rest) != 2:
        return None
    for one, other in (rest, rest[::-1]):
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
        if role.task == OSCILLATOR and not words and not any(other.task == LEVER for other in roles):
            plain = "anchor"
        name, k = plain, 1
        while name in taken:
            k += 1
            name = f"{plain}_{k}"
        taken.add(name)
        role.name = name
