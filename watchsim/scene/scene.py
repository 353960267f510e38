"""What did the user declare?"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from watchsim.displays import notebook_html
from watchsim.drawing.drawing import Profile
from watchsim.drawing.findings import Finding
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Point
from watchsim.scene.errors import CHANGED, Fault, SceneError
from watchsim.scene.forces import Bearing, Contact, Damping, LineSpring, Shock, Spring, Torque
from watchsim.scene.solids import Solid
from watchsim.units import LENGTH, Dimension, known_unit, metric, show

# How much of a run is kept?

Window = tuple[float, float]

ALL, EVENTS, STATISTICS = "all", "events", "statistics"
KEPT = (ALL, EVENTS, STATISTICS)
EVERY = "every"  # "every 10": every tenth row
WHOLE_RUN: tuple[Window, ...] = ((-math.inf, math.inf),)


@dataclass(frozen=True, slots=True)
class Recording:
    """Which rows and events of a run are kept; sums over the whole run are made in any case.

    windows  (s, s) in which rows are kept; none means the whole run where `keep` is "all"
    keep     "all": rows within the windows, and all events;
             "events": the same, but without windows only the rows of the last seconds;
             "statistics": rows and events within the windows and in the last seconds, so that memory does not grow with time
    stride   every n-th row within the windows is kept; interpolation across rows that are left out is not exact
    """

    windows: tuple[Window, ...] = ()
    keep: str = ALL
    stride: int = 1

    def __post_init__(self) -> None:
        if self.keep not in KEPT:
            raise ValueError(f'"{self.keep}" cannot be kept; choose from {", ".join(KEPT)}')
        if self.stride < 1:
            raise ValueError(f"every row or every n-th row can be kept; n must be at least 1, not {self.stride}")
        for start, end in self.windows:
            if not start < end:
                raise ValueError(f"a window runs from an earlier to a later time, not from {start:g} s to {end:g} s")

    @property
    def has_tail(self) -> bool:
        """True if the last seconds of the run are kept whatever the windows say."""
        return self.keep != ALL

    @property
    def row_windows(self) -> tuple[Window, ...]:
        """The windows, or the whole run where none are given and everything is kept."""
        return self.windows or (WHOLE_RUN if self.keep == ALL else ())


EVERYTHING = Recording()


def as_recording(what: Recording | str | Iterable[Window] | None) -> Recording | None:
    """From what is convenient in Python: a word such as "statistics", or windows in seconds."""
    if what is None or isinstance(what, Recording):
        return what
    if isinstance(what, str):
        return Recording(keep=what)
    return Recording(tuple((float(start), float(end)) for start, end in what))


# What binds the coordinate of one body to that of another?

PRESSURE_ANGLE = math.radians(20.0)  # of gears that say nothing else: ISO 53


@dataclass(frozen=True, slots=True)
class Geared:
    """A body that has no coordinate of its own: it goes `ratio` times as far as the body `to`, as gears without play make it.

    rad/rad, m/rad, rad/m or m/m, of coordinates as the scene gives them: of a body that `to` carries, against that one.
    """

    to: str
    ratio: float


@dataclass(frozen=True, slots=True)
class Gear:
    """Gears between two bodies; with play each has a coordinate of its own (or is geared without play to one that has).

    ratio        how far the second goes for one unit of the first: rad/rad, m/rad, rad/m or m/m
    backlash     how far the second can go while the first is held, rad or m; in the middle of it at the start
    restitution  Poisson's, of the impacts when the play is used up
    efficiency   share of the work put in at either body that comes out at the other; the rest is friction of the teeth
    pressure_angle  rad, of the line of action to the common tangent; changes no motion, only what bearings take
    """

    between: tuple[str, str]
    ratio: float
    backlash: float
    restitution: float = 0.0
    efficiency: float = 1.0
    pressure_angle: float = PRESSURE_ANGLE


# How does a body move whose motion is prescribed, whatever it meets?
#
# With q'' = a(t) - w² (q - middle): a constant speed has neither, a swing has w, a path has a(t).


@dataclass(frozen=True)
class Prescribed:
    """The law of a driven coordinate, in SI units.

    `square` (1/s²) is w² of a swing about `middle` (rad or m); `table` holds times (s) and accelerations (rad/s² or m/s²)
    of a path, between which the acceleration is linear; it is zero at both ends. Start and start velocity are the body's.
    """

    square: float = 0.0
    middle: float = 0.0
    table: tuple[tuple[float, float], ...] = ()


def swing(middle: float, amplitude: float, frequency: float, phase: float) -> tuple[Prescribed, float, float]:
    """q = middle + amplitude sin(2π frequency t + phase): the law, q and q' at t = 0."""
    w = math.tau * frequency
    start = middle + amplitude * math.sin(phase)
    return Prescribed(square=w * w, middle=middle), start, amplitude * w * math.cos(phase)


def path(points: Sequence[tuple[float, float]]) -> Prescribed:
    """The smoothest way through two or more points (time in s, coordinate), from rest to rest.

    The acceleration is linear between the points and zero at both ends, so that nothing jerks there; that takes two more
    knots, which divide the first and the last stretch (a single one in three). The later points and the rest at the end
    are as many equations as there are accelerations to find.
    """
    t, q = np.array(points, float).T
    knots = _divided(t)
    inner = len(knots) - 2
    way, speed = np.zeros((len(t) - 1, inner)), np.zeros(inner)
    for j in range(inner):
        pulse = np.zeros(len(knots))
        pulse[j + 1] = 1.0
        u, s = _integrated(knots, pulse)
        way[:, j], speed[j] = s[np.searchsorted(knots, t[1:])], u[-1]
    # Lengths against speeds times the whole time, so that the equations are of one size.
    rows = np.vstack([way, speed * (t[-1] - t[0])])
    found = np.linalg.solve(rows, np.concatenate([q[1:] - q[0], [0.0]]))
    return Prescribed(table=tuple(zip(knots.tolist(), [0.0, *found.tolist(), 0.0], strict=True)))


def _divided(t: np.ndarray) -> np.ndarray:
    if len(t) == 2:
        return np.linspace(t[0], t[1], 4)
    return np.sort(np.concatenate([t, [0.5 * (t[0] + t[1]), 0.5 * (t[-2] + t[-1])]]))


def _integrated(knots: np.ndarray, a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Velocity and way at the knots, from rest, of an acceleration that is linear between them: exactly."""
    h = np.diff(knots)
    u = np.concatenate([[0.0], np.cumsum(0.5 * h * (a[:-1] + a[1:]))])
    s = np.concatenate([[0.0], np.cumsum(h * u[:-1] + h * h * (a[:-1] / 3.0 + a[1:] / 6.0))])
    return u, s


# What is a body?

MOTIONS = ("pivot", "slide", "free", "fixed")


@dataclass(frozen=True)
class Body:
    """A rigid part, SI units. Its outlines are in its own frame, whose origin is the pivot (free bodies: the centre of mass).

    motion          "pivot", "slide", "free" or "fixed"; its coordinates q are the angle itself; the distance travelled along
                    `axis` from `position`; x, y and angle; none
    position, angle  where the frame stands at the start, m and rad
    velocity        at the start, in the order of the coordinates: rad/s; m/s; m/s, m/s, rad/s
    mass, inertia   kg, and kg·m² about the origin (free bodies: about the centre of mass)
    centre_of_mass  in the body's frame, m; it matters only where gravity acts on a pivoted body
    loops           outlines that can touch; `decoration` is drawn only
    solids          where mass and inertia come from, as far as they were not given as numbers
    prescribed      the law by which a driven body moves whatever it meets; mass and inertia then change nothing
    on              the body that carries it; position, angle and velocity are then given in that one's frame, relative to it
    geared          to which body without play: its coordinate then follows from that one's
    """

    name: str
    motion: str = "pivot"
    position: Point = (0.0, 0.0)
    angle: float = 0.0
    velocity: tuple[float, ...] = ()
    axis: Point = (1.0, 0.0)
    mass: float = 0.0
    inertia: float = 0.0
    centre_of_mass: Point = (0.0, 0.0)
    loops: tuple[Loop, ...] = ()
    decoration: tuple[Loop, ...] = field(default=())
    solids: tuple[Solid, ...] = field(default=())
    on: str | None = None
    prescribed: Prescribed | None = None
    geared: Geared | None = None

    def __repr__(self) -> str:
        layers = ", ".join(self.layers) or "no outline that can touch"
        return f"<Body {self.name!r}, {'driven' if self.prescribed else self.motion}: {layers}>"

    @property
    def layers(self) -> tuple[str, ...]:
        """The layers of its outlines that can touch, in the order of the drawing."""
        return tuple(dict.fromkeys(loop.layer for loop in self.loops))

    @property
    def profile(self) -> Profile:
        """Everything drawn of it, in its own frame."""
        drawn = (*self.loops, *self.decoration)
        return Profile(tuple(loop for loop in drawn if loop.closed), tuple(loop for loop in drawn if not loop.closed))


# What did the user declare?


@dataclass(frozen=True, slots=True)
class Expectation:
    """A number the scene promises, in the units it was written in: `value` within `tolerance`, or from `low` to `high`.

    Of one with `low` and `high` value and tolerance are the middle and half the width, or that limit and infinity.
    """

    key: str
    value: float
    tolerance: float
    unit: str
    low: float | None = None
    high: float | None = None

    @property
    def bounds(self) -> tuple[float, float]:
        """The least and the most that keeps the promise; infinite where there is no limit."""
        if self.low is None and self.high is None:
            return self.value - self.tolerance, self.value + self.tolerance
        return -math.inf if self.low is None else self.low, math.inf if self.high is None else self.high


@dataclass(frozen=True, slots=True)
class Tolerance:
    """Within which limits a number of the scene is made.

    key         dotted path, as for `Scene.set`; `nominal` what the scene holds there (SI)
    low, high   deviations from it (SI): the limits
    shape       uniform, normal, truncated, triangular: about the middle of the limits; file: `measured` deviations, sorted
    sigma       of a normal distribution (SI), also where it is truncated at its limits
    group       tolerances of one group get one draw; "" for a draw of its own
    count       of values: one for each tooth, else 1
    """

    key: str
    nominal: float
    low: float
    high: float
    dimension: Dimension
    shape: str = "uniform"
    sigma: float = 0.0
    group: str = ""
    count: int = 1
    measured: tuple[float, ...] = ()

    @property
    def unit(self) -> str:
        """In which people read it."""
        if self.dimension.si.startswith("N"):
            return metric(self.nominal, self.dimension.si).split()[1]
        return ("µm" if self.dimension is LENGTH else self.dimension.usual[1]) if self.dimension.si else ""

    def shown(self, value: float) -> str:
        """A value of the dimension as people read it; lengths that are no errors in millimetres."""
        unit = "mm" if self.unit == "µm" and abs(self.nominal) > 1e-4 else self.unit
        return show(value, unit, 7).replace("-", "−")

    @property
    def words(self) -> str:
        """ "±5 µm, normal, Cpk 1.33"."""
        factor = known_unit(self.unit).factor
        signs = "+" if self.low > 0.0 else "−", "−" if self.high < 0.0 else "+"  # "+4/−0"
        low, high = (f"{sign}{abs(end) / factor:.4g}" for sign, end in zip(signs, (self.low, self.high), strict=True))
        unit = self.unit if self.unit in ("", "°") else f" {self.unit}"
        limits = f"±{high[1:]}{unit}" if self.low == -self.high else f"{high}/{low}{unit}"
        cpk = f", Cpk {(self.high - self.low) / (6.0 * self.sigma):.3g}" if self.sigma else ""
        each = f", one for each of {self.count} teeth" if self.count > 1 else ""
        return f"{limits}, {self.shape}{cpk}{each}{f', drawn with {self.group}' if self.group else ''}"


@dataclass(frozen=True, slots=True)
class Correlation:
    """Of the normal scores of two tolerances."""

    between: tuple[str, str]
    coefficient: float


@dataclass(frozen=True)
class Written:
    """Of a scene made from a design: what its file says, the keys changed since (path -> value, in that order), and the names
    of the drawings that the design makes."""

    mapping: dict[str, Any]
    changes: Mapping[str, object]
    made: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Scene:
    """A mechanism in SI units, ready to be compiled. Two scenes are equal when all but the last eight fields are.

    bodies, springs, torques, damping, bearings, contacts  what it consists of
    gravity         (x, y), m/s²
    tangential_law  "coulomb", "pg1996" or "shifted": what friction does in the expansion of impacts; `nu` belongs to pg1996
                    (docs/theory/laws.md)
    duration        of a run, s; `tolerance` its relative error per step, `record` what is kept of it
    lift_angle      rad; `nominal` (Hz) is what the rate is measured against. None where the scene says nothing
    expect          numbers that a run promises
    gears           with play; those without are `Body.geared`, and, two by two, `rigid_gears`
    shocks          how the case is accelerated and turned
    line_springs    between points of two bodies, or of a body and the movement
    tolerances      within which limits its numbers are made; `correlated` which of them go together
    path, source    the file, and the TOML mapping that it holds
    findings        what the drawings said besides errors; `drawings` the files as they were read, by their names in the scene
    written         of a scene made from a design: `source` then holds the design's scene as well
    reader          reader(scene, {key: value}) reads `source` again with keys changed; None for a scene made in Python
    """

    title: str
    bodies: tuple[Body, ...]
    springs: tuple[Spring, ...] = ()
    torques: tuple[Torque, ...] = ()
    damping: tuple[Damping, ...] = ()
    contacts: tuple[Contact, ...] = ()
    gravity: Point = (0.0, 0.0)
    tangential_law: str = "coulomb"
    nu: float = 0.0
    duration: float = 1.0
    record: Recording = EVERYTHING
    tolerance: float = 1e-9
    lift_angle: float | None = None
    nominal: float | None = None
    expect: tuple[Expectation, ...] = ()
    gears: tuple[Gear, ...] = ()
    rigid_gears: tuple[Gear, ...] = ()
    line_springs: tuple[LineSpring, ...] = ()
    bearings: tuple[Bearing, ...] = ()
    shocks: tuple[Shock, ...] = ()
    tolerances: tuple[Tolerance, ...] = field(default=(), compare=False)
    correlated: tuple[Correlation, ...] = field(default=(), compare=False)
    path: Path | None = field(default=None, compare=False)
    source: dict[str, Any] = field(default_factory=dict, repr=False, compare=False)
    findings: tuple[Finding, ...] = field(default=(), repr=False, compare=False)
    drawings: Mapping[str, bytes] = field(default_factory=dict, repr=False, compare=False)
    written: Written | None = field(default=None, repr=False, compare=False)
    reader: Callable[[Scene, Mapping[str, object]], Scene] | None = field(default=None, repr=False, compare=False)

    def __repr__(self) -> str:
        names = ", ".join(body.name for body in self.bodies)
        return f"<Scene {self.title!r}: {names}; {len(self.contacts)} contacts declared>"

    def _repr_html_(self) -> str:
        return notebook_html(self)

    def body(self, name: str) -> Body:
        """The body of that name; KeyError if there is none."""
        return self._by_name[name]

    def __getstate__(self) -> dict[str, Any]:
        """Without `_by_name`, which one thread may be adding while another one pickles the scene."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @cached_property
    def _by_name(self) -> dict[str, Body]:
        return {body.name: body for body in self.bodies}

    def set(self, key: str, value: object) -> Scene:
        """A copy with one key of the scene file changed, everything else checked again.

        `key` is a dotted path such as "torques.0.value", "bodies.lever.position.1"; `value` a text as in the file
        ("-1.2 µN·m") or a number in SI units. Raises SceneError for an unknown path, for a value that does not fit, and
        for a scene that was made in Python.
        """
        if self.reader is None:
            message = "this scene was made in Python and has no file to read again. Change it with dataclasses.replace"
            raise SceneError([Fault(key, message, place=CHANGED)])
        return self.reader(self, {key: value})
