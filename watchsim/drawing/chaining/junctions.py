"""Which edge follows at this end?

Where two ends meet the answer is plain. Where more meet, edges that one entity draws in one go (a polyline, a spline)
continue each other; if more than two ends are left over then, nobody can know.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from watchsim.drawing.chaining.nodes import Nodes
from watchsim.drawing.content import Stroke


class Junctions(NamedTuple):
    """`partner` of every end that goes on; ends that are `loose`; ends that meet where the way is unclear, by node."""

    partner: dict[int, int]
    loose: tuple[int, ...]
    branches: dict[int, tuple[int, ...]]


def junctions(nodes: Nodes, strokes: Sequence[Stroke]) -> Junctions:
    """The continuation at every node; `strokes` are those the nodes were made of."""
    partner: dict[int, int] = {}
    loose: list[int] = []
    branches: dict[int, tuple[int, ...]] = {}
    for node, members in enumerate(nodes.members):
        ends = list(members) if len(members) <= 2 else _linked(members, strokes, partner)
        if len(ends) == 2:
            partner[ends[0]], partner[ends[1]] = ends[1], ends[0]
        elif len(ends) == 1:
            loose.append(ends[0])
        elif ends:
            branches[node] = tuple(ends)
    return Junctions(partner, tuple(loose), branches)


def _linked(members: Sequence[int], strokes: Sequence[Stroke], partner: dict[int, int]) -> list[int]:
    """Links the end of each stroke to the start of the next one of its run; the ends left over."""
    here = set(members)
    for end in sorted(members):
        following = end + 1
        if end % 2 == 1 and following in here and strokes[end // 2].run == strokes[following // 2].run:
            partner[end], partner[following] = following, end
            here -= {end, following}
    return sorted(here)
