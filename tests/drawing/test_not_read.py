"""Is it said of everything that was not read whether it matters, and why?"""

from __future__ import annotations

import pytest

from watchsim.drawing import dxf as left_out
from watchsim.drawing import svg as unread_elements

WARNED = "no type of entity known here; the file may be damaged"


@pytest.mark.parametrize(
    ("kind", "severity", "why", "what_to_do"),
    [
        ("MTEXT", "notice", "it is not an outline", ""),
        ("HATCH", "notice", "it is not an outline", ""),
        ("3DFACE", "warning", "", "Draw it with lines and arcs where it matters."),
        ("HELIX", "warning", "", "Draw it with lines and arcs where it matters."),
        ("LIME", "warning", WARNED, ""),
    ],
)
def test_entities(kind: str, severity: str, why: str, what_to_do: str) -> None:
    found = left_out._ignored(kind, 3)
    assert (found.severity, found.message) == (severity, f"3 × {kind} not read{f': {why}' if why else ''}")
    assert found.fix == what_to_do


@pytest.mark.parametrize(
    ("kind", "severity", "why"),
    [
        ("text", "notice", "it is not an outline"),
        ("animateMotion", "warning", "it moves"),
        ("animateTransform", "warning", "it moves"),
        ("crcle", "warning", "no element known here; the file may be damaged"),
    ],
)
def test_elements(kind: str, severity: str, why: str) -> None:
    found = unread_elements._ignored(kind, 2)
    assert (found.severity, found.message) == (severity, f"2 × {kind} not read: {why}")
