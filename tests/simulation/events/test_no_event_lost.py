"""Does brute force at steps a thousand times finer find a touch that the simulation has missed?

Two bodies of lines, arcs and corners fly past or into one another. Their motion until they touch is known in closed form; whole
outlines are laid into the plane by shapely at every fine step. Nothing of the package's contact geometry is used.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
import shapely
from every_time import few

from watchsim.candidates import cell_grid
from watchsim.geometry.loop import Loop
from watchsim.geometry.polyline import polyline
from watchsim.geometry.primitives import Arc, Line
from watchsim.scene.body import Body
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import EventKind
from watchsim.simulation.simulate import simulate

DURATION, FINER = 1.0, 1000
CELLED = (
    ("pivot", "fixed"),
    ("pivot", "pivot"),
    ("slide", "pivot"),
    pytest.param(("slide", "slide"), marks=pytest.mark.slow),
    pytest.param(("free", "fixed"), marks=pytest.mark.slow),
)
CHORD = 5e-5  # how far the chords of an arc may stray, of outlines a metre across


def block(scale: float, bite: float) -> Loop:
    """A bar with a round nose and a round bite, about its origin."""
    s = scale
    return Loop(
        (
            Line(-0.5 * s, -0.2 * s, 0.3 * s, -0.2 * s),
            Arc(0.3 * s, 0.0, 0.2 * s, -0.5 * math.pi, math.pi),
            Line(0.3 * s, 0.2 * s, bite * s, 0.2 * s),
            Arc(0.0, 0.2 * s, bite * s, 0.0, -math.pi),
            Line(-bite * s, 0.2 * s, -0.5 * s, 0.2 * s),
            Line(-0.5 * s, 0.2 * s, -0.5 * s, -0.2 * s),
        )
    )


def spike(length: float) -> Loop:
    """A slender thorn about its origin."""
    points = [(length, 0.0), (-0.1 * length, 0.03 * length), (-0.1 * length, -0.03 * length)]
    return Loop(tuple(Line(*points[i], *points[(i + 1) % 3]) for i in range(3)))


def random_body(name: str, motion: str, rng: np.random.Generator) -> Body:
    place = (rng.uniform(0.4, 1.4), rng.uniform(-0.8, 0.8)) if name == "b" else (0.0, 0.0)
    direction = rng.uniform(-math.pi, math.pi)
    speeds = {"pivot": (rng.normal(0.0, 6.0),), "slide": (rng.normal(0.0, 2.0),), "fixed": ()}
    velocity = speeds.get(motion, (*rng.normal(0.0, 1.5, 2), rng.normal(0.0, 6.0)))
    loop = spike(rng.uniform(0.3, 0.8)) if rng.random() < 0.4 else block(rng.uniform(0.3, 1.0), rng.uniform(0.02, 0.15))
    return Body(
        name,
        motion,
        place,
        direction,
        velocity,
        axis=(math.cos(2.0 * direction), math.sin(2.0 * direction)),
        mass=0.0 if motion == "pivot" else 1.0,
        inertia=0.1,
        loops=(loop,),
    )


def outlines(body: Body, t: np.ndarray, gravity: tuple[float, float]) -> np.ndarray:
    """The body's polygon at every instant of its free motion."""
    fall = np.array(gravity)
    x, y, angle = (np.full(len(t), v) for v in (*body.position, body.angle))
    if body.motion == "pivot":
        angle = angle + body.velocity[0] * t
    elif body.motion == "slide":
        way = body.velocity[0] * t + 0.5 * float(fall @ np.array(body.axis)) * t**2
        x, y = x + way * body.axis[0], y + way * body.axis[1]
    elif body.motion == "free":
        x, y = (v + body.velocity[i] * t + 0.5 * fall[i] * t**2 for i, v in ((0, x), (1, y)))
        angle = angle + body.velocity[2] * t
    points = polyline(body.loops[0], CHORD)
    turned = (points[:, 0] + 1j * points[:, 1])[None, :] * np.exp(1j * angle)[:, None] + (x + 1j * y)[:, None]
    return shapely.polygons(np.stack([turned.real, turned.imag], axis=-1))


@pytest.mark.parametrize(
    "motions", few([("pivot", "pivot"), ("pivot", "fixed"), ("slide", "pivot"), ("free", "pivot"), ("free", "fixed")], 2)
)
@pytest.mark.parametrize("wanted", [1, pytest.param(20, marks=pytest.mark.slow)])
def test_the_first_touch_is_the_one_that_brute_force_sees(motions: tuple[str, str], wanted: int) -> None:
    rng = np.random.default_rng(sum(map(ord, "".join(motions))))
    met = missed = 0
    while met < wanted or missed < 1:
        a, b = (random_body(name, motion, rng) for name, motion in zip("ab", motions, strict=True))
        gravity = (0.0, float(rng.choice([0.0, -3.0])))
        start = np.zeros(1)
        if shapely.distance(outlines(a, start, gravity), outlines(b, start, gravity))[0] < 1e-3:
            continue
        scene = Scene("flight", (a, b), contacts=(Contact((Side("a"), Side("b")), 0.1, 0.5),), gravity=gravity)
        done = simulate(scene, DURATION)
        hits = done.events[done.events["kind"] == EventKind.IMPACT]
        told = float(hits["t"][0]) if len(hits) else math.inf
        steps = max(1, np.count_nonzero(done.t <= told))
        apart = min(told, DURATION) / steps / FINER
        t = np.arange(0.5 * apart, DURATION, apart)[: 8 * FINER]  # half a step off, so that none is `told` itself
        touching = shapely.intersects(outlines(a, t, gravity), outlines(b, t, gravity))
        if touching.any():
            assert told <= t[np.argmax(touching)], "the simulation went through"
        assert not touching[t < told - 1e-4].any()
        if told < math.inf:
            there = np.array([told])
            assert shapely.distance(outlines(a, there, gravity), outlines(b, there, gravity))[0] < 2.0 * CHORD
        met, missed = met + (told < math.inf), missed + (told == math.inf)


@pytest.mark.slow
@pytest.mark.parametrize("wanted", [1, pytest.param(20, marks=pytest.mark.slow)])
@pytest.mark.parametrize("motions", CELLED)
def test_cells_change_no_bit_of_random_collisions(
    motions: tuple[str, str], wanted: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Cells are used however few contacts there are; without them every pair is looked at in every step."""
    monkeypatch.setattr(cell_grid, "FEW_CONTACTS", 0)
    rng = np.random.default_rng(sum(map(ord, "".join(motions))) + 1)
    events = compared = 0
    while compared < wanted or events < 10:
        a, b = (random_body(name, motion, rng) for name, motion in zip("ab", motions, strict=True))
        gravity, start = (0.0, float(rng.choice([0.0, -3.0]))), np.zeros(1)
        if shapely.distance(outlines(a, start, gravity), outlines(b, start, gravity))[0] < 1e-3:
            continue
        scene = Scene("flight", (a, b), contacts=(Contact((Side("a"), Side("b")), 0.1, 0.5),), gravity=gravity)
        runs = [simulate(scene, DURATION, prefilter=prefilter) for prefilter in (True, False)]
        assert runs[0].events.tobytes() == runs[1].events.tobytes()
        assert np.array_equal(runs[0].q, runs[1].q)
        assert runs[0].counts["gap_evaluations"] <= runs[1].counts["gap_evaluations"]
        compared, events = compared + 1, events + len(runs[0].events)
