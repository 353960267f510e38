"""Which motions are known exactly, so that pictures of them can be checked?"""

import math

import numpy as np

from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Line, Point
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.recording import Pair
from watchsim.simulation.state import EVENT_DTYPE, EventKind, Stop
from watchsim.simulation.trajectory import Trajectory

MM = 1e-3
TURN = 2.0 * math.pi
GRAVITY = 9.81


def circle(x: float, y: float, radius: float, layer: str, hole: bool = False) -> Loop:
    """Millimetres."""
    return Loop((Arc(x * MM, y * MM, radius * MM, 0.0, -TURN if hole else TURN),), layer, True, hole)


def polygon(points: list[Point], layer: str, closed: bool = True) -> Loop:
    """Millimetres, counter-clockwise."""
    corners = [(x * MM, y * MM) for x, y in points]
    ends = corners[1:] + corners[:1] if closed else corners[1:]
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, ends, strict=False)), layer, closed)


def watch_scene(**changes: object) -> Scene:
    """A ring-shaped wheel, a lever with a stone, a roller with a pin, two banking pins; the balance is 7 mm above the wheel."""
    wheel = Body("wheel", "pivot", inertia=1e-12, loops=(circle(0, 0, 2, "TEETH"), circle(0, 0, 1, "BORE", hole=True)))
    arm = polygon([(-0.2, -1.5), (0.2, -1.5), (0.2, 3), (-0.2, 3)], "ARMS")
    lever = Body("lever", "pivot", (0.0, 3 * MM), inertia=1e-12, loops=(arm, circle(1, -0.5, 0.3, "STONES")))
    balance = Body(
        "balance", "pivot", (0.0, 7 * MM), inertia=1e-9, loops=(circle(0, 0, 1, "ROLLER"), circle(0, -0.7, 0.15, "PIN"))
    )
    banking = Body("banking", "fixed", loops=(circle(-1, 5, 0.2, "PINS"), circle(1, 5, 0.2, "PINS")))
    scene = Scene("Three bodies that turn", (wheel, lever, balance, banking))
    return Scene(**{**scene.__dict__, **changes})


def watch_run(duration: float = 2.0, rows: int = 401, **changes: object) -> Trajectory:
    """Wheel at -2 rad/s, lever 0.1 sin(30 t), balance 5 cos(25 t); at half time the lever's velocity jumps by 4."""
    t = np.sort(np.append(np.linspace(0.0, duration, rows), 0.5 * duration))
    after = (t > 0.5 * duration) | (np.arange(len(t)) == np.flatnonzero(t == 0.5 * duration).max())
    since = np.where(after, t - 0.5 * duration, 0.0)
    q = np.column_stack((-2.0 * t, 0.1 * np.sin(30 * t) + 4.0 * since, 5.0 * np.cos(25 * t)))
    u = np.column_stack((np.full_like(t, -2.0), 3.0 * np.cos(30 * t) + 4.0 * after, -125.0 * np.sin(25 * t)))
    a = np.column_stack((np.zeros_like(t), -90.0 * np.sin(30 * t), -3125.0 * np.cos(25 * t)))
    events = np.array(
        [
            (0.25 * duration, EventKind.TURN, -1, 2, 0.0, 0.0, 0.0, -5.0),
            (0.5 * duration, EventKind.IMPACT, 0, -1, 2e-9, -3e-10, 4e-12, 0.0),
        ],
        dtype=EVENT_DTYPE,
    )
    pairs = (Pair(0, "lever", "corner", 3, "ARMS", "banking", "arc", 1, "PINS"),)
    slices = {"wheel": slice(0, 1), "lever": slice(1, 2), "balance": slice(2, 3)}
    return Trajectory(
        watch_scene(**changes), t, q, u, a, slices, events, pairs, Stop.DURATION, "done", duration, energy={"in_J": 1e-9}
    )


def disc_run(duration: float = 3.0) -> Trajectory:
    """A disc of 50 mm rolls down a plane of 20° that is drawn along x; gravity is turned instead."""
    pull = GRAVITY * math.sin(math.radians(20.0)) / 1.5
    disc = Body("disc", "free", (0.0, 0.05), mass=1.0, inertia=1.25e-3, loops=(circle(0, 0, 50, "circle"),))
    plane = Body("plane", "fixed", loops=(Loop((Line(20.0, 0.0, -1.0, 0.0),), "line", closed=False),))
    down = (GRAVITY * math.sin(math.radians(20.0)), -GRAVITY * math.cos(math.radians(20.0)))
    t = np.linspace(0.0, duration, 200)
    x, zero = 0.5 * pull * t * t, np.zeros_like(t)
    q = np.column_stack((x, zero + 0.05, -x / 0.05))
    u = np.column_stack((pull * t, zero, -pull * t / 0.05))
    a = np.column_stack((zero + pull, zero, zero - pull / 0.05))
    scene = Scene("Disc on an incline", (disc, plane), gravity=down)
    end = {"simulated": duration, "end_q": q[-1], "end_u": u[-1]}
    return Trajectory(scene, t, q, u, a, {"disc": slice(0, 3)}, np.zeros(0, EVENT_DTYPE), (), Stop.DURATION, **end)


def slide_run() -> Trajectory:
    """A slider that travels 2 mm · sin(10 t) along the diagonal, from (1, 1) mm, beside a body that never moves."""
    slider = Body(
        "slider", "slide", (1 * MM, 1 * MM), axis=(math.sqrt(0.5), math.sqrt(0.5)), mass=1.0, loops=(circle(0, 0, 1, "A"),)
    )
    wall = Body("wall", "fixed", loops=(polygon([(5, -5), (6, -5), (6, 5), (5, 5)], "W"),))
    t = np.linspace(0.0, 1.0, 301)
    q, u, a = (2 * MM * f[:, None] for f in (np.sin(10 * t), 10 * np.cos(10 * t), -100 * np.sin(10 * t)))
    scene = Scene("A slider", (slider, wall))
    end = {"simulated": 1.0, "end_q": q[-1], "end_u": u[-1]}
    return Trajectory(scene, t, q, u, a, {"slider": slice(0, 1)}, np.zeros(0, EVENT_DTYPE), (), Stop.DURATION, **end)
