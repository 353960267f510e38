"""How does the time of a simulation grow with the number of declared pairs of primitives?

The same lever with few or all teeth declared, and with its edges cut into ever more pieces, those that slide on each other left
whole, so that the motion is the same. Writes docs/reports/complexity.md and docs/images/complexity.png.

    python scripts/reports/study_complexity.py [--quick]
"""

from __future__ import annotations

import argparse
import dataclasses
import math
import time
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from measured import REDRAW, keep, kept
from numpy.typing import NDArray

from watchsim.candidates.pair_cache import forget
from watchsim.geometry.loop import Loop
from watchsim.geometry.primitives import Arc, Edge, Line
from watchsim.mechanism.compile import compile_scene
from watchsim.model.records import ARC, CORNER, Records
from watchsim.scene.body import Body
from watchsim.scene.file.load import load
from watchsim.scene.recording import EVERYTHING
from watchsim.scene.scene import Scene
from watchsim.simulation.frozen_run import trajectory_of
from watchsim.simulation.record.saved_state import SavedState
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.runner import Run
from watchsim.simulation.simulate import simulate
from watchsim.simulation.stops import Stop

ROOT = Path(__file__).resolve().parents[2]
DURATION = 0.5  # s, four beats
TURN = 3.75  # s, a turn of the escape wheel: every tooth has its turn
REFINED = (1, 3, 8, 20, 50, 100, 182)  # pieces of each edge
REPEATS = 15
MOST_BRUTE = 1.5e4  # declared pairs: beyond it brute force is not waited for
Mark = tuple[str, int, int]


def mark(body: Body, edge: Edge) -> Mark:
    """What an edge has in common with those of other teeth: its length and its distance from the pivot, in nanometres."""
    x, y = edge.point(0.5)
    return body.name, round(1e9 * edge.length), round(1e9 * math.hypot(x, y))


def pieces(edge: Edge, count: int) -> tuple[Edge, ...]:
    """The edge cut into equal parts."""
    if isinstance(edge, Arc):
        sweep = edge.sweep / count
        return tuple(Arc(edge.x, edge.y, edge.radius, edge.start_angle + i * sweep, sweep) for i in range(count))
    ends = [edge.point(i / count) for i in range(count + 1)]
    return tuple(Line(*a, *b) for a, b in pairwise(ends))


def refined(scene: Scene, count: int, whole: set[Mark]) -> Scene:
    """Every edge but those in `whole` cut into `count` pieces."""
    bodies = []
    for body in scene.bodies:
        loops = []
        for loop in body.loops:
            edges = [part for edge in loop.edges for part in ((edge,) if mark(body, edge) in whole else pieces(edge, count))]
            loops.append(dataclasses.replace(loop, edges=tuple(edges)))
        bodies.append(dataclasses.replace(body, loops=tuple(loops)))
    return dataclasses.replace(scene, bodies=tuple(bodies))


def touched(scene: Scene, run: Trajectory) -> set[Mark]:
    """Edges that touch anything in the run."""
    names = [body.name for body in scene.bodies]
    found: set[Mark] = set()
    for primitive in touched_primitives(scene, run):
        body = scene.body(names[primitive.body])
        for loop in body.loops:
            found.update(mark(body, edge) for edge in loop.edges if bears(edge, primitive))
    return found


def touched_primitives(scene: Scene, run: Trajectory) -> list[Records]:
    model = compile_scene(scene).model
    ids = np.unique(run.events["contact"][run.events["contact"] >= 0])
    return [model.primitives[i] for i in np.unique([model.contacts.a[ids], model.contacts.b[ids]])]


def bears(edge: Edge, primitive: Records) -> bool:
    """The primitive is this edge, not a corner beside it."""
    if primitive.kind == CORNER or isinstance(edge, Arc) != (primitive.kind == ARC):
        return False
    return math.dist(edge.point(0.5 if isinstance(edge, Arc) else 0.0), (primitive.px, primitive.py)) < 1e-9


def on_outline(loop: Loop, primitive: Records) -> bool:
    """The primitive is an edge of this outline, or a corner at one of its ends."""
    corner = primitive.kind == CORNER
    return any(
        math.dist(edge.start, (primitive.px, primitive.py)) < 1e-9 if corner else bears(edge, primitive) for edge in loop.edges
    )


def few_outlines(scene: Scene, run: Trajectory) -> Scene:
    """Only the outlines that are touched: a few teeth."""
    met = touched_primitives(scene, run)
    bodies = []
    for number, body in enumerate(scene.bodies):
        mine = [primitive for primitive in met if primitive.body == number]
        loops = tuple(loop for loop in body.loops if any(on_outline(loop, primitive) for primitive in mine))
        bodies.append(dataclasses.replace(body, loops=loops))
    return dataclasses.replace(scene, bodies=tuple(bodies))


@dataclasses.dataclass
class Row:
    """One measured scene; times are of the processor, s per simulated second where nothing else is said."""

    declared: int
    reachable: int
    setup: float  # s, once: flattening, what can be found out in advance, the end state
    learning: float  # a first run, which asks for its cells
    known: float  # later runs
    turn: float | None  # later runs of a whole turn of the wheel
    brute: float | None
    events: int
    gaps: int  # gap functions evaluated in a later run


class TimedRun(Run):
    """A run that knows how long its end state took to save, which it does once, however long it is."""

    saving = 0.0

    def save(self) -> SavedState:
        start = time.process_time()
        saved = super().save()
        self.saving += time.process_time() - start
        return saved


def loop_time(scene: Scene, prefilter: bool, duration: float = DURATION) -> tuple[float, float, TimedRun]:
    """Processor times: to get ready and to save the end state (s), and of the event loop (s per simulated second)."""
    start = time.process_time()
    run = TimedRun(scene, compile_scene(scene, prefilter), scene.tolerance, EVERYTHING)
    ready = time.process_time()
    run.warm_up()
    begin = time.process_time()
    stop = run.to_the_end(duration, None)
    assert stop == Stop.DURATION, stop
    spent = time.process_time() - begin - run.saving
    return ready - start + run.saving, spent / duration, run


def events_of(run: Run) -> NDArray[Any]:
    return trajectory_of(run, Stop.DURATION, 0.0, 0.0).events


def measure(scene: Scene, whole_turn: bool) -> Row:
    """All times of one scene; the events with and without the prefilter must be the same to the last bit."""
    forget()
    setup, learning, run = loop_time(scene, True)
    known = min(loop_time(scene, True)[1] for _ in range(REPEATS))
    model, events = run.compiled.model, events_of(run)
    turn = None
    if whole_turn:
        loop_time(scene, True, TURN)
        turn = min(loop_time(scene, True, TURN)[1] for _ in range(REPEATS // 3))
    brute = None
    if len(model.contacts) <= MOST_BRUTE:
        brutes = [loop_time(scene, False) for _ in range(3)]
        brute = min(spent for _, spent, _ in brutes)
        assert events.tobytes() == events_of(brutes[0][2]).tobytes()
    gaps = int(loop_time(scene, True)[2].state.counts.gap_evaluations)
    return Row(len(model.contacts), len(model.near), setup, learning, known, turn, brute, len(events), gaps)


def rows(quick: bool) -> list[Row]:
    """From few teeth to all, then ever finer."""
    scene = load(ROOT / "profiles" / "bench_lever" / "scene.toml")
    run = simulate(scene, DURATION)
    whole = touched(scene, run)
    found = [measure(few_outlines(scene, run), False)]
    for count in REFINED[: 3 if quick else None]:
        found.append(measure(refined(scene, count, whole), True))
        print(found[-1], flush=True)
    return found


def table(found: list[Row]) -> str:
    """The measured numbers in Markdown, times in milliseconds."""
    lines = [
        "| Declared pairs | that can ever touch | preparation, ms | first run | later runs | a turn of the wheel "
        "| brute force | gaps evaluated | events |",
        "|---:|---:|---:|---:|---:|---:|---:|---:|---:|",
    ]
    for row in found:
        counts = (f"{row.declared:,}", f"{row.reachable:,}", f"{1e3 * row.setup:.0f}")
        times = ("" if t is None else f"{1e3 * t:.2f}" for t in (row.learning, row.known, row.turn, row.brute))
        lines.append("| " + " | ".join((*counts, *times, f"{row.gaps:,}", str(row.events))) + " |")
    return "\n".join(lines)


def plot(found: list[Row], path: Path) -> None:
    """Time per simulated second over declared pairs, both logarithmic."""
    from watchsim.render.figures.figure_style import CURVE, SERIES, dress, figure, key, save

    made = figure(height=100.0, layout="constrained")
    axes = made.subplots()
    blue, red, _, _, _, light, _ = SERIES
    look = {"linewidth": CURVE, "markersize": 3.0}
    x = [row.declared for row in found]
    brute = [(row.declared, row.brute) for row in found if row.brute is not None]
    axes.loglog(*zip(*brute, strict=True), "s-", color=red, **look, label="brute force: every pair in every step")
    axes.loglog(x, [row.learning for row in found], "o--", color=light, **look, label="prefilter, first run of a geometry")
    axes.loglog(x, [row.known for row in found], "o-", color=blue, **look, label="prefilter, later runs: four beats")
    turn = [(row.declared, row.turn) for row in found if row.turn is not None]
    axes.loglog(*zip(*turn, strict=True), "x:", color=blue, **look, label="the same, a whole turn of the wheel")
    axes.set_xlabel("declared pairs of primitives")
    axes.set_ylabel("processor time per simulated second, s")
    dress(axes)
    axes.set_ylim(bottom=1e-3)
    key(axes, [(line, str(line.get_label())) for line in axes.lines], loc="upper left")
    save(made, path)


PAGE = """# Input complexity and computing time

How much does a simulation slow down when more is declared than it needs? The bench lever for {duration:g} s
({beats} beats): first with only the teeth that are touched in that time, then with all teeth, then with every edge on
which nothing slides cut into ever more pieces, so that the motion is the same. Written by
`scripts/reports/study_complexity.py`; processor time of one core in milliseconds for one simulated second (the event loop, the
search for candidates included), events recorded.

![Time per simulated second over declared pairs](../images/complexity.png)

{table}

From {low:,} to {high:,} declared pairs the time of later runs grows by a factor of {growth:.2f}; over a whole turn of
the wheel ({turn:g} s, all teeth) by {turn_growth:.2f} from {second:,} pairs on. Brute force looks at every declared pair
in every step and has the same events to the last bit; it is not run beyond {most:,} pairs.

*First run* asks shapely about each cell of the configuration space it enters; *later runs* of the same geometry, such as
a sweep over torques or friction, ask nothing. *Preparation* is done once, however long the run: the scene becomes a
model, what can be known in advance is found (what can ever touch, symmetries), and the digest of the model in the end state
is computed.
"""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="small scenes only, nothing is written")
    parser.add_argument("--redraw", action="store_true", help=REDRAW)
    args = parser.parse_args()
    if args.redraw:
        plot([Row(**row) for row in kept("complexity")], ROOT / "docs" / "images" / "complexity.png")
        return
    found = rows(args.quick)
    print(table(found))
    if args.quick:
        return
    keep("complexity", map(dataclasses.asdict, found))
    plot(found, ROOT / "docs" / "images" / "complexity.png")
    growth = found[-1].known / found[0].known
    text = PAGE.format(
        duration=DURATION,
        beats=round(8 * DURATION),
        table=table(found),
        low=found[0].declared,
        high=found[-1].declared,
        growth=growth,
        turn=TURN,
        turn_growth=(found[-1].turn or 0.0) / (found[1].turn or 1.0),
        second=found[1].declared,
        most=int(MOST_BRUTE),
    )
    (ROOT / "docs" / "reports" / "complexity.md").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
