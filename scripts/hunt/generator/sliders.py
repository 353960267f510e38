"""Which mechanisms slide or fly? Followers over kinks and waves, bodies in a row, blocks on floors, boxes."""

from __future__ import annotations

import math

from hunt.generator.parts import MM, Dice, fixed, free, pivoted, scene, sliding
from hunt.generator.shapes import box, circle, kinked_bar, polygon, ragged, wavy_bar
from watchsim.geometry.loops import Loop
from watchsim.scene.forces import Damping, Spring, Torque
from watchsim.scene.scene import Body, Scene


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
