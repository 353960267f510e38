"""What does the sheet look like that shows the geometry of function of an escapement, with its angles and their values?

One page 170 mm wide for print, or 85 mm for one column of text.
"""

from __future__ import annotations

import io
import math
import os
from collections.abc import Callable
from pathlib import Path
from textwrap import wrap
from typing import TYPE_CHECKING

from watchsim.escapement.by_hand.hands import Hands
from watchsim.escapement.function_report import direction, text
from watchsim.escapement.measure import Function
from watchsim.mechanism.compile import Compiled
from watchsim.render.posed import Posed
from watchsim.render.stills.function_views import Views, dropped, lift, locked, scale_bar, shape, whole
from watchsim.render.stills.impulse_view import impulse_view
from watchsim.scene.scene import Scene
from watchsim.storage.write import write_file

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MM = 1.0 / 25.4  # inches
FULL, COLUMN = 170.0, 85.0
MARGIN, GAP, TITLE, HEAD = 3.0, 4.0, 11.0, 3.5  # mm
FIRST, PANEL = 80.0, 58.0  # mm, height of the first row and of the others
ROW = 3.4  # mm, of the table
DPI = 300
SENTENCE = 56  # characters


def function_sheet(scene: Scene, compiled: Compiled, function: Function, width: float = FULL) -> Figure:
    """The sheet as a figure, `width` mm wide. ValueError where nothing of it was measured."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    if function.pallets is None:
        raise ValueError("no sheet of the geometry of function: " + "; ".join(why for _, why in function.missing))
    views = Views(Posed(scene, compiled), function, Hands(compiled))
    columns = 2 if width > 1.5 * COLUMN else 1
    made = _views(views)
    lines = [part for line in list(text(function))[1:] for part in _wrapped(line)]
    places, foot = _places(len(made), width, shape(views))
    blocks = _blocks(lines, columns)
    height = foot + ROW * max(len(block) for block in blocks) + 2.0 * MARGIN
    figure = Figure(figsize=(width * MM, height * MM), dpi=DPI, facecolor="white")
    FigureCanvasAgg(figure)
    figure.text(MARGIN / width, 1.0 - 4.5 / height, scene.title, fontsize=10.0, weight="bold", va="center")
    words = f"geometry of function as drawn; wheel {direction(function)}, {function.teeth} teeth"
    figure.text(MARGIN / width, 1.0 - 9.0 / height, words, fontsize=6.5, va="center", color="#444444")
    for view, (left, top, wide, tall) in zip(made, places, strict=True):
        axes = figure.add_axes((left / width, 1.0 - (top + tall) / height, wide / width, tall / height))
        view(axes, wide / tall)
        scale_bar(axes)
    for i, block in enumerate(blocks):
        _table(figure, block, (width, height), (MARGIN + i * 0.5 * width, foot + 2.0))
    return figure


def _places(count: int, width: float, shape: float) -> tuple[list[tuple[float, float, float, float]], float]:
    """(left, top, width, height) of every view, mm, and where they end: on top the first two, the whole as narrow as it is."""
    room = width - 2.0 * MARGIN
    if width <= 1.5 * COLUMN:
        tall = [min(1.2 * room, room / shape)] + [0.8 * room] * (count - 1)
        tops = [TITLE + HEAD + sum(tall[:i]) + i * (GAP + HEAD) for i in range(count + 1)]
        return [(MARGIN, top, room, high) for top, high in zip(tops, tall, strict=False)], tops[-1]
    half = 0.5 * (room - GAP)
    first = min(half, max(0.3 * room, FIRST * shape))
    places = [(MARGIN, TITLE + HEAD, first, FIRST), (MARGIN + first + GAP, TITLE + HEAD, room - first - GAP, FIRST)]
    top = TITLE + 2.0 * HEAD + FIRST + GAP
    for i in range(2, count):
        places.append((MARGIN + ((i - 2) % 2) * (half + GAP), top + ((i - 2) // 2) * (PANEL + GAP + HEAD), half, PANEL))
    return places[:count], top + math.ceil((count - 2) / 2) * (PANEL + GAP + HEAD) - HEAD


def write_sheet(path: str | os.PathLike[str], figure: Figure) -> None:
    """Save it as PNG, SVG or PDF, by the ending of the name."""
    made = io.BytesIO()  # matplotlib has no sentence for a PDF that cannot be written
    figure.savefig(made, format=Path(path).suffix[1:].lower())
    write_file(Path(path), lambda scratch: scratch.write_bytes(made.getvalue()), "the sheet")


def _views(views: Views) -> list[Callable[[Axes, float], None]]:
    detached = views.function.banks is not None
    made: list[Callable[[Axes, float], None]] = [lambda axes, aspect: whole(axes, views, aspect)]
    if views.function.fork is not None:
        made.append(lambda axes, aspect: lift(axes, views, aspect))
    for k in (0, 1) if detached else ():
        made.append(lambda axes, aspect, k=k: locked(axes, views, k, aspect))  # type: ignore[misc]
    for k in (0, 1) if views.function.impulses is not None else ():
        made.append(lambda axes, aspect, k=k: impulse_view(axes, views, k, aspect))  # type: ignore[misc]
    for k in (0, 1):
        made.append(lambda axes, aspect, k=k: dropped(axes, views, k, aspect))  # type: ignore[misc]
    return made


def _wrapped(line: str) -> list[str]:
    """Lines of the table as they are; sentences in lines short enough for the page."""
    if line.startswith("    "):
        return [line]
    return [f"    {part}" for part in wrap(line.strip(), SENTENCE)]


def _blocks(lines: list[str], columns: int) -> list[list[str]]:
    """The table in one column, or with what concerns the balance beside what concerns the stones."""
    split = next((i for i, line in enumerate(lines) if not line.startswith("      ")), len(lines))
    return [lines] if columns == 1 or split == len(lines) else [lines[:split], lines[split:]]


def _table(figure: Figure, lines: list[str], size: tuple[float, float], place: tuple[float, float]) -> None:
    width, height = size
    for i, line in enumerate(lines):
        y = 1.0 - (place[1] + (i + 0.5) * ROW) / height
        figure.text(place[0] / width, y, line[4:], fontsize=6.0, family="monospace", va="center")
