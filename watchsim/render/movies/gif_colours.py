"""Which 64 colours does a GIF need?

One palette for all frames: nothing flickers, unchanged pixels stay unchanged, and the file stays small.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Pixels = NDArray[np.uint8]

COLOURS = 64
PINNED = 24  # of these: the plain faces, exactly
HEAVIEST = 400  # weight above which a colour needs no more say
BITS = 6  # per channel, of the table from colours to the palette


@dataclass(frozen=True)
class Palette:
    """`colours` (COLOURS, 3); `table` gives the nearest of them for every colour of BITS bits per channel."""

    colours: Pixels
    table: Pixels

    def indexed(self, picture: Pixels) -> bytes:
        """The picture (height, width, 3 or 4) as one palette index a pixel, followed by 256 colours as B, G, R, A."""
        channels = (picture[..., :3] >> (8 - BITS)).astype(np.int32)
        index = self.table[(channels[..., 0] << (2 * BITS)) | (channels[..., 1] << BITS) | channels[..., 2]]
        entries = np.zeros((256, 4), dtype=np.uint8)  # those left over are transparent: the encoder marks "as before" with one
        entries[: len(self.colours), :3], entries[: len(self.colours), 3] = self.colours[:, ::-1], 255
        return index.tobytes() + entries.tobytes()


def shared_palette(samples: Iterable[Pixels], named: Iterable[str] = ()) -> Palette:
    """The palette for frames like the samples, each (height, width, 3 or 4), and for these `named` colours (#rrggbb) exactly.

    Colours count by the root of their area, so that a ruby of a few pixels keeps its red beside a large pale ground.
    """
    from PIL import Image

    seen = np.concatenate([sample[..., :3].reshape(-1, 3) for sample in samples]).astype(np.uint32)
    packed, counts = np.unique(seen @ np.array([65536, 256, 1], dtype=np.uint32), return_counts=True)
    found = np.column_stack((packed >> 16, (packed >> 8) & 255, packed & 255)).astype(np.uint8)
    strip = np.repeat(found, np.minimum(np.ceil(np.sqrt(counts)), HEAVIEST).astype(int), axis=0)
    asked = np.array([[int(colour[k : k + 2], 16) for k in (1, 3, 5)] for colour in named], np.uint8).reshape(-1, 3)
    pinned = np.concatenate((asked, found[np.argsort(-counts)][: PINNED - len(asked)]))
    image = Image.fromarray(strip[None]).quantize(COLOURS - len(pinned), method=Image.Quantize.MEDIANCUT, kmeans=3)
    mixed = np.array(image.getpalette(), dtype=np.uint8).reshape(-1, 3)[: COLOURS - len(pinned)]
    return _with_table(np.concatenate((pinned, mixed)))


def _with_table(colours: Pixels) -> Palette:
    levels = (np.arange(2**BITS) * 2 ** (8 - BITS) + 2 ** (7 - BITS)).astype(np.float32)
    grid = np.stack(np.meshgrid(levels, levels, levels, indexing="ij"), axis=-1).reshape(-1, 3)
    points = colours.astype(np.float32)
    # |grid - point|² without the term that is the same for all points
    distance = (points * points).sum(axis=1) - 2.0 * grid @ points.T
    table = distance.argmin(axis=1).astype(np.uint8)
    exact = colours.astype(np.int32) >> (8 - BITS)
    table[((exact[:, 0] << (2 * BITS)) | (exact[:, 1] << BITS) | exact[:, 2])[::-1]] = np.arange(len(colours))[::-1]
    return Palette(colours, table)
