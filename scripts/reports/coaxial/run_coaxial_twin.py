"""How far is Moreau's time stepping from the motion by events, for ever smaller steps? Writes coaxial_twin.csv beside it.

    python scripts/reports/coaxial/run_coaxial_twin.py [csv]

The page's one long computation: three minutes of processor time, half of it for the finest step. make_coaxial_page.py reads its
numbers from the file.
"""

from __future__ import annotations

import csv
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields
from pathlib import Path

import numpy as np
from coaxial_scenes import IMAGES, scenes

import watchsim as ws
from watchsim.scene.scene import Scene

FOUND = Path(__file__).with_name("coaxial_twin.csv")
STEPS = (4e-6, 2e-6, 1e-6, 5e-7, 2.5e-7, 1.25e-7)  # s
LENGTH = 4.0  # s


@dataclass(frozen=True)
class Stepped:
    """Moreau's stepping against the motion by events, 4 s: errors of amplitude (°) and rate (s/d)."""

    step: float
    worst: float
    end: float
    rate: float


def stepped(scene: Scene) -> Iterator[Stepped]:
    """The twin for ever smaller steps."""
    near = scene.set("bodies.balance.angle", "-289.9°")
    run = ws.simulate(near, duration=LENGTH, tolerance=1e-11)
    true, told = ws.beats(run).amplitude_deg, ws.summary(run)
    for step in STEPS:
        other = ws.simulate(near, duration=LENGTH, method="moreau", step=step)
        own, said = ws.beats(other).amplitude_deg, ws.summary(other)
        off = np.abs(own - true)
        end = abs(said["amplitude_deg"] - told["amplitude_deg"])
        yield Stepped(step, float(off.max()), end, abs(said["rate_s_per_d"] - told["rate_s_per_d"]))


def twin(found: list[Stepped]) -> str:
    """Table and picture of the time stepping."""
    from watchsim.render.figures.figure_style import BAD, CURVE, HAIR, SERIES, SMALL, dress, figure, key, save
    from watchsim.render.palette import FAINT

    steps = np.array([one.step for one in found]) * 1e6
    made = figure(height=80.0, layout="constrained")
    axes = made.subplots()
    told = (
        ("worst", "amplitude, worst beat of 28 (°)", "o"),
        ("end", "amplitude at the end (°)", "s"),
        ("rate", "rate (s/d)", "^"),
    )
    for (name, words, mark), colour in zip(told, (SERIES[0], SERIES[2], SERIES[3]), strict=True):
        y = [getattr(one, name) for one in found]
        axes.loglog(steps, y, mark + "-", color=colour, label=words, linewidth=CURVE, markersize=3.0)
    axes.loglog(steps, found[0].worst * steps / steps[0], "--", color=FAINT, linewidth=CURVE, label="first order")
    entries = [(line, str(line.get_label())) for line in axes.lines]
    axes.axhline(1e-3, color=BAD, linewidth=HAIR)
    axes.annotate("10⁻³ °", (steps[0], 1e-3), xytext=(-4, 3), textcoords="offset points", ha="right", fontsize=SMALL)
    axes.set_xticks(steps, [f"{one:g}" for one in steps])
    axes.minorticks_off()
    axes.set_xlabel("step of the time stepping (µs)")
    axes.set_ylabel("difference from the motion by events")
    dress(axes)
    key(axes, entries, loc="upper left")
    save(made, IMAGES / "coaxial_twin.png")
    lines = ["| step, µs | worst beat, ° | end of 4 s, ° | rate, s/d |", "|---:|---:|---:|---:|"]
    for one in found:
        lines.append(f"| {1e6 * one.step:g} | {one.worst:.1e} | {one.end:.1e} | {one.rate:.1e} |")
    slope = np.polyfit(np.log(steps), np.log([one.worst for one in found]), 1)[0]
    return "\n".join(lines) + f"\n\nSlope of the worst beat over the step: {slope:.2f}."


def written(path: Path, found: list[Stepped]) -> None:
    """A row a step."""
    with path.open("w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, [one.name for one in fields(Stepped)], lineterminator="\n")
        table.writeheader()
        table.writerows({name: f"{value:.6g}" for name, value in asdict(one).items()} for one in found)


def read(path: Path = FOUND) -> list[Stepped]:
    """What was written."""
    with path.open(newline="", encoding="utf-8") as file:
        return [Stepped(**{name: float(value) for name, value in row.items()}) for row in csv.DictReader(file)]


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[2]))
    from usage import arguments

    asked, done, began = arguments(__doc__, csv=(FOUND, "the table")), [], time.process_time()
    for one in stepped(scenes()["coaxial"]):
        print(f"{1e6 * one.step:g} µs: worst beat {one.worst:.2e}°, end {one.end:.2e}°, rate {one.rate:.2e} s/d", flush=True)
        done.append(one)
        written(asked.csv, done)
    print(f"{time.process_time() - began:.0f} s of processor time")
