"""How is a cam drawn as arcs or chords, and how far is its motion from that of the curve?"""

import math
from dataclasses import dataclass

import numpy as np
from gear_scenes import through
from reference.flat_cam import Curve, FlatCam, end_state, point
from reference.kinked_bar import Bar, Motion, motion, obeys_laws

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.forces import Contact, Side, Spring, Torque
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop

DURATION = 0.25  # s: about a turn
PHASE = 0.1234  # rad: no joint at a symmetric place


def drawn(curve: Curve, count: int, chords: bool) -> Loop:
    """The curve as `count` arcs through three points each, or as chords."""
    points = [np.array(point(curve, PHASE + math.pi * i / count)) for i in range(2 * count)]
    points.append(points[0])
    if chords:
        return Loop(tuple(Line(*points[i].tolist(), *points[i + 2].tolist()) for i in range(0, 2 * count, 2)))
    return Loop(tuple(through(*points[i : i + 3]) for i in range(0, 2 * count, 2)))


def top(loop: Loop, angle: float) -> float:
    """The height of the outline turned by `angle`: where a flat face comes to stand."""
    best = -math.inf
    for edge in loop.edges:
        for x, y in (edge.start, edge.end):
            best = max(best, x * math.sin(angle) + y * math.cos(angle))
        if not isinstance(edge, Line):
            up = (0.5 * math.pi - angle - edge.start_angle) % (2.0 * math.pi)
            if up < edge.sweep:
                best = max(best, edge.x * math.sin(angle) + edge.y * math.cos(angle) + edge.radius)
    return best


def cam_scene(cam: FlatCam, count: int, chords: bool, restitution: float) -> Scene:
    """The cam turns under the flat face."""
    outline = drawn(cam.curve, count, chords)
    height, step = top(outline, cam.angle), 1e-7
    lift = (top(outline, cam.angle + step) - top(outline, cam.angle - step)) / (2.0 * step)
    w, h = 4e-3, 1e-3
    face = ((-w, 0.0), (w, 0.0), (w, h), (-w, h))
    box = Loop(tuple(Line(*a, *b) for a, b in zip(face, face[1:] + face[:1], strict=True)))
    bodies = (
        Body("cam", angle=cam.angle, velocity=(cam.speed,), inertia=cam.inertia, loops=(outline,)),
        Body("face", "slide", (0.0, height), axis=(0.0, 1.0), velocity=(lift * cam.speed,), mass=cam.mass, loops=(box,)),
    )
    return Scene(
        "cam",
        bodies,
        springs=(Spring("face", cam.stiffness, cam.rest - height),),
        torques=(Torque("cam", cam.torque),),
        contacts=(Contact((Side("face"), Side("cam")), 0.0, restitution),),
        duration=DURATION,
    )


@dataclass(frozen=True)
class Compared:
    """Errors of the cam's angle (rad) and speed (over itself) at the end; what it took."""

    angle: float
    speed: float
    passed: int  # edges of the outline passed
    events: int
    evaluations: int
    stop: str
    residual: float


def compared(cam: FlatCam, count: int, chords: bool, restitution: float = 0.0, tolerance: float = 1e-9) -> Compared:
    run = simulate(cam_scene(cam, count, chords, restitution), tolerance=tolerance)
    angle, speed = end_state(cam, DURATION)
    passed = max(1, round(count * float(run.end_q[0] - cam.angle) / (2.0 * math.pi)))
    found = abs(float(run.end_q[0]) - angle), abs(float(run.end_u[0]) / speed - 1.0)
    residual = float(run.energy["residual_relative"])
    return Compared(*found, passed, run.counts["events"], run.counts["gap_evaluations"], run.stop.name, residual)


# Which scenes show what happens at a kink, and how far is a run from what the laws say?

ANGLES = (*np.geomspace(1e-10, 0.1, 73).tolist(), *np.linspace(0.2, 0.5 * math.pi, 8).tolist())
RESTITUTIONS = (0.0, 0.1, 0.2, 0.5, 0.8)
FRICTIONS = (0.0, 0.1, 0.3)
TOLERANCES = (1e-12, 1e-11, 1e-9, 1e-7)
GENTLE = 0.15  # rad: up to here the follower is watched for LONG, beyond for BRIEF seconds after the kink
ENDED = 1e-6  # s, accumulation_time
TANGENT = 1e-4  # rad: concave joints below this, at most, are handed over as tangent (method 2.9)
LONG, BRIEF = 0.02, 0.002
CONVEX_TORQUE = -5e-3  # N·m: presses the follower on while it rolls round the corner
NEAR = 3e-3  # m: how soon the convex kink comes, before friction has stopped the bar
DEEP, HALF = 5e-3, 40e-3  # m, of the bar below and beside the kink


def bar_for(angle: float, convex: bool, friction: float, restitution: float) -> Bar:
    return Bar(-angle, friction, restitution, torque=CONVEX_TORQUE, ahead=NEAR) if convex else Bar(angle, friction, restitution)


def beyond(angle: float) -> float:
    return LONG if angle <= GENTLE else BRIEF


def kinked_scene(bar: Bar, duration: float, tolerance: float) -> Scene:
    """The bar as a polygon, the follower as a circle on an arm."""
    rise = HALF * math.tan(bar.kink) if abs(bar.kink) <= GENTLE else 0.0
    end = (HALF, rise) if rise else (2.0 * bar.radius * math.cos(bar.kink), 2.0 * bar.radius * math.sin(bar.kink))
    points = [(-HALF, -3.0 * DEEP), (HALF, -3.0 * DEEP), end, (0.0, 0.0), (-HALF, 0.0)]
    if bar.kink > GENTLE:
        points[2:3] = [(HALF, end[1]), end]
    elif bar.kink < -GENTLE:
        points[1:3] = [(end[0], -3.0 * DEEP), end] if end[0] > 1e-9 else [(0.0, -3.0 * DEEP)]
    outline = Loop(tuple(Line(*a, *b) for a, b in zip(points, points[1:] + points[:1], strict=True)))
    roller = Loop((Arc(bar.arm, 0.0, bar.radius, 0.0, 2.0 * math.pi),))
    return Scene(
        "kinked bar",
        (
            Body(
                "bar",
                "slide",
                (bar.ahead + bar.arm, 0.0),
                axis=(1.0, 0.0),
                velocity=(bar.speed,),
                mass=bar.mass,
                loops=(outline,),
            ),
            Body("follower", "pivot", (0.0, bar.radius), inertia=bar.inertia, loops=(roller,)),
        ),
        torques=(Torque("follower", bar.torque),),
        contacts=(Contact((Side("bar"), Side("follower")), bar.friction, bar.restitution),),
        duration=duration,
        tolerance=tolerance,
    )


def expected(angle: float, convex: bool, friction: float, restitution: float) -> Motion:
    """What the laws say."""
    return motion(bar_for(angle, convex, friction, restitution), beyond(angle))


def allowed(bar: Bar, tolerance: float) -> float:
    """What a run's speeds and places may be off, over the bar's speed and way.

    The tolerance; rebounds that would end within ENDED are ended at once (method 2.9), so that the bar misses what the pressed
    follower does to it in that time; a tangent joint is passed without the friction of its impact.
    """
    d = abs(bar.kink)
    slope = bar.friction + math.sin(d)
    ended = ENDED * abs(bar.torque) / bar.arm * slope / (bar.mass * abs(bar.speed)) if bar.restitution > 0.0 else 0.0
    passed = bar.inertia / bar.arm**2 / bar.mass * d * slope if 0.0 < bar.kink < TANGENT else 0.0
    return 1e-9 + 20.0 * tolerance + ended + passed


@dataclass(frozen=True)
class Off:
    """How far a run is off: speeds over the bar's, places over its way past the kink, energy over the kinetic energy."""

    speed: float
    place: float
    energy: float
    bad: str  # how it ended, where not well
    allowed: float

    @property
    def wrong(self) -> bool:
        return bool(self.bad) or not (max(self.speed, self.place) <= self.allowed and self.energy <= 1e-8)


def off(bar: Bar, truth: Motion, seconds: float, tolerance: float) -> Off:
    """The run at its end, or right after the impact at the kink where the truth ends there."""
    if truth.end is None:
        seconds = 1e-6
    run = simulate(kinked_scene(bar, truth.met + seconds, tolerance))
    if truth.end is None:
        row = int(np.searchsorted(run.t, truth.met * (1.0 + 1e-9) + 1e-12)) - 1
        exact, found = truth.after, np.concatenate([run.q[row], run.u[row]])
        if truth.is_open and obeys_laws(bar, truth.before, found):
            exact = found
    else:
        exact, found = truth.end, np.concatenate([run.end_q, run.end_u])
    apart = np.abs(found - exact) * [1.0, bar.arm, 1.0, bar.arm] / abs(bar.speed)
    bad = "" if run.stop == Stop.DURATION else run.stop.name
    bad += " overlap" if run.worst_overlap else ""
    energy = abs(run.energy["residual_J"]) / (0.5 * bar.mass * bar.speed**2)
    return Off(float(apart[2:].max()), float(apart[:2].max() / max(seconds, BRIEF)), energy, bad, allowed(bar, tolerance))
