"""Which pictures of the documentation become smaller without loss for the eye?

A PNG is written with a palette of at most 256 colours where no pixel of it changes by more than can be seen: drawings and
plots have few colours, and shades where edges are smoothed. What does not become smaller by a tenth stays as it is, and so do
movies, whose frames hold only what changed. Run it after the other scripts of this folder.

    python scripts/pictures/shrink_images.py [folder]
"""

from __future__ import annotations

import io
import sys
from pathlib import Path

import numpy as np
from PIL import Image
from scipy.spatial import cKDTree

IMAGES = Path(__file__).resolve().parents[2] / "docs" / "images"
COLOURS, EXACT = 256, 160  # of a palette; so many are the most frequent of the picture, those of its faces, unchanged
MOST, MEAN = 24, 0.3  # of 255, in one channel: the largest difference of a pixel, and the mean difference of a picture
WORTH = 0.9  # of the size before: a picture that stays larger is left alone


def shrunk(data: bytes) -> bytes | None:
    """The same picture with a palette; None where that shows, or is not worth it."""
    with Image.open(io.BytesIO(data)) as picture:
        if picture.mode not in ("RGB", "RGBA"):
            return None
        rgb = picture.convert("RGB")
        if picture.mode == "RGBA" and np.asarray(picture)[..., 3].min() < 255:
            return None
    pixels = np.asarray(rgb).reshape(-1, 3)
    colours, own, count = np.unique(pixels, axis=0, return_inverse=True, return_counts=True)
    order = np.argsort(-count, kind="stable")
    palette, rest = colours[order[:EXACT]], colours[order[EXACT:]]
    if len(rest):
        shades = Image.fromarray(rest[None]).quantize(
            COLOURS - EXACT, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE
        )
        palette = np.vstack((palette, np.array(shades.getpalette(), np.uint8).reshape(-1, 3)))[:COLOURS]
    nearest = cKDTree(palette.astype(float)).query(colours.astype(float))[1]
    apart = np.abs(colours.astype(int) - palette[nearest])
    made = Image.fromarray(nearest[own].astype(np.uint8).reshape(rgb.height, rgb.width), "P")
    made.putpalette(palette.tobytes())
    seen = apart.max() > MOST or (apart.mean(axis=1) @ count) / count.sum() > MEAN
    out = io.BytesIO()
    made.save(out, "PNG", optimize=True)
    return None if seen or out.tell() > WORTH * len(data) else out.getvalue()


def main(folder: Path) -> None:
    before = after = 0
    for path in sorted(folder.rglob("*.png")):
        data = path.read_bytes()
        smaller = shrunk(data)
        before, after = before + len(data), after + len(smaller or data)
        if smaller is not None:
            path.write_bytes(smaller)
    print(f"{before / 1e6:.2f} MB of PNG before, {after / 1e6:.2f} MB after")


if __name__ == "__main__":
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    from usage import arguments

    main(arguments(__doc__, folder=(IMAGES, "whose PNG files are looked through")).folder)
