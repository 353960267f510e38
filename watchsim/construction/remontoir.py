"""Remontoir before a Swiss lever: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import scene_builder as toml
from watchsim.construction import swiss_lever as lever
from watchsim.construction.design import CHOSEN, Conflict, Design, Impossible, dim, sheets_of
from watchsim.construction.outline import arc_between, circle, polar, polygon
from watchsim.construction.swiss_lever import CLEAR, ESTIMATE, SwissLever, swiss, wheel_angle
from watchsim.construction.swiss_lever import draw as draw_lever
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Edge, Line, Point


@dataclass(frozen=True)
class Remontoir(SwissLever):
    """Those of the Swiss lever, of the spring, and of what winds it."""

    torque: float = dim(1.0, "µN·m", 1e-3, 1e3, "of the remontoir's spring in the middle between two windings", ESTIMATE)
    spring_rate: float = dim(0.03, "µN·m/rad", 1e-5, 100.0, "of the remontoir's spring", CHOSEN)
    train: float = dim(12.0, "µN·m", 1e-2, 1e5, "torque of the train on the stop wheel", CHOSEN)
    stop_teeth: int = dim(6, "", 5, 8, "teeth of the stop wheel, and its turns by those of the winder", CHOSEN)
    stop_radius: float = dim(1.5, "mm", 0.3, 10.0, "of the stop wheel, to the points of its teeth", CHOSEN)
    stop_lock: float = dim(0.3, "°", 0.05, 2.0, "stop lever, by which a pallet covers a tooth in the lever's middle", CHOSEN)
    arm: float = dim(4.5, "mm", 1.0, 30.0, "from the stop lever's pivot to the axis of the escape wheel", CHOSEN)
    disc: float = dim(0.4, "mm", 0.05, 5.0, "radius of the eccentric disc", CHOSEN)
    eccentricity: float = dim(0.18, "mm", 0.01, 3.0, "of the disc on the escape wheel", CHOSEN)
    slot_play: float = dim(0.004, "mm", 0.0005, 0.1, "by which the fork's slot is wider than the disc", CHOSEN)
    winder_inertia: float = dim(0.01, "mg·cm²", 1e-4, 100.0, "what holds the outer end of the spring", ESTIMATE)
    stop_wheel_inertia: float = dim(0.5, "mg·cm²", 1e-3, 1e4, "stop wheel with the train as felt there", ESTIMATE)
    stop_lever_inertia: float = dim(0.05, "mg·cm²", 1e-4, 1e3, "stop lever", ESTIMATE)
    stop_friction: float = dim(0.1, "", 0.0, 0.3, "coefficient of friction at stop lever and disc", "steel on oiled steel")


# Which places and moments follow from the dimensions of a remontoir?
#
# The stop wheel's pointed teeth lock by turns on two pallets, one and a half pitches apart. Both locking faces are arcs about
# the stop lever's pivot, so that a tooth at rest does not turn the lever; the centres are as far apart as makes a tooth's
# motion point at that pivot, or away from it. The eccentric disc turns clockwise with the escape wheel; at the beginning it
# stands at START to the line from the lever's pivot through the axis. Millimetres, degrees.

START = 84.0


def half_span(values: Remontoir) -> float:
    """From the line of centres to a locked tooth, at the stop wheel."""
    return 1.5 * 180.0 / values.stop_teeth


def centre_distance(values: Remontoir) -> float:
    """Of stop wheel and stop lever."""
    return values.stop_radius / math.cos(math.radians(half_span(values)))


def locking_radius(values: Remontoir) -> float:
    """Of the locking faces, about the lever's pivot."""
    return values.stop_radius * math.tan(math.radians(half_span(values)))


def disc_at(values: Remontoir, turn: float) -> Point:
    """The disc's middle from the stop lever's pivot, when it stands at `turn` about the escape wheel's axis."""
    x, y = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    return values.arm + values.eccentricity * x, values.eccentricity * y


def lever_at(values: Remontoir, turn: float) -> float:
    """Angle of the stop lever with the disc in the middle of its slot."""
    x, y = disc_at(values, turn)
    return math.degrees(math.atan2(y, x))


def slack(values: Remontoir) -> float:
    """By which the lever stays behind the disc that leads it."""
    return math.degrees(values.slot_play / 2.0 / values.arm)


def letting_go(values: Remontoir) -> float:
    """Where the disc stands when it has led the lever down so far that the first tooth is let go.

    Law of sines in the triangle of the lever's pivot, the axis and the disc's middle.
    """
    led = values.stop_lock + slack(values)
    return -led - math.degrees(math.asin(values.arm * math.sin(math.radians(led)) / values.eccentricity))


def middle(values: Remontoir) -> float:
    """How far the escape wheel turns, counter-clockwise, from the start to the middle between the first two windings."""
    return letting_go(values) - START + 90.0


def hardest(values: Remontoir) -> float:
    """Torque that the wound spring asks of the stop wheel, µN·m: half a turn beyond its weakest."""
    return values.stop_teeth * (values.torque + values.spring_rate * math.pi / 2.0)


# What are the outlines of a remontoir's stop wheel and stop lever?
#
# Six pointed teeth, by default; pallets to the left of the lever's pivot, to its right a fork that holds the eccentric disc.

CORE, BORE, THICK = 8.0 / 15.0, 0.1, 2.0 / 15.0  # of the stop wheel's radius; thickness of a pallet
LEAN, BACK, REACH = 20.0, 45.0, 25.0  # degrees: front from the radius; foot of the back behind the tip; length of a pallet
PRONG, WALL = 1.75, 0.545  # of the disc's radius: half the length of a prong, its thickness
HUB, ROOT = 0.15, 0.3  # mm by an arm of 4.5 mm: half the beam, and how far it reaches behind the pivot


def stop_wheel(values: Remontoir) -> list[Loop]:
    """Pointed teeth that turn counter-clockwise, and the bore."""
    tip, core, pitch = values.stop_radius, CORE * values.stop_radius, 360.0 / values.stop_teeth
    lean = math.radians(LEAN)
    along = tip * math.cos(lean) - math.sqrt(core**2 - (tip * math.sin(lean)) ** 2)  # length of the front, down to the core
    front = math.degrees(math.atan2(-along * math.sin(lean), tip - along * math.cos(lean)))
    if front >= pitch - BACK:
        raise Impossible("stop_teeth", "are too many: they would overlap at their feet")
    edges: list[Edge] = []
    for turn in (pitch * i for i in range(values.stop_teeth)):
        foot, head, heel = polar(core, turn - BACK), polar(tip, turn), polar(core, turn + front)
        next_foot = polar(core, turn + pitch - BACK)
        edges += [Line(*foot, *head), Line(*head, *heel), arc_between(heel, next_foot, (0.0, 0.0), True)]
    return [Loop(tuple(edges), "TEETH"), circle("TEETH", (0.0, 0.0), BORE * tip, hole=True)]


def stop_lever(values: Remontoir) -> list[Loop]:
    """Pallets and fork; what holds them together touches nothing."""
    lock, radius, thick = values.stop_lock, locking_radius(values), THICK * values.stop_radius
    upper, lower = 90.0 + half_span(values), 270.0 - half_span(values)
    exit_ = _pallet(radius, radius + thick, upper + lock - REACH, upper + lock)
    entry = _pallet(radius - thick, radius, lower - lock, lower - lock + REACH)
    return [exit_, entry, _prong(values, 1), _prong(values, -1), *_arms(values, radius, upper, lower)]


def _pallet(inner: float, outer: float, first: float, last: float) -> Loop:
    """A sector of a ring about the pivot, mm and degrees."""
    a, b, c, d = polar(inner, first), polar(outer, first), polar(outer, last), polar(inner, last)
    edges = (Line(*a, *b), arc_between(b, c, (0.0, 0.0), True), Line(*c, *d), arc_between(d, a, (0.0, 0.0), False))
    return Loop(edges, "PALLETS")


def _prong(values: Remontoir, side: int) -> Loop:
    near, far = _slot(values), _outside(values)
    left, right = values.arm - PRONG * values.disc, values.arm + PRONG * values.disc
    return polygon("FORK", [(left, side * near), (right, side * near), (right, side * far), (left, side * far)][::side])


def _arms(values: Remontoir, radius: float, upper: float, lower: float) -> tuple[Loop, ...]:
    hub, root = (share * values.arm / 4.5 for share in (HUB, ROOT))
    far, fork = _outside(values), values.arm - PRONG * values.disc
    neck, half = fork - PRONG * values.disc * 3.0 / 7.0, 0.5 * THICK * values.stop_radius
    beam = [(-root, -hub), (neck, -hub), (fork, -far), (fork, far), (neck, hub), (-root, hub)]
    above = [polar(radius - half, upper - 23.0), polar(hub, 60.0), polar(hub, 180.0), polar(radius + half, upper - 15.0)]
    below = [polar(radius - half, lower + 15.0), polar(hub, 180.0), polar(hub, 300.0), polar(radius - half, lower + 23.0)]
    return polygon("ARM", beam), polygon("UPPER", above), polygon("LOWER", below)


def _slot(values: Remontoir) -> float:
    """Half of its width."""
    return values.disc + values.slot_play / 2.0


def _outside(values: Remontoir) -> float:
    return _slot(values) + WALL * values.disc


WORDS = """\
A remontoir before a Swiss lever: the train does not drive the escape wheel but winds a weak spring on its arbor. An eccentric
disc on the escape wheel leads a stop lever; twice in a turn it lets a tooth of the stop wheel go, and the train winds the
spring by half a turn. So the escapement feels the spring alone, whatever the mainspring does. Drawn to these dimensions:"""

WINDER = (("-0.06 mm", "-0.06 mm"), ("1.1 mm", "-0.06 mm"), ("1.1 mm", "0.06 mm"), ("-0.06 mm", "0.06 mm"))


@dataclass(frozen=True)
class _Plastic:
    """The law of the remontoir's own contacts: dry, without rebound."""

    friction: float
    restitution: float = 0.0


def scene_text(values: Remontoir) -> str:
    """The text of scene.toml: the lever as by itself, a tooth of the stop wheel on the upper pallet."""
    wheel = wheel_angle(swiss(values))
    share = 100.0 * values.spring_rate * 0.5 * math.pi / values.torque
    return toml.scene(
        toml.head(values, WORDS, "Remontoir before a Swiss lever"),
        lever.parts(values),
        toml.table(
            *("[bodies.eccentric]", "on the escape wheel", 8),
            on="wheel",
            motion="fixed",
            circle=f"{values.disc:.15g} mm",
            position=toml.at(*polar(values.eccentricity, START - wheel)),
        ),
        toml.table(
            *("[bodies.winder]", "holds the outer end of the spring; on the axis of the escape wheel", 8),
            polygon=WINDER,
            position=toml.ORIGIN,
            inertia=f"{values.winder_inertia:.15g} mg·cm²",
        ),
        toml.body(
            *("stop_wheel", "stop_wheel", "TEETH"),
            "turns counter-clockwise, by half a pitch for half a turn of the winder",
            pivot=toml.ORIGIN,
            position=toml.at(-values.arm - centre_distance(values), 0),
            angle=toml.Noted(f"{half_span(values) - 2.0 * CLEAR:.15g}°", "a tooth a few nanometres off the upper pallet", 6),
            inertia=toml.Noted(f"{values.stop_wheel_inertia:.15g} mg·cm²", "with the train as felt here", 6),
        ),
        toml.body(
            *("stop_lever", "stop_lever", "PALLETS FORK"),
            pivot=toml.ORIGIN,
            position=toml.at(-values.arm, 0),
            angle=f"{lever_at(values, START)!r}°",
            inertia=f"{values.stop_lever_inertia:.15g} mg·cm²",
        ),
        toml.table("[[gears]]", between=("stop_wheel", "winder"), ratio=-values.stop_teeth),
        toml.table(
            *("[[torques]]", "the remontoir's spring, wound far: so much in the middle between two windings ..."),
            body="wheel",
            against="winder",
            value=f"{-values.torque:.15g} µN·m",
        ),
        toml.table(
            *("[[springs]]", f"... and {share:.3g} % more or less at their ends, a quarter of a turn to either side"),
            body="wheel",
            against="winder",
            stiffness=f"{values.spring_rate:.15g} µN·m/rad",
            rest=f"{wheel + middle(values)!r}°",
        ),
        toml.torque("stop_wheel", f"{values.train:.15g} µN·m", "of the train"),
        toml.contacts(
            _Plastic(values.stop_friction), "stop_wheel.TEETH stop_lever.PALLETS", "eccentric.circle stop_lever.FORK"
        ),
        lever.rest(values),
    )


SURE, SPARE = 1.5, 1.1  # times what lets a tooth go, and times what winds the spring


def draw(values: Remontoir) -> dict[str, Sheet]:
    """The sheets of the lever, stop wheel and stop lever."""
    return draw_lever(values) | sheets_of(stop_wheel=stop_wheel(values), stop_lever=stop_lever(values))


def conflicts(values: Remontoir) -> Iterator[Conflict]:
    """What cannot be drawn or cannot work, of the lever and of what winds it."""
    yield from lever.conflicts(values)
    least = values.arm * math.tan(math.radians(SURE * (values.stop_lock + slack(values))))
    if values.eccentricity < least:
        yield Conflict("eccentricity", f"must be at least {least:.3g} mm, to lead the stop lever clear of both pallets")
    if values.eccentricity + values.disc > PRONG * values.disc:
        yield Conflict("eccentricity", f"must be at most {(PRONG - 1.0) * values.disc:.3g} mm: the disc would leave its fork")
    if values.arm - 2.0 * PRONG * values.disc < 0.5 * locking_radius(values):
        yield Conflict("arm", "leaves no room between the stop lever's pivot and its fork")
    if values.train < SPARE * hardest(values):
        words = f"must be at least {SPARE * hardest(values):.3g} µN·m: the wound spring asks for {hardest(values):.3g} µN·m"
        yield Conflict("train", words)


DESIGN = Design("remontoir", "Remontoir before a Swiss lever", Remontoir, draw, scene_text, conflicts)
