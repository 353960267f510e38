"""Which input is how much of a scatter: Sobol indices of samples that were drawn for another purpose?

The samples of a yield study are used, none is computed for the indices. A polynomial chaos is fitted to them: a sum of products
of polynomials, each orthonormal in the distribution of its input (arbitrary polynomial chaos, Oladyshkin and Nowak 2012), few
of many by greedy selection with the leave-one-out error as judge (sparse polynomial chaos, Blatman and Sudret 2011). Its
coefficients give first-order and total indices (Sudret 2008). What it does not explain is reported, and belongs to no input.
"""

from __future__ import annotations

import functools
import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

FEWEST = 4  # samples with the output for each input
NODES = 400  # at which a distribution is looked at for its polynomials
HIGHEST = 12  # degree
MOST_TERMS = 1200  # that are looked at; more take long and are found by chance
SHARE_KEPT, MOST_KEPT = 0.2, 240  # of the number of samples, and in all
ROUNDS = 14
GAIN = 0.995  # of the error: a round that lowers it less is the last but one
SHRINKS = 2  # rounds without gain until it ends


@dataclass(frozen=True)
class Indices:
    """Of one output: shares of its variance.

    first, total  by input: alone, and with all that it takes part in; `..._error` are standard errors
    explained     share of the variance that the polynomial explains, by leave-one-out
    """

    first: Floats
    total: Floats
    first_error: Floats
    total_error: Floats
    explained: float


def polynomials(quantile: Callable[[Floats], Floats], degree: int) -> Floats:
    """Coefficients (degree + 1, degree + 1) of the polynomials that are orthonormal in a distribution.

    Of powers of (x - mean) / spread; row k is the polynomial of degree k.
    """
    at, weights = _nodes()
    x = _standard(quantile(0.5 * (at + 1.0)), quantile)
    root = np.sqrt(0.5 * weights)
    r = np.linalg.qr(root[:, None] * np.vander(x, degree + 1, increasing=True), mode="r")
    made: Floats = (np.linalg.inv(r) * np.sign(np.diag(r))).T
    return made


@functools.lru_cache(maxsize=1)
def _nodes() -> tuple[Floats, Floats]:
    return np.polynomial.legendre.leggauss(NODES)


def _standard(values: Floats, quantile: Callable[[Floats], Floats]) -> Floats:
    low, middle, high = quantile(np.array([0.1, 0.5, 0.9]))
    return (values - middle) / (high - low)


def terms(inputs: int, samples: int) -> Ints:
    """Degrees (n, inputs) of the products that are looked at: the higher the degree, the fewer inputs take part.

    Degree and number of inputs grow until there are about so many as can be distinguished.
    """
    most = min(MOST_TERMS, max(samples, 1 + inputs))
    found = [(0,) * inputs]
    for degree in range(1, HIGHEST + 1):
        for taking in range(1, min(inputs, degree, 5) + 1):
            made = _products(inputs, degree, taking)
            count = sum(1 for _ in itertools.islice(made, most + 1 - len(found)))
            if len(found) + count > most:
                break
            found += _products(inputs, degree, taking)
    return np.array(found, dtype=np.int64)


def _products(inputs: int, degree: int, taking: int) -> itertools.chain[tuple[int, ...]]:
    """All degrees of `taking` inputs with that sum."""

    def one(chosen: Sequence[int], cuts: Sequence[int]) -> tuple[int, ...]:
        row = [0] * inputs
        for place, start, end in zip(chosen, (0, *cuts), (*cuts, degree), strict=True):
            row[place] = end - start
        return tuple(row)

    splits = list(itertools.combinations(range(1, degree), taking - 1))
    return itertools.chain.from_iterable(
        (one(chosen, cuts) for cuts in splits) for chosen in itertools.combinations(range(inputs), taking)
    )


class Basis:
    """The polynomials of all inputs at all samples; shared by the outputs of a study."""

    def __init__(self, values: Floats, quantiles: Sequence[Callable[[Floats], Floats]]) -> None:
        """values (n, inputs), and of each input the value below which a share of the samples lies."""
        self.degrees = terms(values.shape[1], len(values))
        highest = int(self.degrees.max(initial=0))
        powers = [
            np.vander(_standard(x, one), highest + 1, increasing=True) for x, one in zip(values.T, quantiles, strict=True)
        ]
        self.single = [p @ polynomials(one, highest).T for p, one in zip(powers, quantiles, strict=True)]
        self.count = len(values)

    def at(self, rows: Ints, which: Sequence[int] | Ints) -> Floats:
        """The chosen products at some samples, (rows, n)."""
        out = np.ones((len(rows), len(which)))
        for column, term in enumerate(which):
            for place in np.flatnonzero(self.degrees[term]):
                out[:, column] *= self.single[place][rows, self.degrees[term, place]]
        return out


def indices(basis: Basis, output: Floats, owner: Ints, sequence: Ints) -> Indices | None:
    """The indices of an output (n,), nan where a sample has none; None where it does not vary, or hardly any sample has it.

    owner     by draw: the number of the input it belongs to; the teeth of a wheel are one input
    sequence  by sample: which of the replications it belongs to, by which errors are judged (delete-one-group jackknife)
    """
    rows = np.flatnonzero(np.isfinite(output))
    if len(rows) < FEWEST * len(set(owner.tolist())) or float(np.ptp(output[rows])) == 0.0:
        return None
    y = output[rows] - output[rows].mean()
    scale = float(y.std())
    y = y / scale
    chosen, explained = _selected(basis, rows, y)
    matrix = basis.at(rows, chosen)
    groups = np.unique(sequence[rows])
    grams = np.array([matrix[sequence[rows] == g].T @ matrix[sequence[rows] == g] for g in groups])
    sides = np.array([matrix[sequence[rows] == g].T @ y[sequence[rows] == g] for g in groups])
    degrees = basis.degrees[chosen] > 0
    inputs = int(owner.max()) + 1
    takes = np.column_stack([degrees[:, owner == k].any(axis=1) for k in range(inputs)])
    first_of, total_of = takes & (takes.sum(axis=1) == 1)[:, None], takes

    def shares(gram: Floats, side: Floats) -> tuple[Floats, Floats]:
        squared = np.linalg.lstsq(gram, side, rcond=1e-10)[0] ** 2
        variance = squared @ takes.any(axis=1) + (1.0 - explained)
        return squared @ first_of / variance, squared @ total_of / variance

    first, total = shares(grams.sum(0), sides.sum(0))
    left = [shares(grams.sum(0) - grams[k], sides.sum(0) - sides[k]) for k in range(len(groups) if len(groups) > 1 else 0)]
    errors = [
        np.sqrt((len(groups) - 1) / len(groups) * ((one - one.mean(0)) ** 2).sum(0)) if left else np.full(inputs, np.nan)
        for one in (np.array([f for f, _ in left]), np.array([t for _, t in left]))
    ]
    return Indices(first, total, errors[0], errors[1], explained)


def _selected(basis: Basis, rows: Ints, y: Floats) -> tuple[Ints, float]:
    """The products that explain the output best, and which share of its variance they explain."""
    every = basis.at(rows, range(len(basis.degrees)))
    norms = np.sqrt((every**2).sum(axis=0))
    chosen, residual = np.array([0]), y
    best: tuple[float, Ints] = (1.0, chosen)
    worse, most = 0, max(2, min(int(SHARE_KEPT * len(rows)), MOST_KEPT))
    for _ in range(ROUNDS):
        scores = np.abs(residual @ every) / norms
        scores[chosen] = 0.0
        add = max(4, len(chosen) // 2)
        chosen = np.append(chosen, np.argsort(-scores, kind="stable")[: min(add, most - len(chosen), len(norms) - len(chosen))])
        error, residual, chosen = _fitted(every, chosen, y)
        worse = worse + 1 if error > GAIN * best[0] else 0
        if error < best[0]:
            best = (error, chosen)
        if worse >= SHRINKS or len(chosen) >= min(most, len(norms)) or error < 1e-14:
            break
    return best[1], 1.0 - best[0]


def _fitted(every: Floats, chosen: Ints, y: Floats) -> tuple[float, Floats, Ints]:
    """The leave-one-out error as a share of the variance, the residual, and the chosen products."""
    q, _ = np.linalg.qr(every[:, chosen])
    residual = y - q @ (q.T @ y)
    hat = np.minimum((q**2).sum(axis=1), 1.0 - 1e-9)
    return float(((residual / (1.0 - hat)) ** 2).mean()), residual, chosen
