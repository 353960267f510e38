"""Which pieces make up one body?

Pieces about one centre, pieces whose layers name one part, and pieces that lie in each other. What is left over and shows no
centre stands still.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence

from watchsim.geometry.primitives import Point
from watchsim.proposal.bodies.centres import SURE, Centre, centre_of, holds, hole_of
from watchsim.proposal.bodies.nearby import (
    BESIDE,
    give_to_close,
    give_to_nearest,
    nearest_to_each_other,
    take_in,
    take_in_misnamed,
)
from watchsim.proposal.bodies.part import Part, are_apart, join
from watchsim.proposal.bodies.part_names import FIXED, hints_of, part_of, part_word, tokens
from watchsim.proposal.bodies.piece import Piece
from watchsim.proposal.bodies.source import Mark, Source
from watchsim.proposal.bodies.toothed import call_wheel


def parts_of(sources: Sequence[Source], pieces: Sequence[Piece]) -> list[Part]:
    """The bodies of all drawings; the parts of different files are different bodies."""
    found: list[Part] = []
    for number, source in enumerate(sources):
        own = [piece for piece in pieces if piece.file == number]
        found += _in_one_drawing(source, own, len(sources) > 1)
    return found


def _in_one_drawing(source: Source, pieces: Sequence[Piece], alone: bool) -> list[Part]:
    marks = _distinct(source.marks)
    parts = [_single(piece, marks, source) for piece in pieces]
    above = _above_others(parts, marks)
    parts = [part for part in parts if part not in above]
    if alone:  # one of several files: a drawing of one part, unless blocks or marks say otherwise
        parts = _of_one_file(source, parts, marks)
    join(parts, _one_block(source), "they are one block")
    join(parts, _one_centre, "they have the same centre")
    join(parts, _one_name, "the names of their layers begin alike")
    join(parts, _same_kind(parts), "the names of their layers belong to the same kind of part")
    call_wheel(parts)
    take_in(parts)
    if all(_turns_about(parts, mark) for mark in marks):  # no pivot is left for a body that only a feature's name tells of
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
        return [
            Part(pieces, Centre(marks[0].at, 3, f"the drawing marks it on layer {marks[0].layer}", marks[0]), kind, why=why)
        ]
    centres = [part.centre for part in parts if part.centre is not None]
    whole = Part(pieces, max(centres, key=lambda centre: centre.worth, default=None), kind, why=why)
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
        return len(there) < len(parts) and len(centres) <= 1 and nearest_to_each_other(one, other, parts)

    return together


def _turns_about(parts: Sequence[Part], mark: Mark) -> bool:
    return any(part.centre is not None and math.dist(mark.at, part.centre.at) <= BESIDE for part in parts)


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
    taken = [part.centre.at for part in parts if part.centre is not None]
    for mark in marks:
        free = [part for part in parts if part.centre is None and part.kind != FIXED]
        if any(math.dist(mark.at, at) <= BESIDE for at in taken) or not free:
            continue
        nearest = min(free, key=lambda part: _away(part, mark.at))
        nearest.centre = Centre(mark.at, 1, f"layer {mark.layer} marks it, and this part is the nearest without a centre", mark)
    join(parts, _one_centre, "they have the same centre")


def _away(part: Part, place: Point) -> float:
    return min(math.dist(place, (x, y)) for piece in part.pieces for x, y in piece.points.tolist())


def _own_centre(part: Part) -> Centre:
    """The centre of a part that shows none: its hole, else its centre of area."""
    holes = [centre for piece in part.pieces if (centre := hole_of(piece)) is not None]
    if holes:
        return holes[0]
    largest = max(part.pieces, key=lambda piece: piece.area)
    return Centre(largest.centroid, 0, "the centre of area of its largest outline: nothing in the drawing shows a pivot")


def _distinct(marks: Iterable[Mark]) -> list[Mark]:
    found: list[Mark] = []
    for mark in sorted(marks, key=lambda mark: not mark.single):
        if all(math.dist(mark.at, other.at) > BESIDE for other in found):
            found.append(mark)
    return found
