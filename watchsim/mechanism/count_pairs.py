"""How many pairs of primitives are declared between two bodies, how many can ever touch, how many are candidates at a time?"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.candidates.cell_table import PairCells
from watchsim.candidates.named_rows import named_rows
from watchsim.mechanism.compile import Compiled
from watchsim.mechanism.pair_table import PairCount

Integers = NDArray[np.int64]


class ModelledPairs(NamedTuple):
    """What a scene declares and what of it matters."""

    counts: tuple[PairCount, ...]
    reachable: Integers  # primitives (rows of the model) of which some pair can ever touch
    candidates: Integers  # those among them of which some pair is a candidate at the start


def modelled_pairs(compiled: Compiled, names: Sequence[str]) -> ModelledPairs:
    """Count all pairs of bodies of a compiled scene; `names` are those of its bodies, in order."""
    model = compiled.model
    counts, here = [], [np.zeros(0, np.int64)]
    for p, pair in enumerate(model.pairs):
        near = model.near[pair.near_start : pair.near_stop]
        around, at_start = np.array([len(near)]), near
        if pair.listed:
            cells = PairCells(model, p)
            at_start = cells.here(compiled.q)
            _, around, _ = cells.around(compiled.q)
            if not len(around):  # beyond the cells
                around = np.array([len(at_start)])
        here.append(at_start)
        bodies = (_named(compiled, pair, pair.a, names), _named(compiled, pair, pair.b, names))
        declared = int(pair.stop - pair.start)
        counts.append(PairCount(bodies, declared, len(near), round(float(np.median(around))), int(around.max()), len(at_start)))
    return ModelledPairs(tuple(counts), _primitives(compiled, model.near), _primitives(compiled, np.concatenate(here)))


def _primitives(compiled: Compiled, contacts: Integers) -> Integers:
    """The primitives of some contacts, each once."""
    declared = compiled.model.contacts
    return named_rows(np.concatenate([declared.a[contacts], declared.b[contacts]]), len(compiled.model.primitives))[0]


def _named(compiled: Compiled, pair: Any, body: int, names: Sequence[str]) -> str:
    """What the scene calls one side of a pair: outlines fixed on a moving body keep the name of the part they belong to."""
    contacts, primitives = compiled.model.contacts[pair.start : pair.stop], compiled.model.primitives
    rows, _ = named_rows(np.concatenate([contacts.a, contacts.b]), len(primitives))
    owners = [compiled.owners[row] for row in rows if primitives.body[row] == body]
    return ", ".join(dict.fromkeys(owners)) or names[body]
