"""How are pieces shared out among arcs, how are their tangents tilted, and what is learnt from their deviations?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.geometry.biarcs import ArcChain, Bundle, Curve, Demand, arcs_for, laid_out, shares
from watchsim.geometry.fitting import Legs, Trial, _abreast, _legs_at, _mirrored, _tilt, lay_chains

PARABOLA = [(0.0, 0.0), (0.5, 0.0), (1.0, 1.0)]  # x = t, y = t²
SLANT = [(0.0, 1.0), (1.5, 3.0), (3.0, 5.0)]  # x = 3 t, y = 1 + 4 t


def curve_of(*spans: list[tuple[float, float]]) -> Curve:
    p = np.array(spans)
    return Curve(np.concatenate((p, np.ones((*p.shape[:2], 1))), axis=2), np.arange(len(p) + 1.0))


def test_the_fewest_arcs_that_do_the_work() -> None:
    work = np.linspace(0.0, 20.0, 4002)[1:]  # no number at which the answer changes

    def fewest(needed: float) -> int:
        return next(n for n in range(2, 99) if n - (0.56 if n % 2 else 0.62) >= needed)

    assert arcs_for(work).tolist() == [fewest(needed) for needed in work.tolist()]


def test_single_arcs_at_the_ends_and_biarcs_between_them() -> None:
    layout = laid_out(np.array([2, 5, 3, 4, 6]))
    assert layout.chain.tolist() == [0, 1, 1, 1, 2, 2, 3, 3, 3, 4, 4, 4, 4]
    assert layout.capacity.tolist() == [1.38, 0.69, 2.0, 1.75, 0.69, 1.75, 0.69, 2.0, 0.69, 0.69, 2.0, 2.0, 0.69]
    assert np.flatnonzero(layout.single).tolist() == [1, 4, 6, 8, 9, 12]
    assert layout.first.tolist() == [0, 1, 4, 6, 9] and layout.last.tolist() == [0, 3, 5, 8, 12]
    assert layout.start.tolist() == [0, 2, 3, 4, 6, 7, 9, 10, 11, 13, 14, 15, 16]


def test_pieces_share_the_load_by_what_they_can_do() -> None:
    """Two chains from 0.5 to 1.5 and from 3 to 5; between the curves is one unit of load."""
    demand = Demand(np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0]), np.array([0.0, 4.0, 10.0, 11.0, 12.0, 19.0]))
    nodes, load = shares(demand, np.array([0.5, 3.0]), np.array([1.5, 5.0]), laid_out(np.array([5, 4])))
    unit, other = 5.0 / 4.44, 8.0 / 3.38
    expected = [2.0, 2.0 + 0.69 * unit, 2.0 + 2.69 * unit, 7.0, 11.0, 11.0 + 0.69 * other, 11.0 + 2.69 * other, 19.0]
    assert load == pytest.approx(expected, rel=1e-12)
    places = [0.5, 0.25 * expected[1], 1.0 + (expected[2] - 4.0) / 6.0, 1.5]
    places += [3.0, 4.0 + (expected[5] - 12.0) / 7.0, 4.0 + (expected[6] - 12.0) / 7.0, 5.0]
    assert nodes == pytest.approx(places, rel=1e-12, abs=0.0)


def trial() -> Trial:
    """Three chains of two, five and four arcs."""
    errors = np.array([1.0, 3.0, 2.0, 8.0, 1e-3, 70.0, 5.0, 0.5, 6.0, 0.0, 9.0])
    chain = np.array([0, 0, 1, 1, 1, 1, 1, 2, 2, 2, 2])
    nothing = np.zeros(len(chain))
    four = np.zeros((4, len(chain), 2))
    arcs = ArcChain(four[0], four[1], four[2], four[3], nothing)
    legs = Legs(np.arange(7.0) + 0.5, np.array([0.1, 0.2, 0.3, 0.4, 0.6, 0.7, 0.8]))
    return Trial(
        nothing, nothing, arcs, chain, errors, laid_out(np.array([2, 5, 4])), nothing, legs, np.array([0, 2, 3, 5, 7, 8, 10])
    )


def test_work_is_the_capacity_times_the_mean_of_the_cube_roots() -> None:
    """Of each deviation over the tolerance of its chain, 64 at most."""
    root = np.cbrt([1.0 / 0.5, 3.0 / 0.5, 2.0, 8.0, 1e-3, 64.0, 5.0, 0.25, 3.0, 0.0, 4.5]).tolist()
    means = [(root[0] + root[1]) / 2, root[2], (root[3] + root[4]) / 2, (root[5] + root[6]) / 2]
    means += [root[7], (root[8] + root[9]) / 2, root[10]]
    expected = np.array([1.38, 0.69, 2.0, 1.75, 0.69, 2.0, 0.69]) * means
    assert trial().work(np.array([0.5, 1.0, 2.0])) == pytest.approx(expected, rel=1e-12)
    assert trial().worst().tolist() == [3.0, 70.0, 9.0]


def test_legs_move_towards_equal_deviations_and_single_arcs_take_their_neighbours() -> None:
    """A tenth of the logarithm, a half at most: 8000 times as large is too much, and so is something over nothing."""
    places, logarithms = trial().balanced()
    assert places.tolist() == [0.5, 1.5, 2.5, 3.5, 4.5, 5.5, 6.5]
    two, three, five = 0.3 + 0.5, 0.4 + 0.1 * math.log(14.0), 0.7 + 0.5
    assert logarithms == pytest.approx([0.1 - 0.1 * math.log(3.0), two, two, three, five, five, five], rel=1e-12)
    other = trial()._replace(errors=np.array([1.0, 3.0, 2.0, 1e-3, 8.0, 70.0, 5.0, 0.5, 0.0, 6.0, 9.0]))
    assert other.balanced().logarithms == pytest.approx(
        [0.1 - 0.1 * math.log(3.0), -0.2, -0.2, three, 0.2, 0.2, 0.2], rel=1e-12, abs=0.0
    )


def test_legs_are_those_before_and_beyond_them_like_the_outermost_of_a_curve() -> None:
    """Two curves with trials from 0 to 2 and from 3 to 5; now five and three arcs, by their pieces."""
    before = Legs(np.array([0.4, 1.6, 3.5, 4.5, 4.9]), np.array([1.0, 4.0, 5.0, 9.0, 2.0]))
    layout, places = laid_out(np.array([5, 3])), np.array([0.1, 0.7, 1.9, 3.2, 4.6])
    found = _legs_at(places, before, np.array([0.0, 3.0]), np.array([2.0, 5.0]), layout)
    assert found.places is places and found.logarithms == pytest.approx([1.0, 1.75, 4.0, 5.0, 7.25], rel=1e-12)
    nothing = _legs_at(places, Legs(np.empty(0), np.empty(0)), np.array([0.0, 3.0]), np.array([2.0, 5.0]), layout)
    assert nothing.logarithms.tolist() == [0.0] * 5


def test_a_tangent_is_mirrored_in_the_chord() -> None:
    chord, tangent = (
        np.array([(3.0, 1.0), (-0.5, 2.0)]),
        np.array([(math.cos(1.0), math.sin(1.0)), (math.cos(2.5), math.sin(2.5))]),
    )
    across = 2.0 * np.arctan2(chord[:, 1], chord[:, 0]) - np.array([1.0, 2.5])
    assert _mirrored(chord, tangent) == pytest.approx(np.column_stack((np.cos(across), np.sin(across))), rel=1e-12, abs=0.0)


@pytest.mark.parametrize(
    ("back", "ahead", "turn_back", "turn_ahead", "tilt"),
    [
        (2.0, 3.0, 0.4, 0.7, -(0.7 * 2.0 - 0.4 * 3.0) / 30.0),
        (0.5, 3.0, -0.4, 0.3, -(0.3 * 0.5 + 0.4 * 3.0) / 21.0),
        (3.0, 0.5, 1.2, 2.9, -0.1),  # a tenth at most
        (3.0, 0.5, -1.2, -2.9, 0.1),
        (3.0, 1.0, 0.2, 0.86, -(0.86 * 3.0 - 0.2) / 24.0),
        (0.0, 0.0, 0.4, 0.7, 0.0),
    ],
)
def test_inner_tangents_are_tilted_against_the_rate_of_curvature(
    back: float, ahead: float, turn_back: float, turn_ahead: float, tilt: float
) -> None:
    """One inner node of the second chain, at (1, 2), where the curve runs at 0.8 rad."""

    def way(angle: float) -> list[float]:
        return [math.cos(angle), math.sin(angle)]

    here = np.array([1.0, 2.0])
    at = np.array([(9.0, 8.0), (7.0, 5.0), (0.0, 0.0), here, (4.0, 3.0)])
    halfway = np.array([(6.0, 6.0), here + back * np.array(way(0.3)), here + ahead * np.array(way(1.9))])
    tangents = np.array([way(angle) for angle in (0.1, 0.2, 0.5, 0.8, 1.3)])
    expected = tangents.copy()
    expected[3] = way(0.8 + tilt)
    layout = laid_out(np.array([2, 4]))._replace(chain=np.array([0, 1, 1]), first=np.array([0, 1]))
    _tilt(tangents, at, halfway, np.array([way(2.0), way(0.8 - turn_back), way(0.8 + turn_ahead)]), layout)
    assert tangents == pytest.approx(expected, rel=1e-12, abs=0.0)


def test_where_a_curve_is_abreast_of_a_joint() -> None:
    """On a straight line at once, on a parabola nearly; never in the outermost hundredth."""
    bundle = Bundle([curve_of(PARABOLA), curve_of(SLANT)])
    joints = np.array([(0.3, 1.0), (0.9, 2.5), (30.0, 50.0), (-30.0, -50.0)])
    along = np.array([(0.6, 0.8)] * 4)
    low, high = np.array([0.1, 2.2, 2.2, 2.2]), np.array([0.9, 2.7, 2.7, 2.7])
    found = _abreast(bundle, joints, along, low, np.array([0.65, 2.6, 2.3, 2.4]), high)
    # 0.6 t + 0.8 t² = 0.98; 0.6 · 3 t + 0.8 · (1 + 4 t) = 0.54 + 2.
    assert found == pytest.approx([0.7936, 2.348, 2.695, 2.205], abs=1e-4)
    assert found[1:] == pytest.approx([2.348, 2.695, 2.205], rel=1e-12)
    still = Bundle([curve_of([(1.0, 2.0)] * 3)])  # no better place is known than the guess
    assert _abreast(still, joints[:1], along[:1], np.array([0.1]), np.array([0.65]), np.array([0.9])).tolist() == [0.65]


def test_chains_run_from_end_to_end_and_meet_the_curve_at_their_nodes() -> None:
    bundle = Bundle([curve_of(PARABOLA), curve_of([(0, 0), (1, 2), (4, 1)])])
    demand = Demand(np.array([0.0, 0.3, 1.0, 2.0, 2.6, 3.0]), np.array([0.0, 3.0, 5.0, 6.0, 7.5, 9.5]))
    begin, end = np.array([0.0, 2.0]), np.array([1.0, 3.0])
    legs = Legs(np.array([0.1, 0.9, 2.1, 2.9]), np.array([0.3, -0.2, 0.4, 0.1]))
    found = lay_chains(bundle, demand, begin, end, np.array([5, 2]), legs)
    assert found.chain.tolist() == [0] * 5 + [1] * 2 and found.first.tolist() == [0, 1, 3, 5]
    nodes = bundle.points(found.nodes)
    arcs = found.arcs
    for piece, (arc, last) in enumerate(((0, 0), (1, 2), (3, 4), (5, 6))):
        node = piece + (piece > 2)
        assert arcs.starts[arc] == pytest.approx(nodes[node], abs=1e-12)
        assert arcs.ends[last] == pytest.approx(nodes[node + 1], abs=1e-12)
        assert (found.low[arc], found.high[last]) == (found.nodes[node], found.nodes[node + 1])
    for k in (0, 1, 2, 3, 5):
        assert arcs.starts[k + 1] == pytest.approx(arcs.ends[k]) and found.low[k + 1] == found.high[k]
        assert arcs.start_tangents[k + 1] == pytest.approx(arcs.end_tangents[k], abs=1e-9)
    for k in (1, 3, 5):  # the curve is abreast of the joint
        gap = bundle.points(found.high[k : k + 1])[0] - arcs.ends[k]
        assert abs(gap @ arcs.end_tangents[k]) < 1e-3 * math.dist(arcs.starts[k], arcs.ends[k])
    ends = bundle.tangents(np.array([0.0, 1.0, 2.0, 3.0]))
    assert arcs.start_tangents[[0, 5]] == pytest.approx(ends[[0, 2]]) and arcs.end_tangents[[4, 6]] == pytest.approx(
        ends[[1, 3]]
    )
    middles = 0.5 * (found.nodes[[0, 1, 2, 4]] + found.nodes[[1, 2, 3, 5]])
    expected = [np.interp(m, [0.1, 0.9], [0.3, -0.2]) for m in middles[:3]] + [np.interp(middles[3], [2.1, 2.9], [0.4, 0.1])]
    assert found.legs.places == pytest.approx(middles) and found.legs.logarithms == pytest.approx(expected, rel=1e-12)
