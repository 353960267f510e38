"""Which of the encoder's words say why a movie could not be written?"""

from __future__ import annotations

import pytest

from watchsim.render.encoder import _reason


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ("", "the encoder stopped without a message"),
        ("  \n", "the encoder stopped without a message"),
        (
            "frame 12\nav_interleaved_write_frame(): No space left on device\nexit",
            "av_interleaved_write_frame(): No space left on device",
        ),
        (" first word \nlast word", "first word"),
    ],
)
def test_the_first_refusal_else_the_first_words(words: str, reason: str) -> None:
    assert _reason(words) == reason
