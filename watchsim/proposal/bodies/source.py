"""What do the drawings hold, block by block?

What is inserted as a block gets layers of its own, named after the block: scenes choose outlines by layer.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from watchsim.drawing.circles import circle_of
from watchsim.drawing.content import Content, Inserted, Stroke
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.drawn_material import MARKS, last_word
from watchsim.drawing.read import FIT, SNAP, assembled, read_content
from watchsim.geometry.extent import extents
from watchsim.geometry.primitives import Point

CROSSING = "crossing"  # the code of a finding
LIKELY = (0.5e-3, 1.0)  # m across: a drawing without units within these is taken to be in millimetres, else in inches


@dataclass(frozen=True)
class Mark:
    """A point, or a circle on a layer named for pivots; `layer` names it alone where `single`."""

    at: Point
    layer: str
    single: bool
    point: bool


@dataclass(frozen=True)
class Source:
    """One drawing. `units` is a guess where the file does not say; `blocks` names inserted blocks, by prefix of the layer."""

    path: Path
    drawing: Drawing
    units: str | None
    blocks: dict[str, str]
    marks: tuple[Mark, ...]

    @property
    def bad_layers(self) -> frozenset[str]:
        """Layers with faults that a scene would refuse, and that layers of their own for single outlines do not mend."""
        return self._with_errors() - self.crowded

    @property
    def crowded(self) -> frozenset[str]:
        """Layers on which outlines cross and nothing else is wrong: parts drawn over each other."""
        found = self.drawing.findings
        others = {f.layer for f in found if f.severity == "error" and f.code != CROSSING}
        return frozenset(layer for layer in self._with_errors() if layer not in others)

    def _with_errors(self) -> frozenset[str]:
        return frozenset(f.layer for f in self.drawing.findings if f.severity == "error" and f.layer is not None)


def read_source(path: Path) -> Source:
    """The drawing in a file; whatever is wrong with it is among its findings."""
    content = read_content(path, path.suffix.lower().lstrip("."), None, FIT)
    units = None
    if content.strokes and content.units is None:
        units = _likely_unit(content)
        content = read_content(path, path.suffix.lower().lstrip("."), units, FIT)
    blocks: dict[str, str] = {}
    if len(content.inserted) > 1:
        content, blocks = _by_blocks(content)
    drawing = assembled(path, path.suffix.lower().lstrip("."), lambda: content, SNAP)
    return Source(path, drawing, units, blocks, tuple(_marks(drawing)))


def _likely_unit(content: Content) -> str:
    xs = [x for stroke in content.strokes for x, _ in (stroke.edge.start, stroke.edge.end)]
    ys = [y for stroke in content.strokes for _, y in (stroke.edge.start, stroke.edge.end)]
    across = max(max(xs) - min(xs), max(ys) - min(ys))
    return "mm" if LIKELY[0] <= across <= LIKELY[1] else "inch"


def _by_blocks(content: Content) -> tuple[Content, dict[str, str]]:
    """The strokes of each inserted block on layers of their own; prefix of these layers -> block."""
    counts = Counter(one.block for one in content.inserted)
    seen: Counter[str] = Counter()
    named: list[tuple[Inserted, str]] = []
    for one in content.inserted:
        seen[one.block] += 1
        plain = one.block.replace("_", "-")
        named.append((one, plain if counts[one.block] == 1 else f"{plain}-{seen[one.block]}"))
    strokes = tuple(_renamed(stroke, named) for stroke in content.strokes)
    return replace(content, strokes=strokes), {prefix: one.block for one, prefix in named}


def _renamed(stroke: Stroke, named: Sequence[tuple[Inserted, str]]) -> Stroke:
    prefix = next((prefix for one, prefix in named if one.first <= stroke.run <= one.last), None)
    return stroke if prefix is None else replace(stroke, layer=prefix if stroke.layer == "0" else f"{prefix}_{stroke.layer}")


def _marks(drawing: Drawing) -> list[Mark]:
    """Points, and circles on layers called pivots, axes or centres."""
    found = [(layer, (x, y), True) for layer, x, y in drawing.points]
    for loop in drawing.loops:
        circle = circle_of(loop) if last_word(loop.layer) in MARKS else None
        if circle is not None:
            found.append((loop.layer, circle.centre, False))
    on_layer = Counter(layer for layer, _, _ in found)
    lines = {loop.layer for loop in drawing.loops}
    return [Mark(at, layer, on_layer[layer] == 1 and (not point or layer not in lines), point) for layer, at, point in found]


def is_mark(layer: str) -> bool:
    """Is a layer named for what marks a place and is no material?"""
    return last_word(layer) in MARKS


def size_of(drawings: Sequence[Drawing]) -> float:
    """How large everything together is, m."""
    boxes = [box for drawing in drawings if (box := extents((*drawing.loops, *drawing.open_chains)))]
    if not boxes:
        return 0.0
    low = min(box[0] for box in boxes), min(box[1] for box in boxes)
    high = max(box[2] for box in boxes), max(box[3] for box in boxes)
    return max(high[0] - low[0], high[1] - low[1])
