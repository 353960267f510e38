"""Which mechanism has number k of a seed? First those that turn about pivots, then those that slide or are free."""

import math
from collections.abc import Callable
from dataclasses import replace

from hunt.parts import (
    MM,
    Dice,
    apart,
    box,
    cam_curve,
    circle,
    closed_curve,
    fixed,
    free,
    gear,
    kinked_bar,
    pivoted,
    polygon,
    ragged,
    ratchet_wheel,
    scene,
    sliding,
    slotted_wheel,
    turned_points,
    wavy_bar,
)
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import TURN
from watchsim.scene.forces import Damping, Spring, Torque
from watchsim.scene.scene import Body, Scene


def blade(dice: Dice) -> Scene:
    """A tooth pushes a radial (or nearly radial) blade past the line of centres."""
    reach, long = dice.uniform(1.5, 3.0) * MM, dice.uniform(0.6, 1.5) * MM
    depth = dice.uniform(0.03, 0.4) * long
    offset = dice.pick((0.0, 0.0, 0.0, dice.kink(0.1), dice.uniform(-0.05, 0.05))) * long  # from the radius
    tooth = polygon([(0.0, reach), (-0.3 * MM, reach - 0.6 * MM), (-dice.pick((0.0, 0.05, 0.1)) * MM, reach - 0.6 * MM)])
    flag = polygon([(offset, -long), (offset + 0.1 * MM, -long), (offset + 0.1 * MM, -0.5 * long), (offset, -0.5 * long)])
    back = dice.uniform(4.0, 20.0)
    bodies = [
        pivoted("wheel", tooth, (0.0, 0.0), math.radians(back + dice.uniform(2.0, 6.0)), inertia=dice.log(1e-13, 1e-10)),
        pivoted(
            "balance",
            flag,
            (0.0, reach + long - depth),
            -math.radians(dice.uniform(0.0, 6.0)),
            math.radians(dice.uniform(0.0, 4000.0)) if dice.chance(0.7) else 0.0,
            inertia=dice.log(1e-12, 1e-9),
        ),
    ]
    springs = (Spring("balance", dice.log(1e-7, 1e-5)),) if dice.chance(0.3) else ()
    return scene(dice, "blade", bodies, 0.015, torques=(Torque("wheel", -dice.log(1e-7, 1e-4)),), springs=springs)


def cam(dice: Dice) -> Scene:
    """A cam of many arcs or chords drives an arm with a roller, a pin or a flat face."""
    radius, count = dice.uniform(4.0, 8.0) * MM, dice.number(4, 48)
    outline = closed_curve(cam_curve(dice, radius), count, dice.chance(0.6))
    arm, high = dice.uniform(14.0, 22.0) * MM, 1.5 * radius
    tip = dice.pick(("roller", "blade", "flat"))
    shapes = {
        "roller": circle(dice.uniform(0.5, 3.0) * MM, (arm, 0.0)),
        "blade": polygon([(arm, -2.0 * MM), (arm + 1.0 * MM, 0.0), (arm - 1.0 * MM, 0.0)]),
        "flat": box(16.0 * MM, 1.0 * MM, (arm, 0.0)),
    }
    speed = dice.sign() * dice.uniform(5.0, 40.0)
    bodies = [
        pivoted("cam", outline, (0.0, 0.0), dice.uniform(0.0, 6.0), speed, inertia=dice.log(1e-6, 1e-3)),
        pivoted("arm", shapes[tip], (-arm, high), 0.3, inertia=dice.log(1e-7, 1e-5)),
    ]
    press = -dice.log(1e-3, 3e-2)
    springs = (Spring("arm", dice.log(1e-3, 1e-1)),) if dice.chance(0.4) else ()
    torques = (Torque("arm", press), Torque("cam", math.copysign(abs(press) * dice.uniform(0.0, 1.0), speed)))
    return scene(dice, "cam", bodies, min(1.5 * TURN / abs(speed), 0.3), torques=torques, springs=springs)


def gears(dice: Dice) -> Scene:
    """Two involute wheels, each flank in so many arcs or chords."""
    teeth, other = dice.number(8, 12), dice.number(8, 14)
    pieces, arcs, module = dice.number(1, 10), dice.chance(0.6), 1.0 * MM
    distance = 0.5 * module * (teeth + other) * (1.0 + dice.uniform(0.001, 0.02))
    a = gear(teeth, module, pieces, arcs, 0.06)
    b = gear(other, module, pieces, arcs, 0.06)
    speed = dice.uniform(0.0, 30.0)
    bodies = [
        pivoted("pinion", a, (0.0, 0.0), 0.0, speed, inertia=dice.log(1e-8, 1e-7)),
        pivoted("gear", b, (distance, 0.0), math.pi + math.pi / other, -speed * teeth / other, inertia=dice.log(1e-8, 1e-6)),
    ]
    torque = dice.log(1e-6, 1e-4)
    return scene(
        dice,
        "gears",
        bodies,
        0.04,
        torques=(Torque("pinion", torque),),
        damping=(Damping("gear", viscous=torque / dice.uniform(10.0, 60.0)),),
        law=(dice.pick((0.0, 0.1, 0.2, dice.friction())), dice.restitution()),
    )


def ratchet(dice: Dice) -> Scene:
    """A saw-toothed wheel, turning either way, under a click."""
    teeth, radius, depth = dice.number(6, 16), 10.0 * MM, dice.uniform(0.8, 2.0) * MM
    wheel = ratchet_wheel(teeth, radius, depth, dice.pick((0.0, dice.uniform(-0.1, 0.1))))
    long = dice.uniform(8.0, 16.0) * MM
    click = polygon([(0.0, 0.0), (-long, 0.5 * MM), (-long, -0.5 * MM)])
    lift = dice.uniform(0.15, 0.5)
    place = (radius * math.sin(0.2) + long * math.cos(lift), radius * math.cos(0.2) + 2.5 * MM + long * math.sin(lift) * 0.2)
    bodies = [
        pivoted(
            "wheel",
            wheel,
            (0.0, 0.0),
            dice.uniform(0.0, 1.0),
            dice.sign() * dice.uniform(0.0, 20.0),
            inertia=dice.log(1e-7, 1e-5),
        ),
        pivoted("click", click, place, -lift, inertia=dice.log(1e-8, 1e-7)),
    ]
    torques = (Torque("wheel", dice.sign() * dice.log(1e-4, 1e-2)), Torque("click", dice.log(1e-4, 1e-2)))
    return scene(dice, "ratchet", bodies, 0.1, torques=torques)


def geneva(dice: Dice) -> Scene:
    """A pin drives a wheel with radial slots."""
    slots, distance = dice.pick((4, 5, 6)), 14.0 * MM
    crank = distance * math.sin(math.pi / slots)
    pin = dice.uniform(0.8, 1.5) * MM
    play = dice.pick((0.01, 0.1)) * MM
    reach = distance * math.cos(math.pi / slots)
    wheel = slotted_wheel(slots, reach, 2.0 * (pin + play), reach - (distance - crank) + pin + 0.5 * MM)
    speed = dice.uniform(4.0, 30.0)
    start = math.pi - (0.5 - 1.0 / slots) * math.pi - dice.uniform(0.3, 0.6)
    bodies = [
        pivoted("driver", circle(pin, (crank, 0.0)), (distance, 0.0), start, speed, inertia=dice.log(1e-6, 1e-2)),
        pivoted("wheel", wheel, (0.0, 0.0), math.pi / slots + dice.uniform(-0.02, 0.02), inertia=dice.log(1e-7, 1e-5)),
    ]
    damping = (Damping("wheel", viscous=dice.log(1e-7, 1e-5)),)
    return scene(dice, "geneva", bodies, 4.0 / speed, torques=(Torque("driver", dice.log(1e-5, 1e-3)),), damping=damping)


def anchor(dice: Dice) -> Scene:
    """A toothed wheel drives a sprung anchor with two pallets back and forth."""
    teeth, radius = dice.number(8, 15), 5.0 * MM
    points = []
    for k in range(teeth):
        a = k * TURN / teeth
        points += turned_points([(3.8 * MM, -0.6 * MM), (radius, 0.0), (3.8 * MM, 0.2 * MM)], a)
    span, height = (int(teeth / 3.0) + 0.5) * TURN / teeth, 1.25 * radius
    half = 0.5 * span
    left, right = (
        (-(radius * math.sin(half)), radius * math.cos(half) - height),
        (radius * math.sin(half), radius * math.cos(half) - height),
    )
    lean, w = dice.uniform(0.0, 0.6), 0.8 * MM
    dip = dice.uniform(0.1, 0.3) * MM
    arm = polygon(
        [
            (left[0] - w, left[1] - dip - lean * w),
            (left[0], left[1] - dip),
            (left[0] + 0.3 * MM, -1.2 * MM),
            (right[0] - 0.3 * MM, -1.2 * MM),
            (right[0], right[1] - dip),
            (right[0] + w, right[1] - dip + lean * w),
            (right[0] + w, 0.5 * MM),
            (left[0] - w, 0.5 * MM),
        ]
    )
    bodies = [
        pivoted("wheel", polygon(points), (0.0, 0.0), dice.uniform(0.0, TURN), inertia=dice.log(1e-10, 1e-8)),
        pivoted("anchor", arm, (0.0, height), dice.uniform(-0.1, 0.1), dice.uniform(-10.0, 10.0), inertia=dice.log(1e-9, 1e-7)),
    ]
    torques = (Torque("wheel", dice.sign() * dice.log(1e-6, 1e-4)),)
    springs = (Spring("anchor", dice.log(1e-6, 1e-3)),) if dice.chance(0.7) else ()
    return scene(dice, "anchor", bodies, 0.05, torques=torques, springs=springs)


def pendulums(dice: Dice) -> Scene:
    """Two to four pendulums in a row, mostly alike, which meet where they hang."""
    count, long, radius = dice.number(2, 4), 300.0 * MM, 20.0 * MM
    shape = dice.pick(("disc", "block", "ragged"))
    bob = {"disc": circle(radius, (0.0, -long)), "block": box(2.0 * radius, 2.0 * radius, (0.0, -long))}.get(shape)
    outline = bob or ragged(dice, radius, dice.number(3, 7)).moved(dice.uniform(0.0, 6.0), (0.0, -long))
    gap = dice.pick((0.0, 0.0, 1e-4, dice.log(1e-9, 1e-2)))
    alike = dice.chance(0.7)
    bodies = []
    for k in range(count):
        swung = k == 0 or (k == count - 1 and dice.chance(0.4))
        angle = (dice.uniform(0.2, 1.1) * (-1.0 if k == 0 else 1.0)) if swung else 0.0
        mass = 0.1 if alike else dice.log(0.03, 0.3)
        bodies.append(pivoted(f"p{k}", outline, (k * (2.0 * radius + gap), 0.0), angle, 0.0, mass=mass))
    return scene(dice, "pendulums", bodies, 3.0, gravity=True)


def levers(dice: Dice) -> Scene:
    """Two or three arms of any shape that hit each other and a stop."""
    bodies, torques, springs, damping = [], [], [], []
    for k in range(dice.number(2, 3)):
        outline = ragged(dice, dice.uniform(4.0, 10.0) * MM, dice.number(3, 7))
        if dice.chance(0.3):
            outline = closed_curve(cam_curve(dice, dice.uniform(4.0, 9.0) * MM), dice.number(4, 24), dice.chance(0.6))
        name = f"b{k}"
        spin, angle = dice.uniform(-30.0, 30.0), dice.uniform(0.0, 6.0)
        place = (k * dice.uniform(12.0, 18.0) * MM, dice.uniform(-4.0, 4.0) * MM)
        bodies.append(pivoted(name, outline, place, angle, spin, inertia=dice.log(1e-7, 1e-5)))
        if dice.chance(0.5):
            torques.append(Torque(name, dice.sign() * dice.log(1e-4, 1e-2)))
        if dice.chance(0.4):
            springs.append(Spring(name, dice.log(1e-4, 1e-1), angle))
        if dice.chance(0.3):
            damping.append(Damping(name, viscous=dice.log(1e-7, 1e-5)))
        elif dice.chance(0.2):
            damping.append(Damping(name, coulomb=dice.log(1e-5, 1e-3)))
    if dice.chance(0.3):
        bodies.append(fixed("stop", circle(1.0 * MM), position=(7.0 * MM, dice.uniform(8.0, 12.0) * MM)))
    if dice.chance(0.2):
        bodies.append(free("pawn", circle(1.5 * MM), (8.0 * MM, -14.0 * MM), 0.01, velocity=(0.0, 0.3, 0.0)))
    return scene(dice, "levers", bodies, 0.2, torques=tuple(torques), springs=tuple(springs), damping=tuple(damping))


# Which mechanisms slide or fly? Followers over kinks and waves, bodies in a row, blocks on floors, boxes.


def kink(dice: Dice) -> Scene:
    """A follower rides over a sliding bar with kinks, concave and convex, from 1e-10 rad to a right angle."""
    return _ridden(dice, "kink", kinked_bar(dice, 80.0 * MM, 5.0 * MM))


def wave(dice: Dice) -> Scene:
    """The same over a wave of many arcs or chords."""
    return _ridden(dice, "wave", wavy_bar(dice, 80.0 * MM, 5.0 * MM))


def _ridden(dice: Dice, title: str, bar: Loop) -> Scene:
    """The follower begins on the flat part of the bar or just above it, 20 to 30 mm left of the bar's middle."""
    radius, speed = dice.uniform(1.0, 4.0) * MM, dice.uniform(30.0, 300.0) * MM
    place = -dice.uniform(22.0, 30.0) * MM
    above = dice.pick((0.0, 0.0, dice.uniform(0.01, 1.0) * MM))
    tip = polygon([(0.0, 0.0), (2.0 * MM, 4.0 * MM), (-2.0 * MM, 4.0 * MM)])
    kind = dice.pick(("arm", "arm", "plunger", "point", "roller"))
    force = dice.log(0.01, 1.0)
    mass = dice.log(0.01, 0.3)
    bodies = [sliding("bar", bar, (0.0, 0.0), 0.0, -speed, dice.log(0.03, 0.3))]
    torques = [Torque("bar", -dice.log(1e-2, 1.0))] if dice.chance(0.4) else []
    if kind == "arm":
        long = dice.uniform(10.0, 40.0) * MM
        if dice.chance(0.3):  # turns about its own middle
            bodies.append(pivoted("arm", circle(radius), (place, radius + above), inertia=dice.log(1e-6, 1e-5)))
        else:
            bodies.append(pivoted("arm", circle(radius, (long, 0.0)), (place - long, radius + above), inertia=mass * long**2))
        torques.append(Torque("arm", -force * long))
    elif kind == "roller":
        bodies.append(free("roller", circle(radius), (place, radius + above), mass, velocity=(0.0, 0.0, 0.0)))
        return scene(dice, title, bodies, 60.0 * MM / speed, gravity=True, torques=tuple(torques))
    else:
        outline = circle(radius, (0.0, radius)) if kind == "plunger" else tip
        bodies.append(sliding("plunger", outline, (place, above), 0.5 * math.pi, 0.0, mass))
        torques.append(Torque("plunger", -force))
    springs = (Spring(bodies[1].name, dice.log(10.0, 1000.0) * (MM**2 if kind == "arm" else 1.0)),) if dice.chance(0.3) else ()
    return scene(dice, title, bodies, 60.0 * MM / speed, torques=tuple(torques), springs=springs)


def row(dice: Dice) -> Scene:
    """Two to four bodies in a line, mostly alike, that hit each other flat on flat or round on round; perhaps a wall."""
    count, wide = dice.number(2, 4), 10.0 * MM
    shape, motion = dice.pick(("box", "disc", "disc", "ragged")), dice.pick(("slide", "slide", "free"))
    alike, speed = dice.chance(0.7), dice.uniform(0.1, 1.0)
    bodies: list[Body] = []
    x = 0.0
    outline = {"box": box(wide, wide), "disc": circle(0.5 * wide)}.get(shape) or ragged(dice, 0.5 * wide, 6)
    for k in range(count):
        mass = 0.02 if alike else dice.log(0.005, 0.1)
        v = speed if k == 0 else (-speed * dice.pick((0.5, 1.0)) if k == count - 1 and dice.chance(0.4) else 0.0)
        name = f"s{k}"
        if motion == "slide":
            bodies.append(sliding(name, outline, (x, 0.0), 0.0, v, mass))
        else:
            bodies.append(free(name, outline, (x, dice.pick((0.0, 0.0, 2e-3)) if k else 0.0), mass, velocity=(v, 0.0, 0.0)))
        x += wide + (dice.uniform(5.0, 20.0) * MM if k == 0 else dice.pick((0.0, 0.0, 1e-3, dice.log(1e-9, 1e-2))))
    if dice.chance(0.4):
        bodies.append(fixed("wall", box(wide, 4.0 * wide), position=(x + dice.uniform(0.0, 10.0) * MM, 0.0)))
    springs = (Spring("s0", dice.log(1.0, 100.0)),) if motion == "slide" and dice.chance(0.3) else ()
    damping = (Damping("s1", viscous=dice.log(1e-3, 1e-1)),) if motion == "slide" and dice.chance(0.2) else ()
    return scene(dice, "row", bodies, 0.15, springs=springs, damping=damping)


def blocks(dice: Dice) -> Scene:
    """Blocks on a floor, perhaps tilted, flat on flat or just above it, sliding, at rest, or stacked."""
    tilt = dice.pick((0.0, 0.0, dice.uniform(0.0, 0.6), dice.kink(1e-3)))
    wide, high = dice.uniform(5.0, 20.0) * MM, dice.uniform(3.0, 15.0) * MM
    c, s = math.cos(tilt), math.sin(tilt)

    def on_floor(along: float, up: float) -> tuple[float, float]:
        return c * along - s * up, s * along + c * up

    floor = fixed("floor", box(200.0 * MM, 10.0 * MM, (0.0, -5.0 * MM)), angle=tilt)
    above = dice.pick((0.0, 0.0, 0.0, dice.uniform(0.1, 3.0) * MM))
    speed = dice.pick((0.0, dice.uniform(-0.5, 0.5)))
    outline = box(wide, high)
    first = (c * speed, s * speed, dice.pick((0.0, 0.0, dice.uniform(-20.0, 20.0))) if above else 0.0)
    bodies = [floor, free("a", outline, on_floor(0.0, 0.5 * high + above), 0.05, tilt, first)]
    if dice.chance(0.6):
        second = dice.pick(("stacked", "beside", "ball"))
        mass = dice.pick((0.05, dice.log(0.01, 0.2)))
        if second == "stacked":
            place = on_floor(dice.uniform(-0.3, 0.3) * wide, 1.5 * high + above)
            bodies.append(free("b", outline, place, mass, tilt, first if dice.chance(0.5) else (0.0, 0.0, 0.0)))
        elif second == "beside":
            place = on_floor(wide + dice.pick((0.0, 1.0 * MM, 5.0 * MM)), 0.5 * high)
            bodies.append(free("b", outline, place, mass, tilt))
        else:
            r = dice.uniform(2.0, 6.0) * MM
            bodies.append(free("b", circle(r), on_floor(wide, r), mass, 0.0, (-dice.uniform(0.0, 0.5), 0.0, 0.0)))
    return scene(dice, "blocks", bodies, 0.15, gravity=True)


def boxed(dice: Dice) -> Scene:
    """One or two bodies thrown about between walls."""
    side, wall = 40.0 * MM, 4.0 * MM
    walls = [
        box(side + 2.0 * wall, wall, (0.0, -0.5 * (side + wall))),
        box(wall, side, (-0.5 * (side + wall), 0.0)),
        box(wall, side, (0.5 * (side + wall), 0.0)),
    ]
    bodies = [fixed("floor", walls[0]), fixed("left", walls[1]), fixed("right", walls[2])]
    for k, x in enumerate((-9.0 * MM, 9.0 * MM)[: dice.number(1, 2)]):
        outline = circle(dice.uniform(3.0, 7.0) * MM) if dice.chance(0.3) else ragged(dice, 8.0 * MM, dice.number(3, 6))
        velocity = (dice.uniform(-0.5, 0.5), dice.uniform(-0.5, 0.1), dice.uniform(-30.0, 30.0))
        bodies.append(free(f"m{k}", outline, (x, dice.uniform(-5.0, 8.0) * MM), 0.02, dice.uniform(0.0, 6.0), velocity))
    return scene(dice, "boxed", bodies, 0.12, gravity=dice.chance(0.8))


def crowd(dice: Dice) -> Scene:
    """Eight to forty bodies fall into a box that is open above: discs, discs all alike, polygons, or both."""
    count, kind = dice.number(8, 40), dice.pick(("disc", "alike", "polygon", "mixed"))
    columns, pitch, wall = math.ceil(math.sqrt(count)), 10.0 * MM, 4.0 * MM
    side, alike = columns * pitch + dice.uniform(0.0, 5.0) * MM, dice.uniform(2.0, 4.9) * MM
    bodies = [
        fixed("floor", box(side + 2.0 * wall, wall, (0.0, -0.5 * wall))),
        fixed("left", box(wall, 2.0 * side, (-0.5 * (side + wall), side))),
        fixed("right", box(wall, 2.0 * side, (0.5 * (side + wall), side))),
    ]
    for k in range(count):
        radius = alike if kind == "alike" else dice.uniform(1.5, 4.9) * MM
        is_round = kind in ("disc", "alike") or (kind == "mixed" and dice.chance(0.5))
        outline = circle(radius) if is_round else ragged(dice, min(radius, 4.8 * MM), dice.number(3, 6))
        place = ((k % columns - 0.5 * (columns - 1)) * pitch, (k // columns + 0.5) * pitch)
        velocity = (dice.uniform(-0.5, 0.5), dice.uniform(-0.5, 0.1), dice.uniform(-30.0, 30.0))
        mass = 0.02 if kind == "alike" else dice.log(0.005, 0.05)
        bodies.append(free(f"m{k}", outline, place, mass, dice.uniform(0.0, 6.0), velocity))
    return scene(dice, "crowd", bodies, 0.3, gravity=True)


def wedge(dice: Dice) -> Scene:
    """A sliding wedge lifts a plunger, or a block slides between guides."""
    slope = dice.pick((dice.uniform(0.05, 1.2), dice.log(1e-6, 1e-1)))
    long = 30.0 * MM
    lifter = polygon([(0.0, -2.0 * MM), (long, -2.0 * MM), (long, long * math.tan(slope)), (0.0, 0.0)])
    mass = dice.log(0.01, 0.3)
    flat = dice.chance(0.5)
    foot = box(6.0 * MM, 6.0 * MM, (0.0, 3.0 * MM)) if dice.chance(0.5) else circle(3.0 * MM, (0.0, 3.0 * MM))
    angle = slope if flat else 0.0
    speed = -dice.uniform(0.0, 0.5)
    start = (-3.5 * MM, dice.uniform(-1.0, 2.0) * MM)
    bodies = [
        sliding("wedge", lifter, (0.0, 0.0), 0.0, speed, dice.log(0.01, 0.3)),
        sliding("plunger", foot, start, 0.5 * math.pi, 0.0, mass, angle),
    ]
    if dice.chance(0.5):
        bodies.append(fixed("stop", box(5.0 * MM, 30.0 * MM), position=(-40.0 * MM, 0.0)))
    torques = (Torque("wedge", -dice.log(0.03, 3.0)), Torque("plunger", -dice.log(0.03, 3.0)))
    springs = (Spring("plunger", dice.log(1.0, 300.0)),) if dice.chance(0.3) else ()
    return scene(dice, "wedge", bodies, 0.15, torques=torques, springs=springs)


def pressed(dice: Dice) -> Scene:
    """A pivoted flap falls flat on a sliding bar: parallel faces, or nearly."""
    long, thick = dice.uniform(10.0, 30.0) * MM, 2.0 * MM
    skew = dice.pick((0.0, dice.kink(0.1)))
    rise = skew * long if abs(skew) > 1e-9 else 0.0
    flap = polygon([(1.0 * MM, 0.0), (long, rise), (long, max(thick, rise + 0.5 * thick)), (1.0 * MM, thick)])
    bar = box(100.0 * MM, 5.0 * MM, (0.0, -2.5 * MM))
    bodies = [
        sliding("bar", bar, (0.0, 0.0), 0.0, dice.uniform(-0.5, 0.5), dice.log(0.01, 0.3)),
        pivoted("flap", flap, (0.0, dice.pick((0.0, 0.0, 0.5 * MM))), dice.uniform(0.1, 0.5), 0.0, mass=dice.log(0.01, 0.1)),
    ]
    torques = (Torque("flap", -dice.log(1e-4, 1e-2)), Torque("bar", dice.sign() * dice.log(1e-2, 1.0)))
    return scene(dice, "pressed", bodies, 0.1, gravity=True, torques=torques)


# Which mechanism has number k of a seed?

FAMILIES: dict[str, tuple[Callable[[Dice], Scene], int]] = {  # with their weights
    "blade": (blade, 10),
    "cam": (cam, 9),
    "gears": (gears, 4),
    "ratchet": (ratchet, 6),
    "geneva": (geneva, 5),
    "anchor": (anchor, 6),
    "pendulums": (pendulums, 9),
    "levers": (levers, 10),
    "kink": (kink, 10),
    "wave": (wave, 7),
    "row": (row, 9),
    "blocks": (blocks, 8),
    "boxed": (boxed, 5),
    "wedge": (wedge, 6),
    "pressed": (pressed, 6),
    "crowd": (crowd, 0),  # only by name: a run takes longer than all of another mechanism
}
ATTEMPTS = 200
TURNS = 30.0  # of what nothing stops: a body that misses what it should meet turns ever faster


def mechanism(seed: int, number: int, family: str | None = None) -> Scene:
    """Begins with all bodies apart or just touching; what overlaps at the start is thrown again."""
    dice = Dice(seed, number)
    names = [family] if family else [name for name, (_, weight) in FAMILIES.items() for _ in range(weight)]
    for _ in range(ATTEMPTS):
        scene = FAMILIES[dice.pick(names)][0](dice)
        if apart(scene):
            return replace(scene, duration=min(scene.duration, *_runaway(scene)))
    raise RuntimeError(f"no start without overlap in {ATTEMPTS} attempts for number {number} of seed {seed}")


def _runaway(scene: Scene) -> list[float]:
    """The times (s) in which constant torques give their bodies so many turns from rest if nothing stops them."""
    found = [math.inf]
    for torque in scene.torques:
        body = scene.body(torque.body)
        if body.motion == "pivot" and torque.value != 0.0:
            found.append(math.sqrt(2.0 * TURNS * 2.0 * math.pi * body.inertia / abs(torque.value)))
    return found
