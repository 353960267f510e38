"""What does a figure show, read back from what was drawn: text boxes, curves in SVG, areas?"""

import io
import re
from itertools import combinations
from xml.etree import ElementTree

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.text import Text

POINTS = 72.0  # per inch, the unit of SVG files
SVG = "{http://www.w3.org/2000/svg}"
SMALLEST = 6.0  # pt
SLACK = 0.5  # dots
OVERLAP = 2.0  # dots that boxes of words may share: letters do not fill theirs


def texts(figure: Figure) -> list[Text]:
    """All words that are drawn: not those of ticks outside the limits."""
    found = [text for text in figure.findobj(Text) if text.get_visible() and text.get_text().strip()]
    hidden: set[int] = set()
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            low, high = sorted(axis.get_view_interval())
            slack = 1e-9 * (high - low)
            for tick in (*axis.get_major_ticks(), *axis.get_minor_ticks()):
                if not low - slack <= tick.get_loc() <= high + slack:
                    hidden |= {id(tick.label1), id(tick.label2)}
                if not tick.label1.get_visible():
                    hidden.add(id(tick.label1))
                if not tick.label2.get_visible():
                    hidden.add(id(tick.label2))
    return [text for text in found if id(text) not in hidden]


def faults(figure: Figure) -> list[str]:
    """Words that stand out of the figure or over one another, or are smaller than print allows."""
    figure.draw_without_rendering()
    renderer = figure.canvas.get_renderer()
    whole, found = figure.bbox, []
    boxes = [(text, text.get_window_extent(renderer)) for text in texts(figure)]
    for (text, box), (other, own) in combinations(boxes, 2):
        if min(box.x1, own.x1) - max(box.x0, own.x0) > OVERLAP and min(box.y1, own.y1) - max(box.y0, own.y0) > OVERLAP:
            found.append(f"{text.get_text()!r} and {other.get_text()!r} stand over one another")
    for text, box in boxes:
        out = (whole.x0 - box.x0, whole.y0 - box.y0, box.x1 - whole.x1, box.y1 - whole.y1)
        if max(out) > SLACK:
            found.append(f"{text.get_text()!r} stands {max(out):.1f} dots out of the figure")
        if text.get_fontsize() < SMALLEST:
            found.append(f"{text.get_text()!r} has {text.get_fontsize()} pt")
    return found


def width_mm(figure: Figure) -> float:
    return 25.4 * float(figure.get_figwidth())


def svg_curve(figure: Figure, axes: Axes, gid: str) -> tuple[np.ndarray, np.ndarray]:
    """A curve as its path in the written SVG runs, back in the units of its axes."""
    out = io.BytesIO()
    figure.savefig(out, format="svg")
    root = ElementTree.fromstring(out.getvalue())
    group = next(one for one in root.iter(f"{SVG}g") if one.get("id") == gid)
    path = group.find(f".//{SVG}path")
    assert path is not None
    numbers = [float(x) for x in re.findall(r"-?\d+\.?\d*(?:e-?\d+)?", path.get("d", ""))]
    x, y = np.array(numbers).reshape(-1, 2).T
    height = figure.get_figheight() * POINTS
    dots = figure.dpi / POINTS
    data = axes.transData.inverted().transform(np.column_stack((x, height - y)) * dots)
    return data[:, 0], data[:, 1]


def named(figure: Figure, gid: str) -> tuple[Axes, object]:
    """The artist with this name, and its axes."""
    for axes in figure.axes:
        for artist in (*axes.lines, *axes.collections, *axes.patches):
            if artist.get_gid() == gid:
                return axes, artist
    raise KeyError(gid)


def area_of(collection: object) -> float:
    """The integral of a filled curve along its own way, in the units of the axes."""
    (path,) = collection.get_paths()  # type: ignore[attr-defined]
    x, y = path.vertices.T
    return -0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))
