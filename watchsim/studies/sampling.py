"""Which watches come out of the workshop: numbered draws of all dimensions within their tolerances?

Scrambled Sobol points (Owen 1995, by scipy.stats.qmc). A study consists of sixteen sequences with scramblings of their own, and
sample i is point i // 16 of sequence i % 16: what a sample is depends on its number alone, so that studies can be shared out,
gone on with and extended, and the scatter between the sequences is the error of any mean over all samples (randomised
quasi-Monte Carlo, L'Ecuyer and Lemieux 2002).
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtr, ndtri

from watchsim.scene.read_tolerances import SEQUENCES, matrix
from watchsim.scene.scene import Correlation, Tolerance

Floats = NDArray[np.float64]
BITS = 30  # of a Sobol point: no sequence may be longer than 2^30
CLEAR = 2.0**-33  # u stays so far from 0 and 1, where a normal distribution has no value


def deviation(tolerance: Tolerance, u: Floats) -> Floats:
    """The deviation (SI) below which a share u (0 to 1) of the parts lies."""
    middle, half = 0.5 * (tolerance.low + tolerance.high), 0.5 * (tolerance.high - tolerance.low)
    out: Floats
    if tolerance.shape == "normal":
        out = middle + tolerance.sigma * ndtri(u)
    elif tolerance.shape == "truncated":
        least, most = (ndtr(sign * half / tolerance.sigma) for sign in (-1.0, 1.0))
        out = middle + tolerance.sigma * ndtri(least + (most - least) * u)
    elif tolerance.shape == "triangular":
        rising = np.sqrt(0.5 * np.minimum(u, 1.0 - u))
        out = middle + half * np.where(u < 0.5, 2.0 * rising - 1.0, 1.0 - 2.0 * rising)
    elif tolerance.shape == "file":  # linear between the measured values, each in the middle of its share
        values = np.array(tolerance.measured)
        out = np.interp(u, (np.arange(len(values)) + 0.5) / len(values), values)
    else:
        out = middle + half * (2.0 * u - 1.0)
    return out


@dataclass(frozen=True)
class Draw:
    """One independent number: for one tolerance or all of a group, or for one tooth of it (`tooth`)."""

    name: str
    members: tuple[int, ...]  # of the space's tolerances
    tooth: int = 0


@dataclass(frozen=True)
class Space:
    """All that is drawn for one watch."""

    tolerances: tuple[Tolerance, ...]
    correlated: tuple[Correlation, ...] = ()

    @cached_property
    def draws(self) -> tuple[Draw, ...]:
        found: dict[str, Draw] = {}
        for i, one in enumerate(self.tolerances):
            for tooth in range(one.count):
                name = (one.group or one.key) + (f".{tooth}" if one.count > 1 else "")
                earlier = found[name].members if name in found else ()
                found[name] = Draw(one.group or one.key, (*earlier, i), tooth)
        return tuple(found.values())

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Of the inputs whose contributions are reported: groups, and tolerances without one."""
        return tuple(dict.fromkeys(draw.name for draw in self.draws))

    @cached_property
    def _mixing(self) -> Floats | None:
        """What makes correlated normal scores of independent ones; None where all are independent."""
        if not self.correlated:
            return None
        whole, _ = matrix([one.key for one in self.tolerances], self.correlated)
        places = np.array([draw.members[0] for draw in self.draws])
        teeth = (places[:, None] == places) & ~np.eye(len(places), dtype=bool)  # of one tolerance, each on its own
        made: Floats = np.linalg.cholesky(np.where(teeth, 0.0, whole[np.ix_(places, places)]))
        return made

    def uniform(self, numbers: Sequence[int], seed: int, extra: int = 0) -> Floats:
        """Sobol points (n, draws + extra) of the samples with those numbers."""
        from scipy.stats import qmc  # half a second to load

        wide, asked = len(self.draws) + extra, np.array(numbers, dtype=np.int64)
        out = np.empty((len(asked), wide))
        for sequence in np.unique(asked % SEQUENCES):
            mine = asked % SEQUENCES == sequence
            chance = np.random.default_rng([seed, int(sequence)])
            # Of few points some pairs of columns lie on a diagonal (Joe and Kuo 2008): in each sequence it is another pair.
            order = chance.permutation(wide)
            with warnings.catch_warnings():  # of points that are no power of two: balanced enough, see the coverage in tests
                warnings.simplefilter("ignore", UserWarning)
                engine = qmc.Sobol(wide, scramble=True, bits=BITS, seed=chance)
                points = engine.random(int(asked[mine].max()) // SEQUENCES + 1)[:, order]
            out[mine] = points[asked[mine] // SEQUENCES]
        return np.clip(out, CLEAR, 1.0 - CLEAR)

    def shares(self, independent: Floats) -> Floats:
        """The shares u of every draw, correlated as the scene says."""
        if self._mixing is None:
            return independent
        mixed: Floats = np.clip(ndtr(ndtri(independent) @ self._mixing.T), CLEAR, 1.0 - CLEAR)
        return mixed

    def deviations(self, shares: Floats) -> Floats:
        """The deviation (SI) of the first tolerance of each draw, (n, draws)."""
        columns = [deviation(self.tolerances[draw.members[0]], shares[:, j]) for j, draw in enumerate(self.draws)]
        return np.column_stack(columns) if columns else np.zeros((len(shares), 0))

    def changes(self, shares: Floats) -> dict[str, float | list[float]]:
        """The values (SI) of one watch, from its shares (draws,): dotted path -> value, or the values of all teeth."""
        values: dict[str, float | list[float]] = {}
        for draw, u in zip(self.draws, shares, strict=True):
            for i in draw.members:
                one = self.tolerances[i]
                value = one.nominal + float(deviation(one, np.array([u]))[0])
                if one.count == 1:
                    values[one.key] = value
                else:
                    listed = values.setdefault(one.key, [0.0] * one.count)
                    assert isinstance(listed, list)
                    listed[draw.tooth] = value
        return values


# Watches that hardly ever fail: more samples where failures lie, each counted by how much rarer it is in truth.


@dataclass(frozen=True)
class Shifted:
    """Normal scores about several points at once: `share` of the samples about 0, the rest about the `centres` (n, draws).

    The weight of a sample is the ratio of the true density to that of the mixture, which with a share about 0 is never above
    1 / share (defensive mixture, Hesterberg 1995).
    """

    centres: Floats
    parts: Floats
    share: float = 0.3

    def scores(self, points: Floats) -> tuple[Floats, Floats]:
        """Normal scores (n, draws) and weights (n,) of Sobol points (n, draws + 1), whose last column chooses the centre."""
        ends = np.cumsum(np.append(self.share, (1.0 - self.share) * self.parts))
        which = np.minimum(np.searchsorted(ends, points[:, -1]), len(self.parts))
        all_centres = np.vstack([np.zeros(self.centres.shape[1]), self.centres])
        scores = ndtri(points[:, :-1]) + all_centres[which]
        # log of N(z - c) / N(z)
        ratios = scores @ all_centres.T - 0.5 * (all_centres**2).sum(axis=1)
        mixture = np.exp(ratios) @ np.append(self.share, (1.0 - self.share) * self.parts)
        return scores, 1.0 / mixture


def plain_values(changes: Mapping[str, float | list[float]]) -> dict[str, float]:
    """Flat: the values of teeth as KEY.0, KEY.1 …"""
    flat: dict[str, float] = {}
    for key, value in changes.items():
        flat |= {f"{key}.{i}": one for i, one in enumerate(value)} if isinstance(value, list) else {key: value}
    return flat
