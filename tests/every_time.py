"""Which of many cases are tried every time? All of them are at night."""

from collections.abc import Callable, Iterable
from typing import Any

import pytest


def few(cases: Iterable[Any], kept: int | Callable[[Any], bool], several: bool = False) -> list[Any]:
    """The cases as parameters, all but `kept` of them marked slow: so many, evenly spread, or those that it picks.

    `several`: each case is a tuple of several parameters.
    """
    known = list(cases)
    if isinstance(kept, int):
        chosen = {k * len(known) // kept for k in range(kept)}
    else:
        chosen = {k for k, case in enumerate(known) if kept(case)}
    assert chosen, "nothing would be tried"
    marks = [() if k in chosen else pytest.mark.slow for k in range(len(known))]
    return [pytest.param(*(case if several else (case,)), marks=mark) for case, mark in zip(known, marks, strict=True)]
