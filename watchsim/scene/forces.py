"""Which forces act on a body besides contacts?

All act on the body's own coordinate: a pivoted body's angle (N·m, rad) or a sliding body's travel (N, m). With `against` they
act between two bodies, on the one and back on the other; angles, travels and speeds are then those of `body` less the other's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from watchsim.geometry.hairspring import Coil
from watchsim.geometry.primitives import Point


@dataclass(frozen=True, slots=True)
class Curb:
    """Two pins between which a hairspring plays: `share` of its length lies beyond them, towards the stud.

    The coil touches them where the body is `gap` (rad) to either side of `offset` (rad) from rest. Beyond, only what lies
    before the pins is wound further: its stiffness is that of the whole over 1 - share.
    """

    share: float
    gap: float
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class Spring:
    """A spring: -stiffness (q - rest) - cubic (q - rest)³, N·m/rad or N/m, N·m/rad³ or N/m³.

    `frequency` (Hz) where that is how it was given; `coil` is how it is drawn, `wound` how it bends, with the weight of
    `coil_mass` (kg). At `stop` (rad or m) the body comes to a stop on its way to `rest`, with impacts of Poisson's
    `restitution`.
    """

    body: str
    stiffness: float
    rest: float = 0.0
    frequency: float | None = None
    coil: Coil | None = None
    against: str | None = None
    stop: float | None = None
    restitution: float = 0.0
    cubic: float = 0.0
    curb: Curb | None = None
    wound: Coil | None = None
    coil_mass: float = 0.0


@dataclass(frozen=True, slots=True)
class LineSpring:
    """A spring and damper between a point of one body and a point of another, or of the movement (None).

    points     in the bodies' frames, m
    stiffness  N/m; `length` (m) is that without force, `viscous` (N·s/m) acts on its rate
    """

    between: tuple[str, str | None]
    points: tuple[Point, Point]
    stiffness: float
    length: float
    viscous: float = 0.0


@dataclass(frozen=True, slots=True)
class Mainspring:
    """A mainspring that drives a body through a train.

    ratio       turns of the body for one turn of the barrel, negative where the body turns clockwise
    efficiency  of the train: share of the barrel's work that reaches the body
    run_down    rad, of the barrel since it was wound, at the start
    torque      N·m at the barrel, at the start
    inertia     kg·m², of the train's wheels and the barrel as felt at the body; part of the body's own
    """

    ratio: float
    efficiency: float
    run_down: float
    torque: float
    inertia: float


@dataclass(frozen=True, slots=True)
class Torque:
    """A constant torque (N·m) or force (N) on a body; with `table`, value by linear interpolation over angle or time.

    `over` is "constant", "angle" or "time"; `table` holds (abscissa, value) pairs in SI, ascending. Where a `mainspring` drives
    the body through a train, `table` says what that comes to over the body's own angle, and `value` what it is at the start.
    A table over time with a `period` (s) repeats: its last row is the first, a period later.
    """

    body: str
    value: float = 0.0
    over: str = "constant"
    table: tuple[tuple[float, float], ...] = ()
    mainspring: Mainspring | None = None
    against: str | None = None
    period: float | None = None

    def over_time(self, t: float) -> float:
        """Value of a table over time at `t` (s)."""
        times, values = zip(*self.table, strict=True)
        since = t if self.period is None else times[0] + (t - times[0]) % self.period
        return float(np.interp(since, times, values))


@dataclass(frozen=True, slots=True)
class Damping:
    """Damping: -viscous u - quadratic u|u| - coulomb sgn(u), in SI units."""

    body: str
    viscous: float = 0.0
    quadratic: float = 0.0
    coulomb: float = 0.0
    against: str | None = None


@dataclass(frozen=True, slots=True)
class Side:
    """One side of a contact: a body, or one layer of it."""

    body: str
    layer: str | None = None

    def __str__(self) -> str:
        return self.body if self.layer is None else f"{self.body}.{self.layer}"


G = 9.80665  # m/s² (3rd CGPM, 1901)


@dataclass(frozen=True, slots=True)
class Bearing:
    """Friction of a pivot under the load of its body: friction × load × radius (m), `flat` on the cap stone.

    With `play` (m) the pivot is a shaft in a hole so much wider, in which it rolls and slides; at the start in its middle, or
    where it touches the hole in the direction `side` (rad).

    Reading a scene file checks that the load of the body is known: that it carries nothing, is geared to nothing without a
    load, and has no other bearing. `dataclasses.replace(scene, bearings=...)` does not; `Scene.set` does.
    """

    body: str
    radius: float
    friction: float
    flat: float = 0.0
    play: float = 0.0
    side: float | None = None

    def torque(self, mass: float, gravity: Point) -> float:
        """Of dry friction, N·m, with a body of that mass (kg) in that gravity (m/s²) in the plane.

        What standard gravity has beside that presses the end of the pivot on its stone.
        """
        upright = math.hypot(*gravity)
        lying = math.sqrt(max(0.0, G * G - upright * upright))
        return self.friction * mass * (self.radius * upright + self.flat * lying)


@dataclass(frozen=True, slots=True)
class Shock:
    """How the case is accelerated from `at` (s) on: a half sine over `duration` (s), or between `rows`.

    acceleration  of its point `about` (m), at the most, m/s², in the directions of the movement
    turn          of the case, at the most, rad/s²
    rows          (s since `at`, m/s², m/s², rad/s²), with straight lines between them
    """

    at: float
    duration: float
    acceleration: Point = (0.0, 0.0)
    turn: float = 0.0
    about: Point = (0.0, 0.0)
    rows: tuple[tuple[float, float, float, float], ...] = ()

    @property
    def turns(self) -> bool:
        """True if the case turns."""
        return self.turn != 0.0 or any(row[3] for row in self.rows)


@dataclass(frozen=True, slots=True)
class SlipLaw:
    """How friction depends on the speed v of slip: friction − drop (1 − exp(−v / decay)) + rise v.

    drop, decay and rise are a number, m/s and s/m; with no decay, friction drops as soon as a contact slides (Stribeck's curve:
    Armstrong-Hélouvry, Dupont, Canudas de Wit, Automatica 30 (1994)).
    """

    drop: float = 0.0
    decay: float = 0.0
    rise: float = 0.0

    def times(self, factor: float) -> SlipLaw:
        """Of a coefficient that is so many times as large at every speed."""
        return SlipLaw(self.drop * factor, self.decay, self.rise * factor)


CONSTANT = SlipLaw()


@dataclass(frozen=True, slots=True)
class Contact:
    """Only what is declared here can touch. Coulomb friction, Poisson restitution normal and tangential."""

    sides: tuple[Side, Side]
    friction: float = 0.0
    restitution: float = 0.0
    tangential_restitution: float = 0.0
    slip: SlipLaw = CONSTANT
