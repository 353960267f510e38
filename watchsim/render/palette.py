"""Which colours does a part wear?

Watchmaking has its own: brass wheels, grey steel levers, ruby stones. The words of layers and bodies tell which. Parts that
never move have a colour of their own, whatever they are called.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from watchsim.scene.body import Body
from watchsim.scene.scene import Scene

BACKGROUND = "#f6f3ed"
INK = "#23272c"
FAINT = "#5b6168"
GRID = "#ddd8ce"
CONTACT = "#e8590c"
FORCE = "#0b5fa5"
PHASES = {  # of a beat; pale, to lie behind curves, and distinct for every kind of colour vision (tests/figures/test_colours)
    "unlock": "#a6cee4",
    "catch-up": "#f5d999",
    "impulse": "#8cd3c0",
    "drop": "#f0d7e5",
    "run to banking": "#eebf99",
    "recoil": "#a6cee4",  # of an anchor's wheel, where a lever unlocks
}
SECOND, ELSE = "#66c5ab", "#eeeeee"  # an impulse that follows another; any other phase
PHASE_LINES = {  # the same for curves: Okabe and Ito's colours
    "unlock": "#0072b2",
    "catch-up": "#e69f00",
    "impulse": "#009e73",
    "drop": "#cc79a7",
    "run to banking": "#d55e00",
    "recoil": "#0072b2",
}


@dataclass(frozen=True, slots=True)
class Finish:
    """Colour of the face, of its edge, and of a curve that stands for the part in a plot; `pale` parts are drawn faintly."""

    fill: str
    edge: str
    line: str
    pale: bool = False


BRASS = Finish("#dcb862", "#57420f", "#9c6f00")
STEEL = Finish("#b3bdc8", "#303841", "#6a7683")
RUBY = Finish("#c4234f", "#4a0818", "#b0183c")
GILT = Finish("#eccf7c", "#6b5112", "#7a5c00")
BLUED = Finish("#7d98cb", "#1c2c4d", "#2f57a6")
NIGHT = Finish("#65799a", "#1f2a3f", "#2b3f63")
COPPER = Finish("#d49a78", "#56301c", "#b5532a")
PATINA = Finish("#8fbfa6", "#1f4634", "#2f7a58")
ENAMEL = Finish("#b79bc9", "#402a52", "#74469a")
OLIVE = Finish("#b9bd7a", "#43461a", "#767a14")
PLATE = Finish("#cfcac0", "#55524b", "#6b675e")
FIXED = Finish("#6f685e", "#2c2822", "#5a5349")

OTHERS = (STEEL, BRASS, COPPER, BLUED, PATINA, ENAMEL, OLIVE)

_STONES = ("stone", "pallet", "jewel", "ruby")
_FORKS = ("lever", "fork", "anchor", "arm")
_BODIES = (
    (("balance", "roller"), BLUED),
    (("lever", "fork", "anchor", "pallet"), STEEL),
    (("wheel", "gear", "pinion"), BRASS),
)
_LAYERS = (
    (("roller", "balance"), BLUED),
    (("tooth", "teeth", "wheel", "rim"), BRASS),
    ((*_FORKS, "dart", "guard", "horn"), STEEL),
)


def looks(scene: Scene) -> dict[str, Finish]:
    """What stands for every body in pictures, read-outs and plots; no two moving bodies alike while there are enough.

    Bodies whose words tell of one come first; the others take what is left.
    """
    told = {body.name: _told(body) for body in scene.bodies}
    found: dict[str, Finish] = {body.name: FIXED for body in scene.bodies if body.motion == "fixed"}
    moving = sorted((body for body in scene.bodies if body.motion != "fixed"), key=lambda body: told[body.name] is None)
    used: list[Finish] = []
    for rank, body in enumerate(moving):
        own = told[body.name]
        choices = OTHERS if own is None else (own, *OTHERS)
        used.append(next((look for look in choices if look not in used), choices[rank % len(choices)]))
        found[body.name] = used[-1]
    return found


def finish(body: Body, layer: str, look: Finish) -> Finish:
    """The finish of one layer of a body that `look` stands for: stones and impulse pins are ruby on any body.

    Layers that are drawn beside those that can touch are pale; a balance's rim and a pendulum's bob have that of
    their alloy.
    """
    name, sheet = body.name.lower(), layer.lower()
    if body.motion == "fixed":
        return look
    own = _of_layer(name, sheet)
    if own is not None and len(body.layers) == 1:
        own = look  # told from this layer; another where a body wears that already, so that pictures and legends agree
    if body.layers and layer not in body.layers and any(loop.layer == layer for loop in body.decoration):
        if own is None:
            # Of a body of which only stones can touch, the rest is no stone.
            own = BRASS if any(word in sheet for word in ("rim", "bob")) else STEEL if look is RUBY else look
        return replace(own, pale=True)
    return look if own is None else own


def _of_layer(name: str, sheet: str) -> Finish | None:
    if any(word in sheet for word in _STONES) and not any(word in sheet for word in _FORKS):
        return RUBY
    if "pin" in sheet and any(word in name for word in ("balance", "roller")):
        return RUBY
    if "safety" in sheet:
        return NIGHT  # it lies on the roller and should stand out from it
    return None


def mixed(colour: str, ground: str, share: float) -> str:
    """A colour with that share of another in it."""
    own, other = (tuple(int(text[k : k + 2], 16) for k in (1, 3, 5)) for text in (colour, ground))
    return "#" + "".join(f"{round(a + share * (b - a)):02x}" for a, b in zip(own, other, strict=True))


def _told(body: Body) -> Finish | None:
    """What the words say of a body: its only layer if that has a finish of its own, else its name, else its layers."""
    if len(body.layers) == 1 and (own := _of_layer(body.name.lower(), body.layers[0].lower())) is not None:
        return own
    layers = (_match(layer.lower(), _LAYERS) for layer in body.layers)
    return _match(body.name.lower(), _BODIES) or next((look for look in layers if look is not None), None)


def _match(text: str, table: tuple[tuple[tuple[str, ...], Finish], ...]) -> Finish | None:
    return next((found for words, found in table if any(word in text for word in words)), None)
