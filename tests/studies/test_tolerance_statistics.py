"""Are indices, intervals and rare failures what closed forms say?"""

import math

import numpy as np
import pytest
from scipy.stats import norm, triang, truncnorm

from watchsim.scene.read_tolerances import SEQUENCES, deviations, fit
from watchsim.scene.scene import Correlation, Tolerance
from watchsim.studies.chaos import Basis, indices
from watchsim.studies.sampling import Shifted, Space, deviation
from watchsim.studies.yields import controlled, predicted_yield, sequence_of, share_of, towards_failures, weighted
from watchsim.units import ANGLE, LENGTH, UnitError


def uniform(count: int) -> Space:
    return Space(tuple(Tolerance(f"x{i}", 0.0, 0.0, 1.0, LENGTH) for i in range(count)))


def normal(count: int) -> Space:
    return Space(tuple(Tolerance(f"x{i}", 0.0, -3.0, 3.0, LENGTH, "normal", 1.0) for i in range(count)))


def drawn(space: Space, count: int, seed: int = 0):
    numbers = np.arange(count)
    return space.deviations(space.shares(space.uniform(numbers, seed))), sequence_of(numbers)


def ishigami(u):
    """Ishigami and Homma (1990), a = 7, b = 0.1, with its indices."""
    x = math.pi * (2.0 * u - 1.0)
    parts = 0.5 * (1.0 + 0.1 * math.pi**4 / 5.0) ** 2, 49.0 / 8.0, 0.01 * math.pi**8 * (1.0 / 18.0 - 1.0 / 50.0)
    first = np.array([parts[0], parts[1], 0.0]) / sum(parts)
    total = first + np.array([parts[2], 0.0, parts[2]]) / sum(parts)
    return np.sin(x[:, 0]) + 7.0 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0]), first, total


def g_function(u, a=(0.0, 1.0, 4.5, 9.0, 99.0, 99.0)):
    """Saltelli and Sobol (1995), with its indices."""
    a = np.array(a)
    own = 1.0 / (3.0 * (1.0 + a) ** 2)
    whole = np.prod(1.0 + own) - 1.0
    return np.prod((np.abs(4.0 * u - 2.0) + a) / (1.0 + a), axis=1), own / whole, own * (1.0 + whole) / (1.0 + own) / whole


@pytest.mark.parametrize(("function", "inputs", "count"), [(ishigami, 3, 1024), (g_function, 6, 4096)])
@pytest.mark.slow
def test_sobol_indices_are_those_of_closed_forms_to_one_per_cent(function, inputs, count):
    u, sequence = drawn(uniform(inputs), count)
    values, first, total = function(u)
    found = indices(Basis(u, [lambda share: share] * inputs), values, np.arange(inputs), sequence)
    assert found.first == pytest.approx(first, abs=0.01)
    assert found.total == pytest.approx(total, abs=0.01)
    assert found.explained > 0.99


def test_indices_of_a_sum_of_normal_inputs_are_shares_of_the_variance():
    """Two teeth that belong to one input count together, and what is not explained belongs to nobody."""
    space = normal(4)
    x, sequence = drawn(space, 256)
    values = x @ np.array([3.0, 2.0, 1.0, 1.0])
    quantiles = [lambda share, one=one: deviation(one, share) for one in space.tolerances]
    found = indices(Basis(x, quantiles), values, np.array([0, 1, 2, 2]), sequence)
    assert found.first == pytest.approx(np.array([9.0, 4.0, 2.0]) / 15.0, abs=1e-6)
    assert found.total == pytest.approx(found.first, abs=1e-6)
    missing = values + np.where(np.arange(256) % 5 == 0, np.nan, 0.0)
    assert indices(Basis(x, quantiles), missing, np.array([0, 1, 2, 2]), sequence).first[0] == pytest.approx(0.6, abs=1e-6)
    assert indices(Basis(x, quantiles), np.ones(256), np.arange(4), sequence) is None


DISTRIBUTIONS = [
    (Tolerance("x", 0.0, -2.0, 4.0, LENGTH), lambda x: np.clip((x + 2.0) / 6.0, 0.0, 1.0)),
    (Tolerance("x", 0.0, -2.0, 4.0, LENGTH, "normal", 0.5), norm(1.0, 0.5).cdf),
    (Tolerance("x", 0.0, -2.0, 4.0, LENGTH, "truncated", 2.0), truncnorm(-1.5, 1.5, loc=1.0, scale=2.0).cdf),
    (Tolerance("x", 0.0, -2.0, 4.0, LENGTH, "triangular"), triang(0.5, loc=-2.0, scale=6.0).cdf),
]


@pytest.mark.parametrize(("tolerance", "distribution"), DISTRIBUTIONS)
def test_a_deviation_is_the_quantile_of_its_distribution(tolerance, distribution):
    u = np.linspace(0.001, 0.999, 999)
    assert distribution(deviation(tolerance, u)) == pytest.approx(u, abs=1e-12)


def test_measured_values_are_drawn_as_often_as_they_were_measured():
    values = tuple(np.sort(np.random.default_rng(1).normal(size=500)).tolist())
    found = deviation(Tolerance("x", 0.0, -3.0, 3.0, LENGTH, "file", measured=values), (np.arange(4000) + 0.5) / 4000)
    assert found.mean() == pytest.approx(np.mean(values), abs=1e-3)
    assert found.std() == pytest.approx(np.std(values), abs=1e-2)
    assert found.min() >= values[0]
    assert found.max() <= values[-1]


def test_a_sample_depends_on_its_number_alone():
    space = normal(5)
    whole = space.uniform(range(200), 7)
    some = [3, 77, 150, 151]
    assert np.array_equal(space.uniform(some, 7), whole[some])
    assert not np.array_equal(space.uniform(some, 8), whole[some])


def test_correlated_dimensions_have_that_correlation_and_groups_one_draw():
    a, b = (Tolerance(key, 0.0, -3.0, 3.0, LENGTH, "normal", 1.0) for key in "ab")
    x, _ = drawn(Space((a, b), (Correlation(("a", "b"), -0.7),)), 4096)
    assert np.corrcoef(x.T)[0, 1] == pytest.approx(-0.7, abs=0.02)
    widths = (("pitch", 1.0, ""), ("height", 1.0, "cut"), ("width", 2.0, "cut"))
    teeth = (Tolerance(key, 0.0, -one, one, LENGTH, group=group, count=5) for key, one, group in widths)
    space = Space((a, *teeth, b), (Correlation(("a", "b"), -0.7),))
    each = np.corrcoef(drawn(space, 4096)[0].T)
    assert len(space.draws) == 12 and space.names == ("a", "pitch", "cut", "b")
    assert each[0, 11] == pytest.approx(-0.7, abs=0.02)
    assert np.abs(each - np.diag(np.diag(each)))[:11, :11].max() < 0.1  # teeth have errors of their own
    made = space.changes(space.shares(space.uniform([3], 0))[0])
    assert made["width"] == pytest.approx(2.0 * np.array(made["height"])) and len(set(made["height"])) == 5
    together = Space((Tolerance("c", 1.0, -1.0, 1.0, LENGTH, group="oil"), Tolerance("d", 5.0, -2.0, 2.0, LENGTH, group="oil")))
    assert together.names == ("oil",)
    assert together.changes(np.array([0.75])) == {"c": 1.5, "d": 6.0}


@pytest.mark.parametrize(("limit", "count"), [(0.5, 256), (2.0, 1024), (3.0, 2048)])
def test_the_interval_of_the_yield_covers_the_true_one_in_95_of_100(limit, count):
    """Of a sum of five normal deviations. Where few watches fail the exact interval stands, which covers more."""
    space, repetitions = normal(5), 300
    way = np.array([1.0, 0.8, 0.6, 0.4, 0.2])
    way /= np.linalg.norm(way)
    truth = norm.cdf(limit)
    covered = 0
    for seed in range(repetitions):
        x, sequence = drawn(space, count, seed)
        found = share_of(x @ way <= limit, sequence)
        covered += found.low <= truth <= found.high
    assert covered / repetitions >= 0.92
    assert covered / repetitions <= 0.98 or limit == 3.0


def test_two_dimensions_that_matter_together_are_drawn_independently_in_short_sequences():
    """Of few Sobol points some pairs of columns lie on a diagonal; the same pair in all sequences would spoil the yield."""
    space, shares = uniform(20), []
    for seed in range(30):
        x, sequence = drawn(space, 512, seed)
        shares.append(share_of(~((x[:, 8] > 0.6) & (x[:, 10] < 0.4)), sequence).value)
    assert np.mean(shares) == pytest.approx(0.84, abs=0.008)
    assert np.std(shares) < math.sqrt(0.16 * 0.84 / 512)


def test_a_control_variate_narrows_the_interval_and_leaves_the_mean():
    space = normal(4)
    truths, ratios = [], []
    for seed in range(40):
        x, sequence = drawn(space, 512, seed)
        linear = x.sum(axis=1)
        good, predicted = linear + 0.1 * x[:, 0] ** 2 <= 2.0, linear <= 2.0
        truth = predicted_yield(space, lambda off: (2.0 - off.sum(axis=1))[:, None], seed)
        plain, better = share_of(good, sequence), controlled(good, predicted, truth, sequence)
        truths.append(better.value)
        ratios.append((better.high - better.low) / (plain.high - plain.low))
    x = np.random.default_rng(0).normal(size=(2_000_000, 4))
    assert np.mean(truths) == pytest.approx(np.mean(x.sum(axis=1) + 0.1 * x[:, 0] ** 2 <= 2.0), abs=2e-3)
    assert np.median(ratios) < 0.6


@pytest.mark.parametrize("beta", [3.5, 4.5])
def test_rare_failures_are_counted_by_their_true_frequency(beta):
    """Two limits of a sum of normal deviations, the second farther off: P = Φ(-β) + Φ(-β - 0.3)."""
    space = normal(6)
    way = np.ones(6) / math.sqrt(6.0)

    def margins(off):
        return np.column_stack([beta - off @ way, off @ way + beta + 0.3])

    shifted = towards_failures(space, margins)
    assert isinstance(shifted, Shifted)
    assert np.linalg.norm(shifted.centres, axis=1) == pytest.approx([beta, beta + 0.3], rel=1e-3)
    truth, numbers, found = norm.cdf(-beta) + norm.cdf(-beta - 0.3), np.arange(2048), []
    for seed in range(60):
        scores, weights = shifted.scores(space.uniform(numbers, seed, extra=1))
        found.append(weighted((margins(scores) >= 0.0).all(axis=1), weights, sequence_of(numbers)))
        assert weights.max() <= 1.0 / shifted.share + 1e-9
        assert weights.mean() == pytest.approx(1.0, abs=0.1)
    assert np.mean([1.0 - one.value for one in found]) == pytest.approx(truth, rel=0.03)
    assert sum(1.0 - one.high <= truth <= 1.0 - one.low for one in found) >= 52


@pytest.mark.parametrize("short", [1.0, 1.3])
def test_rare_failures_in_a_corner_of_uniform_dimensions(short):
    """Six deviations of the range ±1, whose sum is within `short` of the largest: a simplex of volume short⁶/6! in 2⁶."""
    space = Space(tuple(Tolerance(f"x{i}", 0.0, -1.0, 1.0, LENGTH) for i in range(6)))

    def margins(off):
        return 6.0 - short - off.sum(axis=1, keepdims=True)

    shifted = towards_failures(space, margins)
    assert isinstance(shifted, Shifted)
    truth, numbers, found = short**6 / math.factorial(6) / 2.0**6, np.arange(2048), []
    for seed in range(40):
        scores, weights = shifted.scores(space.uniform(numbers, seed, extra=1))
        off = space.deviations(space.shares(norm.cdf(scores)))
        found.append(weighted((margins(off) >= 0.0).all(axis=1), weights, sequence_of(numbers)))
    assert np.mean([1.0 - one.value for one in found]) == pytest.approx(truth, rel=0.1)
    assert np.std([1.0 - one.value for one in found]) < 0.2 * truth


# ISO 286-1:2010 in µm, from its tables of deviations (ISO 286-2).
@pytest.mark.parametrize(
    ("name", "size_mm", "low", "high"),
    [
        ("h6", 2.0, -6, 0),
        ("g6", 5.0, -12, -4),
        ("H7", 8.0, 0, 15),
        ("js5", 12.0, -4, 4),
        ("m6", 2.0, 2, 8),
        ("F8", 20.0, 20, 53),
    ],
)
def test_fit_classes_are_those_of_the_standard(name, size_mm, low, high):
    assert fit(name, 1e-3 * size_mm) == pytest.approx((1e-6 * low, 1e-6 * high))


def test_limits_are_read_with_one_unit_or_two():
    assert deviations("±5 µm", 0.0, LENGTH) == pytest.approx((-5e-6, 5e-6))
    assert deviations("+0/-8 µm", 0.0, LENGTH) == pytest.approx((-8e-6, 0.0))
    assert deviations("-1 µm/+0.002 mm", 0.0, LENGTH) == pytest.approx((-1e-6, 2e-6))
    for text in ("+8/+3 µm", "5 µm", "±0 µm", "h12", "±5 mm²", "h6"):
        with pytest.raises(UnitError):
            deviations(text, 0.0, LENGTH)
    with pytest.raises(UnitError):
        deviations("h6", 0.1, ANGLE)
    assert SEQUENCES == 16
