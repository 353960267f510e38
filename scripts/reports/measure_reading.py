"""How does the time to read a drawing grow with its size?

Writes drawings of 1 000 to 100 000 edges, measures the whole command `watchsim inspect` in a fresh process (processor time, the
least of a few runs), fits the exponent, and writes docs/images/reading_speed.png and docs/reports/reading-speed.md. `--curves`
measures only what curves take that must be followed by arcs, and renews that part of the page.
"""

from __future__ import annotations

import argparse
import cmath
import math
import os
import random
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path

import numpy as np
from measured import REDRAW, keep, kept

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
SIZES = (1000, 3000, 10_000, 30_000, 100_000)
FITTED_FROM = 10_000  # edges; below, the start of Python is most of the time
CURVED = "## Curves"
SPANS = 57  # of a closed spline
SEED = 1


def line(ax: float, ay: float, bx: float, by: float) -> str:
    return f"0\nLINE\n8\nPART\n10\n{ax!r}\n20\n{ay!r}\n30\n0.0\n11\n{bx!r}\n21\n{by!r}\n31\n0.0\n"


def arc(x: float, y: float, radius: float, start: float, end: float) -> str:
    return f"0\nARC\n8\nPART\n10\n{x!r}\n20\n{y!r}\n30\n0.0\n40\n{radius!r}\n50\n{start!r}\n51\n{end!r}\n"


def toothed_wheel(count: int, rng: random.Random) -> Iterator[str]:
    """One outline of lines, a tooth every two of them, drawn in random order and direction."""
    radius = 0.02 * count
    corners = [
        ((radius + 0.1 * (k % 2)) * math.cos(math.tau * k / count), (radius + 0.1 * (k % 2)) * math.sin(math.tau * k / count))
        for k in range(count)
    ]
    for k in rng.sample(range(count), count):
        a, b = corners[k], corners[(k + 1) % count]
        yield line(*a, *b) if rng.random() < 0.5 else line(*b, *a)


def scalloped_disc(count: int, rng: random.Random) -> Iterator[str]:
    """One outline of half circles side by side along a large circle, in random order."""
    radius = 0.02 * count
    for k in rng.sample(range(count), count):
        half = math.pi / count
        middle, chord = math.tau * (k + 0.5) / count, radius * math.sin(half)
        foot = radius * math.cos(half)
        degrees = math.degrees(middle)
        yield arc(foot * math.cos(middle), foot * math.sin(middle), chord, degrees - 90.0, degrees + 90.0)


def plate_of_holes(count: int, rng: random.Random) -> Iterator[str]:
    """Rounded slots of two lines and two half circles in rows, in a frame, all shuffled."""
    side = math.ceil(math.sqrt(count / 4))
    pieces = []
    for k in range((count - 4) // 4):
        x, y = 2.0 * (k % side), 2.0 * (k // side)
        pieces += [line(x, y - 0.3, x + 0.8, y - 0.3), line(x + 0.8, y + 0.3, x, y + 0.3)]
        pieces += [arc(x + 0.8, y, 0.3, -90.0, 90.0), arc(x, y, 0.3, 90.0, 270.0)]
    far = 2.0 * side
    corners = [(-2.0, -2.0), (far, -2.0), (far, far), (-2.0, far)]
    pieces += [line(*a, *b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
    rng.shuffle(pieces)
    yield from pieces


def crossing_rings(count: int, rng: random.Random) -> Iterator[str]:
    """Circles in rows of which every tenth cuts its neighbour on the right: as many faults as a tenth of the circles."""
    side = math.ceil(math.sqrt(count))
    for k in rng.sample(range(count), count):
        x, y = 2.0 * (k % side) + 0.3 * (k % 10 == 0), 2.0 * (k // side)
        yield arc(x, y, 0.9, 0.0, 360.0)


def spline(points: Sequence[tuple[float, float]], knots: Sequence[float]) -> str:
    groups = "".join(f"40\n{float(knot)}\n" for knot in knots)
    control = "".join(f"10\n{x!r}\n20\n{y!r}\n30\n0.0\n" for x, y in points)
    return f"0\nSPLINE\n8\nPART\n70\n8\n71\n3\n72\n{len(knots)}\n73\n{len(points)}\n74\n0\n{groups}{control}"


def wavy_splines(count: int, rng: random.Random) -> Iterator[str]:
    """Cubic Béziers of any shape, some millimetres long, in rows."""
    side = math.ceil(math.sqrt(count))
    for k in range(count):
        points = [(3.0 * (k % side) + rng.uniform(-1, 1), 3.0 * (k // side) + rng.uniform(-1, 1)) for _ in range(4)]
        yield spline(points, (0, 0, 0, 0, 1, 1, 1, 1))


def wavy_outline(rng: random.Random) -> list[complex]:
    """The control points of a closed cubic spline of SPANS spans, some 20 mm around."""
    waves = [(rng.uniform(0, 0.3) / n, n, rng.uniform(0, math.tau)) for n in range(1, 7)]
    angles = [math.tau * i / (SPANS + 2) for i in range(SPANS + 2)]
    points = [cmath.rect(3.0 + sum(size * math.cos(n * t + phase) for size, n, phase in waves), t) for t in angles]
    return [*points, points[0]]


def in_rows(outlines: Iterable[Iterable[complex]], count: int) -> Iterator[str]:
    side = math.ceil(math.sqrt(count))
    for k, outline in enumerate(outlines):
        points = [(10.0 * (k % side) + z.real, 10.0 * (k // side) + z.imag) for z in outline]
        yield spline(points, (0, 0, 0, *range(SPANS + 1), SPANS, SPANS, SPANS))


def wavy_outlines(count: int, rng: random.Random) -> Iterator[str]:
    return in_rows((wavy_outline(rng) for _ in range(count)), count)


def copies(count: int, rng: random.Random) -> Iterator[str]:
    """One such outline, turned, drawn anew each time."""
    first = wavy_outline(rng)
    return in_rows(([z * cmath.exp(1j * k) for z in first] for k in range(count)), count)


DRAWINGS: dict[str, Callable[[int, random.Random], Iterator[str]]] = {
    "one wheel of lines": toothed_wheel,
    "one disc of arcs": scalloped_disc,
    "slots in a plate": plate_of_holes,
    "circles, some crossing": crossing_rings,
}


ONE_CIRCLE = "a drawing of one circle"
CURVES: dict[str, tuple[Callable[[int, random.Random], Iterator[str]], tuple[int, ...]]] = {
    "cubics": (wavy_splines, (100, 1000, 9000)),
    "outlines": (wavy_outlines, (10, 100, 760)),
    "copies of one outline": (copies, (10, 100, 760)),
}


def write(path: Path, entities: Iterator[str]) -> None:
    head = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"
    path.write_text(head + "".join(entities) + "0\nENDSEC\n0\nEOF\n")


def seconds(path: Path, repeats: int) -> tuple[float, float]:
    """Processor and wall time of the whole command, the least of several runs."""
    best = (math.inf, math.inf)
    for _ in range(repeats):
        before, start = os.times(), time.perf_counter()
        subprocess.run(
            [sys.executable, "-m", "watchsim", "inspect", str(path)], check=True, stdout=subprocess.DEVNULL, cwd=ROOT
        )
        after = os.times()
        used = after.children_user + after.children_system - before.children_user - before.children_system
        best = min(best[0], used), min(best[1], time.perf_counter() - start)
    return best


def exponent(sizes: np.ndarray, times: np.ndarray) -> float:
    """The slope of log time over log size, without what an empty drawing takes."""
    chosen = sizes >= FITTED_FROM
    return float(np.polyfit(np.log(sizes[chosen]), np.log(times[chosen]), 1)[0])


def plot(results: dict[str, np.ndarray], empty: float, path: Path) -> None:
    from watchsim.render.figures.figure_style import CURVE, HAIR, MARKERS, SERIES, SMALL, dress, figure, key, save
    from watchsim.render.palette import FAINT

    made = figure(height=95.0, layout="constrained")
    axes = made.subplots()
    lines = []
    for (name, rows), colour, mark in zip(results.items(), SERIES, MARKERS, strict=False):
        label = f"{name} (n^{exponent(rows[:, 0], rows[:, 1] - empty):.2f})"
        lines += axes.loglog(rows[:, 0], rows[:, 1], mark, ls="-", color=colour, linewidth=CURVE, markersize=3.0, label=label)
    axes.axhline(empty, color=FAINT, linewidth=HAIR, linestyle=":")
    axes.text(SIZES[-1], 1.04 * empty, ONE_CIRCLE, fontsize=SMALL, color=FAINT, ha="right")
    dress(axes)
    axes.set(xlabel="edges", ylabel="processor time of watchsim inspect (s)")
    axes.xaxis.set_major_formatter(lambda n, _: f"{n:,.0f}".replace(",", " "))
    axes.set_yticks([0.2, 0.5, 1, 2, 5], labels=["0.2", "0.5", "1", "2", "5"])
    axes.set_yticks([], minor=True)
    key(axes, [(line, str(line.get_label())) for line in lines], loc="upper left")
    save(made, path)


def table(results: dict[str, np.ndarray], megabytes: dict[str, float], empty: float) -> str:
    head = (
        "# How fast drawings are read\n\n"
        "Made by `scripts/reports/measure_reading.py`: the whole command `watchsim inspect FILE` in a fresh process,\n"
        "processor time in seconds, the minimum of a few runs. Outlines are cut into single entities and shuffled. "
        f"The exponent is fitted from {FITTED_FROM} edges on, after\nsubtracting the {empty:.2f} s of a drawing "
        "of one circle.\n\n"
    )
    sizes = next(iter(results.values()))[:, 0]
    rows = ["| Edges | " + " | ".join(f"{int(n):,}".replace(",", " ") for n in sizes) + " | largest file | exponent |"]
    rows.append("|---" * (len(sizes) + 3) + "|")
    for name, values in results.items():
        times = " | ".join(f"{t:.2f}" for t in values[:, 1])
        rows.append(f"| {name} | {times} | {megabytes[name]:.1f} MB | {exponent(sizes, values[:, 1] - empty):.2f} |")
    return head + "\n".join(rows) + "\n\n![Time against size](../images/reading_speed.png)\n"


def curves_text(repeats: int) -> str:
    """What curves take that are neither straight nor round, from drawings of different size."""
    from watchsim.drawing.read import read
    from watchsim.geometry.fitting.fit import MANY

    rows = []
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "drawing.dxf"
        for name, (make, counts) in CURVES.items():
            for count in counts:
                write(path, make(count, random.Random(SEED)))
                used, drawing = seconds(path, repeats)[0], read(path)
                rows.append(f"| {count} {name} | {path.stat().st_size / 1e6:.2f} MB | {drawing.fitted_arcs} | {used:.2f} |")
    return (
        f"{CURVED}\n\nSplines and Béziers that are neither straight nor round are followed by the fewest arcs within 0.1 µm "
        f"that are found,\nall curves of a drawing at once, copies (blocks, turned teeth, mirrored halves) only once. "
        f"With more than {MANY} spans\nthe search stops a little sooner, with some four per cent more arcs. "
        f"Cubics of any shape some"
        f"\nmillimetres long, and closed outlines of {SPANS} spans:\n\n"
        f"| Curves | file | arcs | seconds |\n|---|---|---|---|\n" + "\n".join(rows) + "\n"
    )


def _keep(results: dict[str, np.ndarray], empty: float) -> None:
    """One row for each drawing in docs/reports/reading-speed.csv; the first is that of one circle."""
    columns = ("drawing", "edges", "processor_s", "wall_s")
    rows = [(ONE_CIRCLE, 1, empty, None), *((name, *row) for name, own in results.items() for row in own.tolist())]
    keep("reading-speed", (dict(zip(columns, row, strict=True)) for row in rows))


def _kept() -> tuple[dict[str, np.ndarray], float]:
    first, *rows = kept("reading-speed")
    names = dict.fromkeys(row["drawing"] for row in rows)
    times = {name: [(row["edges"], row["processor_s"]) for row in rows if row["drawing"] == name] for name in names}
    return {name: np.array(own) for name, own in times.items()}, first["processor_s"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--repeats", type=int, default=3)
    parser.add_argument("--largest", type=int, default=SIZES[-1])
    parser.add_argument("--curves", action="store_true", help="measure curves only")
    parser.add_argument("--dry", action="store_true", help="print only, write nothing into docs")
    parser.add_argument("--redraw", action="store_true", help=REDRAW)
    args = parser.parse_args()
    if args.redraw:
        plot(*_kept(), ROOT / "docs" / "images" / "reading_speed.png")
        return
    page = ROOT / "docs" / "reports" / "reading-speed.md"
    curves = curves_text(args.repeats)
    print(curves)
    if args.curves:
        page.write_text(page.read_text().partition(CURVED)[0].rstrip() + "\n\n" + curves)
        return
    results: dict[str, np.ndarray] = {}
    megabytes: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "drawing.dxf"
        write(path, iter([arc(0.0, 0.0, 1.0, 0.0, 360.0)]))
        empty, _ = seconds(path, args.repeats + 2)
        for name, make in DRAWINGS.items():
            rows = []
            for size in (n for n in SIZES if n <= args.largest):
                write(path, make(size, random.Random(SEED)))
                used, wall = seconds(path, args.repeats)
                rows.append((size, used, wall))
                megabytes[name] = path.stat().st_size / 1e6
                print(f"{name}: {size} edges, {megabytes[name]:.2f} MB, {used:.2f} s ({wall:.2f} s wall)", flush=True)
            results[name] = np.array(rows)
    text = table(results, megabytes, empty) + "\n" + curves
    print(text)
    if not args.dry:
        _keep(results, empty)
        plot(results, empty, ROOT / "docs" / "images" / "reading_speed.png")
        page.write_text(text)


if __name__ == "__main__":
    main()
