"""Which part of a mechanism does a picture show when nobody has said so, and at which instant?

What touches: a clock's escapement beside its pendulum, the pallets of a verge between its racks. The whole stands small beside
it, with a rectangle around what is shown. Where that would hardly enlarge anything, the whole is the picture.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from watchsim.analysis.phases import Phase
from watchsim.render.marks import ContactMarks
from watchsim.render.parts import outline
from watchsim.render.view import (
    COARSE,
    MARGIN,
    Frame,
    View,
    Window,
    bounds,
    fitted,
    nearest,
    placed,
    poses,
    recorded,
    room_of,
    size_of,
    swept,
    upright,
    view,
)
from watchsim.scene.roles import frequency, keeps_time, only_presses
from watchsim.scene.scene import Scene
from watchsim.simulation.trajectory import Array, Trajectory

WHOLE = "all"  # asked for by name instead of bodies
CLOSER = 1.6  # by which what touches must be larger than in a picture of the whole
VAST = 40.0  # times the extent of what touches: larger outlines are not brought into sight whole
PASSING = 2.0  # the same of what slides past, such as a rack
MOST_POINTS = 300  # instants at which contacts are looked at
AIR = 0.05  # of that extent, around the points themselves
SHARE = 0.2  # of the room, for the whole beside it
GAP = 12.0  # pixels at 1280 × 720, around the box of the whole


@dataclass(frozen=True)
class Sight:
    """The `view` of a mechanism in its `room`; where that shows what touches alone, the `whole` in its `box`. Pixels."""

    view: View
    room: Frame
    whole: View | None = None
    box: Frame | None = None


def sight(
    run: Trajectory,
    window: Window,
    room: Frame,
    zoom: Sequence[str] | None,
    turn: float | None,
    unit: float,
    aside: float = 0.0,
) -> Sight:
    """What a picture shows in `room`: the bodies named in `zoom`, "all", or by default what touches and the whole beside it.

    `unit` is the size of everything drawn; `aside` (pixels) stay free on the left and on the right of the mechanism.
    """
    named = None if zoom is None or is_whole(run.scene, zoom) else zoom
    inner = _narrowed(room, aside)
    everything = view(run, window, inner, named, turn)
    points = touching_room(run, window) if zoom is None and everything.follow is None else None
    if points is None:
        return Sight(everything, inner)
    main, box = _parted(room, *bounds(room_of(run, window, None)[0], everything.turn), GAP * unit)
    inner = _narrowed(main, aside)
    close = fitted(points, inner, everything.turn if any(run.scene.gravity) or turn is not None else upright(points, inner))
    if close.scale < CLOSER * everything.scale:
        return Sight(everything, _narrowed(room, aside))
    return Sight(close, inner, view(run, window, box, None, close.turn), box)


def is_whole(scene: Scene, zoom: Sequence[str]) -> bool:
    """Does `zoom` ask for everything, and not for a body of that name?"""
    return zoom in (WHOLE, [WHOLE], (WHOLE,)) and all(body.name != WHOLE for body in scene.bodies)


def touching_room(run: Trajectory, window: Window) -> Array | None:
    """(n, 2) points (m) that bound the contacts of a window and the outlines that make them; None where nothing touches."""
    try:
        marks = ContactMarks(run)
    except ValueError:
        return None
    found = {number: marks.stretches(number, window) for number in marks.numbers}
    times = np.unique([t for stretches in found.values() for ends in stretches for t in (ends[0], sum(ends) / 2.0)])
    times = times[:: max(1, len(times) // MOST_POINTS)]
    if not len(times):
        return None
    where = poses(run, times)
    points = np.concatenate([marks.points(t, {name: rows[k] for name, rows in where.items()}) for k, t in enumerate(times)])
    if not len(points):
        return None
    low, high = points.min(axis=0), points.max(axis=0)
    extent = float(np.hypot(*(high - low)))
    around = [points + AIR * extent * np.array(corner) for corner in ((-1, -1), (1, 1))]
    layers = {(side.body, side.layer) for contact in run.scene.contacts for side in contact.sides}
    for name in sorted({body for body, _ in layers}):
        body = run.scene.body(name)
        loops = [loop for loop in body.loops if {(name, None), (name, loop.layer)} & layers]
        pivot = swept(run, body, window)[:, :2]
        if body.motion == "pivot" and math.dist(nearest(np.vstack((points, points[:1])), pivot[0]), pivot[0]) <= extent:
            around.append(pivot)
        limit = extent * (PASSING if body.motion in ("slide", "free") else VAST)
        own = outline(loops, COARSE * size_of(body)) if loops else np.empty((0, 2))
        if len(own) and float(np.hypot(*np.ptp(own, axis=0))) <= limit:
            around.append(placed(own, swept(run, body, window)).reshape(-1, 2))
    return np.concatenate(around)


def _narrowed(room: Frame, aside: float) -> Frame:
    return Frame(room.left + aside, room.bottom, room.width - 2.0 * aside, room.height)


def _parted(room: Frame, low: Array, high: Array, gap: float) -> tuple[Frame, Frame]:
    """Room for what touches, and beside it a box for a whole of those extents: on the left of it, or below where it is wide."""
    wide, tall = (float(side) for side in np.maximum(high - low, 1e-12))
    if wide > 2.0 * tall:
        height = min(SHARE * room.height, (room.width - 2.0 * gap) * max(tall / wide, 0.05) / (1.0 - 2.0 * MARGIN) + gap)
        box = Frame(room.left + gap, room.bottom + gap, room.width - 2.0 * gap, height)
        return Frame(room.left, box.bottom + height, room.width, room.height - height - gap), box
    height = room.height - 2.0 * gap
    width = min(SHARE * room.width, height * wide / tall + gap)
    height = min(height, width * tall / wide + gap)
    box = Frame(room.left + gap, room.bottom + room.height - gap - height, width, height)
    return Frame(box.left + width, room.bottom, room.width - width - gap, room.height), box


def telling(found: Sequence[Phase], window: Window) -> float:
    """The instant (s) of a window to look at first: the middle of its last impulse, else its beginning."""
    inside = [one for one in found if one.name == "impulse" and window[0] <= one.start and one.end <= window[1]]
    return 0.5 * (inside[-1].start + inside[-1].end) if inside else window[0]


def last_beats(run: Trajectory, share: float = 1.5) -> Window:
    """The last one and a half oscillations, or the last tenth where nothing keeps time, of the last stretch recorded."""
    start, end = recorded(run)[-1]
    hertz = frequency(run.scene) if keeps_time(run.scene) and not only_presses(run.scene) else None
    length = share / hertz if hertz else 0.1 * (end - start)
    return max(start, end - length), end
