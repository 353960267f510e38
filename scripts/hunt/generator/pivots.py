"""Which mechanisms turn about pivots? Blades, gears, ratchets, Geneva wheels, anchors, pendulums."""

from __future__ import annotations

import math

from hunt.generator.parts import MM, Dice, fixed, free, pivoted, scene
from hunt.generator.shapes import (
    box,
    cam_curve,
    circle,
    closed_curve,
    gear,
    polygon,
    ragged,
    ratchet_wheel,
    slotted_wheel,
    turned_points,
)
from watchsim.geometry.primitives import TURN
from watchsim.scene.forces import Damping, Spring, Torque
from watchsim.scene.scene import Scene


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
