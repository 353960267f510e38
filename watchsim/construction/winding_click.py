"""Winding click with recoil: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import ratchet
from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, Conflict, Design, dim, sheets_of
from watchsim.construction.outline import along, angle_of, circle, polar, polygon
from watchsim.construction.ratchet import Ratchet
from watchsim.drawing.write import Sheet
from watchsim.geometry.primitives import Point


@dataclass(frozen=True)
class WindingClick:
    teeth: int = dim(18, "", 8, 80, "teeth of the ratchet wheel on the barrel's arbor", CHOSEN)
    tip_radius: float = dim(3.0, "mm", 0.3, 50.0, "of the wheel, to the points of its teeth", CHOSEN)
    depth: float = dim(0.6, "mm", 0.02, 10.0, "of the teeth", CHOSEN)
    undercut: float = dim(10.0, "°", 0.0, 30.0, "of the locking faces against the radius", CHOSEN)
    click_length: float = dim(2.0, "mm", 0.2, 50.0, "from the click's pivot to the middle of its nose", CHOSEN)
    nose_radius: float = dim(0.1, "mm", 0.005, 2.0, "of the round nose of the click", CHOSEN)
    reach: float = dim(0.35, "mm", 0.01, 8.0, "of the nose into the circle of the points, on the line of centres", CHOSEN)
    bank: float = dim(
        2.0, "°", -40.0, 40.0, "of the click on its bank, past the line of centres as the wheel runs back", CHOSEN
    )
    leaf_length: float = dim(6.0, "mm", 0.3, 60.0, "of the click's spring, a leaf", CHOSEN)
    leaf_width: float = dim(0.3, "mm", 0.02, 5.0, "of the leaf, across the plane", CHOSEN)
    leaf_thickness: float = dim(0.06, "mm", 0.01, 1.0, "of the leaf", CHOSEN)
    leaf_arm: float = dim(1.5, "mm", 0.05, 20.0, "from the click's pivot to the force of the leaf", CHOSEN)
    leaf_force: float = dim(10.0, "mN", 0.1, 1000.0, "of the leaf, with the click on its bank", CHOSEN)
    mainspring: float = dim(0.5, "mN·m", 0.001, 1000.0, "torque on the wheel, until its coils lie on each other", CHOSEN)
    full: float = dim(120.0, "°", 1.0, 3600.0, "from the start until they do", "short, to be simulated")
    bound: float = dim(4.0, "mN·m/rad", 0.01, 1e5, "stiffness of the coils that lie on each other", CHOSEN)
    winding: float = dim(1.5, "mN·m", 0.002, 3000.0, "torque of the hand that winds", CHOSEN)
    wound_for: float = dim(0.3, "s", 0.01, 10.0, "time for which it winds", CHOSEN)
    viscous: float = dim(0.1, "mN·m·s/rad", 1e-5, 1000.0, "of whatever is wound: keeps the speed down", CHOSEN)
    wheel_inertia: float = dim(50.0, "mg·cm²", 1e-3, 1e6, "wheel with what it turns", CHOSEN)
    click_inertia: float = dim(0.5, "mg·cm²", 1e-4, 1e4, "click", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.3, "coefficient of friction of click and wheel", "steel on oiled steel")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution", CHOSEN)


# How far does a winding click let its wheel run back?
#
# The wheel is wound counter-clockwise, the click hangs from its pivot above the wheel and swings with the teeth. A point T lets
# the nose fall behind it where nose, point and wheel's axis lie on a line, at the distance R + r from the axis:
#
#     cos β = (d² + l² - (R + r)²) / (2 d l)
#
# with the distance d of the axes and the length l of the click. The spring then swings the click to its bank. Let go, the wheel
# runs back until a locking face meets the nose there. From one place to the other it turns by the least recoil; where the hand
# stops elsewhere, by up to a pitch more. Millimetres, angles in degrees, the wheel's first root at 0°.


def teeth(values: WindingClick) -> Ratchet:
    """The ratchet wheel that has these teeth."""
    return Ratchet(teeth=values.teeth, tip_radius=values.tip_radius, depth=values.depth, undercut=values.undercut)


def distance(values: WindingClick) -> float:
    """Of the axes."""
    return values.tip_radius + values.click_length + values.nose_radius - values.reach


def nose(values: WindingClick, angle: float) -> Point:
    """The middle of the nose with the click at `angle`."""
    return along((0.0, distance(values)), angle - 90.0, values.click_length)


def lets_off(values: WindingClick) -> float:
    """The angle of the click at which a point passes beneath its nose."""
    d, length, out = distance(values), values.click_length, values.tip_radius + values.nose_radius
    return -math.degrees(math.acos((d**2 + length**2 - out**2) / (2.0 * d * length)))


def letting_off(values: WindingClick) -> float:
    """Angle of the wheel, of which the first tooth then stands under the nose."""
    return angle_of(nose(values, lets_off(values))) - angle_of(ratchet.tip(teeth(values)))


def held(values: WindingClick) -> float:
    """Angle of the wheel that presses the locking face of its first tooth on the nose, with the click on its bank.

    ValueError where no face can.
    """
    middle = nose(values, values.bank)
    foot = ratchet.root(teeth(values))[0] * math.sin(math.radians(values.undercut)) - values.nose_radius
    return angle_of(middle) - math.degrees(math.asin(foot / math.hypot(*middle))) + values.undercut


def least_recoil(values: WindingClick) -> float:
    return letting_off(values) - held(values)


def nose_in_teeth(values: WindingClick) -> tuple[float, float]:
    """With the click on its bank: how far up the locking face the nose touches it, and how far it is from the back before."""
    turn, middle = held(values), nose(values, values.bank)
    seen = polar(math.hypot(*middle), angle_of(middle) - turn)
    root, back = ratchet.root(teeth(values)), math.radians(ratchet.back(teeth(values)))
    lean = math.radians(-values.undercut)
    dx, dy = seen[0] - root[0], seen[1] - root[1]
    return dx * math.cos(lean) + dy * math.sin(lean), dy * math.cos(back) - dx * math.sin(back) - values.nose_radius


BEGIN, EASE, AFTER = 0.05, 0.02, 0.13  # s: before the hand winds, over which it takes hold and lets go, and after
BEYOND = 1.0  # rad past the full mainspring: as far as its table goes


def scene_text(values: WindingClick) -> str:
    """The text of scene.toml: the click holds, the wheel is wound until its spring is full, and let go."""
    start, hand = held(values), f"{values.winding:.15g} mN·m"
    full = start + values.full
    spring = f"{-values.mainspring:.15g} mN·m"
    tight = f"{-(values.mainspring + values.bound * BEYOND)!r} mN·m"
    ends = (BEGIN, BEGIN + EASE, BEGIN + values.wound_for, BEGIN + values.wound_for + EASE)
    times = [f"{round(time, 9)!r} s" for time in ends]
    recoil = (
        f"Let go, the wheel runs back by {least_recoil(values):.6g}° at least, and by up to {360.0 / values.teeth:.6g}° more."
    )
    return toml.scene(
        toml.head(
            *(values, "A winding click with recoil, drawn to these dimensions:"),
            *(f"Winding click with recoil, {values.teeth} teeth", recoil),
        ),
        toml.body(
            *("wheel", "wheel", "TEETH", "on the barrel's arbor, wound counter-clockwise"),
            pivot=toml.ORIGIN,
            angle=toml.Noted(f"{start!r}°", "a locking face on the nose", 14),
            inertia=f"{values.wheel_inertia:.15g} mg·cm²",
        ),
        toml.body(
            *("click", "click", "NOSE", "goes with the teeth both ways, but for its bank"),
            pivot=toml.ORIGIN,
            position=toml.at(0, distance(values)),
            angle=f"{values.bank!r}°",
            inertia=f"{values.click_inertia:.15g} mg·cm²",
        ),
        toml.table(
            *("[[springs]]", "a leaf, which holds the click on its bank"),
            body="click",
            leaf=toml.leaf(values),
            preload=f"{values.leaf_force * values.leaf_arm!r} µN·m",  # mN·mm = µN·m
            stop=f"{values.bank!r}°",
            restitution=values.restitution,
        ),
        toml.table(
            *("[[torques]]", f"the mainspring; from {values.full:g}° on its coils lie on each other"),
            body="wheel",
            over="angle",
            table=((f"{start!r}°", spring), (f"{full!r}°", spring), (f"{full + math.degrees(BEYOND)!r}°", tight)),
        ),
        toml.table(
            *("[[torques]]", "the hand that winds, and lets go"),
            body="wheel",
            over="time",
            table=list(zip(times, ("0 mN·m", hand, hand, "0 mN·m"), strict=True)),
        ),
        toml.table("[[damping]]", body="wheel", viscous=f"{values.viscous:.15g} mN·m·s/rad"),
        toml.contacts(values, "click.NOSE wheel.TEETH"),
        toml.run(f"{round(ends[3] + AFTER, 9)!r} s"),
    )


FOOT = 2.5  # radius of the click about its pivot, in radii of its nose
SHALLOWEST, STEEPEST = 0.1, 60.0  # of the depth; degrees of the click at the bank


def draw(values: WindingClick) -> dict[str, Sheet]:
    """The wheel; the click with its nose below the pivot, arm and foot touch nothing."""
    r, low, wide = values.nose_radius, -values.click_length, FOOT * values.nose_radius
    arm = polygon("ARM", [(-r, low), (r, low), (wide, 0.0), (-wide, 0.0)])
    click = [circle("NOSE", (0.0, low), r), arm, circle("FOOT", (0.0, 0.0), wide)]
    return sheets_of(wheel=ratchet.wheel(teeth(values)), click=click)


def conflicts(values: WindingClick) -> Iterator[Conflict]:
    if values.depth >= 0.8 * values.tip_radius:
        yield Conflict("depth", f"must be below {0.8 * values.tip_radius:.4g} mm, else no wheel is left")
        return
    if values.reach >= values.depth:
        yield Conflict("reach", f"must be below the depth of the teeth, {values.depth:g} mm, else the nose meets the roots")
        return
    inside = values.tip_radius + values.nose_radius - SHALLOWEST * values.depth
    if math.hypot(*nose(values, values.bank)) > inside:
        yield Conflict("bank", "there the nose is out of the teeth: nearer to 0°, or more reach")
        return
    if abs(values.bank) > STEEPEST or distance(values) < values.tip_radius:
        yield Conflict("reach", "brings the pivot of the click into the wheel: a longer click")
        return
    yield from _crowded(values)
    if values.winding <= 1.05 * values.mainspring:
        yield Conflict("winding", f"must be above {1.05 * values.mainspring:.4g} mN·m, else it does not wind the mainspring")


def _crowded(values: WindingClick) -> Iterator[Conflict]:
    """What keeps the nose from resting between two teeth."""
    try:
        along_face, free = nose_in_teeth(values)
    except ValueError:
        yield Conflict("nose_radius", "no locking face can meet the nose on its bank")
        return
    if not 0.0 < along_face < math.dist(ratchet.tip(teeth(values)), ratchet.root(teeth(values))):
        yield Conflict("reach", "the nose on its bank does not meet a locking face between root and point")
    elif free < 0.0:
        yield Conflict("nose_radius", f"the nose meets the back of a tooth before its bank, by {-free:.3g} mm")


DESIGN = Design("winding_click", "Winding click with recoil", WindingClick, draw, scene_text, conflicts)
