"""Does a blow ring on three tones that die away, from its instant on, also across the borders of blocks?"""

from __future__ import annotations

import math

import numpy as np
import pytest

from watchsim.analysis.sound.bursts import Ringing

RATE = 48000
TONES = [(3400.0, 0.0009, 0.45), (6100.0, 0.0006, 0.35), (11300.0, 0.0003, 0.2)]  # Hz, decay s, share
BLOWS = [(3.0 / RATE, 2.0), (3.4 / RATE, 0.7), (17.9 / RATE, 1.3), (60.0 / RATE, 0.4), (60.0 / RATE, 0.9), (98.5 / RATE, 3.0)]


def summed(count: int) -> list[float]:
    """Every blow, over all samples that are not before it."""
    out = []
    for n in range(count):
        ages = [(n / RATE - at, loud) for at, loud in BLOWS if n / RATE >= at - 1e-15]
        tones = [(loud * share, age / decay, math.tau * hertz * age) for age, loud in ages for hertz, decay, share in TONES]
        out.append(sum(size * math.exp(-gone) * math.cos(turned) for size, gone, turned in tones))
    return out


@pytest.mark.parametrize("blocks", [(150,), (20, 130), (18, 1, 41, 90), (61, 38, 51)])
def test_blows_add_up_block_by_block(blocks: tuple[int, ...]) -> None:
    """Between two samples, too: the next one hears how far it has rung already."""
    ringing, parts, first = Ringing(), [], 0
    for count in blocks:
        own = [(at, loud) for at, loud in BLOWS if first <= math.ceil(at * RATE - 1e-9) < first + count]
        times, loudness = np.array(own).reshape(-1, 2).T
        parts.append(ringing.block(count, times, loudness))
        first += count
        assert ringing.sampled == first
    assert np.concatenate(parts) == pytest.approx(summed(150), abs=1e-12)


@pytest.mark.parametrize(("sample", "fits"), [(8.9, False), (9.1, True), (13.9, True), (14.1, False)])
def test_a_blow_lies_in_its_block(sample: float, fits: bool) -> None:
    """Of samples 10 to 14."""
    ringing = Ringing()
    ringing.block(10, np.zeros(0), np.zeros(0))
    times = np.array([12.0, sample]) / RATE
    if fits:
        assert len(ringing.block(5, times, np.ones(2))) == 5
    else:
        with pytest.raises(ValueError, match="outside the block"):
            ringing.block(5, times, np.ones(2))
