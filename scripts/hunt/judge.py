"""Is the motion of a mechanism right, as far as it can be known without a reference?

1. *Books.* Every run must obey mechanics (`hunt.books`): it ends; the ledger closes; energy, computed from the rows, never
   grows; no material inside material; each jump of velocity lies in the cone of impulses of the contacts that touch.
2. *Agreement.* The same mechanism at three tolerances, and turned, mirrored and drawn otherwise, must move alike. How exactly
   it can, its own twins say: the same mechanism with all numbers changed by a share of 100 tolerances. A disagreement is wrong
   if it is ten times larger than all that the twins have drifted apart until then, and than `FLOOR` tolerances. So chaotic
   motion is compared until it has forgotten its start, and where a law is discontinuous (simultaneous impacts, grazes,
   sticking) the twins fall into its branches and vouch for them. A twin that breaks the books vouches for nothing, and makes
   the mechanism wrong. Nor is a disagreement wrong that has only grown: what the runs do otherwise piece by piece
   (`hunt.views.made`) then explains next to nothing of it.
3. *Witness.* Moreau's time stepping, for a share of the mechanisms (`hunt.witness`).
"""

import math
import time
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from hunt.books import faults
from hunt.open_motion import grazed
from hunt.parts import Material, reach
from hunt.views import View, made, perturbed, views
from hunt.witness import witness_fault
from watchsim.scene.errors import SceneError
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import EventKind, Stop
from watchsim.simulation.trajectory import Trajectory

Array = NDArray[np.float64]

TOLERANCES = (1e-9, 1e-7, 1e-11)
ORIENTATIONS = 2  # besides that of the scene
TWINS = 6  # of each size
LIKE = 100.0  # tolerances: a twin's change that does as much as the error of a run
FACTOR, FLOOR = 10.0, 300.0
SAMPLES = 100
MERGED = 4.0  # tolerances of the size: gaps that a run may take for closed
LOST = 1e-2  # of the size: twins this far apart have forgotten their start
PATIENCE = 4.0  # s of processor time, for one run


@dataclass
class Verdict:
    """`kind`: fine, sensitive, wrong, gave up, hanging; `reasons` a phrase each.

    `judged`: the share of the duration within which twins of 1e-7 stay together, 1 where no twin was needed.
    """

    kind: str = "fine"
    reasons: list[str] = field(default_factory=list)
    runs: int = 0
    events: int = 0
    judged: float = 1.0
    seconds: float = 0.0


class _Hanging(Exception):
    """One run that hangs is enough."""


class _Clock:
    """Ends a run that takes too long; the solver looks at it between slices, the first of which may have been compiled."""

    def __init__(self) -> None:
        self._end = math.inf

    def __call__(self, _simulated: float, _duration: float) -> None:
        now = time.process_time()
        self._end = min(self._end, now + PATIENCE)
        if now > self._end:
            raise KeyboardInterrupt


class _Other(NamedTuple):
    """The same mechanism described otherwise, or at another tolerance; `tolerance` is the coarser one of the two runs."""

    label: str
    tolerance: float
    run: Trajectory
    view: View | None = None


class Judge:
    """All runs of one mechanism."""

    def __init__(self, scene: Scene, seed: int = 0) -> None:
        self.scene, self.seed = scene, seed
        self.material = Material(scene)
        self.times = np.linspace(0.0, scene.duration, SAMPLES + 1)[1:]
        self.verdict = Verdict()
        self.weights = _weights(scene)
        # Free bodies meet so many cells that looking them up would be most of the hunt.
        self._roams = any(body.motion == "free" for body in scene.bodies)

    def run(self, scene: Scene, tolerance: float, prefilter: bool = False) -> Trajectory:
        self.verdict.runs += 1
        return simulate(scene, tolerance=tolerance, prefilter=prefilter, progress=_Clock())

    def motion(self, run: Trajectory, view: View | None = None, times: Array | None = None) -> Array:
        """(samples, n): lengths as shares of the scene's size, seen from where the scene was described."""
        times = self.times if times is None else times
        if len(run.t) == 0:
            return np.full((len(times), len(self.weights)), np.nan)
        q, _ = run.sample(times)
        return (q if view is None else view.back(self.scene, run.slices, q)) * self.weights

    def book(self, run: Trajectory, label: str) -> bool:
        """Notes what is wrong with a run by itself; True where nothing is."""
        material = self.material if run.scene is self.scene else Material(run.scene)
        found = list(faults(run, material))
        self.verdict.reasons += [f"{text} ({label})" for text in found]
        if run.stop == Stop.INTERRUPTED:
            raise _Hanging
        return not found

    def judge(self, with_witness: bool) -> Verdict:
        begun = time.perf_counter()
        with suppress(_Hanging):
            self._judge(with_witness)
        verdict = self.verdict
        verdict.seconds = time.perf_counter() - begun
        if verdict.reasons:
            words = [reason.split(":")[0] for reason in verdict.reasons]
            gave_up = all(word in ("gave up", "hanging") for word in words)
            verdict.kind = words[0] if gave_up else "wrong"
        return verdict

    def _judge(self, with_witness: bool) -> None:
        base = self.run(self.scene, TOLERANCES[0], prefilter=not self._roams or self.seed % 8 == 0)
        self.verdict.events = len(base.events)
        sound = self.book(base, "as described")
        others: list[_Other] = []
        for tolerance in TOLERANCES[1:]:
            run = self.run(self.scene, tolerance)
            sound &= self.book(run, f"tolerance {tolerance:g}")
            others.append(_Other(f"tolerance {tolerance:g}", max(tolerance, TOLERANCES[0]), run))
        for k, view in enumerate(views(self.scene, self.seed, ORIENTATIONS)):
            run = self.run(view.of(self.scene), TOLERANCES[0])
            sound &= self.book(run, f"orientation {k + 1}")
            others.append(_Other(f"orientation {k + 1}", TOLERANCES[0], run, view))
        if not sound:
            return
        middle = self.motion(base)
        spread: dict[float, Array] = {}
        for other in others:
            distance = _drift(middle, self.motion(other.run, other.view))
            if distance[-1] <= FLOOR * other.tolerance:
                continue
            if other.tolerance not in spread:
                spread[other.tolerance] = self.spread(middle, other.tolerance)
            self._compare(base, other, distance, spread[other.tolerance])
        if spread:
            wide = spread.get(TOLERANCES[0], spread.get(TOLERANCES[1]))
            assert wide is not None
            self.verdict.judged = float(np.mean(wide < LOST))
            if self.verdict.judged < 0.5:
                self.verdict.kind = "sensitive"
        if with_witness and not self.verdict.reasons:
            self.verdict.reasons += list(witness_fault(self, base, middle))

    def _compare(self, base: Trajectory, other: _Other, distance: Array, spread: Array) -> None:
        tolerance, run = other.tolerance, other.run
        allowed = np.maximum(FLOOR * tolerance, FACTOR * spread)
        if other.label.startswith("tolerance"):
            allowed += self._cut_short(base, tolerance)
        if (distance > allowed).any():
            error = tolerance * self.material.size
            allowed += sum(grazed(each, error, self.weights, self.times) for each in (base, run))
        if (distance > allowed).any():
            distance = np.minimum(distance, made(self, base, run.tolerance, other.view) + made(self, run, run.tolerance))
        beyond = np.flatnonzero(distance > allowed)
        if len(beyond):
            k = beyond[0]
            if merged(base, MERGED * tolerance * self.material.size, self.times[k]):
                return
            by, at = distance[k], self.times[k]
            self.verdict.reasons.append(
                f"disagrees: {other.label} by {by:.1e} of the size at t = {at:.6g} s, twins by {spread[k]:.1e}"
            )

    def _cut_short(self, base: Trajectory, tolerance: float) -> Array:
        """(samples,): what rebounds may still do that are too low for a tolerance and are ended by rule (method, 2.9).

        They rise by the tolerance's share of the size; their speed may go along the faces from then on.
        """
        ended = base.events["t"][base.events["kind"] == EventKind.ACCUMULATION]
        if not len(ended):
            return np.zeros(len(self.times))
        fastest = float(np.abs(base.a * self.weights).max())  # sizes per second squared
        return np.sqrt(2.0 * fastest * tolerance) * np.maximum(self.times - ended.min(), 0.0)

    def spread(self, middle: Array, tolerance: float) -> Array:
        """(samples,): how far twins with a change of 100 tolerances have drifted from the scene and from each other."""
        motions = [middle]
        for k in range(TWINS):
            twin = perturbed(self.scene, LIKE * tolerance, 2 * self.seed + 1000 + k, 1.0 if k % 2 else -1.0)
            try:
                run = self.run(twin, TOLERANCES[0])
            except SceneError:  # the change made bodies overlap at the start
                continue
            if self.book(run, f"twin {k} of {LIKE * tolerance:g}"):
                motions.append(self.motion(run))
        return np.maximum.accumulate(np.ptp(np.array(motions), axis=0).max(axis=1))


def merged(run: Trajectory, gap: float, until: float) -> bool:
    """Do two impacts of different contacts follow so closely that a run which takes gaps up to `gap` for closed makes them one?

    Where a multiple impact comes out otherwise than its parts in turn, which is what the law says, both motions are right
    at their tolerances.
    """
    found = run.events[(run.events["kind"] == EventKind.IMPACT) & (run.events["t"] <= until)]
    if len(found) < 2:
        return False
    wait = np.diff(found["t"])
    other = found["contact"][1:] != found["contact"][:-1]
    return bool((other & (wait > 0.0) & (wait * np.abs(found["value"][1:]) <= gap)).any())


def _drift(a: Array, b: Array) -> Array:
    """(samples,): the largest distance until then."""
    return np.maximum.accumulate(np.abs(a - b).max(axis=1))


def _weights(scene: Scene) -> Array:
    """(n,): what makes shares of the scene's size of coordinates."""
    size, found = reach(scene), []
    for body in scene.bodies:
        if body.motion == "fixed":
            continue
        own = reach(replace(scene, bodies=(body,))) / size
        found += {"pivot": [own], "slide": [1.0 / size], "free": [1.0 / size, 1.0 / size, own]}[body.motion]
    return np.array(found)


def judged(scene: Scene, seed: int = 0, with_witness: bool = False) -> Verdict:
    return Judge(scene, seed).judge(with_witness)
