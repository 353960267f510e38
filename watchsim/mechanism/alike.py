"""Which contacts are alike when a body has turned by a part of a turn that brings its outline back onto itself?"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.model import Records
from watchsim.mechanism.symmetry import turn_symmetry

Integers = NDArray[np.int64]


class AlikeContacts:
    """The contacts of one pair of bodies, renumbered as one of the two turns."""

    def __init__(self, primitives: Records, contacts: Records, pair: Any, near: Integers, body: int) -> None:
        """`near`: the contacts that can ever touch; the symmetry looked for is that of the primitives of `body` in them."""
        part = contacts[pair.start : pair.stop]
        used = np.unique(np.concatenate([contacts.a[near], contacts.b[near]]))
        used = used[primitives.body[used] == body]
        self._a, self._b, self._group = part.a, part.b, part.group
        self._many, self._groups = len(primitives), int(part.group.max(initial=0)) + 1
        self._names = self._name(part.a, part.b, part.group)
        symmetry = turn_symmetry(primitives[used], 0.5 * float(pair.clearance))
        # Primitive i is, a part of a turn later, where image[i] is now: what holds now for image[i] holds then for i.
        before = np.arange(self._many)
        before[used[symmetry.image]] = used
        self.fold, self._before = symmetry.fold, before
        # Primitives of the body that do not share the symmetry, numbered as in the model.
        self.loose = used[symmetry.loose]
        there = np.flatnonzero(np.isin(np.arange(pair.start, pair.stop), near))
        names = self._name(before[part.a[there]], before[part.b[there]], part.group[there])
        if not np.isin(names, self._names).all():
            self.fold = 1  # drawn alike, but not declared alike

    def later(self, ids: Integers, parts: int) -> Integers:
        """The contacts (numbered from the pair's first) that are, `parts` parts of a turn later, where `ids` are now."""
        before = np.arange(self._many)
        for _ in range(parts):
            before = self._before[before]
        names = self._name(before[self._a[ids]], before[self._b[ids]], self._group[ids])
        return np.searchsorted(self._names, names)

    def _name(self, a: Integers, b: Integers, group: Integers) -> Integers:
        """One number for each contact; ascending, as contacts are sorted by a, b and group."""
        return np.asarray((a * self._many + b) * self._groups + group)
