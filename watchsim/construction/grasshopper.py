"""Grasshopper escapement with its pendulum: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, Conflict, Design, dim, sheets_of
from watchsim.construction.outline import angle_of, circle, polar, polygon, turned
from watchsim.construction.parts import Arms
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Point


@dataclass(frozen=True)
class Grasshopper:
    teeth: int = dim(60, "", 24, 180, "of the wheel", "Harrison: 120 at larger arcs")
    tip_radius: float = dim(30.0, "mm", 3.0, 300.0, "of the wheel, to the points of its teeth", CHOSEN)
    height: float = dim(2.0, "mm", 0.1, 20.0, "of the teeth", CHOSEN)
    span: int = dim(14, "", 2, 80, "whole pitches between the pallets; half a pitch more at rest", "Harrison: near 90°")
    release: float = dim(3.0, "°", 0.5, 10.0, "pendulum, from rest, where one pallet takes over from the other", CHOSEN)
    overswing: float = dim(0.7, "°", 0.05, 4.0, "pendulum, beyond that, for which the stops are set", CHOSEN)
    nib: float = dim(0.6, "mm", 0.02, 6.0, "of a pallet, reaching inside the circle of the points", CHOSEN)
    pallet_torque: float = dim(2.0, "µN·m", 0.01, 1000.0, "of a pallet's counterweight, which lifts it to its stop", CHOSEN)
    pallet_mass: float = dim(0.1, "g", 1e-4, 100.0, "of a pallet, poised on its pivot", CHOSEN)
    pallet_inertia: float = dim(40.0, "g·mm²", 1e-3, 1e6, "of a pallet", CHOSEN)
    pendulum: float = dim(250.0, "mm", 20.0, 5000.0, "from the pivot to the middle of the bob", "beats half seconds")
    bob_radius: float = dim(30.0, "mm", 2.0, 500.0, "of the bob, a disc", CHOSEN)
    bob_mass: float = dim(0.5, "kg", 1e-3, 100.0, "of the bob", CHOSEN)
    q_factor: float = dim(200.0, "", 5.0, 1e6, "quality factor of the pendulum without the escapement", "estimate: low")
    torque: float = dim(0.8, "mN·m", 1e-3, 1e4, "on the wheel", CHOSEN)
    wheel_inertia: float = dim(30.0, "g·mm²", 1e-3, 1e7, "wheel with the train as felt here", "light: a pallet drives it back")
    gravity: float = dim(9.81, "m/s²", 0.1, 100.0, "acceleration of gravity", "9.81 m/s²")
    friction: float = dim(
        0.2, "", 0.1, 0.5, "coefficient of friction, in all contacts; it holds the nibs", "wood on brass, dry"
    )
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution, in all contacts", CHOSEN)


# Which lengths and angles follow from the dimensions of a grasshopper escapement?
#
# Both pallets hang on one pivot P of the frame, at the distance h to the left of the pendulum's axis and, at rest, where the
# tangents at half the span meet above the wheel. A pallet of length l that holds a tooth at the circle of the points is a link
# with two pins: with P at the distance d from the wheel's axis, the two teeth that pallets could hold are apart by
#
#     2 arccos((R² + d² - l²) / (2 R d))
#
# One pallet takes over from the other at +release and at -release, where this must be a whole number of pitches, one more at
# the first than at the second: two equations for h and l. Wheel's axis at the origin, clockwise; millimetres, degrees.

ENTRY, EXIT = 1, -1
NEAREST, FURTHEST = 0.01, 5.0  # of the frame's pivot from the pendulum's axis, by the wheel's radius


@dataclass(frozen=True)
class Points:
    """The dimensions with the arm h of the frame and the length l of the pallets."""

    values: Grasshopper
    arm: float
    length: float

    @property
    def axis(self) -> Point:
        return (self.arm, _height(self.values))

    @property
    def pitch(self) -> float:
        return 360.0 / self.values.teeth

    @property
    def furthest(self) -> float:
        return self.values.release + self.values.overswing

    def pivot(self, swing: float) -> Point:
        return _pivot(self.values, self.arm, swing)

    def tooth(self, swing: float, side: int) -> float:
        """Direction of the point of the tooth that a pallet holds, with the pendulum at `swing`."""
        far, r = math.hypot(*self.pivot(swing)), self.values.tip_radius
        half = math.acos((r**2 + far**2 - self.length**2) / (2.0 * r * far))
        return angle_of(self.pivot(swing)) + side * math.degrees(half)

    def lean(self, swing: float, side: int) -> float:
        """Direction of that pallet from its pivot, in the frame."""
        tip = polar(self.values.tip_radius, self.tooth(swing, side))
        return angle_of(tip, self.pivot(swing)) - swing

    def stopped(self, side: int) -> float:
        """The same on the pallet's stop: where it would hold a tooth at the end of the overswing on its side."""
        return self.lean(side * self.furthest, side)


def points(values: Grasshopper) -> Points:
    """ValueError where no frame makes the pallets take over from each other."""
    low, high = NEAREST * values.tip_radius, FURTHEST * values.tip_radius
    below = _mismatch(values, low)
    if below * _mismatch(values, high) > 0.0:
        raise ValueError("no arm of the frame moves the wheel by half a pitch")
    while high - low > 1e-13 * high:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if below * _mismatch(values, middle) > 0.0 else (low, middle)
    far, half = math.hypot(*_pivot(values, low, values.release)), _half(values, values.span + 1)
    return Points(values, low, math.sqrt(values.tip_radius**2 + far**2 - 2.0 * values.tip_radius * far * math.cos(half)))


def _mismatch(values: Grasshopper, arm: float) -> float:
    """Of the two squares of a pallet's length, from either end of the swing."""
    ends = (values.release, values.span + 1), (-values.release, values.span)
    squares = []
    for swing, pitches in ends:
        far = math.hypot(*_pivot(values, arm, swing))
        squares.append(far**2 - 2.0 * values.tip_radius * far * math.cos(_half(values, pitches)))
    return squares[0] - squares[1]


def _half(values: Grasshopper, pitches: float) -> float:
    return math.pi * pitches / values.teeth


def _height(values: Grasshopper) -> float:
    """Of both axes above the wheel's, at rest."""
    return values.tip_radius / math.cos(_half(values, values.span + 0.5))


def _pivot(values: Grasshopper, arm: float, swing: float) -> Point:
    x, y = turned((-arm, 0.0), swing)
    return (arm + x, _height(values) + y)


# What are the outlines of the wheel, the pallets and the pendulum of a grasshopper escapement?
#
# The nibs' faces are at right angles to their pallets: what a tooth presses there runs through the pivot, and friction keeps
# its point from sliding. Lengths on a pallet are shares of a pitch, so that it clears the teeth before and behind.

LAND, BACK, FRONT = 0.05, 0.53, 0.2  # of a pitch: the flat of a point, its back, and by how much the front is undercut
NIB, FOOT = 0.22, 0.57  # length of a nib inside the circle of the points, and to where it joins its arm
NEAR, FAR = 0.19, 0.45  # of the arm from the line through the nib, its near and far edge
PIN = 0.16  # radius of a stop; all by the pitch on the circle of the points
HELD = 0.55  # of a pallet's length: where its stop stands
ARMS, RIM, HUB = 5, 0.86, 0.16  # of the wheel: number of arms; radii divided by that of the points


def wheel(at: Points) -> list[Loop]:
    """Pointed teeth, undercut in front, the first point on the x axis; arms."""
    r, low, corners = at.values.tip_radius, at.values.tip_radius - at.values.height, []
    for i in range(at.values.teeth):
        first = i * at.pitch
        corners += [polar(r, first), polar(r, first + LAND * at.pitch), polar(low, first + BACK * at.pitch)]
        corners += [polar(low, first + (1.0 + FRONT) * at.pitch)]
    arms = Arms(ARMS, 0.07 * r, HUB * r, RIM * low, 0.03 * r)
    windows = arms.windows("TEETH")
    return [polygon("TEETH", corners), *windows, circle("TEETH", (0.0, 0.0), 0.05 * r, hole=True)]


def pallet(at: Points, side: int) -> list[Loop]:
    """From its pivot at the origin along +x to its nib: the entry pallet is pushed there, the exit pallet pulled."""
    unit, end, deep = _unit(at), at.length, at.values.nib
    if side == ENTRY:
        nib = [(end, deep), (end - NIB * unit, deep), (end - FOOT * unit, -NEAR * unit)]
        corners = [*nib, (0.0, -NEAR * unit), (0.0, -FAR * unit), (end, -FAR * unit)]
    else:
        out = end + FOOT * unit
        nib = [(end, -deep), (end + NIB * unit, -deep), (out, NEAR * unit), (out, FAR * unit)]
        corners = [*nib, (0.0, FAR * unit), (0.0, NEAR * unit), (end, NEAR * unit)]
    hub = circle("HUB", (0.0, 0.0), 2.0 * PIN * unit)
    return [polygon("PALLET", corners if side == EXIT else corners[::-1]), hub]


def pendulum(at: Points) -> list[Loop]:
    """About its axis, at rest: the stops that count, the frame that carries them and the pallets, rod and bob."""
    unit, r, values = _unit(at), PIN * _unit(at), at.values
    stops = [_stop(at, side) for side in (ENTRY, EXIT)]
    pivot = (-at.arm, 0.0)
    arms = [_bar(pivot, stop, 0.6 * r, layer) for stop, layer in zip(stops, ("ENTRY_ARM", "EXIT_ARM"), strict=True)]
    bob = (0.0, -values.pendulum)
    drawn = [_bar((0.0, 0.0), pivot, 0.3 * unit, "FRAME"), *arms, _bar((0.0, 0.0), bob, 0.2 * unit, "ROD")]
    return [
        *(circle("STOPS", stop, r) for stop in stops),
        *drawn,
        circle("BOB", bob, values.bob_radius),
        circle("HUB", (0.0, 0.0), 0.6 * unit),
    ]


def _stop(at: Points, side: int) -> tuple[float, float]:
    """On the far side of the pallet that lies on it."""
    beside = turned((HELD * at.length, -side * (FAR + PIN) * _unit(at)), at.stopped(side))
    return (beside[0] - at.arm, beside[1])


def _unit(at: Points) -> float:
    return math.radians(at.pitch) * at.values.tip_radius


def _bar(start: tuple[float, float], end: tuple[float, float], half: float, layer: str) -> Loop:
    """A straight bar from one point to the other."""
    long = math.dist(start, end)
    nx, ny = half * (start[1] - end[1]) / long, half * (end[0] - start[0]) / long
    (x0, y0), (x1, y1) = start, end
    return polygon(layer, [(x0 - nx, y0 - ny), (x1 - nx, y1 - ny), (x1 + nx, y1 + ny), (x0 + nx, y0 + ny)])


OFF_PALLET, OFF_STOPS = 1e-3, 1e-4  # degrees, at the start: the tooth off its pallet, the pallets off their stops


def scene_text(made: Points) -> str:
    """The text of scene.toml: a tooth on the entry pallet, the exit pallet on its stop."""
    values = made.values
    about = values.bob_mass * (values.pendulum**2 + 0.5 * values.bob_radius**2)
    follows = (
        f"From them: frame {made.arm:.6g} mm from the pendulum's axis to the pallets' pivot, pallets {made.length:.6g} mm long."
    )
    words = "A grasshopper escapement with one pivot for both pallets, drawn to these dimensions:"
    wheel_angle = math.fmod(made.tooth(made.furthest, ENTRY), made.pitch) + OFF_PALLET

    def hanging(name: str, remark: str, angle: float) -> str:
        return toml.body(
            *(name, name, "PALLET", remark),
            rides="pendulum",
            pivot=toml.ORIGIN,
            position=toml.at(-made.arm, 0),
            angle=f"{angle!r}°",
            mass=f"{values.pallet_mass:.15g} g",
            inertia=f"{values.pallet_inertia:.15g} g·mm²",
        )

    return toml.scene(
        toml.head(values, words, f"Grasshopper escapement, {values.teeth} teeth", follows, values.gravity),
        toml.body(
            *("wheel", "wheel", "TEETH", "turns clockwise"),
            pivot=toml.ORIGIN,
            position=toml.ORIGIN,
            angle=toml.Noted(f"{wheel_angle!r}°", "a tooth just off the entry pallet", 14),
            inertia=f"{values.wheel_inertia:.15g} g·mm²",
        ),
        toml.body(
            *("pendulum", "pendulum", "STOPS", "with the frame; let go with the entry pallet about to drive it"),
            pivot=toml.ORIGIN,
            position=toml.at(*made.axis),
            angle=f"{made.furthest!r}°",
            mass=f"{values.bob_mass:.15g} kg",
            centre_of_mass=toml.at(0, -values.pendulum),
            inertia=toml.Noted(f"{about:.15g} kg·mm²", "of the bob, about the pivot", 3),
        ),
        hanging("entry", "hangs in the frame; pushed by its tooth", made.stopped(ENTRY) + OFF_STOPS),
        hanging("exit", "on the same pivot; pulled by its tooth", made.stopped(EXIT) - OFF_STOPS),
        toml.torque("entry", f"{-values.pallet_torque:.15g} µN·m", "counterweights, which lift the pallets to their stops"),
        toml.torque("exit", f"{values.pallet_torque:.15g} µN·m"),
        toml.torque("wheel", f"{-values.torque:.15g} mN·m"),
        toml.q_factor("pendulum", values.q_factor),
        toml.contacts(
            *(values, "wheel.TEETH entry.PALLET", "wheel.TEETH exit.PALLET"),
            *("entry.PALLET pendulum.STOPS", "exit.PALLET pendulum.STOPS"),
        ),
        toml.run("60 s", "1e-12"),
    )


NARROWEST, WIDEST = 50.0, 130.0  # degrees between the pallets, seen from the wheel
HIGHEST = 0.8  # of a pitch: height of a tooth
LEAST = 1.3  # of the lift of a pallet that has been let go, by its nib
CATCHES = 1.05  # of the nib, by what it is short of the circle of the points where it takes over
HOLDS = 0.3  # of the friction of a nib, which the counterweight may take
QUICK = 0.06  # of a period, in which a pallet let go is lifted by its nib
DEEPEST, CLEAR = 0.6, 0.8  # of a tooth's height, by the nib; of an arm's distance from its nib's line, by the teeth
WEAKEST, STRONGEST = 1.06, 1.12  # amplitude that the drive sustains, by release and by release with overswing


def draw(values: Grasshopper) -> dict[str, Sheet]:
    """Wheel, pendulum with frame, the two pallets."""
    at = points(values)
    return sheets_of(wheel=wheel(at), pendulum=pendulum(at), entry=pallet(at, ENTRY), exit=pallet(at, EXIT))


def scene(values: Grasshopper) -> str:
    """Its scene."""
    return scene_text(points(values))


def amplitude(values: Grasshopper) -> float:
    """Degrees, at which damping takes what the wheel gives in an oscillation: T pitch = π k A² / Q."""
    stiffness = values.bob_mass * values.gravity * values.pendulum  # mN·m per rad
    return math.degrees(math.sqrt(values.torque * math.tau / values.teeth * values.q_factor / (math.pi * stiffness)))


def cuts_in(at: Points, side: int) -> float:
    """mm by which the line of a pallet's nib comes inside the circle of the points, at most, while it holds a tooth."""
    ends = (swing for swing in (-at.furthest, at.furthest))
    tilts = (at.lean(swing, side) + swing - at.tooth(swing, side) - side * 90.0 for swing in ends)
    return at.values.tip_radius * (1.0 - min(math.cos(math.radians(tilt)) for tilt in tilts))


def conflicts(values: Grasshopper) -> Iterator[Conflict]:
    pitch = 360.0 / values.teeth
    between, unit = (values.span + 0.5) * pitch, math.radians(pitch) * values.tip_radius
    if not NARROWEST <= between <= WIDEST:
        yield Conflict("span", f"puts the pallets {between:.4g}° apart; {NARROWEST:g}° to {WIDEST:g}° work")
        return
    if values.height > HIGHEST * unit:
        yield Conflict("height", f"must be at most {HIGHEST * unit:.4g} mm at this pitch")
    try:
        at = points(values)
    except ValueError as error:
        yield Conflict("release", str(error))
        return
    yield from _pallets(at)
    sustained, least, most = amplitude(values), WEAKEST * values.release, STRONGEST * at.furthest
    if not least < sustained < most:
        torques = [values.torque * (end / sustained) ** 2 for end in (least, most)]
        yield Conflict("torque", f"would sustain {sustained:.3g}°; between {torques[0]:.4g} and {torques[1]:.4g} mN·m it works")


def _pallets(at: Points) -> Iterator[Conflict]:
    """What keeps a nib from holding its tooth, or from clearing it."""
    if at.values.nib > DEEPEST * at.values.height:
        yield Conflict("nib", f"must be at most {DEEPEST * at.values.height:.4g} mm, else it meets the floor between the teeth")
        return
    for side in (ENTRY, EXIT):
        if cuts_in(at, side) > CLEAR * (NEAR * _unit(at)):
            yield Conflict("span", "lets the arm of a pallet cut into the teeth as it swings: nearer to 90°, or less release")
            return
        lifted = at.length * math.radians(side * (at.lean(-side * at.values.release, side) - at.stopped(side)))
        if lifted <= 0.0:
            yield Conflict("span", "its pallets, let go, would swing into the teeth: nearer to 90°, or less release")
            return
        if lifted < LEAST * at.values.nib:
            yield Conflict("nib", f"must be below {lifted / LEAST:.4g} mm, else a pallet let go stays among the teeth")
            return
        short = at.length * math.radians(side * (at.lean(side * at.values.release, side) - at.stopped(side)))
        if at.values.nib < CATCHES * short:
            yield Conflict("nib", f"must be above {CATCHES * short:.4g} mm, else it passes over its tooth: or less overswing")
            return
    # Too weak to lift a pallet before the pendulum comes back, or so strong that friction does not hold it on its tooth.
    values = at.values
    period = math.tau * math.sqrt(1e-3 * values.pendulum / values.gravity)
    needed = 2e-3 * values.nib / at.length * values.pallet_inertia / (QUICK * period) ** 2
    if values.pallet_torque < needed:
        yield Conflict("pallet_torque", f"must be above {needed:.3g} µN·m, else the pallets are slow to clear the teeth")
    most = 1e3 * HOLDS * values.friction * values.torque * at.length / values.tip_radius
    if values.pallet_torque > most:
        yield Conflict("pallet_torque", f"must be below {most:.3g} µN·m, else it pulls the pallets off their teeth")


DESIGN = Design("grasshopper", "Grasshopper escapement with its pendulum", Grasshopper, draw, scene, conflicts)
