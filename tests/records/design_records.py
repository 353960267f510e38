"""What does every design draw and say: at its own dimensions, with each of them changed alone, and at its limits?

Of an outline are kept its number of edges, length, area, centre and extent; of a change only what it moves.
"""

from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import numpy as np
from records.wording import shortened

from watchsim.construction import registry
from watchsim.construction.design import Design, Dimension
from watchsim.drawing.write import Sheet
from watchsim.geometry.loops import Loop, table_of, total_length

SHARES = (0.03, 0.4)  # of the way to a limit: most designs can still be drawn; few can


def records() -> dict[str, Callable[[Path], str]]:
    """By name: what is drawn and said of a design."""
    return {name: partial(of_design, registry.design(name)) for name in registry.own()}


def of_design(design: Design, _: Path) -> str:
    usual = list(_lines(design, {}))
    lines = [design.title, *usual]
    for one in design.dimensions:
        for value in _changed(one):
            now = _lines(design, {one.name: value})
            lines += [f"{one.name} {one.shortly(value)}: {line}" for line in now if line not in usual and line[0] != "#"]
    return shortened("\n".join(lines) + "\n")


def _changed(one: Dimension) -> list[float]:
    """Values towards both limits."""
    values = [one.default + share * (end - one.default) for share in SHARES for end in (one.high, one.low)]
    return [value for value in dict.fromkeys(map(round, values) if one.count else values) if value != one.default]


def _lines(design: Design, chosen: dict[str, float]) -> Iterator[str]:
    refused = design.refusals(chosen)
    yield from (f"refused for {one.dimension}: {one.message}" for one in refused)
    if not refused:
        values = design.chosen(chosen)
        yield from (line for line in design.scene(values).splitlines() if line)
        for name, sheet in design.draw(values).items():
            yield from _of_sheet(name, sheet)


def _of_sheet(name: str, sheet: Sheet) -> Iterator[str]:
    for layer in dict.fromkeys(loop.layer for loop in sheet.loops):
        loops = [loop for loop in sheet.loops if loop.layer == layer]
        yield f"{name}.{layer}: {len(loops)} outlines, {_figures(loops)}"


def _figures(loops: list[Loop]) -> str:
    """In millimetres: edges and arcs, length, then of the edges' starts the mean place and distance, and the extent."""
    edges = table_of([edge for loop in loops for edge in loop.edges])
    starts = edges.start
    numbers = [total_length(loops), *starts.mean(axis=0), np.hypot(*starts.T).mean()]
    numbers += [*(edges.box[:, :2].min(axis=0)), *(edges.box[:, 2:].max(axis=0))]
    return f"{len(starts)} edges, {edges.arc.sum()} arcs, [{', '.join(f'{one:.7g}' for one in numbers)}]"
