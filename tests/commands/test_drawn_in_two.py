"""Are all plots drawn, whatever becomes of the copy of the process that draws one of them?"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import IO

import pytest

from watchsim.commands.second import drawn_in_two
from watchsim.commands.second.drawn_in_two import drawn

linux = pytest.mark.skipif(sys.platform != "linux", reason="processes are copied on Linux only")
pytestmark = linux

Target = Path | IO[bytes]


def says_where(target: Target) -> None:
    assert not isinstance(target, Path)
    target.write(str(os.getpid()).encode())


def contents(draws: dict[str, Callable[[Target], object]]) -> list[int]:
    found = drawn(draws)
    assert list(found) == list(draws)
    out = []
    for file in found.values():
        file.seek(0)
        out.append(int(file.read()))
    return out


def test_the_last_is_drawn_by_a_copy() -> None:
    first, second, last = contents(dict.fromkeys("abc", says_where))
    assert first == second == os.getpid() != last


def test_one_alone_is_drawn_here() -> None:
    assert contents({"a": says_where}) == [os.getpid()]


def test_nothing_to_draw() -> None:
    assert drawn({}) == {}


@pytest.mark.parametrize("end", ["raises", "goes"])
def test_what_the_copy_cannot_draw_is_drawn_here(end: str) -> None:
    here = os.getpid()

    def only_here(target: Target) -> None:
        assert not isinstance(target, Path)
        if os.getpid() != here:
            target.write(b"half of ")
            target.flush()
            if end == "goes":
                os._exit(3)
            raise ValueError
        target.write(b"1")

    assert contents({"a": says_where, "b": only_here}) == [here, 1]


def test_without_room_for_a_copy(monkeypatch: pytest.MonkeyPatch) -> None:
    def full() -> int:
        raise OSError

    monkeypatch.setattr(drawn_in_two.os, "fork", full)
    assert contents(dict.fromkeys("ab", says_where)) == [os.getpid()] * 2
