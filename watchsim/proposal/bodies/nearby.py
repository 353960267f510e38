"""To which body do pieces belong that show no centre: which do they lie in, or next to?"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from watchsim.proposal.bodies.centres import is_toothed
from watchsim.proposal.bodies.part import Part, are_apart, unite
from watchsim.proposal.bodies.part_names import FIXED, LEVER, OSCILLATOR, WHEEL, part_word

INSIDE = 0.3  # of a piece in the material of a body: it belongs to it
BORDER = 0.2  # of a piece's outline on that of a body: it belongs to it
CLOSE = 0.01  # of the whole: an outline without a name as near as this to a body belongs to it
BESIDE = 1e-6  # m: outlines this close lie on each other


def take_in(parts: list[Part]) -> None:
    """Give pieces without a centre to the body in whose material, or along whose outline, they lie."""
    while _take_in_some(parts):  # an arm lies in its hub, the stone at its end in the arm
        pass
    for part in [part for part in parts if part.centre is None and part.kind == OSCILLATOR]:  # a rod fixed to an anchor
        if not any(other.centre is not None and other.kind == OSCILLATOR for other in parts):
            body = next((other for other in parts if other.kind == LEVER and other.centre and _meet(part, other)), None)
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
            body.kind = kind
            parts.remove(part)


def _take_in_some(parts: list[Part]) -> bool:
    before = len(parts)
    for part in [part for part in parts if part.centre is None and part.kind != FIXED]:
        around = [other for other in parts if other.centre is not None and not are_apart(part, other)]
        body = max(around, key=lambda other: (_in_each_other(part, other), -other.area), default=None)
        if body is not None and _in_each_other(part, body) >= INSIDE:
            unite(body, part, "they lie in each other")
            parts.remove(part)
    return len(parts) < before


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


def nearest_to_each_other(one: Part, other: Part, parts: Sequence[Part]) -> bool:
    """Is no other body, of a kind that the names allow, nearer to what has no centre yet?"""
    loose, body = (one, other) if one.centre is None else (other, one)
    if body.centre is None:
        return True
    return _nearest(loose, parts) is body


def _nearest(loose: Part, parts: Sequence[Part]) -> Part | None:
    bodies = [part for part in parts if part.centre is not None and not are_apart(loose, part)]
    return min(bodies, key=lambda part: _distance(loose, part), default=None)


def _distance(one: Part, other: Part) -> float:
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
        if body is not None and _distance(loose, body) <= near:
            unite(body, loose, "it nearly touches them")
            parts.remove(loose)


def _is_wheel(part: Part) -> bool:
    return part.kind == WHEEL or any(piece.turned is not None and is_toothed(piece.turned) for piece in part.pieces)
