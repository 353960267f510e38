"""What are the places of an escapement called, where are they, and where does a picture write their names?

A stone locks the wheel, a pin enters the fork, a safety roller faces the guard pin: each follows from roles and contacts, not
from the names of layers. Names stand in two columns beside the mechanism, each with a line to its place; lines do not cross.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.path import Path
from matplotlib.transforms import IdentityTransform
from scipy.optimize import linear_sum_assignment

from watchsim.analysis.timeline import pallet_side
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Point
from watchsim.mechanism.compile import compile_scene
from watchsim.render.marks import SIDES, PalletStones, spaced
from watchsim.render.palette import Style
from watchsim.render.parts import LastingPatch, loops_of, pose_matrix
from watchsim.render.view import Frame, Pixels, hairsprings, seen
from watchsim.render.words import Words
from watchsim.scene.roles import (
    ALONE,
    OFF_PIVOT,
    Roles,
    corners_of,
    drive_direction,
    layer_of,
    middle_of,
    pallet_name,
    reach_of,
    touching,
    with_anchor,
)
from watchsim.scene.scene import Scene
from watchsim.simulation.trajectory import Array, Trajectory, frames

ROUND = 1e-3  # of its radius: farther from the pivot the middle of an arc is not there


@dataclass(frozen=True)
class PartName:
    """A place by its name: `point` (m) in the frame of `body`, or in the movement where that is None."""

    text: str
    body: str | None
    point: Point

    def seen(self, frames: dict[str, Array], matrix: Array) -> Array:
        """(2,) pixels, for the poses x, y, angle of one instant and a map from metres."""
        pose = np.eye(3) if self.body is None else pose_matrix(frames[self.body])
        return seen(np.array([self.point]), matrix @ pose)[0]


def part_names(scene: Scene) -> list[PartName]:
    """Wheel, lever and oscillator at their pivots, and what they touch each other with; without an oscillator the bodies that
    turn, as the scene calls them."""
    found = with_anchor(scene)
    if found.oscillator is None or found.wheel is None:
        moving = [body for body in scene.bodies if body.loops and body.motion == "pivot"]
        return [PartName(spaced(body.name), body.name, (0.0, 0.0)) for body in moving]
    whole = [PartName("escape wheel", found.wheel, (0.0, 0.0))]
    whole.append(
        PartName(
            "balance" if any(one.body == found.oscillator for one in scene.springs) else "pendulum",
            found.oscillator,
            (0.0, 0.0),
        )
    )
    carrier = scene.body(found.wheel).on
    if carrier is not None:
        whole.append(PartName("carriage", carrier, _tip(loops_of(scene.body(carrier)))))
    if found.lever is not None:
        springs = [body for body in scene.bodies if body.on == found.lever and body.loops]
        if found.lever != found.oscillator:
            whole.append(PartName("detent" if springs else "lever", found.lever, (0.0, 0.0)))
            whole += [PartName("passing spring", body.name, _tip(loops_of(body))) for body in springs]
        whole += _pallets(scene, found)
    return [*whole, *_touching(scene, found), *_studs(scene)]


def _pallets(scene: Scene, found: Roles) -> Iterator[PartName]:
    stones = PalletStones(scene)
    for name in SIDES:
        try:
            lever, loop = stones.stone(name)
            place = stones.place(name)
        except ValueError:  # nothing is measured where the wheel is carried round, or never stands
            yield from _by_sides(scene, found)
            return
        alone = loop.length < ALONE * sum(one.length for one in loops_of(lever))
        yield PartName(pallet_name(scene, name), lever.name, middle_of([loop]) if alone else place)


def _by_sides(scene: Scene, found: Roles) -> Iterator[PartName]:
    """The two pallets that the wheel meets, on the lever or hinged on it: entry is the one that its teeth come to first."""
    assert found.wheel is not None and found.lever is not None
    words = [pallet_name(scene, name) for name in SIDES]
    places = [(body, middle_of([loop])) for body, loop in _met(scene, found)]
    if len(places) == 1 and found.lever != found.oscillator:  # a detent's
        yield PartName(pallet_name(scene, ""), *places[0])
    if found.lever == found.oscillator:
        met = [loop for side, loop in _met(scene, found) if side == found.lever]
        if len(met) == 1:
            places, words = [(found.lever, lip) for lip in _lips(met[0])], [f"{name} lip" for name in SIDES]
        rollers = [loop for loop in met if math.hypot(*middle_of([loop])) < OFF_PIVOT * reach_of([loop])]
        if len(met) == len(SIDES) and len(rollers) == 1:  # a duplex
            yield PartName("locking roller", found.lever, min(corners_of(rollers), key=lambda point: math.hypot(*point)))
            yield PartName("impulse pallet", found.lever, middle_of([loop for loop in met if loop is not rollers[0]]))
            return
    if len(places) != len(SIDES):
        return
    compiled = compile_scene(scene)
    q = np.array(compiled.q)
    if found.lever == found.oscillator:  # which may start anywhere
        q[compiled.slices[found.lever].start] = sum(one.rest for one in scene.springs if one.body == found.oscillator)
    poses = frames(scene, compiled.slices, compiled.relative(q[None]))
    at = [(pose_matrix(poses[body][0]) @ (*place, 1.0))[:2] for body, place in places]
    wheel = poses[found.wheel][0, :2]
    line = 0.5 * (at[0] + at[1]) - wheel
    turn = line[0] * (at[0] - wheel)[1] - line[1] * (at[0] - wheel)[0]
    order = places if drive_direction(scene, found.wheel) * turn < 0.0 else places[::-1]
    for text, (body, place) in zip(words, order, strict=True):
        yield PartName(text, body, place)


def _met(scene: Scene, found: Roles) -> Iterator[tuple[str, Loop]]:
    """The outlines that the wheel meets, on the lever or on what it carries, and whose they are."""
    for contact in scene.contacts:
        sides = {side.body: side.layer for side in contact.sides}
        other = next((name for name in sides if found.wheel in sides and name != found.wheel), None)
        if other is not None and found.lever in (other, scene.body(other).on):
            yield from ((other, loop) for loop in layer_of(scene.body(other), sides[other]))


def _lips(shell: Loop) -> list[Point]:
    """The middles of the two ends of a shell round the pivot; of another outline none."""
    round_ = [isinstance(edge, Arc) and math.hypot(edge.x, edge.y) < ROUND * edge.radius for edge in shell.edges]
    ends = [edge.point(0.5) for edge, of_shell in zip(shell.edges, round_, strict=True) if not of_shell]
    return ends if len(ends) == len(SIDES) == sum(round_) else []


def _touching(scene: Scene, found: Roles) -> Iterator[PartName]:
    """Fork and pin, guard and roller, banking, and stones that the wheel pushes besides the pallets."""
    for body, layer, text in touching(scene, found):
        loops = layer_of(scene.body(body), layer)
        if text == "banking":
            yield from (PartName(text, body, middle_of([loop])) for loop in loops)
        elif text == "fork":
            yield PartName("horn", body, _tip(loops))
        elif text == "guard pin":
            yield PartName(text, body, _tip(loops))
        elif body != found.lever and text != "passing spring":  # which has its name at its tip
            yield PartName(text, body, _edge(loops) if text == "safety roller" else middle_of(loops))


class Met:
    """What meets what in the contacts of a run, by roles such as "wheel / entry stone"; without one by body and layer."""

    def __init__(self, run: Trajectory) -> None:
        self._run, self._parts, self._compiled = run, with_anchor(run.scene), compile_scene(run.scene)
        self._names = {(body, layer): text for body, layer, text in touching(run.scene, self._parts)}
        self._order = [body.name for body in run.scene.bodies]
        self._known: dict[int, str] = {}

    def words(self, contact: int, time: float) -> str:
        """Of a contact that closed at that time (s)."""
        if contact not in self._known:
            pair = self._run.pairs[contact]
            sides = ((pair.body_a, pair.layer_a), (pair.body_b, pair.layer_b))
            named = sorted(sides, key=lambda side: self._order.index(side[0]))
            bodies = {body for body, _ in named}
            self._known[contact] = " / ".join(self._name(*side, bodies, contact, time) for side in named)
        return self._known[contact]

    def _name(self, body: str, layer: str, bodies: set[str], contact: int, time: float) -> str:
        wheel, lever = self._parts.wheel, self._parts.lever
        known = self._names.get((body, layer), self._names.get((body, None)))
        if known is not None and (wheel not in bodies or known == "impulse stone"):
            return known
        if wheel is None or lever is None or self._parts.oscillator is None:
            return _plain(body, layer)
        if body == wheel:
            return "wheel"
        if body == lever and wheel in bodies:
            met = self._compiled.model.contacts[contact]
            stone = next(side for side in (int(met.a), int(met.b)) if self._compiled.owners[side] == body)
            return pallet_name(self._run.scene, pallet_side(self._run, self._compiled, self._parts, stone, time))
        return _plain(body, layer)


def _plain(body: str, layer: str) -> str:
    """Of a side without a role; names of layers in capitals, as drawings have them, are words here."""
    return spaced(f"{body} {layer.lower() if layer.isupper() else layer}")


def _studs(scene: Scene) -> Iterator[PartName]:
    for spring in hairsprings(scene):
        coil = spring.coil
        x, y = coil.outer * math.cos(coil.stud), coil.outer * math.sin(coil.stud)
        if spring.on is None:
            px, py = scene.body(spring.body).position
            yield PartName("stud", None, (px + x, py + y))


def _tip(loops: Sequence[Loop]) -> Point:
    """What lies farthest from the pivot: the end of a fork, of a guard pin."""
    return max(corners_of(loops), key=lambda point: math.hypot(*point))


def _edge(loops: list[Loop]) -> Point:
    """A point of a roller's rim."""
    return min(corners_of(loops), key=lambda point: point[1])


# The page places names in the same way (pages/assets/names.js).

COLUMN = 9.6  # of the text's size: the longest name, and air on its either side
INSET = 1.0  # of the text's size: from a picture's edge to its names
SLANTED = 0.5  # of the text's size: from the longest name to where the lines of its column begin to slant
DOT = 2.2  # pixels at 1280 × 720: radius of the end of a line


@dataclass(frozen=True)
class Label:
    """A name in a picture, in pixels from its lower left corner.

    box   left, bottom, right, top of the text
    line  (3, 2), from the name to its place
    at    (2,): the place
    """

    name: PartName
    box: tuple[float, float, float, float]
    line: Array
    at: Array


class Labels:
    """The names of parts in `room` (pixels), beside a mechanism that lies within its middle.

    `ways` (instants, n, 2): where the named places are to be seen; names keep their rows, those of the shortest lines in all.
    """

    def __init__(self, names: Sequence[PartName], room: Frame, words: Words, ways: Array) -> None:
        inside = [any(room.near(x, y, 0.0) for x, y in way) for way in ways.transpose(1, 0, 2).tolist()]
        self._names = [name for name, here in zip(names, inside, strict=True) if here]
        self._words, self._room, size = words, room, words.size
        widest = max((words.width(name.text) for name in self._names), default=0)
        left, right = room.left + INSET * size, room.left + room.width - INSET * size
        half = -(-len(self._names) // 2)
        self._slots: list[tuple[bool, float, float, float]] = []  # on the left, outer edge, height, where the line slants from
        for k in range(len(self._names)):
            on_left, count = k < half, half if k < half else len(self._names) - half
            y = room.bottom + room.height * (1.0 - ((k if on_left else k - half) + 0.5) / count)
            begin = left + widest + SLANTED * size if on_left else right - widest - SLANTED * size
            self._slots.append((on_left, left if on_left else right, y, begin))
        starts = np.array([(begin, y) for _, _, y, begin in self._slots]).reshape(-1, 2)
        apart = np.linalg.norm(ways[:, inside][:, :, None] - starts[None, None], axis=3).sum(axis=0)
        self._slot_of = linear_sum_assignment(apart)[1].tolist()

    def at(self, frames: dict[str, Array], matrix: Array) -> list[Label]:
        """The labels for the poses x, y, angle of one instant, in a picture with that map from metres.

        A name is left out where its place is out of sight, or its line would cross a shorter one: what a name without a line
        belongs to could not be seen.
        """
        found: list[Label] = []
        for name, slot in zip(self._names, self._slot_of, strict=True):
            on_left, edge, y, begin = self._slots[slot]
            width, size = self._words.width(name.text), self._words.size
            x = edge if on_left else edge - width
            place = name.seen(frames, matrix)
            line = np.array([(x + width + 0.3 * size if on_left else x - 0.3 * size, y), (begin, y), place])
            if self._room.near(float(place[0]), float(place[1]), 0.0):
                found.append(Label(name, (x, y - 0.45 * size, x + width, y + 0.55 * size), line, place))
        clear: list[Label] = []
        for label in sorted(found, key=lambda one: math.dist(*one.line[1:].tolist())):
            if not any(_cross(label.line, other.line) for other in clear):
                clear.append(label)
        return clear

    def lines(self, labels: Sequence[Label], style: Style, unit: float) -> Iterator[LastingPatch]:
        """Their lines, each with a dot at its place; `unit` is the size of everything drawn."""
        look = {"transform": IdentityTransform(), "edgecolor": style.ink, "facecolor": style.ink, "linewidth": max(unit, 0.6)}
        for label in labels:
            dot = Path.circle((float(label.at[0]), float(label.at[1])), max(DOT * unit, 1.5))
            yield from (LastingPatch(Path(label.line), fill=False, **look), LastingPatch(dot, **look))

    def write(self, labels: Sequence[Label], out_pixels: Pixels) -> None:
        """Write the names, which stand on the picture's ground."""
        for label in labels:
            self._words.write(label.name.text, label.box[0], label.box[1] + 0.1 * self._words.size, out_pixels)


def _cross(one: Array, other: Array) -> bool:
    """Do the slanted parts of two lines cross?"""
    (a, b), (c, d) = one[1:], other[1:]

    def side(p: Array, q: Array, r: Array) -> float:
        return float((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))

    return side(a, b, c) * side(a, b, d) < 0.0 and side(c, d, a) * side(c, d, b) < 0.0
