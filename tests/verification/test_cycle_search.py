"""Does the search for the woodpecker's cycle find the fixed point of a made-up map, and how far is it from closing?"""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.verification.woodpecker import woodpecker_cycle as module
from watchsim.verification.woodpecker.toy import BEAK, LOWER, Toy
from watchsim.verification.woodpecker.woodpecker_cycle import Cycle, breaks_loose, find_cycle, one_peck

FIRST = np.array([0.7, -0.1, -0.3])  # where the section is met first: height and tilts


def moment(
    cause: str, contact: int, q: Any = FIRST, rate: float = 0.0, u: tuple[float, float] = (0.0, 0.0), t: float = 0.0
) -> Any:
    return SimpleNamespace(cause=cause, contact=contact, q=np.array(q), u=np.array([*u, rate]), t=t)


def cycle_of(
    monkeypatch: pytest.MonkeyPatch, after: Callable[[float], float], off: tuple[float, ...] = (0.0,) * 4
) -> tuple[Cycle, list[np.ndarray]]:
    """The peck after the rate x ends with the rate after(x); tilts and the sleeve's rates are off at its end."""
    begins: list[np.ndarray] = []

    def peck(model: object, q: np.ndarray, u: np.ndarray) -> list[Any]:
        begins.append(np.array([*q, *u]))
        end = (-5e-3, FIRST[1] + off[0], FIRST[2] + off[1])
        return [moment("start", -1), moment("slip", LOWER, end, after(float(u[2])), (off[2], off[3]), 0.15)]

    seen = [moment("impact", BEAK), moment("slip", LOWER, FIRST, -9.0), moment("slip", LOWER, FIRST, 5.0)]
    monkeypatch.setattr(module, "one_peck", peck)
    monkeypatch.setattr(module, "moments", lambda *_: iter(seen))
    return find_cycle(Toy()), begins


@pytest.mark.parametrize("slope", [-0.84, 0.5, 0.0])
def test_the_fixed_point_of_a_line_is_found_at_the_second_try(monkeypatch: pytest.MonkeyPatch, slope: float) -> None:
    cycle, begins = cycle_of(monkeypatch, lambda rate: -7.0 + slope * (rate + 7.0))
    assert begins[-1] == pytest.approx([0.0, *FIRST[1:], 0.0, 0.0, -7.0], abs=1e-12)
    assert begins[0][-1] == -9.0 and len(begins) <= 5
    assert (cycle.period, cycle.descent, cycle.gap) == (0.15, 5e-3, pytest.approx(0.0, abs=1e-13))
    assert cycle.slope == pytest.approx(slope, abs=1e-9)


def test_the_fixed_point_of_a_curve(monkeypatch: pytest.MonkeyPatch) -> None:
    cycle, begins = cycle_of(monkeypatch, lambda rate: -7.0 - 0.8 * (rate + 7.0) + 0.05 * (rate + 7.0) ** 2)
    assert begins[-1][-1] == pytest.approx(-7.0, abs=1e-12) and cycle.slope == pytest.approx(-0.8, abs=1e-2)
    assert cycle.gap < 1e-13


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("place", "off", "gap"), [(0, 2e-3, 2e-3), (1, 3e-3, 3e-3), (2, 4e-3, 0.04), (3, 5e-2, 5e-3)])
def test_how_far_it_is_from_closing(monkeypatch: pytest.MonkeyPatch, place: int, off: float, gap: float, sign: float) -> None:
    """Tilts in radians, the sleeve's rates over 0.1 m/s and 10 rad/s."""
    offs = tuple(sign * off if k == place else 0.0 for k in range(4))
    assert cycle_of(monkeypatch, lambda rate: -7.0, offs)[0].gap == pytest.approx(gap, rel=1e-9)


@pytest.mark.parametrize("drift", [0.3, -0.3])
def test_a_rate_that_does_not_come_back_counts_too(monkeypatch: pytest.MonkeyPatch, drift: float) -> None:
    """Over 10 rad/s, of the peck that is told: the third that is asked for."""
    rates = iter([-7.0, -7.0, -7.0 + drift])
    cycle, begins = cycle_of(monkeypatch, lambda rate: next(rates))
    assert len(begins) == 3 and cycle.gap == pytest.approx(0.03, rel=1e-9)


def test_a_peck_ends_where_the_lower_edge_gives_way_again(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = [moment("slip", LOWER), moment("slip", BEAK), moment("open", LOWER), moment("slip", LOWER), moment("impact", BEAK)]
    asked: list[float] = []

    def moments(model: object, e: object, v: object, until: float) -> Any:
        asked.append(until)
        return iter(seen)

    monkeypatch.setattr(module, "moments", moments)
    model: Any = SimpleNamespace(into=lambda vector: vector)
    assert one_peck(model, FIRST, FIRST) == seen[:4] and asked[0] > 0.3  # more than two pecks
    assert [breaks_loose(one) for one in seen] == [True, False, False, True, False]
