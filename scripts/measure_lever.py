"""What are the lock, lift, drop, draw and freedoms of a drawn lever escapement?

    python scripts/measure_lever.py [scene.toml]

Turns the drawn parts against one another, as a watchmaker does by hand, and prints what it finds. Geometry only: no
forces, nothing shared with the simulation. The scene's bodies must be called wheel (turning clockwise), lever, balance
and banking, and stand one above the other. Angles in degrees at the pivot of the part they belong to; `a` is the lever
angle counted towards the bank on which the stone in question locks.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from itertools import pairwise
from pathlib import Path

import shapely
from measure_safety import Safety, measure_safety
from measure_shapes import Layout, first, placed, read_layout
from shapely.geometry.base import BaseGeometry

TEETH = 15  # unless the caller says otherwise
STEPS = (0.04, 2e-3, 5e-5)  # of the lever, in the scan of a beat: coarse, then finer up to the let-off
LOST = 6.0  # the wheel turns this many lever steps without touching: it has been let off
GRAIN = 40  # steps in which the wheel is turned over a reach
TOE = 0.02  # a contact within this of the toe is at the toe


@dataclass(frozen=True)
class Beat:
    """One beat, in which the entry or the exit stone is unlocked and driven. Degrees unless a comment says mm."""

    bank: float  # lever, from the middle to the bank
    draw: float  # of the locking face, from the direction that would neither draw nor repel, lever on the bank
    unlock: float  # lever, from the bank until the toe leaves the locking face (run and lock)
    recoil: float  # wheel, backwards while it is unlocked
    lift_stone: float  # lever, with a toe on the impulse face of the stone
    lift_tooth: float  # lever, with the discharge corner on the impulse face of the tooth
    drop: float  # wheel, from let-off to the lock on the other stone
    lock: float  # lever, how deep the other stone locks at the end of the drop
    run: float  # lever, from let-off to the other bank
    spare_mm: float  # mm, least distance of the wheel from the other stone up to let-off
    wheel_start: float  # wheel, resting on the locking face with the lever on the bank (modulo the pitch)


@dataclass(frozen=True)
class Sweep:
    """Lever and wheel from the bank to let-off."""

    bank: float
    rows: list[tuple[float, float]]  # (a, q), a falling; the last row is at let-off
    unlocked: float
    farthest_back: float


class Escapement:
    """Wheel, stones and banking: where they touch."""

    def __init__(self, layout: Layout, teeth: int = TEETH) -> None:
        self.teeth = teeth
        self.layout = layout
        self.lever_at = layout.parts["lever"].position
        self.wheel_at = layout.parts["wheel"].position
        self.wheel = layout.shape("wheel", layout.layers_between("wheel", "lever"))
        shapely.prepare(self.wheel)
        stones = layout.shape("lever", layout.layers_between("lever", "wheel"))
        self.exit, self.entry = sorted(shapely.get_parts(stones), key=lambda stone: -stone.centroid.x)
        self.body = layout.shape("lever", layout.layers_between("lever", "banking"))
        self.banking = layout.shape("banking", layout.layers_between("banking", "lever"))

    def stone(self, side: int, a: float) -> BaseGeometry:
        """The entry (+1) or exit (-1) stone in the movement."""
        return placed(self.entry if side > 0 else self.exit, side * a, self.lever_at)

    def gap(self, q: float, stone: BaseGeometry) -> float:
        """Distance of the wheel from a stone; 0 where they overlap."""
        return float(shapely.distance(self.wheel, self._seen(q, stone)))

    def touches(self, q: float, stone: BaseGeometry) -> bool:
        return bool(shapely.intersects(self.wheel, self._seen(q, stone)))

    def bank(self, side: int) -> float:
        """Where the body meets the banking."""
        found = first(lambda a: placed(self.body, side * a, self.lever_at).intersects(self.banking), 0.0, 15.0, 0.1)
        if found is None:
            raise ValueError("the lever never meets its banking")
        return found

    def rest(self, q: float, stone: BaseGeometry, reach: float) -> float | None:
        """The wheel angle at which a tooth rests on the stone, coming from q; None if it is free for `reach`.

        A wheel that overlaps the stone is turned back until it does not.
        """
        if self.touches(q, stone):
            back = first(lambda d: not self.touches(q + d, stone), 0.0, reach, reach / GRAIN)
            return None if back is None else q + back
        ahead = first(lambda d: self.touches(q - d, stone), 0.0, reach, reach / GRAIN)
        return None if ahead is None else q - ahead

    def at_toe(self, q: float, stone: BaseGeometry) -> bool:
        """Does the wheel touch with a toe (a corner on the x axis of the wheel's frame, or a whole pitch from it)?"""
        x, y = shapely.shortest_line(self.wheel, self._seen(q, stone)).coords[0]
        pitch = 360.0 / self.teeth
        return abs((math.degrees(math.atan2(y, x)) + pitch / 2.0) % pitch - pitch / 2.0) < TOE

    def _seen(self, q: float, stone: BaseGeometry) -> BaseGeometry:
        """The stone in the wheel's own frame."""
        x, y = self.wheel_at
        return placed(placed(stone, 0.0, (-x, -y)), -q, (0.0, 0.0))


def measure(scene: Path, teeth: int = TEETH) -> tuple[Beat, Beat, Safety]:
    """Entry beat, exit beat and safety action of a scene."""
    layout = read_layout(scene)
    m = Escapement(layout, teeth)
    paths = {side: follow(m, side) for side in (1, -1)}
    return _beat(m, paths, 1), _beat(m, paths, -1), measure_safety(layout, m.bank(1))


def follow(m: Escapement, side: int) -> Sweep:
    """Turn the lever from the bank until the wheel is let off, the wheel always resting on the stone."""
    bank = m.bank(side)
    start = m.rest(0.0, m.stone(side, bank), 24.0)
    if start is None:
        raise ValueError("no tooth locks with the lever on the bank")
    rows = [(bank, start)]
    for step in STEPS:
        rows += _until_lost(m, side, rows[-1], step)
    unlocked, back = _kink(m, side, max(rows, key=lambda row: row[1]))
    return Sweep(bank, rows, unlocked, back)


def _until_lost(m: Escapement, side: int, row: tuple[float, float], step: float) -> list[tuple[float, float]]:
    """Rows after this one, the lever going on in steps, until the wheel is free."""
    a, q = row
    rows: list[tuple[float, float]] = []
    while True:
        a -= step
        found = m.rest(q, m.stone(side, a), LOST * step)
        if found is None:
            return rows
        q = found
        rows.append((a, q))


def _kink(m: Escapement, side: int, top: tuple[float, float]) -> tuple[float, float]:
    """Where the wheel has been driven back farthest, by trisection around the highest row."""
    low, high = top[0] - STEPS[0], top[0] + STEPS[0]
    reach = LOST * STEPS[0]

    def height(a: float) -> float:
        return m.rest(top[1] + 0.1 * reach, m.stone(side, a), reach) or -math.inf

    while high - low > 1e-6:
        third = (high - low) / 3.0
        low, high = (low + third, high) if height(low + third) < height(high - third) else (low, high - third)
    return low, height(low)


def draw_angle(m: Escapement, side: int, bank: float, q: float) -> float:
    """Angle between the locking face and the direction square to the line from the lever's pivot to the contact."""
    stone = m.stone(side, bank)
    x, y = m.lever_at
    contact = shapely.shortest_line(placed(m.wheel, q, m.wheel_at), stone).coords[1]
    ring = list(stone.exterior.coords)
    (x0, y0), (x1, y1) = min(pairwise(ring), key=lambda edge: shapely.LineString(edge).distance(shapely.Point(contact)))
    face = math.degrees(math.atan2(y1 - y0, x1 - x0))
    square = math.degrees(math.atan2(contact[1] - y, contact[0] - x)) + 90.0
    return abs((face - square + 90.0) % 180.0 - 90.0)


def _beat(m: Escapement, paths: dict[int, Sweep], side: int) -> Beat:
    path, other = paths[side], paths[-side]
    let_off, last = path.rows[-1]
    landed = m.rest(last, m.stone(-side, -let_off), 12.0)
    toe = [a for a, q in path.rows if a < path.unlocked and m.at_toe(q, m.stone(side, a))]
    change = min(toe, default=let_off)
    return Beat(
        bank=path.bank,
        draw=draw_angle(m, side, path.bank, path.rows[0][1]),
        unlock=path.bank - path.unlocked,
        recoil=path.farthest_back - path.rows[0][1],
        lift_stone=path.unlocked - change,
        lift_tooth=change - let_off,
        drop=math.nan if landed is None else last - landed,
        lock=-let_off - other.unlocked,
        run=other.bank + let_off,
        spare_mm=min(m.gap(q, m.stone(-side, -a)) for a, q in path.rows),
        wheel_start=path.rows[0][1],
    )


def main(scene: Path) -> None:
    """Print the table."""
    entry, exit_, safety = measure(scene)
    print(f"{'':14s} {'entry':>10s} {'exit':>10s}")
    for name, value in asdict(entry).items():
        print(f"{name:14s} {value:10.4f} {getattr(exit_, name):10.4f}")
    for name, value in asdict(safety).items():
        print(f"{name:18s} {value:10.4f}")


if __name__ == "__main__":
    from usage import arguments

    default = Path(__file__).resolve().parents[1] / "profiles" / "swiss_lever" / "scene.toml"
    main(arguments(__doc__, scene=(default, "the scene to measure")).scene)
