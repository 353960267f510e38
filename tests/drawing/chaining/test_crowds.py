"""Are drawings whose parts lie over each other in masses answered soon, in little memory, with the reason?"""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable

import dxf_text as d
import pytest

from watchsim.drawing import chaining as nesting
from watchsim.drawing.chaining import chain
from watchsim.drawing.drawing import Drawing
from watchsim.drawing.findings import Stroke
from watchsim.geometry import loops as near_edges
from watchsim.geometry.loops import table_of
from watchsim.geometry.primitives import TURN, Arc

MEGABYTE = 1 << 20


def heap(count: int, spacing: float) -> list[Stroke]:
    """Circles of a millimetre, `spacing` metres apart in one row."""
    return [Stroke(Arc(spacing * k, 0.0, 1e-3, 0.0, TURN), "0", "CIRCLE", k) for k in range(count)]


@pytest.mark.slow
def test_a_heap_of_circles_takes_no_more_memory_than_its_limits_allow(monkeypatch: pytest.MonkeyPatch) -> None:
    """All 3000 of them cross all others: 4.5 million pairs, each with two points."""
    monkeypatch.setattr(near_edges, "MOST_PAIRS", 50_000)
    monkeypatch.setattr(nesting, "MOST", 200_000)
    monkeypatch.setattr(nesting, "AT_ONCE", 30_000)
    strokes = heap(3000, 1e-7)
    chain(strokes[:1000], 1e-6)  # imports what it needs
    tracemalloc.start()
    chains = chain(strokes, 1e-6)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 150 * MEGABYTE
    assert len(chains.loops) == 3000
    found = {(finding.code, finding.severity) for finding in chains.findings}
    assert {("crossing", "error"), ("crowded", "error"), ("crowded", "warning")} <= found


def test_the_crowd_that_took_all_the_room_is_named_and_no_other_place(monkeypatch: pytest.MonkeyPatch) -> None:
    """40 circles over each other and, far away, 60."""
    monkeypatch.setattr(near_edges, "MOST_PAIRS", 1000)
    most = [Arc(0.1 + 1e-7 * k, 0.1, 1e-3, 0.0, TURN) for k in range(60)]
    table = table_of([stroke.edge for stroke in heap(40, 1e-7)] + most)
    crowds = near_edges.near_pairs(table, 1e-6).crowds
    assert crowds
    assert all(abs(x - 0.1) < 5e-3 and abs(y - 0.1) < 5e-3 for x, y in crowds), crowds


def test_rings_in_rings_are_told_apart_in_parts(read_bytes: Callable[..., Drawing], monkeypatch: pytest.MonkeyPatch) -> None:
    """400 rings round one centre, more pairs than are looked at in one go."""
    monkeypatch.setattr(nesting, "AT_ONCE", 5000)
    drawing = read_bytes(d.dxf("".join(d.circle(0, 0, 1 + 0.01 * k) for k in range(400))))
    assert all(finding.severity != "error" for finding in drawing.findings)
    assert [loop.hole for loop in drawing.loops] == [k % 2 == 0 for k in range(400)]
