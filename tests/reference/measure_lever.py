"""The parts of a drawn lever escapement, measured by ways that share nothing with the package.

Lock, lift, drop, draw, freedoms and the safety action: the drawings are read with ezdxf and turned against one another as
polygons of shapely, whose chords deviate by less than ten nanometres; millimetres and degrees. `moments`: area and polar
moment of outlines by Green's theorem with 30 digits (mpmath).
"""

import math
import re
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any, TypeAlias

import ezdxf
import mpmath
import numpy as np
import shapely
from shapely.geometry import Polygon, box
from shapely.geometry.base import BaseGeometry

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib
SAGITTA_MM = 1e-5
JOINT_MM = 1e-6
FINE = 1e-9
ELLIPSE_CHORDS = 2000
TO_MM = {"mm": 1.0, "µm": 1e-3, "m": 1e3}
TO_DEGREES = {"°": 1.0, "deg": 1.0, "rad": math.degrees(1.0)}


@dataclass(frozen=True)
class Part:
    """The layers of a body in its own frame (pivot at the origin), where it stands and how it is turned at the start."""

    layers: dict[str, BaseGeometry]
    position: tuple[float, float]
    angle: float


@dataclass(frozen=True)
class Layout:
    """All bodies of a scene, and its declared contacts as ((body, layer), (body, layer))."""

    parts: dict[str, Part]
    contacts: list[tuple[tuple[str, str], tuple[str, str]]]

    def shape(self, body: str, layers: list[str]) -> BaseGeometry:
        """Some layers of a body, in its own frame."""
        return shapely.union_all([self.parts[body].layers[name] for name in layers])

    def pairs(self, body: str, other: str) -> list[tuple[str, str]]:
        """The declared (layer of `body`, layer of `other`), in the order of the scene."""
        both = [pair for first in self.contacts for pair in (first, first[::-1])]
        return [(mine[1], yours[1]) for mine, yours in both if (mine[0], yours[0]) == (body, other)]

    def layers_between(self, body: str, other: str) -> list[str]:
        """The layers of `body` that may touch `other`."""
        return list(dict.fromkeys(mine for mine, _ in self.pairs(body, other)))


def placed(shape: BaseGeometry, degrees: float, position: tuple[float, float]) -> BaseGeometry:
    """The shape turned about its origin, then put at `position`."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    turn, shift = np.array(((c, s), (-s, c))), np.array(position)
    return shapely.transform(shape, lambda points: points @ turn + shift)


def first(condition: Callable[[float], bool], start: float, end: float, step: float) -> float | None:
    """The first place from `start` on, to FINE degrees, where the condition holds; None if it does not up to `end`."""
    low = high = start
    while not condition(high):
        if high >= end:
            return None
        low, high = high, min(high + step, end)
    while high - low > FINE:
        middle = (low + high) / 2.0
        low, high = (low, middle) if condition(middle) else (middle, high)
    return high


def read_layout(scene: Path) -> Layout:
    """Read a scene file and its drawings."""
    data = tomllib.loads(scene.read_text(encoding="utf-8"))
    parts = {name: _part(scene.parent, body) for name, body in data["bodies"].items()}
    contacts = []
    for contact in data["contacts"]:
        first, second = (side.split(".", 1) for side in contact["between"])
        contacts.append(((first[0], first[1]), (second[0], second[1])))
    return Layout(parts, contacts)


def _part(folder: Path, body: dict[str, Any]) -> Part:
    sheet = ezdxf.readfile(folder / body["drawing"])
    x, y = _pivot(sheet, body["pivot"])
    layers = {name: placed(_layer(sheet, name), 0.0, (-x, -y)) for name in body["layers"]}
    position = tuple(_number(value, TO_MM) for value in body["position"])
    return Part(layers, (position[0], position[1]), _number(body.get("angle", "0°"), TO_DEGREES))


def _pivot(sheet: Any, pivot: str | list[str]) -> tuple[float, float]:
    if isinstance(pivot, str):
        (point,) = sheet.modelspace().query(f'POINT[layer=="{pivot}"]')
        return (point.dxf.location.x, point.dxf.location.y)
    return (_number(pivot[0], TO_MM), _number(pivot[1], TO_MM))


def _number(text: str, units: dict[str, float]) -> float:
    value, unit = re.fullmatch(r"\s*([-+0-9.eE]+)\s*(\S+)\s*", text).groups()  # type: ignore[union-attr]
    return float(value) * units[unit]


def _layer(sheet: Any, name: str) -> BaseGeometry:
    """The closed outlines of a layer; an outline inside another one is a hole."""
    rings = _rings([_points(entity) for entity in sheet.modelspace() if entity.dxf.layer == name])
    shape: BaseGeometry = Polygon()
    for ring in sorted((Polygon(ring) for ring in rings), key=lambda polygon: -polygon.area):
        shape = shape.symmetric_difference(ring)
    return shape


def _points(entity: Any) -> np.ndarray[Any, Any]:
    """The vertices of one entity, (n, 2)."""
    if entity.dxftype() == "LWPOLYLINE":
        corners = [(x, y) for x, y, *_ in entity.get_points()]
        return np.array([*corners, corners[0]] if entity.closed else corners)
    if entity.dxftype() == "LINE":
        return np.array([(p.x, p.y) for p in (entity.dxf.start, entity.dxf.end)])
    if entity.dxftype() == "ELLIPSE":  # a full one that does not start at 0 comes out of `flattening` empty
        span = np.linspace(0.0, entity.construction_tool().param_span, ELLIPSE_CHORDS + 1)
        return np.array([(p.x, p.y) for p in entity.vertices(entity.dxf.start_param + span)])
    return np.array([(p.x, p.y) for p in entity.flattening(SAGITTA_MM)])


def _rings(strokes: list[np.ndarray[Any, Any]]) -> list[np.ndarray[Any, Any]]:
    """Join strokes end to end into closed rings."""
    rings, waiting = [], list(strokes)
    while waiting:
        ring = waiting.pop()
        while math.dist(ring[0], ring[-1]) > JOINT_MM:
            i, stroke = _next(ring[-1], waiting)
            waiting.pop(i)
            ring = np.vstack([ring, stroke[1:]])
        rings.append(ring[:-1])
    return rings


def _next(end: np.ndarray[Any, Any], waiting: list[np.ndarray[Any, Any]]) -> tuple[int, np.ndarray[Any, Any]]:
    for i, stroke in enumerate(waiting):
        for candidate in (stroke, stroke[::-1]):
            if math.dist(candidate[0], end) <= JOINT_MM:
                return i, candidate
    raise ValueError(f"the outline is open at ({end[0]:.6f}, {end[1]:.6f}) mm")


FAR = 180.0  # of the balance: the pin is opposite the fork
SWING = 1.0  # step of the balance in the scans


@dataclass(frozen=True)
class Safety:
    """Fork and safety action. Degrees unless the name says mm; nan where the scene has no dart."""

    lift_angle: float  # balance, from the pin's meeting the fork on one bank to its leaving on the other
    fork_play: float  # lever, with the pin in the middle of the slot
    horn_clearance_mm: float  # the pin's farthest point to the horn it passes, lever on the bank
    horn_freedom: float  # lever, from the bank to the horn's meeting the pin, where the dart faces the crescent: largest
    guard_clearance_mm: float  # dart to safety roller, lever on the bank
    guard_freedom: float  # lever, from the bank to the dart's meeting the roller
    worst_freedom: float  # lever, from the bank, over all places of the balance with the pin outside the fork
    worst_at: float  # balance angle of that
    beat_clearance_mm: float  # dart to safety roller while the pin is in the fork: smallest


class Roller:
    """Fork, pin, dart and safety roller: where they touch."""

    def __init__(self, layout: Layout, bank: float) -> None:
        pairs = layout.pairs("lever", "balance")
        self.bank = bank
        self.lever_at, self.balance_at = layout.parts["lever"].position, layout.parts["balance"].position
        self.fork, self.pin = layout.shape("lever", [pairs[0][0]]), layout.shape("balance", [pairs[0][1]])
        self.guarded = len(pairs) > 1
        self.dart = layout.shape("lever", [pairs[1][0]]) if self.guarded else Polygon()
        self.safety = layout.shape("balance", [pairs[1][1]]) if self.guarded else Polygon()

    def fork_touches(self, a: float, theta: float) -> bool:
        return bool(self.lever(self.fork, a).intersects(self.balance(self.pin, theta)))

    def dart_touches(self, a: float, theta: float) -> bool:
        return bool(self.lever(self.dart, a).intersects(self.balance(self.safety, theta)))

    def dart_gap(self, a: float, theta: float) -> float:
        """Distance from the dart to the safety roller; infinite without a dart."""
        if not self.guarded:
            return math.inf
        return float(self.lever(self.dart, a).distance(self.balance(self.safety, theta)))

    def lever(self, shape: BaseGeometry, a: float) -> BaseGeometry:
        return placed(shape, a, self.lever_at)

    def balance(self, shape: BaseGeometry, theta: float) -> BaseGeometry:
        return placed(shape, theta, self.balance_at)

    def freedom(self, theta: float, horns: bool = True, guard: bool = True) -> float:
        """How far the lever can be turned off its entry bank before it is stopped; nan if it never is."""

        def stopped(d: float) -> bool:
            a = self.bank - d
            return (horns and self.fork_touches(a, theta)) or (guard and self.dart_touches(a, theta))

        found = first(stopped, 0.0, 2.0 * self.bank, 0.1)
        return math.nan if found is None else found


def measure_safety(layout: Layout, bank: float) -> Safety:
    """All of it, for a lever that swings to ±`bank` degrees."""
    m = Roller(layout, bank)
    enters, leaves = lift(m)
    guard = m.freedom(FAR, horns=False) if m.guarded else 0.0
    places = _angles(-FAR, enters - SWING) if m.guarded else []
    outside = [(m.freedom(theta), theta) for theta in places]
    worst = max(outside or [(math.nan, math.nan)], key=lambda pair: math.inf if math.isnan(pair[0]) else pair[0])
    horn = [m.freedom(theta, guard=False) for _, theta in outside if m.freedom(theta, horns=False) > 1.5 * guard]
    return Safety(
        lift_angle=leaves - enters,
        fork_play=fork_play(m),
        horn_clearance_mm=horn_clearance(m),
        horn_freedom=max(horn, default=math.nan),
        guard_clearance_mm=m.dart_gap(bank, FAR) if m.guarded else math.nan,
        guard_freedom=guard if m.guarded else math.nan,
        worst_freedom=worst[0],
        worst_at=worst[1],
        beat_clearance_mm=beat_clearance(m, enters, leaves),
    )


def lift(m: Roller) -> tuple[float, float]:
    """Balance angles at which the pin meets the fork on the entry bank, and leaves it on the exit bank."""
    enters = first(lambda d: m.fork_touches(m.bank, d - FAR), 0.0, FAR, SWING)
    leaves = first(lambda d: m.fork_touches(-m.bank, FAR - d), 0.0, FAR, SWING)
    if enters is None or leaves is None:
        raise ValueError("the pin never meets the fork")
    return enters - FAR, FAR - leaves


def fork_play(m: Roller) -> float:
    """Free travel of the lever with the balance at rest."""
    up = first(lambda d: m.fork_touches(d, 0.0), 0.0, m.bank, 0.05)
    down = first(lambda d: m.fork_touches(-d, 0.0), 0.0, m.bank, 0.05)
    return math.nan if up is None or down is None else up + down


def horn_clearance(m: Roller) -> float:
    """On the entry bank the pin comes from the left: the left half of the fork against the pin's farthest point."""
    left = m.fork.intersection(box(-100.0, -100.0, 0.0, 100.0))
    reach = max(math.hypot(x, y) for x, y in shapely.get_coordinates(m.pin))
    return float(m.lever(left, m.bank).distance(shapely.Point(m.balance_at))) - reach


def beat_clearance(m: Roller, enters: float, leaves: float) -> float:
    """Carry the lever over with the pin and watch the dart at both ends of the play."""
    a, least = m.bank, math.inf
    for theta in _angles(enters - SWING, leaves + SWING):
        a, far = _play(m, a, theta)
        least = min(least, m.dart_gap(a, theta), m.dart_gap(far, theta))
    return least


def _play(m: Roller, a: float, theta: float) -> tuple[float, float]:
    """The lever angles between which the pin leaves it free, coming from `a` on the entry side."""
    push = first(lambda d: not m.fork_touches(a - d, theta), 0.0, 2.0 * m.bank, 0.02)
    if push is None:
        raise ValueError(f"the pin jams in the fork at {theta:.1f} degrees of the balance")
    near = a - push
    free = first(lambda d: m.fork_touches(near - d, theta), 1e-6, 2.0 * m.bank, 0.02)
    return near, -m.bank if free is None else max(near - free, -m.bank)


def _angles(start: float, end: float) -> list[float]:
    return [start + i * SWING for i in range(int((end - start) / SWING) + 1)]


TEETH = 15  # unless the caller says otherwise
STEPS = (0.04, 2e-3, 5e-5)  # of the lever, in the scan of a beat: coarse, then finer up to the let-off
LOST = 6.0  # the wheel turns this many lever steps without touching: it has been let off
GRAIN = 40  # steps in which the wheel is turned over a reach
TOE = 0.02  # a contact within this of the toe is at the toe


@dataclass(frozen=True)
class Beat:
    """One beat, in which the entry or the exit stone is unlocked and driven. Degrees unless a comment says mm."""

    bank: float  # lever, from the middle to the bank
    draw: float  # of the locking face, from the direction that would neither draw nor repel, lever on the bank
    unlock: float  # lever, from the bank until the toe leaves the locking face (run and lock)
    recoil: float  # wheel, backwards while it is unlocked
    lift_stone: float  # lever, with a toe on the impulse face of the stone
    lift_tooth: float  # lever, with the discharge corner on the impulse face of the tooth
    drop: float  # wheel, from let-off to the lock on the other stone
    lock: float  # lever, how deep the other stone locks at the end of the drop
    run: float  # lever, from let-off to the other bank
    spare_mm: float  # mm, least distance of the wheel from the other stone up to let-off
    wheel_start: float  # wheel, resting on the locking face with the lever on the bank (modulo the pitch)


@dataclass(frozen=True)
class Sweep:
    """Lever and wheel from the bank to let-off."""

    bank: float
    rows: list[tuple[float, float]]  # (a, q), a falling; the last row is at let-off
    unlocked: float
    farthest_back: float


class Escapement:
    """Wheel, stones and banking: where they touch."""

    def __init__(self, layout: Layout, teeth: int = TEETH) -> None:
        self.teeth = teeth
        self.layout = layout
        self.lever_at = layout.parts["lever"].position
        self.wheel_at = layout.parts["wheel"].position
        self.wheel = layout.shape("wheel", layout.layers_between("wheel", "lever"))
        shapely.prepare(self.wheel)
        stones = layout.shape("lever", layout.layers_between("lever", "wheel"))
        self.exit, self.entry = sorted(shapely.get_parts(stones), key=lambda stone: -stone.centroid.x)
        self.body = layout.shape("lever", layout.layers_between("lever", "banking"))
        self.banking = layout.shape("banking", layout.layers_between("banking", "lever"))

    def stone(self, side: int, a: float) -> BaseGeometry:
        """The entry (+1) or exit (-1) stone in the movement."""
        return placed(self.entry if side > 0 else self.exit, side * a, self.lever_at)

    def gap(self, q: float, stone: BaseGeometry) -> float:
        """Distance of the wheel from a stone; 0 where they overlap."""
        return float(shapely.distance(self.wheel, self._seen(q, stone)))

    def touches(self, q: float, stone: BaseGeometry) -> bool:
        return bool(shapely.intersects(self.wheel, self._seen(q, stone)))

    def bank(self, side: int) -> float:
        """Where the body meets the banking."""
        found = first(lambda a: placed(self.body, side * a, self.lever_at).intersects(self.banking), 0.0, 15.0, 0.1)
        if found is None:
            raise ValueError("the lever never meets its banking")
        return found

    def rest(self, q: float, stone: BaseGeometry, reach: float) -> float | None:
        """The wheel angle at which a tooth rests on the stone, coming from q; None if it is free for `reach`.

        A wheel that overlaps the stone is turned back until it does not.
        """
        if self.touches(q, stone):
            back = first(lambda d: not self.touches(q + d, stone), 0.0, reach, reach / GRAIN)
            return None if back is None else q + back
        ahead = first(lambda d: self.touches(q - d, stone), 0.0, reach, reach / GRAIN)
        return None if ahead is None else q - ahead

    def at_toe(self, q: float, stone: BaseGeometry) -> bool:
        """Does the wheel touch with a toe (a corner on the x axis of the wheel's frame, or a whole pitch from it)?"""
        x, y = shapely.shortest_line(self.wheel, self._seen(q, stone)).coords[0]
        pitch = 360.0 / self.teeth
        return abs((math.degrees(math.atan2(y, x)) + pitch / 2.0) % pitch - pitch / 2.0) < TOE

    def _seen(self, q: float, stone: BaseGeometry) -> BaseGeometry:
        """The stone in the wheel's own frame."""
        x, y = self.wheel_at
        return placed(placed(stone, 0.0, (-x, -y)), -q, (0.0, 0.0))


def measure(scene: Path, teeth: int = TEETH) -> tuple[Beat, Beat, Safety]:
    """Entry beat, exit beat and safety action of a scene."""
    layout = read_layout(scene)
    m = Escapement(layout, teeth)
    paths = {side: follow(m, side) for side in (1, -1)}
    return _beat(m, paths, 1), _beat(m, paths, -1), measure_safety(layout, m.bank(1))


def follow(m: Escapement, side: int) -> Sweep:
    """Turn the lever from the bank until the wheel is let off, the wheel always resting on the stone."""
    bank = m.bank(side)
    start = m.rest(0.0, m.stone(side, bank), 24.0)
    if start is None:
        raise ValueError("no tooth locks with the lever on the bank")
    rows = [(bank, start)]
    for step in STEPS:
        rows += _until_lost(m, side, rows[-1], step)
    unlocked, back = _kink(m, side, max(rows, key=lambda row: row[1]))
    return Sweep(bank, rows, unlocked, back)


def _until_lost(m: Escapement, side: int, row: tuple[float, float], step: float) -> list[tuple[float, float]]:
    """Rows after this one, the lever going on in steps, until the wheel is free."""
    a, q = row
    rows: list[tuple[float, float]] = []
    while True:
        a -= step
        found = m.rest(q, m.stone(side, a), LOST * step)
        if found is None:
            return rows
        q = found
        rows.append((a, q))


def _kink(m: Escapement, side: int, top: tuple[float, float]) -> tuple[float, float]:
    """Where the wheel has been driven back farthest, by trisection around the highest row."""
    low, high = top[0] - STEPS[0], top[0] + STEPS[0]
    reach = LOST * STEPS[0]

    def height(a: float) -> float:
        return m.rest(top[1] + 0.1 * reach, m.stone(side, a), reach) or -math.inf

    while high - low > 1e-6:
        third = (high - low) / 3.0
        low, high = (low + third, high) if height(low + third) < height(high - third) else (low, high - third)
    return low, height(low)


def draw_angle(m: Escapement, side: int, bank: float, q: float) -> float:
    """Angle between the locking face and the direction square to the line from the lever's pivot to the contact."""
    stone = m.stone(side, bank)
    x, y = m.lever_at
    contact = shapely.shortest_line(placed(m.wheel, q, m.wheel_at), stone).coords[1]
    ring = list(stone.exterior.coords)
    (x0, y0), (x1, y1) = min(pairwise(ring), key=lambda edge: shapely.LineString(edge).distance(shapely.Point(contact)))
    face = math.degrees(math.atan2(y1 - y0, x1 - x0))
    square = math.degrees(math.atan2(contact[1] - y, contact[0] - x)) + 90.0
    return abs((face - square + 90.0) % 180.0 - 90.0)


def _beat(m: Escapement, paths: dict[int, Sweep], side: int) -> Beat:
    path, other = paths[side], paths[-side]
    let_off, last = path.rows[-1]
    landed = m.rest(last, m.stone(-side, -let_off), 12.0)
    toe = [a for a, q in path.rows if a < path.unlocked and m.at_toe(q, m.stone(side, a))]
    change = min(toe, default=let_off)
    return Beat(
        bank=path.bank,
        draw=draw_angle(m, side, path.bank, path.rows[0][1]),
        unlock=path.bank - path.unlocked,
        recoil=path.farthest_back - path.rows[0][1],
        lift_stone=path.unlocked - change,
        lift_tooth=change - let_off,
        drop=math.nan if landed is None else last - landed,
        lock=-let_off - other.unlocked,
        run=other.bank + let_off,
        spare_mm=min(m.gap(q, m.stone(-side, -a)) for a, q in path.rows),
        wheel_start=path.rows[0][1],
    )


DIGITS = 30
NODES = 12
Number: TypeAlias = Any  # mpmath.mpf, which has no types


def moments(loops: Iterable[Loop]) -> tuple[Number, Number]:
    """Area (m²) and polar moment (m⁴) about the origin."""
    with mpmath.workdps(DIGITS):
        area = polar = mpmath.mpf(0)
        for loop in loops:
            end = _ends(loop.edges[-1])(mpmath.mpf(1))
            for edge in loop.edges:
                point = _ends(edge)
                start = point(mpmath.mpf(0))
                for way in (_straight(end, start), point):
                    a, p = _along(way, edge if way is point else None)
                    area, polar = area + a, polar + p
                end = point(mpmath.mpf(1))
        return area, polar


def _ends(edge: Edge) -> Callable[[Number], tuple[Number, Number]]:
    if isinstance(edge, Arc):
        x, y, r, start, sweep = (mpmath.mpf(v) for v in (edge.x, edge.y, edge.radius, edge.start_angle, edge.sweep))
        if edge.is_circle:
            sweep = mpmath.sign(sweep) * 2 * mpmath.pi
        return lambda t: (x + r * mpmath.cos(start + t * sweep), y + r * mpmath.sin(start + t * sweep))
    a, b = (tuple(mpmath.mpf(v) for v in p) for p in (edge.start, edge.end))
    return _straight(a, b)


def _straight(a: tuple[Number, Number], b: tuple[Number, Number]) -> Callable[[Number], tuple[Number, Number]]:
    return lambda t: (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]))


def _along(way: Callable[[Number], tuple[Number, Number]], edge: Edge | None) -> tuple[Number, Number]:
    """½ ∮ (x dy − y dx) and ¼ ∮ (x² + y²)(x dy − y dx) over one piece: of homogeneous integrands, by Green's theorem."""
    if edge is None and way(mpmath.mpf(0)) == way(mpmath.mpf(1)):
        return mpmath.mpf(0), mpmath.mpf(0)

    nodes, weights = _rule()
    parts = math.ceil(abs(edge.sweep) / 0.4) if isinstance(edge, Arc) else 1
    first = second = mpmath.mpf(0)
    for part in range(parts):
        for node, weight in zip(nodes, weights, strict=True):
            t = (part + (1 + node) / 2) / parts
            (x, y), (dx, dy) = way(t), _slope(way, edge, t)
            turn = weight * (x * dy - y * dx) / (2 * parts)
            first, second = first + turn, second + (x * x + y * y) * turn
    return first / 2, second / 4


@cache
def _rule() -> tuple[list[Number], list[Number]]:
    """Nodes and weights of Gauss and Legendre: the double ones, polished by Newton's method."""
    nodes, weights = [], []
    for guess in np.polynomial.legendre.leggauss(NODES)[0]:
        x = mpmath.mpf(guess)
        for _ in range(3):
            value, before = mpmath.legendre(NODES, x), mpmath.legendre(NODES - 1, x)
            slope = NODES * (x * value - before) / (x * x - 1)
            x -= value / slope
        nodes.append(x)
        weights.append(2 / ((1 - x * x) * slope**2))
    return nodes, weights


def _slope(way: Callable[[Number], tuple[Number, Number]], edge: Edge | None, t: Number) -> tuple[Number, Number]:
    if isinstance(edge, Arc):
        (x, y), sweep = way(t), mpmath.mpf(edge.sweep)
        if edge.is_circle:
            sweep = mpmath.sign(sweep) * 2 * mpmath.pi
        return -sweep * (y - mpmath.mpf(edge.y)), sweep * (x - mpmath.mpf(edge.x))
    (ax, ay), (bx, by) = way(mpmath.mpf(0)), way(mpmath.mpf(1))
    return bx - ax, by - ay
