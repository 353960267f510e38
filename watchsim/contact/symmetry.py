"""Which contacts are alike after a turn under which a body's outline is symmetric?"""

from __future__ import annotations

import functools
import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.cell_frames import chords, named_rows
from watchsim.model import CORNER, PRIMITIVE, Records, frozen

# What is the fold of an outline's rotational symmetry?
#
# A wheel's teeth are alike: what is known about one of them is known about all. The symmetry is found in the outline; how far
# it fails, by the rounding of the drawing, is measured and has to be allowed for.

Array = NDArray[np.float64]


class Symmetry(NamedTuple):
    """Turned by 1/fold of a turn about the origin, primitive i lies on primitive image[i], but for those that are `loose`."""

    fold: int
    image: NDArray[np.int64]
    loose: NDArray[np.bool_]


def turn_symmetry(primitives: Records, tolerance: float) -> Symmetry:
    """The symmetry that most of one body's primitives share; images miss by at most `tolerance` (m), added up over a turn.

    Spokes do not share the symmetry of the teeth: they are loose. Fold 1 where less than half of the primitives share one.
    What one tooth touches another touches: the image of each primitive is needed, within the clearance.
    """
    return _symmetry_of(primitives.tobytes(), tolerance)


@functools.lru_cache(maxsize=32)
def _symmetry_of(rows: bytes, tolerance: float) -> Symmetry:
    """Of primitives as bytes: every run of a geometry asks for the same, several times."""
    primitives = np.frombuffer(rows, PRIMITIVE)
    drawn = chords(primitives, math.inf)  # corner: its point; line or arc: its two ends
    ends = drawn.points[drawn.first[:-1]], drawn.points[drawn.first[1:] - 1]
    classes = _classes(primitives, tolerance)
    best = Symmetry(1, np.arange(len(primitives)), np.zeros(len(primitives), bool))
    gain = 0.25 * len(primitives)
    for fold in sorted({d for members, _ in classes for d in _divisors(len(members))}, reverse=True):
        dividable = sum(len(members) for members, _ in classes if len(members) % fold == 0)
        axial = sum(len(members) for members, on_axis in classes if on_axis)
        if (dividable + axial) * (1.0 - 1.0 / fold) <= gain:  # at most so many share it
            continue
        image, loose = np.arange(len(primitives)), np.zeros(len(primitives), bool)
        for members, on_axis in classes:
            if len(members) % fold == 0:
                image[members] = np.roll(members, -(len(members) // fold))
            else:
                loose[members] = not on_axis
        miss = fold * _mismatch(primitives, ends, image, 2.0 * math.pi / fold) > tolerance
        for members, _ in classes:
            loose[members] |= miss[members].any()
        shared = np.count_nonzero(~loose) * (1.0 - 1.0 / fold)
        if shared > gain:
            gain, best = shared, Symmetry(fold, np.where(loose, np.arange(len(image)), image), loose)
    for shared_by_all in (best.image, best.loose):
        frozen(shared_by_all)
    return best


def _classes(primitives: Records, tolerance: float) -> list[tuple[NDArray[np.int64], bool]]:
    """Primitives of one kind, size and distance from the origin, each class in the order of polar angles; is it on the axis?"""
    x, y = primitives["px"], primitives["py"]
    away = np.where(primitives["extent"] > 0, np.hypot(primitives["x"], primitives["y"]), np.hypot(x, y))
    full = primitives["extent"] > 0
    angle = np.where(full, np.arctan2(primitives["y"], primitives["x"]), np.arctan2(y, x))
    label = np.zeros(len(primitives), int)
    for value in (
        primitives["kind"],
        primitives["side"],
        primitives["extent"],
        primitives["length"],
        primitives["radius"],
        away,
    ):
        label = _split(label, np.asarray(value, float), tolerance)
    classes = []
    for number in np.unique(label):
        members = np.flatnonzero(label == number)
        members = members[np.argsort(angle[members], kind="stable")]
        classes.append((members, bool(away[members].max() <= tolerance)))
    return classes


def _split(label: NDArray[np.int64], value: Array, tolerance: float) -> NDArray[np.int64]:
    """Finer labels: within each label, values that a gap wider than `tolerance` parts get different ones."""
    order = np.lexsort((value, label))
    parted = (np.diff(value[order]) > tolerance) | (np.diff(label[order]) != 0)
    out = np.zeros_like(label)
    out[order] = np.concatenate([[0], np.cumsum(parted)]) if len(order) else order
    return out


def _divisors(number: int) -> list[int]:
    """Divisors above 1, largest first."""
    return [d for d in range(number, 1, -1) if number % d == 0]


def _mismatch(primitives: Records, ends: tuple[Array, Array], image: NDArray[np.int64], angle: float) -> Array:
    """How far each primitive, turned, may be from its image (an upper bound)."""
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, s], [-s, c]])
    apart = [np.hypot(*(points @ turn - points[image]).T) * (primitives["extent"] == 0) for points in ends]
    middle = np.stack([primitives["px"], primitives["py"]], axis=1)
    normal = np.stack([primitives["nx"], primitives["ny"]], axis=1)
    other = primitives[image]
    # Two arcs differ at most by their middles, their radii and their directions times the radius, both ends included.
    swing = np.hypot(*(normal @ turn - normal[image]).T) * primitives["radius"] * math.pi
    apart.append(np.hypot(*(middle @ turn - middle[image]).T) * (primitives["extent"] == 0))
    centre = np.stack([primitives["x"], primitives["y"]], axis=1)
    apart.append(np.hypot(*(centre @ turn - centre[image]).T) * (primitives["extent"] > 0))
    # Of a corner, the fan of its normals as well, as a length.
    fan = np.arctan2(primitives["half_sin"], primitives["half_cos"])
    turned = np.hypot(*(normal @ turn - normal[image]).T) + np.abs(fan - fan[image])
    apart.append(turned * primitives["length"] * (primitives["kind"] == CORNER))
    total = (
        np.sum(apart, axis=0)
        + np.where(primitives["extent"] > 0, 0.0, swing)
        + 2.0 * np.abs(primitives["radius"] - other["radius"])
    )
    return np.asarray(total)


Integers = NDArray[np.int64]


class AlikeContacts:
    """The contacts of one pair of bodies, renumbered as one of the two turns."""

    def __init__(self, primitives: Records, contacts: Records, pair: Any, near: Integers, body: int) -> None:
        """`near`: the contacts that can ever touch; the symmetry looked for is that of the primitives of `body` in them."""
        used, _ = named_rows(np.concatenate([contacts.a[near], contacts.b[near]]), len(primitives))
        used = used[primitives.body[used] == body]
        symmetry = turn_symmetry(primitives[used], 0.5 * float(pair.clearance))
        self.fold = symmetry.fold
        # Primitives of the body that do not share the symmetry, numbered as in the model.
        self.loose = used[symmetry.loose]
        if self.fold > 1:
            # Primitive i is, a part of a turn later, where image[i] is now: what holds now for image[i] holds then for i.
            before = np.arange(len(primitives))
            before[used[symmetry.image]] = used
            self._next, declared = _numbers_later(contacts[pair.start : pair.stop], before)
            if not declared[near - pair.start].all():
                self.fold = 1  # drawn alike, but not declared alike

    def later(self, ids: Integers) -> Integers:
        """The contacts (numbered from the pair's first) that are, a part of a turn later, where `ids` are now; fold > 1."""
        return self._next[ids]


def _numbers_later(part: Records, before: Integers) -> tuple[Integers, NDArray[np.bool_]]:
    """For each contact the number of that between the primitives `before` of its own, and whether there is one."""
    a, b, group = np.array(part.a), np.array(part.b), np.array(part.group)
    groups = int(group.max(initial=0)) + 1
    # One number for each contact; ascending, as contacts are sorted by a, b and group.
    names, wanted = (((x * len(before)) + y) * groups + group for x, y in ((a, b), (before[a], before[b])))
    number = np.minimum(np.searchsorted(names, wanted), len(names) - 1)
    return number, names[number] == wanted
