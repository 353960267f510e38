"""What happens at the very edge of contact: a graze by a nanometre, a corner met within a nanometre, a start in touch?"""

from __future__ import annotations

import math

import numpy as np

from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.verification.benchmarks import Benchmark, Check, counted
from watchsim.verification.simple_shapes import box, circle, ground, polygon, shaped

GRAVITY = 9.81
EXTENT = 4e-11  # m: `Options.extent` of outlines as large as the tooth
NANOMETRES = (1.0, 0.1, 0.01, 0.001, -0.001, -0.01, -0.1, -1.0)


def edge_cases() -> list[Benchmark]:
    """Grazes and corners from +1 nm to -1 nm, and starts in exact contact on one to six contacts."""
    return [*(graze(nm) for nm in NANOMETRES), *(corner(nm) for nm in (0.0, *NANOMETRES)), *(standing(k) for k in range(1, 7))]


def graze(nanometres: float) -> Benchmark:
    """A pin flies past a round post; at its nearest the gap would be so much.

    Where it is negative, -s, they touch a time sqrt(2 R s)/v before the middle (s far below R, the distance of the centres),
    and approach with v sqrt(2 s/R), which the impact takes away. The gap is the difference of lengths of 2 mm, whose rounding
    counts where s is a picometre.
    """
    speed, radius, pin = 0.1, 1e-3, 5e-4
    clearance, reach = 1e-9 * nanometres, radius + pin
    body = Body("pin", "free", (-2e-3, reach + clearance), velocity=(speed, 0.0, 0.0), mass=1e-3, inertia=1e-10)
    post = Body("post", "fixed", loops=(circle(radius),))
    scene = Scene("graze", (shaped(body, circle(pin)), post), contacts=(Contact((Side("pin"), Side("post"))),), duration=0.04)
    touches = nanometres < 0.0
    checks = [Check("impacts", float(touches), lambda run: float(counted(run, EventKind.IMPACT)), 0.0)]
    if touches:
        approach = -speed * math.sqrt(-2.0 * clearance / reach)
        checks.append(Check("approach [m/s]", approach, lambda run: float(_impact(run, "value")), 1e-3))
        when = 0.02 - math.sqrt(-2.0 * reach * clearance) / speed
        checks.append(Check("time of the touch [s]", when, lambda run: float(_impact(run, "t")), 1e-7))
    else:
        checks.append(Check("height at the end [m]", reach + clearance, lambda run: float(run.q[-1, 1]), 0.0))
    checks.append(Check("nearest to the post, below touching [m]", 0.0, lambda run: max(0.0, reach - _nearest(run)), 1e-15))
    return Benchmark(f"graze, gap {nanometres:+g} nm", scene, tuple(checks), "two circles and a straight line")


def _impact(run: Trajectory, column: str) -> float:
    found = run.events[run.events["kind"] == EventKind.IMPACT]
    return float(found[column][0]) if len(found) else math.nan


def _nearest(run: Trajectory) -> float:
    return float(np.hypot(run.q[:, 0], run.q[:, 1]).min())


def corner(nanometres: float) -> Benchmark:
    """A tooth slides diagonally at the corner of a block, so far to its right: it meets one neighbour.

    It misses the other one by as much and stops so far beyond the corner's place, unless it is nearer to it than contacts reach
    beyond the ends of their primitives (`Options.extent`): then the first of the two may count.
    """
    aside, start, c = 1e-9 * nanometres, 1e-3, math.sqrt(0.5)
    place = (start + c * aside, start - c * aside)
    tooth = Body("tooth", "slide", place, axis=(-c, -c), velocity=(0.05,), mass=1e-4)
    shape = polygon((0.0, 0.0), (4e-4, 2e-4), (4e-4, 6e-4), (2e-4, 4e-4))
    block = Body("block", "fixed", loops=(polygon((-2e-3, -2e-3), (0.0, -2e-3), (0.0, 0.0), (-2e-3, 0.0)),))
    scene = Scene("corner", (shaped(tooth, shape), block), contacts=(Contact((Side("tooth"), Side("block"))),), duration=0.05)
    way = math.sqrt(2.0) * start + abs(aside)
    allowed = 1e-15 + 3.0 * min(abs(aside), EXTENT)
    checks = (
        Check("faces met", 1.0, _faces, 0.0),
        Check("way until it stops [m]", way, lambda run: float(run.q[-1, 0]), allowed / way),
        Check("speed left [m/s]", 0.0, lambda run: float(run.u[-1, 0]), 1e-12),
    )
    return Benchmark(f"tooth at a corner, {nanometres:+g} nm aside", scene, checks, "geometry of the corner")


def _faces(run: Trajectory) -> float:
    """Number of different edges of the block with an impact."""
    found = run.events[run.events["kind"] == EventKind.IMPACT]
    return float(len({(run.pairs[k].primitive_b, run.pairs[k].index_b) for k in found["contact"]}))


def standing(count: int) -> Benchmark:
    """Blocks and discs at rest on one another and on the ground with exactly that many contacts: nothing happens."""
    side, radius = 0.05, 0.02

    def block(name: str, layer: int) -> Body:
        body = Body(name, "free", (0.0, (2 * layer + 1) * side), mass=0.1, inertia=1e-4)
        return shaped(body, box((1.0 - 0.2 * layer) * side, side))

    def disc(name: str, x: float, y: float) -> Body:
        return shaped(Body(name, "free", (x, y), mass=0.1, inertia=0.05 * radius**2), circle(radius))

    blocks = [block(f"block{layer}", layer) for layer in range(count // 2)]
    pairs = [(one.name, blocks[k - 1].name if k else "ground") for k, one in enumerate(blocks)]
    bodies = list(blocks)
    if count % 2:
        bodies.append(disc("disc", side + 2.0 * radius, radius))
        pairs.append(("disc", "ground"))
    contacts = tuple(Contact((Side(one), Side(other)), 0.4, 0.5) for one, other in pairs)
    scene = Scene("standing", (*bodies, ground()), contacts=contacts, gravity=(0.0, -GRAVITY), duration=1.0)
    checks = (
        Check("impacts", 0.0, lambda run: float(counted(run, EventKind.IMPACT)), 0.0),
        Check("contacts found", float(count), lambda run: float(counted(run, EventKind.CLOSE)), 0.0),
        Check("largest way in a second [m]", 0.0, lambda run: float(np.abs(run.q[-1] - run.q[0]).max()), 1e-12),
    )
    return Benchmark(f"start at rest on {count} contacts", scene, checks, "statics")
