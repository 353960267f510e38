"""What does the sheet look like that shows the geometry of function of an escapement, with its angles and their values?

One page 170 mm wide for print, or 85 mm for one column of text.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from textwrap import wrap
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.text import Annotation, Text

from watchsim.escapement.by_hand import Hands
from watchsim.escapement.fork_and_pin import Passage
from watchsim.escapement.function_report import direction, pallet_names, text
from watchsim.escapement.impulses import DIRECT, Impulse
from watchsim.escapement.measure import Function
from watchsim.geometry.primitives import Point
from watchsim.mechanism.compile import Compiled
from watchsim.render.palette import INK
from watchsim.render.parts import Posed
from watchsim.render.style import COLUMN, FULL, MM, save
from watchsim.scene.scene import Scene
from watchsim.simulation.trajectory import Array
from watchsim.storage.write import write_file
from watchsim.units import signed

THIN, SIZE = 0.6, 7.0  # pt
HEAD = "-|>,head_width=0.12,head_length=0.3"
FIXED = "stays"  # words that do not give way
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
    """Words beside a place (mm), shifted by `aside` (pt), or where `clear_labels` finds room for them."""
    _beside(axes, place, words, aside, colour, annotation_clip=False)


def pointed(axes: Axes, place: Point, words: str, aside: tuple[float, float], colour: str = INK) -> None:
    """The same with a line from the words to the place."""
    line = {"arrowstyle": "-", "color": colour, "linewidth": 0.4, "shrinkA": 0, "shrinkB": 0}
    _beside(axes, place, words, aside, colour, arrowprops=line)


def _beside(axes: Axes, place: Point, words: str, aside: tuple[float, float], colour: str, **look: Any) -> None:
    middle = {"ha": "center", "va": "center", "fontsize": SIZE, "zorder": 8, "bbox": HALO}
    axes.annotate(words, xy=place, xytext=aside, textcoords="offset points", color=colour, **{**middle, **look})


# Each view is drawn in millimetres in the movement, as the scene places it.


LEVER_INK, WHEEL_INK, DRAW_INK = "#1f4e9c", "#8a5a00", "#b0183c"
WHOLE = 0.06  # of the extent: margin
DEPTHS = 3.6  # a close-up reaches so many total locks to each side


@dataclass(frozen=True)
class Views:
    """What all views need. Angles rad, points mm."""

    posed: Posed
    function: Function
    hands: Hands

    def coordinates(self, lever: float, wheel: float, balance: float | None = None) -> Array:
        parts = self.function.parts
        assert parts is not None
        q = np.array(self.hands.compiled.q)
        q[self.hands.coordinate(parts.wheel)] = wheel
        if balance is not None:
            q[self.hands.coordinate(parts.balance)] = balance
        q[self.hands.coordinate(parts.lever)] = lever
        return q

    def pivot(self, name: str) -> Point:
        x, y = self.hands.pivot(name, np.array(self.hands.compiled.q))
        return 1e3 * x, 1e3 * y

    def pallet(self, k: int) -> str:
        parts = self.function.parts
        assert parts is not None
        return pallet_names(parts)[k]

    @property
    def names(self) -> tuple[str, str, str]:
        parts = self.function.parts
        assert parts is not None
        return parts.wheel, parts.lever, parts.balance


def frame(axes: Axes, centre: Point, half: tuple[float, float]) -> None:
    """A square-scaled window around a point."""
    axes.set_aspect("equal")
    axes.set_xlim(centre[0] - half[0], centre[0] + half[0])
    axes.set_ylim(centre[1] - half[1], centre[1] + half[1])
    axes.set_xticks([])
    axes.set_yticks([])
    for spine in axes.spines.values():
        spine.set_linewidth(0.4)
        spine.set_color("#b8b8b8")


def scale_bar(axes: Axes) -> None:
    """A bar of a round length in the lower left corner."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    length = next(value for value in (5.0, 2.0, 1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.0) if value <= 0.22 * (right - left))
    x, y = left + 0.04 * (right - left), low + 0.05 * (high - low)
    axes.plot((x, x + length), (y, y), color="#333333", linewidth=1.2, solid_capstyle="butt", zorder=7)
    _beside(axes, (x + 0.5 * length, y), f"{length:g} mm", (0.0, 6.0), "#333333", annotation_clip=False, gid=FIXED)


def locked(axes: Axes, aspect: float, views: Views, k: int) -> None:
    """The stone that locks as entry (0) or exit (1), lever on the bank: draw, lock, run and total lock."""
    function = views.function
    assert function.pallets is not None and function.passages is not None
    numbers, passage = function.pallets[k], function.passages[k]
    pivot = views.pivot(views.names[1])
    start = passage.start
    toe = (1e3 * start.x, 1e3 * start.y)
    q = views.coordinates(start.lever, start.wheel)
    views.posed.draw(axes, q, [views.names[0], views.names[1]])
    arm, at = math.dist(toe, pivot), math.atan2(toe[1] - pivot[1], toe[0] - pivot[0])
    side = function.sides[k]
    # Seen from the lever: the corner stands ahead of the toe by the total lock, towards the bank.
    dropped_at, corner = at + side * numbers.run.value, at + side * numbers.total_lock.value
    half = DEPTHS * arm * numbers.total_lock.value
    met = views.hands.meeting(start.contact, q)
    frame(axes, toe, (half * aspect, half))
    for angle, dashed in ((at, False), (corner, False), (dropped_at, True)):
        ray(axes, polar(pivot, arm - 4.0 * half, angle), polar(pivot, arm + 4.0 * half, angle), LEVER_INK, dashed)
    # On the side of the stone, where there is room.
    inward = -1.0 if (pivot[0] - toe[0]) * met.normal[0] + (pivot[1] - toe[1]) * met.normal[1] > 0.0 else 1.0
    far = arm + inward * 0.62 * half * aspect * (1.0 if _is_stone(views, start.contact, views.names[1]) else -1.0)
    out = math.degrees(at) + 90.0 * side
    across = np.array((math.cos(math.radians(out)), math.sin(math.radians(out))))
    words = f"run {degrees(numbers.run.value)}", f"lock {degrees(numbers.lock.value)}"
    mark(axes, pivot, far, (at, dropped_at), words[0], LEVER_INK, -20.0 * across)
    mark(axes, pivot, far, (dropped_at, corner), words[1], LEVER_INK, 24.0 * across)
    draw_mark(axes, toe, pivot, met.normal, numbers.draw.value, half)
    _title(axes, f"{views.pallet(k)}, lever on its bank")


def _is_stone(views: Views, contact: int, lever: str) -> bool:
    """Does the contact's normal point out of the lever's material?"""
    return bool(views.hands.flat_of(contact) == views.hands.body(lever))


def mark(axes: Axes, centre: Point, radius: float, angles: tuple[float, float], words: str, colour: str, aside: Array) -> None:
    """An arc about a far centre, its words beside it."""
    arc(axes, centre, radius, angles, colour)
    pointed(axes, polar(centre, radius, 0.5 * (angles[0] + angles[1])), words, (float(aside[0]), float(aside[1])), colour)


def draw_mark(axes: Axes, toe: Point, pivot: Point, normal: Point, draw: float, half: float) -> None:
    """The angle between the locking face and the direction square to the line to the lever's pivot."""
    face = math.atan2(normal[0], -normal[1])
    square = math.atan2(pivot[1] - toe[1], pivot[0] - toe[0]) + 0.5 * math.pi
    square += math.pi * round((face - square) / math.pi)
    # Towards the side of the stone, which lies further from the wheel along the face.
    length = 1.25 * half
    for angle in (face, square):
        ray(axes, toe, polar(toe, length, angle), DRAW_INK, dashed=angle == square)
        ray(axes, toe, polar(toe, -length, angle), DRAW_INK, dashed=angle == square)
    for way in (0.0, math.pi):
        place = polar(toe, 0.8 * length, 0.5 * (face + square) + way)
        if _within(axes, place):
            arc(axes, toe, 0.8 * length, (square + way, face + way), DRAW_INK)
            note(axes, place, f"draw {degrees(draw)}", DRAW_INK, (0.0, 9.0))
            break


def _title(axes: Axes, words: str) -> None:
    axes.set_title(words, fontsize=8.0, loc="left", pad=3.0)


def _within(axes: Axes, place: Point) -> bool:
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    return left < place[0] < right and low < place[1] < high


def dropped(axes: Axes, aspect: float, views: Views, k: int) -> None:
    """The wheel before and after the drop from the entry (0: inside drop) or exit (1: outside drop) stone."""
    function = views.function
    assert function.pallets is not None and function.passages is not None
    passage, numbers = function.passages[k], function.pallets[k]
    pivot = views.pivot(views.names[0])
    balance = None if passage.direct is None else passage.direct.end
    before = views.coordinates(passage.let_off.lever, passage.let_off.wheel, balance)
    after = views.coordinates(passage.let_off.lever, passage.landed.wheel, balance)
    # What lets the tooth go: a stone of the lever, or of the balance itself.
    views.posed.draw(axes, before, views.names if passage.direct is not None else views.names[:2])
    views.posed.outline(axes, after, [views.names[0]], WHEEL_INK)
    left, lands = ((1e3 * one.x, 1e3 * one.y) for one in (passage.let_off, passage.landed))
    centre = (0.5 * (left[0] + lands[0]), 0.5 * (left[1] + lands[1]))
    half = 0.72 * max(abs(left[1] - lands[1]), abs(left[0] - lands[0]) / aspect)
    frame(axes, centre, (half * aspect, half))
    assert function.parts is not None
    radius = math.dist(lands, pivot)
    at = math.atan2(lands[1] - pivot[1], lands[0] - pivot[0])
    turn = function.parts.way * numbers.drop.value
    for angle in (at - turn, at):
        ray(axes, polar(pivot, 0.72 * radius, angle), polar(pivot, 1.12 * radius, angle), WHEEL_INK, angle == at)
    arc(axes, pivot, 1.08 * radius, (at - turn, at), WHEEL_INK)
    word = ("inside", "outside")[k]
    place = polar(pivot, 1.08 * radius, at - 0.5 * turn)
    away = math.dist(place, centre)
    aside = (34.0 * (centre[0] - place[0]) / away, 34.0 * (centre[1] - place[1]) / away)
    pointed(axes, place, f"{word} drop {degrees(numbers.drop.value)}", aside, WHEEL_INK)
    through = "" if passage.caught is None else f"{'direct' if passage.direct else 'indirect'} impulse, after the "
    _title(axes, f"let off by the {through}{views.pallet(k)}")


def lift(axes: Axes, aspect: float, views: Views) -> None:
    """Fork and balance as the pin comes in on the entry stone's bank, and where both stand when it leaves."""
    function = views.function
    assert function.fork is not None and function.banks is not None and function.passages is not None
    k = 0 if function.sides[0] > 0.0 else 1
    made, entry, leave = function.fork, function.fork.entries[k], function.fork.entries[1 - k]
    _, lever, balance = views.names
    here, there = function.banks[k], function.banks[1 - k]
    rest_wheel = function.passages[0].start.wheel
    views.posed.draw(axes, views.coordinates(here, rest_wheel, entry.angle), [lever, balance])
    views.posed.outline(axes, views.coordinates(there, rest_wheel, leave.angle), [lever, balance], LEVER_INK)
    hands = views.hands
    point = hands.meeting(entry.contact, views.coordinates(here, rest_wheel, entry.angle)).point
    pivot, foot = views.pivot(balance), views.pivot(lever)
    radius = math.dist((1e3 * point[0], 1e3 * point[1]), pivot)
    at = math.atan2(1e3 * point[1] - pivot[1], 1e3 * point[0] - pivot[0])
    turn = entry.way * made.lift_angle[k].value
    half = 1.9 * radius
    toward = math.atan2(foot[1] - pivot[1], foot[0] - pivot[0])
    frame(axes, polar(pivot, 0.75 * radius, toward), (half * aspect, half))
    marks = ((0.0, ""), (made.unlocking[k].value, "unlocked"), (made.impulse_end[k].value, "let off"), (abs(turn), ""))
    for angle, _ in marks:
        ray(axes, pivot, polar(pivot, 1.75 * radius, at + entry.way * angle), LEVER_INK, dashed=0.0 < angle < abs(turn))
    arc(axes, pivot, 1.55 * radius, (at, at + turn), LEVER_INK)
    note(axes, polar(pivot, 1.72 * radius, at + 0.5 * turn), f"lift angle {degrees(abs(turn))}", LEVER_INK)
    arc(axes, pivot, 1.28 * radius, (at, at + entry.way * made.unlocking[k].value), LEVER_INK)
    middle, aside = at + 0.5 * entry.way * made.unlocking[k].value, (-30.0 if math.cos(at) < 0.0 else 30.0, 14.0)
    pointed(axes, polar(pivot, 1.28 * radius, middle), f"unlocking {degrees(made.unlocking[k].value)}", aside, LEVER_INK)
    _title(axes, "pin entering the fork (filled), leaving it (dashed)")


def whole(axes: Axes, aspect: float, views: Views) -> None:
    """All parts, the entry stone locked, names beside the pivots."""
    function = views.function
    assert function.passages is not None
    start = function.passages[0].start
    entry = None if function.fork is None else function.fork.entries[0 if function.sides[0] > 0.0 else 1].angle
    q = views.coordinates(start.lever, start.wheel, entry)
    views.posed.draw(axes, q)
    (left, right), (low, high) = _extent(axes)
    half = 0.5 * (1.0 + 2.0 * WHOLE) * max((right - left) / aspect, high - low)
    frame(axes, (0.5 * (left + right), 0.5 * (low + high)), (half * aspect, half))
    for name in dict.fromkeys(views.names):
        place = views.pivot(name)
        axes.plot(*place, marker="+", color="#222222", markersize=5.0, markeredgewidth=0.7, zorder=7)
        note(axes, place, name, "#222222", (0.0, -9.0))
    wheel = views.pivot(views.names[0])
    assert function.parts is not None
    reach = 0.55 * math.dist((1e3 * start.x, 1e3 * start.y), wheel)
    arc(axes, wheel, reach, (-2.1, -2.1 + 1.1 * function.parts.way) if function.parts.way > 0 else (-1.0, -2.1), WHEEL_INK)
    _title(axes, f"{views.pallet(0)} locked")


def shape(views: Views) -> float:
    """Width over height of all parts."""
    axes = Figure().add_subplot()
    whole(axes, 1.0, views)
    (left, right), (low, high) = _extent(axes)
    return (right - left) / (high - low)


def _extent(axes: Axes) -> tuple[tuple[float, float], tuple[float, float]]:
    points = np.concatenate([patch.get_path().vertices for patch in axes.patches])
    points = points[np.isfinite(points).all(axis=1)]
    return (float(points[:, 0].min()), float(points[:, 0].max())), (float(points[:, 1].min()), float(points[:, 1].max()))


def degrees(value: float) -> str:
    return f"{signed(math.degrees(value), 2)}°"


AROUND = 1.15  # times the way of the tooth: half the picture
ASIDE = 24.0  # pt, words from their arc


def impulse_view(axes: Axes, aspect: float, views: Views, k: int) -> None:
    """The impulse after the entry (0) or exit (1) stone is unlocked: its beginning filled, its end dashed."""
    function = views.function
    assert function.passages is not None and function.impulses is not None and function.parts is not None
    passage = function.passages[k]
    given = function.impulses[0 if function.sides[k] > 0.0 else 1]
    before, after = _ends(views, passage, given)
    wheel, lever, balance = views.names
    pushed = balance if given.kind == DIRECT else lever
    views.posed.draw(axes, before, [wheel, pushed])
    views.posed.outline(axes, after, [wheel], WHEEL_INK)
    views.posed.outline(axes, after, [pushed], LEVER_INK)
    assert passage.caught is not None
    meets, leaves = ((1e3 * one.x, 1e3 * one.y) for one in (passage.caught, passage.let_off))
    centre = (0.5 * (meets[0] + leaves[0]), 0.5 * (meets[1] + leaves[1]))
    half = AROUND * max(abs(meets[1] - leaves[1]), abs(meets[0] - leaves[0]) / aspect)
    frame(axes, centre, (half * aspect, half))
    turn = given.balance.value if given.kind == DIRECT else given.lever.value
    for name, angle, colour in ((wheel, given.wheel.value, WHEEL_INK), (pushed, turn, LEVER_INK)):
        # Where both arcs lie side by side, each has its words on its own side.
        toward = views.pivot(name) if given.kind == DIRECT else centre
        _turn(axes, views.pivot(name), (meets, leaves), toward, f"{name} {degrees(angle)}", colour)
    _title(axes, f"{given.kind} impulse: begins (filled), ends (dashed)")


def _ends(views: Views, passage: Passage, given: Impulse) -> tuple[Array, Array]:
    """All coordinates as the impulse begins and as it ends."""
    function = views.function
    assert passage.caught is not None and function.fork is not None
    rest = function.fork.entries[0].angle  # of the balance; drawn only where it is pushed itself
    begin, end = (passage.direct.begin, passage.direct.end) if passage.direct is not None else (rest, rest)
    return (
        views.coordinates(passage.caught.lever, passage.caught.wheel, begin),
        views.coordinates(passage.let_off.lever, passage.let_off.wheel, end),
    )


def _turn(axes: Axes, pivot: Point, ends: tuple[Point, Point], toward: Point, words: str, colour: str) -> None:
    """Rays to where the touch begins and ends, the arc between them, and its words on the side of a point."""
    first, last = (math.atan2(y - pivot[1], x - pivot[0]) for x, y in ends)
    last = first + (last - first + math.pi) % math.tau - math.pi
    radius = 0.93 * min(math.dist(pivot, one) for one in ends)
    ray(axes, pivot, polar(pivot, 1.06 * radius, first), colour)
    ray(axes, pivot, polar(pivot, 1.06 * radius, last), colour, dashed=True)
    arc(axes, pivot, radius, (first, last), colour)
    place = polar(pivot, radius, 0.5 * (first + last))
    away = math.dist(place, toward)
    pointed(axes, place, words, (ASIDE * (toward[0] - place[0]) / away, ASIDE * (toward[1] - place[1]) / away), colour)


MARGIN, GAP, TITLE, ABOVE = 3.0, 4.0, 11.0, 3.5  # mm
FIRST, PANEL = 80.0, 58.0  # mm, height of the first row and of the others
ROW = 3.4  # mm, of the table
DPI = 300
SENTENCE = 56  # characters


def function_sheet(scene: Scene, compiled: Compiled, function: Function, width: float = FULL) -> Figure:
    """The sheet as a figure, `width` mm wide. ValueError where nothing of it was measured."""
    if function.pallets is None:
        raise ValueError("no sheet of the geometry of function: " + "; ".join(why for _, why in function.missing))
    views = Views(Posed(scene, compiled), function, Hands(compiled))
    columns = 2 if width > 1.5 * COLUMN else 1
    made = _views(views)
    lines = [part for line in list(text(function))[1:] for part in _wrapped(line)]
    places, foot = _places(len(made), width, shape(views))
    blocks = _blocks(lines, columns)
    height = foot + ROW * max(len(block) for block in blocks) + 2.0 * MARGIN
    figure = Figure(figsize=(width * MM, height * MM), dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    figure.text(MARGIN / width, 1.0 - 4.5 / height, scene.title, fontsize=10.0, weight="bold", va="center")
    words = f"geometry of function as drawn; wheel {direction(function)}, {function.teeth} teeth"
    figure.text(MARGIN / width, 1.0 - 9.0 / height, words, fontsize=6.5, va="center", color="#444444")
    for view, (left, top, wide, tall) in zip(made, places, strict=True):
        axes = figure.add_axes((left / width, 1.0 - (top + tall) / height, wide / width, tall / height))
        view(axes, wide / tall)
        scale_bar(axes)
    clear_labels(figure)
    for i, block in enumerate(blocks):
        _table(figure, block, (width, height), (MARGIN + i * 0.5 * width, foot + 2.0))
    return figure


COARSE = 100.0  # dots per inch, to look for room
FARTHEST, NEAR = 70.0, 4.0  # pt, from where words were put; a shift so small needs no line
COVERED = 400.0  # pt of shift that a label wholly over lines and faces is worth
AIR = 2  # dots round the words


def clear_labels(figure: Figure) -> None:
    """Shift the words of every view to where they cover least, nearest first, with a line to what they name if they moved."""
    canvas, dpi = FigureCanvasAgg(figure), figure.dpi
    figure.set_dpi(COARSE)
    labels = [
        (axes, one)
        for axes in figure.axes
        for one in axes.texts
        if isinstance(one, Annotation) and one.get_text() and one.get_gid() != FIXED
    ]
    for _, one in labels:
        one.set_visible(False)
    canvas.draw()
    drawn = np.asarray(canvas.buffer_rgba())[::-1, :, :3].min(axis=2) < 250  # rows from below, as window extents count
    steps = np.arange(-FARTHEST, FARTHEST + 1.0, 3.0)
    for axes, one in labels:
        one.set_visible(True)
        one.update_positions(canvas.get_renderer())
        box, room = Text.get_window_extent(one, canvas.get_renderer()), axes.get_window_extent()  # without its line
        covered = np.pad(np.cumsum(np.cumsum(drawn, axis=0, dtype=np.int64), axis=1), ((1, 0), (1, 0)))
        wide, tall = int(box.width) + 2 * AIR, int(box.height) + 2 * AIR
        found = []
        for dx in steps:
            for dy in steps:
                x, y = int(box.x0 + dx * COARSE / 72.0) - AIR, int(box.y0 + dy * COARSE / 72.0) - AIR
                if x > room.x0 and y > room.y0 and x + wide < room.x1 and y + tall < room.y1:
                    under = covered[y + tall, x + wide] - covered[y, x + wide] - covered[y + tall, x] + covered[y, x]
                    found.append((math.hypot(dx, dy) + COVERED * under / (wide * tall), dx, dy, x, y))
        if not found:
            continue
        _, dx, dy, x, y = min(found)
        drawn[y : y + tall, x : x + wide] = True
        if math.hypot(dx, dy) > NEAR:
            ax, ay = one.xyann
            one.set_visible(False)
            pointed(axes, one.xy, one.get_text(), (ax + dx, ay + dy), str(one.get_color()))
    figure.set_dpi(dpi)


def _places(count: int, width: float, shape: float) -> tuple[list[tuple[float, float, float, float]], float]:
    """(left, top, width, height) of every view, mm, and where they end; the whole as narrow as it is, beside it the first
    view, or the first two of an even number, then pairs."""
    room = width - 2.0 * MARGIN
    if width <= 1.5 * COLUMN:
        tall = [min(1.2 * room, room / shape)] + [0.8 * room] * (count - 1)
        tops = [TITLE + ABOVE + sum(tall[:i]) + i * (GAP + ABOVE) for i in range(count + 1)]
        return [(MARGIN, top, room, high) for top, high in zip(tops, tall, strict=False)], tops[-1]
    half = 0.5 * (room - GAP)
    step, top = PANEL + GAP + ABOVE, TITLE + ABOVE
    beside = 1 + count % 2
    high = FIRST if beside == 1 else PANEL + step
    first = min(half, max(0.3 * room, high * shape))
    wide, each = room - first - GAP, FIRST if beside == 1 else PANEL
    places = [(MARGIN, top, first, high)]
    places += [(MARGIN + first + GAP, top + i * step, wide, each) for i in range(beside)]
    top += high + GAP + ABOVE
    pairs = count - 1 - beside
    places += [(MARGIN + (i % 2) * (half + GAP), top + (i // 2) * step, half, PANEL) for i in range(pairs)]
    return places[:count], top + pairs // 2 * step - ABOVE


def write_sheet(path: str | os.PathLike[str], figure: Figure) -> None:
    """Save it as PNG, SVG or PDF, by the ending of the name; the same sheet gives the same bytes."""
    write_file(Path(path), lambda place: save(figure, place), "the sheet")


def _views(views: Views) -> list[Callable[[Axes, float], None]]:
    made: list[Callable[[Axes, float], None]] = [partial(whole, views=views)]
    if views.function.fork is not None:
        made.append(partial(lift, views=views))
    for view, there in ((locked, views.function.banks), (impulse_view, views.function.impulses), (dropped, True)):
        made += [partial(view, views=views, k=k) for k in (0, 1) if there is not None]
    return made


def _wrapped(line: str) -> list[str]:
    """Lines of the table as they are; sentences in lines short enough for the page."""
    if line.startswith("    "):
        return [line]
    return [f"    {part}" for part in wrap(line.strip(), SENTENCE)]


def _blocks(lines: list[str], columns: int) -> list[list[str]]:
    """The table in one column, or with what concerns the balance beside what concerns the stones."""
    split = next((i for i, line in enumerate(lines) if not line.startswith("      ")), len(lines))
    return [lines] if columns == 1 or split == len(lines) else [lines[:split], lines[split:]]


def _table(figure: Figure, lines: list[str], size: tuple[float, float], place: tuple[float, float]) -> None:
    width, height = size
    for i, line in enumerate(lines):
        y = 1.0 - (place[1] + (i + 0.5) * ROW) / height
        figure.text(place[0] / width, y, line[4:], fontsize=6.0, family="monospace", va="center")
