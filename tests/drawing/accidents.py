"""What happens to a text file on its way, whatever its format?"""

import random
from collections.abc import Callable, Sequence

Accident = Callable[[random.Random, bytes], bytes]
NUMBERS = (*(b"0", b"-1", b"1e308", b"-1e-320", b"nan", b"inf", b"1e9", b"-1e9"), *(b"", b"99999999999", b"1e-300", b"3.7"))


def after_accidents(rng: random.Random, data: bytes, accidents: Sequence[Accident]) -> bytes:
    """The file after one to three of them."""
    for _ in range(rng.choice((1, 1, 1, 2, 3))):
        data = rng.choice(accidents)(rng, data) if data else data
    return data


def bytes_overwritten(rng: random.Random, data: bytes) -> bytes:
    changed = bytearray(data)
    for _ in range(rng.choice((1, 1, 2, 8))):
        changed[rng.randrange(len(changed))] = rng.randrange(256)
    return bytes(changed)


def cut_off(rng: random.Random, data: bytes) -> bytes:
    return data[: rng.randrange(len(data))]


def line_lost(rng: random.Random, data: bytes) -> bytes:
    lines = data.split(b"\n")
    del lines[rng.randrange(len(lines))]
    return b"\n".join(lines)


def lines_swapped(rng: random.Random, data: bytes) -> bytes:
    lines = data.split(b"\n")
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[i], lines[j] = lines[j], lines[i]
    return b"\n".join(lines)


def lines_doubled(rng: random.Random, data: bytes, most: int) -> bytes:
    """Up to `most` lines stand somewhere else as well."""
    lines = data.split(b"\n")
    i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
    lines[i:i] = lines[j : j + rng.randrange(most)]
    return b"\n".join(lines)
