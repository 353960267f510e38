"""How is a number compared with what it should be?"""

from __future__ import annotations

from typing import Any

Row = dict[str, Any]


def compared(name: str, quantity: str, expected: float, got: float, tolerance: float, source: str) -> Row:
    """One row, with its error (relative to `expected`, absolute where that is zero) and verdict."""
    expected, got = expected + 0.0, got + 0.0  # no negative zero
    error = abs(got - expected) / (abs(expected) if expected else 1.0)
    return {
        "name": name,
        "quantity": quantity,
        "expected": expected,
        "got": got,
        "error": error,
        "tolerance": tolerance,
        "ok": bool(error <= tolerance),
        "source": source,
    }
