"""How is a record of runs kept, and what has moved against it?

A text of blocks: [name of the run], then a line for each quantity with its numbers and how far a run may be off
(`1.5±2e-12`), a line with all counts that are not zero (`steps 7, evaluations 98±6`; `rows ?`: differs by chance), and one
with bounds.

How far a run may be off comes from copies of it, changed by what rounding elsewhere may come to.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from recorded_scenes import Told

PLACE = Path(__file__).with_name("recorded_runs.txt")
COUNTS, WORST = "counts", "at most"
MARGIN = 20.0  # times the scatter of the copies
COUNT_MARGIN = 3  # the same for counts
ROUNDING = 1e-12  # of the largest number of a line: so far a number may be off though the copies agree
OF_ALL = 1e-14  # of the largest number of its kind: the same for what stands still
LEAST_BOUND = 1e-15
CHAOTIC = 1e-8  # of the largest of its kind: copies that differ by more have forgotten their start
LOOSE = 0.1  # of a count: where copies differ by more, nothing is said


@dataclass(frozen=True)
class Recorded:
    """What a run must come to: each number with how far it may be off; counts that differ by chance have None."""

    values: dict[str, list[tuple[float, float]]]
    counts: dict[str, tuple[int, int] | None]
    worst: list[float]


def recorded_of(told: Told, copies: Sequence[Told]) -> Recorded | None:
    """A run with its margins; None where its copies have come apart."""
    counts: dict[str, tuple[int, int] | None] = {}
    for name, count in told.counts.items():
        off = max(abs(copy.counts[name] - count) for copy in copies)
        counts[name] = None if off > LOOSE * abs(count) else (count, COUNT_MARGIN * off)
    values = {}
    for name, numbers in told.values.items():
        if name in counts and (counts[name] is None or counts[name][1] != 0):
            continue  # sums over events that differ by chance
        kind = max((abs(x) for other, all_ in told.values.items() if other[0] == name[0] for x in all_), default=0.0)
        floor = ROUNDING * max(map(abs, numbers), default=0.0) + OF_ALL * kind
        scatter = [max(abs(copy.values[name][i] - x) for copy in copies) for i, x in enumerate(numbers)]
        if name[0] in "qu" and max(scatter) > CHAOTIC * kind:
            return None
        values[name] = [(x, MARGIN * off + floor) for x, off in zip(numbers, scatter, strict=True)]
    worst = [COUNT_MARGIN * max(one.worst[i] for one in (told, *copies)) + LEAST_BOUND for i in range(len(told.worst))]
    return Recorded(values, counts, worst)


def moved(told: Told, kept: Recorded) -> list[str]:
    """In words, what differs from the record by more than it may."""
    found = []
    for name, numbers in kept.values.items():
        for (was, off), x in zip(numbers, told.values[name], strict=True):
            if not abs(x - was) <= off:
                found.append(f"{name} {was:.12g} -> {x:.12g} ({abs(x - was):.2g} off, {off:.2g} allowed)")
    for name, count in told.counts.items():
        was_count = kept.counts.get(name, (0, 0))
        if was_count is not None and abs(count - was_count[0]) > was_count[1]:
            found.append(f"{name} {was_count[0]} -> {count} (±{was_count[1]} allowed)")
    for bound, x in zip(kept.worst, told.worst, strict=True):
        if not x <= bound:
            found.append(f"{WORST} {bound:.3g}, is {x:.3g}")
    return found


def written(records: Mapping[str, Recorded]) -> str:
    blocks = ["# Written by scripts/record_runs.py; record_file.py says what stands here.\n"]
    for run, kept in records.items():
        lines = [f"[{run}]"]
        lines += [
            f"{name}: {' '.join(map(_number, numbers))}" for name, numbers in kept.values.items() if any(map(any, numbers))
        ]
        lines.append(f"{COUNTS}: {', '.join(f'{name} {_count(n)}' for name, n in kept.counts.items() if n != (0, 0))}")
        lines.append(f"{WORST}: {' '.join(f'{x:.2g}' for x in kept.worst)}")
        blocks.append("\n".join(lines) + "\n")
    return "\n".join(blocks)


def read(path: Path = PLACE) -> dict[str, Recorded]:
    """The record; what is not named was zero."""
    found: dict[str, Recorded] = {}
    values: dict[str, list[tuple[float, float]]] = {}
    counts: dict[str, tuple[int, int] | None] = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith("["):
            run, values, counts = line[1:-1], {}, {}
        elif line.startswith(f"{COUNTS}: "):
            for entry in line.split(": ", 1)[1].split(", "):
                name, text = entry.rsplit(" ", 1)
                count, _, off = text.partition("±")
                counts[name] = None if text == "?" else (int(count), int(off or 0))
        elif line.startswith(f"{WORST}: "):
            found[run] = Recorded(values, counts, [float(x) for x in line.split(": ", 1)[1].split()])
        elif ": " in line and not line.startswith("#"):
            name, _, rest = line.partition(": ")
            values[name] = [(float(x), float(off or 0.0)) for x, _, off in (text.partition("±") for text in rest.split())]
    return found


def _number(entry: tuple[float, float]) -> str:
    return f"{entry[0]:.15g}±{entry[1]:.2g}" if entry[1] else f"{entry[0]:.15g}"


def _count(entry: tuple[int, int] | None) -> str:
    return "?" if entry is None else f"{entry[0]}±{entry[1]}" if entry[1] else str(entry[0])
