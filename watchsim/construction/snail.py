"""Snail of a striking train with its rack: dimensions, outlines, scene and conflicts."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from watchsim.construction import scene_builder as toml
from watchsim.construction.design import CHOSEN, Conflict, Design, dim, sheets_of
from watchsim.construction.outline import along, angle_of, arc_between, circle, polar, polygon, turned
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Edge, Line, Point


@dataclass(frozen=True)
class Snail:
    steps: int = dim(12, "", 3, 24, "of the snail: hours that it counts", "12; 4 for quarters")
    distance: float = dim(20.0, "mm", 2.0, 200.0, "of the axes of snail and rack", CHOSEN)
    tail: float = dim(20.0, "mm", 2.0, 200.0, "from the rack's axis to the pin of its tail", "Goodrich: as the distance")
    pin_radius: float = dim(0.4, "mm", 0.02, 5.0, "of that pin", CHOSEN)
    tooth: float = dim(2.5, "°", 0.2, 10.0, "of the rack, for one blow", CHOSEN)
    least: float = dim(4.0, "mm", 0.2, 100.0, "radius of the lowest step", CHOSEN)
    leaf_length: float = dim(50.0, "mm", 1.0, 300.0, "of the rack's spring, a leaf", CHOSEN)
    leaf_width: float = dim(1.5, "mm", 0.02, 20.0, "of the leaf, across the plane", CHOSEN)
    leaf_thickness: float = dim(0.25, "mm", 0.01, 5.0, "of the leaf", CHOSEN)
    leaf_arm: float = dim(3.0, "mm", 0.05, 50.0, "from the rack's axis to the force of the leaf", CHOSEN)
    leaf_force: float = dim(40.0, "mN", 0.1, 1e4, "of the leaf, with the rack gathered up", CHOSEN)
    lifting: float = dim(0.3, "mN·m", 1e-4, 1000.0, "torque that gathers the rack up", CHOSEN)
    hour: float = dim(0.5, "s", 0.01, 3600.0, "from step to step", "short, to be simulated")
    rack_inertia: float = dim(1000.0, "mg·cm²", 1e-3, 1e6, "rack with its tail", CHOSEN)
    friction: float = dim(0.1, "", 0.0, 0.3, "coefficient of friction, in all contacts", "steel on oiled brass")
    restitution: float = dim(0.2, "", 0.0, 0.9, "coefficient of restitution, in all contacts", CHOSEN)


# How high are the steps of a snail, and where do they stand?
#
# The snail's axis is the origin, the rack's lies to the right at the distance d. With the tail, of length l, at the angle ψ
# from the line of centres its pin is s = √(d² + l² - 2 d l cos ψ) from the snail's axis. At step n the rack has fallen by n
# teeth, so
#
#     r_n = s(ψ₀ - n tooth) - pin_radius
#
# and the middle of the step stands where the pin then is, a turn / steps further for each hour. Millimetres, degrees.

FALLS, LIFTED = 0.25, 0.6  # of an hour: the rack is let go, and gathered up again
UNDER = 0.5  # of an hour: the middle of a step is under the pin
EASE = 0.02  # of an hour, over which the rack is taken hold of


def gathered(values: Snail) -> float:
    """ψ₀ of the tail, gathered up. ValueError where the pin cannot come to the lowest step."""
    d, tail, low = values.distance, values.tail, values.least + values.pin_radius
    return math.degrees(math.acos((d**2 + tail**2 - low**2) / (2.0 * d * tail))) + values.steps * values.tooth


def pin(values: Snail, fallen: float) -> Point:
    """Its middle, with the rack fallen by so many teeth."""
    return polar(values.tail, 180.0 - gathered(values) + fallen * values.tooth, (values.distance, 0.0))


def radius(values: Snail, step: int) -> float:
    return math.hypot(*pin(values, step)) - values.pin_radius


def middle(values: Snail, step: int) -> float:
    """Direction of the middle of a step on the snail as it is drawn, with the first step under the pin."""
    return angle_of(pin(values, step)) - (step - 1) * 360.0 / values.steps


def boundary(values: Snail, step: int) -> float:
    """Between a step and the one before, which stands counter-clockwise of it; before the first is the last."""
    before = middle(values, step - 1) if step > 1 else middle(values, values.steps) + 360.0
    return 0.5 * (middle(values, step) + before)


def fall_time(values: Snail, fallen: float) -> float:
    """s for so many teeth, on the leaf alone: (P / k) (1 - cos ω t) rad, P its preload and ω² = k / J."""
    preload, stiffness = 1e-6 * values.leaf_force * values.leaf_arm, leaf_stiffness(values)
    cosine = 1.0 - stiffness / preload * math.radians(fallen * values.tooth)
    return math.acos(cosine) / math.sqrt(stiffness / (1e-10 * values.rack_inertia))


def leaf_stiffness(values: Snail) -> float:
    """N·m/rad, on the rack."""
    length, width, thick, arm = values.leaf_length, values.leaf_width, values.leaf_thickness, values.leaf_arm
    return toml.STEEL * width * thick**3 / (4.0 * length**3) * arm**2 * 1e-9


def rise_time(values: Snail) -> float:
    """s until the rack, fallen to the lowest step, is gathered up; longer than it takes, since the leaf yields."""
    left = 1e-3 * values.lifting - 1e-6 * values.leaf_force * values.leaf_arm
    inertia = 1e-10 * values.rack_inertia
    return EASE * values.hour + math.sqrt(2.0 * math.radians(values.steps * values.tooth) * inertia / left)


def room(values: Snail, step: int) -> float:
    """Degrees that are left on a step beside the pin, on the nearer side, while the snail turns under it.

    The wall behind the last step rises to the first: it must not come before the pin, on its way up, has passed it.
    """
    pitch, here = 360.0 / values.steps, middle(values, step)
    after = boundary(values, step + 1) if step < values.steps else boundary(values, 1) - 360.0
    ahead, behind = (UNDER - FALLS) * pitch, (LIFTED - UNDER) * pitch
    rooms = [boundary(values, step) - here - _beside(values, step) - ahead, here - after - _beside(values, step) - behind]
    if step == values.steps:
        behind += pitch * rise_time(values) / values.hour
        way = [angle_of(pin(values, m)) - angle_of(pin(values, step)) - _beside(values, m) for m in range(1, step)]
        rooms += [here - after + one - behind for one in way]
    return min(rooms)


def _beside(values: Snail, step: int) -> float:
    """Half the pin, seen from the snail's axis."""
    return math.degrees(math.asin(values.pin_radius / math.hypot(*pin(values, step))))


BORE = 0.3  # of the lowest step's radius
BAR = 1.5  # half the width of the tail in radii of its pin
RACK, DEPTH, SPOKE = 0.9, 0.04, 25.0  # radius of the rack and depth of its teeth by the tail; degrees of the rack's first tooth
STOP = 0.5  # of the tail: where it meets the stop


def snail(values: Snail) -> list[Loop]:
    """Arcs about the axis joined by radial walls, counter-clockwise from the last step to the first."""
    edges: list[Edge] = []
    last = values.steps
    for step in range(last, 0, -1):
        follower = step - 1 if step > 1 else last
        begin = boundary(values, step + 1) if step < last else boundary(values, 1) - 360.0
        end = boundary(values, step)
        r, after = radius(values, step), radius(values, follower)
        edges.append(arc_between(polar(r, begin), polar(r, end), (0.0, 0.0), True))
        edges.append(Line(*polar(r, end), *polar(after, end)))
    return [Loop(tuple(edges), "STEPS"), circle("STEPS", (0.0, 0.0), BORE * values.least, hole=True)]


def rack(values: Snail) -> list[Loop]:
    """About its axis, gathered up: pin and tail; the toothed rack on its other arm touches nothing."""
    half = BAR * values.pin_radius
    way = 180.0 - gathered(values)
    bar = [turned(corner, way) for corner in ((0.0, -half), (values.tail, -half), (values.tail, half), (0.0, half))]
    pin = circle("PIN", polar(values.tail, way), values.pin_radius)
    return [pin, polygon("TAIL", bar), _teeth(values), circle("FOOT", (0.0, 0.0), 2.0 * half)]


def stop(values: Snail) -> list[Loop]:
    """A pin above the tail, from the rack's axis."""
    way, r = 180.0 - gathered(values), values.pin_radius
    return [circle("STOP", along(polar(STOP * values.tail, way), way - 90.0, (1.0 + BAR) * r), r)]


def _teeth(values: Snail) -> Loop:
    """A sector with a tooth more at either end than there are steps."""
    outer, count = RACK * values.tail, values.steps + 2
    hub = BAR * values.pin_radius
    corners = [polar(hub, SPOKE + 45.0)]
    for i in range(count):
        at = SPOKE - i * values.tooth
        corners += [polar(outer, at), polar((1.0 - DEPTH) * outer, at)]
    inside, end = (1.0 - 4.0 * DEPTH) * outer, SPOKE - count * values.tooth
    narrow = SPOKE - math.degrees(3.0 * hub / inside)
    corners += [polar(inside, end), polar(inside, max(narrow, 0.5 * (SPOKE + end))), polar(hub, SPOKE - 45.0)]
    return polygon("RACK", corners[::-1])


SUDDEN = 1e-6  # s: over which the rack is let go
END = 0.58  # of the last hour: the rack lies on the lowest step


def scene_text(values: Snail) -> str:
    """The text of scene.toml: the rack gathered up, the first step coming under its pin."""
    free, taken = values.hour * FALLS, values.hour * LIFTED
    times = (free, free + SUDDEN, taken, taken + EASE * values.hour)
    torques = (-values.lifting, 0.0, 0.0, -values.lifting)
    rows = [(f"{time:.15g} s", f"{torque:.15g} mN·m") for time, torque in zip(times, torques, strict=True)]
    pitch = 360.0 / values.steps
    return toml.scene(
        toml.head(
            *(values, "The snail of a striking train with its rack, drawn to these dimensions:"),
            f"Snail of {values.steps} steps with its rack",
        ),
        toml.body(
            *("snail", "snail", "STEPS", "turns counter-clockwise, evenly, by a step in each hour"),
            pivot=toml.ORIGIN,
            angle=f"{-0.5 * pitch!r}°",
            motion="driven",
            velocity=f"{pitch / values.hour!r} °/s",
        ),
        toml.body(
            *("rack", "rack", "PIN TAIL", "falls counter-clockwise, by a tooth for each blow"),
            pivot=toml.ORIGIN,
            position=toml.at(values.distance, 0),
            inertia=f"{values.rack_inertia:.15g} mg·cm²",
        ),
        toml.body(
            *("stop", "stop", "STOP", "of the rack that has been gathered up"),
            pivot=toml.ORIGIN,
            position=toml.at(values.distance, 0),
            motion="fixed",
        ),
        toml.table(
            *("[[springs]]", "a leaf"),
            body="rack",
            leaf=toml.leaf(values),
            preload=f"{values.leaf_force * values.leaf_arm!r} µN·m",  # mN·mm = µN·m
        ),
        toml.table(
            *("[[torques]]", "the striking train gathers the rack up, and lets it go once in each hour"),
            body="rack",
            over="time",
            table=rows,
            period=f"{values.hour!r} s",
        ),
        toml.contacts(values, "rack.PIN snail.STEPS", "rack.TAIL stop.STOP"),
        toml.run(f"{round((values.steps - 1 + END) * values.hour, 9)!r} s"),
    )


WIDEST = 140.0  # degrees of the tail to the line of centres, gathered up
QUIET = 0.25  # of the time on a step that the rack may take to fall there


def draw(values: Snail) -> dict[str, Sheet]:
    """Snail, rack and stop."""
    return sheets_of(snail=snail(values), rack=rack(values), stop=stop(values))


def conflicts(values: Snail) -> Iterator[Conflict]:
    low = values.least + values.pin_radius
    if not abs(values.distance - values.tail) < low < values.distance + values.tail:
        yield Conflict("tail", f"does not bring the pin to the lowest step, {low:.4g} mm from the snail's axis")
        return
    if gathered(values) > WIDEST:
        yield Conflict("tooth", f"the rack would fall by {values.steps * values.tooth:.4g}°, more than its tail can follow")
        return
    if radius(values, 1) + 4.0 * values.pin_radius > values.distance:
        yield Conflict("distance", f"the first step, {radius(values, 1):.4g} mm high, would reach the rack's axis")
    if weak := list(_weak(values)):
        yield from weak
        return
    narrowest = min(range(1, values.steps + 1), key=lambda step: room(values, step))
    if room(values, narrowest) <= 0.0:
        what = (
            "a smaller pin, a tail as long as the distance, so that its pin passes through the snail's axis, "
            "or more torque to gather the rack up"
        )
        yield Conflict("pin_radius", f"the pin does not find room on step {narrowest} while the snail turns: {what}")


def _weak(values: Snail) -> Iterator[Conflict]:
    """What keeps the rack from falling in time, or from being gathered up."""
    preload, whole = values.leaf_force * values.leaf_arm, values.steps * values.tooth
    lost = 1e6 * leaf_stiffness(values) * math.radians(whole)
    if preload <= 1.1 * lost:
        needed = 1.1 * lost / values.leaf_arm
        yield Conflict("leaf_force", f"must be above {needed:.4g} mN, else the leaf slackens before the lowest step")
        return
    if 1e3 * values.lifting <= 1.2 * preload:
        yield Conflict("lifting", f"must be above {1.2e-3 * preload:.4g} mN·m to gather the rack up against its leaf")
        return
    slowest = fall_time(values, values.steps) / (QUIET * (LIFTED - FALLS))
    if values.hour < slowest:
        yield Conflict("hour", f"must be above {slowest:.4g} s, else the rack has no time to come to rest")


DESIGN = Design("snail", "Snail of a striking train with its rack", Snail, draw, scene_text, conflicts)
