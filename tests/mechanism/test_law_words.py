"""How is the law of a driven body put into words?"""

from __future__ import annotations

import math

import pytest

from watchsim.mechanism.scene_in_words import law_words
from watchsim.scene.body import Body
from watchsim.scene.prescribed import Prescribed


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (Body("a", velocity=(0.5,), prescribed=Prescribed(square=(math.tau * 4.0) ** 2)), "driven, swings at 4 Hz"),
        (Body("a", velocity=(math.pi,), prescribed=Prescribed()), "driven at 180 °/s"),
        (Body("a", "slide", velocity=(0.002,), prescribed=Prescribed()), "driven at 2 mm/s"),
        (Body("a", prescribed=Prescribed(table=((0.0, 0.0), (1.5, 0.0)))), "driven along a path of 1.5 s"),
    ],
)
def test_laws(body: Body, words: str) -> None:
    assert law_words(body) == words
