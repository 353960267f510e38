"""Do distances and gaps agree with fifty-digit arithmetic and with the drawn material?"""

import math
from collections import Counter
from collections.abc import Iterator

import numpy as np
import pytest
from naive.distance_oracle import nearest
from naive.exact_distance import Pair, exact_distance, exact_gap, mp, nasty_pairs
from pair_scenes import outline

import watchsim
from watchsim.geometry.loops import Loop
from watchsim.geometry.primitives import Arc, Edge, Line
from watchsim.mechanism.distance import distance, gap, kinematics

# Do distances and gaps agree with fifty-digit arithmetic, and rates with its difference quotients?

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


# Are distances, gaps and kinematics of two outlines those of the drawn material?

SPACING = 0.01
BIG, SMALL = outline(1.0, (0.2, 0.1)), outline(0.35, (0.1, -0.15))
HERE = (0.0, 0.0, 0.0)


def block(width: float, height: float) -> Loop:
    x, y = 0.5 * width, 0.5 * height
    corners = ((-x, -y), (x, -y), (x, y), (-x, y))
    return Loop(tuple(Line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)))


def disc(radius: float, hole: bool = False) -> Loop:
    return Loop((Arc(0.0, 0.0, radius, 0.3, math.tau * (-1.0 if hole else 1.0)),), hole=hole)


def ring(outer: float, inner: float) -> tuple[Loop, Loop]:
    return disc(outer), disc(inner, hole=True)


@pytest.mark.parametrize(
    ("a", "b", "pose", "truth"),
    [
        (disc(1.0), disc(0.5), (2.0, 0.0, 0.0), 0.5),
        (disc(1.0), disc(0.5), (0.9, 1.2, 7.0), 0.0),
        (disc(1.0), disc(0.5), (1.2, 0.0, 0.0), -0.3),
        (disc(1.0), disc(0.5), HERE, -0.5),
        (block(2.0, 2.0), block(1.0, 1.0), (2.0, 0.3, 0.0), 0.5),
        (block(2.0, 2.0), block(1.0, 1.0), (2.0, 2.0, 0.0), math.hypot(0.5, 0.5)),
        (block(2.0, 2.0), block(2.0, 2.0), (1.0 + math.sqrt(2.0), 0.0, 0.25 * math.pi), 0.0),
        (block(2.0, 2.0), block(1.0, 1.0), (1.4, 0.0, 0.0), -0.1),
        (block(4.0, 0.5), block(0.5, 4.0), HERE, -0.25),
        (ring(2.0, 1.0), disc(0.4), (0.5, 0.0, 1.0), 0.1),
        (ring(2.0, 1.0), disc(0.4), (0.7, 0.0, 1.0), -0.1),
        (ring(2.0, 1.0), disc(1.0), HERE, 0.0),
        (ring(2.0, 1.0), disc(0.2), (1.6, 0.0, 0.0), -0.5),
        (Loop((Line(-1.0, 0.0, 1.0, 0.0),), closed=False), disc(0.5), (1.3, 0.4, 0.0), 0.0),
        (Loop((Line(-1.0, 0.0, 1.0, 0.0),), closed=False), disc(0.5), (0.0, 0.7, 0.0), 0.2),
    ],
)
def test_distances_known_in_advance(a: object, b: Loop, pose: tuple[float, float, float], truth: float) -> None:
    found = distance(a, HERE, b, pose)  # type: ignore[arg-type]
    assert found.value == pytest.approx(truth, abs=1e-12)
    assert math.dist(found.on_a, found.on_b) == pytest.approx(abs(truth), abs=1e-9)
    swapped = distance(b, pose, a, HERE)  # type: ignore[arg-type]
    assert swapped.value == pytest.approx(found.value, abs=1e-12)


@pytest.mark.slow
def test_distances_against_dense_sampling() -> None:
    """Apart to the sampling's error; overlapping never shallower than the deepest sample, and hardly deeper."""
    rng = np.random.default_rng(4)
    apart = within = 0
    for _ in range(150):
        one, other = ((*rng.uniform(-0.6, 0.6, 2), rng.uniform(-9.0, 9.0)) for _ in range(2))
        found = distance(BIG, one, SMALL, other)
        truth = nearest((BIG,), one, (SMALL,), other, SPACING)
        assert (found.value > 0.0) == (truth.gap > 0.0)
        if truth.gap > 0.02:
            assert found.value == pytest.approx(truth.gap, abs=SPACING**2 / (2.0 * truth.gap) + SPACING**2)
            assert math.dist(found.on_a, found.on_b) == pytest.approx(found.value, abs=1e-14)
            apart += 1
        elif truth.gap < 0.0:
            assert truth.gap - 0.5 * SPACING < found.value < truth.gap + SPACING**2 / 0.3  # sagittas of chords
            within += 1
    assert apart > 20
    assert within > 20


def test_the_smallest_gap_of_contacts_is_the_distance() -> None:
    """Apart, and unless a corner is nearest to a corner."""
    rng = np.random.default_rng(6)
    agreed = 0
    for _ in range(200):
        one, other = ((*rng.uniform(-0.9, 0.9, 2), rng.uniform(-9.0, 9.0)) for _ in range(2))
        found = distance(BIG, one, SMALL, other)
        if found.value <= 0.0:
            continue
        rows = gap(BIG, one, SMALL, other)
        contacts = rows[(rows["margin"] >= 0.0) & (rows["g"] > 0.0)]
        nearest_one = contacts[np.argmin(contacts["g"])] if len(contacts) else None
        if nearest_one is None or nearest_one["g"] > found.value + 1e-12:
            corners = [edge.start for edge in SMALL.edges] + [edge.start for edge in BIG.edges]
            assert corners  # a corner was nearest to a corner: there is no gap function for that
            continue
        assert nearest_one["g"] == pytest.approx(found.value, abs=1e-14)
        points = found.on_a, found.on_b
        assert min(math.dist(nearest_one["point"], p) for p in points) < 1e-12
        assert nearest_one["n"] @ np.subtract(*points) == pytest.approx(found.value, abs=1e-14)
        agreed += 1
    assert agreed > 40


def test_rows_name_the_primitives_in_the_order_of_the_outline() -> None:
    rows = gap(disc(1.0), HERE, block(2.0, 2.0), (0.0, 3.0, 0.0))
    assert set(rows["kind_a"]) == {"arc"}
    assert sorted(zip(rows["kind_b"].tolist(), rows["index_b"].tolist(), strict=True)) == [
        *(("corner", i) for i in range(4, 8)),
        *(("line", i) for i in range(4)),
    ]
    bottom = rows[(rows["kind_b"] == "line") & (rows["index_b"] == 0)][0]
    assert bottom["g"] == pytest.approx(1.0)
    assert bottom["n"] == pytest.approx((0.0, -1.0))
    assert bottom["point"] == pytest.approx((0.0, 1.0))
    assert bottom["margin"] == pytest.approx(1.0)


def test_kinematics_add_up() -> None:
    """A disc that rolls along a bar: no gap rate, no slip; its point against the bar accelerates by v²/r."""
    velocity = (0.6, 0.0, -0.6 / 0.5)
    row = kinematics(disc(0.5), (0.1, 1.5, 2.0), velocity, block(4.0, 2.0), HERE, HERE)
    top = row[(row["kind_b"] == "line") & (row["index_b"] == 2)][0]
    assert top["g"] == pytest.approx(0.0, abs=1e-15)
    assert top["g_N_dot"] == pytest.approx(0.0, abs=1e-15)
    assert top["g_T_dot"] == pytest.approx(0.0, abs=1e-15)
    assert top["w_N"] @ (*velocity, *HERE) == pytest.approx(top["g_N_dot"], abs=1e-15)
    assert top["w_N"] == pytest.approx((0.0, 1.0, 0.0, 0.0, -1.0, -0.1), abs=1e-15)
    assert top["w_T"] == pytest.approx((-1.0, 0.0, -0.5, 1.0, 0.0, -1.0), abs=1e-15)


def test_the_package_offers_them() -> None:
    assert (watchsim.distance, watchsim.gap, watchsim.kinematics) == (distance, gap, kinematics)


def test_an_outline_without_edges_is_refused() -> None:
    with pytest.raises(ValueError, match="no edges"):
        distance(Loop(()), HERE, disc(1.0), HERE)


def test_edges_without_length_change_nothing() -> None:
    """Points and arcs of no length, or of less than the drawing's rounding, between and beside the edges of an outline."""
    edges: list[Edge] = []
    for edge in BIG.edges:
        x, y = edge.start
        edges += [Line(x, y, x, y), Line(x, y, x + 1e-16, y), Arc(x - 1e-13, y, 1e-13, 0.0, 1e-3), edge]
    spoilt, pose = Loop(tuple(edges)), (0.9, 0.2, 2.0)
    assert distance(spoilt, HERE, SMALL, pose).value == pytest.approx(distance(BIG, HERE, SMALL, pose).value, abs=1e-14)
    rows, clean = gap(spoilt, HERE, SMALL, pose), gap(BIG, HERE, SMALL, pose)
    assert len(rows) == len(clean)
    for field in ("g", "n", "point", "margin"):
        assert rows[field] == pytest.approx(clean[field], abs=1e-12)


def test_concentric_circles_have_a_gap() -> None:
    """A ball in the middle of a ring is equally far from it all round; a hair beside the middle it has a side."""
    inside = gap(disc(0.4), HERE, ring(2.0, 1.0), HERE)
    assert np.isfinite(inside["g"]).all() and np.abs(inside["g"]).min() == pytest.approx(0.6, abs=2e-16)
    beside = gap(disc(0.4), (1e-12, 0.0, 0.0), ring(2.0, 1.0), HERE)
    row = beside[np.argmin(np.abs(beside["g"]))]
    assert row["margin"] >= 0.0 and row["g"] == pytest.approx(0.6 - 1e-12, abs=3e-16)
    assert row["n"] == pytest.approx((-1.0, 0.0), abs=1e-3)


def test_flat_on_flat_is_two_corners_on_a_line() -> None:
    """The two lower corners of a block on a table, gaps and margins to rounding; nothing else is as near."""
    table, box = block(4.0, 1.0), block(1.0, 1.0)
    rows = gap(box, (0.3, 1.0, 0.0), table, HERE)
    near = rows[(rows["margin"] >= -1e-15) & (np.abs(rows["g"]) < 1e-9)]
    assert sorted(near["point"][:, 0]) == pytest.approx([-0.2, 0.8], abs=1e-15)
    assert set(near["kind_a"]) == {"corner"} and set(near["kind_b"]) == {"line"}


@pytest.mark.parametrize("count", [60, pytest.param(600, marks=pytest.mark.slow)])
def test_corner_on_corner_is_met_by_an_edge_first(count: int) -> None:
    """Wherever two corners come together, the smallest gap inside primitives is their distance, or that of an edge."""
    rng = np.random.default_rng(4)
    for _ in range(count):
        turn, off = rng.uniform(-math.pi, math.pi), rng.normal(size=2) * 10.0 ** rng.uniform(-12, -2)
        corner = np.array([0.5, 0.5]) @ np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
        pose = (0.5 + off[0] - corner[0], 0.5 + off[1] - corner[1], turn)
        apart = distance(block(1.0, 1.0), HERE, block(1.0, 1.0), pose).value
        rows = gap(block(1.0, 1.0), HERE, block(1.0, 1.0), pose)
        real = rows[(rows["margin"] >= -1e-12)]
        if apart > 1e-10 and len(real) and real["g"].min() > 0.0:
            assert real["g"].min() >= apart - 1e-13


@pytest.mark.parametrize("angle", [0.0, 0.4, 1.9, -2.7])
@pytest.mark.parametrize("far", [0.0, 30.0])
def test_an_outline_that_lies_within_another_without_crossing_it_is_found_wherever_both_stand(angle: float, far: float) -> None:
    """The depth is that of its edge deepest inside, which the placing of both together does not change."""
    c, s = math.cos(angle), math.sin(angle)
    # The small block lies 20 and 30 m from the origin of its own frame, which is turned by a quarter against the long one's.
    x, y = 3.2 + 30.0, 0.5 - 20.0
    there = (far + c * x - s * y, -far + s * x + c * y, angle + 0.5 * math.pi)
    found = distance(block(8.0, 2.0), (far, -far, angle), block(0.5, 1.0).moved(0.0, (20.0, 30.0)), there)
    assert found.value == pytest.approx(-0.75, abs=1e-9)  # of the edge at 0.25, below the long side at 1
