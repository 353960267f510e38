"""How large is a picture, and of which format: as asked, or as the mechanism is shaped?"""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.figure import Figure

from watchsim.render.frame.marks.extras import Extras
from watchsim.render.frame.marks.mechanism_extras import shared_room
from watchsim.render.frame.marks.word_layout import lay_out
from watchsim.render.frame.pose_history import Window
from watchsim.render.frame.stage import DPI
from watchsim.render.frame.view import view
from watchsim.render.picture_style import LIGHT
from watchsim.simulation.record.trajectory import Trajectory

AUTO = "auto"  # a size
MP4_SIZE, GIF_SIZE = (1280, 720), (800, 450)
FORMATS = ((1280, 720), (960, 960), (860, 1076), (720, 1280))  # wide, square, 4 : 5, tall; about as many pixels in all
FORMATS_GIF = ((800, 450), (600, 600), (536, 670), (450, 800))
SIZES = (64, 8192)  # pixels a side
GAIN = 1.05  # by which a less usual format must enlarge the mechanism

Size = tuple[int, int]


def fitting(
    run: Trajectory, window: Window, extras: Extras, zoom: Sequence[str] | None, gif: bool, turn: float | None
) -> tuple[Size, float | None]:
    """The format in which the mechanism is largest, and the turn (rad) to draw it with: as asked, else as it is drawn."""
    if turn is None and not any(run.scene.gravity):
        turn = 0.0
    best, largest = (GIF_SIZE if gif else MP4_SIZE), 0.0
    for size in FORMATS_GIF if gif else FORMATS:
        figure = Figure(figsize=((size[0] + 0.5) / DPI, (size[1] + 0.5) / DPI), dpi=DPI)
        frame = lay_out(figure, run, window, (window[1] - window[0]) / 2000.0, LIGHT).frame
        seen = view(run, window, shared_room(frame, extras, size[1]).room, zoom, turn)
        if seen.follow is not None:
            return best, None
        if seen.scale > GAIN * largest:
            best, largest = size, seen.scale
    return best, turn


def checked(size: Size) -> Size:
    """The size, if a picture can have it; ValueError else."""
    try:
        width, height = (int(side) for side in size)
    except (TypeError, ValueError):
        raise ValueError(f'size = {size!r}: give (width, height) in pixels, or "{AUTO}"') from None
    if not all(SIZES[0] <= side <= SIZES[1] for side in (width, height)):
        raise ValueError(f"size = {width}x{height}: each side must be {SIZES[0]} to {SIZES[1]} pixels")
    return width, height


def even_sides(size: Size) -> Size:
    """The colour planes of an MP4 have half the size, so its sides must be even."""
    width, height = checked(size)
    return width + width % 2, height + height % 2
