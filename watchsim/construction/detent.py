"""Detent escapement of a marine chronometer with its balance: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, ESTIMATE, Conflict, Design, Impossible, dim, sheets_of
from watchsim.construction.outline import along, angle_of, circle, cosine, polar, polygon, sine, to_circle, turned
from watchsim.construction.parts import Arms, BalanceWheel, Stone, ToothForm, balance_wheel, contour, too_little_draw
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Point

# Which numbers does the designer of a detent escapement choose?
#
# A marine chronometer's size. Angles are those of the detent, where nothing else is said.

LAYOUT = "construction by overlapping circles, docs/guide/mechanisms.md"
USUAL = "usual in marine chronometers"


@dataclass(frozen=True)
class Detent:
    """The dimensions with their defaults; lengths that are not named here scale with the wheel."""

    teeth: int = dim(15, "", 12, 18, "of the escape wheel", USUAL)
    tip_radius: float = dim(6.5, "mm", 2.0, 10.0, "escape wheel, to its tips", CHOSEN)
    reach: float = dim(10.5, "°", 8.0, 11.0, "wheel, half overlap of the circles of tips and impulse stone", LAYOUT)
    stone_ratio: float = dim(0.5, "", 0.4, 0.6, "impulse stone's reach from the balance's centre, by the tip radius", LAYOUT)
    inside: float = dim(
        6.0, "°", 2.0, 12.0, "balance, by which the impulse stone is in the overlap when the tooth is let go", LAYOUT
    )
    lock: float = dim(1.2, "°", 0.6, 2.0, "from its bank until the tooth is let go", LAYOUT)
    travel: float = dim(3.0, "°", 2.0, 4.5, "from its bank until the discharging stone lets it go", LAYOUT)
    clearance: float = dim(
        0.5, "°", 0.2, 1.5, "by which the passing spring's tip stands before the line from pivot to balance", LAYOUT
    )
    draw: float = dim(12.0, "°", 9.0, 18.0, "of the locking face", "as in a lever, Playtner 1910")
    foot: float = dim(1.1, "", 0.8, 1.6, "from the locking to the detent's pivot, by the tip radius", LAYOUT)
    discharge_ratio: float = dim(
        0.24, "", 0.18, 0.3, "discharging stone's reach from the balance's centre, by the tip radius", LAYOUT
    )
    discharge_radius: float = dim(0.22, "mm", 0.1, 0.3, "of the discharging stone, a round pin", CHOSEN)
    undercut: float = dim(25.0, "°", 18.0, 32.0, "of the teeth's fronts from the radius, so that tips lock", USUAL)
    letting_go: float = dim(-22.5, "°", -40.0, 0.0, "balance, from rest, where the tooth is let go", "impulse even about rest")
    wheel_inertia: float = dim(15.0, "mg·cm²", 1.0, 200.0, "escape wheel with the train as felt there", ESTIMATE)
    detent_inertia: float = dim(8.0, "mg·cm²", 0.5, 100.0, "detent without the passing spring", ESTIMATE)
    detent_torque: float = dim(6.0, "µN·m", 0.5, 100.0, "of the detent's spring, on its bank", CHOSEN)
    detent_stiffness: float = dim(40.0, "µN·m/rad", 1.0, 1000.0, "of the detent's spring", CHOSEN)
    passing_inertia: float = dim(0.02, "mg·cm²", 0.001, 1.0, "passing spring, a leaf of gold, as felt at its root", ESTIMATE)
    passing_torque: float = dim(0.8, "µN·m", 0.05, 10.0, "of the passing spring against the detent's horn", CHOSEN)
    passing_stiffness: float = dim(5.0, "µN·m/rad", 0.1, 100.0, "of the passing spring at its root", CHOSEN)
    balance_inertia: float = dim(4000.0, "mg·cm²", 50.0, 20000.0, "balance with roller and hairspring", ESTIMATE)
    frequency: float = dim(14400.0, "vph", 9000.0, 21600.0, "of the balance, in beats per hour", USUAL)
    q_factor: float = dim(400.0, "", 50.0, 2000.0, "quality factor of the balance without the escapement", ESTIMATE)
    torque: float = dim(45.0, "µN·m", 1.0, 500.0, "of the train on the escape wheel", CHOSEN)
    friction: float = dim(0.12, "", 0.0, 0.2, "coefficient of friction, in all contacts", "0.10 to 0.20, steel on ruby")
    restitution: float = dim(0.0, "", 0.0, 0.6, "coefficient of restitution, in all contacts", ESTIMATE)
    start: float = dim(250.0, "°", 60.0, 320.0, "balance, from rest, where it is let go", CHOSEN)


# Which points follow from the dimensions of a detent escapement?
#
# The wheel's centre O is the origin and it turns clockwise; the balance's centre B stands above, and turns counter-clockwise
# while it unlocks and takes its impulse. A tooth is locked one and a half pitches beyond the line OB; the detent's pivot P lies
# on the tangent of the tip circle there, so that locking pushes through P, and draw alone turns the detent to its bank.
# Positive detent angles are counter-clockwise, into the wheel: it unlocks to negative ones. Degrees and millimetres.


class Points:
    """Places in the movement; parts are drawn as they stand there, the detent on its bank."""

    def __init__(self, values: Detent) -> None:
        self.values = values
        self.scale = values.tip_radius / 6.5
        self.pitch = 360.0 / values.teeth
        radius = values.tip_radius
        self.stone_reach = values.stone_ratio * radius
        """From B to the tip of the impulse stone."""
        self.half_impulse = math.degrees(math.asin(radius * sine(values.reach) / self.stone_reach))
        """Turn of the balance on either side of the line of centres in which impulse stone and tips overlap."""
        self.balance_pivot = (0.0, radius * cosine(values.reach) + self.stone_reach * cosine(self.half_impulse))
        self.locked_at = 90.0 - 1.5 * self.pitch
        """Polar angle of the tooth that is locked, just before it is let go."""
        self.locking = polar(radius, self.locked_at)
        self.foot = values.foot * radius
        self.pivot = along(self.locking, self.locked_at - 90.0, self.foot)
        dx, dy = (b - p for b, p in zip(self.balance_pivot, self.pivot, strict=True))
        self.apart = math.hypot(dx, dy)
        self.line = math.degrees(math.atan2(dy, dx))
        """Direction from P to B."""
        self.blade = self.line + values.clearance
        """Direction from P to the tip of the passing spring, along its face."""
        self.discharge = values.discharge_ratio * radius
        """From B to the outermost point of the discharging stone."""
        end = values.travel - values.clearance
        square = self.discharge**2 - (self.apart * sine(end)) ** 2
        if end <= 0.0 or square <= 0.0:
            raise Impossible("travel", "the discharging stone cannot carry the detent so far: take less travel, or more reach")
        self.blade_reach = self.apart * cosine(end) - math.sqrt(square)
        """From P to the tip of the passing spring: it slips off the discharging stone after the travel."""
        self.pin_centre = self.discharge - values.discharge_radius

    def locking_corner(self) -> Point:
        """Of the locking stone, in the detent's frame: on the tip circle when the tooth is let go."""
        return turned((self.locking[0] - self.pivot[0], self.locking[1] - self.pivot[1]), self.values.lock)

    def face_direction(self) -> float:
        """Direction of the locking face away from the wheel, in the detent's frame."""
        return self.locked_at - self.values.draw

    def wheel_angle(self) -> float:
        """Polar angle of the tip that the locking face holds, the detent on its bank."""
        cx, cy = self.locking_corner()
        corner, way = (cx + self.pivot[0], cy + self.pivot[1]), self.face_direction()
        return angle_of(along(corner, way, to_circle(corner, way, self.values.tip_radius)))

    def pin_bearing(self) -> float:
        """Direction from B to the discharging stone's middle as the tooth is let go: it touches the passing spring's tip."""
        tip = along(self.pivot, self.blade - self.values.lock, self.blade_reach)
        away, own, reach = math.dist(tip, self.balance_pivot), self.values.discharge_radius, self.pin_centre
        cos = (away**2 + reach**2 - own**2) / (2.0 * away * reach)
        if not -1.0 < cos < 1.0:
            raise Impossible("clearance", "the discharging stone does not meet the passing spring before the tooth is let go")
        # It comes from the side of the wheel.
        return angle_of(tip, self.balance_pivot) - math.degrees(math.acos(cos))

    def stone_bearing(self) -> float:
        """Direction from B to the impulse stone's tip as the tooth is let go."""
        return -90.0 - self.half_impulse + self.values.inside


# What are the outlines of a detent escapement's parts? Millimetres, each in its own frame.

ARMS, BALANCE_ARMS = 4, 2
ARM_WIDTH, RIM, HUB, BORE, WINDOW_FILLET = 0.34, 4.2, 1.1, 0.35, 0.25
TABLE, STAFF = 0.86, 0.45  # of the impulse stone's reach; mm
STONE_WIDTH, STONE_LENGTH, EDGE = 0.42, 1.1, 0.05  # of the impulse stone
RELIEF = 25.0  # degrees: the end of the impulse stone behind its tip, from the circle it runs on
LOCKING_WIDTH = 0.5
BLADE = 0.06  # thickness of the passing spring
BLADE_LENGTH = 3.2
BAR, BAR_GAP = 0.4, 0.1  # breadth of the detent's bar; between it and the passing spring
HORN_RADIUS, HORN_SHORT = 0.12, 0.5  # of its end, on which the passing spring rests; by how much that is shorter
DETENT_HUB, DETENT_BORE = 0.75, 0.25
BANK_AT, BANK_RADIUS = 3.4, 0.35  # of the banking screw, from the pivot


def wheel(points: Points) -> list[Loop]:
    """Teeth with undercut fronts, windows, bore; tooth 0 has its tip on the x axis."""
    s, values = points.scale, points.values
    form = ToothForm(values.tip_radius, 5.0 * s, 0.05 * s, 0.75 * s, 40.0, 1.3 * s, 0.2 * s)
    arms = Arms(ARMS, ARM_WIDTH * s, HUB * s, RIM * s, WINDOW_FILLET * s)
    windows = arms.windows("TEETH")
    return [contour(form, values.undercut, "TEETH", values.teeth), *windows, circle("TEETH", (0.0, 0.0), BORE * s, hole=True)]


def roller(points: Points) -> list[Loop]:
    """Table and impulse stone, discharging roller and stone; at angle 0 as it stands at rest."""
    s, values = points.scale, points.values
    turn = -values.letting_go
    width = STONE_WIDTH * s
    bearing = points.stone_bearing() + turn
    stone = Stone(
        polar(points.stone_reach, bearing), bearing + 180.0, width, STONE_LENGTH * s, width * math.tan(math.radians(RELIEF))
    )
    pin = polar(points.pin_centre, points.pin_bearing() + turn)
    return [
        circle("TABLE", (0.0, 0.0), TABLE * points.stone_reach),
        circle("TABLE", (0.0, 0.0), STAFF * s, hole=True),
        stone.loop("IMPULSE_STONE", EDGE * s),
        circle("ROLLER", (0.0, 0.0), points.pin_centre - 0.2 * values.discharge_radius),  # the stone stands out of it
        circle("ROLLER", (0.0, 0.0), STAFF * s, hole=True),
        circle("DISCHARGE", pin, values.discharge_radius),
        *wheel_of(points).rim(),
    ]


def wheel_of(points: Points) -> BalanceWheel:
    """Rim and hairspring of the balance."""
    return balance_wheel(points.values.balance_inertia, points.stone_reach, STAFF * points.scale, BALANCE_ARMS)


def _beside(points: Points, x: float, y: float) -> Point:
    """The place in the detent's frame that is x along the passing spring's face from P and y to its left."""
    c, s = math.cos(math.radians(points.blade)), math.sin(math.radians(points.blade))
    return (c * x - s * y, s * x + c * y)


def bar_side(points: Points) -> float:
    """Where the bar's side towards the wheel lies, to the left of the passing spring's face."""
    return -(BLADE + BAR_GAP) * points.scale


def detent(points: Points) -> list[Loop]:
    """The locking stone, the bar with its hub, and the horn at its end, on which the passing spring rests."""
    s = points.scale
    end = points.blade_reach - HORN_SHORT * s
    left, right = bar_side(points), bar_side(points) - BAR * s
    bar = [_beside(points, *corner) for corner in ((0.0, right), (end, right), (end, left), (0.0, left))]
    horn = _beside(points, end - HORN_RADIUS * s, -BLADE * s - HORN_RADIUS * s)
    corner, face = points.locking_corner(), points.face_direction()
    # Out to the middle of the bar.
    out = (math.hypot(*corner) * math.sin(math.radians(math.degrees(math.atan2(corner[1], corner[0])) - points.blade))) - left
    stone = Stone(corner, face, LOCKING_WIDTH * s, out + 0.6 * BAR * s, LOCKING_WIDTH * s * math.tan(math.radians(8.0)))
    return [
        stone.loop("STONE", EDGE * s),
        polygon("BAR", bar),
        circle("HORN", horn, HORN_RADIUS * s),
        circle("HUB", (0.0, 0.0), DETENT_HUB * s),
        circle("HUB", (0.0, 0.0), DETENT_BORE * s, hole=True),
    ]


def root(points: Points) -> Point:
    """Where the passing spring is fixed on the detent, in its frame."""
    return _beside(points, points.blade_reach - BLADE_LENGTH * points.scale, -0.5 * BLADE * points.scale)


def passing(points: Points) -> list[Loop]:
    """The leaf, drawn from its root as it lies on the detent's horn."""
    s = points.scale
    rx, ry = root(points)
    first, last = points.blade_reach - BLADE_LENGTH * s, points.blade_reach
    corners = [(first, -BLADE * s), (last, -BLADE * s), (last, 0.0), (first, 0.0)]
    return [polygon("LEAF", [(x - rx, y - ry) for x, y in (_beside(points, *corner) for corner in corners)])]


def banking(points: Points) -> list[Loop]:
    """The screw against which the bar rests."""
    s = points.scale
    x, y = _beside(points, BANK_AT * s, bar_side(points) + BANK_RADIUS * s)
    return [circle("SCREW", (x + points.pivot[0], y + points.pivot[1]), BANK_RADIUS * s)]


CLEAR = 1e-4  # degrees by which tooth and passing spring stand off what they rest on at the start

WORDS = """\
A detent escapement, as in a marine chronometer: the wheel is locked by a detent that a spring holds on its bank. As the
balance swings counter-clockwise its discharging stone lifts the passing spring, and with it the detent; a tooth falls on the
impulse stone. On the way back it bends the passing spring alone, and nothing else happens. Drawn to these dimensions:"""


def scene_text(values: Detent) -> str:
    """The text of scene.toml: a tooth locked, the detent on its bank, the balance about to be let go."""
    points = Points(values)
    detent_rest = math.degrees(values.detent_torque / values.detent_stiffness)
    passing_rest = -math.degrees(values.passing_torque / values.passing_stiffness)
    lift = 2.0 * points.half_impulse - values.inside
    return toml.scene(
        toml.head(values, WORDS, f"Detent escapement, {values.frequency / 7200.0:g} Hz, {values.teeth} teeth"),
        toml.body(
            *("wheel", "escape_wheel", "TEETH", "turns clockwise; the inertia includes the train as felt here"),
            position=toml.ORIGIN,
            angle=toml.Noted(
                f"{round(points.wheel_angle() % points.pitch + CLEAR, 9)!r}°", "a tooth just off the locking face"
            ),
            inertia=f"{values.wheel_inertia:.15g} mg·cm²",
        ),
        toml.body(
            *("detent", "detent", "STONE BAR HORN HUB"),
            position=toml.at(*points.pivot),
            angle=toml.Noted(f"{-CLEAR!r}°", "just off its bank", 11),
            inertia=f"{values.detent_inertia:.15g} mg·cm²",
        ),
        toml.body(
            *("passing", "passing_spring", "LEAF"),
            "the passing spring: a light leaf, pressed on the detent's horn by its own spring",
            rides="detent",
            position=toml.at(*root(points)),
            angle=f"{CLEAR!r}°",
            mass=f"{3.0 * values.passing_inertia * 1e2 / (BLADE_LENGTH * points.scale) ** 2:.6g} mg",
            inertia=f"{values.passing_inertia:.15g} mg·cm²",
        ),
        toml.body(
            *("balance", "roller", "TABLE IMPULSE_STONE ROLLER DISCHARGE", "hangs at the end of a swing"),
            draw="RIM",
            position=toml.at(*points.balance_pivot),
            angle=f"{-values.start!r}°",
            inertia=f"{values.balance_inertia:.15g} mg·cm²",
        ),
        toml.banking("SCREW"),
        toml.hairspring(values.frequency, wheel_of(points).hairspring(90.0)),
        toml.table(
            *("[[springs]]", "bent: holds the detent on its bank"),
            body="detent",
            stiffness=f"{values.detent_stiffness:.15g} µN·m/rad",
            rest=f"{detent_rest:.9g}°",
        ),
        toml.table(
            *("[[springs]]", "bent: holds the leaf on the horn"),
            body="passing",
            stiffness=f"{values.passing_stiffness:.15g} µN·m/rad",
            rest=f"{passing_rest:.9g}°",
        ),
        toml.torque("wheel", f"{-values.torque!r} µN·m"),
        toml.q_factor("balance", values.q_factor),
        toml.contacts(
            values,
            "wheel.TEETH detent.STONE: locking",
            "wheel.TEETH balance.IMPULSE_STONE: impulse",
            "passing.LEAF balance.DISCHARGE: unlocking, and passing on the way back",
            "passing.LEAF detent.HORN",
            "detent.BAR banking.SCREW",
        ),
        toml.run("10 s"),
        toml.timegrapher(toml.Noted(f"{lift:.4g}°", "from the letting go of the tooth to the end of the impulse", 11)),
    )


def sheets(values: Detent) -> dict[str, Sheet]:
    """File name without ending -> the part. ValueError where a fillet does not fit."""
    points = Points(values)
    movement = {"escape_wheel": wheel(points), "roller": roller(points), "banking": banking(points)}
    return sheets_of(**movement, detent=detent(points), passing_spring=passing(points))


THIN = 1.3  # of the staff's radius: the least that holds the discharging stone
FREE = 0.5  # degrees of the wheel by which a waiting tooth must stand outside the overlap


def conflicts(values: Detent) -> Iterator[Conflict]:
    points = Points(values)
    yield from too_little_draw(values)
    if values.undercut < values.draw + values.lock:
        words = f"must be at least {values.draw + values.lock:.4g}°, draw and lock, so that tips lock and not fronts"
        yield Conflict("undercut", words)
    if 0.5 * points.pitch < values.reach + FREE:
        words = f"must be at most {0.5 * points.pitch - FREE:.4g}°: waiting teeth stand {0.5 * points.pitch:.4g}° from the line"
        yield Conflict("reach", f"{words} of centres, and the impulse stone has to pass between them")
    if values.travel < values.lock + values.clearance:
        yield Conflict("travel", f"must be more than lock and clearance, {values.lock + values.clearance:.4g}°")
    most = (points.discharge - THIN * STAFF * points.scale) / 1.2
    if values.discharge_radius > most:
        yield Conflict(
            "discharge_radius", f"must be at most {most:.4g} mm, or the roller that holds the stone is as thin as its staff"
        )
        return
    sheets(values)


DESIGN = Design("detent", "Detent escapement of a marine chronometer with its balance", Detent, sheets, scene_text, conflicts)
