"""What does one blow sound like?

A case rings on a few tones that die away. Which ones is no result of the simulation: these are typical of a small watch on a
microphone. When a blow sounds and how loud is: it begins at its instant, between samples too, with an amplitude that grows
with the root of the energy lost.

A tone that dies away is one complex number per blow, turned and shrunk from sample to sample: y[n] = z y[n-1] + x[n]. Tails
are therefore exact however long, and a sound can be made block by block.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SAMPLES = 48000  # per second
TONES = ((3400.0, 0.9e-3, 0.45), (6100.0, 0.6e-3, 0.35), (11300.0, 0.3e-3, 0.2))  # Hz, decay time s, share of the start


@dataclass
class Ringing:
    """Goes on from block to block; `sampled` counts the samples made."""

    sampled: int = 0
    _state: list[NDArray[np.complex128]] = field(default_factory=lambda: [np.zeros(1, complex) for _ in TONES])

    def block(self, count: int, times: Array, loudness: Array) -> Array:
        """The next `count` samples: what still rings, and the blows at `times` (s) within them."""
        from scipy.signal import lfilter  # half a second to load, which a movie without sound need not wait for

        place = np.ceil(times * SAMPLES).astype(np.int64)
        late = place / SAMPLES - times
        own = place - self.sampled
        if len(own) and not (own.min() >= 0 and own.max() < count):
            raise ValueError("a blow lies outside the block of sound it was given with")
        out = np.zeros(count)
        for k, (hertz, decay, share) in enumerate(TONES):
            turning = complex(-1.0 / decay, 2.0 * np.pi * hertz)
            begun = share * loudness * np.exp(turning * late)
            blows = np.bincount(own, begun.real, count) + 1j * np.bincount(own, begun.imag, count)
            ringing, self._state[k] = lfilter([1.0], [1.0, -np.exp(turning / SAMPLES)], blows, zi=self._state[k])
            out += ringing.real
        self.sampled += count
        return out
