"""How does a scene become a model?

Bodies, forces and declared contacts are flattened once into the record arrays the kernels read. Only outlines named in
a contact enter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from watchsim.contact.cell_frames import angle_of
from watchsim.contact.cells import choose_cells
from watchsim.mechanism.backlash import with_racks
from watchsim.mechanism.coiled import coiled
from watchsim.mechanism.contacts import coordinates_of_lines, declared_contacts, features, line_springs, near_contacts
from watchsim.mechanism.play import in_the_middle, loose, widen, with_holes
from watchsim.mechanism.shaken import feels, shaken
from watchsim.model import (
    BEARING,
    BODY,
    CONSTANT,
    COORDINATE,
    DAMPING_LAWS,
    FREE,
    JOINT,
    MOTION_CODE,
    OVER_ANGLE,
    OVER_TIME,
    PIVOT,
    PRIMITIVE,
    REPEATED,
    SLIDE,
    TABLE,
    Model,
    Records,
    frozen,
    records,
)
from watchsim.scene.forces import Side, Torque
from watchsim.scene.roles import Oscillator, oscillators
from watchsim.scene.scene import Body, Scene
from watchsim.scene.trains import Bond, Ride, Weighed, bonds, felt, rides, weigh
from watchsim.tolerances import CLEARANCE, SLOWEST_RATE, SPRING_AT_REST, UNIT_PHASE

# What are the coordinates of a model, how heavy are they, and what acts on them besides contacts?

OVER = {"constant": CONSTANT, "angle": OVER_ANGLE, "time": OVER_TIME}


@dataclass(frozen=True)
class Forced:
    """Coordinates, joints, line springs, bearings, tables and their knots, in the model's order; natural frequencies, 1/s."""

    parts: tuple[Records, Records, Records, Records, Records, np.ndarray]
    fastest: float
    slowest: float  # that counts, of what moves at all: never 0


UNSPRUNG = 3.0  # by so much slower than their rate is what only forces move


class _Targets:
    """On which record does a spring, torque or damper act: its body's coordinate, or the joint with another body?"""

    def __init__(
        self,
        scene: Scene,
        swinging: tuple[Oscillator, ...],
        riding: tuple[Ride, ...],
        bound: tuple[Bond, ...],
        slices: dict[str, slice],
        rows: Records,
    ) -> None:
        self.scene, self.swinging, self.slices, self.rows = scene, swinging, slices, rows
        self._riding = {body.name: ride for body, ride in zip(scene.bodies, riding, strict=True)}
        self.bonds = {body.name: bond for body, bond in zip(scene.bodies, bound, strict=True)}
        acting: list[tuple[str, str | None]] = [(one.body, None) for one in swinging]
        for forces in (scene.springs, scene.torques, scene.damping):
            acting += [(one.body, one.against) for one in forces]
        other = {ends: number for ends in dict.fromkeys(acting) if (number := self._other(*ends)) >= 0}
        self.joints = records(JOINT, len(other))
        self._joint = dict(zip(other, self.joints, strict=True))
        for (name, against), joint in self._joint.items():
            joint.coordinate, joint.on, joint.watched = self.number(name), other[name, against], 0

    def _other(self, name: str, against: str | None) -> int:
        """The coordinate of the other end, -1 where there is none."""
        if against is not None:
            return self.number(against)
        carrier = self._riding[name].turns_with
        return self.number(self.scene.bodies[carrier].name) if carrier >= 0 and self.scene.body(name).geared is None else -1

    def number(self, name: str) -> int:
        """The coordinate: a body's angle, or a sliding body's travel; of the body that it is geared to."""
        body = self._holder(name)
        part = self.slices[body.name]
        return part.stop - 1 if body.motion == "free" else part.start

    def _holder(self, name: str) -> Body:
        return self.scene.bodies[self.bonds[name].to]

    def on(self, name: str, against: str | None = None) -> int:
        """The coordinate of the other end, such as the angle of its carrier; -1 for none."""
        return int(self._joint[name, against].on) if (name, against) in self._joint else -1

    def row(self, name: str, against: str | None = None) -> Any:
        return self._joint[name, against] if (name, against) in self._joint else self.rows[self.number(name)]

    def ratio(self, name: str) -> float:
        """How far the body goes, as the scene gives it, for one unit of the coordinate."""
        return self.bonds[name].given

    def place(self, name: str, value: float, against: str | None = None) -> float:
        """The coordinate, or the difference of the two, at which the scene gives the body this angle or travel."""
        bond = self.bonds[name]
        away = self._offset(against) if against is not None else 0.0
        return (value - bond.shift) / bond.given + self._offset(self._holder(name).name) - away

    def _offset(self, name: str) -> float:
        """From an angle as the scene gives it to the coordinate, or to the difference of the two."""
        return self._riding[name].angle if self.scene.body(name).motion == "pivot" else 0.0


def forced_coordinates(
    scene: Scene,
    swinging: tuple[Oscillator, ...],
    riding: tuple[Ride, ...],
    bound: tuple[Bond, ...],
    slices: dict[str, slice],
    size: float,
    u: np.ndarray,
) -> Forced:
    """Coordinates with their forces; joints; force tables and their knots. `u`: velocities at the start.

    What acts on a geared body acts on the coordinate of the one it is geared to, with its ratio as lever arm.
    """
    count = sum(part.stop - part.start for part in slices.values())
    rows = records(COORDINATE, count)
    weighed = weigh(scene.bodies, riding)
    masses = felt(scene.bodies, riding, weighed)
    for i, body in enumerate(scene.bodies):
        if body.name in slices:
            _inertias(scene, body, i, weighed[i], riding[i], rows[slices[body.name]], size)
            if any(bond.to == i != k for k, bond in enumerate(bound)) and body.prescribed is None:
                rows[slices[body.name]].mass = masses[i]
    targets = _Targets(scene, swinging, riding, bound, slices, rows)
    _weigh_geared(scene, weighed, targets)
    _spring_up(scene, targets)
    stiffest = _watch(scene, targets)
    for damping in scene.damping:
        row, ratio = targets.row(damping.body, damping.against), abs(targets.ratio(damping.body))
        for law, power in DAMPING_LAWS.items():
            row[law] += ratio ** (power + 1) * getattr(damping, law)
        row.coulomb += ratio * damping.coulomb
    bearings = _bearings(scene, weighed, targets)
    tables, knots = _tables(scene, targets)
    joints = targets.joints
    if joints.coulomb.any():
        raise ValueError("dry friction between two bodies that turn is not simulated")
    # A spring's force vanishes at its rest, but for the rounding of the place there.
    at_rest = SPRING_AT_REST * rows.stiffness * rows.scale
    rows.load = np.abs(rows.force) + np.hypot(rows.weight_x, rows.weight_y) + at_rest
    tabled = {int(table.coordinate) for table in tables}
    lines = line_springs(scene)
    held = coordinates_of_lines(scene, lines, slices, bound)
    jointed = {*joints.coordinate.tolist(), *joints.on.tolist(), *(k for k, _ in held)}
    for i, row in enumerate(rows):
        bent = any(row[law] != 0.0 for law, power in DAMPING_LAWS.items() if power != 1)
        bent = bent or row.bent != 0
        bent = bent or any(one.coordinate == i and (one.moment_x or one.moment_y) for one in bearings)
        row.linear = not bent and row.weight_x == 0.0 and row.weight_y == 0.0 and i not in tabled | jointed
    inverse = np.where(rows.driven != 0, 0.0, 1.0 / rows.mass)
    light = 1.0 / (inverse[joints.coordinate] + inverse[joints.on])
    swings = np.sqrt(
        [
            *((rows.stiffness + rows.pinned) / rows.mass),
            stiffest,
            *(joints.stiffness / light),
            *(k / rows.mass[i] for i, k in held),
        ]
    )
    fastest = float(np.max(swings, initial=0.0))
    pull = np.abs(rows.force) + np.hypot(rows.weight_x, rows.weight_y)
    for table in tables:
        pull[table.coordinate] += np.max(np.abs(knots[table.start : table.start + table.count, 1]), initial=0.0)
    push = np.sqrt([*(pull / (rows.mass * rows.scale)), *(np.abs(joints.force) / light)])
    pushed, thrown = float(np.max(push, initial=0.0)), float(np.max(np.abs(u) / rows.scale, initial=0.0))
    rows.rate = fastest or pushed or thrown or 1.0
    # Without a spring nothing comes back by itself: what forces do takes longer than their rate says.
    slowest = float(np.min(swings[swings > 0.0])) if fastest else pushed / UNSPRUNG or thrown or 1.0
    return Forced((rows, joints, lines, bearings, tables, knots), fastest, max(slowest, SLOWEST_RATE * fastest))


def _spring_up(scene: Scene, targets: _Targets) -> None:
    """Springs on the coordinates and joints."""
    for spring in scene.springs:
        row = targets.row(spring.body, spring.against)
        # Several springs on one coordinate add up to one: stiffnesses add, rests average.
        stiffness = spring.stiffness * targets.ratio(spring.body) ** 2
        total = row.stiffness + stiffness
        rest = targets.place(spring.body, spring.rest, spring.against)
        row.rest = (row.stiffness * row.rest + stiffness * rest) / total
        row.stiffness = total
        if spring.cubic:
            row.cubic = spring.cubic * targets.ratio(spring.body) ** 4
        if spring.curb is not None:
            row.pinned = spring.stiffness * spring.curb.share / (1.0 - spring.curb.share)
            row.pin_low, row.pin_high = spring.curb.offset - spring.curb.gap, spring.curb.offset + spring.curb.gap
        if spring.cubic or spring.curb is not None or spring.wound is not None:
            row.bent = 1


def _bearings(scene: Scene, weighed: tuple[Weighed, ...], targets: _Targets) -> Records:
    """The pivots whose friction goes with their load, one row a body; what the weight alone makes goes into the coordinates."""
    numbers = {body.name: i for i, body in enumerate(scene.bodies)}
    tight = [bearing.body for bearing in scene.bearings if not bearing.play]
    bearings = records(BEARING, len(set(tight)))
    of = dict(zip(dict.fromkeys(tight), bearings, strict=True))
    for bearing in scene.bearings:
        if bearing.play:  # a contact; the stone under its end stays
            lying = replace(bearing, radius=0.0).torque(weighed[numbers[bearing.body]].mass, scene.gravity)
            targets.row(bearing.body).coulomb += lying
            continue
        row, load = of[bearing.body], weighed[numbers[bearing.body]]
        row.body, row.coordinate = numbers[bearing.body], targets.number(bearing.body)
        row.grip += bearing.friction * bearing.radius
        row.moment_x, row.moment_y = load.moment
        row.weight_x, row.weight_y = load.mass * scene.gravity[0], load.mass * scene.gravity[1]
        targets.row(bearing.body).coulomb += bearing.torque(load.mass, scene.gravity)
        targets.row(bearing.body).loaded = 1
    return bearings


def _watch(scene: Scene, targets: _Targets) -> float:
    """Marks the coordinates that swing, with their rest positions; returns the largest stiffness over inertia among them."""
    largest = 0.0
    for one in targets.swinging:
        if targets.on(one.body) < 0:
            row = targets.row(one.body)
            plain = one.weight == 0.0 and scene.body(one.body).motion == "pivot"
            row.watched, row.level = 1, row.rest if plain else targets.place(one.body, one.rest)
            largest = max(largest, (one.spring + one.weight) / one.inertia)
        else:
            targets.row(one.body).watched = 1
    return largest


def _inertias(scene: Scene, body: Body, number: int, weighed: Weighed, ride: Ride, rows: Records, size: float) -> None:
    """Masses, scales and gravity of one body's coordinates, with all that it carries."""
    gx, gy = scene.gravity
    rows.body = number
    motion = MOTION_CODE[body.motion]
    if body.prescribed is not None:
        rows.mass, rows.driven, rows.scale = 1.0, 1, 1.0 if motion == PIVOT else size
        rows.stiffness, rows.rest = body.prescribed.square, body.prescribed.middle
    elif motion == PIVOT:
        rows.mass, rows.scale = weighed.inertia, 1.0
        if ride.host < 0:  # a carried body is poised
            sx, sy = weighed.moment
            rows.weight_x, rows.weight_y = sx * gx + sy * gy, sx * gy - sy * gx
    elif motion == SLIDE:
        rows.mass, rows.scale = weighed.mass, size
        rows.force = weighed.mass * (gx * body.axis[0] + gy * body.axis[1])
    elif motion == FREE:
        rows.mass, rows.scale = (weighed.mass, weighed.mass, weighed.inertia), (size, size, 1.0)
        rows.force = (weighed.mass * gx, weighed.mass * gy, 0.0)


def _weigh_geared(scene: Scene, weighed: tuple[Weighed, ...], targets: _Targets) -> None:
    """Gravity on a sliding body that is geared to another; a geared one that turns is poised."""
    gx, gy = scene.gravity
    for body, load in zip(scene.bodies, weighed, strict=True):
        if body.geared is not None and body.motion == "slide" and scene.body(body.geared.to).prescribed is None:
            pull = load.mass * (gx * body.axis[0] + gy * body.axis[1])
            targets.row(body.name).force += targets.ratio(body.name) * pull


def _tables(scene: Scene, targets: _Targets) -> tuple[Records, np.ndarray]:
    """Constant torques go into the coordinates, the others into tables."""
    tabled: list[Torque] = []
    for torque in scene.torques:
        if torque.over == "constant":
            targets.row(torque.body, torque.against).force += targets.ratio(torque.body) * torque.value
        else:
            tabled.append(torque)
    paths = [body for body in scene.bodies if body.prescribed is not None and body.prescribed.table]
    tables = records(TABLE, len(tabled) + len(paths))
    knots: list[tuple[float, float]] = []
    for row, torque in zip(tables, tabled, strict=False):
        row.coordinate, row.on, row.over = (
            targets.number(torque.body),
            targets.on(torque.body, torque.against),
            OVER[torque.over] if torque.period is None else REPEATED,
        )
        row.start, row.count = len(knots), len(torque.table)
        over_angle, ratio = torque.over == "angle", targets.ratio(torque.body)
        knots.extend(
            sorted(
                (targets.place(torque.body, x, torque.against) if over_angle else x, ratio * value) for x, value in torque.table
            )
        )
    for row, body in zip(tables[len(tabled) :], paths, strict=True):
        assert body.prescribed is not None
        row.coordinate, row.on, row.over = targets.slices[body.name].start, -1, OVER_TIME
        row.start, row.count = len(knots), len(body.prescribed.table)
        knots.extend(body.prescribed.table)
    return tables, np.array(knots, float).reshape(len(knots), 2)


@dataclass(frozen=True)
class Compiled:
    """The model with what people need to read it."""

    model: Model
    layers: tuple[str, ...]  # of each primitive
    owners: tuple[str, ...]  # the body of the scene that each primitive was drawn for
    slices: dict[str, slice]  # coordinates of each body
    size: float  # m, the reach of the largest moving body
    q: np.ndarray
    u: np.ndarray
    fastest: float  # 1/s, largest natural frequency of a spring, 0 without springs
    unit: float  # s, a power of ten: about ten radians of the slowest spring, else of what forces, else velocities do
    declared: tuple[int, ...] = ()  # pairs of primitives of each pair of bodies
    against: tuple[tuple[int, int, float], ...] = ()  # coordinates given relative to a carrier: (own, carrier's or -1, angle)
    geared: tuple[tuple[int, float, float], ...] = ()  # further columns: ratio times that coordinate plus shift
    loose: frozenset[str] = (
        frozenset()
    )  # bodies with play, whose slice is their angle: two columns before it say where they are
    seen: Model | None = None  # in which candidates are sought, where that is another: bodies with play in the middle of it

    def columns(self, name: str) -> slice:
        """All coordinates of a body."""
        part = self.slices[name]
        return slice(part.start - 2, part.stop) if name in self.loose else part

    def relative(self, q: np.ndarray, rates: bool = False) -> np.ndarray:
        """Rows of coordinates, or of their `rates`, as the scene gives them: carried bodies relative to their carriers.

        Behind them stand columns of the bodies geared to others, which have no coordinate of their own.
        """
        out = np.array(q) if self.against else q
        for own, on, angle in self.against:
            out[:, own] -= (q[:, on] if on >= 0 else 0.0) + (0.0 if rates else angle)
        if self.geared:
            out = np.column_stack((out, *(ratio * out[:, to] + (0.0 if rates else shift) for to, ratio, shift in self.geared)))
        return out

    def own(self, number: int, values: np.ndarray, rates: bool = False) -> np.ndarray:
        """(rows,): the angle in the movement, or the travel, of the body of that number; `values` are rows of coordinates, or
        of their `rates`."""
        body = self.model.bodies[number]
        return np.asarray(body.ratio * values[:, angle_of(body)] + (0.0 if rates else body.phase))


_last: dict[bool, tuple[Scene, Compiled]] = {}  # by `prefilter`: the scene compiled last, which most often is the next one


def compile_scene(scene: Scene, prefilter: bool = True) -> Compiled:
    """Flatten a checked scene (SI units), into arrays that nobody writes to. Coordinates follow the order of the bodies.

    Without `prefilter` every declared pair of primitives is a candidate everywhere.
    """
    known = _last.get(prefilter)
    if known is None or known[0] is not scene:
        known = _last[prefilter] = scene, compiled_anew(scene, prefilter)
    return known[1]


def compiled_anew(scene: Scene, prefilter: bool) -> Compiled:
    """The same, of a scene that nobody will ask for again."""
    size, declared = scene_size(scene), scene
    scene, shafts = with_holes(scene)
    scene, named = with_racks(scene, size)
    named |= shafts
    riding = rides(scene.bodies)
    bound = bonds(scene.bodies, riding)
    bodies, q, u = _bodies(scene, riding, bound)
    slices = _slices(scene, bodies)
    primitives, layers, owners, sides = _primitives(scene, riding, size)
    owners = tuple(named.get(owner, owner) for owner in owners)
    contacts, laws, pairs, counts = declared_contacts(scene, bodies, riding, sides, primitives, CLEARANCE * size)
    forced = forced_coordinates(scene, oscillators(declared), riding, bound, slices, size, u)
    widen(declared, pairs)
    middle = in_the_middle(declared, bodies, primitives)
    near = near_contacts(*middle, contacts, pairs)
    choose_cells(*middle, contacts, pairs, near)
    if not prefilter:
        # The cells stay, so that time is parted in the same way; only their answers are not used.
        near = np.arange(len(contacts))
        pairs.near_start, pairs.near_stop, pairs.listed = pairs.start, pairs.stop, 0
    shocks, jolts, heavy = shaken(scene, weigh(scene.bodies, riding), bodies)
    for row in heavy:
        turns, loaded = any(one.turns for one in scene.shocks), forced.parts[0].loaded[bodies[row.body].first]
        if loaded or feels(row, scene.bodies[row.body].motion, turns):
            first = int(bodies[row.body].first)
            forced.parts[0].linear[first : first + (3 if bodies[row.body].motion == FREE else 1)] = 0
    springs, coils, terms = coiled(scene)
    for number, spring in enumerate(springs):
        forced.parts[0].coil[slices[spring.body].stop - 1] = 1 + number
    parts = (bodies, *forced.parts, primitives, contacts, laws, pairs, near, shocks, jolts, heavy, coils, terms)
    model = Model(*(frozen(part) for part in parts))
    with_play = frozenset(loose(declared))
    seen = model._replace(bodies=frozen(middle[0]), primitives=frozen(middle[1])) if with_play else None
    slices |= {name: slice(slices[name].stop - 1, slices[name].stop) for name in with_play}
    own = [(body.name, bond) for body, bond in zip(scene.bodies, bound, strict=True) if body.geared and body.name not in named]
    geared = tuple((int(bodies[bond.to].first), bond.given, bond.shift) for _, bond in own)
    slices |= {name: slice(len(q) + k, len(q) + k + 1) for k, (name, _) in enumerate(own)}
    unit, against = 10.0 ** round(math.log10(UNIT_PHASE / forced.slowest)), _against(riding, bodies, bound)
    return Compiled(
        *(model, layers, owners, slices, size, frozen(q), frozen(u), forced.fastest, unit, counts, against, geared),
        *(with_play, seen),
    )


def _against(riding: tuple[Ride, ...], bodies: Records, bound: tuple[Bond, ...]) -> tuple[tuple[int, int, float], ...]:
    """The angles that the scene gives relative to a carrier, of bodies with a coordinate of their own."""
    return tuple(
        (int(bodies[i].first), angle_of(bodies[ride.turns_with]) if ride.turns_with >= 0 else -1, ride.angle)
        for i, ride in enumerate(riding)
        if bodies[i].first >= 0 and bound[i].to == i and (ride.turns_with >= 0 or ride.angle != 0.0)
    )


_last_size: list[tuple[tuple[Body, ...], float]] = [((), 1e-3)]  # a scene is looked at for overlaps before it is compiled


def scene_size(scene: Scene) -> float:
    """The largest distance of an outline from its moving body's origin, m; 1 mm where nothing moving has outlines."""
    bodies, size = _last_size[0]
    if bodies is not scene.bodies:
        reaches = [_reach(body) for body in scene.bodies if body.motion != "fixed" and body.loops]
        size = max(reaches, default=0.0) or 1e-3
        _last_size[0] = scene.bodies, size
    return size


def _reach(body: Body) -> float:
    far = 0.0
    for loop in body.loops:
        for edge in loop.edges:
            far = max(far, *(math.hypot(*edge.point(f)) for f in (0.0, 0.25, 0.5, 0.75, 1.0)))
    return far


def _slices(scene: Scene, bodies: Records) -> dict[str, slice]:
    """The coordinates of each body that has some of its own."""
    count = {"fixed": 0, "pivot": 1, "slide": 1, "free": 3}
    return {
        body.name: slice(int(row.first), int(row.first) + count[body.motion])
        for body, row in zip(scene.bodies, bodies, strict=True)
        if count[body.motion] and body.geared is None
    }


def _bodies(scene: Scene, riding: tuple[Ride, ...], bound: tuple[Bond, ...]) -> tuple[Records, np.ndarray, np.ndarray]:
    rows = records(BODY, len(scene.bodies))
    q: list[float] = []
    u: list[float] = []
    for i, (body, ride) in enumerate(zip(scene.bodies, riding, strict=True)):
        carrier = ride.host if body.motion == "pivot" else -1
        direction = math.cos(ride.start), math.sin(ride.start)
        start = {"fixed": (), "pivot": (ride.start,), "slide": (0.0,), "free": (*body.position, body.angle)}[body.motion]
        # The whole record at once: writing one field takes as long.
        first = len(q) if start else -1
        line = bound[i].ratio, bound[i].phase
        rows[i] = (MOTION_CODE[body.motion], first, *ride.place, ride.start, *body.axis, *direction, carrier, *line)
        if body.geared is not None:
            continue
        q.extend(start)
        velocity = (ride.spin,) if body.motion == "pivot" else body.velocity
        u.extend(velocity if velocity else (0.0,) * len(start))
    for i, bond in enumerate(bound):
        if bond.to != i:
            rows[i].first = rows[bond.to].first
    return rows, np.array(q, float), np.array(u[: len(q)], float)


def _primitives(
    scene: Scene, riding: tuple[Ride, ...], size: float
) -> tuple[Records, tuple[str, ...], tuple[str, ...], dict[Side, np.ndarray]]:
    """All primitives that a contact names, their layers, their bodies, and by side of a contact the numbers of its primitives.

    Outlines of a part that is rigid with a moving body become outlines of that one.
    """
    named = list(dict.fromkeys(side for contact in scene.contacts for side in contact.sides))
    numbers = {body.name: number for number, body in enumerate(scene.bodies)}
    blocks: list[Records] = []
    layers: list[str] = []
    owners: list[str] = []
    of_layer: dict[tuple[str, str], np.ndarray] = {}
    for side in named:
        body, ride = scene.body(side.body), riding[numbers[side.body]]
        for layer in body.layers if side.layer is None else (side.layer,):
            if (side.body, layer) in of_layer:
                continue
            loops = [loop for loop in body.loops if loop.layer == layer]
            if ride.host == ride.part_of:
                loops = [loop.moved(ride.angle, ride.place) for loop in loops]
            start = len(layers)
            for block in (features(loop, ride.part_of, size) for loop in loops):
                for side_of in ("before", "after"):
                    block[side_of][block[side_of] >= 0] += len(layers)
                blocks.append(block)
                layers.extend([layer] * len(block))
                owners.extend([side.body] * len(block))
            of_layer[side.body, layer] = np.arange(start, len(layers))
    sides = {}
    for side in named:
        chosen = scene.body(side.body).layers if side.layer is None else (side.layer,)
        sides[side] = np.concatenate([of_layer[side.body, layer] for layer in chosen] or [np.zeros(0, int)]).astype(int)
    rows = np.concatenate(blocks).view(np.recarray) if blocks else records(PRIMITIVE, 0)
    return rows, tuple(layers), tuple(owners), sides
