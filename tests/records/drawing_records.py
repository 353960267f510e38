"""What does `watchsim inspect` say of many drawings, whole and damaged?"""

import math
import random
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import dxf_text as d
import mutate_dxf
import mutate_svg
import random_dxf
import svg_text as s
from records.wording import said

from watchsim.drawing.drawing import Drawing
from watchsim.drawing.inspection import inspect_report, inspect_text
from watchsim.drawing.read import read
from watchsim.drawing.write import dxf_text, svg_text
from watchsim.geometry.loops import Loop, extents, total_length
from watchsim.geometry.solids import section, section_of_loop

RANDOM, DAMAGED = (0, 1, 2, 3, 6, 8, 9, 10, 11), 40  # seeds of small ones; how many
FACETS = (12, 36, 90, 360)  # of an egg
FEW = 12  # outlines, one by one
SEEN = 1e-6  # µm: a deviation below is that of floating point
OPTIONS = ({"units": "inch"}, {"snap": 2e-4}, {"fit": 1e-5}, {"fit": 1e-9})


def records() -> dict[str, Callable[[Path], str]]:
    """By name: what is said, of a file written into a folder."""
    found: dict[str, Callable[[Path], str]] = {}
    for mutator in (mutate_dxf, mutate_svg):
        ending, samples = mutator.ENDING, mutator.samples()
        for k, data in enumerate(samples):
            found[f"{ending} {k}"] = partial(inspected, data, ending)
            found |= {f"{ending} {k} {one}": partial(outlined, data, ending, one) for one in OPTIONS}
        for seed in range(DAMAGED):
            rng = random.Random(f"record {seed}")
            data = mutator.mutate(rng, samples[seed % len(samples)])
            found[f"{ending} damaged {seed}"] = partial(damaged, data, ending)
    for seed in RANDOM:
        data, _ = random_dxf.drawing(random.Random(f"record {seed}"))
        found[f"random blocks {seed}"] = partial(damaged, data, "dxf")
        found[f"turned and torn {seed}"] = partial(damaged, transformed(random.Random(f"record {seed}")), "svg")
    for count in FACETS:
        found[f"{count} facets"] = partial(damaged, faceted(count), "dxf")
    for ending in ("dxf", "svg"):
        found[f"written again as {ending}"] = partial(written_again, ending)
    return found


def faceted(count: int) -> bytes:
    """An egg as a polygon, once with even pieces and once with uneven ones, a double corner among them, far off the origin."""
    even = [math.tau * k / count for k in range(count)]
    uneven = [angle + 0.4 / count * math.sin(7.0 * angle) for angle in even]
    eggs = [
        [(x + 3.0 * math.cos(angle) + 0.4 * math.cos(2.0 * angle), 2.0 * math.sin(angle)) for angle in angles]
        for x, angles in ((0.0, even), (2e4, [*uneven, uneven[-1]]))
    ]
    return d.dxf("".join(d.lwpolyline(egg, True) for egg in eggs))


def transformed(rng: random.Random) -> bytes:
    """Arcs, circles and curves under two random maps each, some of them half a circle far off."""
    maps = (
        lambda: f"translate({rng.uniform(-9, 9):.3f} {rng.uniform(-9, 9):.3f})",
        lambda: f"rotate({rng.uniform(-360, 360):.2f} 3 4)",
        lambda: f"scale({rng.choice((1, -1, 0.5, 2))} {rng.choice((1, -1, 0.5, 2))})",
        lambda: f"skewX({rng.uniform(-40, 40):.2f})",
        lambda: f"matrix(0 {rng.choice((1, -1))} 1 0 {rng.uniform(-9, 9):.3f} 0)",
    )
    shapes = []
    for _ in range(5):
        r, far = round(rng.uniform(0.3, 2.0), 3), rng.choice((0, 0, 12345))
        path = rng.choice((f"M{far} 1a{r} {r} 0 0 1 {2 * r} 0z", f"M1 {far}a{r} 1 30 1 0 1 1z", f"M{far} 0q{r} 3 4 0t1 -2z"))
        shapes.append(s.path(path, f'transform="{rng.choice(maps)()} {rng.choice(maps)()}"'))
    return s.svg("".join(shapes)).encode()


def inspected(data: bytes, ending: str, folder: Path) -> str:
    """All that the command says of a whole drawing, as text and as JSON."""
    drawing = _read(data, ending, folder)
    report = inspect_report(drawing)
    for name in ("file", "loops"):
        report.pop(name)
    if 1e6 * drawing.fitted_deviation < SEEN:
        report["fitted"] = "exactly"
    return "\n".join([_words(drawing), *said(report), *_outlines(drawing)]) + "\n"


def damaged(data: bytes, ending: str, folder: Path) -> str:
    """What it says in words, and the first few outlines."""
    drawing = _read(data, ending, folder)
    lines = [_words(drawing), *said([drawing.drawn.length, drawing.fitted_arcs], "drawn, arcs"), *_outlines(drawing)]
    return "\n".join(lines) + "\n"


def _words(drawing: Drawing) -> str:
    return inspect_text(drawing).replace(str(drawing.path), drawing.path.name)


def outlined(data: bytes, ending: str, options: dict[str, object], folder: Path) -> str:
    """The outlines and findings alone, read with options."""
    drawing = _read(data, ending, folder, **options)
    return "\n".join([*_outlines(drawing), *(finding.message for finding in drawing.findings)]) + "\n"


def written_again(ending: str, folder: Path) -> str:
    """A drawing of lines, arcs and circles as the package writes it."""
    drawing = _read(mutate_dxf.samples()[0], "dxf", folder)
    plain = [loop for loop in drawing.loops if len(loop.edges) < 8]
    if ending == "svg":
        return svg_text(plain) + "\n"
    body = dxf_text(plain).partition("ENTITIES")[2]
    return "\n".join(line.strip() for line in body.splitlines()) + "\n"


def _read(data: bytes, ending: str, folder: Path, **options: object) -> Drawing:
    path = folder / f"drawing.{ending}"
    path.write_bytes(data)
    return read(path, **options)  # type: ignore[arg-type]


def _outlines(drawing: Drawing) -> Iterator[str]:
    """One line each for the first few, and the sums over all."""
    everything = (*drawing.loops, *drawing.open_chains)
    yield from map(outline, everything[:FEW])
    if len(everything) > FEW:
        whole = section(drawing.loops).about((0.0, 0.0))
        sums = [1e3 * total_length(everything), 1e6 * whole.area, 1e9 * whole.first_x, 1e9 * whole.first_y, 1e12 * whole.polar]
        yield from said(sums, "all together: length, area, first moments, polar")


def outline(loop: Loop) -> str:
    """Layer, kind, edges, length (mm), box, and moments of the area about the origin (mm², mm³, mm⁴)."""
    kind = ("hole" if loop.hole else "outline") if loop.closed else "chain"
    box = [1e3 * side for side in extents([loop]) or ()]
    words = f"{kind} on {loop.layer}: {len(loop.edges)} edges, {1e3 * loop.length:.10g} mm"
    if not all(map(math.isfinite, box)):
        return words
    words += f", box [{', '.join(f'{side:.10g}' for side in box)}]"
    if not loop.closed:
        return words
    found = section_of_loop(loop).about((0.0, 0.0))
    first = f"{1e9 * found.first_x:.10g}, {1e9 * found.first_y:.10g}"
    return f"{words}, area {1e6 * found.area:.10g}, first [{first}], polar {1e12 * found.polar:.10g}"
