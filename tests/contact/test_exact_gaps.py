"""Do distances and gaps agree with fifty-digit arithmetic, and rates with its difference quotients?"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator

import numpy as np
import pytest
from naive.exact_distance import Pair, exact_distance, exact_gap, mp, nasty_pairs

from watchsim.contact.distance import distance, gap, kinematics
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line

FEW, MANY = 150, 20000
EXACT = 1e-14  # of the size
STEP = mp.mpf(10) ** -12  # of a central quotient in fifty digits: its error is of order STEP²


def chain(*edges: Edge) -> Loop:
    return Loop(edges, closed=False)


def round_side(pair: Pair) -> Loop | None:
    """Edge a as something that plays the circle: a convex arc, or a line that ends in a convex corner; None for a bite.

    None also for what is so short that it counts as a joint.
    """
    if min(pair.a.length, pair.b.length) < 1e-10 * pair.size:
        return None
    if isinstance(pair.a, Arc):
        fits = not (isinstance(pair.b, Arc) and pair.b.sweep < 0.0 and pair.a.radius >= pair.b.radius)
        return chain(pair.a) if pair.a.sweep > 0.0 and fits else None
    (x, y), (tx, ty) = pair.a.end, pair.a.tangent(1.0)
    return chain(pair.a, Line(x, y, x - pair.size * ty, y + pair.size * tx))


def contact_row(rows: np.ndarray, pair: Pair) -> np.void:
    """The row of the pair's own contact."""
    return rows[rows["kind_a"] == ("arc" if isinstance(pair.a, Arc) else "corner")][0]


@pytest.mark.parametrize("count", [FEW, pytest.param(MANY, marks=pytest.mark.slow)])
def test_distances_of_nasty_pairs_of_edges(count: int) -> None:
    seen: Counter[str] = Counter()
    for pair in nasty_pairs(np.random.default_rng(count), count):
        found = distance(chain(pair.a), pair.pose_a, chain(pair.b), pair.pose_b)
        truth = exact_distance(pair)
        assert abs(found.value - truth) <= EXACT * pair.size, pair
        # The two points are that far apart.
        assert math.dist(found.on_a, found.on_b) == pytest.approx(found.value, abs=2e-14 * pair.size)
        seen[pair.name] += 1
    assert min(seen.values()) >= count // 6


@pytest.mark.parametrize("count", [FEW, pytest.param(MANY, marks=pytest.mark.slow)])
def test_gaps_of_nasty_pairs(count: int) -> None:
    seen: Counter[str] = Counter()
    for pair in nasty_pairs(np.random.default_rng(count), count):
        outline = round_side(pair)
        if outline is None:
            continue
        row = contact_row(gap(outline, pair.pose_a, chain(pair.b), pair.pose_b), pair)
        truth = exact_gap(pair)
        # Far beyond its primitives a contact on a flat circle has the lever of its way there.
        assert abs(float(row["g"]) - truth) <= EXACT * max(pair.size, -float(row["margin"])), pair
        seen[pair.name] += 1
    assert min(seen.values()) >= count // 25


def moved(pose: tuple[float, ...], velocity: np.ndarray, t) -> tuple:
    return tuple(mp.mpf(x) + t * mp.mpf(v) for x, v in zip(pose, velocity, strict=True))


def gap_after(pair: Pair, velocities: tuple[np.ndarray, np.ndarray], t):
    """Fifty-digit gap after time t at constant velocities."""
    at = pair._replace(pose_a=moved(pair.pose_a, velocities[0], t), pose_b=moved(pair.pose_b, velocities[1], t))
    return exact_gap(at)


def slip(pair: Pair, velocities: tuple[np.ndarray, np.ndarray], t):
    """Fifty-digit g_T_dot after time t: velocity of a's material against b's at the contact point, along t."""
    pose_a, pose_b = moved(pair.pose_a, velocities[0], t), moved(pair.pose_b, velocities[1], t)

    def out(pose, p):
        return mp.mpc(pose[0], pose[1]) + p * mp.expj(pose[2])

    if isinstance(pair.a, Arc):
        centre, radius = out(pose_a, mp.mpc(pair.a.x, pair.a.y)), mp.mpf(pair.a.radius)
    else:
        centre, radius = out(pose_a, mp.mpc(*pair.a.end)), mp.mpf(0)
    if isinstance(pair.b, Line):
        way = out(pose_b, mp.mpc(*pair.b.end)) - out(pose_b, mp.mpc(*pair.b.start))
        n = -mp.mpc(0, 1) * way / abs(way)
    else:
        way = centre - out(pose_b, mp.mpc(pair.b.x, pair.b.y))
        n = mp.sign(pair.b.sweep) * way / abs(way)
    point = centre - radius * n
    if isinstance(pair.a, Arc) and isinstance(pair.b, Arc) and pair.b.sweep > 0.0 and pair.b.radius < pair.a.radius:
        point = centre - way + mp.mpf(pair.b.radius) * n  # of two convex arcs the rounder one has the contact point
    va, vb = ([mp.mpf(float(v)) for v in velocity] for velocity in velocities)
    va = mp.mpc(va[0], va[1]) + mp.mpc(0, 1) * va[2] * (point - mp.mpc(pose_a[0], pose_a[1]))
    vb = mp.mpc(vb[0], vb[1]) + mp.mpc(0, 1) * vb[2] * (point - mp.mpc(pose_b[0], pose_b[1]))
    return mp.re((va - vb) * mp.conj(mp.mpc(0, 1) * n))


def in_motion(count: int) -> Iterator[tuple[Pair, tuple[np.ndarray, np.ndarray]]]:
    """Nasty pairs whose contact has a normal to speak of, and random velocities."""
    rng = np.random.default_rng(count)
    for pair in nasty_pairs(rng, count):
        if round_side(pair) is None:
            continue
        yield pair, (rng.normal(size=3), rng.normal(size=3))


@pytest.mark.parametrize("count", [FEW, pytest.param(MANY, marks=pytest.mark.slow)])
def test_rates_and_bar_terms_of_nasty_pairs(count: int) -> None:
    """Against quotients of the level below, whose own rounding is 1e-24: what is left is the kernels' rounding."""
    compared = 0
    for pair, velocities in in_motion(count):
        outline = round_side(pair)
        assert outline is not None
        both = (pair.pose_a, tuple(velocities[0])), (pair.pose_b, tuple(velocities[1]))
        row = contact_row(kinematics(outline, *both[0], chain(pair.b), *both[1]), pair)
        before, now, after = (gap_after(pair, velocities, step) for step in (-STEP, mp.mpf(0), STEP))
        first, second = (after - before) / (2 * STEP), (after - 2 * now + before) / STEP**2
        turn = (slip(pair, velocities, STEP) - slip(pair, velocities, -STEP)) / (2 * STEP)
        # Rounding grows with the radius of a (its contact point runs) and as the centres come together.
        radius = pair.a.radius if isinstance(pair.a, Arc) else 0.0
        reach = max(pair.size, abs(float(now)), radius)
        bend = 1.0
        if isinstance(pair.b, Arc):
            apart = abs(float(now) * np.sign(pair.b.sweep) + pair.b.radius + np.sign(pair.b.sweep) * radius)
            bend = max(1.0, reach / apart) if apart > 0.0 else math.inf
        if bend > 1e3:
            continue
        assert abs(float(row["g_N_dot"]) - first) <= 3e-14 * reach * bend, pair
        assert abs(float(row["g_T_dot"]) - slip(pair, velocities, mp.mpf(0))) <= 3e-14 * reach * bend, pair
        assert abs(float(row["w_bar_N"]) - second) <= 1e-12 * reach * bend**2, pair
        assert abs(float(row["w_bar_T"]) - turn) <= 1e-12 * reach * bend**2, pair
        compared += 1
    assert compared > count // 4
