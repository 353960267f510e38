"""Which pieces make up one body?

Pieces about one centre, pieces whose layers name one part, and pieces that lie in each other. What is left over and shows no
centre stands still.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from watchsim.geometry.primitives import Point
from watchsim.mechanism.overlap import placed
from watchsim.proposal.geneva import cranks_of
from watchsim.proposal.pieces import (
    MANY,
    NONE,
    SURE,
    USUAL,
    WEAK,
    Centre,
    Mark,
    Piece,
    Source,
    Turned,
    centre_of,
    holds,
    hole_of,
    is_toothed,
)
from watchsim.proposal.words import CLICK, DRIVER, FIXED, LEVER, OSCILLATOR, WHEEL, hints_of, part_of, part_word, tokens


@dataclass(eq=False)
class Part:
    """Pieces that move as one. `kind` is what names say it is, None where they say nothing; `why`: what holds it together."""

    pieces: list[Piece]
    centre: Centre | None = None
    kind: str | None = None
    hints: frozenset[str] = frozenset()  # kinds that its name may mean
    why: list[str] = field(default_factory=list)

    @property
    def area(self) -> float:
        return sum(piece.area for piece in self.pieces)

    @property
    def layers(self) -> list[str]:
        return list(dict.fromkeys(piece.layer for piece in self.pieces))

    def on(self, layer: str) -> list[Piece]:
        return [piece for piece in self.pieces if piece.layer == layer]

    @property
    def file(self) -> int:
        return self.pieces[0].file


def join(parts: list[Part], together: Callable[[Part, Part], bool], why: str) -> None:
    """Unite parts as long as two belong together."""
    k = 0
    while k < len(parts):
        other = next((one for one in parts[k + 1 :] if together(parts[k], one)), None)
        if other is None:
            k += 1
            continue
        unite(parts[k], other, why)
        parts.remove(other)


def unite(part: Part, other: Part, why: str) -> None:
    part.pieces += other.pieces
    part.centre = surest((part, other))
    # An anchor with its pendulum, or a lever with its own balance, is the oscillator; an arm with a beak a click.
    kinds = {part.kind, other.kind}
    part.kind = OSCILLATOR if kinds == {LEVER, OSCILLATOR} else CLICK if kinds == {LEVER, CLICK} else part.kind or other.kind
    part.why = list(dict.fromkeys([*part.why, *other.why, why]))


def surest(parts: Iterable[Part]) -> Centre | None:
    """Of the centres of some parts the one that is best founded."""
    return max((part.centre for part in parts if part.centre is not None), key=lambda centre: centre.worth, default=None)


def are_apart(one: Part, other: Part) -> bool:
    """Do centres or names say that these are two bodies?"""
    if one.centre is not None and other.centre is not None and not one.centre.is_that_of(other.centre):
        return True
    first, second = ({part.kind} if part.kind else part.hints for part in (one, other))
    return bool(first) and bool(second) and not set(first) & set(second)


# Where pieces belong that show no centre: to what they lie in, or next to.

INSIDE = 0.3  # of a piece in the material of a body: it belongs to it
HUBBED = 0.1  # the same of a hub, which a bar reaches with its end
BORDER = 0.2  # of a piece's outline on that of a body: it belongs to it
CLOSE = 0.01  # of the whole: an outline without a name as near as this to a body belongs to it
BESIDE = 1e-6  # m: outlines this close lie on each other


def take_in(parts: list[Part]) -> None:
    """Give pieces without a centre to the body in whose material, or along whose outline, they lie."""
    while _take_in_some(parts):  # an arm lies in its hub, the stone at its end in the arm
        pass
    for part in [part for part in parts if part.centre is None and part.kind == OSCILLATOR]:  # a rod fixed to an anchor
        if not any(other.centre is not None and other.kind == OSCILLATOR for other in parts):
            body = next((other for other in parts if other.kind == LEVER and _meet(part, other)), None)
            if body is not None:
                unite(body, part, "they lie in each other")
                parts.remove(part)


def take_in_misnamed(parts: list[Part]) -> None:
    """Where no body is of the kind that a feature's name speaks of, it belongs to the one in which it lies all the same."""
    for part in [part for part in parts if part.centre is None and part.kind is not None and part.kind != FIXED]:
        if any(part_word(layer) for layer in part.layers) or any(one.centre and one.kind == part.kind for one in parts):
            continue
        around = [other for other in parts if other is not part and not _is_wheel(other)]
        body = max(around, key=lambda other: _in_each_other(part, other), default=None)
        if body is not None and body.centre is not None and _in_each_other(part, body) >= INSIDE:
            kind = body.kind
            unite(body, part, "they lie in each other, and no other part is of the kind that its name speaks of")
            body.kind = CLICK if part.kind == CLICK and kind == LEVER else kind  # an arm with a beak
            parts.remove(part)


def _take_in_some(parts: list[Part]) -> bool:
    before = len(parts)
    for part in [part for part in parts if part.centre is None and part.kind != FIXED]:
        around = [other for other in parts if other.centre is not None and not are_apart(part, other)]
        body = max(around, key=lambda other: (_in_each_other(part, other), -other.area), default=None)
        if body is not None and _in_each_other(part, body) >= (HUBBED if _is_hub(body) else INSIDE):
            unite(body, part, "they lie in each other")
            parts.remove(part)
    return len(parts) < before


def _is_hub(body: Part) -> bool:
    """Nothing but discs without a name: what reaches into it is fixed to it."""
    return not body.hints and all(piece.is_disc for piece in body.pieces)


def _in_each_other(part: Part, body: Part) -> float:
    """How much of the part lies in the body, or of the body, a hub, in the part."""
    return max(_share(part, body), _share(body, part))


def _meet(part: Part, other: Part) -> bool:
    return any(p.region.intersects(q.region) for p in part.pieces for q in other.pieces)


def _share(part: Part, other: Part) -> float:
    """How much of a part lies in another one: of its area, or as much as its border says."""
    most = 0.0
    for piece in part.pieces:
        for there in other.pieces:
            most = max(most, piece.region.intersection(there.region).area / piece.area)
            if most < INSIDE and piece.region.distance(there.region) <= BESIDE:
                along = piece.region.boundary.intersection(there.region.buffer(BESIDE)).length
                most = max(most, INSIDE if along > BORDER * piece.length else 0.0)
    return most


def _nearest(loose: Part, parts: Sequence[Part]) -> Part | None:
    bodies = [part for part in parts if part.centre is not None and not are_apart(loose, part)]
    return min(bodies, key=lambda part: distance(loose, part), default=None)


def distance(one: Part, other: Part) -> float:
    """Between the outlines as they are drawn, m."""
    return min(float(p.region.distance(q.region)) for p in one.pieces for q in other.pieces)


def give_to_nearest(parts: list[Part]) -> None:
    """What is named for a moving part goes to the nearest one of that kind."""
    for loose in [part for part in parts if part.centre is None and part.kind != FIXED and part.hints - {FIXED}]:
        body = _nearest(loose, parts)
        if body is not None and body.kind is not None:
            unite(body, loose, "it is the nearest part of the kind that their names speak of")
            parts.remove(loose)


def give_to_close(parts: list[Part]) -> None:
    """What nothing names and is no disc, such as a stone set in a lever, goes to the part that it nearly touches."""
    points = np.concatenate([piece.points for part in parts for piece in part.pieces]) if parts else np.zeros((1, 2))
    near = CLOSE * float((points.max(axis=0) - points.min(axis=0)).max())
    for loose in [part for part in parts if part.centre is None and part.kind is None and not part.hints]:
        if len(loose.pieces) > 1 or loose.pieces[0].is_disc:
            continue
        body = _nearest(loose, [part for part in parts if not _is_wheel(part)])
        if body is not None and distance(loose, body) <= near:
            unite(body, loose, "it nearly touches them")
            parts.remove(loose)


def _is_wheel(part: Part) -> bool:
    return part.kind == WHEEL or any(piece.turned is not None and is_toothed(piece.turned) for piece in part.pieces)


def teeth_of(part: Part) -> int:
    """The fold of the rotational symmetry of the part's outermost toothed piece; 0 without one."""
    toothed = [piece.turned for piece in part.pieces if piece.turned is not None and is_toothed(piece.turned)]
    centre = part.centre
    about = [one for one in toothed if centre is not None and math.dist(one.centre, centre.at) <= 1e-2 * one.outer]
    return max(about, key=lambda one: one.outer).fold if about else 0


def call_wheel(parts: Sequence[Part]) -> None:
    """Make the part with the most teeth a wheel, where the names of its features alone speak against it, and none else is one.

    An "impulse" may be a stone of the balance or the teeth of a duplex wheel, a "rim" that of a balance or of a pin wheel.
    """
    if any(part.kind in (WHEEL, None) and teeth_of(part) for part in parts):
        return
    free = [part for part in parts if teeth_of(part) >= MANY and not any(part_word(layer) for layer in part.layers)]
    if free:
        wheel = max(free, key=teeth_of)
        wheel.kind = WHEEL
        wheel.why.append(f"it has {teeth_of(wheel)}-fold rotational symmetry, and nothing else is a wheel")


def parts_of(sources: Sequence[Source], pieces: Sequence[Piece]) -> list[Part]:
    """The bodies of all drawings; the parts of different files are different bodies."""
    found: list[Part] = []
    for number, source in enumerate(sources):
        own = [piece for piece in pieces if piece.file == number]
        found += _in_one_drawing(source, own, len(sources) > 1)
    return found


def _in_one_drawing(source: Source, pieces: Sequence[Piece], alone: bool) -> list[Part]:
    marks = _distinct(source.marks)
    cranks = _cranks(pieces, marks)
    turned = [piece for crank in cranks for piece in crank.pieces]
    parts = [_single(piece, marks, source) for piece in pieces if piece not in turned]
    above = _above_others(parts, marks)
    parts = [part for part in parts if part not in above]
    if alone:  # one of several files: a drawing of one part, unless blocks or marks say otherwise
        parts = _of_one_file(source, parts, marks)
    parts += cranks
    join(parts, _one_block(source), "they are one block")
    join(parts, _one_centre, "they have the same centre")
    join(parts, _one_name, "the names of their layers begin alike")
    call_wheel(parts)
    join(parts, _same_kind(parts), "the names of their layers belong to the same kind of part")
    take_in(parts)
    if not _idle(parts, marks):  # no pivot is left for a body that only a feature's name tells of
        take_in_misnamed(parts)
    join(parts, _one_layer(parts), "they lie on one layer")
    _give_marks(parts, marks)
    give_to_nearest(parts)
    give_to_close(parts)
    parts += above
    join(parts, _one_centre, "they have the same centre")
    join(parts, _both_left_over, "nothing shows a centre")
    for part in parts:
        if part.centre is None and part.kind != FIXED and part.kind is not None:
            part.centre = _own_centre(part)
    return parts


def _cranks(pieces: Sequence[Piece], marks: Sequence[Mark]) -> list[Part]:
    """The cranks of Geneva drives; what is called another part than a driver is none, and turns with none."""
    free = [piece for piece in pieces if part_word(piece.layer) is None or part_of(piece.layer) in (DRIVER, WHEEL)]
    return [Part(one.pieces, one.centre, DRIVER, why=[one.centre.why]) for one in cranks_of(free, marks)]


def _single(piece: Piece, marks: Sequence[Mark], source: Source) -> Part:
    prefix = piece.layer.split("_")[0]
    named = source.blocks.get(prefix)
    kind = (part_of(named) if named else None) or part_of(piece.layer)
    centre = centre_of(piece, marks)
    if kind == FIXED and piece.is_disc and centre is not None and centre.worth == SURE:
        kind = None  # a disc about a pivot turns, whatever it is called
    return Part([piece], None if kind == FIXED else centre, kind, hints_of(piece.layer))


def _of_one_file(source: Source, parts: list[Part], marks: Sequence[Mark]) -> list[Part]:
    """All that a file holds as one body, where it marks one pivot at most and has no blocks."""
    if len(marks) > 1 or source.blocks or not parts:
        return parts
    pieces = [piece for part in parts for piece in part.pieces]
    kind = part_of(source.path.stem) or next((part.kind for part in parts if part.kind), None)
    why = ["it is a drawing by itself"]
    if kind == FIXED:
        return [Part(pieces, None, kind, why=why)]
    if marks:
        centre = Centre(marks[0].at, SURE, f"the drawing marks it on layer {marks[0].layer}", marks[0])
        return [Part(pieces, centre, kind, why=why)]
    whole = Part(pieces, surest(parts), kind, why=why)
    whole.centre = whole.centre or _own_centre(whole)
    return [whole]


def _one_block(source: Source) -> Callable[[Part, Part], bool]:
    def together(one: Part, other: Part) -> bool:
        first, second = (part.pieces[0].layer.split("_")[0] for part in (one, other))
        return first == second and first in source.blocks

    return together


def _one_centre(one: Part, other: Part) -> bool:
    return one.centre is not None and other.centre is not None and one.centre.is_that_of(other.centre)


def _one_name(one: Part, other: Part) -> bool:
    first, second = ({part_word(layer) for layer in part.layers} - {None} for part in (one, other))
    return bool(first & second) and not are_apart(one, other)


def _same_kind(parts: Sequence[Part]) -> Callable[[Part, Part], bool]:
    """Of one kind, where only one centre is known for it: two levers would be two bodies."""

    def together(one: Part, other: Part) -> bool:
        if one.kind is None or one.kind != other.kind:
            return False
        centres = [part.centre for part in parts if part.kind == one.kind and part.centre is not None]
        return all(centre.is_that_of(centres[0]) for centre in centres)

    return together


def _one_layer(parts: Sequence[Part]) -> Callable[[Part, Part], bool]:
    """On one layer, unless that holds nearly everything or what is on it has several centres."""

    def together(one: Part, other: Part) -> bool:
        shared = [layer for layer in one.layers if layer in other.layers and tokens(layer)]
        if not shared or are_apart(one, other):
            return False
        there = [part for part in parts if shared[0] in part.layers]
        centres = [part.centre for part in there if part.centre is not None]
        loose, body = (one, other) if one.centre is None else (other, one)
        nearest = body.centre is None or _nearest(loose, parts) is body
        return len(there) < len(parts) and len(centres) <= 1 and nearest

    return together


def _idle(parts: Sequence[Part], marks: Sequence[Mark]) -> list[Mark]:
    """The marks about which nothing turns."""
    places = [part.centre.at for part in parts if part.centre is not None]
    return [mark for mark in marks if all(math.dist(mark.at, at) > BESIDE for at in places)]


def _above_others(parts: Sequence[Part], marks: Sequence[Mark]) -> list[Part]:
    """The pieces, such as a balance's rim over the lever, whose outline runs round the pivot of another body as well.

    They lie above that body, and what lies within their outline need not belong to them: they are set aside, where something
    else shows their centre.
    """
    found: list[Part] = []
    for part in parts:
        centre = part.centre
        if centre is None or centre.worth < SURE:
            continue
        others = (mark for mark in marks if math.dist(mark.at, centre.at) > BESIDE)
        alone = not any(_one_centre(part, other) for other in parts if other is not part)
        if not alone and any(holds(part.pieces[0], mark.at) for mark in others):
            found.append(part)
    return found


def _both_left_over(one: Part, other: Part) -> bool:
    return one.centre is None and other.centre is None and {one.kind, other.kind} <= {None, FIXED}


def _give_marks(parts: list[Part], marks: Sequence[Mark]) -> None:
    """To each mark about which nothing turns yet the nearest part without a centre."""
    for mark in _idle(parts, marks):
        free = [part for part in parts if part.centre is None and part.kind != FIXED]
        if not free:
            break
        nearest = min(free, key=lambda part: _away(part, mark.at))
        nearest.centre = Centre(
            mark.at, WEAK, f"layer {mark.layer} marks it, and this part is the nearest without a centre", mark
        )
    join(parts, _one_centre, "they have the same centre")


def _away(part: Part, place: Point) -> float:
    return min(math.dist(place, (x, y)) for piece in part.pieces for x, y in piece.points.tolist())


def _own_centre(part: Part) -> Centre:
    """The centre of a part that shows none: its hole, the smallest circle drawn over its outlines, else its centre of area."""
    holes = [centre for piece in part.pieces if (centre := hole_of(piece)) is not None]
    if holes:
        return holes[0]
    over = [disc for disc in part.pieces if disc.is_disc and any(holds(p, disc.centroid) for p in part.pieces if p is not disc)]
    if over:
        bore = min(over, key=lambda disc: disc.area)
        radius = bore.length / (2.0 * math.pi)
        return Centre(bore.centroid, USUAL, f"the centre of its smallest circle, of radius {1e3 * radius:.4g} mm, as of a bore")
    largest = max(part.pieces, key=lambda piece: piece.area)
    return Centre(largest.centroid, NONE, "the centre of area of its largest outline: nothing in the drawing shows a pivot")


def _distinct(marks: Iterable[Mark]) -> list[Mark]:
    found: list[Mark] = []
    for mark in sorted(marks, key=lambda mark: not mark.single):
        if all(math.dist(mark.at, other.at) > BESIDE for other in found):
            found.append(mark)
    return found


# A click works on one side of a wheel only.

SWING = math.radians(15.0)  # to either side: what is an anchor has its other pallet in the teeth by then
STEP = math.radians(0.1)


@dataclass(frozen=True)
class Nose:
    """Of a click: the way (+1 counter-clockwise) that leads into the wheel, its distance from the click's pivot (m), and
    the share of its motion that leads to the wheel's centre: 1 where the click turns square to the wheel, 0 where it cannot."""

    inward: int
    arm: float
    share: float


def is_one_sided(part: Part, wheel: Part) -> bool:
    """Turned one way it comes within the tips of the wheel's teeth, and turned the other way it is clear of them."""
    toothed = toothing(wheel)
    if part.centre is None or toothed is None:
        return False
    ways = [_closest(part, toothed.centre, angle)[0] < toothed.outer for angle in (-SWING, SWING)]
    return ways[0] != ways[1]


def nose_of(part: Part, wheel: Part) -> Nose:
    """The place of the part nearest to the centre of a wheel or cam, as it is drawn."""
    assert part.centre is not None and wheel.centre is not None
    at = wheel.centre.at
    _, place = _closest(part, at, 0.0)
    closer = _closest(part, at, STEP)[0] < _closest(part, at, -STEP)[0]
    (x, y), (px, py) = place, part.centre.at
    away, arm = math.dist(place, at), math.dist(place, (px, py))
    across = abs((x - px) * (at[1] - y) - (y - py) * (at[0] - x))
    return Nose(1 if closer else -1, arm, across / (away * arm) if away > 0.0 and arm > 0.0 else 0.0)


def toothing(wheel: Part) -> Turned | None:
    """What has rotational symmetry, be it a wheel of many teeth or a star of a few."""
    return max((piece.turned for piece in wheel.pieces if piece.turned is not None), key=lambda one: one.outer, default=None)


def _closest(part: Part, centre: Point, angle: float) -> tuple[float, Point]:
    """The least distance of the part's outlines from a point once it is turned by `angle`, and where it is."""
    assert part.centre is not None
    pivot = part.centre.at
    points: NDArray[np.float64] = np.concatenate([piece.points for piece in part.pieces])
    about = placed(points - np.array(pivot), (*pivot, angle)) - np.array(centre)
    k = int(np.argmin(np.hypot(*about.T)))
    return float(np.hypot(*about[k])), (float(about[k, 0] + centre[0]), float(about[k, 1] + centre[1]))
