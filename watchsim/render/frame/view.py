"""Which part of the plane does a picture show, and which way up?

The room that the bodies really take over the window, with equal scales. Gravity points down; a mechanism that lies flat
is turned by a quarter where it fills the frame clearly better so. A body that travels far is followed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loop import Loop
from watchsim.render.frame.coils import room_for
from watchsim.render.frame.filled_parts import loops_of, outline
from watchsim.render.frame.line_spring_shapes import fixed_ends, hooks
from watchsim.render.frame.pose_history import Window, placed, swept
from watchsim.scene.body import Body
from watchsim.scene.carriers import at_start, is_still
from watchsim.simulation.record.trajectory import Trajectory

Array = NDArray[np.float64]

MARGIN = 0.05  # of the frame, on every side
QUARTER_GAIN = 1.25  # a quarter turn must enlarge the picture by this
REACH = 4.0  # ground as far away as so many times the room of the bodies is still brought into sight
GROUND = 0.06  # of that room: what is seen of the ground's material
FAR = 12.0  # a travel of so many times the body's size is followed
FOLLOWED = 7.0  # how much of the path is then in sight, in sizes of the body
COARSE = 1e-3  # of a body's size: outlines for extents need no more


@dataclass(frozen=True)
class Frame:
    """Room for the mechanism in pixels: left, bottom, width, height."""

    left: float
    bottom: float
    width: float
    height: float


@dataclass(frozen=True)
class View:
    """pixel = middle + scale · turn(point - centre). `follow` names a body whose travel along `track` moves the centre."""

    centre: tuple[float, float]
    scale: float
    turn: float
    middle: tuple[float, float]
    follow: str | None = None
    track: tuple[float, float] = (1.0, 0.0)

    def matrix(self, centre: tuple[float, float]) -> Array:
        """The 3 × 3 map from metres to pixels when the picture is centred there."""
        c, s = self.scale * math.cos(self.turn), self.scale * math.sin(self.turn)
        x, y = centre
        return np.array([[c, -s, self.middle[0] - c * x + s * y], [s, c, self.middle[1] - s * x - c * y], [0.0, 0.0, 1.0]])

    def centre_at(self, frames: dict[str, Array]) -> tuple[float, float]:
        """The centre for the poses x, y, angle of one instant."""
        if self.follow is None:
            return self.centre
        (x, y), (tx, ty) = self.centre, self.track
        shift = tx * (frames[self.follow][0] - x) + ty * (frames[self.follow][1] - y)
        return x + shift * tx, y + shift * ty


def view(run: Trajectory, window: Window, frame: Frame, zoom: Sequence[str] | None, turn: float | None) -> View:
    """Frame the bodies of a run over a window; `zoom` names those to frame, `turn` (radians) overrides the choice of up."""
    points, frames, traveller = room_of(run, window, zoom)
    angle = _upright(run, points, frame, traveller) if turn is None else turn
    if traveller is not None:
        return _following(traveller, frames[traveller.name], frame, angle)
    return _fitted(points, frame, angle)


def room_of(run: Trajectory, window: Window, zoom: Sequence[str] | None) -> tuple[Array, dict[str, Array], Body | None]:
    """(n, 2) points that bound all that is to be seen over a window, the poses they come from, and a body to follow, if any."""
    bodies = _shown(run, zoom)
    frames = {body.name: swept(run, body, window) for body in bodies}
    if zoom is not None:
        # What is asked for is seen for what it does: a rim drawn beside a roller would make that small.
        points = np.concatenate([_room(body.loops or loops_of(body), body, frames[body.name]) for body in bodies])
    else:
        points = np.concatenate([_room(loops_of(body), body, frames[body.name]) for body in bodies])
        coils = [placed(room_for(run.scene, body.name), frames[body.name][:1]).reshape(-1, 2) for body in bodies]
        hooked = [placed(hooks(run.scene, body.name), frames[body.name]).reshape(-1, 2) for body in bodies]
        points = np.concatenate((points, *coils, *hooked, fixed_ends(run.scene)))
        points = np.concatenate((points, _ground_below(run, points)))
    return points, frames, _traveller(bodies, frames)


def _shown(run: Trajectory, zoom: Sequence[str] | None) -> list[Body]:
    """The bodies to frame: those named, or all that bound an area; ground is only brought into sight."""
    drawn = {body.name: body for body in run.scene.bodies if loops_of(body)}
    if zoom is not None:
        asked = (zoom,) if isinstance(zoom, str) else tuple(zoom)
        unknown = [name for name in asked if name not in drawn]
        if unknown or not asked:
            wrong = ", ".join(repr(name) for name in unknown) or "none given"
            raise ValueError(f"zoom: no body with an outline is called {wrong}; there are: {', '.join(drawn)}")
        return [drawn[name] for name in asked]
    if not drawn:
        raise ValueError("nothing to draw: no body of this scene has an outline")
    solid = [body for body in drawn.values() if any(loop.closed for loop in loops_of(body))]
    return solid or list(drawn.values())


def _ground_below(run: Trajectory, points: Array) -> Array:
    """(n, 2) points that bring ground into sight: of every open outline that stays in place, those nearest to `points`.

    Ground further away than REACH times the room of the points is left out.
    """
    size, middle = float(np.ptp(points, axis=0).max()), 0.5 * (points.min(axis=0) + points.max(axis=0))
    found = [np.empty((0, 2))]
    for body in at_start(run.scene).bodies:
        if not is_still(run.scene, body) or any(loop.closed for loop in loops_of(body)):
            continue
        pose = np.array([[*body.position, body.angle]])
        for loop in loops_of(body):
            line = placed(outline([loop], COARSE * size), pose)[0]
            foot = _nearest(line, middle)
            away = foot - middle
            if math.hypot(*away) <= REACH * size:
                found.append((foot + GROUND * size * away / max(math.hypot(*away), 1e-9 * size))[None])
    return np.concatenate(found)


def _nearest(line: Array, point: Array) -> Array:
    """The point of a polyline nearest to another point."""
    start, way = line[:-1], np.diff(line, axis=0)
    share = np.clip(np.sum((point - start) * way, axis=1) / np.maximum(np.sum(way * way, axis=1), 1e-300), 0.0, 1.0)
    feet = start + share[:, None] * way
    return feet[np.argmin(np.hypot(*(feet - point).T))]


def size_of(body: Body) -> float:
    """The larger side of the box around the body's own outlines (m)."""
    points = outline(loops_of(body), math.inf)
    reach = max(float(np.ptp(points, axis=0).max()), 1e-12)
    return max(float(np.ptp(outline(loops_of(body), COARSE * reach), axis=0).max()), 1e-12)


def _room(loops: tuple[Loop, ...], body: Body, frames: Array) -> Array:
    return placed(outline(loops, COARSE * size_of(body)), frames).reshape(-1, 2)


def _traveller(bodies: list[Body], frames: dict[str, Array]) -> Body | None:
    """The body that goes furthest, where that is far more than its size."""
    movers = [body for body in bodies if body.motion in ("free", "slide")]
    travel = {body.name: float(np.ptp(frames[body.name][:, :2], axis=0).max()) for body in movers}
    furthest = max(movers, key=lambda body: travel[body.name], default=None)
    return furthest if furthest is not None and travel[furthest.name] > FAR * size_of(furthest) else None


def _upright(run: Trajectory, points: Array, frame: Frame, traveller: Body | None) -> float:
    gx, gy = run.scene.gravity
    if math.hypot(gx, gy) > 0.0:
        return -0.5 * math.pi - math.atan2(gy, gx)
    if traveller is not None:
        return 0.0
    upright, quarter = _fitted(points, frame, 0.0).scale, _fitted(points, frame, -0.5 * math.pi).scale
    return -0.5 * math.pi if quarter > QUARTER_GAIN * upright else 0.0


def _fitted(points: Array, frame: Frame, turn: float) -> View:
    c, s = math.cos(turn), math.sin(turn)
    seen = points @ np.array([[c, s], [-s, c]])
    low, high = seen.min(axis=0), seen.max(axis=0)
    width, height = np.maximum(high - low, 1e-12)
    scale = (1.0 - 2.0 * MARGIN) * min(frame.width / width, frame.height / height)
    x, y = 0.5 * (low + high)
    return View((c * x + s * y, -s * x + c * y), float(scale), turn, _middle(frame))


def _following(body: Body, frames: Array, frame: Frame, turn: float) -> View:
    """The travel's own direction runs past; across it everything stays in sight and in place."""
    places = frames[:, :2] - frames[:, :2].mean(axis=0)
    track = np.linalg.svd(places, full_matrices=False)[2][0]
    across = places @ np.array([-track[1], track[0]])
    size = size_of(body)
    middle = frames[:, :2].mean(axis=0) + np.array([-track[1], track[0]]) * 0.5 * (across.max() + across.min())
    sight = max(float(np.ptp(across)) + 3.0 * size, FOLLOWED * size * min(frame.height / frame.width, 1.0))
    scale = frame.height / sight
    return View(
        (float(middle[0]), float(middle[1])), float(scale), turn, _middle(frame), body.name, (float(track[0]), float(track[1]))
    )


def _middle(frame: Frame) -> tuple[float, float]:
    return frame.left + 0.5 * frame.width, frame.bottom + 0.5 * frame.height
