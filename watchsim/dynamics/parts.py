"""Which contacts of a problem have nothing to do with each other?

Bodies that share no contact, directly or through others, do not feel each other's forces: the matrix falls into blocks, and
each block is a problem of its own. Solved together, the pivots of one would depend on rounding in another.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.jit import by_reference, kernel

Array = NDArray[np.float64]
Integers = NDArray[np.int64]


class Parts(NamedTuple):
    """The whole problem while its parts are solved in the arrays of `ContactWork`."""

    A: Array
    rhs: Array
    x: Array
    is_active: Integers  # by unknown: the basis of the solution
    block: Integers  # by element
    width: Array  # by element
    label: Integers  # by unknown: its part
    picked: Integers  # unknowns of the part at hand
    place: Integers  # by block: its number in the part


PartsRef = by_reference(Parts, __name__)


def parts_of(side: int, blocks: int) -> Parts:
    """Room for problems of up to `side` unknowns."""
    return Parts(
        A=np.zeros((side, side)),
        rhs=np.zeros(side),
        x=np.zeros(side),
        is_active=np.zeros(side, np.int64),
        block=np.zeros(blocks, np.int64),
        width=np.zeros(blocks),
        label=np.zeros(side, np.int64),
        picked=np.zeros(side, np.int64),
        place=np.zeros(blocks, np.int64),
    )


@kernel
def label_parts(work, n):
    """Number the parts of the problem in `work.A` into `label`; returns how many there are."""
    label, waiting = work.parts.label, work.parts.picked
    for i in range(n):
        label[i] = -1
    count = 0
    for first in range(n):
        if label[first] >= 0:
            continue
        label[first], waiting[0], left = count, first, 1
        while left > 0:
            left -= 1
            i = waiting[left]
            for j in range(n):
                if label[j] < 0 and (work.A[i, j] != 0.0 or work.A[j, i] != 0.0):
                    label[j], waiting[left] = count, j
                    left += 1
        count += 1
    return count


@kernel
def spare_parts(work, m, elements, slow):
    """Take away the approaches, all rounding, of the parts of an impact in which no contact approaches faster than `slow`.

    `work.b` holds the rates of the gaps, `work.rhs` the same scaled.
    """
    parts = label_parts(work, m + 2 * elements)
    if parts <= 1:
        return
    for part in range(parts):
        fastest = 0.0
        for i in range(m):
            if work.parts.label[i] == part:
                fastest = max(fastest, -work.b[2 * i])
        if fastest <= slow:
            for i in range(m):
                if work.parts.label[i] == part:
                    work.rhs[i] = max(work.rhs[i], 0.0)


@kernel
def keep_whole(work, n, elements):
    """Keep the whole problem."""
    whole = work.parts
    for i in range(n):
        whole.rhs[i] = work.rhs[i]
        for j in range(n):
            whole.A[i, j] = work.A[i, j]
    for e in range(elements):
        whole.block[e], whole.width[e] = work.block[e], work.width[e]


@kernel
def take_part(work, m, elements, part):
    """Bring one part into the arrays of `work`; returns its numbers of contacts and elements."""
    whole = work.parts
    contacts, held = 0, 0
    for i in range(m):
        if whole.label[i] == part:
            whole.picked[contacts], whole.place[i] = i, contacts
            contacts += 1
    for e in range(elements):
        if whole.label[m + e] == part:
            block = whole.block[e]
            # A bearing comes after all contacts.
            work.block[held] = whole.place[block] if block < m else contacts
            work.width[held] = whole.width[e]
            whole.picked[contacts + held] = m + e
            held += 1
    for h in range(held):
        whole.picked[contacts + held + h] = whole.picked[contacts + h] + elements
    size = contacts + 2 * held
    for i in range(size):
        work.rhs[i] = whole.rhs[whole.picked[i]]
        for j in range(size):
            work.A[i, j] = whole.A[whole.picked[i], whole.picked[j]]
    return contacts, held


@kernel
def put_part(work, contacts, held):
    """The solution of the part just solved, into the whole one."""
    whole = work.parts
    for i in range(contacts + 2 * held):
        whole.x[whole.picked[i]], whole.is_active[whole.picked[i]] = work.x[i], work.lcp.is_active[i]


@kernel
def restore_whole(work, n, elements):
    """The whole problem and its solution, back into the arrays of `work`."""
    whole = work.parts
    for i in range(n):
        work.rhs[i], work.x[i], work.lcp.is_active[i] = whole.rhs[i], whole.x[i], whole.is_active[i]
        for j in range(n):
            work.A[i, j] = whole.A[i, j]
    for e in range(elements):
        work.block[e], work.width[e] = whole.block[e], whole.width[e]
