"""Which shapes do several designs share: stones, arms, balances, levers, gears, teeth, pendulums; and which scenes?"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import Conflict, Values
from watchsim.construction.outline import (
    along,
    angle_of,
    arc_between,
    around,
    circle,
    fillet_chain,
    filleted,
    mirrored,
    polar,
    polygon,
    rounded,
    to_circle,
    turned,
)
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN, Edge, Line, Point

# What is the outline of a stone: a prism with a slanted end, held in a slot?
#
# In the frame of the part that holds it, millimetres.


@dataclass(frozen=True)
class Stone:
    """A prism: `at(t, v)` is t along the working face, away from its tip, and v across, into the stone.

    The face runs from `tip` in the direction `face` (degrees); the material is to the right of it. `relief` is how far the
    end's other corner stands back.
    """

    tip: Point
    face: float
    width: float
    length: float
    relief: float

    def at(self, t: float, v: float) -> Point:
        ux, uy = polar(1.0, self.face)
        return (self.tip[0] + t * ux + v * uy, self.tip[1] + t * uy - v * ux)

    def loop(self, layer: str, edge: float) -> Loop:
        """Tip, end, back and face, counter-clockwise; the two edges of the shank rounded by `edge`."""
        corners = [self.tip, self.at(self.relief, self.width), self.at(self.length, self.width), self.at(self.length, 0.0)]
        return rounded(layer, list(zip(corners, (0.0, 0.0, edge, edge), strict=True)))


def too_little_draw(values: Values) -> Iterator[Conflict]:
    """A locking face has to lean by more than the angle of friction."""
    holds = math.degrees(math.atan(values.friction))
    if holds >= values.draw:
        words = f"{values.draw:.4g}° does not hold at a friction of {values.friction:.4g}: more than {holds:.2f}° is needed"
        yield Conflict("draw", words)


# What is the opening between two arms of a wheel?


@dataclass(frozen=True)
class Arms:
    """Straight arms between hub and rim, evenly spaced, the first along the x axis; lengths in millimetres."""

    number: int
    width: float
    hub: float  # radius
    rim: float  # inner radius
    fillet: float  # in the corners of the openings

    def windows(self, layer: str) -> list[Loop]:
        """The openings, to be drawn with the wheel's layer."""
        return [Loop(tuple(self.window(i)), layer, hole=True) for i in range(self.number)]

    def window(self, i: int) -> list[Edge]:
        """The opening between arms i and i + 1, clockwise."""
        first, last = self._side(i, 1.0), self._side(i + 1, -1.0)
        chain: list[Edge] = [
            arc_between(last[1], first[1], (0.0, 0.0), False),
            Line(*first[1], *first[0]),
            arc_between(first[0], last[0], (0.0, 0.0), True),
            Line(*last[0], *last[1]),
        ]
        return fillet_chain(chain, [self.fillet] * 4, closed=True)

    def _side(self, arm: int, side: float) -> tuple[Point, Point]:
        """Where one edge of an arm leaves the hub and reaches the rim."""
        half, angle = self.width / 2.0, arm * (360.0 / self.number)
        hub, rim = (turned((math.sqrt(r * r - half * half), side * half), angle) for r in (self.hub, self.rim))
        return hub, rim


# What does a balance of a given inertia look like: its rim with arms, and its hairspring?
#
# Drawn only; nothing of it touches anything. The rim is as large as one of Glucydur with a square section in the usual
# proportion, so that a heavier balance looks heavier. Millimetres.

GLUCYDUR = 8.25  # mg/mm³
SECTION = 0.12  # of the radius: width and height of the rim
RADIUS_OF_GYRATION = 1.0 - 0.5 * SECTION
ARM, HUB, FILLET = 0.085, 0.13, 0.035  # of the radius: width of an arm, radius of the hub, corners of the openings
CLEAR_OF_ROLLER = 1.8  # times the reach of roller and stones, at least
INNER, OUTER = 0.12, 0.62  # of the rim's radius: the hairspring's collet and stud
TURNS = 13
PLACES = 3  # decimals of a millimetre that a scene needs


@dataclass(frozen=True)
class BalanceWheel:
    """A rim with straight arms, the first along the x axis, and the hairspring within."""

    radius: float
    arms: int
    staff: float  # radius of its hole

    def rim(self) -> list[Loop]:
        """The outlines on the layer RIM: outer edge, staff's hole, openings between the arms."""
        r = self.radius
        spokes = Arms(self.arms, ARM * r, max(HUB * r, 2.0 * self.staff), (1.0 - SECTION) * r, FILLET * r)
        return [circle("RIM", (0.0, 0.0), r), circle("RIM", (0.0, 0.0), self.staff, hole=True), *spokes.windows("RIM")]

    def hairspring(self, stud: float) -> dict[str, object]:
        """What a scene says of the hairspring, its stud in that direction (degrees)."""
        inner, outer = (f"{round(share * self.radius, PLACES):g} mm" for share in (INNER, OUTER))
        return {"inner": inner, "outer": outer, "turns": TURNS, "stud": f"{stud:g}°"}


def balance_wheel(inertia: float, reach: float, staff: float, arms: int) -> BalanceWheel:
    """That of a balance of `inertia` (mg·cm²) whose roller reaches so far and whose staff has that radius (mm)."""
    # I = 2 pi rho (section R)² (gyration R)³, with R the outer radius and 100 mg·mm² to the mg·cm²
    fifth = 100.0 * inertia / (math.tau * GLUCYDUR * SECTION**2 * RADIUS_OF_GYRATION**3)
    return BalanceWheel(max(fifth**0.2, CLEAR_OF_ROLLER * reach), arms, staff)


# Which outlines do lever escapements share: fork, impulse pin, safety roller and guard?
#
# In the frame of their part, millimetres: the lever's pivot in the origin and the balance above it, or the balance's centre in
# the origin and the lever below.


def edge_half(reach: float, centre: float, radius: float, edge: float) -> float:
    """From the middle line to the rounding, of radius `edge`, between the flat of an impulse pin and its round side.

    The flat is `reach` from the balance's centre, the centre of the round side `centre`.
    """
    return math.sqrt((radius - edge) ** 2 - (reach - edge - centre) ** 2)


def horn_radius(reach: float, centre: float, radius: float, edge: float, clearance: float) -> float:
    """Of the horns about the balance's centre, lever on the bank: past the farthest point of the pin's edge."""
    return math.hypot(edge_half(reach, centre, radius, edge), reach - edge) + edge + clearance


def impulse_pin(reach: float, centre: float, radius: float, height: float, edge: float) -> Loop:
    """A round pin with part of its diameter ground away: the flat, `height` from the pin's middle, looks outwards."""
    half = math.sqrt(radius**2 - height**2)
    left, right = (-half, -reach), (half, -reach)
    return filleted("PIN", [(Line(*left, *right), edge), (arc_between(right, left, (0.0, -centre), True), edge)])


def safety_roller(radius: float, depth: float, half_opening: float, edge: float) -> Loop:
    """A disc with a hollow for the guard's point; the opening in degrees at the balance's centre."""
    bottom = radius - depth
    right, left = (polar(radius, -90.0 + side * half_opening) for side in (1.0, -1.0))
    half, height = right[0], -right[1]
    hollow = (half**2 + (height - bottom) ** 2) / (2.0 * (height - bottom))  # circle through both edges and the bottom
    back = arc_between(left, right, (0.0, -(bottom + hollow)), False)
    return filleted("SAFETY", [(arc_between(right, left, (0.0, 0.0), True), edge), (back, edge)])


def guard(
    layer: str, y: float, tip: float, half: float, slope: float, drop: float, foot: tuple[float, float], fillet: float
) -> Loop:
    """A round foot (height of its centre, radius), a bar of half width `half`, and a point rounded by `tip` about (0, y).

    The point leans by `slope` (degrees) from the middle line, and is `drop` high from the bar to its rounding.
    """
    left, right = polar(tip, 180.0 - slope, (0.0, y)), polar(tip, slope, (0.0, y))
    join = foot[0] + math.sqrt(foot[1] ** 2 - half**2)
    shoulder = right[1] - drop
    parts: list[tuple[Edge, float]] = [
        (arc_between((-half, join), (half, join), (0.0, foot[0]), True), fillet),
        (Line(half, join, half, shoulder), 0.0),
        (Line(half, shoulder, *right), 0.0),
        (arc_between(right, left, (0.0, y), True), 0.0),
        (Line(*left, -half, shoulder), 0.0),
        (Line(-half, shoulder, -half, join), fillet),
    ]
    return filleted(layer, parts)


def fork_outline(
    outside: Sequence[Point], tip: Point, about: tuple[Point, float], slot: tuple[float, float], radii: Sequence[float]
) -> Loop:
    """Counter-clockwise from the left end of the neck; the right half is drawn, the left one is its mirror image.

    The right half runs from the neck over the places `outside`, of which the last is the outer end of the horn, to the inner
    end of the horn, `tip`; along an arc `about` the balance on the bank (centre, radius), into the slot (half width, bottom).
    """
    (half, bottom), (centre, reach) = slot, about
    mouth = (half, centre[1] - math.sqrt(reach**2 - (half - centre[0]) ** 2))
    ways = [Line(*a, *b) for a, b in zip(outside, [*outside[1:], tip], strict=True)]
    right: list[Edge] = [*ways, arc_between(tip, mouth, centre, False), Line(*mouth, half, bottom)]
    (x, neck), left = outside[0], [mirrored(edge) for edge in reversed(right)]
    edges: list[Edge] = [Line(-x, neck, x, neck), *right, Line(half, bottom, -half, bottom), *left]
    return filleted("FORK", list(zip(edges, [0.0, *radii, *reversed(radii), 0.0], strict=True)))


# How does the outline of a gear follow from one flank of a tooth?
#
# In the gear's own frame, millimetres; tooth 0 is centred on the x axis.

BORE = 0.25  # by the radius of the floor


def arc_through(first: Point, middle: Point, last: Point) -> Edge:
    """The arc through three points."""
    ax, ay = middle[0] - first[0], middle[1] - first[1]
    bx, by = last[0] - first[0], last[1] - first[1]
    cross = 2.0 * (ax * by - ay * bx)
    a, b = ax * ax + ay * ay, bx * bx + by * by
    centre = (first[0] + (by * a - ay * b) / cross, first[1] + (ax * b - bx * a) / cross)
    return arc_between(first, last, centre, cross > 0.0)


def other_flank(right: Sequence[Edge]) -> list[Edge]:
    """The left flank, from tip to foot, of a tooth whose right one is given from foot to tip."""
    return [_mirrored(edge).reversed() for edge in reversed(right)]


def gear_outline(layer: str, tooth: Sequence[Edge], teeth: int, floor: float) -> list[Loop]:
    """The toothed contour, one tooth with its gap turned round, and the bore."""
    pitch = TURN / teeth
    outline = around(layer, tooth, (i * pitch for i in range(teeth)))
    return [outline, circle(layer, (0.0, 0.0), BORE * floor, hole=True)]


def _mirrored(edge: Edge) -> Edge:
    """Across the x axis; from the same end to the same end."""
    if isinstance(edge, Line):
        return Line(edge.x0, -edge.y0, edge.x1, -edge.y1)
    start, end = (edge.start[0], -edge.start[1]), (edge.end[0], -edge.end[1])
    return arc_between(start, end, (edge.x, -edge.y), edge.sweep < 0.0)


# What is the outline of pointed teeth with undercut fronts, of which only the tips work, and hollow backs?
#
# In the wheel's own frame, millimetres; tooth 0 has its tip on the x axis and the wheel turns clockwise.


@dataclass(frozen=True)
class ToothForm:
    """One wheel's teeth: radii of tips and of the gaps' floor, the tip's flat, the back's lean there, fillets."""

    tip: float
    root: float
    land: float
    back: float  # length of the straight back behind the flat
    lean: float  # of that back from the radius, degrees
    hollow: float  # radius behind that
    front_fillet: float


def contour(form: ToothForm, undercut: float, layer: str, teeth: int) -> Loop:
    """All teeth, counter-clockwise; one tooth and the gap behind it, turned as often as there are teeth."""
    return around(layer, tooth_and_gap(form, undercut, 360.0 / teeth), (i * TURN / teeth for i in range(teeth)))


def tooth_and_gap(form: ToothForm, undercut: float, pitch: float) -> list[Edge]:
    """From the middle of the gap before the tooth over its tip to the middle of the next gap."""
    tip = (form.tip, 0.0)
    flat = math.degrees(form.land / form.tip)
    heel = polar(form.tip, flat)
    back = along(heel, flat + 180.0 - form.lean, form.back)
    foot = along(tip, 180.0 - undercut, to_circle(tip, 180.0 - undercut, form.root, out=False))
    hollow, end = hollow_back(back, form.hollow, form.root)
    before = polar(form.root, (angle_of(foot) + angle_of(end) - pitch) / 2.0)
    after = turned(before, pitch)
    chain: list[Edge] = [
        arc_between(before, foot, (0.0, 0.0), True),
        Line(*foot, *tip),
        arc_between(tip, heel, (0.0, 0.0), True),
        Line(*heel, *back),
        hollow,
        arc_between(end, after, (0.0, 0.0), True),
    ]
    return fillet_chain(chain, [form.front_fillet, 0.0, 0.0, 0.0, 0.0])


def hollow_back(back: Point, radius: float, root: float) -> tuple[Edge, Point]:
    """The hollow behind a tooth: an arc through `back` that runs tangentially into the gap's floor, and where it ends."""
    reach, distance = root + radius, math.hypot(*back)
    cosine = (distance**2 + reach**2 - radius**2) / (2.0 * distance * reach)
    if not -1.0 <= cosine <= 1.0:
        raise ValueError("the backs of the teeth do not reach the floor of their gaps")
    bearing = angle_of(back) + math.degrees(math.acos(cosine))
    return arc_between(back, polar(root, bearing), polar(reach, bearing), False), polar(root, bearing)


def gear_pair_scene(values: Values, heading: str, title: str, distance: float) -> str:
    """The text of scene.toml: both at rest, in the middle of the play; `distance` of the axes, mm."""
    pinion = (180.0 + 180.0 / values.pinion_teeth) % (360.0 / values.pinion_teeth)
    return toml.scene(
        toml.head(
            *(values, f"{heading}, drawn to these dimensions:"),
            f"{title}, {values.wheel_teeth} and {values.pinion_teeth} teeth",
        ),
        toml.body(
            *("wheel", "wheel", "TEETH", "drives, counter-clockwise"),
            position=toml.ORIGIN,
            angle=toml.Noted("0°", "a tooth on the line of centres", 22),
            inertia=f"{values.wheel_inertia:.15g} mg·cm²",
        ),
        toml.body(
            *("pinion", "pinion", "TEETH", "a gap on the line of centres"),
            position=toml.at(distance, 0),
            angle=f"{pinion!r}°",
            inertia=f"{values.pinion_inertia:.15g} mg·cm²",
        ),
        toml.torque("wheel", f"{values.torque:.15g} µN·m"),
        toml.table("[[damping]]", body="pinion", viscous=f"{values.drag:.15g} µN·m·s/rad"),
        toml.contacts(values, "wheel.TEETH pinion.TEETH"),
        toml.run("2 s", "1e-10"),
    )


# What do pendulum clocks share: the pendulum's outlines beside its pallets, and the end of the scene?

ROD_DENSITY = 7850.0  # kg/m³, steel


def pendulum(values: Values, pallets: Sequence[Loop], anchor: Loop, bore: float, half: float) -> list[Loop]:
    """PALLETS are what the teeth meet; ANCHOR, ROD and BOB touch nothing. Radius of the bore, half the width of the rod."""
    low = -values.pendulum
    hole = circle("ANCHOR", (0.0, 0.0), bore, hole=True)
    rod = polygon("ROD", [(-half, 0.0), (-half, low), (half, low), (half, 0.0)])
    return [*pallets, anchor, hole, rod, circle("BOB", (0.0, low), values.bob_radius)]


def pendulum_clock(values: Values, touching: str, bob: float, thickness: float) -> tuple[str, ...]:
    """The tables after wheel and pendulum, whose bob is so thick that it has its mass: density of the bob, kg/m³; thickness of
    the rod, mm."""
    thick = values.bob_mass / (bob * (math.pi * values.bob_radius**2)) * 1e9
    mass = toml.Noted(f"{thick!r} mm", f"makes its mass {values.bob_mass:.6g} kg", 7)
    solids = "[[bodies.pendulum.solids]]"
    return (
        toml.table(solids, layer="BOB", thickness=mass, density=f"{bob:g} kg/m³"),
        toml.table(solids, layer="ROD", thickness=f"{thickness:g} mm", density=f"{ROD_DENSITY:g} kg/m³"),
        toml.torque("wheel", f"{-values.torque:.15g} mN·m"),
        toml.q_factor("pendulum", values.q_factor),
        toml.contacts(values, touching),
        toml.run("60 s", "1e-12"),
        toml.timegrapher(f"{values.lift!r}°"),
    )
