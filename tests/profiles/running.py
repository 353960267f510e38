"""What must be true of every escapement, however long it runs, and what does time stepping say of it?"""

import math
from dataclasses import dataclass

import numpy as np
from shapely import affinity
from shapely.geometry import MultiPolygon, Polygon
from shapely.ops import unary_union

import watchsim as ws
from watchsim.geometry.primitives import Arc
from watchsim.simulation.trajectory import Trajectory


def of_profile(name: str, duration: float) -> Trajectory:
    return ws.simulate(ws.load(ws.profiles_dir() / name / "scene.toml"), duration=duration)


def stepping_errors(scene: ws.Scene, duration: float, steps: tuple[float, ...]) -> list[float]:
    """Largest difference of the half swings' amplitudes (°) by time stepping from those by events, for each step (s)."""
    true = ws.beats(ws.simulate(scene, duration=duration, tolerance=1e-11)).amplitude_deg
    found = [ws.beats(ws.simulate(scene, duration=duration, method="moreau", step=step)).amplitude_deg for step in steps]
    return [float(np.abs(one - true).max()) for one in found]


# What does a drive give an oscillator, by the outlines alone?
#
# The oscillator is led by hand through an impulse, the wheel follows until its polygon touches the other. The turn of the wheel
# by the turn of the oscillator is the torque on it by the drive, without friction and inertia (virtual work); Airy's integral
# over it is the rate. Shares with the simulation only the drawings, as polygons of SPLIT points per arc.

DAY = 86400.0
SPLIT = 400  # points on a full turn of an arc
STEP = math.radians(0.004)  # of the wheel, to look for the touch: as an impulse ends, what overlaps is thin
FINE = 1e-9


def polygon(scene: ws.Scene, body: str, layers: set[str]) -> MultiPolygon:
    """The material of those layers in the body's frame, in units of its own size."""
    found, holes = [], []
    for loop in scene.body(body).loops:
        if loop.layer in layers:
            points = []
            for edge in loop.edges:
                parts = max(2, int(SPLIT * abs(edge.sweep) / math.tau)) if isinstance(edge, Arc) else 1
                points += [edge.point(i / parts) for i in range(parts)]
            (holes if loop.hole else found).append(Polygon(points))
    return unary_union(found).difference(unary_union(holes)) if holes else unary_union(found)


@dataclass
class Led:
    """Wheel and oscillator; `way` is +1 where the drive turns the wheel counter-clockwise."""

    scene: ws.Scene
    oscillator: str
    wheel_layers: set[str]
    own_layers: set[str]
    way: float = -1.0

    def __post_init__(self) -> None:
        wheel, own = self.scene.body("wheel"), self.scene.body(self.oscillator)
        self.wheel = affinity.translate(polygon(self.scene, "wheel", self.wheel_layers), *wheel.position)
        self.other = affinity.translate(polygon(self.scene, self.oscillator, self.own_layers), *own.position)
        self.centre, self.pivot = tuple(wheel.position), tuple(own.position)
        near = self.other.buffer(math.dist(self.centre, self.pivot))
        assert near.intersects(self.wheel)

    def overlaps(self, other: Polygon, angle: float) -> bool:
        wheel = affinity.rotate(self.wheel, angle, origin=self.centre, use_radians=True)
        return bool(wheel.intersects(other))

    def follow(self, swung: float, wheel: float) -> float:
        """How far the wheel goes with its drive from `wheel`, or is pushed back, with the oscillator there; rad."""
        other = affinity.rotate(self.other, swung, origin=self.pivot, use_radians=True)
        step = -STEP if self.overlaps(other, self.way * wheel) else STEP
        free, touching = (wheel, wheel + STEP) if step > 0.0 else (wheel - STEP, wheel)
        while (step > 0.0) is not self.overlaps(other, self.way * (touching if step > 0.0 else free)):
            free, touching = free + step, touching + step
        while touching - free > FINE:
            middle = 0.5 * (free + touching)
            free, touching = (free, middle) if self.overlaps(other, self.way * middle) else (middle, touching)
        return free

    def impulse(self, begin: float, end: float, wheel: float, points: int = 81) -> tuple[np.ndarray, np.ndarray]:
        """Angles of the oscillator (rad) from begin to end, closer together there, and how far the wheel stands at each."""
        swung = begin + (end - begin) * np.sin(np.linspace(0.0, 0.5 * math.pi, points))
        gone = []
        for angle in swung:
            wheel = self.follow(float(angle), wheel)
            gone.append(wheel)
        return swung, np.array(gone)


def work_and_rate(
    impulses: list[tuple[np.ndarray, np.ndarray]], torque: float, stiffness: float, swing: float
) -> tuple[float, float]:
    """Work of the drive (J) in the impulses of an oscillation, and the rate (s/d) by Airy's formula.

    dω/ω = -(1 / 2π k A) times the integral of M sin φ over an oscillation, θ = A sin φ.
    """
    work, late = 0.0, 0.0
    for swung, gone in impulses:
        middle = 0.5 * (swung[1:] + swung[:-1])
        done = torque * np.diff(gone)  # the same for the wheel and the oscillator
        towards = math.copysign(1.0, swung[-1] - swung[0])
        work += float(done.sum())
        late += float((towards * done * middle / swing / np.sqrt(swing**2 - middle**2)).sum())
    return work, -DAY * late / (2.0 * math.pi * stiffness * swing)
