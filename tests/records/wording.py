"""How is what the program says kept as plain text, and when do two such texts agree?

A record file holds sections, each begun by a line "## name". Numbers agree to a millionth, within brackets also to a part in
1e9 of the largest beside them (a zero is seldom exact); "~" stands for a number or line that is rounding, or time on the clock.
All other words agree to the letter.
"""

import dataclasses
import difflib
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from enum import Enum
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np

RELATIVE = 1e-6  # far above rounding on another machine, far below any fault that matters
SURE = 1e-7  # what a number kept may move when its scene is changed by rounding
NOTHING = 1e-9  # of the largest number within the same brackets
UNSURE = "~"
NUMBER = re.compile(r"(?<![\w.])[-−]?\d+(?:\.\d+)?(?:e[-+]?\d+)?|~")
BRACKETS = re.compile(r"(\[[^\[\]]*\])")


def said(value: Any, name: str = "") -> Iterator[str]:
    """Lines "name: value" of anything nested: what is made of single values stands on one line."""
    if dataclasses.is_dataclass(value):
        value = {field.name: getattr(value, field.name) for field in dataclasses.fields(value) if field.compare}
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, Mapping) and value and not any(map(_nested, value.values())):
        yield f"{name}: {', '.join(f'{key} {_single(one)}' for key, one in value.items())}"
    elif isinstance(value, Mapping) and value:
        for key, one in value.items():
            yield from said(one, f"{name}.{key}".lstrip("."))
    elif isinstance(value, (list, tuple)) and any(map(_nested, value)):
        for number, one in enumerate(value):
            yield from said(one, f"{name}.{number}")
    elif isinstance(value, (list, tuple)):
        yield f"{name}: [{', '.join(map(_single, value))}]"
    else:
        yield f"{name}: {_single(value)}"


def _nested(value: Any) -> bool:
    return isinstance(value, (Mapping, list, tuple, np.ndarray)) or dataclasses.is_dataclass(value)


def _single(value: Any) -> str:
    if isinstance(value, Enum):
        return value.name
    if isinstance(value, (float, np.floating)):
        return f"{float(value):.10g}"
    return str(value)


def moved(kept: str, now: str) -> list[str]:
    """The lines that differ, "- kept" and "+ now"; empty where the two texts agree."""
    before, after = kept.splitlines(), now.splitlines()
    if len(before) == len(after):
        pairs = [(a, b) for a, b in zip_longest(before, after, fillvalue="") if not agree(a, b)]
        return [line for a, b in pairs for line in (f"- {a}", f"+ {b}")]
    return [
        f"{line[0]} {line[1:]}" for line in list(difflib.unified_diff(before, after, n=0, lineterm=""))[2:] if line[0] in "-+"
    ]


def agree(kept: str, now: str) -> bool:
    """Do two lines say the same?"""
    if kept in (now, UNSURE):
        return True
    one, other = BRACKETS.split(kept), BRACKETS.split(now)
    return len(one) == len(other) and all(map(_alike, one, other))


def _alike(kept: str, now: str) -> bool:
    if NUMBER.split(kept) != NUMBER.split(now):
        return False
    pairs = list(zip(NUMBER.findall(kept), NUMBER.findall(now), strict=True))
    floor = NOTHING * max((abs(_value(a)) for a, _ in pairs if a != UNSURE), default=0.0) if kept.startswith("[") else 0.0
    return all(a == UNSURE or math.isclose(_value(a), _value(b), rel_tol=RELATIVE, abs_tol=floor) for a, b in pairs)


def _value(text: str) -> float:
    return float(text.replace("−", "-"))


def without_unsure(text: str, again: str) -> str:
    """The text with "~" for each number that differs in `again`, and for each line that does in other words.

    ValueError where one has more lines.
    """
    one, other = text.splitlines(), again.splitlines()
    if len(one) != len(other):
        raise ValueError("\n".join(["not only numbers:", *moved(text, again)]))
    return "".join(f"{_settled(*both)}\n" for both in zip(one, other, strict=True))


def _settled(line: str, again: str) -> str:
    if NUMBER.split(line) != NUMBER.split(again):
        return UNSURE
    others = iter(NUMBER.findall(again))

    def number(found: re.Match[str]) -> str:
        one, other = found.group(), next(others)
        return one if one != UNSURE and math.isclose(_value(one), _value(other), rel_tol=SURE) else UNSURE

    return NUMBER.sub(number, line)


def shortened(text: str) -> str:
    """Numbers with more than ten digits are cut to nine."""
    return NUMBER.sub(lambda found: f"{_value(found.group()):.9g}" if len(found.group()) > 11 else found.group(), text)


def sections(path: Path) -> dict[str, str]:
    """The texts of a record file by their names; none where there is no file."""
    if not path.is_file():
        return {}
    parts = re.split(r"^## (.*)\n", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def written(texts: Mapping[str, str], about: Sequence[str]) -> str:
    """A record file of these sections, `about` on top."""
    return "".join([*(f"{line}\n" for line in about), *(f"## {name}\n{text}" for name, text in texts.items())])
