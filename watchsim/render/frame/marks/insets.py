"""Which places does a picture show once more, enlarged?

A place is given as a body ("lever"), one of its layers ("lever.STONES"), one outline of a layer ("lever.STONES.2", counted in
the order of the drawing), the "entry stone" or "exit stone" of an escapement, or a rectangle of the movement in millimetres
("-1.4, 1.9 : -0.8, 2.5"). What stays about where it is is shown in place; what goes far is followed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.loop import Loop
from watchsim.render.frame.filled_parts import loops_of, outline
from watchsim.render.frame.marks.pallet_stones import STONES, PalletStones
from watchsim.render.frame.pose_history import Window, placed, swept
from watchsim.render.frame.view import COARSE, Frame, View
from watchsim.scene.body import Body
from watchsim.simulation.record.trajectory import Trajectory

Array = NDArray[np.float64]

AIR = 0.12  # of an inset, around what it shows
STAYS = 2.5  # what sweeps more than so many times its size is followed
FOLLOWED = 1.0  # of its diagonal is in sight on every side of its middle: enough of what it meets
MOST = 6  # insets
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
    if count > MOST:
        raise ValueError(f"insets: {count} are too many to be read; show at most {MOST}")
    wide, gap = frame.width >= frame.height, GAP * max(frame.width, frame.height)
    across, down = (ACROSS * frame.width, frame.height) if wide else (frame.width, DOWN * frame.height)
    left, top = frame.left + frame.width - across, frame.bottom + frame.height
    columns = max(range(1, count + 1), key=lambda n: (min((across - gap) / n, (down - gap) / -(-count // n)), -n))
    width, height = (across - gap) / columns, (down - gap) / -(-count // columns)
    boxes = tuple(
        Frame(
            left + gap + k % columns * width,
            top - gap - (k // columns + 1) * height + gap,
            width - gap,
            height - gap,
        )
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
    if (corners := _rectangle(place)) is not None:
        return Inset(place.strip(), box, _fitted(corners, box, turn))
    body, loops = _outlines(run, place, stones)
    points = outline(loops, math.inf)
    points = outline(loops, COARSE * max(float(np.ptp(points, axis=0).max()), 1e-12))
    frames = swept(run, body, window)
    room = placed(points, frames).reshape(-1, 2)
    low, high = points.min(axis=0), points.max(axis=0)
    if float(np.ptp(room, axis=0).max()) <= STAYS * float((high - low).max()):
        return Inset(place, box, _fitted(room, box, turn))
    middle, half = 0.5 * (low + high), FOLLOWED * float(np.hypot(*(high - low)))
    around = placed(middle[None], frames[:1])[0] + np.array([(-half, -half), (half, half)])
    return Inset(place, box, _fitted(around, box, turn), body.name, (float(middle[0]), float(middle[1])))


def _rectangle(place: str) -> Array | None:
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
    if place in STONES and all(body.name != place for body in run.scene.bodies):
        try:
            lever, loop = stones.stone(place)
        except ValueError as error:
            raise ValueError(f"inset {error}") from None
        return lever, [loop]
    name, _, rest = place.partition(".")
    drawn = {body.name: body for body in run.scene.bodies if loops_of(body)}
    if name not in drawn:
        raise ValueError(f'inset "{place}": bodies with a drawing are {", ".join(drawn)}')
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


def _fitted(points: Array, box: Frame, turn: float) -> View:
    """The view that fits points (n, 2) into a box."""
    c, s = math.cos(turn), math.sin(turn)
    seen = points @ np.array([[c, s], [-s, c]])
    low, high = seen.min(axis=0), seen.max(axis=0)
    width, height = np.maximum(high - low, 1e-12)
    scale = (1.0 - 2.0 * AIR) * min(box.width / width, box.height / height)
    x, y = 0.5 * (low + high)
    return View((c * x + s * y, -s * x + c * y), scale, turn, (box.left + 0.5 * box.width, box.bottom + 0.5 * box.height))
