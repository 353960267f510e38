"""What is drawn while a picture is made, as plain text: each stroke, fill, marker and word that the renderer gets.

A line holds what looks the same: how many, how many corners, where from and to, and their mean place (pixels).
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import RendererAgg
from matplotlib.colors import to_hex
from matplotlib.path import Path as Outline

Stroke = tuple[str, np.ndarray[Any, Any]]  # how it looks, and its corners (n, 2)


@contextmanager
def noted() -> Iterator[list[Stroke]]:
    """The strokes of all pictures drawn within."""
    found: list[Stroke] = []
    begin = RendererAgg.__init__

    def started(self: RendererAgg, *given: Any, **named: Any) -> None:
        begin(self, *given, **named)
        for name, note in NOTES.items():
            setattr(self, name, _noting(getattr(self, name), note, found))

    RendererAgg.__init__ = started  # type: ignore[method-assign]
    try:
        yield found
    finally:
        RendererAgg.__init__ = begin  # type: ignore[method-assign]


def lines(strokes: list[Stroke]) -> Iterator[str]:
    """A line for each way of looking, in the order in which they first appear."""
    looks: dict[str, list[np.ndarray[Any, Any]]] = {}
    for look, corners in strokes:
        looks.setdefault(look, []).append(corners)
    for look, group in looks.items():
        places = np.concatenate(group)
        if len(places) == 1:
            yield f"{look} at [{places[0, 0]:.1f}, {places[0, 1]:.1f}]"
        elif len(places):
            numbers = [*places.min(axis=0), *places.max(axis=0), *places.mean(axis=0)]
            yield f"{look}: {len(group)}, {len(places)} corners [{', '.join(f'{one:.2f}' for one in numbers)}]"


def _noting(draw: Callable[..., Any], note: Callable[..., Stroke], found: list[Stroke]) -> Callable[..., Any]:
    def drawn(*given: Any, **named: Any) -> Any:
        found.append(note(*given, **named))
        return draw(*given, **named)

    return drawn


def _hex(colour: Any) -> str:
    return to_hex(colour, keep_alpha=True).removeprefix("#").removesuffix("ff")


def _look(context: Any, face: Any = None) -> str:
    filled = "" if face is None or not len(face) else f" filled {_hex(face)}"
    dashes = context.get_dashes()[1]
    dashed = "" if dashes is None else " dashed"
    width = context.get_linewidth()
    stroked = f" {width:.3g} {_hex(context.get_rgb())}{dashed}" if width > 0.0 else ""
    return f"{filled}{stroked}".strip() or "nothing"


def _corners(path: Outline, transform: Any = None) -> np.ndarray[Any, Any]:
    places = path.vertices if transform is None else transform.transform(path.vertices)
    return places[np.isfinite(places).all(axis=1)]


def _path(context: Any, path: Outline, transform: Any, face: Any = None) -> Stroke:
    return _look(context, face), _corners(path, transform)


def _markers(context: Any, _marker: Outline, _place: Any, path: Outline, transform: Any, face: Any = None) -> Stroke:
    return f"marks {_look(context, face)}", _corners(path, transform)


def _collection(
    _context: Any,
    master: Any,
    paths: Any,
    transforms: Any,
    offsets: Any,
    shift: Any,
    faces: Any,
    edges: Any,
    *_: Any,
    **__: Any,
) -> Stroke:
    colours = sorted({_hex(one) for group in (faces, edges) for one in np.asarray(group).reshape(-1, 4)})
    outlines = [np.asarray(master.frozen().transform(path.vertices)) for path in paths]
    corners = np.concatenate([*outlines, np.asarray(shift.transform(offsets)).reshape(-1, 2)])
    return f"collection {' '.join(colours)}", corners[np.isfinite(corners).all(axis=1)]


def _text(context: Any, x: float, y: float, words: str, font: Any, angle: float, *_: Any, **__: Any) -> Stroke:
    turned = f" turned by {angle:.0f}°" if angle else ""
    return f'"{words}" {font.get_size_in_points():.3g} pt {_hex(context.get_rgb())}{turned}', np.array([[x, y]], dtype=float)


def _image(_context: Any, x: float, y: float, pixels: Any, *_: Any) -> Stroke:
    height, width = pixels.shape[:2]
    return f"image, mean {np.asarray(pixels)[..., :3].mean():.0f}", np.array([[x, y], [x + width, y + height]], dtype=float)


NOTES: dict[str, Callable[..., Stroke]] = {
    "draw_path": _path,
    "draw_markers": _markers,
    "draw_path_collection": _collection,
    "draw_text": _text,
    "draw_image": _image,
}
