"""Which pictures show lock and draw of a stone, a drop, and the lift of the balance?

Each view is drawn in millimetres in the movement, as the scene places it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from watchsim.escapement.by_hand.hands import Hands
from watchsim.escapement.measure import Function
from watchsim.geometry.primitives import Point
from watchsim.render.posed import Posed
from watchsim.render.stills.angle_marks import arc, note, pointed, polar, ray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]

LEVER_INK, WHEEL_INK, DRAW_INK = "#1f4e9c", "#8a5a00", "#b0183c"
STONES = ("entry", "exit")
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
    note(axes, (x + 0.5 * length, y), f"{length:g} mm", "#333333", (0.0, 6.0))


def locked(axes: Axes, views: Views, k: int, aspect: float) -> None:
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
    axes.set_title(f"{STONES[k]} stone, lever on its bank", fontsize=8.0, loc="left", pad=3.0)


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


def _within(axes: Axes, place: Point) -> bool:
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    return left < place[0] < right and low < place[1] < high


def dropped(axes: Axes, views: Views, k: int, aspect: float) -> None:
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
    through = (
        "" if passage.caught is None else ("direct impulse, after the " if passage.direct else "indirect impulse, after the ")
    )
    axes.set_title(f"let off by the {through}{STONES[k]} stone", fontsize=8.0, loc="left", pad=3.0)


def lift(axes: Axes, views: Views, aspect: float) -> None:
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
    pointed(
        axes, polar(pivot, 1.28 * radius, at + 0.5 * entry.way * made.unlocking[k].value),
        f"unlocking {degrees(made.unlocking[k].value)}", (-30.0 if math.cos(at) < 0.0 else 30.0, 14.0), LEVER_INK,
    )  # fmt: skip
    axes.set_title("pin entering the fork (filled), leaving it (dashed)", fontsize=8.0, loc="left", pad=3.0)


def whole(axes: Axes, views: Views, aspect: float) -> None:
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
    axes.set_title(f"{STONES[0]} stone locked", fontsize=8.0, loc="left", pad=3.0)


def shape(views: Views) -> float:
    """Width over height of all parts."""
    from matplotlib.figure import Figure

    axes = Figure().add_subplot()
    whole(axes, views, 1.0)
    (left, right), (low, high) = _extent(axes)
    return (right - left) / (high - low)


def _extent(axes: Axes) -> tuple[tuple[float, float], tuple[float, float]]:
    points = np.concatenate([patch.get_path().vertices for patch in axes.patches])
    points = points[np.isfinite(points).all(axis=1)]
    return (float(points[:, 0].min()), float(points[:, 0].max())), (float(points[:, 1].min()), float(points[:, 1].max()))


def degrees(value: float) -> str:
    return f"{math.degrees(value):.2f}°"
