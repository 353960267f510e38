"""Which accidents happen to a scene file? Each takes a random generator and a text, and returns another text."""

from __future__ import annotations

import random
import re

VALUES = (  # in place of what a key has
    *[
        "",
        "0",
        "-1",
        "1",
        "1e308",
        "1e-320",
        "5e101",
        "nan",
        "inf",
        "-inf",
        "true",
        "[]",
        "{}",
        "[[]]",
        "[{}]",
        '""',
        '"x"',
        "'''a'''",
        '"5e101 mm"',
        '"-1 mm"',
        '"0 mm"',
        '"1e-320 g"',
        '"1e400 m"',
        '"nan m"',
        '"1 mm/0"',
        '"28800"',
        '"28800 vph"',
        '"1e5000 Hz"',
        '"every 99999999999999999999"',
        '"every 0"',
        '"events"',
        '["1 s", "0 s"]',
        '["0 s", "1e99 s"]',
        "1979-05-27T07:32:00Z",
        "07:32:00",
    ],
    *("9" * 5000, f'"{"9" * 5000} mm"', f'"every {"9" * 5000}"'),
    *("[" * 400 + "]" * 400, "{a=" * 400 + "1" + "}" * 400, "[" * 5000),
    *[
        '"wheel"',
        '"wheel.TEETH"',
        '["wheel.TEETH", "wheel.TEETH"]',
        '["a", "b", "c"]',
        '"../../etc/passwd"',
        '"/dev/null"',
        '"."',
        "1_0",
        '"\\u0000"',
        '"\\ud800"',
        '"µ"',
        '"1 µN·m"',
        "[1, 2]",
        '["1 mm", "1 mm"]',
        '["0 mm", "0 mm", "0 mm"]',
        "0x10",
        "1e-14",
        '"free"',
        '"fixed"',
        '"slide"',
        '"moving"',
        "[0.0, 0.0]",
        "[1.0, 0.0]",
        '"-0 mm"',
        '"1 mm mm mm"',
        '"((((mm))))"',
        '"1 mm^9"',
        '"1 mm^-9"',
    ],
)
LINES = (  # put in somewhere
    *[
        "[bodies]",
        "[[bodies]]",
        "[[contacts]]",
        "[[springs]]",
        "[[torques]]",
        "[[damping]]",
        "[run]",
        "[expect]",
        "[scene]",
        "[lock]",
        "[bodies.x]",
        "[bodies.'']",
        "[bodies.'a.b']",
        "[timegrapher]",
        "[bodies.wheel.solids]",
        "[[bodies.wheel.solids]]",
        "[[]]",
        "[",
    ],
    *("[bodies]\ndrawing = 'x.dxf'\nposition = ['0 mm', '0 mm']", "[[contacts]]\n[[contacts]]", "bodies = 1", "contacts = [1]"),
    *("contacts = [[]]", "springs = {}", "x = 1", "=", "a.b.c.d = 1"),
    *("[a." + "a." * 400 + "a]", "\x00", "\ufeff", "# \x01", "[expect.x]"),
    *[
        '"amplitude" = 1',
        '"amplitude" = { value = "1", tolerance = "1" }',
        '"x.y" = { value = "1 s", tolerance = "-1 s" }',
        "[lock.drawings]",
        'on = "wheel"',
        'on = "balance"',
        'record = "statistics"',
        "tolerance = 1e-14",
        'duration = "1e300 s"',
    ],
)


def _value(rng: random.Random, text: str) -> str:
    """Another value for a key."""
    lines = text.splitlines()
    places = [k for k, line in enumerate(lines) if re.match(r"\s*[\w\"]+\s*=", line)]
    if places:
        k = rng.choice(places)
        lines[k] = f"{lines[k].split('=')[0]}= {rng.choice(VALUES)}"
    return "\n".join(lines)


def _line(rng: random.Random, text: str) -> str:
    """Another line somewhere."""
    lines = text.splitlines()
    lines.insert(rng.randrange(len(lines) + 1), rng.choice(LINES))
    return "\n".join(lines)


def _lost(rng: random.Random, text: str) -> str:
    """Some lines lost."""
    lines = text.splitlines()
    at = rng.randrange(len(lines) + 1)
    return "\n".join(lines[:at] + lines[at + rng.randrange(1, 6) :])


def _moved(rng: random.Random, text: str) -> str:
    """Some lines doubled, or in another place."""
    lines = text.splitlines() or [""]
    at, to = rng.randrange(len(lines)), rng.randrange(len(lines))
    part = lines[at : at + rng.randrange(1, 8)]
    return "\n".join(lines[:to] + part + lines[to:])


def _key(rng: random.Random, text: str) -> str:
    """A key or a name misspelt."""
    words = list(re.finditer(r"[A-Za-z_]{2,}", text))
    if not words:
        return text
    word = rng.choice(words)
    other = rng.choice((word[0][:-1], word[0] + "s", rng.choice(words)[0], word[0].upper(), ""))
    return text[: word.start()] + other + text[word.end() :]


def _number(rng: random.Random, text: str) -> str:
    """Another number."""
    numbers = list(re.finditer(r"-?\d+\.?\d*(e-?\d+)?", text))
    if not numbers:
        return text
    found = rng.choice(numbers)
    other = rng.choice(
        ("0", "-1", "1e9", "1e-9", "1e30", "1e-30", "1e300", "-" + found[0], found[0] + "0", "1e-320", "99999999999999999999")
    )
    return text[: found.start()] + other + text[found.end() :]


def _cut(rng: random.Random, text: str) -> str:
    return text[: rng.randrange(len(text) + 1)]


ACCIDENTS = (_value, _value, _value, _line, _line, _lost, _moved, _key, _key, _number, _number, _number, _cut)
