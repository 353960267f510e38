"""What is known of a study of tolerances from its rows, however they came together?

Yield, spread of every output, what each dimension contributes, what the linear prediction says of all that, and the failures.
"""

from __future__ import annotations

import dataclasses
import functools
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from watchsim.analysis.verdict_kinds import TICKS
from watchsim.displays import notebook_html
from watchsim.scene.keys import in_words
from watchsim.scene.roles import timekeeper
from watchsim.studies.chaos import FEWEST, Basis, indices
from watchsim.studies.point import OUTPUTS, Row
from watchsim.studies.sampling import Floats, Space, deviation
from watchsim.studies.sensitivity import SMOOTH
from watchsim.studies.tolerance_plan import Plan
from watchsim.studies.yields import (
    FEW,
    Flags,
    Ints,
    Predict,
    Share,
    controlled,
    predicted_yield,
    replicated,
    sequence_of,
    share_of,
    weighted,
    wilson,
)
from watchsim.units import known_unit, rounded

SHOWN = 20  # of the worst samples
ROUNDING = 1e-9  # of a degree, a millisecond: what is less was to be 0
LEAST_KNOWN = 32  # samples with an output, for what contributes to it
QUANTILES = (0.00135, 0.05, 0.5, 0.95, 0.99865)


@dataclass(frozen=True)
class Spread:
    """Of one output over all samples that have it; cp and cpk where there are limits, linear_... by the linear prediction.

    linear_sigma is the root of the sum of squares, linear_low to linear_high the worst case; `remark` says where linear
    misleads.
    """

    mean: float
    sigma: float
    quantiles: dict[str, float]
    cp: float | None
    cpk: float | None
    count: int
    nominal: float | None = None
    linear_sigma: float | None = None
    linear_low: float | None = None
    linear_high: float | None = None
    remark: str = ""


@dataclass(frozen=True)
class Contribution:
    """What one input does to one output: shares of its variance (Sobol indices) with standard errors.

    linear  its share by the linear prediction, rank Spearman's correlation; first and total None for correlated inputs
    """

    key: str
    first: float | None
    total: float | None
    first_error: float | None
    total_error: float | None
    linear: float | None
    rank: float


@dataclass(frozen=True)
class ToleranceStudy:
    """What came of all samples.

    yield_, yield_low, yield_high  share of good watches and its interval (95 %); `shares` by each way to estimate it
    outputs        column -> Spread;  contributions: column, "ticks" or "good" -> the inputs, the greatest total first
    explained      column -> share of its variance that the indices account for
    failures       what went wrong -> how often;  worst: samples with what is wrong with them;  message: for people
    rows           number -> what the sample gave;  values: number -> what it was made to (SI)
    """

    title: str
    samples: int
    good: int
    shares: dict[str, Share]
    outputs: dict[str, Spread]
    contributions: dict[str, tuple[Contribution, ...]]
    explained: dict[str, float]
    failures: dict[str, int]
    worst: tuple[dict[str, Any], ...]
    message: str
    seconds: dict[str, float]
    whole: bool
    wall_s: float
    plan: Plan
    rows: Mapping[int, Row]

    @property
    def yield_(self) -> float:
        """The share of good watches."""
        return self.shares["yield"].value

    @property
    def yield_low(self) -> float:
        """The lower end of its interval."""
        return self.shares["yield"].low

    @property
    def yield_high(self) -> float:
        """The upper end of its interval."""
        return self.shares["yield"].high

    def why_ranks(self, name: str) -> str:
        """Why what contributes to a column, "ticks" or "good" has rank correlations and no shares; "" where it has shares."""
        if self.contributions[name][0].total is not None:
            return ""
        if self.plan.space.correlated:
            return "inputs are correlated"
        if self.plan.shifted is not None:
            return "samples are drawn towards failures"
        return f"Sobol indices need {FEWEST * len(self.contributions[name])} samples that have the output"

    def __repr__(self) -> str:
        return f"<Tolerances of {self.title!r}: {self.good} of {self.samples} good; {self.message}>"

    def _repr_html_(self) -> str:
        return notebook_html(self)

    @cached_property
    def numbers_of(self) -> tuple[int, ...]:
        """The numbers of its samples."""
        return tuple(sorted(number for number in self.rows if number >= 0))

    def numbers(self) -> dict[str, Any]:
        """What `tolerance --json` prints."""
        return {
            "samples": self.samples,
            "good": self.good,
            "yield": self.yield_,
            "yield_low": self.yield_low,
            "yield_high": self.yield_high,
            "shares": {name: dataclasses.asdict(one) for name, one in self.shares.items()},
            "outputs": {name: dataclasses.asdict(one) for name, one in self.outputs.items()},
            "contributions": {name: [dataclasses.asdict(one) for one in each] for name, each in self.contributions.items()},
            "explained": self.explained,
            "failures": self.failures,
            "worst": list(self.worst),
            "message": self.message,
            "not_judged": list(self.plan.not_judged),
            "seconds_per_sample": self.seconds,
            "wall_s": self.wall_s,
        }


def failing(plan: Plan, row: Row) -> str:
    """What is wrong with a sample, in few words; "" for a good one."""
    if row["verdict"] not in (TICKS, None):
        return str(row["verdict"])
    if row["verdict"] is None and row["message"]:
        return "impossible"
    return next((words for one in plan.limits if (words := one.missed(row.get(one.column)))), "")


@dataclass(frozen=True)
class Samples:
    """The rows of samples in columns."""

    plan: Plan
    rows: tuple[Row, ...]
    numbers: Ints

    @cached_property
    def wrong(self) -> list[str]:
        return [failing(self.plan, row) for row in self.rows]

    @cached_property
    def good(self) -> Flags:
        return np.array([not words for words in self.wrong])

    @cached_property
    def points(self) -> tuple[Floats, Floats]:
        return self.plan.shares(self.numbers.tolist())

    @cached_property
    def deviations(self) -> Floats:
        return self.plan.space.deviations(self.points[0])

    @property
    def sequence(self) -> Ints:
        return sequence_of(self.numbers)

    def column(self, name: str) -> Floats:
        """Values, nan where there is none; 0 for rounding, as the draw of dead-beat pallets is."""
        values = np.array([row.get(name) if row.get(name) is not None else np.nan for row in self.rows], float)
        return np.where(np.abs(values) < ROUNDING, 0.0, values)


class Linear:
    """The prediction by differences between limit cycles near the nominal one: value and slopes of each output."""

    def __init__(self, plan: Plan, rows: Mapping[int, Row]) -> None:
        self.plan = plan
        points = plan.nudged()
        self.nominal, self.slopes = {}, {}
        if -1 not in rows or any(number not in rows for number in points):
            return
        moved = plan.space.deviations(np.array(list(points.values())))
        for one in OUTPUTS.values():
            name = SMOOTH.get(one.column, one.column)
            level, values = rows[-1].get(name), [rows[number].get(name) for number in points]
            if level is None or any(value is None for value in values):
                continue
            ends = np.array(values, float).reshape(-1, 2)
            steps = np.array([moved[2 * j + 1, j] - moved[2 * j, j] for j in range(len(ends))])
            self.nominal[one.column] = float(level)
            self.slopes[one.column] = (ends[:, 1] - ends[:, 0]) / steps

    def at(self, column: str, deviations: Floats) -> Floats:
        """The predicted values (n,); of a beat error its magnitude."""
        middle = self.plan.space.deviations(np.full((1, deviations.shape[1]), 0.5))
        values: Floats = self.nominal[column] + (deviations - middle) @ self.slopes[column]
        return np.abs(values) if column in SMOOTH else values

    def margins(self) -> Predict | None:
        """How far inside the limits predicted watches are; None where a limited output has no prediction."""
        limits = self.plan.limits
        if not limits or any(one.column not in self.slopes for one in limits):
            return None
        return lambda deviations: np.hstack([one.margins(self.at(one.column, deviations)) for one in limits])


def analysed(plan: Plan, rows: Mapping[int, Row], whole: bool, wall_s: float) -> ToleranceStudy:
    """Everything that follows from the rows."""
    numbers = np.array(sorted(number for number in rows if number >= 0), dtype=np.int64)
    samples = Samples(plan, tuple(rows[int(number)] for number in numbers), numbers)
    linear = Linear(plan, rows)
    shares = _shares(samples, linear) if len(numbers) else {"yield": Share(float("nan"), 0.0, 1.0, "no sample")}
    outputs: dict[str, Spread] = {}
    contributions: dict[str, tuple[Contribution, ...]] = {}
    explained: dict[str, float] = {}
    if len(numbers):
        outputs = {one.column: spread for one in OUTPUTS.values() if (spread := _spread(samples, linear, one.column))}
        contributions, explained = _contributions(samples, linear, tuple(outputs))
    seconds_of = {
        name: float(np.mean([row["seconds"].get(name, 0.0) for row in samples.rows if row.get("seconds")] or [0.0]))
        for name in ("geometry", "function", "cells", "motion")
    }
    return ToleranceStudy(
        title=plan.scene.title,
        samples=len(numbers),
        good=int(samples.good.sum()) if len(numbers) else 0,
        shares=shares,
        outputs=outputs,
        contributions=contributions,
        explained=explained,
        failures=dict(Counter(words for words in samples.wrong if words).most_common()),
        worst=tuple(_worst(samples)),
        message=_message(samples, shares["yield"]),
        seconds=seconds_of,
        whole=whole,
        wall_s=wall_s,
        plan=plan,
        rows=rows,
    )


def _shares(samples: Samples, linear: Linear) -> dict[str, Share]:
    """The yield by each way to estimate it; "yield" is the one that counts."""
    plan, good, sequence = samples.plan, samples.good, samples.sequence
    if plan.shifted is not None:
        found = weighted(good, samples.points[1], sequence)
        mean, half = replicated(samples.points[1], sequence)
        return {"yield": found, "weights": Share(mean, mean - half, mean + half, "their mean, which must be 1")}
    shares = {"yield": share_of(good, sequence)}
    shares["wilson"] = Share(float(good.mean()), *wilson(int(good.sum()), len(good)), "Wilson, independent samples")
    margins = linear.margins()
    if margins is not None:
        predicted: Flags = np.all(margins(samples.deviations) >= 0.0, axis=1)
        truth = predicted_yield(plan.space, margins, plan.seed)
        shares["predicted"] = Share(truth, truth, truth, "linear prediction")
        if min(int((good & ~predicted).sum()) + int((~good & predicted).sum()), int((~good).sum())) >= FEW:
            shares["controlled"] = controlled(good, predicted, truth, sequence)
    return shares


def _spread(samples: Samples, linear: Linear, column: str) -> Spread | None:
    values, weights = samples.column(column), samples.points[1]
    there = np.isfinite(values)
    if there.sum() < 2:
        return None
    x, w = values[there], weights[there] / weights[there].sum()
    mean = float(x @ w)
    sigma = float(np.sqrt(w @ (x - mean) ** 2 * len(x) / (len(x) - 1)))
    order = np.argsort(x, kind="stable")
    below = np.cumsum(w[order]) - 0.5 * w[order]
    quantiles = {f"{q:g}": float(np.interp(q, below, x[order])) for q in QUANTILES}
    cp = cpk = None
    for one in samples.plan.limits:
        if one.column == column and sigma:
            low, high = (end / one.factor for end in one.expectation.bounds)
            cp = (high - low) / (6.0 * sigma) if np.isfinite(high - low) else None
            cpk = min(high - mean, mean - low) / (3.0 * sigma)
    found = Spread(mean, sigma, quantiles, cp, cpk, int(there.sum()))
    return found if column not in linear.slopes else _with_linear(found, samples.plan.space, linear, column)


def _with_linear(found: Spread, space: Space, linear: Linear, column: str) -> Spread:
    parts = linear.slopes[column][:, None] * _range(space)
    cover = parts[:, 2:] @ parts[:, 2:].T * _correlation(space)
    sigma = float(np.sqrt(cover.sum()))
    level = linear.nominal[column]
    low, high = (level + float(np.sort(parts[:, :2], axis=1)[:, i].sum()) for i in (0, 1))
    level, sigma, low, high = (0.0 if abs(one) < ROUNDING else one for one in (level, sigma, low, high))
    if column in SMOOTH:  # shown as a magnitude
        low, high = 0.0 if low < 0.0 < high else min(abs(low), abs(high)), max(abs(low), abs(high))
    words = []
    if column not in SMOOTH and found.sigma > 0.0:
        if not 0.9 < sigma / found.sigma < 1.1:
            words.append(f"the linear sigma is {sigma / found.sigma:.2g} times that of the samples")
        if abs(found.mean - level) > 0.2 * found.sigma:
            words.append(f"the mean is {abs(found.mean - level) / found.sigma:.2g} sigmas away from the nominal value")
    return dataclasses.replace(
        found, nominal=abs(level) if column in SMOOTH else level, linear_sigma=sigma, linear_low=low, linear_high=high,
        remark="; ".join(words),
    )  # fmt: skip


def _range(space: Space) -> Floats:
    """(draws, 3): the deviations of both limits and the standard deviation of what is drawn first in each draw."""
    nodes = (np.arange(4096) + 0.5) / 4096
    firsts = [space.tolerances[draw.members[0]] for draw in space.draws]
    return np.array([[one.low, one.high, float(deviation(one, nodes).std())] for one in firsts])


def _correlation(space: Space) -> Floats:
    whole = np.eye(len(space.draws))
    places = {space.tolerances[draw.members[0]].key: j for j, draw in enumerate(space.draws) if len(draw.members) == 1}
    for one in space.correlated:
        i, j = (places[key] for key in one.between)
        whole[i, j] = whole[j, i] = one.coefficient
    return whole


def _contributions(
    samples: Samples, linear: Linear, columns: Sequence[str]
) -> tuple[dict[str, tuple[Contribution, ...]], dict[str, float]]:
    """Of each output, of whether it ticks and of whether it is good."""
    space = samples.plan.space
    owner = np.array([space.names.index(draw.name) for draw in space.draws])
    firsts = [space.tolerances[draw.members[0]] for draw in space.draws]
    independent = not space.correlated and samples.plan.shifted is None
    basis = Basis(samples.deviations, [functools.partial(deviation, one) for one in firsts]) if independent else None
    ticking = np.array([float(row["verdict"] == TICKS) for row in samples.rows])
    wanted = {column: samples.column(SMOOTH.get(column, column)) for column in columns}
    wanted |= {"ticks": ticking, "good": samples.good.astype(float)}
    found: dict[str, tuple[Contribution, ...]] = {}
    explained: dict[str, float] = {}
    for name, values in wanted.items():
        there = np.isfinite(values)
        if there.sum() < LEAST_KNOWN or float(np.ptp(values[there])) == 0.0:
            continue
        made = indices(basis, values, owner, samples.sequence) if basis is not None else None
        ranks = _ranks(samples.deviations[there], values[there])
        parts = None
        if name in linear.slopes:
            parts = np.bincount(owner, (linear.slopes[name] * _range(space)[:, 2]) ** 2, minlength=len(space.names))
            parts = parts / parts.sum() if parts.sum() else None
        each = []
        for k, key in enumerate(space.names):
            rank = float(max(ranks[owner == k], key=abs))
            share = None if parts is None else float(parts[k])
            if made is None:
                each.append(Contribution(key, None, None, None, None, share, rank))
            else:
                first, total, first_error, total_error = (
                    float(v[k]) for v in (made.first, made.total, made.first_error, made.total_error)
                )
                each.append(Contribution(key, first, total, first_error, total_error, share, rank))
        each.sort(key=lambda one: -(one.total if one.total is not None else abs(one.rank)))
        found[name] = tuple(each)
        if made is not None:
            explained[name] = made.explained
    return found, explained


def _ranks(deviations: Floats, values: Floats) -> Floats:
    """Spearman's rank correlation of each column with the values."""
    from scipy.stats import rankdata

    x = rankdata(deviations, axis=0)
    y = rankdata(values)
    x, y = x - x.mean(axis=0), y - y.mean()
    size = np.sqrt((x**2).sum(axis=0) * (y @ y))
    return np.divide(x.T @ y, size, out=np.zeros(x.shape[1]), where=size > 0.0)


def _worst(samples: Samples) -> Iterable[dict[str, Any]]:
    """The samples farthest out: those that do not tick first, then by how far outside, or near, the limits they are."""

    def reserve(i: int) -> float:
        if samples.wrong[i] and not any(samples.wrong[i].startswith(one.label) for one in limits):
            return -np.inf
        margins = [
            (one.margins(np.array([value])) / sizes[one.column]).min()
            for one in limits
            if (value := samples.rows[i].get(one.column)) is not None and sizes[one.column] > 0.0
        ]
        return float(min(margins, default=np.inf))

    limits = samples.plan.limits
    sizes = {one.column: one.factor * float(np.nanstd(samples.column(one.column))) for one in limits}
    order = sorted(range(len(samples.rows)), key=lambda i: (not samples.wrong[i], reserve(i)))
    for i in order[:SHOWN]:
        why = samples.wrong[i] or "good; the least reserve"
        message = samples.rows[i]["message"]
        yield {"sample": int(samples.numbers[i]), "why": f"{why}: {message}" if message else why}


def apart(samples: Samples, words: str) -> tuple[Floats, Floats]:
    """How the watches with that failure differ from all others on average, in sigmas and in SI, by draw."""
    mine = np.array([one == words for one in samples.wrong])
    off = samples.deviations
    differ: Floats = off[mine].mean(axis=0) - (off[~mine] if (~mine).any() else off).mean(axis=0)
    sigma = _range(samples.plan.space)[:, 2]
    return differ / np.where(sigma > 0.0, sigma, 1.0), differ


def _message(samples: Samples, share: Share) -> str:
    """The most probable failure, and how such watches differ from the others, for whoever makes them."""
    count = len(samples.rows)
    if not count:
        return "no sample was computed"
    low, high = (f"{100.0 * end:.4g}" for end in (share.low, share.high))
    first = f"{100.0 * share.value:.4g} % of the {timekeeper(samples.plan.scene, many=True)} are good ({low} to {high} %)"
    kinds = Counter(words for words in samples.wrong if words)
    if not kinds:
        return f"{first}; none of {count} samples fails"
    words, number = kinds.most_common(1)[0]
    space = samples.plan.space
    away, differ = apart(samples, words)
    traits = []
    for j in np.argsort(-np.abs(away), kind="stable")[:2]:
        one = space.tolerances[space.draws[j].members[0]]
        if abs(away[j]) * np.sqrt(number) > 3.0:
            size = abs(differ[j]) / known_unit(one.unit).factor
            side = "larger" if (away[j] > 0.0) == (one.nominal >= 0.0) else "smaller"  # of a torque to the left its magnitude
            gap = "" if one.unit in ("", "°") else " "
            traits.append(f"{in_words(space.draws[j].name)} is {rounded(size, 2)}{gap}{one.unit} {side}")
    how = f"; in these, on average, {' and '.join(traits)} than in the others" if traits else ""
    return f"{first}. Most failures: {words} ({number} of {int((~samples.good).sum())}){how}"
