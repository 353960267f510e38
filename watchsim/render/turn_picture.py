"""What does a mechanism that is turned by hand look like at each thing that happens, and how do its parts go together?

Small views of the moments that matter, touches ringed, over the coordinates of all other bodies against that of the led one.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.transforms import Affine2D

from watchsim.escapement.couples import pose_of
from watchsim.escapement.turn import Happening, Turn, happenings, verdict
from watchsim.render.marks import spaced
from watchsim.render.palette import BACKGROUND, CONTACT, FAINT, GRID, INK, LIGHT, dark, looks
from watchsim.render.parts import Part, pose_matrix, working
from watchsim.storage.write import write_file

VIEWS, ACROSS = 9, 3
WIDE, VIEW, PLOT, HEAD, FOOT, DPI = (
    10.0,
    2.35,
    3.0,
    0.65,
    0.6,
    150,
)  # inches: letters are read where a page shows it 700 px wide
TITLES, ABOVE = 0.72, 0.75  # inches: over a view, and over the plot with its key
ROOM = 1.15  # of the reach of what touches: half the side of a view
BEFORE_AFTER = 12.0  # degrees of the led body that the plot shows beyond the first and last happening
MOMENTS = ("free", "back", "leaves", "meets")  # in this order of importance


def turn_picture(found: Turn, path: Path, on_dark: bool = False) -> None:
    """Write the picture as PNG, on light or with a dark background."""
    figure = dark(_figure(found)) if on_dark else _figure(found)
    write_file(path, lambda scratch: figure.savefig(scratch, format="png", dpi=DPI), "the picture")


def _figure(found: Turn) -> Figure:
    story = happenings(found)
    chosen = _moments(found, story)
    rows = max(1, math.ceil(len(chosen) / ACROSS))
    tall = HEAD + rows * (TITLES + VIEW) + ABOVE + PLOT + FOOT
    figure = Figure(figsize=(WIDE, tall), facecolor=BACKGROUND)
    FigureCanvasAgg(figure)
    sides, low = {"left": 0.05, "right": 0.95}, FOOT + PLOT + ABOVE
    views = {**sides, "bottom": low / tall, "top": 1.0 - (HEAD + TITLES) / tall, "hspace": TITLES / VIEW, "wspace": 0.04}
    grid = figure.add_gridspec(rows, ACROSS, **views)
    shapes = working(found.scene, 2e-7, 2e-4)
    box = _box(found)
    for number, (row, words) in enumerate(chosen):
        axes = figure.add_subplot(grid[number // ACROSS, number % ACROSS])
        _view(axes, found, row, shapes, box)
        heading = words.replace(": ", ":\n")
        axes.set_title(f"{number + 1}   {heading}", fontsize=9.5, color=INK, loc="left")
    plot = figure.add_subplot(figure.add_gridspec(1, 1, **sides, bottom=FOOT / tall, top=(FOOT + PLOT) / tall)[0])
    _plot(plot, found, story, [row for row, _ in chosen])
    figure.text(0.05, 1.0 - 0.3 / tall, found.scene.title, fontsize=14, fontweight="bold", color=INK)
    figure.text(0.05, 1.0 - 0.53 / tall, f"turned by hand, no forces: {verdict(found)[1]}", fontsize=11, color=INK)
    return figure


def _moments(found: Turn, story: list[Happening]) -> list[tuple[int, str]]:
    """The rows to show, in order, with what to say; the last one where the cycle ended early."""
    picked: dict[int, str] = {}
    led = found.cycle.led
    for kind in MOMENTS:
        for one in story:
            row = min(one.row, len(found.cycle.rows) - 1)
            if (
                one.kind != kind
                or len(picked) >= VIEWS
                or _with_fixed(found, one)
                or any(_beside(found, row, other, led) for other in picked)
            ):
                continue
            picked[row] = _words(found, one)
    if found.cycle.jam is not None or found.cycle.runaway is not None:
        picked[len(found.cycle.rows) - 1] = verdict(found)[0]
    return sorted(picked.items())


def _with_fixed(found: Turn, one: Happening) -> bool:
    """Is a fixed body what meets or parts?"""
    if one.couple is None:
        return False
    couple = found.cycle.assembly.couples[one.couple]
    return "fixed" in (found.scene.bodies[couple.a].motion, found.scene.bodies[couple.b].motion)


def _beside(found: Turn, row: int, other: int, led: int) -> bool:
    """Would the two look alike?"""
    a, b = found.cycle.rows[row], found.cycle.rows[other]
    slack = math.radians(1.0) if found.scene.bodies[led].motion == "pivot" else 2e-5
    return abs(a[led] - b[led]) < slack and math.copysign(1, row - found.cycle.turned[-1]) == math.copysign(
        1, other - found.cycle.turned[-1]
    )


def _words(found: Turn, one: Happening) -> str:
    name = found.names[found.cycle.led]
    q = found.cycle.rows[min(one.row, len(found.cycle.rows) - 1)][found.cycle.led]
    body = found.scene.bodies[found.cycle.led]
    value = f"{math.degrees(q):.2f}°" if body.motion == "pivot" else f"{1e3 * q:.3f} mm"
    here = f"{name} {value}".replace("-", "−") + "\n"
    if one.couple is None:
        return f"{here}{_pressed(found)} furthest back, by {math.degrees(one.way):.2f}°"
    couple = found.cycle.assembly.couples[one.couple]
    pair = f"{_short(couple.layers[0])} – {_short(couple.layers[1])}"
    words = {"free": f"{_pressed(found)} free for {math.degrees(one.way):.2f}°: {pair}", "leaves": f"{pair} part"}
    return here + words.get(one.kind, f"{pair} meet")


def _pressed(found: Turn) -> str:
    return " and ".join(found.names[number] for number in found.cycle.pressed)


def _short(layer: str) -> str:
    return spaced(layer.lower())


def _box(found: Turn) -> tuple[float, float, float]:
    """Middle and half side of the views: everything that touches in the cycle, with room around it."""
    places = np.array([touch.place for touches in found.cycle.touches[found.first :] for touch in touches] or [(0.0, 0.0)])
    low, high = places.min(axis=0), places.max(axis=0)
    middle = 0.5 * (low + high)
    half = 0.5 * float((high - low).max())
    return float(middle[0]), float(middle[1]), ROOM * half + 3e-4


def _view(axes: Axes, found: Turn, row: int, shapes: tuple[Part, ...], box: tuple[float, float, float]) -> None:
    bodies = {body.name: number for number, body in enumerate(found.scene.bodies)}
    q = found.cycle.rows[row]
    for part in shapes:
        number = bodies[part.body]
        x, y, c, s = pose_of(found.scene.bodies[number], q[number])
        place = Affine2D(pose_matrix(np.array([x, y, math.atan2(s, c)]))) + axes.transData
        look = LIGHT.worn(part.finish)
        axes.add_patch(PathPatch(part.faces, facecolor=look.fill, edgecolor=look.edge, linewidth=0.6, transform=place))
    for touch in found.cycle.touches[row]:
        axes.plot(*touch.place, "o", markersize=9, markerfacecolor="none", markeredgecolor=CONTACT, markeredgewidth=1.8)
    if found.cycle.jam is not None and row == len(found.cycle.rows) - 1:
        axes.plot(
            *found.cycle.jam.place, "o", markersize=15, markerfacecolor="none", markeredgecolor="#c92a2a", markeredgewidth=2.5
        )
    x, y, half = box
    axes.set_xlim(x - 1.25 * half, x + 1.25 * half)
    axes.set_ylim(y - half, y + half)
    axes.set_aspect("equal")
    axes.set_xticks([])
    axes.set_yticks([])
    axes.set_facecolor(BACKGROUND)
    for spine in axes.spines.values():
        spine.set_color(GRID)


def _plot(axes: Axes, found: Turn, story: list[Happening], moments: list[int]) -> None:
    """Coordinates of the others against the led one's; the pressed body's progress on a scale of its own."""
    cycle, worn = found.cycle, looks(found.scene)
    q = cycle.q[found.first :]
    factor = [math.degrees(1.0) if body.motion == "pivot" else 1e3 for body in found.scene.bodies]
    unit = ["°" if body.motion == "pivot" else "mm" for body in found.scene.bodies]
    led, name = cycle.led, found.names[cycle.led]
    right = axes.twinx()
    for number, body in enumerate(found.scene.bodies):
        if body.motion == "fixed" or number == led:
            continue
        pressed = number in cycle.pressed
        line, label = worn[body.name].line, spaced(body.name)
        values = factor[number] * ((q[:, number] - q[0, number]) * cycle.pressed.get(number, 1.0) if pressed else q[:, number])
        words = f"{label}, on from where it stood ({unit[number]}), right" if pressed else f"{label} ({unit[number]}), left"
        back = max(found.cycle.turned[-2] - found.first, 0) if len(found.cycle.turned) > 2 else len(q)
        side, x = right if pressed else axes, factor[led] * q[:, led]
        side.plot(x[: back + 1], values[: back + 1], color=line, linewidth=1.8, label=words)
        side.plot(x[back:], values[back:], color=line, linewidth=1.8, linestyle=(0, (4, 1.5)))
    for side in (axes, right):
        if not side.get_lines():
            side.set_yticks([])
    for number, row in enumerate(moments):
        top = 1.01 if number % 2 == 0 else 1.06
        at = factor[led] * cycle.rows[row][led]
        axes.axvline(at, color=GRID, linewidth=1.0, zorder=0)
        axes.text(
            at, top, str(number + 1), fontsize=9, color=CONTACT, ha="center", va="bottom", transform=axes.get_xaxis_transform()
        )
    here = [factor[led] * cycle.rows[min(one.row, len(cycle.rows) - 1)][led] for one in story] or list(factor[led] * q[:, led])
    room = BEFORE_AFTER if unit[led] == "°" else 0.05 * (max(here) - min(here) + 1e-3)
    axes.set_xlim(min(here) - room, max(here) + room)
    axes.set_xlabel(f"{name} ({unit[led]}); dashed: on the way back", color=INK)
    for side in (axes, right):
        side.tick_params(colors=FAINT, labelcolor=INK)
        for spine in side.spines.values():
            spine.set_color(GRID)
    axes.set_facecolor(BACKGROUND)
    axes.grid(color=GRID, linewidth=0.5)
    handles = [line for side in (axes, right) for line in side.get_lines() if not str(line.get_label()).startswith("_")]
    axes.legend(
        handles=handles, fontsize=9, frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.1), ncols=3, borderaxespad=0.0
    )
