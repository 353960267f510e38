"""What does one frame show?

The background (fixed bodies, title, scale, names) is drawn once; then one patch per part is moved by its transform and
the changing numbers are copied in. Frames do not depend on one another.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

from watchsim.render.frame.coloured_edges import Edges
from watchsim.render.frame.filled_parts import loops_of
from watchsim.render.frame.lasting_patch import LastingPatch
from watchsim.render.frame.marks.extras import NOTHING, Extras
from watchsim.render.frame.marks.mechanism_extras import Beside
from watchsim.render.frame.marks.readouts import Clock
from watchsim.render.frame.marks.word_layout import draw_key, draw_notes, draw_rules, draw_scale, lay_out, relative_size
from watchsim.render.frame.mechanism_patches import Mechanism
from watchsim.render.frame.pose_history import Window
from watchsim.render.frame.view import view
from watchsim.render.picture_style import LIGHT, Style
from watchsim.simulation.record.trajectory import Trajectory

Array = NDArray[np.float64]
Pixels = NDArray[np.uint8]

DPI = 72.0  # one point is one pixel


class Stage:
    """Draws a run at any instant of a window, always in the same frame.

    `size` is (width, height) in pixels; `speed` and `step` (s between frames) are only told, not used. `picked` edges are
    drawn over everything, with a key below the title. With `extras` the mechanism leaves room for them.
    `clock` reports something other than the time of the run, `style` is light or dark.
    """

    def __init__(  # noqa: PLR0913 - options, by name
        self,
        run: Trajectory,
        size: tuple[int, int],
        window: Window,
        *,
        zoom: Sequence[str] | None = None,
        turn: float | None = None,
        speed: float | None = None,
        step: float | None = None,
        picked: Sequence[Edges] = (),
        extras: Extras = NOTHING,
        clock: Clock | None = None,
        style: Style = LIGHT,
    ) -> None:
        self._style = style
        self._figure = Figure(figsize=((size[0] + 0.5) / DPI, (size[1] + 0.5) / DPI), dpi=DPI, facecolor=style.background)
        self._canvas = FigureCanvasAgg(self._figure)
        self._unit = relative_size(*size)
        self._layout = lay_out(self._figure, run, window, step or (window[1] - window[0]) / 2000.0, style)
        if clock is not None:
            self._layout = replace(self._layout, clock=clock)
        size_of_text = self._layout.small.size
        self._beside = Beside(self._figure, run, window, extras, self._layout.frame, size_of_text, self._unit, style)
        room = self._beside.room
        self.view = view(run, window, room, zoom, turn)
        self._beside.look_at(self.view)
        draw_scale(self._figure, self.view.scale, style)
        draw_notes(self._figure, self._layout.frame, speed, self.view.turn, style)
        endless = any(not loop.closed for body in run.scene.bodies for loop in loops_of(body))
        if zoom is not None or endless or self.view.follow is not None:
            draw_rules(self._figure, room, style)
        self._mechanism = Mechanism(self._figure, run.scene, self.view, room, self._unit, style, picked)
        draw_key(self._figure, [(edges.colour, edges.meaning) for edges in picked], style)
        self._canvas.draw()
        self._background = self._canvas.copy_from_bbox(self._figure.bbox)

    def draw(
        self,
        t: float,
        frames: dict[str, Array],
        contacts: Array | None = None,
        mark: str | None = None,
        press: tuple[Array, Array] | None = None,
        speed: float | None = None,
    ) -> Pixels:
        """The picture (height, width, 4) of the instant `t`; the next call overwrites it.

        `frames` gives every body's pose x, y, angle; `contacts` (n, 2) points to mark, in metres, in the colour `mark`
        (default: that of contacts); `press` points (n, 2), m, and the forces there (n, 2), N; `speed` is told where it
        changes from frame to frame.
        """
        self._canvas.restore_region(self._background)
        renderer = self._canvas.get_renderer()
        matrix = self.view.matrix(self.view.centre_at(frames))
        self._mechanism.draw(renderer, frames, matrix)

        def touching(matrix: Array) -> list[LastingPatch]:
            made: list[LastingPatch] = []
            if contacts is not None and len(contacts) > 0:
                made = self._mechanism.rings(contacts @ matrix[:2, :2].T + matrix[:2, 2], mark or self._style.contact)
            return made if press is None else made + self._beside.arrows(matrix, *press)

        for patch in touching(matrix):
            self._mechanism.own(patch).draw(renderer)
        pixels = np.asarray(self._canvas.buffer_rgba())
        self._beside.draw(renderer, t, frames, matrix, touching, pixels)
        if speed is not None:
            self._beside.tell_speed(speed, self._layout.frame, pixels)
        self._layout.write(t, frames, pixels)
        return pixels
