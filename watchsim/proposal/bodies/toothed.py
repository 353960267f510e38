"""How many teeth has a part, and which one is the wheel where names do not say so?"""

from __future__ import annotations

import math
from collections.abc import Sequence

from watchsim.proposal.bodies.centres import MANY, is_toothed
from watchsim.proposal.bodies.part import Part
from watchsim.proposal.bodies.part_names import WHEEL, part_word


def teeth_of(part: Part) -> int:
    """How often the part's outermost toothed piece comes back onto itself in a turn; 0 where none does."""
    toothed = [piece.turned for piece in part.pieces if piece.turned is not None and is_toothed(piece.turned)]
    centre = part.centre
    about = [one for one in toothed if centre is not None and math.dist(one.centre, centre.at) <= 1e-2 * one.outer]
    return max(about, key=lambda one: one.outer).fold if about else 0


def call_wheel(parts: Sequence[Part]) -> None:
    """Make the part with the most teeth a wheel, where the names of its features alone speak against it, and none else is one.

    An "impulse" may be a stone of the balance or the teeth of a duplex wheel, a "rim" that of a balance or of a pin wheel.
    """
    if any(part.kind in (WHEEL, None) and teeth_of(part) for part in parts):
        return
    free = [part for part in parts if teeth_of(part) >= MANY and not any(part_word(layer) for layer in part.layers)]
    if free:
        wheel = max(free, key=teeth_of)
        wheel.kind = WHEEL
        wheel.why.append(f"it comes back onto itself {teeth_of(wheel)} times in a turn, and nothing else is a wheel")
