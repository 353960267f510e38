"""Cylinder escapement of a watch with its balance: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, ESTIMATE, Conflict, Design, Impossible, dim, sheets_of
from watchsim.construction.outline import angle_of, arc_between, arc_of_radius, circle, fillet_chain, polar
from watchsim.construction.parts import Arms, BalanceWheel, balance_wheel
from watchsim.construction.root import zero_between
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Edge, Line, Point

# Which numbers does the designer of a cylinder escapement choose?
#
# Angles of lift and lock are the balance's, of teeth and drop the wheel's.

HEADRICK = "Headrick 1997, Clock and Watch Escapement Mechanics, ch. 18"
USUAL = "usual in cylinder watches"


@dataclass(frozen=True)
class Cylinder:
    teeth: int = dim(15, "", 10, 20, "of the escape wheel", HEADRICK)
    centre_distance: float = dim(4.5, "mm", 1.0, 20.0, "of wheel and balance", CHOSEN)
    tooth_width: float = dim(10.0, "°", 4.0, 15.0, "of a tooth's impulse face, at the wheel's centre", HEADRICK)
    drop: float = dim(1.4, "°", 0.1, 4.0, "wheel, free from a let-off to the next rest, the same inside and outside", CHOSEN)
    lift: float = dim(40.0, "°", 20.0, 70.0, "balance, while a tooth drives a lip; mean of both lips", USUAL)
    lock: float = dim(
        8.0, "°", 1.0, 20.0, "balance, from the drop of a tooth until its point is at the lip; of the lesser", USUAL
    )
    wheel_inertia: float = dim(0.4, "mg·cm²", 1e-3, 100.0, "escape wheel with the train as felt there", ESTIMATE)
    balance_inertia: float = dim(15.0, "mg·cm²", 0.5, 1e3, "balance with cylinder and hairspring", ESTIMATE)
    frequency: float = dim(18000.0, "vph", 7200.0, 21600.0, "of the balance on its hairspring, in beats per hour", USUAL)
    q_factor: float = dim(150.0, "", 20.0, 1000.0, "quality factor of the balance without the escapement", ESTIMATE)
    torque: float = dim(0.4, "µN·m", 1e-3, 100.0, "of the train on the escape wheel", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.25, "coefficient of friction, teeth on the cylinder", "oiled steel on steel")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution, teeth on the cylinder", CHOSEN)
    start: float = dim(155.0, "°", 40.0, 190.0, "balance, from rest, where it is let go", CHOSEN)


# Which lengths and angles of a cylinder escapement follow from its dimensions?
#
# The wheel's centre O is the origin and it turns clockwise; the balance's centre B stands above, at the distance D. A tooth's
# impulse face runs from its point, D - x from O, back to its heel, D + x from O. With the balance turned counter-clockwise the
# point rests outside on the left wall of the shell. Turning back, the left lip passes the point, and the face lifts the lip;
# once the heel is through, the point drops on the inside of the right wall. On the way back the face lifts the right lip, and
# the next tooth's point drops on the left wall. Lips are half round: unlocked is where the middle of the lip and the point are
# in line with B, let off where the lip's middle and the heel are in line with O. Bearings are at O, from the line OB, positive
# on the left; directions at B. Millimetres, degrees.

FINE = 1e-14  # of the centre distance
STEEPEST = 0.14  # of it: half the rise of the impulse face


@dataclass(frozen=True)
class Shell:
    """The dimensions, and half the rise of the impulse faces."""

    values: Cylinder
    rise: float

    @property
    def distance(self) -> float:
        return self.values.centre_distance

    @property
    def balance(self) -> Point:
        return (0.0, self.distance)

    @property
    def pitch(self) -> float:
        return 360.0 / self.values.teeth

    @property
    def point_radius(self) -> float:
        return self.distance - self.rise

    @property
    def heel_radius(self) -> float:
        return self.distance + self.rise

    def bearing(self, reach: float, radius: float) -> float:
        """Of what is `reach` from O and `radius` from B."""
        cosine = (reach**2 + self.distance**2 - radius**2) / (2.0 * reach * self.distance)
        return math.degrees(math.acos(cosine)) if cosine < 1.0 else 0.0

    @cached_property
    def inner(self) -> float:
        """Radius of the shell inside: a tooth and the drop fit."""

        def excess(inner: float) -> float:
            return self._let_off_bearing(inner, self._outer(inner)) + self.bearing(self.point_radius, inner) - fits

        fits = self.values.tooth_width + self.values.drop
        return zero_between(excess, 1.001 * self.rise, 0.5 * self.distance, FINE * self.distance)

    @cached_property
    def outer(self) -> float:
        """Radius of the shell outside: it and the drop fit between two teeth."""
        return self._outer(self.inner)

    def _outer(self, inner: float) -> float:
        """With equal drops the walls take what is left of a pitch beside two teeth and two drops."""
        walls = self.pitch - 2.0 * (self.values.tooth_width + self.values.drop)
        angle = math.radians(self.bearing(self.point_radius, inner) + walls)
        x, y = self.point_radius * math.sin(angle), self.point_radius * math.cos(angle) - self.distance
        return math.hypot(x, y)

    def _let_off_bearing(self, inner: float, outer: float) -> float:
        """Of heel and lip's middle, in line with O."""
        return self.bearing(self.heel_radius + (outer - inner) / 2.0, (inner + outer) / 2.0)

    @property
    def let_off_bearing(self) -> float:
        return self._let_off_bearing(self.inner, self.outer)

    @property
    def driven(self) -> tuple[float, float]:
        """Turn of the wheel during the impulse on the left and on the right lip."""
        across = self.let_off_bearing - self.values.tooth_width
        return self.rests_outside - across, self.rests_inside + self.let_off_bearing + self.values.tooth_width

    @property
    def rests_outside(self) -> float:
        """Bearing of the point."""
        return self.bearing(self.point_radius, self.outer)

    @property
    def rests_inside(self) -> float:
        return -self.bearing(self.point_radius, self.inner)

    def _direction(self, reach: float, radius: float, side: int) -> float:
        """From B, of what is so far from O and from B: on the left (side 1) 90° to 270°, on the right (-1) -90° to 90°."""
        seen = angle_of(polar(reach, 90.0 + side * self.bearing(reach, radius)), self.balance)
        return seen % 360.0 if side > 0 else seen

    @cached_property
    def entry(self) -> tuple[float, float]:
        """Direction of the left lip's middle at unlocking and let-off."""
        return self._direction(self.point_radius, self.outer, 1), self._lip_let_off(1)

    @cached_property
    def exit(self) -> tuple[float, float]:
        """The same of the right lip."""
        return self._direction(self.point_radius, self.inner, -1), self._lip_let_off(-1)

    def _lip_let_off(self, side: int) -> float:
        return self._direction(self.heel_radius + (self.outer - self.inner) / 2.0, (self.inner + self.outer) / 2.0, side)

    @property
    def lifts(self) -> tuple[float, float]:
        """Of the balance, on the left and on the right lip."""
        return self.entry[0] - self.entry[1], self.exit[1] - self.exit[0]

    @property
    def span(self) -> float:
        """From lip to lip, over the shell: so that the lesser lock is as asked for."""
        return max(self.entry[1] - self.exit[0], self.entry[0] - self.exit[1]) + self.values.lock

    @property
    def locks(self) -> tuple[float, float]:
        """Inside and outside, of the balance."""
        return self.span - self.entry[1] + self.exit[0], self.span - self.entry[0] + self.exit[1]

    @property
    def left_lip(self) -> float:
        """Direction of its middle with the balance at rest: both let-offs are as far from there."""
        return (self.entry[1] + self.exit[1] + self.span) / 2.0

    @property
    def let_off(self) -> float:
        """Of the balance, from rest."""
        return self.left_lip - self.entry[1]

    @property
    def most(self) -> float:
        """Swing at which the other end of the shell comes round to a resting tooth; of the side where that is first."""
        return min(self.entry[0] - self.left_lip + self.span, self.left_lip - self.exit[0]) - self.values.lock


def shell(values: Cylinder) -> Shell:
    """The faces rise such that the mean lift is as asked for."""
    most = STEEPEST * values.centre_distance

    def excess(rise: float) -> float:
        return sum(Shell(values, rise).lifts) / 2.0 - values.lift

    try:
        if excess(most) > 0.0:
            return Shell(values, zero_between(excess, 1e-3 * most, most, FINE * most))
    except ValueError:
        raise Impossible("tooth_width", "no cylinder fits round such a tooth and between two of them") from None
    raise Impossible("lift", "needs impulse faces too steep to slide")


# What are the outlines of a cylinder escapement's wheel and balance?
#
# TEETH and SHELL touch. The teeth stand on pillars over the wheel's RIM, at the height of the shell's cut; it and the
# rim of the balance (BALANCE) are drawn only. Millimetres.

BELLY_AT, BELLY_DEEP, BELLY = 228.0, 0.74, 1.7  # foot of a tooth's back, from the cylinder's middle; radius; by the inner one
RIM, WIDTH, ARM, HUB, BORE, PILLAR = 0.74, 0.09, 0.06, 0.2, 0.05, 0.022  # of the wheel, by the centre distance
ARMS, BALANCE_ARMS, FILLET = 3, 3, 0.04


def face(shell: Shell) -> tuple[Point, Point]:
    """Point and heel of a tooth in the middle of the cylinder."""
    half = shell.values.tooth_width / 2.0
    return polar(shell.point_radius, 90.0 - half), polar(shell.heel_radius, 90.0 + half)


def tooth(shell: Shell) -> Loop:
    """A wedge: impulse face, back, and a belly that keeps clear of the inside of the shell; as it stands in the middle."""
    point, heel = face(shell)
    foot = polar(BELLY_DEEP * shell.inner, BELLY_AT, shell.balance)
    edges: list[Edge] = [Line(*point, *heel), Line(*heel, *foot), arc_of_radius(foot, point, BELLY * shell.inner)]
    return Loop(tuple(fillet_chain(edges, [0.0, 0.15 * shell.inner, 0.0], closed=True)), "TEETH")


def wheel(shell: Shell) -> list[Loop]:
    """Teeth, and below them the rim from which a pillar goes out to each; at angle 0 tooth 0 is in the middle."""
    d = shell.distance
    arms = Arms(ARMS, ARM * d, HUB * d, (RIM - WIDTH) * d, FILLET * d)
    return [
        *(tooth(shell).moved(math.radians(i * shell.pitch), (0.0, 0.0)) for i in range(shell.values.teeth)),
        Loop(tuple(edge for i in range(shell.values.teeth) for edge in _pillar(shell, i * shell.pitch)), "RIM"),
        *arms.windows("RIM"),
        circle("RIM", (0.0, 0.0), BORE * d, hole=True),
    ]


def _pillar(shell: Shell, turn: float) -> list[Edge]:
    """Up one pillar, down it, and along the rim to the next; counter-clockwise."""
    d, half = shell.distance, math.degrees(PILLAR / RIM)
    top = d - 0.62 * shell.inner
    first, last = 90.0 + turn - half, 90.0 + turn + half
    low, high = polar(RIM * d, first), polar(top, 90.0 + turn - 0.8 * half)
    back, foot = polar(top, 90.0 + turn + 0.8 * half), polar(RIM * d, last)
    rim = arc_between(foot, polar(RIM * d, first + shell.pitch), (0.0, 0.0), True)
    return [Line(*low, *high), Line(*high, *back), Line(*back, *foot), rim]


def balance(shell: Shell) -> list[Loop]:
    """Shell with its half-round lips, and the rim of the balance, which is at rest."""
    left, right = shell.left_lip, shell.left_lip - shell.span
    middle = (shell.inner + shell.outer) / 2.0
    edges: list[Edge] = [
        arc_between(polar(shell.outer, right), polar(shell.outer, left), (0.0, 0.0), True),
        arc_between(polar(shell.outer, left), polar(shell.inner, left), polar(middle, left), True),
        arc_between(polar(shell.inner, left), polar(shell.inner, right), (0.0, 0.0), False),
        arc_between(polar(shell.inner, right), polar(shell.outer, right), polar(middle, right), True),
    ]
    return [Loop(tuple(edges), "SHELL"), *(Loop(loop.edges, "BALANCE", hole=loop.hole) for loop in wheel_of(shell).rim())]


def wheel_of(shell: Shell) -> BalanceWheel:
    """Rim and hairspring of the balance."""
    return balance_wheel(shell.values.balance_inertia, shell.outer, 0.3 * shell.inner, BALANCE_ARMS)


LEAST_WALL = 0.04  # of the outer radius
PARTS = 20  # of an edge
HAIR = 1e-9  # of a radius
SLIDES = 5.0  # degrees by which an impulse face must be steeper than the angle of friction
SPARE = 5.0  # degrees of swing


def conflicts(values: Cylinder) -> Iterator[Conflict]:
    half = 180.0 / values.teeth
    if values.tooth_width + values.drop >= half:
        most = half - values.drop
        yield Conflict("tooth_width", f"must be less than {most:.4g}°: half a pitch is tooth, wall and drop")
        return
    made = shell(values)
    wall = 1.0 - made.inner / made.outer
    if wall < LEAST_WALL:
        words = f"with this drop leaves a wall of {1e3 * (made.outer - made.inner):.3g} µm, {100.0 * wall:.2g} % of the radius"
        yield Conflict("tooth_width", f"{words}; {100.0 * LEAST_WALL:g} % are needed")
    slope = math.degrees(math.atan2(2.0 * made.rise, made.distance * math.radians(values.tooth_width)))
    least = math.degrees(math.atan(values.friction)) + SLIDES
    if slope < least:
        words = f"gives impulse faces of {slope:.3g}°; with a friction of {values.friction:g} they must have {least:.3g}°"
        yield Conflict("lift", words)
    if values.start <= made.let_off:
        yield Conflict("start", f"must be more than {made.let_off:.4g}°, else no tooth is let off")
    if values.start > made.most - SPARE:
        words = f"must be less than {made.most - SPARE:.4g}°"
        yield Conflict("start", f"{words}: farther out the other end of the shell comes round to the tooth")
    yield from _drive(values, made)
    yield from _belly(made)


def _drive(values: Cylinder, made: Shell) -> Iterator[Conflict]:
    """The swing A that the drive would keep up if only damping and friction at rest took work: w = π k A² / 2 Q + 2 f A.

    Only a bound: the balance may swing less, so that too much torque is for the run to say.
    """
    stiffness = values.balance_inertia * 1e-10 * (math.pi * values.frequency / 3600.0) ** 2
    damping = 0.5 * math.pi * stiffness / values.q_factor
    work = values.torque * 1e-6 * math.radians(values.tooth_width)
    rubbing = values.friction * values.torque * 1e-6 * made.outer / made.distance
    swing = math.degrees((math.sqrt(rubbing**2 + damping * work) - rubbing) / damping)
    if swing < made.let_off:
        yield Conflict("torque", f"the balance would swing by {swing:.4g}° at most, and let off no tooth: more torque")


def _belly(made: Shell) -> Iterator[Conflict]:
    """A tooth that rests inside must be within the inner circle, those on both sides of the shell beyond the outer one."""
    inside = max(_distances(made, made.rests_inside))
    if inside > made.inner * (1.0 + HAIR):
        words = f"a tooth that rests inside would stand out of the shell by {1e3 * (inside - made.inner):.3g} µm"
        yield Conflict("drop", f"{words}: more drop, or a wider tooth")
    outside = min(*_distances(made, made.rests_outside), *_distances(made, made.rests_outside - made.pitch))
    if outside < made.outer * (1.0 - HAIR):
        words = f"the tooth before one that rests outside would be {1e3 * (made.outer - outside):.3g} µm within the shell"
        yield Conflict("drop", f"{words}: more drop, or a wider tooth")


def _distances(made: Shell, bearing: float) -> list[float]:
    """From the balance's centre, of points all round a tooth whose point is at that bearing."""
    turn = math.radians(bearing + made.values.tooth_width / 2.0)
    edges = tooth(made).moved(turn, (0.0, 0.0)).edges
    return [math.dist(edge.point(i / PARTS), made.balance) for edge in edges for i in range(PARTS + 1)]


CLEAR = 1e-4  # degrees by which the tooth stands off the shell at the start

WORDS = """\
A cylinder escapement: teeth rest on the cylinder, a half shell on the balance's arbor, outside and inside by turns, while the
balance swings on; in between their inclined faces lift its lips. Drawn to these dimensions:"""


def scene_text(values: Cylinder) -> str:
    """The text of scene.toml: a tooth at rest on the outside of the shell, the balance about to be let go."""
    made = shell(values)
    wheel_angle = round((made.rests_outside + values.tooth_width / 2.0 + CLEAR) % made.pitch, 9)
    return toml.scene(
        toml.head(values, WORDS, f"Cylinder escapement, {values.frequency:.0f} vph, {values.teeth} teeth"),
        toml.body(
            *("wheel", "escape_wheel", "TEETH", "turns clockwise"),
            draw="RIM",
            position=toml.ORIGIN,
            angle=toml.Noted(f"{wheel_angle!r}°", "a tooth just off the outside of the shell"),
            inertia=toml.Noted(f"{values.wheel_inertia:.15g} mg·cm²", "with the train as felt here", 6),
        ),
        toml.body(
            *("balance", "balance", "SHELL", "hangs at the end of a swing"),
            draw="BALANCE",
            position=toml.at(0, values.centre_distance),
            angle=f"{values.start!r}°",
            inertia=f"{values.balance_inertia:.15g} mg·cm²",
        ),
        toml.hairspring(values.frequency, wheel_of(made).hairspring(90.0)),
        toml.torque("wheel", f"{-values.torque!r} µN·m"),
        toml.q_factor("balance", values.q_factor),
        toml.contacts(values, "wheel.TEETH balance.SHELL"),
        toml.run("20 s", "1e-12"),
        toml.timegrapher(f"{values.lift:.15g}°"),
    )


def draw(values: Cylinder) -> dict[str, Sheet]:
    """Wheel, and balance with its cylinder."""
    made = shell(values)
    return sheets_of(escape_wheel=wheel(made), balance=balance(made))


DESIGN = Design("cylinder", "Cylinder escapement of a watch with its balance", Cylinder, draw, scene_text, conflicts)
