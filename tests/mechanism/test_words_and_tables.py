"""Are lengths written in the unit that suits them, and do tables stand in columns?"""

from __future__ import annotations

import pytest

from watchsim.mechanism.pair_table import HEADINGS, pair_lines
from watchsim.mechanism.scene_in_words import length, place, turned


@pytest.mark.parametrize(
    ("metres", "words"),
    [
        (12.34567e-3, "12.35 mm"),
        (3.712345e-9, "3.712 nm"),
        (0.0123456, "12.35 mm"),
        (2.34567, "2.346 m"),
        (-12.34567e-3, "-12.35 mm"),
    ],
)
def test_lengths(metres: float, words: str) -> None:
    assert length(metres).replace("−", "-") == words


def test_places_and_angles() -> None:
    assert place(7.1312814e-3) == "7.131281 mm" and place(-0.0) == "0 mm" and place(2e-3) == "2 mm"
    assert turned(0.5235987755982988) == "30°" and turned(-1e-13) == "0°"


@pytest.mark.parametrize("name", ["a", "a very long name of a body that moves"])
@pytest.mark.parametrize("count", [1, 2])
def test_the_columns_of_pairs(name: str, count: int) -> None:
    numbers = dict.fromkeys(HEADINGS, 123456)
    entry = {"between": [{"bodies": (name, "lever"), **numbers}] * count, **numbers}
    lines = list(pair_lines(entry))
    assert len(lines) == {1: 2, 2: 4}[count] and len({len(line) for line in lines}) == 1
    assert f"  {name} - lever" in lines[1] and lines[1].count("123,456") == len(HEADINGS)
    longest = max(len("pairs of edges and corners"), len(f"  {name} - lever"))
    assert lines[0].index("   declared") == longest and lines[1].index("    123,456") == longest
    assert (count == 1) or lines[3].startswith("  together")


def test_without_contacts_there_is_no_table() -> None:
    assert list(pair_lines({"between": []})) == ["pairs of edges and corners: no contact is declared"]
