"""Is any random mechanism with loaded or loose pivots, friction that goes with speed, or a shaken case simulated wrongly?

The mechanisms are those of the hunt (scripts/hunt), each given bearings with a load, pivots with play, static and sliding
friction, and blows to its case, by dice of its own. A run must end, or say why it cannot go on; its ledger must close; nothing
may overlap; and at a finer tolerance, and described mirrored and turned, it must move alike as long as twins do, whose numbers
differ by 100 tolerances.

    python scripts/fuzz/oiled.py --count 2000 --minutes 20

Exit status: 0 nothing wrong, 1 something was.
"""

import argparse
import sys
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from hunt.books import OPPOSED, of_a_step, unopposed
from hunt.generate import mechanism
from hunt.parts import Dice, reach
from hunt.views import View, perturbed, views

from watchsim.scene.errors import SceneError
from watchsim.scene.forces import Bearing, Shock, SlipLaw
from watchsim.scene.scene import Scene
from watchsim.simulation.simulate import simulate
from watchsim.simulation.state import Stop
from watchsim.simulation.trajectory import Trajectory

Array = NDArray[np.float64]

PATIENCE = 5.0  # s of processor time, for one run
LEDGER, WRONG_LEDGER = 1e-9, 1e-6  # of what is turned over: what is due, and what is wrong
SAMPLES, TWINS, MORE_TWINS, LIKE = 40, 3, 12, 100.0
COMPACT = 1.3  # inertia over that of a point: a body with less jams in its hole as a rod on its tip does (Painlevé)
FACTOR, FLOOR, LOST = 100.0, 1e-5, 1e-2  # a disagreement, in drifts of the twins; shares of the size


def oiled(scene: Scene, dice: Dice) -> Scene:
    """The scene with some of what an oiled and worn watch has."""
    size = reach(scene)
    heavy = [
        replace(body, mass=4.0 * body.inertia / size**2) if body.motion == "pivot" and body.mass == 0.0 else body
        for body in scene.bodies
    ]
    bearings = []
    for body in heavy:
        poised = body.mass * (body.centre_of_mass[0] ** 2 + body.centre_of_mass[1] ** 2)
        if body.motion == "pivot" and body.mass > 0.0 and dice.chance(0.7):
            radius = dice.log(1e-3, 3e-2) * size
            play = dice.log(1e-2, 0.3) * radius if dice.chance(0.4) and body.inertia > COMPACT * poised else 0.0
            bearings.append(Bearing(body.name, radius, dice.uniform(0.02, 0.3), 0.5 * radius, play))
    contacts = tuple(replace(one, slip=_slip(one.friction, size / scene.duration, dice)) for one in scene.contacts)
    shocks = []
    if dice.chance(0.4):
        hard, lasts = dice.log(1.0, 1e3), dice.log(1e-3, 0.1) * scene.duration
        way = dice.uniform(0.0, 2.0 * np.pi)
        # The case turns on: by 0.1 to 10 rad in the time of the run, so that nothing is flung further than e^10 sizes.
        turn = 0.5 * np.pi * dice.log(0.1, 10.0) / (lasts * scene.duration) if dice.chance(0.3) else 0.0
        acceleration = (hard * float(np.cos(way)), hard * float(np.sin(way)))
        shocks.append(Shock(dice.uniform(0.0, 0.8) * scene.duration, lasts, acceleration, turn))
    return replace(scene, bodies=tuple(heavy), bearings=tuple(bearings), contacts=contacts, shocks=tuple(shocks))


def _slip(friction: float, speed: float, dice: Dice) -> SlipLaw:
    if friction == 0.0 or dice.chance(0.4):
        return SlipLaw()
    drop = dice.uniform(0.0, 0.5) * friction
    return SlipLaw(drop, dice.log(1e-2, 10.0) * speed if dice.chance(0.6) else 0.0, dice.log(1e-3, 0.1) / speed)


class _Clock:
    """Ends a run that takes too long."""

    def __init__(self) -> None:
        self._end = time.process_time() + PATIENCE

    def __call__(self, _simulated: float, _duration: float) -> None:
        if time.process_time() > self._end:
            raise KeyboardInterrupt


def seen(view: View, scene: Scene) -> Scene:
    """The scene from there, blows too."""
    sign = -1.0 if view.mirrored else 1.0
    shocks = tuple(replace(one, acceleration=view._vector(one.acceleration), turn=sign * one.turn) for one in scene.shocks)
    return replace(view.of(scene), shocks=shocks)


def motion(scene: Scene, run: Trajectory, view: View | None = None) -> Array:
    """(samples, coordinates): angles, and lengths as shares of the scene's size; not a number beyond the end of the run."""
    times = np.linspace(0.0, scene.duration, SAMPLES + 1)[1:]
    if len(run.t) == 0:
        return np.full((SAMPLES, 1), np.nan)
    q, _ = run.sample(np.minimum(times, run.simulated))
    q = q if view is None else view.back(scene, run.slices, q)
    size = reach(scene)
    scales = {"pivot": [1.0], "slide": [1.0 / size], "free": [1.0 / size, 1.0 / size, 1.0]}
    columns = [q[:, run.slices[b.name]] * scales[b.motion] for b in scene.bodies if b.name in run.slices]
    found = np.concatenate(columns, axis=1)
    found[times > run.simulated * (1.0 + 1e-12)] = np.nan
    return found


def judged(scene: Scene, number: int) -> tuple[str, str]:
    """(what it is, why)."""
    run = simulate(scene, tolerance=1e-9, progress=_Clock())
    if run.stop == Stop.INTERRUPTED:
        return "hanging", f"at t = {run.simulated:.6g} s"
    off_ledger = missed(run)
    if run.stop in (Stop.OVERLAP, Stop.LEDGER, Stop.UNEXPLAINED) or off_ledger > WRONG_LEDGER:
        return "wrong", f"{run.stop.name}, ledger {off_ledger:.1e}"
    if run.stop.gave_up:
        return "gave up", f"{run.stop.name} at t = {run.simulated:.6g} s"
    base, asked = motion(scene, run), TWINS
    drift = _drift(scene, base, range(TWINS * number, TWINS * number + TWINS))
    view = views(scene, number, 2)[1]
    for label, other, back in (
        ("finer", simulate(scene, tolerance=1e-11, progress=_Clock()), None),
        ("mirrored", simulate(seen(view, scene), tolerance=1e-9, progress=_Clock()), view),
    ):
        off = np.abs(motion(scene, other, back) - base).max(axis=1)
        if _beyond(off, drift) >= 0 and asked == TWINS:  # where a law leaves two branches, three twins may all take the one
            asked, begin = MORE_TWINS, -MORE_TWINS * (number + 1)
            drift = np.maximum(drift, _drift(scene, base, range(begin, begin + MORE_TWINS)))
        k = _beyond(off, drift)
        if k >= 0:
            return "wrong", f"{label}: {off[k]:.1e} apart at sample {k}, twins {drift[k] / FACTOR:.1e}"
        if other.stop.gave_up or other.stop == Stop.INTERRUPTED:
            return "gave up", f"{label}: {other.stop.name} at t = {other.simulated:.6g} s"
    return ("fine" if off_ledger < LEDGER else "ledger"), f"{off_ledger:.1e}"


def _drift(scene: Scene, base: Array, seeds: range) -> Array:
    """(samples,) `FACTOR` times how far twins have gone from the motion by then."""
    drift = np.full(SAMPLES, FLOOR)
    for seed in seeds:
        try:
            twin = simulate(_twin(scene, LIKE * 1e-9, abs(seed)), tolerance=1e-9, progress=_Clock())
        except SceneError:  # what touches may overlap in a twin
            continue
        off = np.abs(motion(scene, twin) - base).max(axis=1)
        drift = np.maximum(drift, FACTOR * np.maximum.accumulate(np.nan_to_num(off, nan=1.0)))
    return drift


def _twin(scene: Scene, share: float, seed: int) -> Scene:
    """The scene perturbed, the play of its pivots by a share of its size: what is small is no more exact for that."""
    rng, by = np.random.default_rng(seed), share * reach(scene)
    loose = [replace(one, play=one.play + by * float(rng.uniform(-1.0, 1.0)) * (one.play > by)) for one in scene.bearings]
    return perturbed(replace(scene, bearings=tuple(loose)), share, seed)


def _beyond(off: Array, drift: Array) -> int:
    """The first sample at which that is further, before the twins are lost; -1 for none."""
    end = int(np.argmax(drift > LOST)) if (drift > LOST).any() else SAMPLES
    far = off[:end] > drift[:end]
    return int(np.argmax(far)) if far.any() else -1


def _swung(run: Trajectory) -> float:
    """The largest kinetic energy of one body, J: what swings freely takes nothing in and gives nothing away."""
    most = 0.0
    for body in run.scene.bodies:
        if body.name in run.slices and len(run.u):
            inertia = np.array([body.inertia] if body.motion == "pivot" else [body.mass, body.mass, body.inertia])
            u = run.u[:, run.slices[body.name]]
            most = max(most, float(np.max(u * u @ (0.5 * inertia[: u.shape[1]]))))
    return most


def missed(run: Trajectory) -> float:
    """By what share of what is turned over the ledger misses, beyond rounding of forces that cancel and errors of one step."""
    allowed = OPPOSED * unopposed(run.scene, run.simulated) + of_a_step(run.scene, run.tolerance, 0.0)
    spent = sum(run.energy["dissipated"].values())
    turned_over = max(abs(run.energy["in_J"]), abs(run.energy["stored_J"]), spent, allowed, _swung(run))
    return max(abs(run.energy["residual_J"]) - allowed, 0.0) / turned_over if turned_over else 0.0


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--start", type=int, default=0)
    parser.add_argument("--count", type=int, default=1000)
    parser.add_argument("--minutes", type=float, default=20.0, help="at most (default %(default)s)")
    args = parser.parse_args()
    end, counts, dressed = time.monotonic() + 60.0 * args.minutes, Counter[str](), Counter[str]()
    simulate(mechanism(1, 0))  # compiles
    for number in range(args.start, args.start + args.count):
        if time.monotonic() > end:
            break
        scene = oiled(mechanism(args.seed, number), Dice(args.seed + 1000, number))
        dressed["bearings"] += any(not one.play for one in scene.bearings)
        dressed["play"] += any(one.play > 0.0 for one in scene.bearings)
        dressed["shocks"] += bool(scene.shocks)
        dressed["slip"] += any(one.slip != SlipLaw() for one in scene.contacts)
        try:
            kind, why = judged(scene, number)
        except Exception as error:  # a fault of the program is what is looked for
            kind, why = "crashed", f"{type(error).__name__}: {error}"
        counts[kind] += 1
        if kind != "fine":
            print(f"{number} {scene.title}: {kind}: {why}", flush=True)
    print(f"{sum(counts.values())} mechanisms, seed {args.seed}, from {args.start}: {dict(counts)}; with {dict(dressed)}")
    return int(any(counts[kind] for kind in ("wrong", "crashed", "hanging")))


if __name__ == "__main__":
    sys.exit(main())
