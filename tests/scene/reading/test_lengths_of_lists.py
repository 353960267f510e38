"""How long, how deep and how many may what is written in a scene be, and how much of it is shown?"""

from __future__ import annotations

import math
from typing import Any

import pytest

from watchsim.scene.errors import Faults
from watchsim.scene.keys import BODY, TORQUE, nearest
from watchsim.scene.read_bodies import read_prescribed
from watchsim.scene.read_contacts import repeated, rows_of
from watchsim.scene.values import Table, parsed, shown
from watchsim.units import TIME


def table(mapping: dict[str, Any], keys: Any = BODY) -> Table:
    return Table(mapping, "here", keys, Faults())


@pytest.mark.parametrize("opening", ["[]", "{}"])
def test_twenty_tables_within_each_other_are_the_most(opening: str) -> None:
    """The whole file is the first, the value within all the last."""
    name, end = ("", "") if opening == "[]" else ("a = ", "")

    def nested(depth: int) -> str:
        return "x = " + (opening[0] + name) * depth + "1" + (opening[1] + end) * depth

    found: Any = parsed(nested(19))["x"]
    for _ in range(19):
        found = found[0] if isinstance(found, list) else found["a"]
    assert found == 1
    with pytest.raises(ValueError, match="more than 20 deep"):
        parsed(nested(20))


@pytest.mark.parametrize(("length", "cut"), [(57, False), (58, False), (59, True), (70, True)])
def test_of_a_long_value_the_beginning_is_shown(length: int, cut: bool) -> None:
    """With the quotes sixty characters at most, three of them points where some are left out."""
    text = "".join(chr(97 + k % 26) for k in range(length))
    whole = f' = "{text}"'
    assert shown(text) == (f"{whole[:60]}..." if cut else whole)
    assert len(shown(text)) <= len(" = ") + 60


def test_what_toml_cannot_hold_is_shown_as_python_does() -> None:
    assert shown({"a": None}) == " = {'a': None}"


@pytest.mark.parametrize(("points", "taken"), [(0, False), (1, True), (2000, True), (2001, False)])
def test_a_path_has_one_to_two_thousand_points(points: int, taken: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    given: list[Any] = []
    monkeypatch.setattr("watchsim.scene.read_bodies.path", given.append)
    one = table({"motion": "driven", "path": [[f"{k + 1} s", f"{3 * k + 2} rad"] for k in range(points)]})
    read_prescribed(one, 0.25)
    assert [fault.key for fault in one.faults.found] == ([] if taken else ["here.path"])
    assert given == ([[(0.0, 0.0), *((k + 1.0, 3.0 * k + 2.0) for k in range(points))]] if taken else [])


@pytest.mark.parametrize(
    ("points", "faults"),
    [
        ([["0 s", "1 rad"]], ["path.0.0"]),
        ([["1 s", "1 rad"], ["1 s", "2 rad"]], ["path.1.0"]),
        ([["2 s", "1 rad"], ["1 s", "2 rad"], ["1.5 s", "3 rad"]], ["path.1.0", "path.2.0"]),
        ([["1 s", "1 rad", "2 rad"]], ["path.0"]),
        ([["1 s"]], ["path.0"]),
        ([["1 s", "2 mm"], ["2 s", "1 rad"]], ["path.0.1"]),
        ("1 s", ["path"]),
    ],
)
def test_times_of_a_path_ascend_from_the_start(points: Any, faults: list[str]) -> None:
    """After a fault nothing moves."""
    one = table({"motion": "driven", "path": points})
    found = read_prescribed(one, 0.25)
    assert [fault.key for fault in one.faults.found] == [f"here.{key}" for key in faults]
    assert found is not None and found.law.table == () and found.velocity == 0.0


LAWS: dict[str, Any] = {
    "velocity": "3 rad/s",
    "swing": {"amplitude": "0.5 rad", "frequency": "2 Hz"},
    "path": [["1 s", "2 rad"]],
}


@pytest.mark.parametrize(
    ("laws", "key"),
    [
        ((), "here"),
        (("velocity", "swing"), "here.swing"),
        (("path", "velocity"), "here.path"),
        (("swing", "path"), "here.path"),
        (("velocity", "swing", "path"), "here.swing"),
    ],
)
def test_a_driven_body_has_one_law(laws: tuple[str, ...], key: str) -> None:
    one = table({"motion": "driven", **{law: LAWS[law] for law in laws}})
    read_prescribed(one, 0.25)
    assert [fault.key for fault in one.faults.found] == [key]
    for law, value in LAWS.items():
        alone = table({"motion": "driven", law: value})
        found = read_prescribed(alone, 0.25)
        assert not alone.faults.found and found is not None
        assert found.velocity == pytest.approx({"velocity": 3.0, "swing": 2.0 * math.pi, "path": 0.0}[law])
        idle = table({law: value})
        assert read_prescribed(idle, 0.25) is None and len(idle.faults.found) == (law != "velocity")


@pytest.mark.parametrize(
    ("inner", "faults"),
    [
        ({"amplitude": "0.5 rad"}, ["swing"]),
        ({"frequency": "2 Hz"}, ["swing"]),
        ({}, ["swing"]),
        (3, ["swing"]),
        ({"amplitude": "0.5 rad", "frequency": "0 Hz"}, ["swing.frequency"]),
        ({"amplitude": "0.5 mm", "frequency": "2 Hz"}, ["swing.amplitude"]),
        ({"amplitude": "0.5 rad", "frequency": "2 Hz", "phase": "1 s"}, ["swing.phase"]),
    ],
)
def test_a_swing_says_how_far_and_how_often(inner: Any, faults: list[str]) -> None:
    """After a fault it stands."""
    one = table({"motion": "driven", "swing": inner})
    found = read_prescribed(one, 0.25)
    assert [fault.key for fault in one.faults.found] == [f"here.{key}" for key in faults]
    assert found is not None and (found.law.square, found.velocity) == (0.0, 0.0)


@pytest.mark.parametrize(("phase", "middle", "speed"), [("0 rad", 0.25, 2.0 * math.pi), ("30°", 0.0, math.sqrt(3.0) * math.pi)])
def test_a_swing_begins_where_the_body_stands(phase: str, middle: float, speed: float) -> None:
    one = table({"motion": "driven", "swing": {"amplitude": "0.5 rad", "frequency": "2 Hz", "phase": phase}})
    found = read_prescribed(one, 0.25)
    assert found is not None and found.law.middle == pytest.approx(middle, abs=1e-15)
    assert (found.law.square, found.velocity) == pytest.approx((16.0 * math.pi**2, speed))


@pytest.mark.parametrize(
    ("rows", "faults"),
    [
        ([["1 s", "3 N·m"], ["4 s", "5 N·m"], ["6 s", "-2 N·m"]], []),
        ([["1 s", "3 N·m"]], ["table"]),
        ([["1 s", "3 N·m"], ["4 s", "5 N·m"], ["4 s", "6 N·m"]], ["table.2"]),
        ([["4 s", "3 N·m"], ["1 s", "5 N·m"], ["2 s", "6 N·m"]], ["table.1"]),
        ([["1 s", "3 N·m"], ["4 s", "5 N·m", "6 N·m"]], ["table.1"]),
        ([["1 s", "3 N·m"], ["4 s", "5 mm"]], ["table.1.1"]),
        ([["1 s", "3 N·m"], ["4 N·m", "5 N·m"]], ["table.1.0"]),
        ("1 s", ["table"]),
    ],
)
def test_rows_of_a_table_ascend(rows: Any, faults: list[str]) -> None:
    one = table({"table": rows}, TORQUE)
    found = rows_of(one, TIME)
    assert [fault.key for fault in one.faults.found] == [f"here.{key}" for key in faults]
    if not faults:
        assert found == ((1.0, 3.0), (4.0, 5.0), (6.0, -2.0))


@pytest.mark.parametrize(("period", "taken"), [("5.01 s", True), ("5 s", False), ("4.99 s", False)])
def test_a_table_repeats_after_more_than_its_length(period: str, taken: bool) -> None:
    one = table({"period": period}, TORQUE)
    rows, seconds = repeated(one, ((2.0, 11.0), (3.0, 13.0), (7.0, 17.0)))
    assert bool(one.faults.found) is not taken
    assert rows == ((2.0, 11.0), (3.0, 13.0), (7.0, 17.0), (2.0 + seconds, 11.0)) and f"{seconds:g} s" == period
    assert repeated(one, ())[0] == ()


@pytest.mark.parametrize(
    ("word", "known", "said"),
    [
        ("abcdefg", ["abcdexy", "xyz"], 'Did you mean "abcdexy"?'),  # 10 of 14 letters: 0.71
        ("abcdefg", ["abcxyzw", "xyz"], "Known here: abcxyzw, xyz."),  # 6 of 14
        ("abcdefghi", ["abcdefxyz"], "Known here: abcdefxyz."),  # 12 of 18: 0.67
        ("LEVER", ["levee", "lever"], 'Did you mean "lever"?'),
        ("leveR", ["levex", "lever"], 'Did you mean "lever"?'),
        ("any", [], ""),
    ],
)
def test_the_nearest_word_shares_seven_letters_in_ten(word: str, known: list[str], said: str) -> None:
    assert nearest(word, known) == said
