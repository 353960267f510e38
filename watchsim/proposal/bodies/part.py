"""What is a body in the making: which pieces, about which centre, of which kind?"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from watchsim.proposal.bodies.centres import Centre
from watchsim.proposal.bodies.part_names import LEVER, OSCILLATOR
from watchsim.proposal.bodies.piece import Piece


@dataclass(eq=False)
class Part:
    """Pieces that move as one. `kind` is what names say it is, None where they say nothing; `why`: what holds it together."""

    pieces: list[Piece]
    centre: Centre | None = None
    kind: str | None = None
    hints: frozenset[str] = frozenset()  # kinds that its name may mean
    why: list[str] = field(default_factory=list)

    @property
    def area(self) -> float:
        return sum(piece.area for piece in self.pieces)

    @property
    def layers(self) -> list[str]:
        return list(dict.fromkeys(piece.layer for piece in self.pieces))

    @property
    def file(self) -> int:
        return self.pieces[0].file


def join(parts: list[Part], together: Callable[[Part, Part], bool], why: str) -> None:
    """Unite parts as long as two belong together."""
    k = 0
    while k < len(parts):
        other = next((one for one in parts[k + 1 :] if together(parts[k], one)), None)
        if other is None:
            k += 1
            continue
        unite(parts[k], other, why)
        parts.remove(other)


def unite(part: Part, other: Part, why: str) -> None:
    part.pieces += other.pieces
    worth = [centre for centre in (part.centre, other.centre) if centre is not None]
    part.centre = max(worth, key=lambda centre: centre.worth, default=None)
    part.kind = _united(part.kind, other.kind)
    part.why = list(dict.fromkeys([*part.why, *other.why, why]))


def _united(first: str | None, second: str | None) -> str | None:
    """What an anchor with its pendulum, or a lever with its own balance, is: the oscillator."""
    if {first, second} == {LEVER, OSCILLATOR}:
        return OSCILLATOR
    return first or second


def are_apart(one: Part, other: Part) -> bool:
    """Do centres or names say that these are two bodies?"""
    if one.centre is not None and other.centre is not None and not one.centre.is_that_of(other.centre):
        return True
    first, second = ({part.kind} if part.kind else part.hints for part in (one, other))
    return bool(first) and bool(second) and not set(first) & set(second)
