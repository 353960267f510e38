"""Which watches does a study of tolerances consist of, and what is asked of each?"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import ndtr

from watchsim.analysis.expectations import WATCH_KEYS, unit_of
from watchsim.scene.errors import SceneError
from watchsim.scene.load import changed
from watchsim.scene.read_settings import FUNCTION
from watchsim.scene.read_tolerances import require_tolerances
from watchsim.scene.scene import Expectation, Scene
from watchsim.studies.cycle import Cycle
from watchsim.studies.journal import same_study, study_of_tolerances
from watchsim.studies.point import OUTPUTS, Question
from watchsim.studies.sampling import Floats, Shifted, Space
from watchsim.studies.sensitivity import fixed_nominal
from watchsim.studies.steady import steady
from watchsim.units import FREQUENCY, known_unit

NUDGE = 0.05  # of the share below: how far a dimension is moved either way for the linear prediction
SECTION = "tolerances"


@dataclass(frozen=True)
class Limit:
    """What is promised of one column of a row; `factor` makes its unit that of the promise."""

    expectation: Expectation
    column: str
    factor: float

    @property
    def is_function(self) -> bool:
        """Whether it is of the geometry of function, which is not measured of every sample else."""
        return self.expectation.key in FUNCTION

    @property
    def label(self) -> str:
        """The output in words."""
        return next(output.label for output in OUTPUTS.values() if output.column == self.column)

    def margins(self, values: Floats) -> Floats:
        """How far inside (n, ends) the values lie, in the unit of the promise; negative outside."""
        low, high = self.expectation.bounds
        ends = [values * self.factor - low] if np.isfinite(low) else []
        return np.column_stack([*ends, high - values * self.factor] if np.isfinite(high) else ends)

    def missed(self, value: float | None) -> str:
        """ "amplitude too low"; "" where it is kept."""
        low, high = self.expectation.bounds
        name = self.label
        if value is None:
            return f"{name} not measurable"
        return f"{name} too low" if value * self.factor < low else f"{name} too high" if value * self.factor > high else ""


def limits_of(scene: Scene) -> tuple[tuple[Limit, ...], tuple[str, ...]]:
    """The promises that samples can be judged by, and the names of those that they cannot."""
    found, left = [], []
    for one in scene.expect:
        column = {**WATCH_KEYS, **{name: f"{name}_deg" for name in FUNCTION}}.get(one.key, one.key)
        if column not in {output.column for output in OUTPUTS.values()}:
            left.append(one.key)
            continue
        factor = known_unit(unit_of(column)).factor / known_unit(one.unit).factor if one.unit else 1.0
        found.append(Limit(one, column, factor))
    return tuple(found), tuple(left)


@dataclass(frozen=True)
class Plan:
    """All that decides the samples of a study. `question` has the geometry measured of every sample, or of none."""

    scene: Scene
    space: Space
    question: Question
    limits: tuple[Limit, ...]
    not_judged: tuple[str, ...]
    seed: int
    importance: bool
    shifted: Shifted | None = None

    def shares(self, numbers: Sequence[int]) -> tuple[Floats, Floats]:
        """The shares (n, draws) of samples, and their weights: 1 but for importance sampling."""
        if self.shifted is None:
            return self.space.shares(self.space.uniform(numbers, self.seed)), np.ones(len(numbers))
        scores, weights = self.shifted.scores(self.space.uniform(numbers, self.seed, extra=1))
        return self.space.shares(np.clip(ndtr(scores), 1e-300, 1.0 - 2.0**-53)), weights

    def changes(self, numbers: Sequence[int]) -> list[dict[str, Any]]:
        """The values (SI) of those samples."""
        return [self.space.changes(one) for one in self.shares(numbers)[0]]

    def nudged(self) -> dict[int, Floats]:
        """The points of the linear prediction: their numbers, below 0, -> shares."""
        width = len(self.space.draws)
        middle = np.full((2 * width, width), 0.5)
        for j in range(width):
            middle[2 * j, j], middle[2 * j + 1, j] = 0.5 - NUDGE, 0.5 + NUDGE
        return {-2 - i: row for i, row in enumerate(middle)}

    def header(self) -> dict[str, Any]:
        """What a resumed or merged study must find again."""
        return study_of_tolerances(self.scene, self.question.duration, self.question.tolerance, self.seed, self.importance)


def plan_of(
    scene: Scene,
    *,
    duration: float | None = None,
    tolerance: float | None = None,
    seed: int = 0,
    importance: bool = False,
    resumed: Path | None = None,
    is_computed: bool = False,
) -> Plan:
    """The study of a scene; SceneError where it has no tolerances, or is none without them.

    resumed      the folder of a study that shall be gone on with; ValueError where that is another one
    is_computed  its samples are there, and none is computed: then no limit cycle is looked for to begin with
    """
    require_tolerances(scene)
    space = Space(scene.tolerances, scene.correlated)
    varied = [("frequency", one.dimension is FREQUENCY) for one in scene.tolerances]
    varied += [("q_factor", one.key.endswith(".q_factor")) for one in scene.tolerances]
    bare = fixed_nominal(without_tolerances(scene), leave=[name for name, yes in varied if yes])
    limits, left = limits_of(scene)
    function = 1 if all(one.count == 1 for one in scene.tolerances) else 0
    question = Question(bare, duration is None, duration, tolerance, function=function)
    plan = Plan(scene, space, question, limits, left, seed, importance)
    if is_computed:
        return plan
    changed(bare, space.changes(np.full(len(space.draws), 0.5)))  # refuses now what no sample could be
    if resumed is not None:  # refused before anything takes time
        same_study(resumed, plan.header())
    if duration is None:
        cycle = steady(bare, tolerance=tolerance)
        other = _cycle(changed(bare, space.changes(np.full(len(space.draws), 0.6))), tolerance)
        amplitude = np.radians(cycle.amplitude_deg) if cycle.found and cycle.amplitude_deg else None
        brief = all(one is not None and one.found and one.oscillations == 1 for one in (cycle, other))
        slope = cycle.multipliers[0] if brief and cycle.multipliers else None
        amplitude = float(amplitude) if amplitude else None
        question = dataclasses.replace(question, amplitude=amplitude, brief=brief, slope=slope)
    return dataclasses.replace(plan, question=question)


def _cycle(scene: Scene, tolerance: float | None) -> Cycle | None:
    """None for a watch whose parts overlap at the start, as samples may."""
    try:
        return steady(scene, tolerance=tolerance)
    except SceneError:
        return None


def without_tolerances(scene: Scene) -> Scene:
    """The same scene, whose samples need not read them again."""
    source = {key: value for key, value in scene.source.items() if key != SECTION}
    written = scene.written
    if written is not None:
        mapping = {key: value for key, value in written.mapping.items() if key != SECTION}
        changes = {key: value for key, value in written.changes.items() if not key.startswith(f"{SECTION}.")}
        written = dataclasses.replace(written, mapping=mapping, changes=changes)
    return dataclasses.replace(scene, source=source, written=written, tolerances=(), correlated=())
