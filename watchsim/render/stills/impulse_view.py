"""Which picture shows an impulse that a stone of its own takes: where the wheel meets it, where it lets it go?"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from watchsim.escapement.impulses import DIRECT, Impulse
from watchsim.escapement.tooth_passage import Passage
from watchsim.geometry.primitives import Point
from watchsim.render.stills.angle_marks import arc, pointed, polar, ray
from watchsim.render.stills.function_views import LEVER_INK, WHEEL_INK, Array, Views, degrees, frame

if TYPE_CHECKING:
    from matplotlib.axes import Axes

AROUND = 1.15  # times the way of the tooth: half the picture
ASIDE = 24.0  # pt, words from their arc


def impulse_view(axes: Axes, views: Views, k: int, aspect: float) -> None:
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
    axes.set_title(f"{given.kind} impulse: begins (filled), ends (dashed)", fontsize=8.0, loc="left", pad=3.0)


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
