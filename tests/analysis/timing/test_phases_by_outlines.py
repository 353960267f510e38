"""Are the phases of cylinder and duplex those that the outlines show, placed by the motion alone?

Shapely measures how far the drawn edges of wheel and balance are apart, and where they touch; contact events, gap functions
and the solver's tables are not looked at.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator

import numpy as np
import pytest
import shapely
from shapely.affinity import affine_transform
from shapely.ops import nearest_points

import watchsim as ws
from watchsim.analysis.timing.phases import phases
from watchsim.geometry.primitives import Arc, Edge
from watchsim.scene.body import Body
from watchsim.simulation.record.trajectory import Trajectory

TOUCHING, FREE, RISE = 2e-8, 1e-7, 2e-9  # m; RISE: of an arc above its chords
BEGUN = 0.3  # of a phase: a gap opens with the square of time
PARTS = {  # profile -> phase -> layers that touch in it, wheel and balance
    "cylinder": dict.fromkeys(("unlock", "impulse", "locked"), ("TEETH", "SHELL")),
    "duplex": {"unlock": ("RESTING", "ROLLER"), "impulse": ("IMPULSE", "PALLET"), "locked": ("RESTING", "ROLLER")},
}


@functools.cache
def run_of(name: str) -> Trajectory:
    return ws.simulate(ws.load(ws.profiles_dir() / name / "scene.toml"), duration=2.2)


@functools.cache
def lines(name: str, body: str, layer: str) -> tuple[shapely.LineString, ...]:
    """The edges of a layer in the body's frame."""
    found: Body = run_of(name).scene.body(body)
    edges = (edge for loop in found.loops if loop.layer == layer for edge in loop.edges)
    return tuple(shapely.LineString([edge.point(i / n) for i in range(n + 1)]) for edge in edges for n in (chords(edge),))


def chords(edge: Edge) -> int:
    """So many that none is further than RISE from its arc."""
    return math.ceil(abs(edge.sweep) / math.sqrt(8.0 * RISE / edge.radius)) if isinstance(edge, Arc) and edge.radius else 1


def arcs_about_the_axis(name: str, layer: str) -> list[float]:
    """The radii of those arcs of the balance's layer, m."""
    edges = [edge for loop in run_of(name).scene.body("balance").loops if loop.layer == layer for edge in loop.edges]
    return sorted({edge.radius for edge in edges if isinstance(edge, Arc) and math.hypot(edge.x, edge.y) < 1e-9})


def placed(run: Trajectory, name: str, body: str, layer: str, t: float) -> list[shapely.LineString]:
    x, y, angle = run.pose(body, t)
    c, s = math.cos(angle), math.sin(angle)
    return [affine_transform(line, [c, -s, s, c, x, y]) for line in lines(name, body, layer)]


def apart(name: str, layers: tuple[str, str], t: float) -> tuple[float, float, float]:
    """Distance of two layers, and how far their nearest points are from the axes of wheel and balance, m."""
    run = run_of(name)
    wheel, balance = (placed(run, name, body, layer, t) for body, layer in zip(("wheel", "balance"), layers, strict=True))
    whole = shapely.MultiLineString(balance)
    near = shapely.MultiLineString([line for line in wheel if line.distance(whole.envelope) < 1e-5] or wheel[:1])
    a, b = nearest_points(near, whole)
    axes = (run.scene.body(body).position for body in ("wheel", "balance"))
    return a.distance(b), *(math.dist((point.x, point.y), axis) for point, axis in zip((a, b), axes, strict=True))


def of(name: str, kind: str) -> Iterator[tuple[float, float]]:
    """Start and end of the phases of that name in the last oscillations."""
    found = [(one.start, one.end) for one in phases(run_of(name))[-15:] if one.name == kind]
    assert found
    return iter(found)


@pytest.mark.parametrize("kind", ["catch-up", "drop"])
@pytest.mark.parametrize("name", PARTS)
def test_the_wheel_is_free_while_it_catches_up_and_drops(name: str, kind: str) -> None:
    """From when the tooth leaves what it touched until it meets what comes next, and not a moment longer."""
    pairs = set(PARTS[name].values())
    before, after = ("unlock", "impulse") if kind == "catch-up" else ("impulse", "locked")
    for start, end in of(name, kind):
        inside = start + (end - start) * np.linspace(BEGUN, 0.97, 7)
        assert min(apart(name, pair, t)[0] for t in inside for pair in pairs) > FREE
        assert apart(name, PARTS[name][before], start)[0] < TOUCHING
        assert apart(name, PARTS[name][after], end)[0] < TOUCHING


@pytest.mark.parametrize("kind", ["unlock", "impulse", "locked"])
@pytest.mark.parametrize("name", PARTS)
def test_the_tooth_touches_what_the_phase_is_named_after(name: str, kind: str) -> None:
    """At most instants: impacts may throw it off for a moment."""
    for start, end in of(name, kind):
        inside = start + (end - start) * np.linspace(0.1, 0.99, 10)
        touching = [apart(name, PARTS[name][kind], t)[0] < TOUCHING for t in inside]
        assert sum(touching) >= 8, kind


@pytest.mark.parametrize("name", PARTS)
def test_a_locked_tooth_rests_on_an_arc_about_the_balance(name: str) -> None:
    """On the shell, outside or inside, or on the roller, by one and the same point of the tooth."""
    radii, toes = arcs_about_the_axis(name, PARTS[name]["locked"][1]), []
    for start, end in of(name, "locked"):
        for t in start + (end - start) * np.linspace(0.3, 0.95, 4):
            _, toe, rest = apart(name, PARTS[name]["locked"], t)
            assert min(abs(rest - radius) for radius in radii) < TOUCHING
            toes.append(toe)
    assert np.ptp(toes) < 1e-5


def test_the_cylinder_is_pushed_at_its_lips() -> None:
    """Between the inner and the outer radius of the shell, while the point of contact goes along the tooth's face."""
    radii = arcs_about_the_axis("cylinder", "SHELL")
    for start, end in of("cylinder", "impulse"):
        found = [apart("cylinder", ("TEETH", "SHELL"), t) for t in start + (end - start) * np.linspace(0.2, 0.9, 6)]
        lips = [rest for gap, _, rest in found if gap < TOUCHING]
        along = [toe for gap, toe, _ in found if gap < TOUCHING]
        assert all(radii[0] - TOUCHING < rest < radii[-1] + TOUCHING for rest in lips)
        assert np.ptp(along) > 5e-6
