"""How does the co-axial escapement do, beside the Swiss lever? Writes docs/guide/coaxial.md and its pictures.

    python scripts/reports/coaxial/make_coaxial_page.py [page]

Everything is run here, with the package's public functions; nothing is copied from anywhere. Takes some minutes. Only Moreau's time
stepping is run before, by run_coaxial_twin.py, which leaves its numbers in coaxial_twin.csv.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import coaxial_runs
import coaxial_slides
import coaxial_studies
import run_coaxial_twin
from coaxial_scenes import IMAGES, scenes

import watchsim as ws
from watchsim.analysis.timeline.shown_beats import shown_beats
from watchsim.analysis.timeline.timeline_table import timeline_text
from watchsim.construction.known import design
from watchsim.escapement.function_report import text
from watchsim.escapement.measure import measure
from watchsim.mechanism.compile import compile_scene
from watchsim.render.figures.phase_plot import plot_phases
from watchsim.render.stills.function_sheet import function_sheet
from watchsim.render.stills.turn_picture import turn_picture
from watchsim.scene.scene import Scene
from watchsim.turning.happenings import passings
from watchsim.turning.turn import turn
from watchsim.turning.turning_report import turn_text

PAGE = Path(__file__).resolve().parents[3] / "docs" / "guide" / "coaxial.md"
LAST = (179.65, 179.95)  # s: the beats that begin here reach from before 179.68 s to beyond 179.98 s
WHOLE = 180.2  # s, so that the last of them is recorded whole


def dimensions() -> str:
    """The one table of dimensions."""
    lines = ["| dimension | default | limits | what | from |", "|---|---:|---|---|---|"]
    for one in design("coaxial").dimensions:
        limits = f"{one.shown(one.low)} to {one.shown(one.high)}"
        lines.append(f"| `{one.name}` | {one.shown(one.default)} | {limits} | {one.meaning} | {one.source} |")
    return "\n".join(lines)


def function(scene: Scene) -> str:
    """The lines of `watchsim check`; the sheet as a picture."""
    compiled = compile_scene(scene)
    found = measure(scene, compiled)
    function_sheet(scene, compiled, found).savefig(IMAGES / "coaxial_function.png", dpi=130)
    return "\n".join(text(found))


def turned(scene: Scene) -> dict[str, str]:
    """The story of `check --turn`, its picture, and the closest passings."""
    found = turn(scene, math.radians(60.0))
    turn_picture(found, IMAGES / "coaxial_turn.png")
    couples = found.cycle.assembly.couples
    near = [f"- {1e6 * one.distance:.1f} µm: {' and '.join(couples[one.couple].layers)}" for one in passings(found)[:5]]
    return {"turn": turn_text(found), "near": "\n".join(near)}


def timeline(scene: Scene) -> str:
    """Both tables of `plot --phases`, its picture, and one picture of each impulse."""
    import imageio.v3 as imageio

    run = ws.simulate(scene, duration=WHOLE)
    told = shown_beats(run, LAST)
    plot_phases(run, None, beats=told[:2]).savefig(IMAGES / "coaxial_phases.png", dpi=130)
    for name, beat in (("indirect", told[0]), ("direct", told[1])):
        push = next(one.phase for one in beat.stages if one.name == "impulse")
        instant = 0.5 * (push.start + push.end)
        imageio.imwrite(IMAGES / f"coaxial_{name}.png", ws.frame(run, instant, contacts=True))
    return timeline_text(run, told)


def chapters() -> Iterator[tuple[str, Callable[[], dict[str, str]]]]:
    """What is run for the page, one after the other: a name, and what fills places of the page."""
    both = scenes()
    scene = both["coaxial"]
    yield "dimensions", lambda: {"dimensions": dimensions()}
    yield "function", lambda: {"function": function(scene)}
    yield "turned by hand", lambda: turned(scene)
    yield "long runs", lambda: {"longs": coaxial_runs.long_runs(scene)}
    yield "range", lambda: {"map": coaxial_runs.range_map(scene)}
    yield "tolerances", lambda: {"accuracy": coaxial_runs.accuracy(scene)}
    yield "timeline", lambda: {"timeline": timeline(scene)}
    yield "compared", lambda: {"compared": coaxial_studies.compared(both)}
    yield "slides", lambda: {"slides": coaxial_slides.table(both)}
    yield "friction and restitution", lambda: dict(zip(("friction", "restitution"), coaxial_studies.rubbed(both), strict=True))
    yield "torque", lambda: {"torque": coaxial_studies.driven(both)}
    yield "inertia of the wheel", lambda: {"wheels": coaxial_studies.wheels(scene), "weighed": coaxial_studies.weighed(scene)}
    yield "what matters", lambda: {"matters": coaxial_studies.matters(both)}
    yield "time stepping", lambda: {"twin": run_coaxial_twin.twin(run_coaxial_twin.read())}


def page() -> str:
    """The text of the page; draws the pictures and tells how long each chapter took."""
    found: dict[str, str] = {}
    for name, made in chapters():
        began = time.process_time()
        found |= made()
        print(f"{name}: {time.process_time() - began:.1f} s of processor time", flush=True)
    return written(found)


def written(found: dict[str, str]) -> str:
    """The page with its tables in their places."""
    return (Path(__file__).parent / "coaxial_page.md").read_text(encoding="utf-8").format(**found)


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
    from usage import arguments

    asked = arguments(__doc__, page=(PAGE, "the page"))
    Path(asked.page).write_text(page(), encoding="utf-8")
