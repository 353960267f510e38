"""Are the phases of a grasshopper those that the drawn outlines show, placed by the motion alone?

Shapely measures how far the edges of wheel and pallets are apart; contact events and gap functions are not looked at.
"""

from __future__ import annotations

import functools
import math
from itertools import pairwise

import numpy as np
import pytest
import shapely
from shapely.affinity import affine_transform

import watchsim as ws
from watchsim.analysis.timeline.shown_beats import shown_beats
from watchsim.analysis.timing.phases import Phase, phases
from watchsim.escapement.measure import measure
from watchsim.geometry.primitives import Arc, Edge
from watchsim.scene.roles import hinged_pallets
from watchsim.simulation.record.trajectory import Trajectory

TOUCHING, FREE, RISE = 1e-7, 1e-5, 1e-8  # m; RISE: of an arc above its chords


@functools.cache
def run_of(amplitude: str = "") -> Trajectory:
    scene = ws.load(ws.profiles_dir() / "grasshopper")
    return ws.simulate(scene.set("bodies.pendulum.angle", amplitude) if amplitude else scene, duration=4.2)


@functools.cache
def edges(body: str) -> tuple[shapely.LineString, ...]:
    found = run_of().scene.body(body)
    return tuple(chain(edge) for loop in found.loops for edge in loop.edges)


def chain(edge: Edge) -> shapely.LineString:
    count = math.ceil(abs(edge.sweep) / math.sqrt(8.0 * RISE / edge.radius)) if isinstance(edge, Arc) and edge.radius else 1
    return shapely.LineString([edge.point(i / count) for i in range(count + 1)])


def apart(pallet: str, t: float) -> float:
    """m."""
    placed = []
    for body in ("wheel", pallet):
        x, y, angle = run_of().pose(body, t)
        c, s = math.cos(angle), math.sin(angle)
        placed.append([affine_transform(line, [c, -s, s, c, x, y]) for line in edges(body)])
    whole = shapely.MultiLineString(placed[1])
    near = [line for line in placed[0] if line.distance(whole.envelope) < 1e-4]
    return float(shapely.MultiLineString(near).distance(whole)) if near else math.inf


def told() -> list[Phase]:
    return phases(run_of())[4:]


def test_each_half_swing_has_an_impulse_and_a_recoil_by_the_pallets_in_turn() -> None:
    rows = told()
    assert hinged_pallets(run_of().scene) == ("entry", "exit")
    assert [row.name for row in rows] == ["impulse", "recoil"] * (len(rows) // 2)
    assert len(rows) >= 8
    for one, after in pairwise(rows):
        assert after.start == pytest.approx(one.end, abs=1e-12)
        assert (one.on == after.on) == (one.name == "recoil")  # a pallet that has caught a tooth keeps it over the turn


def test_the_pallet_that_a_phase_names_touches_and_the_other_does_not() -> None:
    for row in told():
        other = "exit" if row.on == "entry" else "entry"
        for t in row.start + (row.end - row.start) * np.array([0.1, 0.5, 0.9]):
            assert apart(row.on, t) < TOUCHING
        # The other has no tooth yet while one pushes; after the change it jumps off.
        assert apart(other, 0.5 * (row.start + row.end)) > FREE


def test_the_wheel_goes_on_in_the_impulse_and_back_in_the_recoil() -> None:
    for row in told():
        inside = np.linspace(row.start, row.end, 40)
        way = -np.diff(run_of().sample(inside)[0][:, run_of().slices["wheel"].start])
        assert (way > 0.0).all() if row.name == "impulse" else (way < 0.0).all()


def test_the_beats_account_closes() -> None:
    for beat in shown_beats(run_of()):
        assert abs(beat.residual) < 1e-4 * sum(stage.energy.supplied for stage in beat.stages)


def test_a_pendulum_that_swings_too_little_has_no_phases() -> None:
    """Where no pallet takes over, the wheel only goes to and fro."""
    assert phases(run_of("2°")) == []


def test_check_says_why_there_is_no_lock() -> None:
    found = measure(run_of().scene)
    assert found.pallets is None
    assert any(what == "lock, draw, drop" and "hinged on pendulum" in why for what, why in found.missing)
