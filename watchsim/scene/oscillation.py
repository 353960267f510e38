"""What swings about which rest position, by springs and by gravity, and how fast?

A body swings if a spring pulls it back, or if it is pivoted, hangs with its centre of mass beside the pivot in gravity, and is
not driven. Stiffnesses of springs and of gravity add; inertia counts with all that the body carries.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from watchsim.geometry.primitives import Point
from watchsim.scene.body import Body
from watchsim.scene.carriers import Ride, Weighed, rides, weigh
from watchsim.scene.force import Spring
from watchsim.scene.gear_trains import felt
from watchsim.scene.scene import Scene

Loads = tuple[tuple[Ride, ...], tuple[Weighed, ...], tuple[float, ...]]

POISED = 1e-9  # of the radius of gyration: a centre of mass nearer to the pivot lies on it, but for rounding
HALVINGS = 200

# Asked for every spring and damper of a scene; a body's outlines make comparing longer than weighing.
_recent: deque[tuple[tuple[Body, ...], Loads]] = deque(maxlen=4)


@dataclass(frozen=True, slots=True)
class Oscillator:
    """A body about its rest position, SI units: small oscillations.

    inertia   with what it carries, kg·m² (kg where it slides)
    spring    stiffness of all its springs, N·m/rad (N/m)
    gravity   stiffness by gravity at the rest position; negative where gravity topples it
    rest      its coordinate where it stands in balance, rad (m)
    weight    the largest torque of gravity, N·m: the pull on the centre of mass times its distance from the pivot
    """

    body: str
    inertia: float
    spring: float
    gravity: float
    rest: float
    weight: float = 0.0

    @property
    def stiffness(self) -> float:
        return self.spring + self.gravity

    @property
    def hertz(self) -> float | None:
        """Undamped frequency; None where it does not return to its rest position."""
        return math.sqrt(self.stiffness / self.inertia) / math.tau if self.stiffness > 0.0 < self.inertia else None


def oscillators(scene: Scene) -> tuple[Oscillator, ...]:
    """All that swings: sprung bodies in the order of their springs, without any the undriven body with the greatest weight."""
    found = [oscillator(scene.bodies, scene.springs, scene.gravity, name) for name in _sprung(scene.springs)]
    if found:
        return tuple(one for one in found if one is not None)
    driven = {torque.body for torque in scene.torques}
    hung = _hung(scene.bodies, scene.gravity, driven) if any(scene.gravity) else ()
    heaviest = max(hung, key=lambda one: one.weight, default=None)
    return () if heaviest is None else (heaviest,)


def frequency(scene: Scene) -> float | None:
    """Undamped frequency (Hz) of small swings of the scene's oscillator; None where nothing swings."""
    found = oscillators(scene)
    return found[0].hertz if found else None


def nominal_frequency(scene: Scene) -> float | None:
    """What the rate is measured against, Hz: `frequency` under [timegrapher], else that of its spring where the scene gives it,
    else that of small swings."""
    found = oscillators(scene)
    if not found or scene.nominal is not None:
        return scene.nominal
    springs = [spring for spring in scene.springs if spring.body == found[0].body and spring.against is None]
    return (springs[0].frequency if len(springs) == 1 else None) or found[0].hertz


def oscillator(bodies: tuple[Body, ...], springs: Iterable[Spring], gravity: Point, name: str) -> Oscillator | None:
    """How the body of that name swings; None where neither a spring nor gravity pulls it back."""
    own = [spring for spring in springs if spring.body == name and spring.against is None]
    number = next((i for i, body in enumerate(bodies) if body.name == name), -1)
    if number < 0 or bodies[number].motion not in ("pivot", "slide"):
        return None
    hung, weighed, masses = loads(bodies)
    body, load, ride, mass = bodies[number], weighed[number], hung[number], masses[number]
    stiffness = sum(spring.stiffness for spring in own)
    middle = _middle(own, stiffness)
    if body.motion == "slide":
        if middle is None:
            return None
        pull = load.mass * (gravity[0] * body.axis[0] + gravity[1] * body.axis[1])
        return Oscillator(name, mass, stiffness, 0.0, middle + pull / stiffness)
    weight, hanging = _weight(load, ride, gravity)
    if weight == 0.0:
        return None if middle is None else Oscillator(name, mass, stiffness, 0.0, middle)
    if middle is None:
        return Oscillator(name, mass, 0.0, weight, _nearest(hanging, body.angle), weight)
    rest = _balance(stiffness, middle, weight, _nearest(hanging, middle))
    return Oscillator(name, mass, stiffness, weight * math.cos(rest - hanging), rest, weight)


def _middle(springs: list[Spring], stiffness: float) -> float | None:
    """Where the springs together pull to; None without any."""
    if not springs:
        return None
    return sum(spring.stiffness * spring.rest for spring in springs) / stiffness if stiffness else springs[0].rest


def loads(bodies: tuple[Body, ...]) -> Loads:
    """How each body hangs, what it weighs with all it carries, and what its coordinate weighs with all that is geared to it.

    What cannot be carried is complained of elsewhere.
    """
    for known, found in _recent:
        if known is bodies:
            return found
    hung = rides(bodies, _in_silence)
    weighed = weigh(bodies, hung, _in_silence)
    found = hung, weighed, felt(bodies, hung, weighed)
    _recent.appendleft((bodies, found))
    return found


def _in_silence(_name: str, _message: str) -> None:
    pass


def _sprung(springs: Iterable[Spring]) -> tuple[str, ...]:
    return tuple(dict.fromkeys(spring.body for spring in springs if spring.against is None))


def _hung(bodies: tuple[Body, ...], gravity: Point, driven: set[str]) -> Iterator[Oscillator]:
    for body in bodies:
        if body.motion == "pivot" and body.name not in driven:
            found = oscillator(bodies, (), gravity, body.name)
            if found is not None:
                yield found


def _weight(load: Weighed, ride: Ride, gravity: Point) -> tuple[float, float]:
    """The largest torque of gravity (N·m), and the angle (rad, as the scene gives it) at which the body hangs."""
    (sx, sy), (gx, gy) = load.moment, gravity
    # What could not be read is passed on as not-a-number: it has been complained of.
    if ride.host >= 0 or math.hypot(sx, sy) <= POISED * math.sqrt(abs(load.mass * load.inertia)):
        return 0.0, 0.0
    along, across = sx * gx + sy * gy, sx * gy - sy * gx
    return math.hypot(along, across), math.atan2(across, along) - ride.angle


def _nearest(angle: float, to: float) -> float:
    """The same direction, within half a turn of `to`."""
    return to - math.remainder(to - angle, math.tau)


def _balance(stiffness: float, middle: float, weight: float, hanging: float) -> float:
    """Where k (q - middle) + weight sin(q - hanging) = 0 between the two rest positions, by halving."""
    low, high = min(middle, hanging), max(middle, hanging)
    for _ in range(HALVINGS):
        between = 0.5 * (low + high)
        if not low < between < high:
            break
        if stiffness * (between - middle) + weight * math.sin(between - hanging) > 0.0:
            high = between
        else:
            low = between
    return 0.5 * (low + high)
