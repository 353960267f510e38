"""How many pairs of primitives of two bodies have to be looked at?"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

HEADINGS = {"declared": "declared", "reachable": "can ever touch", "typical": "candidates at a time"}


class PairCount(NamedTuple):
    """Numbers of pairs of primitives between two bodies."""

    bodies: tuple[str, str]
    declared: int
    reachable: int  # at any pose
    typical: int  # candidates: the median over the cells of configuration space around the start position
    most: int  # the largest number there
    start: int  # in the cell of the start position itself

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {**self._asdict(), "bodies": list(self.bodies)}


def pairs_entry(counts: Sequence[PairCount]) -> dict[str, Any]:
    """The `pairs` of `check --json`: sums, and the numbers `between` two bodies."""
    sums = {name: sum(getattr(count, name) for count in counts) for name in HEADINGS}
    return {**sums, "between": [count.as_dict() for count in counts]}


def pair_lines(entry: Mapping[str, Any]) -> Iterator[str]:
    """The same as a table for people, in which only two pairs of bodies or more need a sum."""
    rows = [(" - ".join(count["bodies"]), count) for count in entry["between"]]
    if not rows:
        yield "pairs of edges and corners: no contact is declared"
        return
    rows += [("together", entry)] if len(rows) > 1 else []
    title = "pairs of edges and corners"
    width = max(len(title), *(2 + len(name) for name, _ in rows))
    yield f"{title:{width}}" + "".join(f"   {heading}" for heading in HEADINGS.values())
    for name, numbers in rows:
        cells = (f"   {numbers[key]:>{len(heading)},}" for key, heading in HEADINGS.items())
        yield f"{'  ' + name:{width}}" + "".join(cells)
