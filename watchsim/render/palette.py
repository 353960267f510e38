"""Which colours does a part wear?

Watchmaking has its own: brass wheels, grey steel levers, ruby stones, gilt pins. The words of layers and bodies tell which.
"""

from __future__ import annotations

from dataclasses import dataclass

from watchsim.mechanism.body import Body

BACKGROUND = "#f6f3ed"
INK = "#23272c"
FAINT = "#80858c"
GRID = "#ddd8ce"
CONTACT = "#e8590c"


@dataclass(frozen=True, slots=True)
class Finish:
    """Colour of the face, of its edge, and of a curve that stands for the part in a plot."""

    fill: str
    edge: str
    line: str


BRASS = Finish("#dcb862", "#57420f", "#9c6f00")
STEEL = Finish("#b3bdc8", "#303841", "#35618e")
RUBY = Finish("#c4234f", "#4a0818", "#b0183c")
GILT = Finish("#eccf7c", "#6b5112", "#7a5c00")
BLUED = Finish("#8296b4", "#1f2a3f", "#5b3f94")
NIGHT = Finish("#65799a", "#1f2a3f", "#44307a")
COPPER = Finish("#d49a78", "#56301c", "#b5532a")
PLATE = Finish("#cfcac0", "#55524b", "#6b675e")

OTHERS = (STEEL, BRASS, COPPER, BLUED)

_STONES = ("stone", "pallet", "jewel", "ruby")
_FORKS = ("lever", "fork", "anchor", "arm")
_BODIES = (
    (("bank",), GILT),
    (("balance", "roller"), BLUED),
    (("lever", "fork", "anchor", "pallet"), STEEL),
    (("wheel", "gear", "pinion"), BRASS),
)
_LAYERS = (
    (("bank",), GILT),
    (("roller", "balance"), BLUED),
    (("tooth", "teeth", "wheel", "rim"), BRASS),
    ((*_FORKS, "dart", "guard", "horn"), STEEL),
)


def finish(body: Body, layer: str, rank: int = 0) -> Finish:
    """The finish of one layer of a body; `rank` (its place among the bodies) decides where no word does."""
    name, sheet = body.name.lower(), layer.lower()
    if any(word in sheet for word in _STONES) and not any(word in sheet for word in _FORKS):
        return RUBY
    if "pin" in sheet and any(word in name for word in ("balance", "roller")):
        return RUBY
    if "safety" in sheet:
        return NIGHT  # it lies on the roller and should stand out from it
    return _match(name, _BODIES) or _match(sheet, _LAYERS) or (PLATE if body.motion == "fixed" else OTHERS[rank % len(OTHERS)])


def _match(text: str, table: tuple[tuple[tuple[str, ...], Finish], ...]) -> Finish | None:
    return next((found for words, found in table if any(word in text for word in words)), None)


def body_finish(body: Body, rank: int = 0) -> Finish:
    """The finish that stands for a whole body in read-outs and plots: that of its only layer, or the body's own."""
    looks = {finish(body, layer, rank) for layer in body.layers}
    return looks.pop() if len(looks) == 1 else finish(body, "", rank)
