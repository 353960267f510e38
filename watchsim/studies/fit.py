"""Which numbers of a scene make it do what was measured, how well are they known, and which cannot be distinguished?

Least squares by scipy's trust region. Intervals follow from the Jacobian at the best fit, in units of the scatter around it,
with Student's quantiles. Numbers that stand in for each other are a small singular value of its columns, each made one long.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.timing import beats
from watchsim.displays import notebook_html
from watchsim.scene.errors import Fault, SceneError
from watchsim.scene.load import changed
from watchsim.scene.roles import nominal_frequency, roles
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.studies.goals import Knob, knobs_from
from watchsim.studies.measured import ANGLE, ROUGH, SWING, Measured, raise_any, read_measured
from watchsim.studies.point import Question
from watchsim.studies.steady import steady
from watchsim.studies.workers import Executor, chosen
from watchsim.units import show

Array = NDArray[np.float64]

STEP = 1e-4  # of a value: of central differences
SURE = 0.95  # the intervals hold the true value so often
ALIKE = 1e-4  # of the largest singular value: below it the residuals do not change
VAGUE = 0.5  # of the values themselves, a standard deviation beyond which a direction is not known
SHARE = 0.2  # of a direction: numbers with less of it do not belong to it
LOST = 1e3  # residual of a scene that does not work, in standard deviations
ROUNDS = 3  # of finding the scatter of each kind of reading, and fitting again
EVALUATIONS = 60


@dataclass(frozen=True)
class Value:
    """`low` to `high`: 95 % interval, None where nothing that was measured bounds it; `old`: as the scene had it. SI."""

    value: float
    low: float | None
    high: float | None
    old: float


@dataclass(frozen=True)
class Fit:
    """The scene that does what was measured.

    residual  root mean square of what is left, in standard deviations; `scatter` of each kind of reading, in its unit, is known
              from the file where that has errors, else from what is left
    cannot_tell_apart  groups of keys; `words` says of each in which ratio they stand in for each other
    modelled  what the scene gives beside the measured values
    """

    title: str
    measured: Measured
    knobs: tuple[Knob, ...]
    found: bool
    message: str
    keys: Mapping[str, Value]
    residual: float | None
    scatter: Mapping[str, float]
    cannot_tell_apart: tuple[tuple[str, ...], ...]
    words: tuple[str, ...]
    modelled: Mapping[str, Array]
    evaluations: int
    wall_s: float
    scene: Scene = field(repr=False)

    def __repr__(self) -> str:
        keys = ", ".join(f"{one.key} = {one.shown(self.keys[one.key].value)}" for one in self.knobs if one.key in self.keys)
        return f"<Fit of {self.title!r} to {self.measured.name}: {keys or self.message}>"

    def _repr_html_(self) -> str:
        return notebook_html(self)

    @property
    def changes(self) -> dict[str, str]:
        """The values as texts for a scene file."""
        return {one.key: show(self.keys[one.key].value, one.unit, 10) for one in self.knobs if one.key in self.keys}

    def numbers(self) -> dict[str, Any]:
        """What `fit --json` prints."""
        keys = {key: {"value": one.value, "low": one.low, "high": one.high, "old": one.old} for key, one in self.keys.items()}
        return {
            "found": self.found,
            "message": self.message,
            "keys": keys,
            "residual": self.residual,
            "scatter": dict(self.scatter),
            "cannot_tell_apart": [list(group) for group in self.cannot_tell_apart],
            "words": list(self.words),
            "readings": self.measured.count,
            "evaluations": self.evaluations,
            "wall_s": self.wall_s,
        }


def fit(
    scene: Scene | str | Path,
    measured: str | Path | Measured,
    vary: Mapping[str, tuple[Any, Any] | None] | Iterable[str],
    *,
    tolerance: float | None = None,
    workers: int = 1,
    scheduler: str | None = None,
    progress: Callable[[int], None] | None = None,
) -> Fit:
    """Fit numbers of a scene to a measured decay, to readings of a timing machine, or to a recording.

    measured  a CSV file (docs/guide/fit.md), a WAV file, or what was read from one
    vary      paths of the scene, or {path: (from, to)} with limits; the search begins from the scene's own values

    SceneError with all that is wrong with file and keys; a scene that does not work as it is gives `found` False.
    """
    if not isinstance(scene, Scene):
        from watchsim.scene.load import load

        scene = load(scene)
    faults: list[Fault] = []
    knobs = knobs_from(scene, vary if isinstance(vary, Mapping) else dict.fromkeys(vary), faults, "fit")
    if not knobs and not faults:
        faults.append(Fault("--vary", 'name what may be changed, such as --vary "damping.0.q_factor"', place="fit"))
    known = measured if isinstance(measured, Measured) else read_measured(measured, scene, faults)
    if known is not None and knobs and known.count < len(knobs):
        few = f"{known.count} readings cannot decide {len(knobs)} numbers: vary fewer, or measure more"
        faults.append(Fault("--vary", few, place="fit"))
    if known is not None and known.times is not None and roles(scene).oscillator is None:
        faults.append(
            Fault("springs", "nothing in this scene swings on a spring or by gravity, so nothing decays", place="fit")
        )
    raise_any(faults)
    assert known is not None
    return Fitting(scene, known, knobs, chosen(workers, scheduler), tolerance, progress).result()


class Fitting:
    """Numbers as parts of their own values (of a tenth of their range where they are zero), so that all are of one size."""

    def __init__(
        self,
        scene: Scene,
        measured: Measured,
        knobs: tuple[Knob, ...],
        executor: Executor,
        tolerance: float | None = None,
        progress: Callable[[int], None] | None = None,
    ) -> None:
        self.begun, self.measured, self.knobs, self.executor, self.progress = (
            time.perf_counter(),
            measured,
            knobs,
            executor,
            progress,
        )
        nominal = nominal_frequency(scene) if scene.nominal is None else None
        self.scene = (
            scene if nominal is None else scene.set("timegrapher.frequency", nominal)
        )  # rates are against the train's own
        self.tolerance = tolerance
        self.base = np.array([one.value for one in knobs])
        self.size = np.array([abs(one.value) or 0.1 * (one.high - one.low) for one in knobs])
        self.low, self.high = (np.array(side) for side in ([one.low for one in knobs], [one.high for one in knobs]))
        self.kinds = tuple(measured.columns)
        self.given = np.concatenate([measured.columns[kind] for kind in self.kinds])
        self.used = np.isfinite(self.given)
        self.kind = np.repeat(np.arange(len(self.kinds)), [len(measured.columns[kind]) for kind in self.kinds])
        self.errors = np.concatenate([measured.errors[kind] for kind in self.kinds])
        # With as many numbers as readings nothing is left to judge their scatter by: then that of a usual instrument counts.
        self.stated = bool(np.isfinite(self.errors[self.used]).all()) or measured.count <= len(knobs)
        rough = np.array([ROUGH[kind] for kind in self.kinds])[self.kind]
        self.sigma = np.where(np.isfinite(self.errors), self.errors, rough)
        self.seen: dict[bytes, Array] = {}
        self.why = ""
        self.brief, self.amplitude = False, None if measured.times is not None else self._amplitude()

    def _amplitude(self) -> float | None:
        """From where limit cycles are looked for."""
        cycle = steady(self.scene, tolerance=self.tolerance)
        self.brief = cycle.found and cycle.oscillations == 1
        return math.radians(cycle.amplitude_deg) if cycle.found and cycle.amplitude_deg is not None else None

    def at(self, z: Array) -> Array:
        return self.base + z * self.size

    def changes(self, z: Array) -> dict[str, float]:
        return {one.key: float(value) for one, value in zip(self.knobs, self.at(z), strict=True)}

    def models(self, points: Sequence[Array]) -> list[Array]:
        """What scenes with these numbers give in place of each reading; nan where they do not work."""
        new = {one.tobytes(): one for one in points if one.tobytes() not in self.seen}
        made = self._decays(list(new.values())) if self.measured.times is not None else self._readings(list(new.values()))
        self.seen.update(zip(new, made, strict=True))
        if self.progress is not None:
            self.progress(len(self.seen))
        return [self.seen[one.tobytes()] for one in points]

    def _decays(self, points: Sequence[Array]) -> list[Array]:
        found = []
        for z in points:
            try:
                found.append(self._decay(changed(self.scene, self.changes(z))))
            except SceneError as error:
                self.why = error.sentence()
                found.append(np.full(len(self.given), math.nan))
        return found

    def _decay(self, scene: Scene) -> Array:
        times, body = self.measured.times, roles(scene).oscillator
        assert times is not None and body is not None
        run = simulate(
            scene, float(times[-1]) + (1.5 / (nominal_frequency(scene) or 1.0) if SWING in self.kinds else 0.0), self.tolerance
        )
        parts = []
        for kind in self.kinds:
            if kind == ANGLE:
                parts.append(np.degrees(run.positions(times, [run.slices[body].start])[:, 0]))
            else:
                found = beats(run, body)
                middle = 0.5 * (found.start + found.end)
                parts.append(np.interp(times, middle, found.amplitude_deg) if len(middle) else np.full(len(times), math.nan))
        return np.concatenate(parts)

    def _readings(self, points: Sequence[Array]) -> list[Array]:
        """One limit cycle for each state that readings were taken in."""
        states = list({repr(sorted(one.items())): one for one in self.measured.states}.values())
        place = [next(k for k, state in enumerate(states) if state == one) for one in self.measured.states]
        question = Question(self.scene, True, None, self.tolerance, self.amplitude, self.brief)
        asked = [(i, {**state, **self.changes(z)}) for i, (z, state) in enumerate((z, s) for z in points for s in states)]
        rows: dict[int, Any] = dict(self.executor.answers(question, asked, lambda: False)) if asked else {}
        found = []
        for i in range(len(points)):
            own = [rows[i * len(states) + k] for k in place]
            wrong = next((row for row in own if row[self.kinds[0]] is None), None)
            self.why = self.why if wrong is None else str(wrong["message"] or wrong["verdict"])
            found.append(np.array([math.nan if row[kind] is None else row[kind] for kind in self.kinds for row in own], float))
        return found

    def residuals(self, z: Array) -> Array:
        (model,) = self.models([np.ascontiguousarray(z)])
        left = ((model - self.given) / self.sigma)[self.used]
        return left if np.isfinite(left).all() else np.full(len(left), LOST * (1.0 + float(np.linalg.norm(z))))

    def jacobian(self, z: Array) -> Array:
        """Of the residuals, by central differences, on one side at a limit and where a scene does not work."""
        steps = STEP * np.eye(len(z))
        around = [np.ascontiguousarray(self._within(z + sign * step)) for step in steps for sign in (1.0, -1.0)]
        self.models([np.ascontiguousarray(z), *around])
        out = np.zeros((int(self.used.sum()), len(z)))
        for k in range(len(z)):
            pair = [one for one in around[2 * k : 2 * k + 2] if np.isfinite(self.models([one])[0][self.used]).all()]
            pair += [np.ascontiguousarray(z)] if len(pair) == 1 else []
            if len(pair) == 2 and pair[0][k] != pair[1][k]:
                one, two = self.models(pair)
                out[:, k] = ((one - two) / self.sigma)[self.used] / (pair[0][k] - pair[1][k])
        return out

    def _within(self, z: Array) -> Array:
        return np.clip(z, (self.low - self.base) / self.size, (self.high - self.base) / self.size)

    def result(self) -> Fit:
        from scipy.optimize import least_squares

        z = self._within(np.zeros(len(self.knobs)))
        (first,) = self.models([z])
        if not np.isfinite(first[self.used]).all():
            return self._report(z, None, f"the scene does not work as it is, so nothing can be fitted: {self.why}")
        bounds = ((self.low - self.base) / self.size - 1e-12, (self.high - self.base) / self.size + 1e-12)
        for _ in range(1 if self.stated else ROUNDS):
            found = least_squares(
                self.residuals, z, self.jacobian, bounds, x_scale="jac", xtol=1e-10, ftol=1e-12, max_nfev=EVALUATIONS
            )
            z = np.ascontiguousarray(found.x)
            if not self.stated:
                self._weigh(self.residuals(z))
        stopped = [
            f"{knob.key} came to its limit, {knob.shown(limit)}"
            for knob, value in zip(self.knobs, self.at(z), strict=True)
            for limit in (knob.low, knob.high)
            if self._is_at(knob, value, limit)
        ]
        stopped += [] if found.status > 0 else [f"not settled after {found.nfev} steps"]
        return self._report(z, self.jacobian(z), "; ".join(stopped))

    @staticmethod
    def _is_at(knob: Knob, value: float, limit: float) -> bool:
        return abs(value - limit) < 1e-6 * (knob.high - knob.low)

    def _weigh(self, left: Array) -> None:
        """Each kind of reading by its own scatter, with its share of what fitting has taken from it."""
        kinds, spare = self.kind[self.used], 1.0 - len(self.knobs) / len(left)
        for k in range(len(self.kinds)):
            own = left[kinds == k]
            if spare > 0.0 and len(own):
                scatter = math.sqrt(float(np.mean(own**2)) / spare)
                self.sigma[self.kind == k] *= scatter if scatter > 1e-9 else 1.0

    def _report(self, z: Array, jacobian: Array | None, message: str) -> Fit:
        keys: dict[str, Value] = {}
        groups: tuple[tuple[str, ...], ...] = ()
        words: tuple[str, ...] = ()
        residual = None
        model = self.models([z])[0]
        if jacobian is not None:
            left = self.residuals(z)
            residual = float(np.sqrt(np.mean(left**2)))
            keys, groups, words = self._intervals(z, jacobian, left)
            for knob, value in zip(self.knobs, self.at(z), strict=True):
                if any(self._is_at(knob, value, limit) for limit in (knob.low, knob.high)):
                    keys[knob.key] = replace(keys[knob.key], low=None, high=None)  # what was measured lies beyond
        sizes = np.cumsum([len(self.measured.columns[kind]) for kind in self.kinds])[:-1]
        return Fit(
            title=self.scene.title,
            measured=self.measured,
            knobs=self.knobs,
            found=jacobian is not None,
            message=message,
            keys=keys,
            residual=residual,
            scatter={kind: float(np.median(self.sigma[self.kind == k])) for k, kind in enumerate(self.kinds)},
            cannot_tell_apart=groups,
            words=words,
            modelled=dict(zip(self.kinds, np.split(model, sizes), strict=True)),
            evaluations=len(self.seen),
            wall_s=time.perf_counter() - self.begun,
            scene=changed(self.scene, self.changes(z)) if jacobian is not None else self.scene,
        )

    def _intervals(
        self, z: Array, jacobian: Array, left: Array
    ) -> tuple[dict[str, Value], tuple[tuple[str, ...], ...], tuple[str, ...]]:
        """Values with their intervals, what cannot be distinguished, and in words how it stands in for each other."""
        from scipy.stats import norm, t

        spare = len(left) - len(z)
        noise = 1.0 if self.stated else math.sqrt(float(left @ left) / spare) if spare > 0 else math.nan
        quantile = float(
            norm.ppf(0.5 + 0.5 * SURE) if self.stated else t.ppf(0.5 + 0.5 * SURE, spare) if spare > 0 else math.nan
        )
        lengths = np.linalg.norm(jacobian, axis=0)
        dead = ~(lengths * VAGUE > noise)
        alive = np.flatnonzero(~dead)
        _, sizes, own_ways = np.linalg.svd(jacobian[:, alive] / lengths[alive], full_matrices=False)
        ways = np.zeros((len(sizes), len(z)))  # changes of z
        ways[:, alive] = own_ways / lengths[alive]
        vague_by = np.abs(ways).max(axis=1, initial=0.0) * noise > VAGUE * sizes
        loose = (sizes <= ALIKE) | vague_by
        spread = noise * np.sqrt(np.sum((ways[~loose] / sizes[~loose, None]) ** 2, axis=0))
        free = [(np.eye(len(z))[k], [k]) for k in np.flatnonzero(dead).tolist()]
        for way in ways[loose] * self.size / np.where(self.at(z) == 0.0, self.size, np.abs(self.at(z))):
            free.append((way, np.flatnonzero(np.abs(way) > SHARE * np.abs(way).max()).tolist()))
        vague = {k for _, group in free for k in group}
        values = {}
        for k, (knob, value) in enumerate(zip(self.knobs, self.at(z).tolist(), strict=True)):
            reach = quantile * float(spread[k]) * float(self.size[k])
            known = k not in vague and math.isfinite(reach)
            values[knob.key] = Value(value, value - reach if known else None, value + reach if known else None, knob.value)
        names = tuple(tuple(self.knobs[k].key for k in group) for _, group in free)
        words = tuple(self._words(group, way) for way, group in free)
        return values, names, words

    def _words(self, group: Sequence[int], way: Array) -> str:
        names = [self.knobs[k].key for k in group]
        if len(group) == 1:
            return f"{names[0]} is not decided by what was measured: keep it at a known value"
        ratios = [way[k] / way[group[0]] for k in group[1:]]
        others = " and ".join(
            f"{abs(r):.3g} % {'more' if r > 0.0 else 'less'} {name}" for r, name in zip(ratios, names[1:], strict=True)
        )
        listed = f"{', '.join(names[:-1])} and {names[-1]}"
        return f"{listed} cannot be distinguished: 1 % more {names[0]} with {others} changes nothing measured; keep one known"
