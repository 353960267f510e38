"""How is a pair of involute gears drawn with N arcs a flank, as a CAD program exports it?"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from reference.gear_friction import Train

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line
from watchsim.scene.forces import Contact, Damping, Side, Torque
from watchsim.scene.scene import Body, Scene

MODULE, PRESSURE = 0.2e-3, math.radians(20.0)
TEETH = (8, 30)  # pinion, wheel
DISTANCE = 3.82e-3  # with backlash
LOAD, DRIVE = 3e-8, 20e-6  # N·m·s/rad on the pinion, N·m on the wheel
Vector = NDArray[np.float64]


def _involute(x: float) -> float:
    return math.tan(x) - x


@dataclass(frozen=True)
class Gear:
    """An involute gear: teeth, profile shift, tip as a share of the module beyond 1 + shift, arcs a flank."""

    teeth: int
    shift: float
    arcs: int
    cut: float = 0.0  # modules taken off the tip

    @property
    def pitch(self) -> float:
        return 0.5 * MODULE * self.teeth

    @property
    def base(self) -> float:
        return self.pitch * math.cos(PRESSURE)

    @property
    def tip(self) -> float:
        return self.pitch + MODULE * (1.0 + self.shift - self.cut)

    @property
    def root(self) -> float:
        return self.pitch - MODULE * (1.25 - self.shift)

    def half_angle(self, radius: float) -> float:
        """Half of a tooth's thickness there, rad."""
        thick = MODULE * (0.5 * math.pi + 2.0 * self.shift * math.tan(PRESSURE))
        return thick / (2.0 * self.pitch) + _involute(PRESSURE) - _involute(math.acos(min(1.0, self.base / radius)))

    def radii(self) -> Vector:
        """Of the 2 arcs + 1 points of a flank, even in the roll angle."""
        inner = max(self.base, self.root)
        low, high = math.sqrt(max((inner / self.base) ** 2 - 1.0, 0.0)), math.sqrt((self.tip / self.base) ** 2 - 1.0)
        return self.base * np.sqrt(1.0 + np.linspace(low, high, 2 * self.arcs + 1) ** 2)


def through(p: Vector, q: Vector, r: Vector) -> Edge:
    """The arc from p through q to r; a line where they are in line."""
    (ax, ay), (cx, cy) = q - p, r - p
    twice = 2.0 * (ax * cy - ay * cx)
    if abs(twice) < 1e-12 * float(np.hypot(cx, cy)) ** 2:
        return Line(*p.tolist(), *r.tolist())
    a2, c2 = ax * ax + ay * ay, cx * cx + cy * cy
    x, y = (cy * a2 - ay * c2) / twice, (ax * c2 - cx * a2) / twice
    first, last = math.atan2(-y, -x), math.atan2(cy - y, cx - x)
    turn = (last - first) % (2.0 * math.pi)
    return Arc(float(p[0] + x), float(p[1] + y), math.hypot(x, y), first, turn if twice > 0.0 else turn - 2.0 * math.pi)


def outline(gear: Gear) -> Loop:
    """Tooth by tooth, counter-clockwise: root, radial line to the base circle, flank, tip, flank, radial line."""
    edges: list[Edge] = []
    radii, low = gear.radii(), max(gear.base, gear.root)
    for k in range(gear.teeth):
        c = 2.0 * math.pi * k / gear.teeth

        def at(radius: float, angle: float) -> Vector:
            return radius * np.array([math.cos(angle), math.sin(angle)])

        up = [at(r, c - gear.half_angle(r)) for r in radii]
        down = [at(r, c + gear.half_angle(r)) for r in reversed(radii)]
        half, top = gear.half_angle(low), gear.half_angle(gear.tip)
        if gear.base > gear.root:
            edges.append(Line(*at(gear.root, c - half).tolist(), *up[0].tolist()))
        edges += [through(*up[i : i + 3]) for i in range(0, 2 * gear.arcs, 2)]
        edges.append(Arc(0.0, 0.0, gear.tip, c - top, 2.0 * top))
        edges += [through(*down[i : i + 3]) for i in range(0, 2 * gear.arcs, 2)]
        if gear.base > gear.root:
            edges.append(Line(*down[-1].tolist(), *at(gear.root, c + half).tolist()))
        edges.append(Arc(0.0, 0.0, gear.root, c + half, 2.0 * math.pi / gear.teeth - 2.0 * half))
    return Loop(tuple(edges))


def gear_scene(arcs: int, friction: float, restitution: float = 0.2, cut: float = 0.0, damping: float = LOAD) -> Scene:
    """The wheel drives the pinion against a viscous load; `cut` shortens the teeth of both (modules)."""
    pinion, wheel = Gear(TEETH[0], 0.4, arcs, cut), Gear(TEETH[1], -0.4, arcs, cut)
    bodies = (
        Body("pinion", "pivot", (DISTANCE, 0.0), inertia=0.5e-10, loops=(outline(pinion),)),
        Body("wheel", "pivot", angle=math.radians(6.0), inertia=30e-10, loops=(outline(wheel),)),
    )
    return Scene(
        "gears",
        bodies,
        torques=(Torque("wheel", DRIVE),),
        damping=(Damping("pinion", damping),),
        contacts=(Contact((Side("pinion"), Side("wheel")), friction, restitution),),
        duration=1.0,
    )


def contact_ratio(cut: float = 0.0) -> float:
    """Pairs of teeth in contact on the average."""
    a, b = Gear(TEETH[0], 0.4, 1, cut), Gear(TEETH[1], -0.4, 1, cut)
    working = math.acos((a.base + b.base) / DISTANCE)
    path = sum(math.sqrt(g.tip**2 - g.base**2) for g in (a, b)) - DISTANCE * math.sin(working)
    return path / (math.pi * MODULE * math.cos(PRESSURE))


def train(friction: float, cut: float = 0.0) -> Train:
    """The same pair with exact involutes, for the reference."""
    pinion, wheel = Gear(TEETH[0], 0.4, 1, cut), Gear(TEETH[1], -0.4, 1, cut)
    pitch = math.pi * MODULE * math.cos(PRESSURE)
    return Train((wheel.base, pinion.base), (wheel.tip, pinion.tip), DISTANCE, pitch, (30e-10, 0.5e-10), DRIVE, LOAD, friction)
