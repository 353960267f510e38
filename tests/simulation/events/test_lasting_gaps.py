"""Is a gap that stays at rounding looked at rarely, and is what it does in the end found at its time?"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Line
from watchsim.scene.body import Body
from watchsim.scene.file.load import load
from watchsim.scene.force import Contact, Side
from watchsim.scene.scene import Scene
from watchsim.simulation.event_kinds import EventKind
from watchsim.simulation.simulate import simulate

KEPT = Path(__file__).resolve().parents[2] / "data" / "hunt"
FALL, SPEED, HEIGHT = 9.81, 0.6, 4e-3  # m/s², m/s, m


def _polygon(*points: tuple[float, float]) -> Loop:
    return Loop(tuple(Line(*a, *b) for a, b in zip(points, (*points[1:], points[0]), strict=True)))


def _along_a_wall(lean: float, turn: float) -> Scene:
    """A block flies up along a wall that it touches; at `HEIGHT` above its corner the wall leans over by `lean`."""
    c, s = math.cos(turn), math.sin(turn)

    def turned(x: float, y: float) -> tuple[float, float]:
        return c * x - s * y, s * x + c * y

    half = 5e-3
    bend, top = 2.0 * half + HEIGHT, 0.04
    wall = _polygon((-half, -0.02), (0.0, -0.02), (0.0, bend), ((top - bend) * math.tan(lean), top), (-half, top))
    block = _polygon((-half, -half), (half, -half), (half, half), (-half, half))
    x, y = turned(half, half)
    vx, vy = turned(0.0, SPEED)
    bodies = (
        Body("wall", "fixed", (0.0, 0.0), turn, loops=(wall,)),
        Body("block", "free", (x, y), turn, (vx, vy, 0.0), mass=0.02, inertia=3e-7, loops=(block,)),
    )
    contact = Contact((Side("wall"), Side("block")), 0.0, 0.0)
    return Scene("wall", bodies, contacts=(contact,), gravity=turned(0.0, -FALL), duration=0.02)


@pytest.mark.parametrize("turn", [0.0, 0.7])
@pytest.mark.parametrize("lean", [1e-3, 0.2])
def test_a_block_that_flies_along_a_wall_meets_where_it_leans_over(lean: float, turn: float) -> None:
    run = simulate(_along_a_wall(lean, turn), tolerance=1e-11, prefilter=False)
    first = run.events[run.events["kind"] == EventKind.IMPACT]["t"][0]
    # The wall leans over HEIGHT above the block's upper corner.
    expected = (SPEED - math.sqrt(SPEED**2 - 2.0 * FALL * HEIGHT)) / FALL
    assert first == pytest.approx(expected, rel=1e-7)
    assert run.counts["gap_evaluations"] < 10_000  # 400 000 and more where accelerations are bounded one by one


def test_a_body_that_turns_about_a_corner_on_a_corner_is_looked_at_rarely() -> None:
    scene = load(KEPT / "boxed-77-2415.toml")
    counts = [simulate(scene, tolerance=tolerance, prefilter=False).counts for tolerance in (1e-9, 1e-7)]
    assert max(count["gap_evaluations"] for count in counts) < 60_000  # were 1.3 million, and 47 million turned by 219°


@pytest.mark.parametrize("tolerance", [1e-7, 1e-9, 1e-11])
def test_a_block_that_lands_flat_keeps_the_corner_on_which_it_stood(tolerance: float) -> None:
    """Drift of that corner's gap had turned the block past the end of the corner's normals: it was let go, and hit again."""
    run = simulate(load(KEPT / "blocks-77-1586.toml"), tolerance=tolerance)
    landing = run.events[np.isclose(run.events["t"], 0.1329445, atol=1e-7)]
    names = [str(run.pairs[k]) for k in landing["contact"]]
    assert all(EventKind(kind) != EventKind.OPEN for kind in landing["kind"]), names
    hit = {int(k) for k in landing[landing["kind"] == EventKind.IMPACT]["contact"]}
    assert len(hit) == 2
