"""How does a figure that was drawn for paper look on dark ground?

Ground, words, rules, marks and the bands of phases take the colours that movies have there; other curves and words keep their
hue and become light enough to be read, other pale faces dark enough to lie behind. Parts keep what they wear.
"""

from __future__ import annotations

import colorsys
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from matplotlib.collections import Collection
from matplotlib.colors import to_rgba
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

from watchsim.render.palette import SECOND
from watchsim.render.picture_style import DARK, LIGHT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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
        (SECOND, "#357049"),
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
    elif isinstance(artist, Collection):
        artist.set_facecolor([on_dark(colour, face=True) for colour in artist.get_facecolor()])
        artist.set_edgecolor([on_dark(colour) for colour in artist.get_edgecolor()])
