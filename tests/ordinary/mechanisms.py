"""Which small mechanisms touch in ways that depend on nothing but the laws of contact?

Lines of centres, kinks, equal masses, faces flat on flat, bodies in a row, axes that are parallel: whatever happens
there must not depend on how the mechanism lies in the plane.
"""

import dataclasses
import math
from collections.abc import Callable

from flat_cams import bar_for, kinked_scene
from gear_scenes import gear_scene
from simulation.moving_scenes import box, circle, ground, polygon, profile, touching

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line, Point
from watchsim.scene.forces import Damping, Spring, Torque
from watchsim.scene.scene import Body, Scene

TOLERANCE = 1e-11
G = (0.0, -9.81)


def blade() -> Scene:
    """A tooth pushes a radial blade past the line of centres."""
    wheel = polygon((0.0, 2.4e-3), (-0.3e-3, 1.8e-3), (-0.05e-3, 1.8e-3))
    vane = polygon((0.0, -1.08e-3), (0.1e-3, -1.08e-3), (0.1e-3, -0.6e-3), (0.0, -0.6e-3))
    bodies = (
        Body("wheel", angle=math.radians(8.0), inertia=5e-12, loops=(wheel,)),
        Body("balance", position=(0.0, 3.372e-3), angle=math.radians(-5.0), velocity=(52.36,), inertia=1.2e-9, loops=(vane,)),
    )
    contacts = touching("wheel", "balance", friction=0.12)
    return Scene("blade", bodies, torques=(Torque("wheel", -1e-5),), contacts=contacts, duration=0.005)


def fine_kink() -> Scene:
    return kinked_scene(bar_for(1e-4, False, 0.1, 0.2), 0.12, TOLERANCE)


def coarse_kink() -> Scene:
    return kinked_scene(bar_for(0.05, False, 0.1, 0.0), 0.15, TOLERANCE)


def convex_kink() -> Scene:
    return kinked_scene(bar_for(0.1, True, 0.1, 0.0), 0.05, TOLERANCE)


def _pendulum(name: str, x: float, angle: float) -> Body:
    mass, length, bob = 0.1, 0.3, 0.02
    inertia = mass * (length**2 + 0.5 * bob**2)
    return Body(
        name,
        position=(x, 0.0),
        angle=angle,
        mass=mass,
        inertia=inertia,
        centre_of_mass=(0.0, -length),
        loops=(circle(bob, (0.0, -length)),),
    )


def pendulums(friction: float, restitution: float, duration: float) -> Scene:
    """Equal ones that meet where both hang straight down."""
    bodies = (_pendulum("a", 0.0, -1.0), _pendulum("b", 0.04, 0.0))
    return Scene(
        "pendulums",
        bodies,
        contacts=touching("a", "b", friction=friction, restitution=restitution),
        gravity=G,
        duration=duration,
    )


def cradle() -> Scene:
    """Newton's cradle of four, apart by a tenth of a millimetre, without loss."""
    bodies = tuple(_pendulum(f"p{i}", 0.0401 * i, -0.5 if i == 0 else 0.0) for i in range(4))
    contacts = sum((touching(f"p{i}", f"p{i + 1}", restitution=1.0) for i in range(3)), ())
    return Scene("cradle", bodies, contacts=contacts, gravity=G, duration=0.8)


def gears() -> Scene:
    return dataclasses.replace(gear_scene(2, 0.1), duration=0.02)


def geneva() -> Scene:
    """A pin enters a slot, turns the slotted wheel by a quarter and leaves, restitution 0."""
    r, c, play = 10e-3, 10e-3 * math.sqrt(2.0), 0.01e-3
    half, depth = 1.5e-3 + play, c - r - 2e-3
    arm = 9.8e-3
    quarter = [(arm, half), (depth, half), (depth, -half), (arm, -half)]
    points: list[Point] = []
    for k in range(4):
        a = -0.5 * math.pi * k
        points += [(x * math.cos(a) - y * math.sin(a), x * math.sin(a) + y * math.cos(a)) for x, y in quarter]
    wheel = polygon(*points[::-1])
    bodies = (
        Body(
            "driver",
            position=(c, 0.0),
            angle=math.radians(131.0),
            velocity=(6.0,),
            inertia=1e-2,
            loops=(circle(1.5e-3, (r, 0.0)),),
        ),
        Body("wheel", angle=math.radians(45.0), inertia=2e-7, loops=(wheel,)),
    )
    contacts = touching("driver", "wheel", friction=0.1)
    return Scene("geneva", bodies, damping=(Damping("wheel", 1e-5),), contacts=contacts, duration=0.25)


def ratchet() -> Scene:
    """A click under a spring drops over the teeth of a driven wheel."""
    points = []
    for k in range(12):
        a = 2.0 * math.pi * k / 12
        points += [(3e-3 * math.cos(a), 3e-3 * math.sin(a)), (2.5e-3 * math.cos(a + 0.05), 2.5e-3 * math.sin(a + 0.05))]
    click = polygon((-4e-3, 0.3e-3), (-4e-3, -0.6e-3), (-3.8e-3, 0.0), (0.0, 0.0), (0.0, 0.3e-3))
    bodies = (
        Body("wheel", inertia=5e-9, velocity=(-5.0,), loops=(polygon(*points),)),
        Body("click", position=(4.5e-3, 3.6e-3), angle=0.02, inertia=2e-10, loops=(click,)),
    )
    contacts = touching("wheel", "click", friction=0.15, restitution=0.2)
    return Scene(
        "ratchet",
        bodies,
        springs=(Spring("click", 1e-5, 0.8),),
        torques=(Torque("wheel", -2e-5),),
        contacts=contacts,
        duration=0.04,
    )


def rocking_block() -> Scene:
    """A block rocks from edge to edge until it stands."""
    w, h, tilt, mass = 10e-3, 20e-3, 0.12, 5e-3
    foot = (0.5 * w, -0.5 * h)
    c, s = math.cos(tilt), math.sin(tilt)
    y = -(s * -foot[0] + c * foot[1])
    block = Body("block", "free", (0.0, y), tilt, mass=mass, inertia=mass * (w * w + h * h) / 12.0, loops=(box(w, h),))
    contacts = touching("block", "ground", friction=0.6)
    return Scene("rocking block", (ground(0.2), block), contacts=contacts, gravity=G, duration=0.5)


def wedge() -> Scene:
    """A wedge driven under a plunger: faces flat on flat."""
    slope = math.tan(0.25)
    below = polygon((-10e-3, 0.0), (10e-3, 0.0), (10e-3, 20e-3 * slope))
    above = polygon((-2e-3, -2e-3 * slope), (2e-3, 2e-3 * slope), (2e-3, 4e-3), (-2e-3, 4e-3))
    bodies = (
        Body("wedge", "slide", (0.0, 0.0), axis=(1.0, 0.0), velocity=(-0.05,), mass=0.02, loops=(below,)),
        Body("plunger", "slide", (0.0, 10e-3 * slope), axis=(0.0, 1.0), mass=0.01, loops=(above,)),
    )
    contacts = touching("wedge", "plunger", friction=0.1)
    torques = (Torque("wedge", -0.1), Torque("plunger", -0.1))
    return Scene("wedge", bodies, torques=torques, contacts=contacts, duration=0.05)


def cam() -> Scene:
    """An eccentric of twelve arcs under a flat follower on a spring."""
    step = 2.0 * math.pi / 12
    round_ = Loop(tuple(Arc(0.4e-3, 0.0, 1.5e-3, i * step, step) for i in range(12)))
    height = 1.5e-3
    bodies = (
        Body("cam", angle=0.0, inertia=2e-8, velocity=(20.0,), loops=(round_,)),
        Body(
            "follower",
            "slide",
            (0.0, height),
            axis=(0.0, 1.0),
            velocity=(8e-3,),
            mass=1e-4,
            loops=(box(4e-3, 0.6e-3, (0.0, 0.3e-3)),),
        ),
    )
    contacts = touching("cam", "follower", friction=0.1, restitution=0.3)
    springs = (Spring("follower", 5.0, -2e-3),)
    return Scene("cam", bodies, springs=springs, torques=(Torque("cam", 1e-5),), contacts=contacts, duration=0.2)


def tilted_bars() -> Scene:
    """Two bars on one axis meet on tilted faces: in the coordinates normal and friction force are parallel."""
    left = polygon((-5e-3, -2e-3), (0.0, -2e-3), (2e-3, 2e-3), (-5e-3, 2e-3))
    right = polygon((0.0, -2e-3), (6e-3, -2e-3), (6e-3, 2e-3), (2e-3, 2e-3))
    bodies = (
        Body("left", "slide", (-1e-3, 0.0), axis=(1.0, 0.0), velocity=(0.3,), mass=0.01, loops=(left,)),
        Body("right", "slide", (0.0, 0.0), axis=(1.0, 0.0), velocity=(-0.1,), mass=0.02, loops=(right,)),
    )
    return Scene("tilted bars", bodies, contacts=touching("left", "right", friction=0.3, restitution=0.5), duration=0.02)


def parallel_discs() -> Scene:
    """Two discs on parallel slides: rank one, with friction."""
    bodies = (
        Body("a", "slide", (0.0, 0.0), axis=(1.0, 0.0), velocity=(0.5,), mass=0.01, loops=(circle(5e-3),)),
        Body("b", "slide", (12e-3, 1e-3), axis=(1.0, 0.0), velocity=(-0.2,), mass=0.015, loops=(circle(5e-3),)),
    )
    return Scene("parallel discs", bodies, contacts=touching("a", "b", friction=0.1, restitution=0.5), duration=0.02)


def row() -> Scene:
    """Three equal discs in a row, restitution 0: the first pushes the second on the third."""
    bodies = tuple(
        Body(
            f"d{i}",
            "free",
            (11e-3 * i, 0.0),
            velocity=(0.4 if i == 0 else 0.0, 0.0, 0.0),
            mass=0.01,
            inertia=1.25e-7,
            loops=(circle(5e-3),),
        )
        for i in range(3)
    )
    contacts = touching("d0", "d1", friction=0.2) + touching("d1", "d2", friction=0.2)
    return Scene("row", bodies, contacts=contacts, duration=0.02)


def head_on() -> Scene:
    """Two discs meet head-on, restitution 0: they travel on together and touch without force."""
    masses = (0.0942, 0.0107)
    bodies = tuple(
        Body(
            f"d{i}",
            "free",
            (15e-3 * i, 0.0),
            velocity=(0.9 - 1.8 * i, 0.0, 0.0),
            mass=m,
            inertia=1.25e-5 * m,
            loops=(circle(5e-3),),
        )
        for i, m in enumerate(masses)
    )
    return Scene("head-on", bodies, contacts=touching("d0", "d1"), duration=0.02)


def yoke() -> Scene:
    """A crank's pin in the slot of a slide, with play."""
    half = 1.01e-3
    left, right = box(1e-3, 14e-3, (-half - 0.5e-3, 0.0)), box(1e-3, 14e-3, (half + 0.5e-3, 0.0))
    bodies = (
        Body("crank", angle=0.3, velocity=(10.0,), inertia=1e-7, loops=(circle(1e-3, (5e-3, 0.0)),)),
        Body("yoke", "slide", (5e-3 * math.cos(0.3), 0.0), axis=(1.0, 0.0), mass=1e-3, loops=(left, right)),
    )
    contacts = touching("crank", "yoke", friction=0.1, restitution=0.1)
    return Scene("yoke", bodies, damping=(Damping("yoke", 0.01),), contacts=contacts, duration=0.4)


def banked_lever() -> Scene:
    """A lever thrown from one banking pin to the other comes to rest there."""
    pins = tuple(circle(0.3e-3, (4e-3, side * 1.2e-3)) for side in (1.0, -1.0))
    lever = box(6e-3, 0.8e-3, (2e-3, 0.0))
    bodies = (Body("pins", "fixed", loops=pins), Body("lever", velocity=(30.0,), inertia=7e-11, loops=(lever,)))
    contacts = touching("lever", "pins", friction=0.1, restitution=0.4)
    return Scene("banked lever", bodies, torques=(Torque("lever", -2e-6),), contacts=contacts, duration=0.05)


def sliding_block() -> Scene:
    """A block flat on a slope speeds up against friction."""
    mass, angle = 5e-3, 0.5
    block = Body("block", "free", (0.0, 5e-3), mass=mass, inertia=mass * 500e-6 / 12.0, loops=(box(20e-3, 10e-3),))
    gravity = (9.81 * math.sin(angle), -9.81 * math.cos(angle))
    return Scene(
        "sliding block", (ground(0.5), block), contacts=touching("block", "ground", friction=0.3), gravity=gravity, duration=0.2
    )


def groove() -> Scene:
    """A disc drops into a groove and comes to rest between its flanks."""
    sides = Loop((Line(50e-3, 50e-3, 0.0, 0.0), Line(0.0, 0.0, -50e-3, 50e-3)), closed=False)
    disc = Body("disc", "free", (1e-3, 12e-3), velocity=(0.0, 0.0, 5.0), mass=0.01, inertia=1.25e-7, loops=(circle(5e-3),))
    contacts = touching("disc", "groove", friction=0.2, restitution=0.3)
    return Scene("groove", (Body("groove", "fixed", loops=(sides,)), disc), contacts=contacts, gravity=G, duration=0.15)


def lever_escapement() -> Scene:
    """The Swiss lever for two beats."""
    return dataclasses.replace(profile("swiss_lever"), duration=0.3)


MECHANISMS: dict[str, Callable[[], Scene]] = {
    "blade past the line of centres": blade,
    "follower, concave kink of 1e-4": fine_kink,
    "follower, concave kink of 0.05": coarse_kink,
    "follower, convex kink of 0.1": convex_kink,
    "equal pendulums, plastic": lambda: pendulums(0.0, 0.0, 2.0),
    "equal pendulums, friction": lambda: pendulums(0.3, 0.5, 0.8),
    "Newton's cradle": cradle,
    "Geneva drive": geneva,
    "ratchet": ratchet,
    "rocking block": rocking_block,
    "wedge, flat on flat": wedge,
    "cam of twelve arcs": cam,
    "bars with tilted faces": tilted_bars,
    "discs on parallel slides": parallel_discs,
    "three discs in a row": row,
    "two discs head-on, plastic": head_on,
    "pin in a slot": yoke,
    "lever on banking pins": banked_lever,
    "block flat on a slope": sliding_block,
    "disc in a groove": groove,
    "gears, two arcs a flank": gears,
    "Swiss lever": lever_escapement,
}


def mechanism(name: str) -> Scene:
    """The scene of that name, at a tight tolerance."""
    return dataclasses.replace(MECHANISMS[name](), tolerance=TOLERANCE)
