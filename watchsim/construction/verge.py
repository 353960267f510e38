"""Verge escapement with a foliot: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, Conflict, Design, dim, sheets_of
from watchsim.construction.outline import circle, polygon, rounded
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Point

USUAL = "usual: 90° to 110° (Britten, The Watch and Clock Maker's Handbook)"


@dataclass(frozen=True)
class Verge:
    teeth: int = dim(
        27, "", 5, 99, "teeth of the crown wheel; odd, so that the two sides are half a pitch apart", "usual: 11 to 31"
    )
    wheel_radius: float = dim(40.0, "mm", 1.0, 500.0, "of the crown wheel, to the tips of its teeth", CHOSEN)
    flag_angle: float = dim(95.0, "°", 2.0, 130.0, "between the two flags", USUAL)
    lift: float = dim(20.0, "°", 0.5, 40.0, "of the verge from the middle to where a flag lets go", CHOSEN)
    drop: float = dim(0.6, "mm", 0.001, 20.0, "of the wheel from there until the other side meets its flag", CHOSEN)
    undercut: float = dim(25.0, "°", 5.0, 45.0, "of the faces that push, against the wheel's axis", CHOSEN)
    slope: float = dim(38.0, "°", 10.0, 60.0, "of the backs of the teeth, against the wheel's axis", CHOSEN)
    length: int = dim(100, "", 5, 2000, "teeth drawn of each side, as many as pass in a run", CHOSEN)
    torque: float = dim(60.0, "mN·m", 1e-6, 1e5, "on the crown wheel", CHOSEN)
    wheel_inertia: float = dim(200.0, "g·cm²", 1e-6, 1e6, "of the crown wheel and its train", CHOSEN)
    foliot_inertia: float = dim(16.0, "kg·cm²", 1e-6, 1e5, "of verge and foliot", "two arms of 20 cm with 20 g each")
    viscous: float = dim(1.5, "mN·m·s/rad", 0.0, 1e5, "damping of the foliot", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.5, "coefficient of friction of teeth and flags", "steel on oiled brass")
    restitution: float = dim(0.0, "", 0.0, 0.9, "coefficient of restitution", CHOSEN)


# Which places follow from the dimensions of a verge escapement?
#
# The verge stands in the origin, seen along its axis; the crown wheel's axis points down, so that its near side runs to the
# right below the verge and its far side to the left, each as a straight rack. A tooth tip at depth h pushes a flag, whose face
# lies in a plane through the axis, from one side to the other until the flag's edge lets it go. Millimetres, angles in radians.


def pitch(values: Verge) -> float:
    """Between the teeth, along the rim."""
    return math.tau * values.wheel_radius / values.teeth


def leaving(values: Verge) -> float:
    """The angle of a flag against the wheel's axis at which it lets a tooth go."""
    return math.radians(0.5 * values.flag_angle + values.lift)


def meeting(values: Verge) -> float:
    """That of the other flag at the same instant, the other way round."""
    return math.radians(0.5 * values.flag_angle - values.lift)


def depth(values: Verge) -> float:
    """h: the wheel goes half a pitch from one letting go to the next, all of it but the drop along flags."""
    return (0.5 * pitch(values) - values.drop) / (math.tan(leaving(values)) - math.tan(meeting(values)))


def flag_length(values: Verge) -> float:
    return depth(values) / math.cos(leaving(values))


def height(values: Verge) -> float:
    """Of the teeth: the flags swing clear of their roots."""
    return 1.15 * (flag_length(values) - depth(values)) + 0.02 * pitch(values)


def start(values: Verge) -> float:
    """Where a tooth tip of the near side stands at the start, just off the first flag, the verge in the middle."""
    return depth(values) * math.tan(math.radians(0.5 * values.flag_angle)) - 1e-3 * pitch(values)


AHEAD = 2  # teeth that have passed already
STAFF = 0.45  # radius of the verge's staff, in depths
THICK, THINNEST = 0.16, 0.08  # of a flag, in depths and in pitches, the smaller of the two
RIM = 1.5  # of the crown wheel below its teeth, in their heights
ARM = 200.0  # mm: reach of a foliot of 16 kg·cm²; one of another inertia is of the same shape
BAR, WEIGHT_WIDE, WEIGHT_HIGH = 0.0025, 0.10, 0.20  # of its reach


def near_side(values: Verge) -> list[Loop]:
    """It runs to the right."""
    return [_rack(values, "NEAR", 0.0, 1.0)]


def far_side(values: Verge) -> list[Loop]:
    """It runs to the left, half a pitch ahead."""
    return [_rack(values, "FAR", 0.5 * pitch(values), -1.0)]


def _rack(values: Verge, layer: str, ahead: float, way: float) -> Loop:
    """Teeth whose tips lie at the depth of the wheel, in the order of their passing from right to left for `way` 1."""
    top, tall, step = -depth(values), height(values), pitch(values)
    front, back = (tall * math.tan(math.radians(angle)) for angle in (values.undercut, values.slope))
    tips = [start(values) + ahead + (AHEAD - k) * step for k in range(values.length + AHEAD)]
    points: list[Point] = []
    for tip in tips:
        # From the front's root to the tip and down the back: the front leans over by the undercut.
        points += [(tip - front, top - tall), (tip, top), (tip - back, top - tall)]
    base = top - (1.0 + RIM) * tall
    points += [
        (tips[-1] - step, top - tall),
        (tips[-1] - step, base),
        (tips[0] + 0.5 * step, base),
        (tips[0] + 0.5 * step, top - tall),
    ]
    return _closed([(way * x, y) for x, y in points], layer)


def _closed(points: list[Point], layer: str) -> Loop:
    """Counter-clockwise, whichever way the points run."""
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(points, [*points[1:], points[0]], strict=True))
    loop = polygon(layer, points)
    return loop if area > 0.0 else loop.reversed()


def verge(values: Verge) -> list[Loop]:
    """Two flags with their faces in planes through the axis, and the staff."""
    half = math.radians(0.5 * values.flag_angle)
    return [
        _flag(values, "NEAR_FLAG", half, 1.0),
        _flag(values, "FAR_FLAG", half, -1.0),
        circle("STAFF", (0.0, 0.0), STAFF * depth(values)),
    ]


def foliot(values: Verge) -> list[Loop]:
    """A bar across the verge with a weight near either end: drawn only, its inertia is a number."""
    reach = ARM * (values.foliot_inertia / 16.0) ** 0.2
    bar, wide, high = 0.5 * BAR * reach, 0.5 * WEIGHT_WIDE * reach, 0.5 * WEIGHT_HIGH * reach
    return [
        _box("FOLIOT", 0.0, reach, bar),
        *(_box("WEIGHTS", side * (reach - 2.0 * wide), wide, high) for side in (-1.0, 1.0)),
    ]


def _box(layer: str, x: float, half: float, tall: float) -> Loop:
    """A plate with rounded corners about (x, 0), so wide and so high to either side."""
    corner = 0.4 * min(half, tall)
    corners = ((-half, -tall), (half, -tall), (half, tall), (-half, tall))
    return rounded(layer, [((x + dx, dy), corner) for dx, dy in corners])


def _flag(values: Verge, layer: str, angle: float, side: float) -> Loop:
    """A plate from the staff downwards, its face towards the teeth that come; `side` 1: they come from the left."""
    long, thick = flag_length(values), min(THICK * depth(values), THINNEST * pitch(values))
    points = [(0.0, 0.0), (0.0, -long), (thick, -long + 0.5 * thick), (thick, 0.0)]
    c, s = math.cos(angle), math.sin(angle)
    return _closed([(side * (c * x - s * y), s * x + c * y) for x, y in points], layer)


def scene_text(values: Verge) -> str:
    """The text of scene.toml: the verge begins at rest in the middle, a tooth of the near side at its flag."""
    words, rim = "A verge escapement with a foliot, drawn to these dimensions:", f"{values.wheel_radius:.15g} mm/rad"
    side: dict[str, Any] = {"motion": "slide", "axis": (1.0, 0.0)}
    return toml.scene(
        toml.head(values, words, f"Verge and foliot, crown wheel of {values.teeth} teeth"),
        toml.body(
            *("verge", "verge", "NEAR_FLAG FAR_FLAG", "with the foliot, seen along its axis"),
            draw="FOLIOT WEIGHTS",
            pivot=toml.ORIGIN,
            inertia=f"{values.foliot_inertia:.15g} kg·cm²",
        ),
        toml.table(
            *("[bodies.crown_wheel]", "stands across the plane, its axis pointing down", 8),
            inertia=f"{values.wheel_inertia:.15g} g·cm²",
        ),
        toml.table(
            *("[bodies.near_side]", "of its rim runs to the right,", 8),
            drawing="near_side.dxf",
            **side,
            mass=toml.Noted("1 µg", "weighed with the wheel", 20),
        ),
        toml.table(
            *("[bodies.far_side]", "the far one to the left", 8),
            drawing="far_side.dxf",
            **{**side, "axis": (-1.0, 0.0)},
            mass="1 µg",
        ),
        *(toml.table("[[gears]]", between=("crown_wheel", f"{name}_side"), ratio=rim) for name in ("near", "far")),
        toml.torque("crown_wheel", f"{values.torque:.15g} mN·m"),
        toml.table("[[damping]]", body="verge", viscous=f"{values.viscous:.15g} mN·m·s/rad"),
        toml.contacts(values, "near_side.NEAR verge.NEAR_FLAG", "far_side.FAR verge.FAR_FLAG"),
        toml.run("20 s", "1e-12"),
    )


STEEPEST = 80.0  # degrees of a flag against the wheel's axis when it lets go
NARROWEST = 3.0  # degrees of a tooth


def draw(values: Verge) -> dict[str, Sheet]:
    """The verge with its foliot, and the two sides of the crown wheel."""
    return sheets_of(verge=[*verge(values), *foliot(values)], near_side=near_side(values), far_side=far_side(values))


def conflicts(values: Verge) -> Iterator[Conflict]:
    if values.teeth % 2 == 0:
        yield Conflict("teeth", "must be odd: with an even number both sides would meet their flags at once")
    if math.degrees(leaving(values)) > STEEPEST:
        yield Conflict(
            "lift", f"must be below {STEEPEST - 0.5 * values.flag_angle:.4g}° with flags {values.flag_angle:g}° apart"
        )
        return
    if values.drop >= 0.45 * pitch(values):
        yield Conflict("drop", f"must be below {0.45 * pitch(values):.4g} mm, else nothing of the half pitch is left to push")
        return
    if values.slope < values.undercut + NARROWEST:
        yield Conflict("slope", f"must be above {values.undercut + NARROWEST:g}°, else the teeth have no body")
    elif height(values) * math.tan(math.radians(values.slope)) > 0.9 * pitch(values):
        yield Conflict("slope", f"leaves no gap between teeth {height(values):.3g} mm high, {pitch(values):.3g} mm apart")
    if depth(values) < 0.02 * pitch(values):
        yield Conflict("lift", "leaves too short a way between the wheel and the verge's axis")


DESIGN = Design("verge", "Verge escapement with a foliot", Verge, draw, scene_text, conflicts)
