"""Which dimensions make the better watch?

One number for one result is a root: bracketed by secants, found by Brent's method. All else goes to scipy's SLSQP, with
derivatives by central differences between limit cycles; where that finds no stationary point, as at kinks, to Nelder and Mead's
simplex from the best design seen. Designs that do not tick, or cannot be drawn, count as worse than any that do, the more so
the further they lie from the best one: they turn the search back and end it nowhere. Of several goals a front: one is made
best while the others are held at levels between their extremes.

A yield takes hundreds of limit cycles, so a limit on it is left out at first: the best design without it mostly keeps it, which
one yield shows. Else the simplex goes on from there. As a share of samples a yield has steps, so its derivatives are taken over
wide differences.
"""

from __future__ import annotations

import itertools
import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.verdict_kinds import SPOKEN, Verdict
from watchsim.escapement.measure import with_lift
from watchsim.scene.errors import SceneError
from watchsim.scene.load import changed
from watchsim.scene.roles import keeps_time, nominal_frequency
from watchsim.scene.scene import Scene
from watchsim.studies.goals import ABOVE, BELOW, EQUAL, KNOWN, MOST, YIELD, Aim, Better, Knob, arguments, needs, shown
from watchsim.studies.point import Question, Row, function_of
from watchsim.studies.sensitivity import change_of
from watchsim.studies.steady import steady
from watchsim.studies.workers import Executor, chosen

Array = NDArray[np.float64]

SAMPLES = 256  # watches of a yield: each design takes so many limit cycles
STEP = 5e-4  # of a range: of central differences
FEW = 2  # teeth whose geometry of function is measured; those of a design are alike
KEPT = 1e-7  # of what a limit changes over a range: so far it may be broken
NEAR = 1e-6  # of a range, of a bound that holds
STATIONARY = 1e-3  # of the gradient: what multipliers may leave of it
EXACT = 1e-10  # SLSQP stops at such a change of the scaled goal
ROUNDS = 60  # of SLSQP
SIMPLEX, MOVES = 0.05, 60  # of a range; evaluations for each number
YIELDS = 0.02, 0.25, 2e-3  # where there is a yield, of a range: central differences, the first simplex and the last one
POPULATION, GENERATIONS = 8, 25  # of differential evolution, for each number
PENALTY = 100.0  # on what is broken, in Nelder and Mead's merit
TRIES = 64  # designs that are looked at for one that ticks
LEVELS = 9  # designs of a front
SOLVED = 1e-12  # of a range: where the root is
EDGE, BEYOND = 1e-4, 3.0  # of a range, and ratio of ways: how closely a design that does not work is approached


class _NoNumber(Exception):
    """A design has no value of a goal or limit; holds its row."""


class Limit(NamedTuple):
    """Output number `output` is to be at, above or below `value`."""

    output: int
    way: str
    value: float

    @property
    def sign(self) -> float:
        """+1 where more of the output is on the good side."""
        return -1.0 if self.way == BELOW else 1.0


def improve(  # noqa: PLR0913 - options, by name
    scene: Scene | str | Path,
    knobs: Mapping[str, tuple[Any, Any] | None],
    goal: str | Iterable[str],
    keep: Iterable[str] = (),
    *,
    method: str = "auto",
    starts: int = 1,
    points: int = LEVELS,
    duration: float | None = None,
    tolerance: float | None = None,
    workers: int = 1,
    scheduler: str | None = None,
    progress: Callable[[int], None] | None = None,
) -> Better:
    """The scene with some numbers changed so that a goal is reached and limits are kept.

    knobs     path, or name of a design's dimension -> (from, to), SI numbers or texts with units; None without limits
    goal      "amplitude max", "torque min" (a number that is varied), "rate = 0 s/d"; several of max and min give a front. With
              nothing but "=" the design that changes least is looked for
    keep      "total_lock >= 1.2°", "beat_error <= 0.1 ms", of outputs as in `sweep` or of what is varied
    method    auto, slsqp, nelder-mead, differential-evolution (then slsqp)
    starts    so many searches, the first from the scene as it is, the others from elsewhere between the limits
    points    designs on a front
    duration  s: by the end of a run instead of by limit cycles; what is found must work on its limit cycle, too
    progress  called with the number of designs evaluated

    Limits and goals in the unit that an output has in tables. SceneError with all that is wrong with the arguments.
    """
    if not isinstance(scene, Scene):
        from watchsim.scene.load import load

        scene = load(scene)
    varied, goals, keeps = arguments(scene, knobs, goal, keep, method, starts, points)
    drawn = any(one.output == YIELD for one in (*goals, *keeps))
    executor = chosen(workers, scheduler)
    search = Search(scene, varied, goals, keeps, executor, tolerance, duration, progress)
    plain = [one for one in keeps if one.output != YIELD]
    held = [one.way for one in keeps if one.output == YIELD]
    if held and EQUAL not in held and len(goals) == 1 and goals[0].output != YIELD:
        without = Search(scene, varied, goals, tuple(plain), executor, tolerance, duration, progress)
        first = without.result(method, starts, points)
        if first.found:
            whole = search.with_yield(first)
            if whole is not None:
                return whole
            search.near(first)
    return search.result("nelder-mead" if drawn and method == "auto" else method, starts, points)


class Search:
    """Designs as points of a unit cube, looked at once each."""

    def __init__(
        self,
        scene: Scene,
        knobs: tuple[Knob, ...],
        goals: tuple[Aim, ...],
        keeps: tuple[Aim, ...],
        executor: Executor,
        tolerance: float | None = None,
        duration: float | None = None,
        progress: Callable[[int], None] | None = None,
    ) -> None:
        self.begun, self.original = time.perf_counter(), scene
        self.knobs, self.goals, self.keeps, self.executor, self.progress = knobs, goals, keeps, executor, progress
        self.motion, self.function = needs((*goals, *keeps))
        self.outputs = tuple({one.output.name: one.output for one in (*goals, *keeps)}.values())
        self.nominal = (
            nominal_frequency(scene) if scene.nominal is None and any(one.name == "rate" for one in self.outputs) else None
        )
        if self.nominal is not None:  # a rate against a frequency that moves along would be none
            scene = scene.set("timegrapher.frequency", self.nominal)
        amplitude, brief = None, False
        if self.motion and duration is None:
            cycle = steady(scene, tolerance=tolerance)
            if cycle.found and cycle.amplitude_deg is not None and cycle.period_s is not None:
                whole = all(one.name != "multiplier" for one in self.outputs)
                amplitude, brief = math.radians(cycle.amplitude_deg), whole and cycle.oscillations == 1
        few = FEW if self.function else None
        self.question = Question(scene, duration is None, duration, tolerance, amplitude, brief, few)
        self.low = np.array([one.low for one in knobs])
        self.range = np.array([one.high for one in knobs]) - self.low
        self.start = np.clip((np.array([one.value for one in knobs]) - self.low) / self.range, 0.0, 1.0)
        self.seen: dict[bytes, Array] = {}
        self.rows: dict[bytes, Row] = {}
        self.limits = tuple(self._limit(one) for one in (*goals, *keeps) if not one.is_goal)
        self.ends = tuple((self._index(one), -1.0 if one.way == MOST else 1.0) for one in goals if one.is_goal)
        self.scale = np.ones(len(self.outputs))
        drawn = YIELD in self.outputs
        self.step, self.simplex, self.nearest = YIELDS if drawn else (STEP, SIMPLEX, NEAR)
        self.exact = math.inf if drawn else EXACT
        self.first = self.start  # where the search begins

    # What a yield says of the design that is best without it

    def near(self, found: Better) -> None:
        """Begin with that design."""
        values = np.array([found.keys[one.key][1] for one in self.knobs])
        self.first = np.ascontiguousarray(np.clip((values - self.low) / self.range, 0.0, 1.0))

    def with_yield(self, found: Better) -> Better | None:
        """The same with the yields, old and new; None where the new one breaks a limit."""
        new = self._yield({key: value for key, (_, value) in found.keys.items()})
        room = [(new - one.value) * (-1.0 if one.way == BELOW else 1.0) for one in self.keeps if one.output == YIELD]
        if not min(room) >= 0.0:
            return None
        moved = any(not one.low <= one.value <= one.high for one in self.knobs)
        old = math.nan if moved else self._yield({one.key: one.value for one in self.knobs})
        values = {**found.values, YIELD.column: (None if math.isnan(old) else old, new)}
        return replace(found, keeps=self.keeps, values=values, wall_s=time.perf_counter() - self.begun)

    def _index(self, aim: Aim) -> int:
        return [one.name for one in self.outputs].index(aim.output.name)

    def _limit(self, aim: Aim) -> Limit:
        return Limit(self._index(aim), aim.way, aim.value)

    def values(self, points: Sequence[Array]) -> list[Array]:
        """Of all that is watched, at each of the points; nan where there is none."""
        new = {point.tobytes(): point for point in points if point.tobytes() not in self.seen}
        changes = [(i, self._changes(point)) for i, point in enumerate(new.values())]
        places = list(new)
        for number, row in self._answers(changes):
            own = {one.key: float(x) for one, x in zip(self.knobs, self.at(new[places[number]]), strict=True)}
            self.rows[places[number]] = row
            self.seen[places[number]] = np.array([self._value(one, row, own) for one in self.outputs], float)
            if self.progress is not None:
                self.progress(len(self.seen))
        return [self.seen[point.tobytes()] for point in points]

    def _answers(self, changes: list[tuple[int, dict[str, float]]]) -> Iterable[tuple[int, Row]]:
        if self.motion:
            return self.executor.answers(self.question, changes, lambda: False)
        return [(number, self._still(change)) for number, change in changes]

    def _still(self, change: Mapping[str, float]) -> Row:
        try:
            scene = changed(self.question.scene, change)
            return function_of(scene, FEW) if self.function else {}
        except SceneError as error:
            return {"message": error.sentence(change)}

    def _value(self, output: Any, row: Row, own: Mapping[str, float]) -> float:
        from watchsim.units import to

        if output == YIELD:
            return self._yield(own)
        if output.name not in KNOWN:
            return to(own[output.name], output.unit) if output.unit else own[output.name]
        value = row.get(output.column)
        return float(value) if value is not None and Verdict(row.get("verdict")).works else math.nan

    def _yield(self, own: Mapping[str, float]) -> float:
        """%, of the same draws each time, so that designs differ by what they are and not by chance."""
        from watchsim.studies.tolerance import made
        from watchsim.studies.tolerance_plan import plan_of

        asked = self.question
        try:
            plan = plan_of(changed(asked.scene, own), duration=asked.duration, tolerance=asked.tolerance)
        except SceneError:
            return math.nan
        study = made(plan, SAMPLES, self.executor)
        if not study.whole:
            raise KeyboardInterrupt
        return 100.0 * study.yield_

    def at(self, point: Array) -> Array:
        return self.low + point * self.range

    def _changes(self, point: Array) -> dict[str, float]:
        return {one.key: float(value) for one, value in zip(self.knobs, self.at(point), strict=True)}

    def gradients(self, point: Array) -> Array:
        """(watched, knobs): derivatives by central differences, of second order on one side where a bound or a design that does
        not tick is in the way; nan where neither can be had."""
        stencils = [(-1.0, 1.0), (1.0, 2.0), (-1.0, -2.0)]
        moved = {(k, s): _moved(point, k, s * self.step) for k in range(len(point)) for s in (-1.0, 1.0)}
        centre, *_ = self.values([point, *(one for one in moved.values() if _inside(one))])
        out = np.full((len(self.outputs), len(point)), math.nan)
        for k in range(len(point)):
            for first, second in stencils:
                pair = [_moved(point, k, s * self.step) for s in (first, second)]
                if not all(map(_inside, pair)):
                    continue
                one, two = self.values(pair)
                if np.isnan(one).any() or np.isnan(two).any():
                    continue
                slope = two - one if first < 0.0 < second else first * (4.0 * one - two - 3.0 * centre)
                out[:, k] = slope / (2.0 * self.step)
                break
        return out

    # How good is a design? Less is better.

    def objective(self, values: Array, point: Array, end: tuple[int, float] | None) -> float:
        if end is None:
            return float(np.sum((point - self.start) ** 2))
        return end[1] * float(values[end[0]]) / float(self.scale[end[0]])

    def broken(self, values: Array, limits: Sequence[Limit]) -> float:
        """By how much limits are broken in all, in parts of what they change over a range."""
        total = 0.0
        for one in limits:
            room = (values[one.output] - one.value) / self.scale[one.output]
            total += abs(room) if one.way == EQUAL else max(0.0, -room if one.way == ABOVE else room)
        return total

    def merit(self, point: Array, end: tuple[int, float] | None, limits: Sequence[Limit]) -> float:
        (values,) = self.values([np.ascontiguousarray(np.clip(point, 0.0, 1.0))])
        if np.isnan(values).any():
            return 1e6 * (1.0 + float(np.linalg.norm(point - self.start)))
        return self.objective(values, point, end) + PENALTY * self.broken(values, limits)

    def best(self, end: tuple[int, float] | None, limits: Sequence[Limit]) -> Array | None:
        """The best design seen that keeps the limits."""
        found, least = None, math.inf
        for place, values in self.seen.items():
            point = np.frombuffer(place)
            if not np.isnan(values).any() and self.broken(values, limits) <= KEPT * max(1, len(limits)):
                own = self.objective(values, point, end)
                found, least = (point, own) if own < least else (found, least)
        return found

    # How is the best one found?

    def optimum(self, end: tuple[int, float] | None, limits: Sequence[Limit], start: Array, method: str) -> Array | None:
        """From a design that ticks; None where no design was found that keeps the limits."""
        if method == "differential-evolution":
            start = self._evolved(end, limits)
        point = start
        if method != "nelder-mead":
            point = self._slsqp(end, limits, start)
        good = self._good(point, end, limits)
        if method == "nelder-mead" or (method == "auto" and not good):
            nearest = self.best(end, limits)
            self._simplex(end, limits, start if nearest is None else nearest)
        best = self.best(end, limits)
        if best is None or not good:
            return best
        gain = self.objective(self.values([point])[0], point, end) - self.objective(self.values([best])[0], best, end)
        return best if gain > 1e-6 else point

    def _good(self, point: Array, end: tuple[int, float] | None, limits: Sequence[Limit]) -> bool:
        """Does it keep the limits, and is it stationary?"""
        (values,) = self.values([point])
        if np.isnan(values).any() or self.broken(values, limits) > KEPT * max(1, len(limits)):
            return False
        return self.multipliers(point, end, limits)[1] <= STATIONARY

    def _slsqp(self, end: tuple[int, float] | None, limits: Sequence[Limit], start: Array) -> Array:
        from scipy.optimize import minimize

        last = {"point": start}

        def values(point: Array) -> Array:
            own = np.ascontiguousarray(np.clip(point, 0.0, 1.0))
            (found,) = self.values([own])
            if not np.isnan(found).any():
                last["point"] = own
                return found
            good = self.values([last["point"]])[0]
            return _worse(good, end, limits, self.scale, float(np.linalg.norm(own - last["point"])))

        def slopes(point: Array) -> Array:
            return np.nan_to_num(self.gradients(np.ascontiguousarray(np.clip(point, 0.0, 1.0))))

        def goal_slope(point: Array) -> Array:
            return 2.0 * (point - self.start) if end is None else end[1] * slopes(point)[end[0]] / self.scale[end[0]]

        held = [
            {
                "type": "eq" if one.way == EQUAL else "ineq",
                "fun": lambda p, one=one: one.sign * (values(p)[one.output] - one.value) / self.scale[one.output],
                "jac": lambda p, one=one: one.sign * slopes(p)[one.output] / self.scale[one.output],
            }
            for one in limits
        ]
        found = minimize(
            lambda point: self.objective(values(point), point, end),
            start,
            jac=goal_slope,
            bounds=[(0.0, 1.0)] * len(start),
            constraints=held,
            method="SLSQP",
            options={"ftol": EXACT, "maxiter": ROUNDS},
        )
        point: Array = np.ascontiguousarray(np.clip(found.x, 0.0, 1.0))
        return point if not np.isnan(self.values([point])[0]).any() else last["point"]

    def _simplex(self, end: tuple[int, float] | None, limits: Sequence[Limit], start: Array) -> None:
        from scipy.optimize import minimize

        corners = [start, *(_moved(start, k, -self.simplex if start[k] > 0.5 else self.simplex) for k in range(len(start)))]
        ends = {"maxfev": MOVES * len(start), "xatol": self.nearest, "fatol": self.exact}
        options = {"initial_simplex": np.array(corners), **ends}
        bounds = [(0.0, 1.0)] * len(start)
        minimize(lambda p: self.merit(p, end, limits), start, method="Nelder-Mead", bounds=bounds, options=options)

    def _evolved(self, end: tuple[int, float] | None, limits: Sequence[Limit]) -> Array:
        from scipy.optimize import differential_evolution

        def merits(points: Array) -> Array:
            columns = [np.ascontiguousarray(one) for one in points.T]
            self.values(columns)
            return np.array([self.merit(one, end, limits) for one in columns])

        options: dict[str, Any] = {"popsize": POPULATION, "maxiter": GENERATIONS, "polish": False, "updating": "deferred"}
        bounds = [(0.0, 1.0)] * len(self.knobs)
        found = differential_evolution(merits, bounds, x0=self.start, seed=0, vectorized=True, tol=1e-4, **options)
        return np.ascontiguousarray(found.x)

    # What holds it back?

    def multipliers(
        self, point: Array, end: tuple[int, float] | None, limits: Sequence[Limit]
    ) -> tuple[list[tuple[Limit | int, float, float]], float]:
        """(limit, or number of the knob at its bound; side; multiplier) of all that hold; what they leave of the gradient."""
        from scipy.optimize import nnls

        slopes, (values,) = self.gradients(point) / self.scale[:, None], self.values([point])
        goal = 2.0 * (point - self.start) if end is None else end[1] * slopes[end[0]]
        rows: list[tuple[Limit | int, float, Array]] = []
        for one in limits:
            room = abs(values[one.output] - one.value) / self.scale[one.output]
            for sign in (1.0, -1.0) if one.way == EQUAL else (one.sign,):
                if one.way == EQUAL or room < 10.0 * NEAR:
                    rows.append((one, sign, sign * slopes[one.output]))
        for k in range(len(point)):
            for side, room in ((1.0, point[k]), (-1.0, 1.0 - point[k])):
                if room < NEAR:
                    rows.append((k, side, side * np.eye(len(point))[k]))
        size = float(np.linalg.norm(goal))
        if not np.isfinite(size) or any(not np.isfinite(row).all() for _, _, row in rows):
            return [], math.inf
        if not rows or size == 0.0:
            return [], 0.0 if size == 0.0 else 1.0 if end is not None else size
        weights, left = nnls(np.array([row for _, _, row in rows]).T, goal)
        return [(what, side, float(w)) for (what, side, _), w in zip(rows, weights, strict=True) if w > 0.0], left / size

    def _held_by(self, point: Array, end: tuple[int, float] | None, limits: Sequence[Limit]) -> tuple[str, ...]:
        """Sentences, the strongest first; of a goal that is a mere value, nothing."""
        if end is None:
            return ()
        advice: list[tuple[float, str]] = []
        goal = self.outputs[end[0]]
        for what, side, weight in self.multipliers(point, end, limits)[0]:
            if isinstance(what, Limit):
                output = self.outputs[what.output]
                room = {"°": 0.1, "s/d": 1.0, "ms": 0.01}.get(output.unit, 0.01 * abs(what.value) or 0.01)
                gain = weight * room / self.scale[what.output]
                aim = Aim(output, what.way, what.value)
                words, way = shown(output, room), "less" if side > 0.0 else "more"
                name = str(aim)
            else:
                knob = self.knobs[what]
                room, words = change_of(self.at(point)[what], knob.dimension)
                gain, room = weight * abs(room) / self.range[what], abs(room)
                way = "less" if side > 0.0 else "more"
                name = f"{knob.key} {ABOVE if side > 0.0 else BELOW} {knob.shown(knob.low if side > 0.0 else knob.high)}"
            gain = shown(goal, gain * self.scale[end[0]], 3)
            more = "less" if end[1] > 0.0 else "more"
            advice.append((-weight, f"{name}: {words} {way} would give {gain} {more} {goal.label}"))
        return tuple(words for _, words in sorted(advice))

    # The whole search

    def result(self, method: str, starts: int, points: int) -> Better:
        self.values([self.start])
        if len(self.knobs) == 1 and len(self.goals) == 1 and self.goals[0].way == EQUAL and not self.keeps:
            return self._solved()
        begins = self._begins(starts)
        if not begins:
            return self._report(None, f"no design of {len(self.seen)} between these limits works: {self._why(self.start)}")
        self._scaled(begins[0])
        ends: tuple[tuple[int, float] | None, ...] = self.ends or (None,)
        found = [self.optimum(ends[0], self.limits, begin, method) for begin in begins]
        known = [one for one in found if one is not None]
        if not known:
            return self._report(None, self._impossible())
        known.sort(key=lambda one: self.objective(self.values([one])[0], one, ends[0]))
        same = sum(self._alike(one, known[0], ends[0]) for one in known)
        if len(ends) > 1:
            return self._front(known[0], method, points)
        return self._report(known[0], starts=(len(begins), same), active=self._held_by(known[0], ends[0], self.limits))

    def _alike(self, one: Array, best: Array, end: tuple[int, float] | None) -> bool:
        values, least = self.values([one, best])
        return self.objective(values, one, end) - self.objective(least, best, end) < 1e-4

    def _scaled(self, point: Array) -> None:
        """What each output changes over a range of its strongest knob, near that design."""
        slopes = np.abs(self.gradients(point))
        widest = np.max(np.nan_to_num(slopes), axis=1)
        self.scale = np.where(widest > 0.0, widest, 1.0)

    def _begins(self, starts: int) -> list[Array]:
        """Designs that tick: the scene's own, and others spread between the limits."""
        from scipy.stats import qmc

        spread = qmc.Sobol(len(self.knobs), rng=0).random_base2(max(6, math.ceil(math.log2(2 * starts))))
        found: list[Array] = []
        for point in itertools.chain([self.first], 0.05 + 0.9 * spread):
            own = np.ascontiguousarray(point)
            if len(found) == starts:
                break
            if not np.isnan(self.values([own])[0]).any():
                found.append(own)
        return found

    def _front(self, first: Array, method: str, points: int) -> Better:
        """One goal made best with the others held between their extremes; what is worse in all than another is left out."""
        ends = self.ends
        alone = [first, *(self.optimum(end, self.limits, first, method) for end in ends[1:])]
        corners = np.array([self.values([one])[0] for one in alone if one is not None])
        designs = [one for one in alone if one is not None and not self._later(one)]
        if not designs:
            return self._report(first)
        levels = []
        for index, _ in ends[1:]:
            low, high = float(corners[:, index].min()), float(corners[:, index].max())
            each = max(2, round(points ** (1.0 / (len(ends) - 1))))
            levels.append([(index, value) for value in np.linspace(low, high, each + 2)[1:-1].tolist()])
        way = {index: ABOVE if sign < 0.0 else BELOW for index, sign in ends}
        begin = first
        for held in itertools.product(*levels):
            more = [Limit(index, way[index], value) for index, value in held]
            design = self.optimum(ends[0], (*self.limits, *more), begin, method)
            if design is not None and not self._later(design):
                designs.append(design)
                begin = design
        signed = np.array([[sign * self.values([one])[0][i] for i, sign in ends] for one in designs])
        spread = np.ptp(signed, axis=0)
        spread[spread == 0.0] = 1.0
        best = [k for k, row in enumerate(signed) if not _dominated(row, np.delete(signed, k, axis=0), NEAR * spread)]
        best.sort(key=lambda k: signed[k, 0])
        unique = [k for i, k in enumerate(best) if not i or np.abs((signed[k] - signed[best[i - 1]]) / spread).max() > NEAR]
        ideal = signed[unique].min(axis=0)
        middle = min(unique, key=lambda k: float(np.linalg.norm((signed[k] - ideal) / spread)))
        reported = self._report(designs[middle], "of the front, the design nearest to the best of each goal")
        return replace(reported, front=tuple(self._line(designs[k]) for k in unique))

    def _line(self, point: Array) -> dict[str, float]:
        (values,) = self.values([point])
        outputs = {one.column: float(v) for one, v in zip(self.outputs, values, strict=True) if one.name in KNOWN}
        return self._changes(point) | outputs

    def _impossible(self) -> str:
        """Which limits the nearest design breaks."""
        near = min(
            (p for p, v in self.seen.items() if not np.isnan(v).any()), key=lambda p: self.broken(self.seen[p], self.limits)
        )
        wrong = [one for one in self.limits if self.broken(self.seen[near], [one]) > KEPT]
        words = "; ".join(
            f"{Aim(self.outputs[one.output], one.way, one.value)} is missed, it comes to "
            f"{shown(self.outputs[one.output], float(self.seen[near][one.output]))}"
            for one in wrong
        )
        values = ", ".join(f"{k.key} = {k.shown(x)}" for k, x in zip(self.knobs, self.at(np.frombuffer(near)), strict=True))
        return f"no design between these limits keeps all of them. The nearest ({values}): {words}"

    def _later(self, point: Array) -> str:
        """What becomes of a design after the run, or the geometry, by which it was judged: its fault on the limit cycle.

        "" where it works, or where the scene it comes from does not either.
        """
        still = not self.motion and keeps_time(with_lift(self.question.scene))
        if not still and (self.question.by_shooting or Verdict(self.rows[point.tobytes()].get("verdict")).name is None):
            return ""
        values = ", ".join(f"{one.key} = {one.shown(x)}" for one, x in zip(self.knobs, self.at(point), strict=True))
        try:
            cycle = steady(changed(self.question.scene, self._changes(point)), tolerance=self.question.tolerance)
            if Verdict(cycle.verdict).works or (still and not Verdict(steady(self.original).verdict).works):
                return ""
            fault = SPOKEN.get(str(cycle.verdict), cycle.verdict)
        except SceneError as error:
            fault = f"cannot start: {error.faults[0].message.splitlines()[0].removesuffix('.')}"
        if still:
            found = f"the design found ({values}) has that geometry, but the watch {fault}"
            return f'{found}. With --keep "amplitude >= 100°", say, designs that do not tick are taken as worse'
        found = (
            f"the design found ({values}) works for {self.question.duration:g} s, but not for good: as it settles it {fault}"
        )
        return f"{found}. Judge by a longer run, or by limit cycles (without a duration)"

    def _why(self, point: Array) -> str:
        row = self.rows[point.tobytes()]
        return str(row.get("message") or row.get("verdict") or "it has no such number")

    # One number for one result

    def _solved(self) -> Better:
        from scipy.optimize import brentq

        target, output = self.limits[0].value, self.outputs[0]

        def off(z: float) -> float:
            (values,) = self.values([np.array([z])])
            if np.isnan(values).any():
                raise _NoNumber
            return float(values[0]) - target

        try:
            bracket = self._bracket(off)
            if isinstance(bracket, str):
                return self._report(None, bracket)
            root = brentq(off, *bracket, xtol=SOLVED, rtol=1e-14) if bracket[0] != bracket[1] else bracket[0]
        except _NoNumber:
            return self._report(
                None, "between two designs that work there is one that does not, so the goal cannot be closed in on"
            )
        found = self._report(np.array([root]))
        (value,) = self.values([np.array([root])])[0]
        nearest = min(abs(float(v[0]) - target) for v in self.seen.values() if not np.isnan(v).any())
        jumps = abs(value - target) > max(1e-6 * abs(target), 1e-6, 10.0 * nearest)
        why = f"{output.label} jumps over {shown(output, target)} there: it is {shown(output, value)}"
        return replace(found, found=False, message=why) if jumps else found

    def _bracket(self, off: Callable[[float], float]) -> tuple[float, float] | str:
        """Two designs with the goal between them, by secants from the scene's own; else what stands in the way."""
        z, last, why = float(self.start[0]), None, ""
        try:
            here = off(z)
        except _NoNumber:
            return f"the scene itself does not work: {self._why(self.start)}"
        step, bad, root = 0.02 if z < 0.5 else -0.02, math.nan, math.nan
        for _ in range(TRIES):
            if here == 0.0:
                return z, z
            if last is not None and here != last[1]:
                root = z - here * (z - last[0]) / (here - last[1])
                step = math.copysign(min(1.3 * abs(root - z), 3.0 * abs(step) + 0.05), root - z)
            there = min(max(z + step, 0.0), 1.0)
            if (bad - z) * (bad - there) <= 0.0 or abs(bad - there) < abs(0.5 * (bad - z)):  # nan: none is known
                there = 0.5 * (z + bad)
            # A straight line to the goal that leads far beyond what does not work will not end before it.
            near = max(EDGE, abs(root - z) / BEYOND if (root - z) * (bad - z) > 0.0 else 0.0)
            if there == z or abs(bad - z) < near:
                break
            try:
                value = off(there)
            except _NoNumber:
                bad, why = there, self._why(np.array([there]))
                continue
            if value * here <= 0.0:
                return min(z, there), max(z, there)
            last, z, here = (z, here), there, value
        output, knob = self.outputs[0], self.knobs[0]
        at = knob.shown(float(self.at(np.array([z]))[0]))
        reached = f"{output.label} comes to {shown(output, here + self.limits[0].value)} at {knob.key} = {at}"
        beyond = knob.shown(float(self.at(np.array([bad]))[0])) if why else ""
        return f"{reached}{f', and at {beyond} {why}' if why else ', where its limits end'}"

    def _report(
        self, point: Array | None, message: str = "", starts: tuple[int, int] = (1, 1), active: tuple[str, ...] = ()
    ) -> Better:
        later = "" if point is None else self._later(point)
        point, message = (None, later) if later else (point, message)
        old = self.seen[self.start.tobytes()]
        moved = any(not one.low <= one.value <= one.high for one in self.knobs)  # the start is not the scene as it is
        new = None if point is None else self.values([point])[0]
        numbers = {
            one.column: (None if moved or math.isnan(old[i]) else float(old[i]), None if new is None else float(new[i]))
            for i, one in enumerate(self.outputs)
            if one.name in KNOWN
        }
        keys = {} if point is None else self._changes(point)
        scene = self.original if point is None else changed(self.question.scene, keys)
        first = self._index(self.goals[0])
        return Better(
            title=self.original.title,
            goals=self.goals,
            keeps=self.keeps,
            knobs=self.knobs,
            found=point is not None,
            message=message,
            value=None if new is None else float(new[first]),
            values=numbers,
            keys={one.key: (one.value, keys[one.key]) for one in self.knobs if one.key in keys},
            active=active,
            front=(),
            starts=starts,
            evaluations=len(self.seen),
            without=sum(bool(np.isnan(one).any()) for one in self.seen.values()),
            wall_s=time.perf_counter() - self.begun,
            scene=scene,
            nominal=self.nominal,
        )


def _moved(point: Array, k: int, way: float) -> Array:
    out = point.copy()
    out[k] += way
    return out


def _inside(point: Array) -> bool:
    return bool((point >= 0.0).all() and (point <= 1.0).all())


def _worse(good: Array, end: tuple[int, float] | None, limits: Sequence[Limit], scale: Array, far: float) -> Array:
    """Of a design that does not tick: worse than a good one near it in goal and limits, the more so the further away."""
    out = good.copy()
    for one in limits:
        out[one.output] = one.value - one.sign * (1.0 + far) * scale[one.output]
    if end is not None:
        out[end[0]] = good[end[0]] + end[1] * (1.0 + far) * scale[end[0]]
    return out


def _dominated(row: Array, others: Array, slack: Array) -> bool:
    return bool(len(others) and ((others <= row + slack).all(axis=1) & (others < row - slack).any(axis=1)).any())
