"""Which colours do parts wear, and in which is a picture drawn besides, on light or on dark ground?

Watchmaking has its own: brass wheels, grey steel levers, ruby stones. The words of layers and bodies say which. Parts that
never move have a colour of their own, whatever they are called.
"""

from __future__ import annotations

import colorsys
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from matplotlib.collections import Collection
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

from watchsim.scene.scene import Body, Scene

BACKGROUND = "#f6f3ed"
INK = "#23272c"
FAINT = "#5b6168"
GRID = "#ddd8ce"
CONTACT = "#e8590c"
FORCE = "#0b5fa5"
FAULT = "#d0021b"
PHASES = {  # of a beat; pale, to lie behind curves, and distinct for every kind of colour vision
    "unlock": "#a6cee4",
    "recoil": "#a6cee4",  # of an anchor's wheel, where a lever unlocks
    "catch-up": "#f5d999",
    "impulse": "#8cd3c0",
    "drop": "#f0d7e5",
    "run to banking": "#eebf99",
}
SECOND, ELSE = "#6ab9a8", "#eeeeee"  # an impulse that follows another; any other phase
ENERGIES = {  # where energy goes, on plots and pages: Okabe and Ito's colours
    "stored": "#0072b2",
    "damping": "#d55e00",
    "friction": "#009e73",
    "impacts": "#cc79a7",
    "given back to the drive": "#e69f00",
}
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
_BODIES = ((("balance", "roller"), BLUED), (("lever", "fork", "anchor", "pallet"), STEEL), (("wheel", "gear", "pinion"), BRASS))
_LAYERS = (
    (("roller", "balance"), BLUED),
    (("tooth", "teeth", "wheel", "rim"), BRASS),
    ((*_FORKS, "dart", "guard", "horn"), STEEL),
)


def looks(scene: Scene) -> dict[str, Finish]:
    """What stands for every body in pictures, read-outs and plots; no two moving bodies alike while there are enough.

    Bodies whose words name one come first; the others take what is left.
    """
    named = {body.name: _by_words(body) for body in scene.bodies}
    found: dict[str, Finish] = {body.name: FIXED for body in scene.bodies if body.motion == "fixed"}
    moving = sorted((body for body in scene.bodies if body.motion != "fixed"), key=lambda body: named[body.name] is None)
    used: list[Finish] = []
    for rank, body in enumerate(moving):
        own = named[body.name]
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
        own = look  # chosen by this layer; another where a body wears that already, so that pictures and legends agree
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


def _by_words(body: Body) -> Finish | None:
    """What the words say of a body: its only layer if that has a finish of its own, else its name, else its layers."""
    if len(body.layers) == 1 and (own := _of_layer(body.name.lower(), body.layers[0].lower())) is not None:
        return own
    layers = (_match(layer.lower(), _LAYERS) for layer in body.layers)
    return _match(body.name.lower(), _BODIES) or next((look for look in layers if look is not None), None)


def _match(text: str, table: tuple[tuple[tuple[str, ...], Finish], ...]) -> Finish | None:
    return next((found for words, found in table if any(word in text for word in words)), None)


PALE_PICTURE_STYLE = 0.55  # of the ground's colour in what is drawn though it cannot touch


@dataclass(frozen=True)
class Style:
    """Colours of ground, words, rules and marks; `phases` lie behind curves, `shade` is that of shadows (RGBA)."""

    name: str
    background: str
    ink: str
    faint: str
    grid: str
    contact: str
    force: str
    phases: dict[str, str]
    shade: tuple[float, float, float, float]

    def worn(self, look: Finish) -> Finish:
        """What a part wears on this ground: what cannot touch is pale, so that what can stands out."""
        if not look.pale:
            return look
        fill, edge = (
            mixed(look.fill, self.background, PALE_PICTURE_STYLE),
            mixed(look.edge, self.background, PALE_PICTURE_STYLE),
        )
        return Finish(fill, edge, look.line)

    def line(self, look: Finish) -> str:
        """The colour of ground, which has an outline and no face."""
        return look.edge if self.name == "light" else mixed(look.fill, self.ink, 0.4)

    def curve(self, look: Finish) -> str:
        """The colour of a curve that stands for a part."""
        return look.line if self.name == "light" else look.fill


LIGHT = Style("light", BACKGROUND, INK, FAINT, GRID, CONTACT, FORCE, PHASES, (0.13, 0.14, 0.16, 0.13))
DARK = Style(
    "dark",
    background="#15181c",
    ink="#ece8df",
    faint="#a9b0b8",
    grid="#343a42",
    contact="#ff9d5c",
    force="#7cc0ff",
    phases={
        "unlock": "#1a4a76",
        "catch-up": "#3d2f05",
        "impulse": "#124a2e",
        "drop": "#5a2a58",
        "run to banking": "#6e3d1a",
        "recoil": "#1a4a76",
    },
    shade=(0.0, 0.0, 0.0, 0.4),
)


# A figure drawn for paper, on dark ground: ground, words, rules, marks and the bands of phases take the colours that movies
# have there; other curves and words keep their hue and become light enough to be read, other pale faces dark enough to lie
# behind. Parts keep what they wear.

READABLE = 4.5  # contrast of words and curves with the ground, as the guidelines for pages ask (WCAG 2.1, 1.4.3)
PALE, BEHIND = 0.82, 0.24  # lightness from which a face is one that lies behind, and what it becomes
GREY = 0.15  # saturation of what has no hue: dark greys become light ones
Colour = tuple[float, float, float, float]


def dark(figure: Figure) -> Figure:
    """The same figure with the colours of dark ground; it is changed in place and returned."""
    figure.draw_without_rendering()  # ticks and their numbers are made when they are needed
    for axes in figure.axes:
        axes.tick_params(which="both", color=DARK.faint, labelcolor=DARK.ink)
    figure.draw_without_rendering()
    seen: set[int] = set()
    for artist in figure.findobj():
        for one in (artist, *_beside(artist)):
            if one is not None and id(one) not in seen:
                seen.add(id(one))
                _repaint(one)
    return figure


def on_dark(colour: Any, face: bool = False) -> Colour:
    """What a colour of a light figure becomes, RGBA; `face`: of a surface, which has curves and words before it."""
    red, green, blue, alpha = to_rgba(colour)
    known = _KNOWN.get(_packed((red, green, blue)))
    if known is not None:
        return (*to_rgba(known)[:3], alpha)
    hue, light, saturation = colorsys.rgb_to_hls(red, green, blue)
    if face:
        made = (red, green, blue) if light < PALE else colorsys.hls_to_rgb(hue, BEHIND, 0.6 * saturation)
        return (*made, alpha)
    if saturation < GREY:
        light = max(light, 1.0 - light)
        red, green, blue = colorsys.hls_to_rgb(hue, light, saturation)
    while contrast((red, green, blue), to_rgba(DARK.background)[:3]) < READABLE and light < 1.0:
        light = min(light + 0.02, 1.0)
        red, green, blue = colorsys.hls_to_rgb(hue, light, saturation)
    return red, green, blue, alpha


def contrast(one: tuple[float, ...], other: tuple[float, ...]) -> float:
    """Of two colours (RGB), from 1 to 21, as WCAG 2.1 defines it."""
    high, low = sorted((_luminance(one), _luminance(other)), reverse=True)
    return (high + 0.05) / (low + 0.05)


def _luminance(colour: tuple[float, ...]) -> float:
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in colour]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def _packed(colour: tuple[float, ...]) -> tuple[int, ...]:
    return tuple(round(255.0 * part) for part in colour)


_KNOWN = {
    _packed(to_rgba(own)[:3]): other
    for own, other in (
        ("white", DARK.background),
        ("black", DARK.ink),
        (SECOND, "#276347"),
        *((getattr(LIGHT, name), getattr(DARK, name)) for name in ("background", "ink", "faint", "grid", "contact", "force")),
        *((LIGHT.phases[name], DARK.phases[name]) for name in LIGHT.phases),
    )
}


def _beside(artist: Any) -> Iterator[Patch]:
    """What belongs to a text and is no child of it: its ground and its arrow."""
    if isinstance(artist, Text):
        yield from filter(None, (artist.get_bbox_patch(), getattr(artist, "arrow_patch", None)))


def _repaint(artist: Any) -> None:
    if isinstance(artist, Text):
        artist.set_color(on_dark(artist.get_color()))
    elif isinstance(artist, Line2D):
        artist.set_color(on_dark(artist.get_color()))
        for get, put in (
            (artist.get_markerfacecolor, artist.set_markerfacecolor),
            (artist.get_markeredgecolor, artist.set_markeredgecolor),
        ):
            if not (isinstance(get(), str) and get() in ("none", "auto")):
                put(on_dark(get()))
    elif isinstance(artist, Patch):
        face, edge = to_rgba(artist.get_facecolor()), to_rgba(artist.get_edgecolor())
        if face[3]:
            artist.set_facecolor(on_dark(face, face=True))
        if edge[3]:
            artist.set_edgecolor(on_dark(edge))
    elif isinstance(artist, Collection) and artist.get_array() is None:  # colours that are numbers stay those of their scale
        artist.set_facecolor([on_dark(colour, face=True) for colour in artist.get_facecolor()])
        artist.set_edgecolor([on_dark(colour) for colour in artist.get_edgecolor()])
