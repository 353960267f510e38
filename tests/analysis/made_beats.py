"""Which beats are known exactly, so that what is read from a run can be checked?

Hand-made runs: nothing is simulated, every row and event follows from a formula.
"""

import functools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line, Point
from watchsim.paths import profiles_dir
from watchsim.scene.forces import Contact, Side, Spring, Torque
from watchsim.scene.load import load
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.recording import Pair
from watchsim.simulation.state import EVENT_DTYPE, EventKind, Stop
from watchsim.simulation.trajectory import Trajectory

HERTZ = 4.0
PERIOD = 1.0 / HERTZ
OMEGA = math.tau * HERTZ
INERTIA = 1.2e-9
BALANCE, LEVER, WHEEL = 0, 1, 2
LOCKING, IMPULSE, PIN, BANK = range(4)  # rows of PAIRS
DEGREE = math.pi / 180.0

# What happens in a beat of the made lever, angles of the wheel in the sense of its drive from where it stood locked before.
RECOIL, CAUGHT, LET_OFF, LOCKED = -0.25, 0.5, 10.0, 12.0  # degrees
ENTRY, UNLOCKED, CATCH, DROP, LOCK, BANKED = -26.0, -15.0, -12.0, 21.0, 22.5, 24.0  # degrees of the balance


def polygon(points: Sequence[complex], layer: str = "TEETH", hole: bool = False) -> Loop:
    """A closed outline through the points (complex, metres)."""
    ends = [*points[1:], points[0]]
    return Loop(tuple(Line(a.real, a.imag, b.real, b.imag) for a, b in zip(points, ends, strict=True)), layer, True, hole)


def star(teeth: int, tip: float = 2.5e-3, root: float = 2.0e-3) -> Loop:
    """Pointed teeth, leaning."""
    turns = [(k + lean) * math.tau / teeth for k in range(teeth) for lean in (0.0, 0.3)]
    radii = [tip, root] * teeth
    return polygon([r * complex(math.cos(a), math.sin(a)) for r, a in zip(radii, turns, strict=True)])


def lever_scene(rest: float = 0.0) -> Scene:
    """A balance on a spring, a wheel of 15 teeth that is driven clockwise, a lever between them, banking pins."""
    bodies = (
        Body("balance", inertia=INERTIA, velocity=(0.0,)),
        Body("lever", inertia=1e-12, velocity=(0.0,)),
        Body("wheel", inertia=1e-12, velocity=(0.0,), loops=(star(15),)),
        Body("banking", "fixed"),
    )
    touching = (("wheel", "TEETH", "lever"), ("lever", None, "balance"), ("lever", None, "banking"))
    contacts = tuple(Contact((Side(a, layer), Side(b))) for a, layer, b in touching)
    spring = Spring("balance", INERTIA * OMEGA**2, rest)
    return Scene("Made lever", bodies, (spring,), (Torque("wheel", -1e-6),), contacts=contacts, lift_angle=52.0 * DEGREE)


PAIRS = (
    Pair(0, "wheel", "corner", 3, "TEETH", "lever", "line", 1, "STONES"),
    Pair(0, "wheel", "corner", 3, "TEETH", "lever", "line", 2, "STONES"),
    Pair(1, "balance", "arc", 0, "PIN", "lever", "line", 7, "FORK"),
    Pair(2, "banking", "arc", 0, "PINS", "lever", "line", 9, "ARMS"),
)


class Events:
    """Collects events, gives them in order of time."""

    def __init__(self) -> None:
        self.rows: list[tuple[float, ...]] = []

    def touch(self, t: float, kind: EventKind, pair: int, lost: float = 0.0) -> None:
        self.rows.append((t, kind, pair, -1, 0.0, 0.0, lost, 0.0))

    def passage(self, t: float, kind: EventKind, value: float, body: int = BALANCE) -> None:
        self.rows.append((t, kind, -1, body, 0.0, 0.0, 0.0, value))

    def table(self) -> np.ndarray:
        return np.array(sorted(self.rows, key=lambda row: row[0]), dtype=EVENT_DTYPE)


def balance_only(events: Events, duration: float, scene: Scene | None = None, pairs: tuple[Pair, ...] = PAIRS) -> Trajectory:
    """A run of which only the events matter: a single row at the start."""
    scene = scene or lever_scene()
    moving = [body.name for body in scene.bodies if body.motion != "fixed"]
    slices = {name: slice(i, i + 1) for i, name in enumerate(moving)}
    zero = np.zeros((1, len(moving)))
    return Trajectory(scene, np.zeros(1), zero, zero, zero, slices, events.table(), pairs, Stop.DURATION, simulated=duration)


def steady_swings(count: int, amplitude: float, offset: float = 0.0, period: float = PERIOD) -> Events:
    """Turning points and passages of offset + amplitude · -cos: it starts at a turning point, which is no event."""
    events, omega = Events(), math.tau / period
    for k in range(count):
        way = 1.0 if k % 2 == 0 else -1.0
        events.passage((k + 0.5) * 0.5 * period, EventKind.CROSS, way * amplitude * omega)
        events.passage((k + 1) * 0.5 * period, EventKind.TURN, offset + way * amplitude)
    return events


def lever_run(count: int, amplitude: float = 270.0 * DEGREE, missed: Sequence[int] = (), rows_from: float = -1.0) -> Trajectory:
    """`count` half swings of a lever that works, but for the `missed` ones, in which the wheel stays where it is.

    Each beat: ENTRY, UNLOCKED (the wheel recoiled most), CATCH, DROP (let-off), LOCK with a rebound, BANKED; rows before
    `rows_from` are not kept.
    """
    events = steady_swings(count, amplitude)
    wheel, lever = [(0.0, 0.0)], [(0.0, 5.0)]
    events.touch(0.0, EventKind.CLOSE, LOCKING)
    for k in range(count):
        middle, way = (k + 0.5) * 0.5 * PERIOD, 1.0 if k % 2 == 0 else -1.0
        times = [
            middle + math.asin(angle * DEGREE / amplitude) / OMEGA for angle in (ENTRY, UNLOCKED, CATCH, DROP, LOCK, BANKED)
        ]
        events.touch(times[0], EventKind.IMPACT, PIN, 1e-10)
        if k in missed:
            continue
        _beat_events(events, times)
        start = wheel[-1][1]
        wheel += zip(times[:5], (start + turn for turn in (0.0, RECOIL, CAUGHT, LET_OFF, LOCKED)), strict=True)
        lever += zip((times[0], times[5]), (5.0 * way, -5.0 * way), strict=True)
    end = count * 0.5 * PERIOD
    wheel, lever = [*wheel, (end, wheel[-1][1])], [*lever, (end, lever[-1][1])]
    t, columns = _rows(amplitude, wheel, lever, end)
    kept = t >= rows_from
    run = balance_only(events, end)
    q, u, a = (column[kept] for column in columns)
    return replace(run, t=t[kept], q=q, u=u, a=a)


def _beat_events(events: Events, times: Sequence[float]) -> None:
    _, unlocked, catch, drop, lock, banked = times
    events.touch(unlocked, EventKind.OPEN, LOCKING)
    events.touch(catch, EventKind.IMPACT, IMPULSE, 2e-9)
    events.touch(catch + 1e-5, EventKind.IMPACT, IMPULSE, 1e-10)
    events.touch(catch + 2e-5, EventKind.CLOSE, IMPULSE)
    events.touch(drop, EventKind.OPEN, IMPULSE)
    events.touch(lock, EventKind.IMPACT, LOCKING, 2e-8)
    events.touch(lock + 1e-5, EventKind.IMPACT, LOCKING, 1e-9)
    events.touch(lock + 2e-5, EventKind.CLOSE, LOCKING)
    events.touch(banked, EventKind.IMPACT, BANK, 1e-9)


def _rows(
    amplitude: float, wheel: list[tuple[float, float]], lever: list[tuple[float, float]], end: float
) -> tuple[np.ndarray, list]:
    """Rows on a grid and twice at every kink of the broken lines of wheel (turned clockwise) and lever, in degrees."""
    kinks = np.unique([t for t, _ in (*wheel, *lever)])
    pieces = [np.linspace(a, b, 2 + int((b - a) / 2e-3)) for a, b in pairwise(kinks)]
    t = np.concatenate(pieces)
    # The velocity of a piece is the same at its two ends.
    inside = np.concatenate([np.full(len(piece), 0.5 * (piece[0] + piece[-1])) for piece in pieces])
    q, u = [-amplitude * np.cos(OMEGA * t)], [amplitude * OMEGA * np.sin(OMEGA * t)]
    for line, sign in ((lever, 1.0), (wheel, -1.0)):
        places, values = (np.array(column) for column in zip(*line, strict=True))
        slopes = np.diff(values) / np.maximum(np.diff(places), 1e-12)
        q.append(sign * DEGREE * np.interp(t, places, values))
        u.append(sign * DEGREE * slopes[np.clip(np.searchsorted(places, inside) - 1, 0, len(slopes) - 1)])
    a = [amplitude * OMEGA**2 * np.cos(OMEGA * t), 0.0 * t, 0.0 * t]
    return t, [np.column_stack(columns) for columns in (q, u, a)]


# Which small changes make a watch that ticks fail, each in its own way?
#
# All are made from the Swiss lever profile; `turned_over` and `renamed` change what no verdict may depend on.

NAMES = {"wheel": "rad", "lever": "anker", "balance": "unruh", "banking": "stifte"}
EDGES = 6  # of a tooth of the Swiss lever's wheel; the first two meet at its toe
TEETH = 15


@functools.cache
def _swiss() -> Scene:
    return load(profiles_dir() / "swiss_lever")


def swiss(**changes: str) -> Scene:
    """The profile with changes such as torques_0_value = "-1.5 µN·m"."""
    scene = _swiss()
    for key, value in changes.items():
        scene = scene.set(key.replace("_", "."), value)
    return replace(scene, expect=())


def unguarded(scene: Scene) -> Scene:
    """Without its guard pin: the dart touches nothing."""
    return replace(scene, contacts=tuple(one for one in scene.contacts if all(side.layer != "DART" for side in one.sides)))


def knocked(scene: Scene, t: float, torque: float, lasting: float = 2e-3) -> Scene:
    """A knock on the lever at time t (s)."""
    table = ((0.0, 0.0), (t, 0.0), (t + 1e-5, torque), (t + lasting, torque), (t + lasting + 1e-5, 0.0), (1e4, 0.0))
    return replace(scene, torques=(*scene.torques, Torque("lever", over="time", table=table)))


def on_teeth(scene: Scene, change: Callable[[Loop], Loop]) -> Scene:
    """Another outline of the wheel's rim; holes stay."""
    bodies = tuple(
        replace(body, loops=tuple(loop if loop.hole else change(loop) for loop in body.loops)) if body.name == "wheel" else body
        for body in scene.bodies
    )
    return replace(scene, bodies=bodies)


def chipped(scene: Scene, tooth: int, depth: float, back: float = 0.0) -> Scene:
    """The toe of one tooth worn off: towards the centre by `depth` (m), and by the share `back` of its impulse face."""

    def worn(loop: Loop) -> Loop:
        edges = list(loop.edges)
        front, top = edges[EDGES * tooth], edges[EDGES * tooth + 1]
        assert isinstance(front, Line) and isinstance(top, Line) and front.end == top.start
        (x, y), (heel_x, heel_y) = front.end, top.end
        share = 1.0 - depth / math.hypot(x, y)
        toe = (share * (x + back * (heel_x - x)), share * (y + back * (heel_y - y)))
        edges[EDGES * tooth], edges[EDGES * tooth + 1] = Line(*front.start, *toe), Line(*toe, *top.end)
        return Loop(tuple(edges), loop.layer)

    return on_teeth(scene, worn)


def toothless(scene: Scene, tooth: int) -> Scene:
    """Without one tooth."""

    def broken(loop: Loop) -> Loop:
        edges = list(loop.edges)
        first = EDGES * tooth
        # From the root before the tooth to the root behind it.
        low, high = edges[first - 1], edges[first + 3]
        edges[first : first + 3] = [Line(*low.end, *high.start)]
        return Loop(tuple(edges), loop.layer)

    return on_teeth(scene, broken)


def eccentric(scene: Scene, shift: float) -> Scene:
    """The rim off its centre by `shift` (m)."""
    return on_teeth(scene, lambda loop: loop.moved(0.0, (shift, 0.0)))


def turned_over(scene: Scene) -> Scene:
    """The same watch seen in a mirror: everything turns the other way."""

    def over(body: Body) -> Body:
        return replace(
            body,
            position=_across(body.position),
            angle=-body.angle,
            velocity=tuple(-one for one in body.velocity),
            loops=tuple(loop.reflected((0.0, 0.0), (0.0, 1.0)) for loop in body.loops),
        )

    def against(torque: Torque) -> Torque:
        return replace(torque, value=-torque.value, table=tuple((at, -value) for at, value in torque.table))

    springs = tuple(replace(spring, rest=-spring.rest) for spring in scene.springs)
    return replace(scene, bodies=tuple(map(over, scene.bodies)), springs=springs, torques=tuple(map(against, scene.torques)))


def _across(point: Point) -> Point:
    return -point[0], point[1]


def renamed(scene: Scene, names: Mapping[str, str] = NAMES) -> Scene:
    """Other words for all bodies, listed the other way round."""

    def told(contact: Contact) -> Contact:
        first, second = (Side(names[side.body], side.layer) for side in contact.sides)
        return replace(contact, sides=(second, first))

    return replace(
        scene,
        bodies=tuple(replace(body, name=names[body.name]) for body in reversed(scene.bodies)),
        springs=tuple(replace(one, body=names[one.body]) for one in scene.springs),
        torques=tuple(replace(one, body=names[one.body]) for one in scene.torques),
        damping=tuple(replace(one, body=names[one.body]) for one in scene.damping),
        contacts=tuple(map(told, scene.contacts)),
    )
