"""What does `watchsim verify` simulate, and which numbers must come out? Nothing is run."""

from collections.abc import Callable, Iterator
from dataclasses import astuple, fields
from functools import partial
from pathlib import Path
from typing import Any

from records.wording import said

from watchsim.verification.benchmarks import Benchmark, inclines, swings
from watchsim.verification.hard_cases import edge_cases, hard_cases
from watchsim.verification.repeated_impacts import repeated_impacts

MAKERS: tuple[Callable[[], list[Benchmark]], ...] = (inclines, swings, hard_cases, repeated_impacts, edge_cases)


def records() -> dict[str, Callable[[Path], str]]:
    """By the name of the benchmark."""
    return {case.name: partial(of_benchmark, maker, k) for maker in MAKERS for k, case in enumerate(maker())}


def of_benchmark(maker: Callable[[], list[Benchmark]], number: int, _: Path) -> str:
    """The scene, as far as it is not what scenes are by default, and the checks."""
    case = maker()[number]
    lines = [f"source: {case.source}", *_told(case.scene, "scene")]
    for body in case.scene.bodies:
        lines += _told(body, body.name)
        for place, loop in enumerate(body.loops):
            lines += [f"{body.name}.loop {place}: {'closed' if loop.closed else 'open'}{', a hole' if loop.hole else ''}"]
            lines += [line for edge in loop.edges for line in said(astuple(edge), f"  {type(edge).__name__}")]
    for check in case.checks:
        lines += [f"{check.quantity}: {check.expected:.10g}, allowed {check.tolerance:.3g}"]
    return "\n".join(lines) + "\n"


def _told(whole: Any, name: str) -> Iterator[str]:
    for field in fields(whole):
        value = getattr(whole, field.name)
        if field.compare and field.name not in ("bodies", "loops", "folder", "source") and value != field.default:
            yield from said(value, f"{name}.{field.name}")
