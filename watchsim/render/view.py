"""Which part of the plane does a picture show, and which way up?

The room that the bodies really take over the window, with equal scales. Gravity points down; a mechanism that lies flat
is turned by a quarter where it fills the frame clearly better so. A body that travels far is followed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.transforms import Bbox
from numpy.typing import NDArray

from watchsim.geometry.hairspring import Coil
from watchsim.render.parts import loops_of, outline, pose_matrix
from watchsim.render.rows import taken, thinned
from watchsim.scene.forces import LineSpring
from watchsim.scene.scene import Body, Scene
from watchsim.scene.trains import at_start, is_still
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.simulation.trajectory import frames as body_frames

# Everything is asked of the trajectory's interpolation, so a picture may be drawn at any time and in any order.

Pixels = NDArray[np.uint8]
Window = tuple[float, float]

SWEEP_STEP = math.radians(3.0)  # a chord this long leaves its circle by 0.03 % of the radius
PATH_SAMPLES = 400


def recorded(run: Trajectory) -> tuple[Window, ...]:
    """The stretches of time (s) in which the motion is known, in order; ValueError where no rows were kept."""
    if len(run.t) == 0:
        raise ValueError("nothing to draw: no row of this run was kept (see --record)")
    first, last = float(run.t[0]), float(run.t[-1])
    spans = [(max(start, first), min(stop, last)) for start, stop in run.spans]
    return tuple((start, stop) for start, stop in spans if start < stop) or ((first, last),)


def stretch(run: Trajectory, window: Sequence[float] | None, unbroken: bool = False) -> Window:
    """The window to draw (s): as asked, or all that was recorded.

    ValueError where it is empty, reversed, or holds times that were not recorded; with `unbroken` also where nothing was
    asked and the record has gaps.
    """
    spans = recorded(run)
    kept = " and ".join(f"{start:.9g} s to {stop:.9g} s" for start, stop in spans)
    if spans[-1][1] <= spans[0][0]:
        raise ValueError(f"nothing to draw: the run holds only the instant {spans[0][0]:.9g} s")
    if window is None:
        if unbroken and len(spans) > 1:
            raise ValueError(f"{kept} were recorded: choose a window within one of them")
        return spans[0][0], spans[-1][1]
    try:
        start, stop = (float(value) for value in window)
    except (TypeError, ValueError):
        raise ValueError(f"window = {window!r}: give two times in seconds, (from, to), within {kept}") from None
    if not start < stop:
        raise ValueError(f"window from {start:.9g} s to {stop:.9g} s is empty; give (from, to) within {kept}")
    slack = 1e-9 * (stop - start)
    for low, high in spans:
        if low - slack <= start and stop <= high + slack:
            return max(start, low), min(stop, high)
    raise ValueError(f"window from {start:.9g} s to {stop:.9g} s: only {kept} was recorded")


def choose(run: Trajectory, names: Sequence[str] | None) -> tuple[Body, ...]:
    """The moving bodies of those names (default all); ValueError naming the choices where one is unknown or fixed."""
    bodies = {body.name: body for body in run.scene.bodies if body.name in run.slices}
    if names is None:
        return tuple(bodies.values())
    asked = (names,) if isinstance(names, str) else tuple(names)
    unknown = [name for name in asked if name not in bodies]
    if unknown or not asked:
        wrong = ", ".join(repr(name) for name in unknown) or "none given"
        raise ValueError(f"bodies: no moving body is called {wrong}; there are: {', '.join(bodies) or 'none'}")
    return tuple(bodies[name] for name in asked)


def poses(run: Trajectory, times: Array) -> dict[str, Array]:
    """For every body (len(times), 3): x, y (m) and angle (rad) of its frame."""
    q, _ = run.sample(times)
    return body_frames(run.scene, run.slices, q)


def seen(points: Array, matrix: Array) -> Array:
    """Points (n, 2) through a 3 × 3 map, such as from metres to pixels."""
    return points @ matrix[:2, :2].T + matrix[:2, 2]


def placed(points: Array, frames: Array) -> Array:
    """(len(frames), n, 2): the body points (n, 2) in the plane, for every pose x, y, angle."""
    c, s = np.cos(frames[:, 2:3]), np.sin(frames[:, 2:3])
    x = frames[:, 0:1] + c * points[:, 0] - s * points[:, 1]
    y = frames[:, 1:2] + s * points[:, 0] + c * points[:, 1]
    return np.stack((x, y), axis=2)


def sampled(run: Trajectory, body: Body, window: Window) -> Array:
    """(m, 3) poses at some hundred instants of the window, rows among them."""
    inside = run.t[(run.t >= window[0]) & (run.t <= window[1])]
    thinned = inside[:: max(1, len(inside) // PATH_SAMPLES)]
    return poses(run, np.union1d(np.linspace(*window, PATH_SAMPLES), thinned))[body.name]


def swept(run: Trajectory, body: Body, window: Window) -> Array:
    """(m, 3) poses dense enough to show the room the body takes within the window.

    A pivoted body is turned evenly through the angles it really reaches (at most one turn), others are sampled in time.
    """
    frames = sampled(run, body, window)
    if body.motion != "pivot" or body.on is not None:
        return frames
    low, high = float(frames[:, 2].min()), float(frames[:, 2].max())
    high = min(high, low + 2.0 * math.pi)
    angles = np.linspace(low, high, 2 + int((high - low) / SWEEP_STEP))
    return np.column_stack((np.tile(body.position, (len(angles), 1)), angles))


def dense(run: Trajectory, window: Window, least: int = 2000, accelerations: bool = True) -> tuple[Array, Array, Array, Array]:
    """t (m,), q, u and a (m, n) over the window: every row that a picture shows, and points between rows far apart.

    Without `accelerations` there are none of them, (0, n): to gather them takes as long as any of the others.
    At an impact both rows of that instant are kept, so that a jump stays a jump. Stretches that were not recorded are NaN.
    """
    start, stop = window
    inside = thinned(run, window)
    at_rows = taken(run.t, inside)
    times = np.concatenate(([start], at_rows, [stop]))
    gaps = np.diff(times)
    extra = np.maximum(np.ceil(gaps * (least / (stop - start))).astype(int) - 1, 0)
    left = np.repeat(np.arange(len(gaps)), extra)
    rank = np.arange(len(left)) - np.repeat(np.cumsum(extra) - extra, extra) + 1
    between = times[left] + gaps[left] * rank / (extra[left] + 1)
    added = np.concatenate(([start], between, [stop]))
    place = np.searchsorted(at_rows, between, side="right")

    def merged(rows: Array, new: Array) -> Array:
        inner = np.insert(rows, place, new[1:-1], 0) if len(place) else rows
        return np.concatenate((new[:1], inner, new[-1:]))

    t = merged(at_rows, added)
    q, u = (merged(taken(rows, inside), new) for rows, new in zip((run.q, run.u), run.sample(added), strict=True))
    a = merged(taken(run.a, inside), run.acceleration(added)) if accelerations else run.a[:0]
    spans = recorded(run)
    if len(spans) > 1:
        known = np.any([(t >= low) & (t <= high) for low, high in spans], axis=0)[:, None]
        q, u, a = (np.where(known, values, np.nan) if len(values) else values for values in (q, u, a))
    return t, q, u, a


# A hairspring is drawn from the shape that a scene gives it: the collet turns with the balance, the stud stays where it is. It
# takes no part in the motion.

STUD = 0.045  # of the stud's radius: half a side of the block that holds the outer end


@dataclass(frozen=True)
class Hairspring:
    """A spring's `coil` about the pivot of `body`, which stands on the body `on`; at rest where the body's angle is `rest`."""

    body: str
    on: str | None
    rest: float
    coil: Coil

    def turned(self, frames: dict[str, Array]) -> float:
        """How far (rad) the collet is turned from its rest, for the poses x, y, angle of one instant."""
        return float(frames[self.body][2]) - self._base(frames) - self.rest

    def line(self, frames: dict[str, Array], chords: int) -> Array:
        """(chords + 1, 2) points of the strip's middle in the movement (m), from collet to stud."""
        return self._placed(self.coil.line(self.turned(frames), chords), frames)

    def stud(self, frames: dict[str, Array]) -> Array:
        """(5, 2) corners (m) of the block at the outer end, the first one twice."""
        half, coil = STUD * self.coil.outer, self.coil
        middle = coil.outer * np.array([math.cos(coil.stud), math.sin(coil.stud)])
        along, across = middle / coil.outer, np.array([-middle[1], middle[0]]) / coil.outer
        sides = ((1, 1), (1, -1), (-1, -1), (-1, 1), (1, 1))
        return self._placed(np.array([middle + half * (a * along + b * across) for a, b in sides]), frames)

    def _base(self, frames: dict[str, Array]) -> float:
        return 0.0 if self.on is None else float(frames[self.on][2])

    def _placed(self, points: Array, frames: dict[str, Array]) -> Array:
        x, y, _ = frames[self.body]
        matrix = pose_matrix(np.array([x, y, self._base(frames)]))
        return seen(points, matrix)


def hairsprings(scene: Scene) -> tuple[Hairspring, ...]:
    """Those that the scene gives a shape."""
    return tuple(
        Hairspring(spring.body, scene.body(spring.body).on, spring.rest, spring.coil)
        for spring in scene.springs
        if spring.coil is not None
    )


def room_for(scene: Scene, body: str) -> Array:
    """(n, 2) points in the body's frame (m) that bound its hairspring; none without one."""
    reach = max((one.coil.outer * (1.0 + STUD) for one in hairsprings(scene) if one.body == body), default=0.0)
    angles = np.linspace(0.0, math.tau, 24, endpoint=False)
    return reach * np.column_stack((np.cos(angles), np.sin(angles))) if reach else np.empty((0, 2))


# A spring between two points is drawn as a helical spring is seen from the side: a straight eye at either end, and between them
# a zigzag of always the same width, which a stretched spring draws out. It takes no part in the motion.

COILS = 10
WIDTH = 0.05  # of its length: half the width of the zigzag
EYES = 0.12  # of the way between the points: straight, at either end


@dataclass(frozen=True)
class Zigzag:
    """A spring between a point of one body and a point of another, or of the movement (None); `half` (m) of its width."""

    between: tuple[str, str | None]
    points: tuple[Array, Array]
    half: float

    def line(self, frames: dict[str, Array]) -> Array:
        """(2 COILS + 4, 2) points in the movement (m) from end to end, for the poses x, y, angle of one instant."""
        first, last = self.ends(frames)
        way = last - first
        length = math.hypot(*way)
        side = self.half * np.array([-way[1], way[0]]) / length if length > 0.0 else np.zeros(2)
        return first + SHARES[:, None] * way + SIDES[:, None] * side

    def ends(self, frames: dict[str, Array]) -> Array:
        """(2, 2): where the two points are, m."""
        return np.array([_placed(point, frames, body) for point, body in zip(self.points, self.between, strict=True)])


def _zigzag() -> tuple[Array, Array]:
    """Shares of the way and of half the width, from point to point of the line."""
    steps = np.arange(2 * COILS) + 0.5
    along = EYES + (1.0 - 2.0 * EYES) * np.concatenate(([0.0], steps, [2.0 * COILS])) / (2.0 * COILS)
    across = np.concatenate(([0.0], np.where(np.arange(2 * COILS) % 2, -1.0, 1.0), [0.0]))
    return np.concatenate(([0.0], along, [1.0])), np.concatenate(([0.0], across, [0.0]))


SHARES, SIDES = _zigzag()


def _placed(point: Array, frames: dict[str, Array], body: str | None) -> Array:
    return point if body is None else (pose_matrix(frames[body]) @ [*point, 1.0])[:2]


def zigzags(scene: Scene) -> tuple[Zigzag, ...]:
    """All springs between points; each is as wide as the longer of its free length and that at the start asks for."""
    frames = {body.name: np.array([*body.position, body.angle]) for body in at_start(scene).bodies}
    return tuple(_of(spring, frames) for spring in scene.line_springs)


def _of(spring: LineSpring, frames: dict[str, Array]) -> Zigzag:
    first, second = (np.array(point) for point in spring.points)
    drawn = Zigzag(spring.between, (first, second), 0.0)
    apart = math.hypot(*np.subtract(*drawn.ends(frames)))
    return Zigzag(spring.between, (first, second), WIDTH * max(spring.length, apart))


def hooks(scene: Scene, body: str | None) -> Array:
    """(n, 2) points in the frame of a body, or of the movement (None), that springs are hooked to, m."""
    return np.array([s.points[k] for s in scene.line_springs for k in (0, 1) if s.between[k] == body]).reshape(-1, 2)


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

    @property
    def box(self) -> Bbox:
        """The same for matplotlib."""
        return Bbox.from_bounds(self.left, self.bottom, self.width, self.height)

    def near(self, x: float, y: float, reach: float) -> bool:
        """Does the point lie in the frame, or closer to it than `reach` both ways?"""
        return -reach < x - self.left < self.width + reach and -reach < y - self.bottom < self.height + reach


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
    return fitted(points, frame, angle)


def room_of(run: Trajectory, window: Window, zoom: Sequence[str] | None) -> tuple[Array, dict[str, Array], Body | None]:
    """(n, 2) points that bound all that is to be seen over a window, the poses they come from, and a body to follow, if any."""
    bodies = _shown(run, zoom)
    frames = {body.name: swept(run, body, window) for body in bodies}
    # What is asked for is seen for what it does: a rim drawn beside a roller would make that small.
    loops = [(body.loops if zoom is not None else ()) or loops_of(body) for body in bodies]
    outlines = [outline(own, COARSE * size_of(body)) for own, body in zip(loops, bodies, strict=True)]
    points = np.concatenate([placed(own, frames[body.name]).reshape(-1, 2) for own, body in zip(outlines, bodies, strict=True)])
    if zoom is None:
        coils = [placed(room_for(run.scene, body.name), frames[body.name][:1]).reshape(-1, 2) for body in bodies]
        hooked = [placed(hooks(run.scene, body.name), frames[body.name]).reshape(-1, 2) for body in bodies]
        points = np.concatenate((points, *coils, *hooked, hooks(run.scene, None)))
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
            foot = nearest(line, middle)
            away = foot - middle
            if math.hypot(*away) <= REACH * size:
                found.append((foot + GROUND * size * away / max(math.hypot(*away), 1e-9 * size))[None])
    return np.concatenate(found)


def nearest(line: Array, point: Array) -> Array:
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
    return upright(points, frame)


def upright(points: Array, frame: Frame) -> float:
    """The turn (rad) of a mechanism that lies flat: a quarter where it fills the frame clearly better so."""
    as_drawn, quarter = fitted(points, frame, 0.0).scale, fitted(points, frame, -0.5 * math.pi).scale
    return -0.5 * math.pi if quarter > QUARTER_GAIN * as_drawn else 0.0


def fitted(points: Array, frame: Frame, turn: float, margin: float = MARGIN) -> View:
    """The view that fits points (n, 2), m, into a frame."""
    low, high = bounds(points, turn)
    width, height = np.maximum(high - low, 1e-12)
    scale = (1.0 - 2.0 * margin) * min(frame.width / width, frame.height / height)
    (x, y), c, s = 0.5 * (low + high), math.cos(turn), math.sin(turn)
    return View((c * x + s * y, -s * x + c * y), float(scale), turn, _middle(frame))


def bounds(points: Array, turn: float) -> tuple[Array, Array]:
    """Least and largest x and y (m) of points (n, 2) in a picture turned by so much."""
    c, s = math.cos(turn), math.sin(turn)
    seen = points @ np.array([[c, s], [-s, c]])
    return seen.min(axis=0), seen.max(axis=0)


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
