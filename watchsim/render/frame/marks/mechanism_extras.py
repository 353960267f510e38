"""How does what a picture shows besides the mechanism share the room with it, and how is it drawn?"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.transforms import IdentityTransform
from numpy.typing import NDArray

from watchsim.render.frame.lasting_patch import LastingPatch
from watchsim.render.frame.marks.changing_words import Words
from watchsim.render.frame.marks.extras import ARROW, STRIP_TALL, STRIP_WIDE, Extras
from watchsim.render.frame.marks.force_arrows import arrow_path
from watchsim.render.frame.marks.inset_pictures import InsetPicture
from watchsim.render.frame.marks.insets import Inset, beside, insets
from watchsim.render.frame.marks.readouts import changing_speed_text, turn_text
from watchsim.render.frame.marks.strip import Strip
from watchsim.render.frame.pose_history import Window
from watchsim.render.frame.view import Frame, View
from watchsim.render.picture_style import Style
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.units import metric

Array = NDArray[np.float64]
Pixels = NDArray[np.uint8]

LEAST = 60.0  # pixels of height that must be left for the mechanism
PAD = 24.0  # pixels at 1280 × 720


@dataclass(frozen=True)
class Shared:
    """Who has which room (pixels): the mechanism, the strip below it, the insets."""

    room: Frame
    strip: Frame | None
    insets: tuple[Frame, ...]


def shared_room(frame: Frame, extras: Extras, height: float) -> Shared:
    """How the frame between the bands of words of a picture of that height is shared out."""
    room, below = frame, None
    if extras.strip is not None:
        taken = (STRIP_WIDE if frame.width >= frame.height else STRIP_TALL) * height
        below = Frame(frame.left, frame.bottom, frame.width, taken)
        room = Frame(frame.left, frame.bottom + taken, frame.width, frame.height - taken)
        if room.height < LEAST:
            raise ValueError("no room is left for the mechanism above its strip; choose a larger picture, or no strip")
    room, boxes = beside(room, len(extras.insets))
    return Shared(room, below, boxes)


class Beside:
    """Insets, strip, arrows and phase names of a figure.

    `frame` is the room between the bands of words, `size` that of text, `unit` that of everything drawn.
    """

    def __init__(
        self,
        figure: Figure,
        run: Trajectory,
        window: Window,
        extras: Extras,
        frame: Frame,
        size: float,
        unit: float,
        style: Style,
    ) -> None:
        self._style = style
        self._figure, self._run, self._window, self._extras, self._unit = figure, run, window, extras, unit
        self._words, self._faint = Words(size, style.ink, style.background), Words(size, style.faint, style.background)
        self._bold = Words(size, style.ink, style.background, "bold")
        self._frame, self._strip, self._turn = frame, None, 0.0
        shared = shared_room(frame, extras, figure.bbox.height)
        if shared.strip is not None and extras.strip is not None:
            self._strip = Strip(run, window, shared.strip, extras.strip, extras.phases, size, style)
        self.room, self._boxes = shared.room, shared.insets
        self._longest = ARROW * min(self.room.width, self.room.height)
        self._insets: list[InsetPicture] = []
        self._made: list[Inset] = []

    def look_at(self, view: View) -> None:
        """Prepare the insets, which stand the same way up as the picture's own view."""
        self._turn = view.turn
        self._made = insets(self._run, self._window, self._extras.insets, self._boxes, view.turn)
        self._insets = [
            InsetPicture(self._figure, self._run.scene, one, self._unit, self._words, self._style) for one in self._made
        ]

    def arrows(self, matrix: Array, points: Array, forces: Array) -> list[LastingPatch]:
        """Arrows for forces (n, 2), N, at points (n, 2), m, in a picture with this map."""
        if not len(points) or self._extras.force <= 0.0:
            return []
        turn = matrix[:2, :2] / np.hypot(*matrix[:2, 0])
        ways = forces @ turn.T * (self._longest / self._extras.force)
        path = arrow_path(points @ matrix[:2, :2].T + matrix[:2, 2], ways, self._longest)
        return [] if path is None else [self._arrow(path)]

    def draw(
        self,
        renderer: Any,
        t: float,
        frames: dict[str, Array],
        matrix: Array,
        marks: Callable[[Array], list[LastingPatch]],
        out_pixels: Pixels,
    ) -> None:
        """Draw everything for the poses of the instant `t`, in a picture whose map from metres is `matrix`."""
        for picture, one in zip(self._insets, self._made, strict=True):
            picture.place_in(matrix, one.centre(frames), self.room).draw(renderer)
        for picture in self._insets:
            picture.draw(renderer, frames, marks, out_pixels)
        self._key(renderer, out_pixels)
        if self._extras.phases:
            self._name_phase(self._extras.phase_at(t), out_pixels)
        if self._strip is not None:
            self._strip.draw(t, out_pixels)

    def _name_phase(self, name: str, out_pixels: Pixels) -> None:
        """The name, after a chip of the colour that shades the phase in the strip."""
        size, left = self._bold.size, round(PAD * self._unit)
        base = round(self._frame.bottom + self._frame.height + 0.3 * size)
        if name in self._style.phases:
            foot = out_pixels.shape[0] - base
            chip = slice(foot - round(0.75 * size), foot + 1), slice(left, left + round(0.8 * size))
            out_pixels[chip][..., :3] = np.round(255.0 * np.array(to_rgb(self._style.phases[name])))
            left += round(1.3 * size)
        self._bold.write(name, left, base, out_pixels)

    def tell_speed(self, speed: float, frame: Frame, out_pixels: Pixels) -> None:
        """Write the speed of this frame where a steady one would stand."""
        turned = turn_text(self._turn)
        text = changing_speed_text(speed) + (f", {turned}" if turned else "")
        right, base = frame.left + frame.width - PAD * self._unit, frame.bottom + frame.height + 0.3 * self._faint.size
        self._faint.write(text, right, base, out_pixels, right=True)

    def _key(self, renderer: Any, out_pixels: Pixels) -> None:
        """An arrow of a round force with its size, at the lower left of the mechanism."""
        if self._extras.scale <= 0.0:
            return
        size, left, base = self._words.size, PAD * self._unit, self.room.bottom + 0.9 * self._words.size
        length = self._extras.scale / self._extras.force * self._longest
        path = arrow_path(np.array([[left, base + 0.35 * size]]), np.array([[length, 0.0]]), self._longest)
        if path is not None:
            self._arrow(path).draw(renderer)
        self._words.write(metric(self._extras.scale, "N", 1), left + length + 0.6 * size, base, out_pixels)

    def _arrow(self, path: Any) -> LastingPatch:
        look = {"facecolor": self._style.force, "edgecolor": self._style.background, "linewidth": max(0.9 * self._unit, 0.6)}
        patch = LastingPatch(path, transform=IdentityTransform(), **look)
        patch.set_figure(self._figure)
        return patch
