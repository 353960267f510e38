"""Which contacts are alike when a body has turned by a part of a turn that brings its outline back onto itself?"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.named_rows import named_rows
from watchsim.candidates.symmetry import turn_symmetry
from watchsim.model.records import Records

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
