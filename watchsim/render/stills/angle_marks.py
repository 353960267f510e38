"""How is an angle drawn: two rays, an arc with arrowheads, its name and its value?"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from watchsim.geometry.primitives import Point
from watchsim.render.palette import INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes

THIN, SIZE = 0.6, 7.0  # pt
HEAD = "-|>,head_width=0.12,head_length=0.3"
HALO = {"boxstyle": "round,pad=0.12", "facecolor": "white", "edgecolor": "none", "alpha": 0.85}


def ray(axes: Axes, start: Point, end: Point, colour: str = INK, dashed: bool = False) -> None:
    """A thin line between two points (mm)."""
    style = (0, (5, 2, 1, 2)) if dashed else "-"
    axes.plot(*zip(start, end, strict=True), color=colour, linewidth=THIN, linestyle=style, zorder=6, solid_capstyle="butt")


def polar(centre: Point, radius: float, angle: float) -> Point:
    return centre[0] + radius * math.cos(angle), centre[1] + radius * math.sin(angle)


def arc(axes: Axes, centre: Point, radius: float, angles: tuple[float, float], colour: str = INK) -> None:
    """An arc from one angle (rad) to the other, with an arrowhead at its end."""
    turn = np.linspace(*angles, 60)
    x, y = centre[0] + radius * np.cos(turn), centre[1] + radius * np.sin(turn)
    axes.plot(x, y, color=colour, linewidth=THIN, zorder=6)
    arrow = {"arrowstyle": HEAD, "color": colour, "linewidth": THIN, "shrinkA": 0, "shrinkB": 0}
    k = max(0, len(turn) - 12)
    axes.annotate("", xy=(x[-1], y[-1]), xytext=(x[k], y[k]), arrowprops=arrow, zorder=6)


def note(axes: Axes, place: Point, words: str, colour: str = INK, aside: tuple[float, float] = (0.0, 0.0)) -> None:
    """Words beside a place (mm), shifted by `aside` (pt), on a pale ground so that what lies below does not disturb."""
    axes.annotate(
        words, xy=place, xytext=aside, textcoords="offset points", color=colour, fontsize=SIZE, ha="center", va="center",
        zorder=8, bbox=HALO, annotation_clip=False,
    )  # fmt: skip


def pointed(axes: Axes, place: Point, words: str, aside: tuple[float, float], colour: str = INK) -> None:
    """The same with a line from the words to the place."""
    line = {"arrowstyle": "-", "color": colour, "linewidth": 0.4, "shrinkA": 0, "shrinkB": 0}
    axes.annotate(
        words, xy=place, xytext=aside, textcoords="offset points", color=colour, fontsize=SIZE, ha="center", va="center",
        zorder=8, bbox=HALO, arrowprops=line,
    )  # fmt: skip
