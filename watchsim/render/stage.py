"""What does one frame show: the mechanism, and what is asked for beside it?

The background (fixed bodies, title, scale, names) is drawn once; then one patch per part is moved by its transform and the
changing numbers are copied in. Frames do not depend on one another.
"""

from __future__ import annotations

import os
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.transforms import IdentityTransform

from watchsim.analysis.phases import Phase
from watchsim.geometry.primitives import Point
from watchsim.mechanism.check import ModelledPairs
from watchsim.mechanism.compile import Compiled
from watchsim.render.insets import Inset, InsetPicture, Marks, Strip, beside, insets
from watchsim.render.marks import Clock, arrow_path, changing_speed_text, turn_text
from watchsim.render.opening import Sight, sight
from watchsim.render.palette import DARK, FAULT, LIGHT, Style
from watchsim.render.part_names import COLUMN, Label, Labels, PartName
from watchsim.render.parts import Edges, LastingPatch, loops_of
from watchsim.render.patches import Mechanism
from watchsim.render.view import Frame, Pixels, Window, poses, seen
from watchsim.render.words import Layout, Words, draw_key, draw_notes, draw_rules, draw_scale, lay_out, relative_size
from watchsim.scene.scene import Scene
from watchsim.simulation.state import EVENT_DTYPE, Stop
from watchsim.simulation.trajectory import Array, Trajectory
from watchsim.storage.write import write_file
from watchsim.units import metric


@dataclass(frozen=True)
class Extras:
    """insets   places to enlarge (see `insets`)
    strip    the body whose angle and velocity run below the mechanism; None: no strip
    phases   of the beats, in order: named, and shaded in the strip
    force    N: the force that the longest arrow stands for; 0: no arrows
    scale    N: a round force, for the key of the arrows
    names    on the parts
    ordered  instants (s) for which the lines of the names are kept short
    """

    insets: tuple[str, ...] = ()
    strip: str | None = None
    phases: tuple[Phase, ...] = ()
    force: float = 0.0
    scale: float = 0.0
    names: tuple[PartName, ...] = ()
    ordered: tuple[float, ...] = ()

    def phase_at(self, t: float) -> str:
        """The name of the phase at `t` (s); empty where none is known."""
        k = bisect_right(self.phases, t, key=lambda phase: phase.start) - 1
        return self.phases[k].name if k >= 0 and t < self.phases[k].end else ""


STRIP_WIDE, STRIP_TALL = 0.27, 0.2  # share of a wide and of a tall picture's height that the strip takes
ARROW = 0.15  # of the smaller side of the room: the longest arrow
LEAST = 60.0  # pixels of height that must be left for the mechanism
PAD = 24.0  # pixels at 1280 × 720


@dataclass(frozen=True)
class Rooms:
    """Who has which room of a picture, pixels: names and the mechanism between them, the strip below, the insets."""

    sight: Sight
    names: Frame
    strip: Frame | None
    insets: tuple[Frame, ...]


def rooms(
    run: Trajectory,
    window: Window,
    layout: Layout,
    extras: Extras,
    height: float,
    zoom: Sequence[str] | None,
    turn: float | None,
) -> Rooms:
    """Divide the frame between the bands of words of a picture of that height."""
    room, below, size = layout.frame, None, layout.small.size
    if extras.strip is not None:
        taken = (STRIP_WIDE if room.width >= room.height else STRIP_TALL) * height
        below = Frame(room.left, room.bottom, room.width, taken)
        room = Frame(room.left, room.bottom + taken, room.width, room.height - taken)
        if room.height < LEAST:
            raise ValueError("no room is left for the mechanism above its strip; choose a larger picture, or no strip")
    room, boxes = beside(room, len(extras.insets))
    column = COLUMN * size if extras.names else 0.0
    if room.width < 2.0 * column + LEAST:
        raise ValueError("no room is left for the mechanism between its names; choose a larger picture, or no names")
    found = sight(run, window, room, zoom, turn, relative_size(layout.frame.width, height), column)
    around = found.room
    return Rooms(found, Frame(around.left - column, around.bottom, around.width + 2.0 * column, around.height), below, boxes)


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
        layout: Layout,
        shared: Rooms,
        unit: float,
        style: Style,
    ) -> None:
        size, room = layout.small.size, shared.sight.room
        self._style = style
        self._figure, self._run, self._window, self._extras, self._unit = figure, run, window, extras, unit
        self._words, self._faint = Words(size, style.ink, style.background), Words(size, style.faint, style.background)
        self._bold = Words(size, style.ink, style.background, "bold")
        self._frame, self._room, self._turn, self._strip = layout.frame, room, shared.sight.view.turn, None
        if shared.strip is not None and extras.strip is not None:
            self._strip = Strip(run, window, shared.strip, extras.strip, extras.phases, size, style)
        self._longest = ARROW * min(room.width, room.height)
        places = insets(run, window, extras.insets, shared.insets, self._turn)
        self._insets = [InsetPicture(figure, run.scene, one, unit, self._words, style) for one in places]
        self._whole = self._whole_of(shared.sight)
        self._labels = self._labels_in(shared) if extras.names else None

    def _whole_of(self, seen: Sight) -> InsetPicture | None:
        """The whole mechanism, small, where the picture shows a part of it."""
        if seen.whole is None or seen.box is None:
            return None
        return InsetPicture(
            self._figure, self._run.scene, Inset("", seen.box, seen.whole), self._unit, self._words, self._style
        )

    def _labels_in(self, shared: Rooms) -> Labels:
        names, view = self._extras.names, shared.sight.view
        ways = []
        for t in self._extras.ordered:
            frames = {name: rows[0] for name, rows in poses(self._run, np.array([t])).items()}
            matrix = view.matrix(view.centre_at(frames))
            ways.append([name.seen(frames, matrix) for name in names])
        return Labels(names, shared.names, self._words, np.array(ways).reshape(-1, len(names), 2))

    def labels(self, frames: dict[str, Array], matrix: Array) -> list[Label]:
        """The names on the parts, for the poses of an instant, in a picture with this map."""
        return self._labels.at(frames, matrix) if self._labels is not None else []

    def arrows(self, matrix: Array, points: Array, forces: Array) -> list[LastingPatch]:
        """Arrows for forces (n, 2), N, at points (n, 2), m, in a picture with this map."""
        if not len(points) or self._extras.force <= 0.0:
            return []
        turn = matrix[:2, :2] / np.hypot(*matrix[:2, 0])
        ways = forces @ turn.T * (self._longest / self._extras.force)
        path = arrow_path(seen(points, matrix), ways, self._longest)
        return [] if path is None else [self._arrow(path)]

    def draw(self, renderer: Any, t: float, frames: dict[str, Array], matrix: Array, marks: Marks, out_pixels: Pixels) -> None:
        """Draw everything for the poses of the instant `t`, in a picture whose map from metres is `matrix`."""
        if self._labels is not None:
            labels = self.labels(frames, matrix)
            for patch in self._labels.lines(labels, self._style, self._unit):
                patch.drawn_on(self._figure, self._frame.box).draw(renderer)
            self._labels.write(labels, out_pixels)
        for picture in self._insets:
            picture.place_in(matrix, frames, self._room).draw(renderer)
        for picture in self._insets:
            picture.draw(renderer, frames, marks, out_pixels)
        if self._whole is not None:
            self._whole.draw(renderer, frames, lambda _: [], out_pixels)
            self._whole.outline_of(self._room, matrix, frames).draw(renderer)
        self._draw_key(renderer, out_pixels)
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

    def write_speed(self, speed: float, frame: Frame, out_pixels: Pixels) -> None:
        """Write the speed of this frame where a steady one would stand."""
        turned = turn_text(self._turn)
        text = changing_speed_text(speed) + (f", {turned}" if turned else "")
        right, base = frame.left + frame.width - PAD * self._unit, frame.bottom + frame.height + 0.3 * self._faint.size
        self._faint.write(text, right, base, out_pixels, right=True)

    def _draw_key(self, renderer: Any, out_pixels: Pixels) -> None:
        """An arrow of a round force with its size, at the lower left of the mechanism."""
        if self._extras.scale <= 0.0:
            return
        size, left, base = self._words.size, self._room.left + PAD * self._unit, self._room.bottom + 0.9 * self._words.size
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


DPI = 72.0  # one point is one pixel


class Stage:
    """Draws a run at any instant of a window, always in the same frame.

    `size` is (width, height) in pixels; `speed` and `step` (s between frames) are only shown, not used. `picked` edges are
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
        extras: Extras = Extras(),
        clock: Clock | None = None,
        style: Style = LIGHT,
    ) -> None:
        self._style = style
        self._figure = Figure(figsize=((size[0] + 0.5) / DPI, (size[1] + 0.5) / DPI), dpi=DPI, facecolor=style.background)
        self._canvas = FigureCanvasAgg(self._figure)
        self._unit = relative_size(*size)
        layout = lay_out(self._figure, run, window, step or (window[1] - window[0]) / 2000.0, style)
        self._layout = layout if clock is None else replace(layout, clock=clock)
        shared = rooms(run, window, layout, extras, self._figure.bbox.height, zoom, turn)
        self._beside = Beside(self._figure, run, window, extras, layout, shared, self._unit, style)
        self.view = shared.sight.view
        draw_scale(self._figure, self.view.scale, style)
        draw_notes(self._figure, self._layout.frame, speed, self.view.turn, style)
        endless = any(not loop.closed for body in run.scene.bodies for loop in loops_of(body))
        if zoom is not None or endless or self.view.follow is not None or shared.sight.whole is not None:
            draw_rules(self._figure, shared.names, style)
        self._mechanism = Mechanism(self._figure, run.scene, self.view, shared.names, self._unit, style, picked)
        draw_key(self._figure, [(edges.colour, edges.meaning) for edges in picked], style)
        self._canvas.draw()
        self._background = self._canvas.copy_from_bbox(self._figure.bbox)

    def labels(self, frames: dict[str, Array]) -> list[Label]:
        """The names on the parts as `draw` writes them for these poses; none without `Extras.names`."""
        return self._beside.labels(frames, self.view.matrix(self.view.centre_at(frames)))

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
        (default: that of contacts); `press` points (n, 2), m, and the forces there (n, 2), N; `speed` is given where it
        changes from frame to frame.
        """
        self._canvas.restore_region(self._background)
        renderer = self._canvas.get_renderer()
        matrix = self.view.matrix(self.view.centre_at(frames))
        self._mechanism.draw(renderer, frames, matrix)

        def touching(matrix: Array) -> list[LastingPatch]:
            made: list[LastingPatch] = []
            if contacts is not None and len(contacts) > 0:
                made = self._mechanism.rings(seen(contacts, matrix), mark or self._style.contact)
            return made if press is None else made + self._beside.arrows(matrix, *press)

        for patch in touching(matrix):
            self._mechanism.own(patch).draw(renderer)
        pixels = np.asarray(self._canvas.buffer_rgba())
        self._beside.draw(renderer, t, frames, matrix, touching, pixels)
        if speed is not None:
            self._beside.write_speed(speed, self._layout.frame, pixels)
        self._layout.write(t, frames, pixels)
        return pixels


STILL_SIZE = (1280, 720)
REACHABLE, CANDIDATE = "#1971c2", "#f76707"
REACHABLE_DARK = "#74c0fc"


def still(
    scene: Scene,
    path: str | os.PathLike[str],
    compiled: Compiled,
    pairs: ModelledPairs,
    overlaps: Sequence[Point] = (),
    dark: bool = False,
) -> None:
    """Write a picture (PNG or what else imageio knows) of the bodies where the scene puts them at t = 0.

    Edges that can ever touch another body are in colour, those of which a pair is a candidate at the start in another; rings
    mark the places (m) where bodies overlap. `dark`: with a dark background.
    """
    import imageio.v3 as imageio

    model = compiled.model
    picked: tuple[Edges, ...] = (
        Edges(model, np.setdiff1d(pairs.reachable, pairs.candidates), REACHABLE_DARK if dark else REACHABLE, "can ever touch"),
        Edges(model, pairs.candidates, CANDIDATE, "candidate at the start"),
    )
    if overlaps:
        picked = (*picked, Edges(model, np.zeros(0, np.int64), FAULT, "bodies overlap"))
    run = at_rest(scene, compiled)
    stage = Stage(run, STILL_SIZE, (0.0, 1.0), picked=picked, style=DARK if dark else LIGHT)
    frames = {name: rows[0] for name, rows in poses(run, np.zeros(1)).items()}
    pixels = stage.draw(0.0, frames, np.array(overlaps).reshape(-1, 2), FAULT)[..., :3]
    write_file(Path(path), lambda scratch: imageio.imwrite(scratch, pixels), "the picture")


def at_rest(scene: Scene, compiled: Compiled) -> Trajectory:
    """A run in which nothing moves."""
    q = compiled.relative(np.stack([compiled.q, compiled.q]))
    rest, no_events = np.zeros_like(q), np.zeros(0, EVENT_DTYPE)
    return Trajectory(scene, np.array([0.0, 1.0]), q, rest, rest, compiled.slices, no_events, (), Stop.DURATION)
