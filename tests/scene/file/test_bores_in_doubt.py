"""Which bores is it worth saying that they are in doubt?"""

from __future__ import annotations

import itertools
from typing import Any

import pytest

from watchsim.drawing.circles import Lie
from watchsim.geometry.loops import Loop
from watchsim.scene.read_bores import _doubtful


@pytest.mark.parametrize(
    ("outlines", "holes", "crosses", "around", "meets"),
    list(itertools.product((0, 1, 2), (0, 1), (None, (0.0, 0.0)), (None, False, True), (None, (1, (0.0, 0.0))))),
)
def test_what_crosses_or_meets_another_inside_or_covers_a_hole(
    outlines: int, holes: int, crosses: Any, around: bool | None, meets: Any
) -> None:
    """A bore outside the material that meets another one changes nothing."""
    covered = None if around is None else Loop((), hole=around)
    lie = Lie(outlines, holes, crosses, covered, None, meets)
    expected = crosses is not None or around is True or (meets is not None and outlines > holes)
    assert _doubtful(lie) is expected
