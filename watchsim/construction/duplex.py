"""Duplex escapement of a watch with its balance: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, ESTIMATE, Conflict, Design, Impossible, dim, sheets_of
from watchsim.construction.outline import along, arc_between, circle, polar, rounded, turned
from watchsim.construction.parts import Arms, BalanceWheel, Stone, ToothForm, balance_wheel, contour, tooth_and_gap
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line

# Which numbers does the designer of a duplex escapement choose?
#
# Angles of notch, drop and letting go are the balance's, of the reach the wheel's.

ABBOTT = "Abbott, The American Watchmaker and Jeweler (1893), Duplex Escapement"
USUAL = "usual in duplex watches"


@dataclass(frozen=True)
class Duplex:
    teeth: int = dim(15, "", 10, 16, "of the escape wheel: so many long ones that rest, so many upright ones that drive", USUAL)
    tip_radius: float = dim(6.0, "mm", 1.5, 15.0, "escape wheel, to the points of the resting teeth", CHOSEN)
    roller_ratio: float = dim(1.0 / 15.0, "", 0.04, 0.1, "ratio of the roller's radius to that of the resting teeth", ABBOTT)
    intersection: float = dim(
        25.0, "°", 12.0, 40.0, "half of the roller's arc within the circle of the points", f"{ABBOTT}: about 30°"
    )
    notch: float = dim(22.0, "°", 12.0, 40.0, "breadth of the notch, at the roller's centre", CHOSEN)
    impulse_ratio: float = dim(
        2.0 / 3.0, "", 0.55, 0.75, "ratio of the impulse teeth's radius to that of the resting teeth", ABBOTT
    )
    reach: float = dim(8.5, "°", 6.0, 13.0, "wheel, half overlap of the circles of impulse teeth and pallet", CHOSEN)
    drop: float = dim(10.0, "°", 3.0, 16.0, "balance, by which the pallet is ahead of the tooth that will drive it", ABBOTT)
    letting_go: float = dim(2.0, "°", -40.0, 30.0, "balance, from rest, where the notch lets a tooth go", CHOSEN)
    undercut: float = dim(16.0, "°", 8.0, 21.0, "of the fronts of the teeth, so that points touch", CHOSEN)
    wheel_inertia: float = dim(0.5, "mg·cm²", 1e-3, 100.0, "escape wheel with the train as felt there", ESTIMATE)
    balance_inertia: float = dim(60.0, "mg·cm²", 2.0, 1e4, "balance with roller, pallet and hairspring", ESTIMATE)
    frequency: float = dim(18000.0, "vph", 9000.0, 21600.0, "of the balance on its hairspring, in beats per hour", USUAL)
    q_factor: float = dim(200.0, "", 20.0, 1000.0, "quality factor of the balance without the escapement", ESTIMATE)
    torque: float = dim(4.0, "µN·m", 0.01, 500.0, "of the train on the escape wheel", CHOSEN)
    friction: float = dim(0.07, "", 0.0, 0.2, "coefficient of friction, in all contacts", "oiled brass on polished ruby")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution, in all contacts", CHOSEN)
    start: float = dim(220.0, "°", 60.0, 280.0, "balance, from rest, where it is let go", CHOSEN)


# Which points follow from the dimensions of a duplex escapement?
#
# The wheel's centre O is the origin and it turns clockwise; the balance's centre B stands above, and turns counter-clockwise as
# it takes its impulse. The circle of the resting teeth's points cuts the roller; a tooth rests on the left of that arc. As the
# notch comes by, the point falls into it, goes through with it and is let go on the right; an upright tooth then drops on the
# impulse pallet. With a tooth at rest the line of centres is in the middle between two impulse teeth, where the pallet can
# pass.
# Bearings are at O, from the line OB, positive on the left; the pallet's angle is at B, from that line, positive to the right.


class DuplexPoints:
    """Lengths in millimetres, angles in degrees."""

    def __init__(self, values: Duplex) -> None:
        self.values = values
        self.pitch = 360.0 / values.teeth
        self.roller = values.roller_ratio * values.tip_radius
        """Radius of the roller."""
        half = math.radians(values.intersection)
        resting = math.asin(self.roller * math.sin(half) / values.tip_radius)
        self.rests = math.degrees(resting)
        """Bearing of the point of a tooth at rest; let go at its negative."""
        self.distance = values.tip_radius * math.cos(resting) + self.roller * math.cos(half)
        self.inside = values.tip_radius + self.roller - self.distance
        """How deep the points come into the roller."""
        self.impulse_radius = values.impulse_ratio * values.tip_radius
        across = self.impulse_radius * math.sin(math.radians(values.reach))
        along = self.distance - self.impulse_radius * math.cos(math.radians(values.reach))
        self.pallet = math.hypot(across, along)
        """From B to the tip of the pallet."""
        self.half_impulse = math.degrees(math.atan2(across, along))
        """Angle of the pallet at the ends of the overlap."""
        self.waiting = self.pitch / 2.0
        """Bearing of the impulse tooth that will drive, with a tooth at rest; the one before it is as far on the right."""

    def pallet_at(self, bearing: float) -> float:
        """Angle of the pallet whose tip a tooth at that bearing would meet: its face points at B."""
        x, y = math.sin(math.radians(bearing)), math.cos(math.radians(bearing))
        return -math.degrees(math.atan2(self.impulse_radius * x, self.distance - self.impulse_radius * y))

    @property
    def pallet_let_go(self) -> float:
        """Angle of the pallet as the notch lets a tooth go: ahead of the impulse tooth by the drop."""
        return self.pallet_at(self.waiting - 2.0 * self.rests) + self.values.drop

    @property
    def driven(self) -> float:
        """Turn of the balance from the letting go to the end of the impulse."""
        found = self.half_impulse - self.pallet_let_go
        if found <= 0.0:
            raise Impossible("drop", "is so large that the pallet is past the tooth: nothing would be left of the impulse")
        return found


# What are the outlines of a duplex escapement's wheel and balance?
#
# RESTING teeth and ROLLER touch in one plane, upright IMPULSE teeth and the PALLET in another; the RIM of the balance is drawn
# only. Millimetres.

REFERENCE = 6.0  # mm: radius of the wheel whose lesser lengths others scale
ROOT, RIM, ARM, HUB, BORE = 3.6, 3.1, 0.35, 0.9, 0.3
STRAIGHT, TAPER, HOLLOW = 1.8, 9.0, 0.8  # of a resting tooth: length of its straight back, angle at its point, hollow behind
ARMS, BALANCE_ARMS = 4, 3
UPRIGHT, BACK = 0.62, 24.0  # of an impulse tooth: height of its section, lean of its back from the radius (degrees)
WIDTH, RELIEF, EDGE = 0.45, 25.0, 0.05  # of the pallet
DEPTH, CLEAR = 0.5, 2.0  # of the notch: of the roller's radius; of what the points come in


def wheel(points: DuplexPoints) -> list[Loop]:
    """Resting teeth on the rim, arms, impulse teeth; at angle 0 the point of a resting tooth is on the x axis."""
    s, values = points.values.tip_radius / REFERENCE, points.values
    form = resting_form(points)
    arms = Arms(ARMS, ARM * s, HUB * s, RIM * s, 0.25 * s)
    upright = impulse_tooth(points)
    return [
        contour(form, values.undercut, "RESTING", values.teeth),
        *arms.windows("RESTING"),
        circle("RESTING", (0.0, 0.0), BORE * s, hole=True),
        *(
            upright.moved(math.radians(points.waiting - points.rests + i * points.pitch), (0.0, 0.0))
            for i in range(values.teeth)
        ),
    ]


def resting_form(points: DuplexPoints) -> ToothForm:
    """Of the long teeth: their backs are straight for most of the way."""
    s, values = points.values.tip_radius / REFERENCE, points.values
    return ToothForm(values.tip_radius, ROOT * s, 0.03 * s, STRAIGHT * s, values.undercut + TAPER, HOLLOW * s, 0.3 * s)


def impulse_tooth(points: DuplexPoints) -> Loop:
    """The section of an upright tooth, a wedge with its point on the x axis."""
    s = points.values.tip_radius / REFERENCE
    tip, height = (points.impulse_radius, 0.0), UPRIGHT * s
    front = along(tip, 180.0 - points.values.undercut, height / math.cos(math.radians(points.values.undercut)))
    back = along(polar(points.impulse_radius, 0.5), 180.0 - points.values.undercut - BACK, 1.15 * height)
    heel, foot = polar(points.impulse_radius, 0.5), 0.1 * height
    return rounded("IMPULSE", [(front, foot), (tip, 0.0), (heel, 0.0), (back, foot)])


def balance(points: DuplexPoints) -> list[Loop]:
    """Roller with its notch, pallet, rim; the balance at rest."""
    s, values = points.values.tip_radius / REFERENCE, points.values
    bearing = -90.0 + points.pallet_let_go - values.letting_go
    width = WIDTH * s
    pallet = Stone(polar(points.pallet, bearing), bearing + 180.0, width, points.pallet, width * math.tan(math.radians(RELIEF)))
    return [roller(points), pallet.loop("PALLET", EDGE * s), *wheel_of(points).rim()]


def roller(points: DuplexPoints) -> Loop:
    """A disc with a notch; its leading wall is where the tooth is let go as the balance stands at `letting_go`."""
    values, r = points.values, points.roller
    lead = -90.0 + values.intersection - values.letting_go
    trail = lead - values.notch
    floor = r - max(CLEAR * points.inside, DEPTH * r * math.sin(math.radians(values.notch)))
    # Walls are parallel to the notch's middle line, or the point would jam in a narrowing notch.
    middle, half = (lead + trail) / 2.0, r * math.sin(math.radians(values.notch / 2.0))
    foot, root = turned((floor, half), middle), turned((floor, -half), middle)
    edges: list[Edge] = [
        arc_between(polar(r, lead), polar(r, trail), (0.0, 0.0), True),
        Line(*polar(r, trail), *root),
        Line(*root, *foot),
        Line(*foot, *polar(r, lead)),
    ]
    return Loop(tuple(edges), "ROLLER")


def wheel_of(points: DuplexPoints) -> BalanceWheel:
    """Rim and hairspring of the balance."""
    return balance_wheel(points.values.balance_inertia, points.pallet, 0.45 * points.roller, BALANCE_ARMS)


FREE = 0.2  # degrees of the wheel by which an impulse tooth stands outside the overlap until the notch has let go
LEAST_FLOOR = 2.0  # degrees
LEAST_IMPULSE = 8.0  # degrees of the balance
WITHIN = 1.0  # degrees of the balance by which the pallet is in the overlap as a tooth is let go
SLIDES = 5.0  # degrees by which the point's direction on the roller must exceed the angle of friction
SPARE = 20.0  # degrees of swing


def conflicts(values: Duplex) -> Iterator[Conflict]:
    points = DuplexPoints(values)
    most = points.waiting - 2.0 * points.rests - FREE
    if values.reach > most:
        words = f"must be at most {most:.4g}°: as the notch lets a tooth go, the impulse tooth that will drive is"
        yield Conflict(
            "reach", f"{words} {most + FREE:.4g}° from the line of centres, and the pallet has to be there before it"
        )
        return
    at_letting_go = points.pallet_at(points.waiting - 2.0 * points.rests)
    least = WITHIN - points.half_impulse - at_letting_go
    if values.drop < least:
        yield Conflict("drop", f"must be at least {least:.4g}°, else the tooth passes before the pallet is in its way")
    most = points.half_impulse - LEAST_IMPULSE - at_letting_go
    if values.drop > most:
        yield Conflict("drop", f"must be at most {most:.4g}°: {LEAST_IMPULSE:g}° of impulse are needed")
    holds = math.degrees(math.atan(values.friction)) + SLIDES
    if values.intersection < holds:
        words = f"must be at least {holds:.4g}°, or a tooth wedges itself below the roller at a friction of {values.friction:g}"
        yield Conflict("intersection", words)
    if values.undercut <= values.notch / 2.0:
        yield Conflict(
            "undercut", f"must be more than {values.notch / 2.0:.4g}°, half of the notch, so that points touch its wall"
        )
    chain = tooth_and_gap(resting_form(points), points.values.undercut, points.pitch)
    first, last = chain[0], chain[-1]
    floor = math.degrees(abs(first.sweep) + abs(last.sweep)) if isinstance(first, Arc) and isinstance(last, Arc) else 0.0
    if not LEAST_FLOOR <= floor <= points.pitch:
        words = f"with {values.teeth} teeth leaves no rim between the feet of the resting teeth"
        yield Conflict("undercut", f"{words}: {LEAST_FLOOR:g}° of it are needed; less undercut, or fewer teeth")
    # The notch comes round to the resting tooth a second time.
    round_again = 360.0 - abs(values.letting_go) - 2.0 * values.intersection - values.notch - SPARE
    if values.start > round_again:
        yield Conflict("start", f"must be at most {round_again:.4g}°: farther out the notch comes round to the tooth again")


OFF = 1e-4  # degrees by which the tooth stands off the roller at the start

WORDS = """\
A duplex escapement: a long tooth rests on the roller while the balance swings; as the roller's notch comes by, counter-
clockwise, the tooth goes through with it, and an upright tooth falls on the impulse pallet. On the way back the tooth only
dips into the notch. Drawn to these dimensions:"""


def scene_text(values: Duplex) -> str:
    """The text of scene.toml: a tooth at rest on the roller, the balance about to be let go."""
    points = DuplexPoints(values)
    lift = points.driven + 2.0 * values.intersection
    return toml.scene(
        toml.head(values, WORDS, f"Duplex escapement, {values.frequency:.0f} vph, {values.teeth} teeth"),
        toml.body(
            *("wheel", "escape_wheel", "RESTING IMPULSE", "turns clockwise"),
            position=toml.ORIGIN,
            angle=toml.Noted(f"{round((90.0 + points.rests + OFF) % points.pitch, 9)!r}°", "a tooth just off the roller"),
            inertia=toml.Noted(f"{values.wheel_inertia:.15g} mg·cm²", "with the train as felt here", 6),
        ),
        toml.body(
            *("balance", "balance", "ROLLER PALLET", "hangs at the end of a swing"),
            draw="RIM",
            position=toml.at(0, points.distance),
            angle=f"{-values.start!r}°",
            inertia=f"{values.balance_inertia:.15g} mg·cm²",
        ),
        toml.hairspring(values.frequency, wheel_of(points).hairspring(90.0)),
        toml.torque("wheel", f"{-values.torque!r} µN·m"),
        toml.q_factor("balance", values.q_factor),
        toml.contacts(values, "wheel.RESTING balance.ROLLER", "wheel.IMPULSE balance.PALLET"),
        toml.run("60 s", "1e-12"),
        toml.timegrapher(toml.Noted(f"{lift:.4g}°", "from the notch's taking of a tooth to the end of the impulse", 11)),
    )


def draw(values: Duplex) -> dict[str, Sheet]:
    """Wheel, and balance with roller and pallet."""
    points = DuplexPoints(values)
    return sheets_of(escape_wheel=wheel(points), balance=balance(points))


DESIGN = Design("duplex", "Duplex escapement of a watch with its balance", Duplex, draw, scene_text, conflicts)
