"""How does a strip below the mechanism show a body's angle and velocity, with a cursor at the instant shown?

What a page of the strip holds never changes: it is drawn once, and the cursor is copied in. A window of many swings has several
pages, one after the other.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from matplotlib.path import Path
from matplotlib.transforms import Affine2D, IdentityTransform

from watchsim.analysis.phases import Phase
from watchsim.geometry.loops import Loop
from watchsim.render.marks import SIDES, PalletStones, clock, spaced
from watchsim.render.palette import Style, looks
from watchsim.render.parts import LastingPatch, Part, loops_of, outline, parts, pose_matrix
from watchsim.render.patches import CoilPatches
from watchsim.render.view import COARSE, Frame, Pixels, View, Window, choose, dense, fitted, placed, seen, swept
from watchsim.render.words import Words
from watchsim.scene.keys import closest
from watchsim.scene.roles import PALLETS, pallet_word, roles
from watchsim.scene.scene import Body, Scene
from watchsim.simulation.trajectory import Array, Trajectory

# A place is given as a body ("lever"), one of its layers ("lever.STONES"), one outline of a layer ("lever.STONES.2", counted in
# the order of the drawing), the "entry stone" or "exit stone" of an escapement, or a rectangle of the movement in millimetres
# ("-1.4, 1.9 : -0.8, 2.5"). What stays about where it is is shown in place; what goes far is followed.

AIR = 0.12  # of an inset, around what it shows
STAYS = 2.5  # what sweeps more than so many times its size is followed
FOLLOWED = 1.0  # of its diagonal is in sight on every side of its middle: enough of what it meets
MOST_INSETS = 6  # insets
ACROSS, DOWN = 0.37, 0.3  # share of a wide picture's width and of a tall one's height that insets take
GAP = 0.012  # of the longer side


@dataclass(frozen=True)
class Inset:
    """A place in its box (pixels): `view` of it, and where it is followed the body and the point of it (m) in the middle."""

    name: str
    box: Frame
    view: View
    body: str | None = None
    point: tuple[float, float] = (0.0, 0.0)

    def matrix(self, frames: dict[str, Array]) -> Array:
        """The 3 × 3 map from metres to pixels for the poses x, y, angle of one instant."""
        return self.view.matrix(self.centre(frames))

    def centre(self, frames: dict[str, Array]) -> tuple[float, float]:
        """The point of the movement (m) in the middle of the box."""
        if self.body is None:
            return self.view.centre
        x, y = placed(np.array([self.point]), frames[self.body][None])[0, 0].tolist()
        return x, y


def beside(frame: Frame, count: int) -> tuple[Frame, tuple[Frame, ...]]:
    """Room for the mechanism and boxes for `count` insets: to the right in a wide frame, above in a tall one."""
    if count == 0:
        return frame, ()
    if count > MOST_INSETS:
        raise ValueError(f"insets: {count} are too many to be read; show at most {MOST_INSETS}")
    wide, gap = frame.width >= frame.height, GAP * max(frame.width, frame.height)
    across, down = (ACROSS * frame.width, frame.height) if wide else (frame.width, DOWN * frame.height)
    left, top = frame.left + frame.width - across, frame.bottom + frame.height
    columns = max(range(1, count + 1), key=lambda n: (min((across - gap) / n, (down - gap) / -(-count // n)), -n))
    width, height = (across - gap) / columns, (down - gap) / -(-count // columns)
    boxes = tuple(
        Frame(left + gap + k % columns * width, top - gap - (k // columns + 1) * height + gap, width - gap, height - gap)
        for k in range(count)
    )
    if wide:
        return Frame(frame.left, frame.bottom, frame.width - across, frame.height), boxes
    return Frame(frame.left, frame.bottom, frame.width, frame.height - down), boxes


def insets(run: Trajectory, window: Window, places: Sequence[str], boxes: Sequence[Frame], turn: float) -> list[Inset]:
    """An inset for each place and box, the same way up as the picture. ValueError where there is no such place."""
    stones = PalletStones(run.scene)
    return [_inset(run, window, place, box, turn, stones) for place, box in zip(places, boxes, strict=True)]


def _inset(run: Trajectory, window: Window, place: str, box: Frame, turn: float, stones: PalletStones) -> Inset:
    if (corners := _rectangle_of(place)) is not None:
        return Inset(place.strip(), box, fitted(corners, box, turn, AIR))
    body, loops = _outlines(run, place, stones)
    points = outline(loops, math.inf)
    points = outline(loops, COARSE * max(float(np.ptp(points, axis=0).max()), 1e-12))
    frames = swept(run, body, window)
    room = placed(points, frames).reshape(-1, 2)
    low, high = points.min(axis=0), points.max(axis=0)
    if float(np.ptp(room, axis=0).max()) <= STAYS * float((high - low).max()):
        return Inset(place, box, fitted(room, box, turn, AIR))
    middle, half = 0.5 * (low + high), FOLLOWED * float(np.hypot(*(high - low)))
    around = placed(middle[None], frames[:1])[0] + np.array([(-half, -half), (half, half)])
    return Inset(place, box, fitted(around, box, turn, AIR), body.name, (float(middle[0]), float(middle[1])))


def _rectangle_of(place: str) -> Array | None:
    """(4, 2) corners (m) of a place such as "-1.4, 1.9 : -0.8, 2.5"; None where it names something."""
    if ":" not in place:
        return None
    try:
        (x0, y0), (x1, y1) = ((float(number) for number in corner.split(",")) for corner in place.split(":"))
    except ValueError:
        raise ValueError(f'inset "{place}": a rectangle is two corners in mm, such as "-1.4, 1.9 : -0.8, 2.5"') from None
    if not all(map(math.isfinite, (x0, y0, x1, y1))) or x0 == x1 or y0 == y1:
        raise ValueError(f'inset "{place}": the rectangle is empty')
    return 1e-3 * np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def _outlines(run: Trajectory, place: str, stones: PalletStones) -> tuple[Body, Sequence[Loop]]:
    side, _, kind = place.partition(" ")
    if side in SIDES and kind in PALLETS and all(body.name != place for body in run.scene.bodies):
        try:
            lever, loop = stones.stone(side)
        except ValueError as error:
            raise ValueError(f'inset "{place}": {error}') from None
        return lever, [loop]
    name, _, rest = place.partition(".")
    drawn = {body.name: body for body in run.scene.bodies if loops_of(body)}
    if name not in drawn:
        pallets = (f"{side} {pallet_word(run.scene)}" for side in SIDES)
        near = f'; did you mean "{meant}"?' if (meant := closest(place, [*drawn, *pallets])) else ""
        raise ValueError(f'inset "{place}": bodies with a drawing are {", ".join(drawn)}{near}')
    body = drawn[name]
    loops = loops_of(body)
    if not rest:
        return body, body.loops or loops
    layers = list(dict.fromkeys(loop.layer for loop in loops))
    layer, number = (rest, "") if rest in layers else rest.rpartition(".")[::2]
    if layer not in layers:
        raise ValueError(f'inset "{place}": layers of {name} are {", ".join(layers)}')
    own = [loop for loop in loops if loop.layer == layer]
    if not number:
        return body, own
    if not number.isascii() or not number.isdigit() or not 1 <= int(number) <= len(own):
        raise ValueError(f'inset "{place}": outlines of {name}.{layer} are counted from 1 to {len(own)}')
    return body, [own[int(number) - 1]]


# Every inset has shapes of its own, fine enough for its scale; those out of its sight at an instant are passed over.

Marks = Callable[[Array], list[LastingPatch]]  # what is drawn at contacts, for a map from metres to pixels

CHORD = 0.05  # pixels that a chord may stray from its arc
HATCH = 13.0  # pixels between hatch strokes


@dataclass(frozen=True)
class _Shape:
    body: str
    patches: tuple[LastingPatch, ...]
    middle: Array  # m, in the body's frame
    reach: float


class InsetPicture:
    """One inset of a figure; `unit` is the size of everything drawn, `words` write its name."""

    def __init__(self, figure: Figure, scene: Scene, inset: Inset, unit: float, words: Words, style: Style) -> None:
        self._figure, self._inset, self._words, self._style = figure, inset, words, style
        self._springs = CoilPatches(scene, inset.box, inset.view.scale, style, unit, self._own)
        self._thin = max(1.1 * unit, 0.6)
        self._transforms = {body.name: Affine2D() for body in scene.bodies}
        made = parts(scene, CHORD / inset.view.scale, HATCH * unit / inset.view.scale)
        self._shapes = [self._shape(part) for part in made]
        box, place = inset.box, IdentityTransform()
        frame = _rectangle((box.left, box.bottom), (box.left + box.width, box.bottom + box.height))
        self._sheet = LastingPatch(frame, facecolor=style.background, linewidth=0.0, transform=place)
        look = {"fill": False, "edgecolor": style.faint, "linewidth": max(1.4 * unit, 1.0)}
        self._border = LastingPatch(frame, transform=place, **look)
        for patch in (self._sheet, self._border):
            patch.set_figure(figure)

    def place_in(self, matrix: Array, frames: dict[str, Array], room: Frame) -> LastingPatch:
        """The rectangle of the picture (its map `matrix`) that the inset enlarges."""
        half = 0.5 * np.array([self._inset.box.width, self._inset.box.height]) / self._inset.view.scale
        scale = float(np.hypot(*matrix[:2, 0]))
        middle = matrix[:2, :2] @ np.array(self._inset.centre(frames)) + matrix[:2, 2]
        corners = _rectangle(middle - scale * half, middle + scale * half)
        look = {"fill": False, "edgecolor": self._style.ink, "linewidth": 0.8 * self._thin, "alpha": 0.55}
        return LastingPatch(corners, transform=IdentityTransform(), **look).drawn_on(self._figure, room.box)

    def outline_of(self, room: Frame, matrix: Array, frames: dict[str, Array]) -> LastingPatch:
        """The rectangle of the inset that the picture shows in `room`; `matrix` is the picture's map from metres."""
        corners = np.array([(room.left, room.bottom), (room.left + room.width, room.bottom + room.height)])
        low, high = seen(corners, self._inset.matrix(frames) @ np.linalg.inv(matrix))
        look = {"fill": False, "edgecolor": self._style.contact, "linewidth": self._thin}
        return self._own(LastingPatch(_rectangle(low, high), transform=IdentityTransform(), **look))

    def draw(self, renderer: RendererBase, frames: dict[str, Array], marks: Marks, out_pixels: Pixels) -> None:
        """Draw the inset for the poses x, y, angle of one instant."""
        matrix = self._inset.matrix(frames)
        self._sheet.draw(renderer)
        for body, transform in self._transforms.items():
            transform.set_matrix(matrix @ pose_matrix(frames[body]))
        for patch in self._springs.patches(frames, matrix):
            patch.draw(renderer)
        for shape in self._seen():
            for patch in shape.patches:
                patch.draw(renderer)
        for patch in marks(matrix):
            self._own(patch).draw(renderer)
        self._border.draw(renderer)
        box, size = self._inset.box, self._words.size
        self._words.write(self._inset.name, box.left + 0.5 * size, box.bottom + 0.55 * size, out_pixels)

    def _seen(self) -> Iterator[_Shape]:
        box = self._inset.box
        for shape in self._shapes:
            x, y = self._transforms[shape.body].transform(shape.middle)
            if box.near(x, y, shape.reach * self._inset.view.scale):
                yield shape

    def _shape(self, part: Part) -> _Shape:
        points = np.asarray(part.faces.vertices)
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        look = self._style.worn(part.finish)
        colour = self._style.line(look) if part.ground else look.edge
        edge = {"edgecolor": colour, "joinstyle": "round", "transform": self._transforms[part.body]}
        if part.ground:
            paths = [part.faces] if part.strokes is None else [part.strokes, part.faces]
            made = [LastingPatch(path, fill=False, linewidth=self._thin, **edge) for path in paths]
        else:
            made = [LastingPatch(part.faces, facecolor=look.fill, linewidth=self._thin, **edge)]
        return _Shape(part.body, tuple(map(self._own, made)), middle, float(np.hypot(*(points - middle).T).max()))

    def _own(self, patch: LastingPatch) -> LastingPatch:
        return patch.drawn_on(self._figure, self._inset.box.box)


def _rectangle(low: Sequence[float] | Array, high: Sequence[float] | Array) -> Path:
    (x0, y0), (x1, y1) = low, high
    return Path([(x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0)], closed=True)


DPI = 72.0  # one point is one pixel
SWINGS = 8.0  # on a page
MOST_PAGES = 4000
LEFT, FOOT = 11.5, 2.3  # of the text's size: room for the words on the left and below
BELOW = 0.1  # of the height of one of the two rows, under its axes


class Strip:
    """The strip of one body in `room` (pixels); `size` is that of its text."""

    def __init__(
        self, run: Trajectory, window: Window, room: Frame, body: str, phases: Sequence[Phase], size: float, style: Style
    ) -> None:
        self._style = style
        self._run, self._room, self._phases, self._size = run, room, phases, size
        self._body = choose(run, [body])[0]
        self._window = window
        self._column = run.slices[body].start
        self._last: tuple[int, Pixels, tuple[float, float]] | None = None
        rows = dense(run, window)
        self._travels = self._body.motion in ("slide", "free")
        self._reach = [_reach(self._shown(values)) for values in rows[1:3]]
        speed = rows[2][:, self._column]
        swings = 0.5 * float(np.count_nonzero(np.diff(np.signbit(speed))))
        self._pages = min(max(1, math.ceil(swings / SWINGS - 0.25)), MOST_PAGES)

    def draw(self, t: float, out_pixels: Pixels) -> None:
        """Copy the page that holds `t` (s) and its cursor into the picture."""
        share = (t - self._window[0]) / (self._window[1] - self._window[0]) * self._pages
        number = min(max(int(share), 0), self._pages - 1)
        if self._last is None or self._last[0] != number:
            self._last = (number, *self._page(number))
        _, page, (left, right) = self._last
        bottom = out_pixels.shape[0] - round(self._room.bottom)
        place = slice(bottom - page.shape[0], bottom), slice(round(self._room.left), round(self._room.left) + page.shape[1])
        out_pixels[place] = page
        middle = place[1].start + left + (share - number) * (right - left)
        half = max(1, round(0.06 * self._size))
        columns = slice(round(middle) - half, round(middle) + half)
        foot = FOOT * self._size + BELOW * 0.5 * (self._room.height - FOOT * self._size)  # of the lower axes, pixels
        colour = np.round(255 * np.array(to_rgb(self._style.contact)))
        out_pixels[place[0].start : bottom - round(foot), columns, :3] = colour

    def _shown(self, rows: Array) -> Array:
        """Of q or u, in mm or degrees."""
        return rows[:, self._column] * 1e3 if self._travels else np.degrees(rows[:, self._column])

    def _page(self, number: int) -> tuple[Pixels, tuple[float, float]]:
        """The pixels of one page, and the columns of its first and last instant."""
        start, end = (self._window[0] + k / self._pages * (self._window[1] - self._window[0]) for k in (number, number + 1))
        width, height = round(self._room.width), round(self._room.height)
        figure = Figure(figsize=((width + 0.5) / DPI, (height + 0.5) / DPI), dpi=DPI, facecolor=self._style.background)
        canvas = FigureCanvasAgg(figure)
        left, right, foot = LEFT * self._size, 1.6 * self._size, FOOT * self._size
        each = (height - foot) / 2.0
        t, q, u, _ = dense(self._run, (start, end))
        time, line = clock((start, end)), self._style.curve(looks(self._run.scene)[self._body.name])
        units = ("travel (mm)", "velocity (mm/s)") if self._travels else ("angle (°)", "velocity (°/s)")
        for k, (values, unit) in enumerate(zip((q, u), units, strict=True)):
            bottom = foot + (1 - k) * each + BELOW * each
            axes = figure.add_axes((left / width, bottom / height, 1.0 - (left + right) / width, 0.86 * each / height))
            for phase in self._phases:
                colour = self._style.phases.get(phase.name)
                if colour is not None and phase.end > start and phase.start < end:
                    axes.axvspan(time.at(phase.start), time.at(phase.end), color=colour, linewidth=0.0, zorder=0)
            axes.plot(time.at(t), self._shown(values), color=line, linewidth=0.11 * self._size)
            axes.set_xlim(time.at(start), time.at(end))
            axes.set_ylim(*self._reach[k])
            self._dress(axes, f"{spaced(self._body.name)}\n{unit}", k == 1)
        axes.set_xlabel(time.label, fontsize=0.8 * self._size, color=self._style.ink, labelpad=0.05 * self._size)
        canvas.draw()
        return np.array(canvas.buffer_rgba())[:height, :width].copy(), (left, width - right)

    def _dress(self, axes: Axes, unit: str, last: bool) -> None:
        axes.set_facecolor(self._style.background)
        axes.locator_params(axis="y", nbins=3)
        axes.grid(True, color=self._style.grid, linewidth=0.8)
        axes.set_axisbelow(True)
        size, ink = 0.8 * self._size, self._style.ink
        axes.tick_params(labelsize=size, colors=ink, length=0.0, labelbottom=last, pad=0.25 * self._size)
        axes.set_ylabel(unit, fontsize=size, color=ink, rotation=0, ha="left", va="center", parse_math=False)
        axes.yaxis.set_label_coords((1.6 - LEFT) * self._size / (self._room.width - (LEFT + 1.6) * self._size), 0.5)
        for side, spine in axes.spines.items():
            spine.set_visible(side in ("left", "bottom"))
            spine.set_color(self._style.faint)


def strip_body(run: Trajectory, asked: str | None) -> str:
    """The body that a strip shows: the one asked for, else the oscillator, else the first that moves."""
    own = asked or roles(run.scene).oscillator
    return choose(run, [own] if own else None)[0].name


def _reach(values: Array) -> tuple[float, float]:
    """Limits of an axis with a little air."""
    known = values[np.isfinite(values)]
    low, high = float(known.min()), float(known.max())
    air = 0.08 * (high - low) or max(abs(high), 1.0) * 0.1
    return low - air, high + air
