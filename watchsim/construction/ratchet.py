"""Ratchet wheel with its click: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, Conflict, Design, dim, sheets_of
from watchsim.construction.outline import along, angle_of, circle, polar, polygon
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Point


@dataclass(frozen=True)
class Ratchet:
    teeth: int = dim(24, "", 8, 80, "teeth of the ratchet wheel", "usual: 20 to 60")
    tip_radius: float = dim(3.0, "mm", 0.3, 50.0, "of the wheel, to the points of its teeth", CHOSEN)
    depth: float = dim(0.4, "mm", 0.02, 10.0, "of the teeth", CHOSEN)
    undercut: float = dim(5.0, "°", 0.0, 30.0, "of the locking faces against the radius", CHOSEN)
    click_length: float = dim(3.0, "mm", 0.3, 50.0, "from the click's pivot to its nose", CHOSEN)
    click_angle: float = dim(45.0, "°", 10.0, 80.0, "from the radius at the nose to the click", CHOSEN)
    nose_radius: float = dim(0.08, "mm", 0.005, 2.0, "of the round nose of the click", CHOSEN)
    click_force: float = dim(5.0, "mN", 0.01, 1000.0, "of the click's spring at its nose", CHOSEN)
    mainspring: float = dim(0.5, "mN·m", 0.001, 1000.0, "torque on the wheel, which the click holds", CHOSEN)
    winding: float = dim(1.5, "mN·m", 0.002, 3000.0, "torque against it, while the watch is wound", CHOSEN)
    viscous: float = dim(0.1, "mN·m·s/rad", 1e-5, 1000.0, "of whatever is wound: keeps the speed down", CHOSEN)
    wheel_inertia: float = dim(50.0, "mg·cm²", 1e-3, 1e6, "wheel with what it turns", CHOSEN)
    click_inertia: float = dim(0.5, "mg·cm²", 1e-4, 1e4, "click", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.3, "coefficient of friction of click and wheel", "steel on oiled steel")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution", CHOSEN)


# Which places follow from the dimensions of a ratchet wheel and its click?
#
# The wheel is wound counter-clockwise. At rest the click's nose lies in the root at 0°, between a locking face, which looks
# clockwise and leans over it by the undercut, and the back of the tooth before. Millimetres, angles in degrees.


def pitch(values: Ratchet) -> float:
    return 360.0 / values.teeth


def root(values: Ratchet) -> Point:
    return (values.tip_radius - values.depth, 0.0)


def tip(values: Ratchet) -> Point:
    """Of the tooth whose locking face rises from the root at 0°."""
    start, lean = root(values)[0], math.radians(values.undercut)
    length = -start * math.cos(lean) + math.sqrt(values.tip_radius**2 - (start * math.sin(lean)) ** 2)
    return along(root(values), -values.undercut, length)


def back(values: Ratchet) -> float:
    """Direction in which the back of the tooth before rises from the root at 0°."""
    return angle_of(polar(values.tip_radius, angle_of(tip(values)) - pitch(values)), root(values))


def opening(values: Ratchet) -> float:
    """Between that back and the locking face."""
    return -values.undercut - back(values)


def nose(values: Ratchet) -> Point:
    """Middle of the click's nose that touches both."""
    half = 0.5 * opening(values)
    return along(root(values), -values.undercut - half, values.nose_radius / math.sin(math.radians(half)))


def pivot(values: Ratchet) -> Point:
    """Of the click."""
    return along(nose(values), -values.click_angle, values.click_length)


BORE = 0.15  # of the tip radius
FOOT = 3.0  # radius of the click about its pivot, in radii of its nose


def wheel(values: Ratchet) -> list[Loop]:
    """Saw teeth, the first root at 0°; bore."""
    corners = []
    for turn in (i * pitch(values) for i in range(values.teeth)):
        corners += [polar(root(values)[0], turn), polar(values.tip_radius, turn + angle_of(tip(values)))]
    return [polygon("TEETH", corners), circle("TEETH", (0.0, 0.0), BORE * values.tip_radius, hole=True)]


def click(values: Ratchet) -> list[Loop]:
    """The nose to the left of the pivot; arm and foot touch nothing."""
    r, far, wide = values.nose_radius, -values.click_length, FOOT * values.nose_radius
    arm = polygon("ARM", [(far, -r), (0.0, -wide), (0.0, wide), (far, r)])
    return [circle("NOSE", (far, 0.0), r), arm, circle("FOOT", (0.0, 0.0), wide)]


WOUND = 0.35  # rad of the click's spring at rest: it hardly weakens as the click is lifted


def scene_text(values: Ratchet) -> str:
    """The text of scene.toml: the click holds, the wheel is wound, the click holds again."""
    angle, hand = -math.radians(values.click_angle), f"{values.winding:.15g} mN·m"
    return toml.scene(
        toml.head(
            *(values, "A ratchet wheel with its click, drawn to these dimensions:"),
            f"Ratchet wheel of {values.teeth} teeth with its click",
        ),
        toml.body(
            "wheel",
            "wheel",
            "TEETH",
            "wound counter-clockwise",
            pivot=toml.ORIGIN,
            inertia=f"{values.wheel_inertia:.15g} mg·cm²",
        ),
        toml.body(
            *("click", "click", "NOSE"),
            pivot=toml.ORIGIN,
            position=toml.at(*pivot(values)),
            angle=f"{angle!r} rad",
            inertia=f"{values.click_inertia:.15g} mg·cm²",
        ),
        toml.table(
            *("[[springs]]", f"presses the nose into the teeth with {values.click_force:.6g} mN"),
            body="click",
            stiffness=f"{values.click_force * values.click_length / WOUND!r} µN·m/rad",  # mN·mm = µN·m
            rest=f"{angle + WOUND!r} rad",
        ),
        toml.torque("wheel", f"{-values.mainspring!r} mN·m", "the mainspring"),
        toml.table(
            *("[[torques]]", "the hand that winds, and lets go"),
            body="wheel",
            over="time",
            table=(("0.05 s", "0 mN·m"), ("0.07 s", hand), ("0.35 s", hand), ("0.37 s", "0 mN·m")),
        ),
        toml.table("[[damping]]", body="wheel", viscous=f"{values.viscous:.15g} mN·m·s/rad"),
        toml.contacts(values, "click.NOSE wheel.TEETH"),
        toml.run("0.5 s"),
    )


NARROWEST = 20.0  # degrees


def draw(values: Ratchet) -> dict[str, Sheet]:
    """Wheel and click."""
    return sheets_of(wheel=wheel(values), click=click(values))


def conflicts(values: Ratchet) -> Iterator[Conflict]:
    if values.depth >= 0.8 * values.tip_radius:
        yield Conflict("depth", f"must be below {0.8 * values.tip_radius:.4g} mm, else no wheel is left")
        return
    if opening(values) < NARROWEST:
        yield Conflict("undercut", f"leaves roots of {opening(values):.3g}° for the nose; {NARROWEST:g}° are needed")
        return
    if nose(values)[0] - root(values)[0] > 0.6 * values.depth:
        yield Conflict("nose_radius", "the nose does not reach deep enough between the teeth")
    if values.click_angle > -back(values) - 5.0:
        yield Conflict("click_angle", f"must be below {-back(values) - 5.0:.3g}°, else the click lies in the teeth")
    if values.winding <= 1.05 * values.mainspring:
        yield Conflict("winding", f"must be above {1.05 * values.mainspring:.4g} mN·m, else it does not wind the mainspring")


DESIGN = Design("ratchet", "Ratchet wheel with its click", Ratchet, draw, scene_text, conflicts)
