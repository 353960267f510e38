"""Are gaps, rates, force directions, bar terms and candidates right where bodies are carried by others?"""

import dataclasses
import functools
import math

import numpy as np
import pytest
from every_time import few
from hypothesis import given, settings
from hypothesis import strategies as st
from pair_scenes import ARRANGEMENTS, carried_scene, outline, places
from true_contacts import touches

from watchsim.contact.cell_lookup import ALL, candidate, candidates, time_in_cell
from watchsim.contact.cells import CellFinder
from watchsim.contact.gaps import SLOTS, closed_contacts, contact_kinematics, place, poses
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Line
from watchsim.jit import callable_kernel
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model import LINE
from watchsim.scene.scene import Scene

STEP = 1e-3  # of a five-point quotient
TEETH = 24

_place, _kinematics = callable_kernel(place), callable_kernel(contact_kinematics)
_candidates, _candidate, _time = callable_kernel(candidates), callable_kernel(candidate), callable_kernel(time_in_cell)
numbers = st.lists(st.floats(-3.0, 3.0), min_size=16, max_size=16)


def block(name: str) -> tuple[Loop, ...]:
    return (outline(1.0, (0.2, 0.1)),) if name != "a" else (outline(0.35, (0.1, -0.15)),)


@functools.cache
def scene_of(arrangement: tuple[str, str, bool]) -> tuple[Scene, Compiled]:
    return carried_scene(*arrangement, block, (0.25, 0.1))


def kinematics(compiled: Compiled, k: int, q: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(g, g_N', g_T', bar_N, bar_T), w_N and w_T as full vectors."""
    pose, closed = poses(len(compiled.model.bodies)), closed_contacts(1)
    _place(compiled.model, q, u, pose)
    _kinematics(compiled.model, k, pose, 0, closed)
    assert closed.slots[0] <= SLOTS
    kin, w = closed.kin[0], np.zeros((2, len(q)))
    for j in range(closed.slots[0]):
        w[:, closed.coord[0, j]] += closed.w_N[0, j], closed.w_T[0, j]
    return np.array([kin.g, kin.gN_dot, kin.gT_dot, kin.bar_N, kin.bar_T]), w[0], w[1]


def quotient(function):
    """Derivative at 0 by five points."""
    h = STEP
    return (8.0 * (function(h) - function(-h)) - (function(2 * h) - function(-2 * h))) / (12.0 * h)


@functools.cache
def uncarried(arrangement: tuple[str, str, bool]) -> Compiled:
    """The same two outlines as free bodies."""
    scene, _ = scene_of(arrangement)
    pair = {side.body for side in scene.contacts[0].sides}
    bodies = [dataclasses.replace(b, motion="free", on=None, mass=1.0) for b in scene.bodies if b.name in pair]
    return compile_scene(dataclasses.replace(scene, bodies=tuple(bodies)))


@pytest.mark.parametrize("arrangement", ARRANGEMENTS, ids=str)
def test_rates_directions_and_bar_terms(arrangement: tuple[str, str, bool]) -> None:
    """Every quotient is of something simpler than what it is compared with; the gap itself is that of two free bodies."""
    scene, compiled = scene_of(arrangement)
    n, free = len(compiled.q), uncarried(arrangement)
    names = [body.name for body in scene.bodies if body.name in {side.body for side in scene.contacts[0].sides}]

    @settings(max_examples=12)
    @given(st.integers(0, 10000), numbers)
    def check(choice: int, values: list[float]) -> None:
        k = choice % len(compiled.model.contacts)
        q, u = np.array(values[:n]), np.array(values[8 : 8 + n])
        (g, gN_dot, gT_dot, bar_N, bar_T), w_N, w_T = kinematics(compiled, k, q, u)
        where = places(scene, compiled, q)
        apart = kinematics(free, k, np.concatenate([where[name] for name in names]), np.zeros(6))[0][0]
        assert g == pytest.approx(apart, abs=1e-13)
        scale = 1.0 + float(np.abs(u).max()) ** 2
        assert w_N @ u == pytest.approx(gN_dot, abs=1e-13 * scale)
        assert w_T @ u == pytest.approx(gT_dot, abs=1e-13 * scale)
        contact = compiled.model.contacts[k]
        if compiled.model.primitives[contact.b].kind != LINE and _centres(compiled, k, q, u) < 0.2:
            return
        for j in range(n):
            unit = np.eye(n)[j]
            slope = quotient(lambda s, e=unit: kinematics(compiled, k, q + s * e, u)[0][0])
            assert w_N[j] == pytest.approx(slope, abs=1e-7)
        truth = [quotient(lambda s, i=i: kinematics(compiled, k, q + s * u, u)[0][i]) for i in range(3)]
        assert [gN_dot, bar_N, bar_T] == pytest.approx(truth, abs=1e-6 * scale**3)

    check()


def _centres(compiled: Compiled, k: int, q: np.ndarray, u: np.ndarray) -> float:
    """Distance of the centres of two round primitives."""
    pose, contact = poses(len(compiled.model.bodies)), compiled.model.contacts[k]
    _place(compiled.model, q, u, pose)
    points = []
    for i in (contact.a, contact.b):
        one = compiled.model.primitives[i]
        p = pose[one.body]
        points.append((p.x + p.c * one.x - p.s * one.y, p.y + p.s * one.x + p.c * one.y))
    return math.dist(*points)


def toothed(name: str) -> tuple[Loop, ...]:
    """Saw teeth: on a of radius 0.3, on all others of radius 0.5."""
    tip = 0.3 if name == "a" else 0.5
    points = [
        (r * math.cos(2.0 * math.pi * (i + shift) / TEETH), r * math.sin(2.0 * math.pi * (i + shift) / TEETH))
        for i in range(TEETH)
        for r, shift in ((0.8 * tip, 0.0), (tip, 0.2 + 0.1 * (name == "a" and i == 3)))
    ]
    return (Loop(tuple(Line(*p, *q) for p, q in zip(points, points[1:] + points[:1], strict=True))),)


@functools.cache
def toothed_scene(arrangement: tuple[str, str, bool], at: tuple[float, float]) -> tuple[Scene, Compiled]:
    return carried_scene(*arrangement, toothed, at)


FEW = few(ARRANGEMENTS, lambda one: one == ("pivot", "beside", False) or ARRANGEMENTS.index(one) % 3 == 0)


@pytest.mark.parametrize("arrangement", FEW, ids=str)
def test_no_touching_pair_is_lost(arrangement: tuple[str, str, bool]) -> None:
    """At poses where primitives really touch, and before them, as long as the answer there is said to hold."""
    scene, compiled = toothed_scene(arrangement, (0.25, 0.1))
    n, model, rng, met, early = len(compiled.q), compiled.model, np.random.default_rng(7), 0, 0
    finder, shares = CellFinder(model), 0.3 if arrangement[0] != "pivot" or arrangement[1] in ("slide", "free") else 3.5

    def listed(q: np.ndarray) -> set[int]:
        cells = finder.learn(0, q) if model.pairs[0].listed else finder.cells
        how, start, count = _candidates(model, cells, 0, q)
        return {int(_candidate(model, cells, how, i)) for i in range(start, start + count)}

    for k, q in touches(scene, compiled, rng, (rng.uniform(-shares, shares, n) for _ in range(4))):
        assert k in model.near
        assert k in listed(q)
        u, a, t = rng.uniform(-1.0, 1.0, n), rng.uniform(0.0, 2.0, n), rng.uniform(0.0, 0.02)
        before = q - u * t - 0.5 * a * t * t
        met += 1
        if float(_time(model, 0, before, u, a)) >= t:
            early += 1
            assert k in listed(before)
    if arrangement == ("pivot", "beside", False):
        assert met >= 3 and early >= 1


def test_cells_are_seen_from_the_carrier() -> None:
    """Two bodies on one carriage: two relative angles; body and carrier: one; against the movement: both angles."""
    axes = {}
    for arrangement in ARRANGEMENTS[:8]:
        model = toothed_scene(arrangement, (0.25, 0.1))[1].model
        axes[arrangement[1]] = int(model.pairs[0].axes)
        relative = [int(model.pairs[0][f"on{i}"]) >= 0 for i in range(model.pairs[0].axes)]
        assert any(relative) == all(relative) or not relative
        assert any(relative) == (arrangement[1] in ("beside", "carrier", "part"))
    assert axes == {"beside": 2, "carrier": 1, "part": 1, "fixed": 2, "pivot": 3, "slide": 3, "free": 0, "other": 0}


def test_far_parts_of_a_carriage_are_no_candidates() -> None:
    """A body on a carriage reaches a ring about the carriage's pivot and nothing beyond."""
    scene, _ = toothed_scene(("pivot", "fixed", False), (0.25, 0.1))
    for distance, some in ((0.9, True), (3.0, False)):
        bodies = tuple(
            dataclasses.replace(body, position=(0.3 + distance, -0.2)) if body.name == "b" else body for body in scene.bodies
        )
        assert (len(compile_scene(dataclasses.replace(scene, bodies=bodies)).model.near) > 0) == some


def test_a_free_carrier_leaves_all_to_be_looked_at() -> None:
    """Four coordinates and more have no cells."""
    model = toothed_scene(("free", "fixed", False), (0.25, 0.1))[1].model
    q = np.zeros(len(model.coordinates))
    how, _, count = _candidates(model, CellFinder(model).cells, 0, q)
    assert how == ALL and count == len(model.contacts)
