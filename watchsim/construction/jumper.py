"""Calendar star with jumper and finger: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, Conflict, Design, dim, sheets_of
from watchsim.construction.outline import circle, polar, polygon, rounded
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Point


@dataclass(frozen=True)
class Jumper:
    teeth: int = dim(7, "", 5, 16, "teeth of the star", "7: days of the week")
    tip_radius: float = dim(4.0, "mm", 0.5, 20.0, "of the star, to the points of its teeth", CHOSEN)
    depth: float = dim(1.2, "mm", 0.05, 8.0, "of the teeth, from point to root", CHOSEN)
    tip_rounding: float = dim(0.08, "mm", 0.005, 1.0, "radius of the points of the teeth", CHOSEN)
    beak_radius: float = dim(0.4, "mm", 0.02, 4.0, "of the round beak of the jumper", CHOSEN)
    jumper_length: float = dim(6.0, "mm", 0.5, 40.0, "jumper, from its pivot to the middle of the beak", CHOSEN)
    preload: float = dim(20.0, "mN", 0.1, 2000.0, "with which the beak is pressed into the star at rest", CHOSEN)
    rate: float = dim(8.0, "mN/mm", 0.01, 2000.0, "by which that force grows as the beak is lifted", CHOSEN)
    crank: float = dim(2.5, "mm", 0.2, 20.0, "finger, from its axis to the middle of its pin", CHOSEN)
    pin_radius: float = dim(0.3, "mm", 0.02, 3.0, "of the pin", CHOSEN)
    push: float = dim(0.75, "", 0.55, 0.95, "share of a pitch over which the pin carries a tooth", CHOSEN)
    speed: float = dim(360.0, "°/s", 0.1, 3600.0, "of the finger; a calendar's turns once a day", "fast, to be simulated")
    star_inertia: float = dim(30.0, "mg·cm²", 1e-3, 1e6, "star with its disc", CHOSEN)
    jumper_inertia: float = dim(5.0, "mg·cm²", 1e-3, 1e6, "jumper", CHOSEN)
    drag: float = dim(2.0, "µN·m", 0.0, 1e4, "dry friction of the star in its bearing", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.3, "coefficient of friction, in all contacts", "steel on oiled steel")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution, in all contacts", CHOSEN)


# Which lengths and angles follow from the dimensions of a star and its jumper?
#
# The star's axis is the origin; at rest the beak lies in the root at 0°. The pin passes the star's tip circle where a tooth's
# point is `half_push` before and behind the line of centres of finger and star. Millimetres, angles in degrees.

ENTRY = 0.08  # of the pitch: by which the pin is clear of a tooth's point as it comes in


def pitch(values: Jumper) -> float:
    return 360.0 / values.teeth


def root_radius(values: Jumper) -> float:
    return values.tip_radius - values.depth


def flank_angle(values: Jumper) -> float:
    """Between a flank and the radius at the root."""
    half = math.radians(pitch(values) / 2.0)
    rise, side = values.tip_radius * math.cos(half) - root_radius(values), values.tip_radius * math.sin(half)
    return math.degrees(math.atan2(side, rise))


def beak_at_rest(values: Jumper) -> float:
    """From the star's axis to the middle of the beak that touches both flanks of a root."""
    return root_radius(values) + values.beak_radius / math.sin(math.radians(flank_angle(values)))


def half_push(values: Jumper) -> float:
    return values.push * pitch(values) / 2.0


def finger_distance(values: Jumper) -> float:
    """Of the axes of finger and star. ValueError where the crank is too short to reach both places."""
    angle = math.radians(half_push(values))
    reach = values.crank**2 - (values.tip_radius * math.sin(angle)) ** 2
    return values.tip_radius * math.cos(angle) + math.sqrt(reach)


def finger_direction(values: Jumper) -> float:
    """Of the finger's axis, seen from the star's: the tooth across from the jumper waits just before the pin's way."""
    tooth = (values.teeth // 2 + 0.5) * pitch(values)
    wait = math.degrees(values.pin_radius / values.tip_radius) + ENTRY * pitch(values)
    return tooth + half_push(values) - wait


LEAST_ROOT = 0.2  # of the tip radius
NARROWEST = 15.0  # degrees between a flank and the radius: the beak would jam


def conflicts(values: Jumper) -> Iterator[Conflict]:
    deepest = (1.0 - LEAST_ROOT) * values.tip_radius
    if values.depth > deepest:
        yield Conflict("depth", f"leaves a root radius of {root_radius(values):.3g} mm; at most {deepest:.3g} mm fit")
        return
    if flank_angle(values) <= NARROWEST:
        yield Conflict("depth", "the roots are so narrow that the beak would jam in them: fewer teeth or less depth")
        return
    if beak_at_rest(values) > values.tip_radius:
        yield Conflict("beak_radius", "the beak is too large to lie between two teeth")
    shortest = 1.02 * values.tip_radius * math.sin(math.radians(half_push(values)))
    if values.crank <= shortest:
        yield Conflict("crank", f"must be above {shortest:.3g} mm, else the pin does not carry a tooth that far (push)")
        return
    between = math.radians(pitch(values)) * values.tip_radius
    if 2.0 * values.pin_radius * (1.0 + ENTRY) > 0.5 * between:
        yield Conflict("pin_radius", f"the pin does not fit between the points of two teeth, {between:.3g} mm apart")
    if finger_distance(values) - values.crank - values.pin_radius <= root_radius(values):
        yield Conflict("crank", "the pin would run into the roots of the star: a longer crank comes less deep")


HUB, BORE = 0.45, 0.15  # of the star's root radius
BAR = 0.5  # half the width of jumper and finger, in radii of beak and pin
FOOT = 1.6  # radius of the jumper's foot in radii of the beak


def star(values: Jumper) -> list[Loop]:
    """Teeth with straight flanks and rounded points, a root on the x axis; a bore and a scribed hub, which touch nothing."""
    corners: list[tuple[Point, float]] = []
    for i in range(values.teeth):
        corners.append((polar(root_radius(values), i * pitch(values)), 0.0))
        corners.append((polar(values.tip_radius, (i + 0.5) * pitch(values)), values.tip_rounding))
    bore = circle("STAR", (0.0, 0.0), BORE * root_radius(values), hole=True)
    return [rounded("STAR", corners), bore, circle("HUB", (0.0, 0.0), HUB * root_radius(values))]


def jumper(values: Jumper) -> list[Loop]:
    """The beak hangs below the pivot; arm and foot touch nothing."""
    half = BAR * values.beak_radius
    low = -values.jumper_length
    arm = polygon("ARM", [(-half, 0.0), (-half, low), (half, low), (half, 0.0)])
    beak = circle("BEAK", (0.0, low), values.beak_radius)
    return [beak, arm, circle("FOOT", (0.0, 0.0), FOOT * values.beak_radius)]


def finger(values: Jumper) -> list[Loop]:
    """A pin on an arm that touches nothing; the pin on the x axis."""
    half = BAR * values.pin_radius
    arm = polygon("ARM", [(0.0, -half), (values.crank, -half), (values.crank, half), (0.0, half)])
    pin = circle("PIN", (values.crank, 0.0), values.pin_radius)
    return [pin, arm, circle("HUB", (0.0, 0.0), 2.0 * values.pin_radius)]


TURNS = 2.0


def scene_text(values: Jumper) -> str:
    """The text of scene.toml: the star at rest, the pin on its far side."""
    direction = finger_direction(values)
    duration = math.ceil(TURNS * 360.0 / values.speed * 1e6) / 1e6
    presses = f"{values.preload:.6g} mN on the beak at rest, {values.rate:.6g} mN/mm more as it is lifted"
    return toml.scene(
        toml.head(
            *(values, "A calendar star with its jumper, drawn to these dimensions:"),
            f"Calendar star of {values.teeth} teeth with its jumper",
        ),
        toml.body(
            *("finger", "finger", "PIN", "turns clockwise, evenly, and carries the star on by a tooth in each turn"),
            pivot=toml.ORIGIN,
            position=toml.at(*polar(finger_distance(values), direction)),
            angle=f"{direction!r}°",
            motion="driven",
            velocity=f"{-values.speed!r} °/s",
        ),
        toml.body(
            *("star", "star", "STAR", f"turns counter-clockwise, {pitch(values):.6g}° at a time"),
            pivot=toml.ORIGIN,
            position=toml.ORIGIN,
            inertia=f"{values.star_inertia:.15g} mg·cm²",
        ),
        toml.body(
            *("jumper", "jumper", "BEAK"),
            "holds the star between two teeth, and throws it on once the beak has passed a point",
            pivot=toml.ORIGIN,
            position=toml.at(beak_at_rest(values), values.jumper_length),
            inertia=f"{values.jumper_inertia:.15g} mg·cm²",
        ),
        toml.table(
            *("[[springs]]", presses),
            body="jumper",
            stiffness=f"{values.rate * values.jumper_length**2!r} µN·m/rad",  # mN/mm · mm² = µN·m per rad
            rest=f"{-values.preload / (values.rate * values.jumper_length)!r} rad",
        ),
        toml.table("[[damping]]", body="star", coulomb=f"{values.drag:.15g} µN·m") if values.drag > 0.0 else None,
        toml.contacts(values, "finger.PIN star.STAR", "jumper.BEAK star.STAR"),
        toml.run(f"{duration:.15g} s"),
    )


def draw(values: Jumper) -> dict[str, Sheet]:
    """Star, jumper and finger."""
    return sheets_of(star=star(values), jumper=jumper(values), finger=finger(values))


DESIGN = Design("jumper", "Calendar star with jumper and finger", Jumper, draw, scene_text, conflicts)
