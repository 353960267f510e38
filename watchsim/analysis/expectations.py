"""What does a run say to the expectations of its scene?

Keys are watch quantities (amplitude, rate, period, beat_error, frequency) or dotted names of the summary, such as
"bodies.disc.x_m" or "energy.residual_relative". Units come from the ends of these names.
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping, Sequence
from typing import Any

from watchsim.scene.keys import ALIKE
from watchsim.scene.read_settings import FUNCTION
from watchsim.scene.scene import Expectation
from watchsim.units import known_unit

WATCH_KEYS = {
    "amplitude": "amplitude_deg",
    "rate": "rate_s_per_d",
    "period": "period_s",
    "beat_error": "beat_error_ms",
    "frequency": "frequency_hz",
    **{name: f"function.{name}_deg" for name in FUNCTION},
}
# Longest first: "_s_per_d" must not pass for "_d".
ENDINGS = {
    **{"_rad_per_s": "rad/s", "_m_per_s": "m/s", "_s_per_d": "s/d"},
    **{"_deg": "°", "_rad": "rad", "_vph": "vph", "_hz": "Hz", "_ms": "ms", "_s": "s", "_m": "m", "_J": "J"},
}
ERROR = "_error"
KNOWN = f"Known names: {', '.join(WATCH_KEYS)} and the names in summary.json."
MOST_ADVISED = 20  # wrong keys for which a similar one is looked for: each takes a hundredth of a second


def judged(expectations: Sequence[Expectation], numbers: Mapping[str, Any]) -> list[dict[str, Any]]:
    """{key, expected, tolerance, got, ok, unit, message} of each, in the unit of the promise; `message`: why `got` is None."""
    known = dict(_numbers(numbers))
    return [_judged(expectation, known) for expectation in expectations]


def _judged(expectation: Expectation, known: Mapping[str, float | None]) -> dict[str, Any]:
    got, message = _found(expectation, known)
    low, high = expectation.bounds
    if got is not None and expectation.low is expectation.high:
        ok: bool | None = abs(got - expectation.value) <= expectation.tolerance
    else:
        ok = got is not None and low <= got <= high
    return {
        "key": expectation.key,
        "expected": expectation.value,
        "tolerance": expectation.tolerance,
        **({} if expectation.low is expectation.high else {"min": expectation.low, "max": expectation.high}),
        "got": got,
        "ok": None if expectation.key in FUNCTION else ok,
        "unit": expectation.unit,
        "message": message,
    }


def not_judged(entry: Mapping[str, Any], changed: Sequence[str]) -> dict[str, Any]:
    """An entry of `judged` without a verdict (`ok` is null): options made the run another than the scene's own."""
    return {**entry, "ok": None, "message": f"not checked: changed by {' and '.join(changed)}"}


def unit_of(name: str) -> str:
    """The unit a dotted name of the summary ends with; "" for plain numbers."""
    if name.startswith("energy.dissipated."):
        return "J"
    last = name.removesuffix(ERROR)
    return next((unit for ending, unit in ENDINGS.items() if last.endswith(ending)), "")


def mistakes(expectations: Sequence[Expectation], numbers: Mapping[str, Any]) -> list[str]:
    """Of each what is wrong with the key or the unit, whatever the run; "" for nothing. What is null may hold numbers later."""
    known = dict(_numbers(numbers))
    found: list[str] = []
    wrong = 0
    for expectation in expectations:
        found.append(_mistake(expectation, known, advised=wrong < MOST_ADVISED))
        wrong += bool(found[-1])
    return found


def _mistake(expectation: Expectation, known: Mapping[str, float | None], advised: bool = True) -> str:
    name = _name(expectation)
    if name not in known and expectation.key not in FUNCTION and not _within_null(name, known):
        return f'"{expectation.key}" is not a number in the results. {_advice(expectation.key, known) if advised else KNOWN}'
    source = unit_of(name)
    if expectation.unit and known_unit(source).powers != known_unit(expectation.unit).powers:
        return f'"{expectation.key}" is in {source or "plain numbers"}, which cannot be compared with {expectation.unit}'
    return ""


def _within_null(name: str, known: Mapping[str, float | None]) -> bool:
    """Whether something above the dotted name is null, and may hold numbers in another run."""
    parts = name.split(".")
    return any(known.get(".".join(parts[:k]), 0.0) is None for k in range(1, len(parts)))


def _name(expectation: Expectation) -> str:
    return WATCH_KEYS.get(expectation.key, expectation.key)


def _found(expectation: Expectation, known: Mapping[str, float | None]) -> tuple[float | None, str]:
    """The number in the expectation's unit, or None and what is wrong."""
    if message := _mistake(expectation, known):
        return None, message
    value = known.get(_name(expectation))
    if expectation.key in FUNCTION:
        return None, "not checked: watchsim tolerance measures the geometry of function"
    if value is None:
        return None, f'this run gives no "{expectation.key}"'
    if not expectation.unit:
        return value, ""
    return value * known_unit(unit_of(_name(expectation))).factor / known_unit(expectation.unit).factor, ""


def _numbers(mapping: Mapping[str, Any], above: str = "") -> list[tuple[str, float | None]]:
    """(dotted name, value) of all numbers and of what is null."""
    found: list[tuple[str, float | None]] = []
    for key, value in mapping.items():
        name = f"{above}{key}"
        if isinstance(value, Mapping):
            found += _numbers(value, f"{name}.")
        elif value is None:
            found.append((name, None))
        elif isinstance(value, (int, float)):
            found.append((name, float(value) if math.isfinite(value) else None))
    return found


def _advice(key: str, known: Mapping[str, Any]) -> str:
    names = [*WATCH_KEYS, *known]
    near = difflib.get_close_matches(key, names, n=1, cutoff=ALIKE)
    return f'Did you mean "{near[0]}"?' if near else KNOWN
