"""Which body is the oscillator, which the escape wheel, which the lever?

Names in a scene are free, so the roles follow from what the bodies do: the oscillator swings on a spring or as a pendulum,
the wheel is driven, if only through a train of gears, and locked by the lever, which touches both, or by the oscillator itself.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Point
from watchsim.geometry.solids import mass_properties
from watchsim.scene.forces import Side, Spring
from watchsim.scene.scene import Body, Scene
from watchsim.scene.teeth import FEWEST_TEETH, teeth_of, train
from watchsim.scene.trains import ON_PIVOT, Ride, Weighed, felt, in_silence, rides, weigh

# What swings about which rest position, by springs and by gravity, and how fast?
#
# A body swings if a spring pulls it back, or if it is pivoted, hangs with its centre of mass beside the pivot in gravity, and
# is not driven. Stiffnesses of springs and of gravity add; inertia counts with all that the body carries.

Loads = tuple[tuple[Ride, ...], tuple[Weighed, ...], tuple[float, ...]]

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
    hung = rides(bodies, in_silence)
    weighed = weigh(bodies, hung, in_silence)
    found = hung, weighed, felt(bodies, hung, weighed)
    _recent.appendleft((bodies, found))
    return found


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
    if ride.host >= 0 or math.hypot(sx, sy) <= ON_PIVOT * math.sqrt(abs(load.mass * load.inertia)):
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


# Which body is the oscillator, which the escape wheel, which the lever?


@dataclass(frozen=True, slots=True)
class Roles:
    """Names of bodies; None where a scene has no such part."""

    oscillator: str | None
    wheel: str | None
    lever: str | None


def roles(scene: Scene) -> Roles:
    """The first that swings, a driven pivoted body besides it, and a moving body in contact with both.

    A body may be driven through gears, declared ones or teeth in contact, and touch by way of what it carries.

    Of several driven bodies the wheel is the first that has such a lever, whatever the order of the torques: a lever may be
    knocked by a torque of its own. Without a lever it is the first that touches the oscillator; what else is driven stands
    before it in the train, or belongs to another escapement.
    """
    oscillator = next((one.body for one in oscillators(scene)), None)
    driven = [name for torque in scene.torques for name in train(scene, torque.body) if torque.body != oscillator]
    wheels = [name for name in driven if scene.body(name).motion == "pivot"]
    if oscillator is None:
        return Roles(None, wheels[0] if wheels else None, None)
    for wheel in wheels:
        if lever := _lever(scene, oscillator, wheel):
            return Roles(oscillator, wheel, lever)
    touched = partners(scene, oscillator).union(*(partners(scene, name) for name in _carried(scene, oscillator)))
    return Roles(oscillator, next((name for name in wheels if name in touched), wheels[0] if wheels else None), None)


def with_anchor(scene: Scene) -> Roles:
    """The same; a pendulum with its anchor, driven by the wheel itself, is the lever, too; so is one with hinged pallets."""
    found = roles(scene)
    if hinged_pallets(scene):
        return replace(found, lever=found.oscillator)
    if found.wheel is None or found.oscillator is None or found.lever is not None or not keeps_time(scene):
        return found
    return replace(found, lever=found.oscillator) if found.oscillator in partners(scene, found.wheel) else found


def hinged_pallets(scene: Scene) -> tuple[str, ...]:
    """The bodies, two or more, that turn on the oscillator itself and touch the wheel, as in a grasshopper escapement."""
    found = roles(scene)
    if found.oscillator is None or found.wheel is None or not keeps_time(scene):
        return ()
    touched = partners(scene, found.wheel)
    hinged = [b.name for b in scene.bodies if b.on == found.oscillator and b.motion == "pivot" and b.name in touched]
    return tuple(hinged) if len(hinged) > 1 else ()


def _lever(scene: Scene, oscillator: str, wheel: str) -> str | None:
    both = partners(scene, oscillator) & partners(scene, wheel) - {oscillator, wheel}
    pivoted = [body.name for body in scene.bodies if body.motion == "pivot"]
    direct = next((name for name in pivoted if name in both and not _is_geared(scene, name, wheel)), None)
    return direct or next((name for name in pivoted if _reaches(scene, name, oscillator, wheel)), None)


def _is_geared(scene: Scene, name: str, wheel: str) -> bool:
    """Are the outlines with which a body touches the wheel those of a gear, and no pallets?"""
    return teeth_of(scene, _sides(scene, name, {wheel})) >= FEWEST_TEETH


def _reaches(scene: Scene, name: str, oscillator: str, wheel: str) -> bool:
    """Does the body touch both by way of what it carries, as a detent does with its passing spring?"""
    carried = _carried(scene, name)
    own = {name} | carried
    touched = set().union(*(partners(scene, one) for one in own))
    return bool(carried) and not own & {oscillator, wheel} and {oscillator, wheel} <= touched


def _carried(scene: Scene, name: str) -> set[str]:
    return {body.name for body in scene.bodies if body.on == name}


def _sides(scene: Scene, name: str, others: set[str] | None = None) -> list[Side]:
    """The sides of body `name` of its contacts, with some others only."""
    pairs = [(a, b) for contact in scene.contacts for a, b in (contact.sides, contact.sides[::-1]) if a.body == name]
    return [own for own, other in pairs if others is None or other.body in others]


def pitch(scene: Scene, wheel: str) -> float | None:
    """Angle (rad) from tooth to tooth of body `wheel`; None without equal teeth.

    Of an escape wheel those teeth count with which it touches lever and oscillator, of other wheels all that touch something.
    """
    count = teeth_of(scene, toothed_sides(scene, wheel))
    return math.tau / count if count > 1 else None


def toothed_sides(scene: Scene, wheel: str) -> list[Side]:
    """The sides of contacts that decide about a wheel's pitch."""
    return _locked_sides(scene, wheel) or _sides(scene, wheel)


def may_lock(scene: Scene) -> bool:
    """Is a contact declared in which lever or oscillator could lock the wheel?"""
    wheel = roles(scene).wheel
    return wheel is not None and bool(_locked_sides(scene, wheel))


def _locked_sides(scene: Scene, wheel: str) -> list[Side]:
    found = roles(scene)
    ends = {one for one in (found.lever, found.oscillator) if one is not None}
    return _sides(scene, wheel, ends.union(*(_carried(scene, one) for one in ends))) if found.wheel == wheel else []


def swings(scene: Scene) -> bool:
    """Does anything swing, on a spring or by gravity?"""
    return bool(oscillators(scene))


def keeps_time(scene: Scene) -> bool:
    """True for an oscillator that swings alone or is kept going by an escapement; False for a ratchet's click on its spring.

    A driven wheel makes an escapement where a lever stands between it and the oscillator, or where the scene names a lift
    angle; a wheel that touches the sprung body itself may as well be held by it.
    """
    found = roles(scene)
    return found.oscillator is not None and (found.wheel is None or found.lever is not None or scene.lift_angle is not None)


def only_presses(scene: Scene) -> bool:
    """Is the spring there to press, as that of a jumper, a click or a cam's follower?

    The sprung body then rests on a driven wheel that is no escapement's, or all that drives are bodies moved as the scene says.
    """
    found = roles(scene)
    if found.oscillator is None:
        return False
    if found.wheel is not None:
        return not keeps_time(scene)
    return not is_driven(scene) and any(body.prescribed is not None for body in scene.bodies)


def is_driven(scene: Scene) -> bool:
    """Does a torque or a force put work in?"""
    return any(torque.table or torque.value for torque in scene.torques)


def partners(scene: Scene, name: str) -> set[str]:
    """The bodies that a declared contact lets touch body `name`."""
    pairs = [{side.body for side in contact.sides} for contact in scene.contacts]
    return set().union(*(pair - {name} for pair in pairs if name in pair))


def drive_direction(scene: Scene, name: str) -> float:
    """+1 or -1: the way the torques on body `name`, and on what is geared to it, turn it (the mean of a table)."""
    total, ratios = 0.0, train(scene, name)
    for torque in scene.torques:
        if torque.body in ratios:
            mean = sum(value for _, value in torque.table) / len(torque.table) if torque.table else torque.value
            total += ratios[torque.body] * mean
    return -1.0 if total < 0.0 else 1.0


def timekeeper(scene: Scene, many: bool = False) -> str:
    """A "watch" has a spring on its oscillator, a "clock" a pendulum; `many`: "watches", "clocks"."""
    own = roles(scene).oscillator
    one = "watch" if own is None or any(spring.body == own for spring in scene.springs) else "clock"
    return {"watch": "watches", "clock": "clocks"}[one] if many else one


# What are the pallets of a mechanism called? By one word in names, sounds, plots, tables and messages.

ALONE = 0.5  # of all the lever's outlines by length: a shorter one is a stone of its own, a longer one carries its pallets


PALLETS = ("stone", "pallet", "pin")


def pallet_word(scene: Scene) -> str:
    """ "pin" where what locks the wheel is round, "stone" where it is an outline of its own on a lever, else "pallet"."""
    found, met = with_anchor(scene), _locking(scene)
    if found.lever is None or found.lever == found.oscillator:
        return "pallet"
    lever = scene.body(found.lever)
    if met and all(isinstance(loop.edges[0], Arc) and loop.edges[0].is_circle for loop in met):
        return "pin"
    whole = sum(loop.length for loop in (*lever.loops, *lever.decoration))
    return "stone" if min((loop.length for loop in met), default=0.0) < ALONE * whole else "pallet"


def pallet_name(scene: Scene, side: str) -> str:
    """ "entry stone" or the like, of what locks on that side; a detent has one stone, which locks every time."""
    alone = roles(scene).lever is not None and len(_locking(scene)) == 1
    return f"{'locking' if alone else side} {pallet_word(scene)}"


def _locking(scene: Scene) -> list[Loop]:
    """The outlines of the lever that the wheel meets."""
    found = with_anchor(scene)
    contacts = [{side.body: side.layer for side in contact.sides} for contact in scene.contacts]
    pairs = [sides for sides in contacts if {found.wheel, found.lever} == set(sides)]
    return [loop for sides in pairs if found.lever for loop in layer_of(scene.body(found.lever), sides[found.lever])]


# With what do lever, oscillator and banking touch each other? Names of layers are as free as those of bodies.

OFF_PIVOT = 0.3  # of a layer's reach: a pin's middle is farther from the pivot, that of a roller is not


def touching(scene: Scene, found: Roles) -> Iterator[tuple[str, str | None, str]]:
    """Body, layer and name of what bodies meet each other with, besides teeth and pallets."""
    lever, own = found.lever, found.oscillator
    if lever is None or own is None:
        return
    contacts = [{side.body: side.layer for side in contact.sides} for contact in scene.contacts]
    pushed = [sides[lever] for sides in contacts if {found.wheel, lever} == set(sides)]
    most = max((len(layer_of(scene.body(lever), layer)) for layer in pushed), default=0)
    for sides in contacts:
        fixed = next((name for name in sides if scene.body(name).motion == "fixed"), None)
        if fixed is not None and lever in sides:
            detent = any(body.on == lever for body in scene.bodies)
            yield from ((fixed, sides[fixed], "banking"), (lever, sides[lever], "detent" if detent else "lever"))
        elif {lever, own} == set(sides):
            loops = layer_of(scene.body(own), sides[own])
            is_pin = math.hypot(*middle_of(loops)) > OFF_PIVOT * reach_of(loops)
            yield own, sides[own], "roller jewel" if is_pin else "safety roller"
            yield lever, sides[lever], "fork" if is_pin else "guard pin"
        elif found.wheel in sides and own in sides and lever != own:
            yield own, sides[own], "impulse stone"
        elif own in sides and lever != own and (carried := [name for name in sides if scene.body(name).on == lever]):
            yield from ((own, sides[own], "discharging jewel"), (carried[0], sides[carried[0]], "passing spring"))
        elif found.wheel in sides and lever in sides and len(layer_of(scene.body(lever), sides[lever])) == 1 < most:
            yield lever, sides[lever], "impulse stone"  # one beside the two that lock, as in a co-axial escapement


def layer_of(body: Body, layer: str | None) -> list[Loop]:
    return [loop for loop in body.loops if layer is None or loop.layer == layer]


def middle_of(loops: list[Loop]) -> Point:
    """The centre of the face; of an open outline the middle of its first edge."""
    closed = [loop for loop in loops if loop.closed]
    return mass_properties(closed, 1.0, 1.0).centre if closed else loops[0].edges[0].point(0.5)


def corners_of(loops: Sequence[Loop]) -> list[Point]:
    return [edge.point(share) for loop in loops for edge in loop.edges for share in (0.0, 0.5)]


def reach_of(loops: list[Loop]) -> float:
    return max(math.hypot(*point) for point in corners_of(loops))
