"""How large is the share of good watches, and how well is it known?

Intervals hold with a confidence of 95 %. Of quasi-random samples in replications the scatter between these counts (Student's
t); where hardly any sample fails, or hardly any is good, it is not known well enough, and the interval of Clopper and Pearson
(1934) for independent samples stands, which is then the wider one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import betaincinv, ndtr, ndtri, stdtrit

from watchsim.scene.read_tolerances import SEQUENCES
from watchsim.studies.sampling import CLEAR, Shifted, Space

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

CONFIDENCE = 0.95
FEW = 12  # failing or good samples, below which replications scatter too irregularly
CHEAP = 1 << 16  # watches of the linear prediction, to know its yield
SOUGHT = 100  # steps to the most probable failure
STEP = 1e-4  # of a score, for slopes
FARTHEST = 7.0  # sigmas: failures farther off are ignored


@dataclass(frozen=True)
class Share:
    """An estimate of a share with the ends of its interval; `by` says how it was made."""

    value: float
    low: float
    high: float
    by: str


def clopper_pearson(good: int, count: int) -> tuple[float, float]:
    """The exact interval for independent samples."""
    tail = 0.5 * (1.0 - CONFIDENCE)
    low = float(betaincinv(good, count - good + 1, tail)) if good else 0.0
    high = float(betaincinv(good + 1, count - good, 1.0 - tail)) if good < count else 1.0
    return low, high


def wilson(good: int, count: int) -> tuple[float, float]:
    """E. B. Wilson's interval (1927) for independent samples."""
    z, share = float(ndtri(0.5 + 0.5 * CONFIDENCE)), good / count
    middle = (share + z * z / (2 * count)) / (1.0 + z * z / count)
    half = z / (1.0 + z * z / count) * np.sqrt(share * (1.0 - share) / count + z * z / (4.0 * count * count))
    return float(middle - half), float(middle + half)


def replicated(values: Floats, sequence: Ints) -> tuple[float, float]:
    """The mean of all samples, and half the width of its interval by the scatter between replications; inf for fewer than 2."""
    groups = np.unique(sequence)
    if len(groups) < 2:
        return float(values.mean()), np.inf
    means = np.array([values[sequence == group].mean() for group in groups])
    t = float(stdtrit(len(groups) - 1, 0.5 + 0.5 * CONFIDENCE))
    return float(values.mean()), t * float(means.std(ddof=1)) / math.sqrt(len(groups))


def share_of(good: Flags, sequence: Ints) -> Share:
    """Of good ones among the samples."""
    count, number = len(good), int(good.sum())
    value, half = replicated(good.astype(float), sequence)
    if min(number, count - number) < FEW or not np.isfinite(half):
        return Share(value, *clopper_pearson(number, count), "Clopper and Pearson")
    return Share(value, max(0.0, float(value - half)), min(1.0, float(value + half)), "replications")


def controlled(good: Flags, predicted: Flags, truth: float, sequence: Ints) -> Share:
    """The same with a control variate: which samples a cheap prediction calls good, whose yield over all watches is `truth`.

    What remains to be estimated by samples is where the prediction is wrong.
    """
    known, real = predicted.astype(float), good.astype(float)
    spread = float(known.var())
    factor = float(np.cov(real, known, bias=True)[0, 1]) / spread if spread else 0.0
    value, half = replicated(real - factor * (known - truth), sequence)
    return Share(min(1.0, max(0.0, value)), max(0.0, float(value - half)), min(1.0, float(value + half)), "control variate")


def weighted(good: Flags, weights: Floats, sequence: Ints) -> Share:
    """The share of good watches from samples of which failing ones are more frequent than in truth, by `weights`."""
    value, half = replicated(weights * ~good, sequence)
    low, high = float(max(0.0, 1.0 - value - half)), float(min(1.0, 1.0 - value + half))
    return Share(1.0 - value, low, high, "importance sampling")


# The linear prediction knows where failures begin.

Predict = Callable[[Floats], Floats]  # deviations (n, draws) -> how far inside each limit (n, limits); negative outside


def predicted_yield(space: Space, margins: Predict, seed: int) -> float:
    """The share of all watches that the prediction calls good, by many more samples than are computed."""
    shares = space.shares(space.uniform(range(CHEAP), seed + 1))
    return float((margins(space.deviations(shares)) >= 0.0).all(axis=1).mean())


def towards_failures(space: Space, margins: Predict) -> Shifted | None:
    """Around the most probable failure at each limit, as the prediction has it; None where it reaches no limit.

    First-order reliability method: the point of a limit that is nearest to the middle in normal scores (Hasofer, Lind 1974), by
    scipy's SLSQP. The steps of Rackwitz and Fiessler (1978) go to and fro where scores of uniform dimensions near their ends
    move nothing any more. Limits out of reach are left out.
    """
    from scipy.optimize import minimize

    width = len(space.draws)

    def at(scores: Floats) -> Floats:
        shares = np.clip(ndtr(np.atleast_2d(scores)), CLEAR, 1.0 - CLEAR)
        return margins(space.deviations(space.shares(shares)))

    def slope(scores: Floats, limit: int) -> Floats:
        ends = at(scores + STEP * np.vstack([np.eye(width), -np.eye(width)]))[:, limit]
        return (ends[:width] - ends[width:]) / (2.0 * STEP)

    found = []
    for limit, middle in enumerate(at(np.zeros(width))[0]):
        away = slope(np.zeros(width), limit)
        if middle == 0.0 or not away.any():
            continue
        kept = {"type": "eq", "fun": lambda u, k=limit, unit=middle: at(u)[0, k] / unit}
        kept["jac"] = lambda u, k=limit, unit=middle: slope(u, k) / unit
        begin = -np.sign(middle) * away / np.linalg.norm(away)
        got = minimize(
            lambda u: (0.5 * float(u @ u), u),
            begin,
            jac=True,
            method="SLSQP",
            bounds=[(-FARTHEST, FARTHEST)] * width,
            constraints=[kept],
            options={"maxiter": SOUGHT},
        )
        reached = abs(float(at(got.x)[0, limit])) <= 1e-3 * abs(float(middle))
        if reached and 0.0 < float(np.linalg.norm(got.x)) <= FARTHEST:
            found.append(got.x.round(6))  # the same on all machines
    if not found:
        return None
    parts = ndtr(-np.linalg.norm(found, axis=1))
    return Shifted(np.array(found), parts / parts.sum())


def sequence_of(numbers: Ints) -> Ints:
    """Which of the replications samples with those numbers belong to."""
    return np.asarray(numbers) % SEQUENCES
