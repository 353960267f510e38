"""What is marked in a picture: contacts, forces, stones; and what do its numbers say: time, speed, angles, scale?"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

import numpy as np
from matplotlib.path import Path
from numpy.typing import NDArray

from watchsim.analysis.forces import forces
from watchsim.escapement.measure import Function, measure
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Point
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model import LINE, Records
from watchsim.render.parts import loops_of, outline
from watchsim.render.view import Window, nearest
from watchsim.scene.roles import pallet_word
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.state import EventKind
from watchsim.simulation.trajectory import Array, Trajectory, frames
from watchsim.storage.columns import blocks
from watchsim.units import decimals_for, signed

# An arrow begins where two bodies touch and tells the force on that one of them which comes later in the scene and can move:
# on the lever from the wheel, on the balance from the lever. All arrows of a movie have one scale.


HEAD, WIDE, SHAFT = 0.28, 0.1, 0.034  # of the longest arrow: length of a head, half widths of head and shaft
AT_ONCE = 2000  # instants
LEAST = 0.02  # of the longest arrow: shorter ones are dots


class ForceArrows:
    """Points (m) and forces (N) at the instants of a movie. ValueError where the forces of a run are not known."""

    def __init__(self, run: Trajectory, times: Array) -> None:
        self._at: list[tuple[Array, Array]] = []
        # Bodies in their order, fixed ones before all others.
        rank = {body.name: -1 if body.motion == "fixed" else k for k, body in enumerate(run.scene.bodies)}
        model = compile_scene(run.scene).model
        body, contacts = model.primitives.body, model.contacts
        # Not of gears with play or of a stop, which have no place.
        drawn = np.maximum(body[contacts.a], body[contacts.b]) < len(run.scene.bodies)
        for start in range(0, len(times), AT_ONCE):
            found = forces(run, times[start : start + AT_ONCE])
            pairs = [run.pairs[number] for number in found.pairs.tolist()]
            sign = [1.0 if rank[one.body_a] > rank[one.body_b] else -1.0 for one in pairs]
            on_later = found.on_a * np.array(sign).reshape(1, -1, 1)
            for points, own in zip(found.point, on_later, strict=True):
                held = np.isfinite(points[:, 0]) & drawn[found.pairs]
                self._at.append((points[held], own[held]))
        self.largest = max((float(np.hypot(*own.T).max()) for _, own in self._at if len(own)), default=0.0)

    def at(self, k: int) -> tuple[Array, Array]:
        """Points (n, 2), m, and forces (n, 2), N, of the k-th instant."""
        return self._at[k]

    @property
    def round_force(self) -> float:
        """A round force (N) of at most the largest, for the scale; 0 where nothing presses."""
        return round_below(self.largest) if self.largest > 0.0 else 0.0


def arrow_path(starts: Array, ways: Array, longest: float) -> Path | None:
    """Filled arrows (pixels) from `starts` (n, 2) by `ways` (n, 2); None where there are none to be seen."""
    made = [
        _arrow(start, way, length, longest)
        for start, way, length in zip(starts, ways, np.hypot(*ways.reshape(-1, 2).T).tolist(), strict=True)
        if length > LEAST * longest
    ]
    return Path.make_compound_path(*made) if made else None


def _arrow(start: Array, way: Array, length: float, longest: float) -> Path:
    along = way / length
    across = np.array([-along[1], along[0]])
    head = min(HEAD * longest, 0.6 * length)
    wide, shaft = WIDE * longest * head / (HEAD * longest), SHAFT * longest * min(1.0, length / (0.5 * longest))
    neck = length - head
    outline = [(0, shaft), (neck, shaft), (neck, wide), (length, 0), (neck, -wide), (neck, -shaft), (0, -shaft), (0, shaft)]
    codes = [Path.MOVETO, *[Path.LINETO] * 6, Path.CLOSEPOLY]
    return Path([start + x * along + y * across for x, y in outline], codes)


# A contact is closed from the event that closed it to the one that opened it; its point lies on the circle it was compiled
# to, in the direction of the other side.


class ContactMarks:
    """The closed contacts of a run. ValueError where its events number contacts that the scene does not have."""

    def __init__(self, run: Trajectory) -> None:
        names = [body.name for body in run.scene.bodies]
        model = compile_scene(run.scene).model
        changes = np.concatenate([_changes(part) for (part,) in blocks(run.events)] or [_changes(run.events)])
        if len(changes) and changes["contact"].max() >= len(model.contacts):
            raise ValueError("contacts cannot be marked: the events of this run do not belong to its scene")
        self._history: dict[int, tuple[Array, NDArray[np.bool_]]] = {}
        self._sides: dict[int, tuple[Side, Side]] = {}
        for k in map(int, np.unique(changes["contact"])):
            events, contact = changes[changes["contact"] == k], model.contacts[k]
            if max(model.primitives[contact.a].body, model.primitives[contact.b].body) >= len(names):
                continue  # of gears with play, whose teeth are not drawn
            self._history[k] = np.array(events["t"]), events["closes"]
            self._sides[k] = Side.of(model.primitives[contact.a], names), Side.of(model.primitives[contact.b], names)

    def closed(self, t: float) -> list[int]:
        """The numbers of the contacts that are closed at `t` (s)."""
        last = ((k, int(times.searchsorted(t, side="right")) - 1, closes) for k, (times, closes) in self._history.items())
        return [k for k, row, closes in last if row >= 0 and closes[row]]

    @property
    def numbers(self) -> tuple[int, ...]:
        """The contacts that are closed at any time of the run."""
        return tuple(self._history)

    def stretches(self, number: int, window: tuple[float, float]) -> list[tuple[float, float]]:
        """From when to when (s) that contact is closed, as far as it lies in the window."""
        start, stop = window
        found: list[tuple[float, float]] = []
        since: float | None = None
        for t, closes in zip(*(column.tolist() for column in self._history[number]), strict=True):
            if since is not None and t > since:
                found.append((since, t))
            since = t if closes else None
        if since is not None:
            found.append((since, stop))
        return [(max(low, start), min(high, stop)) for low, high in found if low < stop and high > start]

    def sides(self, number: int) -> tuple[Side, Side]:
        """The two primitives of that contact: a circle or corner, and what it touches."""
        return self._sides[number]

    def points(self, t: float, frames: dict[str, Array]) -> Array:
        """(n, 2) points of the contacts closed at `t`, metres, for the poses x, y, angle of that instant."""
        return np.array([_touch(*self._sides[k], frames) for k in self.closed(t)]).reshape(-1, 2)


def _changes(events: NDArray[Any]) -> NDArray[Any]:
    """(t, contact, closes) of everything that closes or opens a contact; a hand-over does both."""
    kinds = (EventKind.CLOSE, EventKind.OPEN, EventKind.HANDOVER)
    rows: list[tuple[float, int, bool]] = []
    for event in events[np.isin(events["kind"], kinds)]:
        if event["kind"] == EventKind.HANDOVER:
            rows.append((event["t"], int(event["value"]), False))
        rows.append((event["t"], event["contact"], event["kind"] != EventKind.OPEN))
    return np.array(rows, dtype=[("t", "f8"), ("contact", "i8"), ("closes", "?")])


@dataclass(frozen=True)
class Side:
    """A primitive in its body's frame: a circle's centre, radius and side; a line has its outward normal instead."""

    body: str
    x: float
    y: float
    radius: float
    side: float
    normal: Point | None

    @classmethod
    def of(cls, primitive: Records, names: list[str]) -> Side:
        """The side that a primitive of the model is; `names` are those of the bodies."""
        # Outward normal of a line: the direction of travel turned by -90 degrees.
        normal = (float(primitive.ty), -float(primitive.tx)) if primitive.kind == LINE else None
        x, y, radius, side = (float(primitive[name]) for name in ("x", "y", "radius", "side"))
        return cls(names[primitive.body], x, y, radius, side, normal)


def _touch(a: Side, b: Side, frames: dict[str, Array]) -> Point:
    """From the circle's centre towards B's material by its radius, against B's outward normal."""
    x, y = _world(frames[a.body], a.x, a.y)
    bx, by, turn = frames[b.body]
    if b.normal is not None:
        nx, ny = _world((0.0, 0.0, turn), *b.normal)
    else:
        px, py = _world((bx, by, turn), b.x, b.y)
        apart = b.side * math.hypot(x - px, y - py) or 1.0
        nx, ny = (x - px) / apart, (y - py) / apart
    return x - a.radius * nx, y - a.radius * ny


def _world(frame: Sequence[float] | Array, x: float, y: float) -> Point:
    c, s = math.cos(frame[2]), math.sin(frame[2])
    return frame[0] + c * x - s * y, frame[1] + s * x + c * y


# The stone that a tooth meets first on its way is the entry stone, whatever layers are called and in whatever order they were
# drawn.

SIDES = ("entry", "exit")
FINE = 1e-6  # of the scene's size: how closely an outline is followed to find which one a tooth rests on


class PalletStones:
    """The stones of a scene's lever; its geometry of function is measured once, when the first of them is asked for."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def stone(self, side: str) -> tuple[Body, Loop]:
        """The lever and the outline of its stone (or pin, or pallet) of that side. ValueError where there is none."""
        compiled, lever, there = self._rest(side)
        place = np.array(there)

        def distance(loop: Loop) -> float:
            return math.dist(nearest(outline([loop], FINE * compiled.size), place), place)

        return lever, min(loops_of(lever), key=distance)

    def place(self, side: str) -> Point:
        """Where that stone holds the wheel, in the lever's frame (m). ValueError as in `stone`."""
        return self._rest(side)[2]

    def _rest(self, side: str) -> tuple[Compiled, Body, Point]:
        scene, (compiled, found) = self._scene, self._measured
        if found.parts is None or found.passages is None:
            what, why = found.missing[-1]
            raise ValueError(f"the {side} {pallet_word(scene)} is not known: {what} not measured, {why}")
        rest = found.passages[SIDES.index(side)].start
        lever = scene.body(found.parts.lever)
        q = np.array(compiled.q)
        q[compiled.slices[lever.name].start] = rest.lever
        x, y, angle = frames(scene, compiled.slices, compiled.relative(q[None]))[lever.name][0].tolist()
        c, s = math.cos(angle), math.sin(angle)
        dx, dy = rest.x - x, rest.y - y
        return compiled, lever, (c * dx + s * dy, -s * dx + c * dy)

    @cached_property
    def _measured(self) -> tuple[Compiled, Function]:
        compiled = compile_scene(self._scene)
        return compiled, measure(self._scene, compiled)


ROUND = 1  # decimals of a window's length to which the time before it is given
SHORT = 1.0  # s; a shorter window is given in milliseconds from its start


@dataclass(frozen=True)
class Clock:
    """Time at an axis, so many units after `base` seconds; an instant is "19.4125 s"."""

    base: float
    factor: float
    unit: str

    def at(self, t: Any) -> Any:
        """Times (s) in its unit, after its base."""
        return (t - self.base) * self.factor

    def text(self, t: float, step: float) -> str:
        """The time, with as many digits as distinguish two instants `step` seconds apart."""
        if self.base != 0.0:
            return f"{signed(t, decimals_for(step))} s"
        return f"{signed(self.at(t), decimals_for(step * self.factor))} {self.unit}"

    @property
    def label(self) -> str:
        """What to write at a time axis."""
        return f"time ({self.unit})" if self.base == 0.0 else f"time after {self.base:.9g} s ({self.unit})"


def clock(window: Window) -> Clock:
    """Seconds for long windows, milli- or microseconds after the start for short ones."""
    start, stop = window
    duration = stop - start
    if duration >= SHORT:
        return Clock(0.0, 1.0, "s")
    if start != 0.0 and stop < SHORT:
        return Clock(0.0, 1e3, "ms")
    # A round number just before the start: "3.4 s", not "3.40000046 s".
    decimals = ROUND - math.floor(math.log10(duration))
    base = math.floor(start * 10.0**decimals + 1e-6) / 10.0**decimals
    return Clock(base, 1e6, "µs") if duration < 1e-3 else Clock(base, 1e3, "ms")


def speed_text(speed: float) -> str:
    """ "1/20 of true speed", "true speed", "2 × true speed"."""
    if math.isclose(speed, 1.0, rel_tol=1e-9):
        return "true speed"
    ratio = Fraction(speed).limit_denominator(100_000)
    if speed > 1.0:
        return f"{speed:.4g} × true speed"
    if ratio > 0 and ratio.numerator <= 9 and math.isclose(float(ratio), speed, rel_tol=1e-6):
        return f"{ratio.numerator}/{ratio.denominator} of true speed"
    return f"{speed:.4g} of true speed"


def changing_speed_text(speed: float) -> str:
    """The same with two digits, for a speed that changes: "1/43 of true speed"."""
    if speed >= 0.67:
        return "true speed" if abs(speed - 1.0) < 0.005 else f"{_two_digits(speed)} × true speed"
    return f"1/{_two_digits(1.0 / speed)} of true speed"


def _two_digits(value: float) -> str:
    if value < 10.0:
        return f"{value:.1f}".removesuffix(".0")
    power = 10 ** (math.floor(math.log10(value)) - 1)
    return f"{round(value / power) * power:d}"


def turn_text(turn: float) -> str:
    """ "picture turned by 90° clockwise"; nothing where the scene's axes stand as drawn."""
    degrees = round(math.degrees(math.remainder(turn, math.tau)), 2)
    if degrees == 0.0:
        return ""
    way = "" if abs(degrees) == 180.0 else " clockwise" if degrees < 0.0 else " counter-clockwise"
    return f"picture turned by {abs(degrees):g}°{way}"


def spaced(name: str) -> str:
    """The name of a body or layer, or a pair of such, as a label has it: "balance wheel" of `balance_wheel`."""
    return name.replace("_", " ")


def goes_round(angles: Array) -> bool:
    """True where turns have gone by (rad), so that an angle is better read within its turn."""
    return len(angles) > 0 and float(np.abs(angles).max()) >= math.tau


def reading(body: Body, frames: Array, within_turn: bool = False) -> tuple[Callable[[Array], str], tuple[str, str]]:
    """How to show a body's pose (its angle; a slide's travel), and the texts at the two ends of the range in `frames`.

    `within_turn`: the angle from 0° to 360°, whole turns left away.
    """
    if body.motion == "slide":
        start, axis = np.array(body.position), np.array(body.axis)
        values = 1e3 * ((frames[:, :2] - start) @ axis)
        decimals = min(decimals_for(max(float(np.ptp(values)), 1e-6)) + 2, 6)

        def text(frame: Array) -> str:
            return f"{signed(1e3 * float((frame[:2] - start) @ axis), decimals)} mm"

        unit = " mm"
    else:
        values, unit = np.degrees(frames[:, 2]), "°"
        decimals = 2 if float(np.ptp(values)) < 30.0 else 1

        def text(frame: Array) -> str:
            if not within_turn:
                return f"{signed(math.degrees(frame[2]), decimals)}°"
            angle = f"{math.degrees(frame[2]) % 360.0:.{decimals}f}"
            return f"{0.0 if angle.startswith('360') else float(angle):.{decimals}f}°"

        if within_turn:
            return text, (f"{0.0:.{decimals}f}°", f"{300.0:.{decimals}f}°")
    return text, (f"{signed(float(values.min()), decimals)}{unit}", f"{signed(float(values.max()), decimals)}{unit}")


def round_below(value: float) -> float:
    """5, 2 or 1 times a power of ten, at most so much."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(step * power for step in (5.0, 2.0, 1.0) if step * power <= value * (1.0 + 1e-9))


def scale_bar(width: float) -> tuple[float, str]:
    """A round length (m) of at most `width` metres, and its name."""
    length = round_below(width)
    return (length, f"{length * 1e3:g} mm") if length < 0.9999 else (length, f"{length:g} m")
