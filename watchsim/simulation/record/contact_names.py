"""What are the contacts of a run called, for people?

A pair is put into words when it is looked at: a run may declare millions, and has events at a few of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import NDArray

from watchsim.mechanism.compile import Compiled
from watchsim.model.records import KIND_WORD


@dataclass(frozen=True)
class Pair:
    """The two primitives of a contact, for people: bodies, layers, a word for each primitive and its index in the body."""

    group: int  # index in scene.contacts
    body_a: str
    primitive_a: str  # "corner", "arc", "line"
    index_a: int
    layer_a: str
    body_b: str
    primitive_b: str
    index_b: int
    layer_b: str

    def __str__(self) -> str:
        return (
            f"{self.body_a}.{self.layer_a} {self.primitive_a} {self.index_a} / "
            f"{self.body_b}.{self.layer_b} {self.primitive_b} {self.index_b}"
        )


Named = tuple[str, str, int, str]  # one primitive: body, word, index and layer, as in `Pair`


class Pairs(Sequence[Pair]):
    """All contacts of a run; read like a tuple of `Pair`, and equal to one with the same pairs.

    `names` are the primitives; row k of `table` holds group, number of the one primitive and of the other of contact k.
    """

    def __init__(self, names: Sequence[Named], table: NDArray[np.int32]) -> None:
        self.names, self.table = tuple(names), table
        self.table.flags.writeable = False

    def __len__(self) -> int:
        return len(self.table)

    @overload
    def __getitem__(self, index: int) -> Pair: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Pair, ...]: ...
    def __getitem__(self, index: int | slice) -> Pair | tuple[Pair, ...]:
        if isinstance(index, slice):
            return tuple(self._made(self.table[index]))
        group, a, b = self.table[index].tolist()
        return Pair(group, *self.names[a], *self.names[b])

    def __iter__(self) -> Iterator[Pair]:
        return self._made(self.table)

    def _made(self, table: NDArray[np.int32]) -> Iterator[Pair]:
        # Plain numbers, some at a time: reading one of an array takes a tenth of a microsecond.
        for start in range(0, len(table), 4096):
            for group, a, b in table[start : start + 4096].tolist():
                yield Pair(group, *self.names[a], *self.names[b])

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Pairs) and self.names == other.names:
            return np.array_equal(self.table, other.table)
        if isinstance(other, (Pairs, tuple)):
            return len(self) == len(other) and all(one == two for one, two in zip(self, other, strict=True))
        return NotImplemented

    def __hash__(self) -> int:
        return hash(tuple(self))

    def __repr__(self) -> str:
        return f"<{len(self)} pairs of primitives>"

    def of_body(self, name: str) -> NDArray[np.bool_]:
        """For each pair: is that body on either side of it?"""
        own = np.array([body == name for body, *_ in self.names], bool)
        return np.asarray(own[self.table[:, 1]] | own[self.table[:, 2]])


def pairs_of(compiled: Compiled) -> Pairs:
    """The contacts of a model in words; row k belongs to contact number k."""
    model, owners = compiled.model, compiled.owners
    first = {name: owners.index(name) for name in dict.fromkeys(owners)}
    # A plain list: reading a field of a record array takes a microsecond each time.
    kinds = model.primitives.kind.tolist()
    sides = zip(owners, kinds, compiled.layers, strict=True)
    names = [(owner, KIND_WORD[kind], i - first[owner], layer) for i, (owner, kind, layer) in enumerate(sides)]
    contacts = model.contacts
    table = np.empty((len(contacts), 3), np.int32)
    table[:, 0], table[:, 1], table[:, 2] = contacts.group, contacts.a, contacts.b
    return Pairs(names, table)


def as_pairs(pairs: Sequence[Pair]) -> Pairs:
    """The same pairs, however they are kept."""
    if isinstance(pairs, Pairs):
        return pairs
    numbers: dict[Named, int] = {}
    rows: list[tuple[int, ...]] = []
    for pair in pairs:
        first = (pair.body_a, pair.primitive_a, pair.index_a, pair.layer_a)
        second = (pair.body_b, pair.primitive_b, pair.index_b, pair.layer_b)
        rows.append((pair.group, *(numbers.setdefault(side, len(numbers)) for side in (first, second))))
    return Pairs(list(numbers), np.array(rows, np.int32).reshape(-1, 3))
