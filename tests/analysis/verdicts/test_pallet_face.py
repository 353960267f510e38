"""Is a tooth found on the same face of the same pallet wherever the movement stands?"""

from __future__ import annotations

import cmath
import math
from types import SimpleNamespace
from typing import Any

import pytest

from watchsim.analysis.verdicts.faces import Face, face
from watchsim.analysis.verdicts.tooth_lean import Teeth

PITCH = math.tau / 15


def told(point: complex, arm: float, shift: complex, turned: float) -> Face:
    """Wheel at the origin, lever 4 mm above it, all turned and then shifted."""
    turn = cmath.exp(1j * turned)
    wheel, lever, at = (turn * place + shift for place in (0j, 4e-3j, point))
    places = {"wheel": (wheel.real, wheel.imag, turned), "lever": (lever.real, lever.imag, turned)}
    found: Any = SimpleNamespace(
        places=places, point=[SimpleNamespace(tolist=lambda: [at.real, at.imag])], of=lambda *_: (arm, 0.0)
    )
    watch: Any = SimpleNamespace(wheel="wheel", lever="lever", direction=-1.0, teeth=Teeth(PITCH, 0.1 * PITCH, 0.0))
    return face(watch, found, 0)


@pytest.mark.parametrize("shift", [0j, 7e-3 - 3e-3j, -2e-3 + 9e-3j])
@pytest.mark.parametrize("turned", [0.0, 0.7, -2.5])
@pytest.mark.parametrize(("angle", "pallet", "way"), [(114.0, "entry", -1.0), (66.0, "exit", 1.0)])
def test_wherever_it_stands(shift: complex, turned: float, angle: float, pallet: str, way: float) -> None:
    """A clockwise wheel reaches the entry pallet, on the left, first; clockwise, the lever takes the left arm out."""
    point = 2.5e-3 * cmath.exp(1j * math.radians(angle))
    tooth = round(angle / 24.0) % 15 + 1
    reach = abs(point - 4e-3j)
    for share, impulse in ((0.0, False), (-1.0, False), (0.045, False), (0.055, True), (1.0, True)):
        assert told(point, share * way * reach, shift, turned) == Face(tooth, pallet, impulse, way)


def test_on_the_line_of_centres_a_tooth_has_passed_the_entry_pallet() -> None:
    assert told(2.5e-3j, 0.0, 0j, 0.0).pallet == "exit"


@pytest.mark.parametrize(("tooth", "which"), [(7, "tooth 7"), (None, "a tooth")])
@pytest.mark.parametrize(("impulse", "kind"), [(True, "impulse"), (False, "locking")])
def test_in_words(tooth: int | None, which: str, impulse: bool, kind: str) -> None:
    assert str(Face(tooth, "exit", impulse, 1.0)) == f"{which} rests on the exit {kind} face"
