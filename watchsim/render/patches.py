"""Of which patches is the mechanism in a picture made, and in which order do they lie?

From behind: the hairspring, what cannot touch and is larger than all that can (a balance's rim), what never moves, then the
moving parts with their shadows, the largest first, stops of springs, and springs between points.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.backend_bases import RendererBase
from matplotlib.figure import Figure
from matplotlib.path import Path
from matplotlib.transforms import Affine2D, IdentityTransform, Transform

from watchsim.render.palette import BLUED, FIXED, PALE_PICTURE_STYLE, Style, mixed
from watchsim.render.parts import (
    Edges,
    LastingPatch,
    Part,
    backdrop,
    edge_paths,
    is_round,
    loops_of,
    outline,
    parts,
    pose_matrix,
    spoke,
)
from watchsim.render.view import Frame, Hairspring, View, Zigzag, hairsprings, placed, seen, size_of, zigzags
from watchsim.scene.forces import Spring
from watchsim.scene.scene import Body, Scene
from watchsim.scene.trains import at_start, is_still, rides
from watchsim.simulation.trajectory import Array

THINNEST = 1.1  # pixels at 1280 × 720: a strip seen from far is narrower than a line can be
DEVIATION = 0.25  # pixels that a chord may stray from the coil


class CoilPatches:
    """The hairsprings of a scene in a picture with room `room` (pixels) and so many pixels to the metre; `own` makes a patch
    one of the picture's, `unit` is the size of everything drawn."""

    def __init__(
        self, scene: Scene, room: Frame, scale: float, style: Style, unit: float, own: Callable[[LastingPatch], LastingPatch]
    ) -> None:
        self._room, self._scale = room, scale
        colour = mixed(style.curve(BLUED), style.background, PALE_PICTURE_STYLE)
        thin = {"fill": False, "edgecolor": colour, "capstyle": "round", "joinstyle": "bevel", "transform": IdentityTransform()}
        held = {"facecolor": FIXED.fill, "edgecolor": FIXED.edge, "linewidth": 0.5, "transform": IdentityTransform()}
        blank = Path(np.zeros((1, 2)))
        self._drawn: list[tuple[Hairspring, int, tuple[LastingPatch, LastingPatch, LastingPatch]]] = []
        for spring in hairsprings(scene):
            width = max(scale * spring.coil.width, THINNEST * unit, 0.7)
            looks = ({**thin, "linewidth": width}, {**thin, "linewidth": 2.0 * width}, held)
            strip, collet, stud = (own(LastingPatch(blank, **look)) for look in looks)
            self._drawn.append((spring, spring.coil.chords(DEVIATION / scale), (strip, collet, stud)))

    def __bool__(self) -> bool:
        return bool(self._drawn)

    def patches(self, frames: dict[str, Array], matrix: Array) -> Iterator[LastingPatch]:
        """To be drawn for the poses x, y, angle of one instant; `matrix` maps metres to pixels. The next call moves them."""
        for spring, chords, (strip, collet, stud) in self._drawn:
            x, y = seen(frames[spring.body][None, :2], matrix)[0].tolist()
            if not self._room.near(x, y, 1.1 * self._scale * spring.coil.outer):
                continue
            strip.set_path(Path(seen(spring.line(frames, chords), matrix)))
            collet.set_path(Path.circle((x, y), self._scale * spring.coil.inner))
            stud.set_path(Path(seen(spring.stud(frames), matrix)))
            yield from (strip, collet, stud)


WIRE, HALO = 1.8, 3.8  # pixels at 1280 × 720: the wire, and the pale rim that parts it from what lies below
PIN = 3.0


class LineSpringPatches:
    """The springs between points of a scene; `own` makes a patch one of the picture's, `unit` is the size of everything
    drawn."""

    def __init__(self, scene: Scene, style: Style, unit: float, own: Callable[[LastingPatch], LastingPatch]) -> None:
        self._pin = PIN * max(unit, 0.5)
        place = IdentityTransform()
        line = {"fill": False, "capstyle": "round", "joinstyle": "round", "transform": place}
        wire = {"edgecolor": style.curve(BLUED), "linewidth": max(WIRE * unit, 0.8), **line}
        halo = {"edgecolor": style.background, "linewidth": max(HALO * unit, 1.8), **line}
        pin = {"facecolor": style.curve(BLUED), "edgecolor": style.background, "linewidth": 0.8, "transform": place}
        blank = Path(np.zeros((1, 2)))
        self._drawn: list[tuple[Zigzag, list[LastingPatch]]] = [
            (spring, [own(LastingPatch(blank, **look)) for look in (halo, wire, pin, pin)]) for spring in zigzags(scene)
        ]

    def patches(self, frames: dict[str, Array], matrix: Array) -> Iterator[LastingPatch]:
        """To be drawn for the poses x, y, angle of one instant; `matrix` maps metres to pixels. The next call moves them."""
        for spring, (halo, wire, *pins) in self._drawn:
            line = seen(spring.line(frames), matrix)
            halo.set_path(Path(line))
            wire.set_path(Path(line))
            for pin, place in zip(pins, (line[0], line[-1]), strict=True):
                pin.set_path(Path.circle(tuple(place.tolist()), self._pin))
            yield from (halo, wire, *pins)


# A stop has no place of its own: it only says at which angle, or after which travel, its body comes to a stop. It is drawn as a
# pin that the body then touches, on the side to which the spring presses, far out on the body's longest arm.

PIN_SPRING_STOPS = 0.04  # of the body's reach: radius of the pin
OUT = 0.7  # of the reach: where the pin stands on the arm
FINE = 400  # points along the reach of a body


@dataclass(frozen=True)
class StopPin:
    """A circle of `radius` m at `place` (m) in the frame of the body `on`, or in the movement (None)."""

    spring: Spring
    on: str | None
    place: tuple[float, float]
    radius: float


def stop_pins(scene: Scene) -> list[StopPin]:
    """One for each spring with a stop whose body has an outline."""
    return [pin for spring in scene.springs if spring.stop is not None and (pin := _pin(scene, spring)) is not None]


def _pin(scene: Scene, spring: Spring) -> StopPin | None:
    body = scene.body(spring.body)
    shapes = loops_of(body)  # what can touch is often the tip of an arm alone
    if not shapes or spring.stop is None:
        return None
    number = [one.name for one in scene.bodies].index(body.name)
    carrier = rides(scene.bodies)[number].turns_with
    on = spring.against or (scene.bodies[carrier].name if carrier >= 0 else None)
    frames = {one.name: np.array([*one.position, one.angle]) for one in at_start(scene).bodies}
    points = np.concatenate([_dense(outline([loop], size_of(body) / FINE), size_of(body) / FINE) for loop in shapes])
    side = math.copysign(1.0, spring.rest - spring.stop)  # to which the spring presses
    if body.motion == "pivot":
        start = body.angle - (scene.body(spring.against).angle if spring.against else 0.0)
        place, radius = _round(points, frames[body.name], spring.stop - start, side)
    else:
        place, radius = _along(points, body, frames[body.name], spring.stop, side)
    if on is None:
        return StopPin(spring, None, place, radius)
    x, y, angle = frames[on]
    c, s = math.cos(angle), math.sin(angle)
    dx, dy = place[0] - x, place[1] - y
    return StopPin(spring, on, (c * dx + s * dy, c * dy - s * dx), radius)


def _dense(points: Array, step: float) -> Array:
    """The points of a line with others between them, no further apart than `step` m."""
    ways = np.diff(points, axis=0)
    count = np.clip(np.ceil(np.hypot(*ways.T) / step), 1, FINE).astype(int)
    starts = zip(points[:-1], ways, count, strict=True)
    between = [start + np.linspace(0.0, 1.0, n, endpoint=False)[:, None] * way for start, way, n in starts]
    return np.concatenate((*between, points[-1:]))


def _round(points: Array, frame: Array, way: float, side: float) -> tuple[tuple[float, float], float]:
    """Beside the longest arm of a body that turns by `way` to its stop: the circle that the outline then touches."""
    r, turn = np.hypot(*points.T), np.arctan2(points[:, 1], points[:, 0])
    reach = float(r.max())
    radius, out = PIN_SPRING_STOPS * reach, OUT * reach
    arm = float(turn[np.argmax(r)])
    beside = (turn - arm + math.pi) % math.tau - math.pi
    near = (np.abs(r - out) < radius) & (np.abs(beside) < 0.5 * math.pi)
    cosine = (out**2 + r[near] ** 2 - radius**2) / (2.0 * out * r[near])
    met = side * beside[near] + np.arccos(np.clip(cosine, -1.0, 1.0))
    far = float(met.max(initial=math.asin(PIN_SPRING_STOPS / OUT)))
    direction = float(frame[2]) + way + arm + side * far
    return (float(frame[0]) + out * math.cos(direction), float(frame[1]) + out * math.sin(direction)), radius


def _along(points: Array, body: Body, frame: Array, stop: float, side: float) -> tuple[tuple[float, float], float]:
    """Before a body that slides, where it is longest."""
    here = placed(points, frame[None])[0]
    axis = np.array(body.axis)
    radius = 0.5 * PIN_SPRING_STOPS * float(np.ptp(here, axis=0).max())
    first = here[np.argmax(side * (here @ axis))]
    spot = first + (stop + side * radius) * axis
    return (float(spot[0]), float(spot[1])), radius


class SpringStopPatches:
    """The pins of a scene; `own` makes a patch one of the picture's, `unit` is the size of everything drawn."""

    def __init__(self, scene: Scene, style: Style, unit: float, own: Callable[[LastingPatch], LastingPatch]) -> None:
        look = style.worn(FIXED)
        self._drawn: list[tuple[StopPin, Affine2D, LastingPatch]] = []
        for pin in stop_pins(scene):
            place, width = Affine2D(), max(1.1 * unit, 0.6)
            circle = Path.circle(pin.place, pin.radius)
            made = LastingPatch(circle, facecolor=look.fill, edgecolor=look.edge, linewidth=width, transform=place)
            self._drawn.append((pin, place, own(made)))

    def patches(self, frames: dict[str, Array], matrix: Array) -> Iterator[LastingPatch]:
        """To be drawn for the poses x, y, angle of one instant; `matrix` maps metres to pixels. The next call moves them."""
        for pin, place, patch in self._drawn:
            place.set_matrix(matrix if pin.on is None else matrix @ pose_matrix(frames[pin.on]))
            yield patch


CHORD = 0.05  # pixels that a chord may stray from its arc
HATCH = 13.0  # pixels between hatch strokes
PICKED = 3.0  # pixels: width of picked edges
SHADOW = (2.0, -3.0)  # pixels


class Mechanism:
    """All bodies of a scene as `view` sees them in `room` (pixels) of a figure; `unit` is the size of everything drawn.

    `picked` edges are drawn over everything. What never moves and lies behind all else is given to the figure itself.
    """

    def __init__(
        self, figure: Figure, scene: Scene, view: View, room: Frame, unit: float, style: Style, picked: Sequence[Edges]
    ) -> None:
        self._figure, self._scene, self._view, self._room, self._unit, self._style = figure, scene, view, room, unit, style
        self._transforms = {body.name: Affine2D() for body in scene.bodies}
        self._springs = CoilPatches(scene, room, view.scale, style, unit, self.own)
        self._lines = LineSpringPatches(scene, style, unit, self.own)
        self._stops = SpringStopPatches(scene, style, unit, self.own)
        self._patches = [*self._compose(), *(patch for edges in picked for patch in self._picked(edges))]

    def draw(self, renderer: RendererBase, frames: dict[str, Array], matrix: Array) -> None:
        """Draw everything that may move, for the poses x, y, angle of one instant; `matrix` maps metres to pixels."""
        for body, transform in self._transforms.items():
            transform.set_matrix(matrix @ pose_matrix(frames[body]))
        for patch in self._springs.patches(frames, matrix):
            patch.draw(renderer)
        for patch in (*self._patches, *self._stops.patches(frames, matrix), *self._lines.patches(frames, matrix)):
            patch.draw(renderer)

    def rings(self, points: Array, colour: str) -> list[LastingPatch]:
        """Rings around points (n, 2), pixels, with a pale rim, to be seen on steel, brass and ruby alike."""
        path, width = _rings(points, 7.0 * max(self._unit, 0.5)), max(2.4 * self._unit, 1.2)
        looks = ((self._style.background, 2.2 * width), (colour, width))
        place = IdentityTransform()
        return [LastingPatch(path, fill=False, edgecolor=shade, linewidth=line, transform=place) for shade, line in looks]

    def own(self, patch: LastingPatch) -> LastingPatch:
        """The patch, drawn on this figure and only between the bands of words."""
        return patch.drawn_on(self._figure, self._room.box)

    def _compose(self) -> list[LastingPatch]:
        """Patches to draw in every frame, in order; those that never move go to the figure itself."""
        shapes = parts(self._scene, CHORD / self._view.scale, HATCH * self._unit / self._view.scale)
        start = at_start(self._scene).bodies
        still = {body.name for body in self._scene.bodies if is_still(self._scene, body) and self._view.follow is None}
        frames = {body.name: np.array([*body.position, body.angle]) for body in start}
        for body in still:
            self._transforms.pop(body)
        live: list[LastingPatch] = []
        unmoved: list[LastingPatch] = []
        for part in shapes:
            if part.body in still:
                unmoved += self._of_part(part, self._fixed(frames[part.body]))
        moving = [part for part in shapes if part.body not in still]
        behind = backdrop(moving)
        for part in behind:
            live += [self._shadow(part), *self._of_part(part, self._transforms[part.body])]
        if behind or self._springs:
            live += unmoved
        else:
            for patch in unmoved:
                self._figure.add_artist(patch)
        moving = moving[len(behind) :]
        live += [self._shadow(part) for part in moving if not part.ground]
        live += [patch for part in moving for patch in self._of_part(part, self._transforms[part.body])]
        live += [self._spoke(name) for name in self._transforms if is_round(self._scene.body(name))]
        live += self._pivots()
        return live

    def _fixed(self, frame: Array) -> Affine2D:
        """Where a body with that pose stands in a picture that does not move."""
        return Affine2D(self._view.matrix(self._view.centre) @ pose_matrix(frame))

    def _of_part(self, part: Part, transform: Transform) -> list[LastingPatch]:
        look = self._style.worn(part.finish)
        edge = {"edgecolor": look.edge, "joinstyle": "round", "capstyle": "round", "transform": transform}
        thin = max(1.1 * self._unit, 0.6)
        if not part.ground:
            return [self.own(LastingPatch(part.faces, facecolor=look.fill, linewidth=thin, **edge))]
        edge["edgecolor"] = self._style.line(look)
        made = [] if part.strokes is None else [LastingPatch(part.strokes, fill=False, linewidth=0.8 * thin, alpha=0.7, **edge)]
        return [self.own(patch) for patch in (*made, LastingPatch(part.faces, fill=False, linewidth=1.8 * thin, **edge))]

    def _picked(self, edges: Edges) -> list[LastingPatch]:
        """Edges in colour, on top of their bodies."""
        look = {"fill": False, "edgecolor": edges.colour, "linewidth": max(PICKED * self._unit, 1.5), "capstyle": "round"}
        made = []
        for number, path in edge_paths(edges, CHORD / self._view.scale).items():
            if number >= len(self._scene.bodies):
                continue  # the rack of a gear or a stop, which is nowhere
            body = self._scene.bodies[number]
            place = self._transforms.get(body.name) or self._fixed(np.array([*body.position, body.angle]))
            made.append(self.own(LastingPatch(path, transform=place, **look)))
        return made

    def _shadow(self, part: Part) -> LastingPatch:
        shift = Affine2D().translate(SHADOW[0] * self._unit, SHADOW[1] * self._unit)
        place = self._transforms[part.body] + shift
        return self.own(LastingPatch(part.faces, facecolor=self._style.shade, linewidth=0.0, transform=place))

    def _spoke(self, name: str) -> LastingPatch:
        """A radius drawn on a body so round that its turning could not be seen."""
        body = self._scene.body(name)
        first, last = spoke(body, size_of(body))
        path = Path([(first, 0.0), (last, 0.0)])
        look = {"edgecolor": self._style.ink, "linewidth": max(2.0 * self._unit, 1.0), "capstyle": "round"}
        return self.own(LastingPatch(path, fill=False, transform=self._transforms[name], **look))

    def _pivots(self) -> list[LastingPatch]:
        """A small ring at every pivot; those on carriers move with them."""
        pivoted = [body for body in self._scene.bodies if body.motion == "pivot"]
        if not pivoted or self._view.follow is not None:
            return []
        radius, matrix = 3.2 * max(self._unit, 0.5), self._view.matrix(self._view.centre)
        look = {"facecolor": self._style.background, "edgecolor": self._style.ink, "linewidth": max(1.3 * self._unit, 0.8)}
        places = [body.position for body in pivoted if body.on is None]
        patches = []
        if places:
            rings = _rings(seen(np.array(places), matrix), radius)
            patches.append(self.own(LastingPatch(rings, transform=IdentityTransform(), **look)))
        moved = _rings(np.zeros((1, 2)), radius / self._view.scale)
        names = [body.name for body in pivoted if body.on is not None]
        return patches + [self.own(LastingPatch(moved, transform=self._transforms[name], **look)) for name in names]


def _rings(points: Array, radius: float) -> Path:
    """Circles of `radius` pixels around points given in pixels."""
    circle = Path.unit_circle()
    vertices = radius * np.asarray(circle.vertices)
    return Path.make_compound_path(*(Path(vertices + point, circle.codes) for point in points))
