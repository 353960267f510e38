"""What are the outlines of a snail, its rack and the stop of the rack?"""

from __future__ import annotations

import math

from watchsim.construction.outline import along, arc_between, circle, polar, rounded, turned
from watchsim.construction.snail.snail_dimensions import Snail
from watchsim.construction.snail.snail_proportions import boundary, gathered, radius
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Edge, Line

BORE = 0.3  # of the lowest step's radius
BAR = 1.5  # half the width of the tail in radii of its pin
RACK, DEPTH, SPOKE = 0.9, 0.04, 25.0  # radius of the rack and depth of its teeth by the tail; degrees of the rack's first tooth
STOP = 0.5  # of the tail: where it meets the stop


def snail(values: Snail) -> list[Loop]:
    """Arcs about the axis joined by radial walls, counter-clockwise from the last step to the first."""
    edges: list[Edge] = []
    last = values.steps
    for step in range(last, 0, -1):
        follower = step - 1 if step > 1 else last
        begin = boundary(values, step + 1) if step < last else boundary(values, 1) - 360.0
        end = boundary(values, step)
        r, after = radius(values, step), radius(values, follower)
        edges.append(arc_between(polar(r, begin), polar(r, end), (0.0, 0.0), True))
        edges.append(Line(*polar(r, end), *polar(after, end)))
    return [Loop(tuple(edges), "STEPS"), circle("STEPS", (0.0, 0.0), BORE * values.least, hole=True)]


def rack(values: Snail) -> list[Loop]:
    """About its axis, gathered up: pin and tail; the toothed rack on its other arm touches nothing."""
    half = BAR * values.pin_radius
    way = 180.0 - gathered(values)
    bar = [turned(corner, way) for corner in ((0.0, -half), (values.tail, -half), (values.tail, half), (0.0, half))]
    tail = rounded([(*corner, 0.0) for corner in bar])
    pin = circle("PIN", polar(values.tail, way), values.pin_radius)
    return [pin, Loop(tuple(tail), "TAIL"), _teeth(values), circle("FOOT", (0.0, 0.0), 2.0 * half)]


def stop(values: Snail) -> list[Loop]:
    """A pin above the tail, from the rack's axis."""
    way, r = 180.0 - gathered(values), values.pin_radius
    return [circle("STOP", along(polar(STOP * values.tail, way), way - 90.0, (1.0 + BAR) * r), r)]


def _teeth(values: Snail) -> Loop:
    """A sector with a tooth more at either end than there are steps."""
    outer, count = RACK * values.tail, values.steps + 2
    hub = BAR * values.pin_radius
    corners = [polar(hub, SPOKE + 45.0)]
    for i in range(count):
        at = SPOKE - i * values.tooth
        corners += [polar(outer, at), polar((1.0 - DEPTH) * outer, at)]
    inside, end = (1.0 - 4.0 * DEPTH) * outer, SPOKE - count * values.tooth
    narrow = SPOKE - math.degrees(3.0 * hub / inside)
    corners += [polar(inside, end), polar(inside, max(narrow, 0.5 * (SPOKE + end))), polar(hub, SPOKE - 45.0)]
    return Loop(tuple(rounded([(*corner, 0.0) for corner in reversed(corners)])), "RACK")
