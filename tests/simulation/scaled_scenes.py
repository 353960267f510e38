"""Scenes in which all lengths, times or masses are so many times as large, or which lie otherwise: the same mechanism."""

import dataclasses
import math

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Point
from watchsim.scene.forces import Damping, LineSpring, Spring, Torque
from watchsim.scene.scene import Body, Gear, Geared, Prescribed, Scene


def scaled(scene: Scene, length: float = 1.0, time: float = 1.0, mass: float = 1.0) -> Scene:
    """`scene` with all dimensions scaled alike. Its motion is the same but for these factors."""
    unit = _Units(scene, length, time, mass)
    gx, gy = scene.gravity
    return dataclasses.replace(
        scene,
        bodies=tuple(unit.body(body) for body in scene.bodies),
        springs=tuple(unit.spring(one) for one in scene.springs),
        torques=tuple(unit.torque(one) for one in scene.torques),
        damping=tuple(unit.damping(one) for one in scene.damping),
        line_springs=tuple(unit.line_spring(one) for one in scene.line_springs),
        gears=tuple(unit.gear(one) for one in scene.gears),
        gravity=(gx * length / time**2, gy * length / time**2),
        duration=scene.duration * time,
        nominal=None if scene.nominal is None else scene.nominal / time,
        record=dataclasses.replace(scene.record, windows=tuple((a * time, b * time) for a, b in scene.record.windows)),
        tolerances=(),
        expect=(),
        path=None,
        reader=None,
        written=None,
    )


class _Units:
    """The factors of a scene's numbers."""

    def __init__(self, scene: Scene, length: float, time: float, mass: float) -> None:
        self.scene, self.length, self.time, self.mass = scene, length, time, mass

    def way(self, body: str) -> float:
        """Of the coordinate of a body that turns or slides."""
        return self.length if self.scene.body(body).motion == "slide" else 1.0

    def load(self, body: str) -> float:
        """Of a torque or force on it: what makes a power of it with its speed."""
        return self.mass * self.length**2 / self.time**2 / self.way(body)

    def edge(self, edge: Edge) -> Edge:
        names = ("x", "y", "radius") if isinstance(edge, Arc) else ("x0", "y0", "x1", "y1")
        return dataclasses.replace(edge, **{name: self.length * getattr(edge, name) for name in names})

    def loop(self, loop: Loop) -> Loop:
        return dataclasses.replace(loop, edges=tuple(self.edge(edge) for edge in loop.edges))

    def body(self, body: Body) -> Body:
        free, way = body.motion == "free", self.way(body.name)
        speeds = (self.length, self.length, 1.0) if free else (way,)
        solids = tuple(
            dataclasses.replace(
                one,
                weight=dataclasses.replace(
                    one.weight,
                    mass=self.mass * one.weight.mass,
                    centre=(self.length * one.weight.centre[0], self.length * one.weight.centre[1]),
                    inertia=self.mass * self.length**2 * one.weight.inertia,
                ),
                loops=tuple(self.loop(loop) for loop in one.loops),
            )
            for one in body.solids
        )
        return dataclasses.replace(
            body,
            position=(self.length * body.position[0], self.length * body.position[1]),
            velocity=tuple(one * speed / self.time for one, speed in zip(body.velocity, speeds, strict=False)),
            mass=self.mass * body.mass,
            inertia=self.mass * self.length**2 * body.inertia,
            centre_of_mass=(self.length * body.centre_of_mass[0], self.length * body.centre_of_mass[1]),
            loops=tuple(self.loop(loop) for loop in body.loops),
            decoration=(),
            solids=solids,
            prescribed=None if body.prescribed is None else self.prescribed(body.prescribed, way),
            geared=None if body.geared is None else self.geared(body.name, body.geared),
        )

    def prescribed(self, law: Prescribed, way: float) -> Prescribed:
        table = tuple((self.time * t, way / self.time**2 * a) for t, a in law.table)
        return Prescribed(law.square / self.time**2, way * law.middle, table)

    def geared(self, name: str, one: Geared) -> Geared:
        return Geared(one.to, one.ratio * self.way(name) / self.way(one.to))

    def gear(self, one: Gear) -> Gear:
        first, second = one.between
        ratio = one.ratio * self.way(second) / self.way(first)
        return dataclasses.replace(one, ratio=ratio, backlash=one.backlash * self.way(second))

    def spring(self, one: Spring) -> Spring:
        load, way = self.load(one.body), self.way(one.body)
        stop = None if one.stop is None else way * one.stop
        frequency = None if one.frequency is None else one.frequency / self.time
        return dataclasses.replace(
            one, stiffness=load / way * one.stiffness, rest=way * one.rest, stop=stop, frequency=frequency, coil=None
        )

    def line_spring(self, one: LineSpring) -> LineSpring:
        (ax, ay), (bx, by) = one.points
        points = (self.length * ax, self.length * ay), (self.length * bx, self.length * by)
        stiffness = self.mass / self.time**2 * one.stiffness
        viscous = self.mass / self.time * one.viscous
        return LineSpring(one.between, points, stiffness, self.length * one.length, viscous)

    def torque(self, one: Torque) -> Torque:
        load, along = self.load(one.body), {"angle": self.way(one.body), "time": self.time}.get(one.over, 1.0)
        table = tuple((along * x, load * value) for x, value in one.table)
        period = None if one.period is None else self.time * one.period
        return dataclasses.replace(one, value=load * one.value, table=table, mainspring=None, period=period)

    def damping(self, one: Damping) -> Damping:
        load, speed = self.load(one.body), self.way(one.body) / self.time
        return dataclasses.replace(
            one, viscous=load / speed * one.viscous, quadratic=load / speed**2 * one.quadratic, coulomb=load * one.coulomb
        )


def lying(scene: Scene, angle: float) -> Scene:
    """The whole scene with its gravity turned by `angle` (rad): outlines in their frames, so that all angles are as before."""
    c, s = math.cos(angle), math.sin(angle)

    def image(point: Point) -> Point:
        return c * point[0] - s * point[1], s * point[0] + c * point[1]

    def body(one: Body) -> Body:
        loops = tuple(loop.moved(angle, (0.0, 0.0)) for loop in one.loops)
        velocity = (*image(one.velocity[:2]), *one.velocity[2:]) if len(one.velocity) == 3 else one.velocity
        places = {name: image(getattr(one, name)) for name in ("position", "axis", "centre_of_mass")}
        return dataclasses.replace(one, loops=loops, velocity=velocity, **places)

    bodies = tuple(body(one) for one in scene.bodies)
    lines = tuple(dataclasses.replace(one, points=tuple(image(point) for point in one.points)) for one in scene.line_springs)
    return dataclasses.replace(scene, bodies=bodies, gravity=image(scene.gravity), line_springs=lines, path=None, reader=None)
