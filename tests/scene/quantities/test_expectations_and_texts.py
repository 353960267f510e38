"""How are promised numbers read, how is a mapping written as TOML, and what is said of a file that is none?"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest
import tomllib

from watchsim.scene.errors import Fault, Faults, SceneError
from watchsim.scene.load import load
from watchsim.scene.read_settings import read_expectations
from watchsim.scene.scene import Expectation
from watchsim.scene.write_toml import toml_text, value_text


def expected(entries: Any) -> tuple[tuple[Expectation, ...], list[str]]:
    faults = Faults()
    found = read_expectations({"expect": entries}, faults)
    return found, [f"{fault.key}{fault.shown}: {fault.message}" for fault in faults.found]


@pytest.mark.parametrize(
    ("key", "value", "tolerance", "number", "width", "unit"),
    [
        ("amplitude", "270°", "0.05 rad", 270.0, math.degrees(0.05), "°"),
        ("amplitude", "4.5 rad", "9°", 4.5, math.radians(9.0), "rad"),
        ("rate", "-3 s/d", "7 ppm", -3.0, 0.6048, "s/d"),
        ("period", "250 ms", "0.001 s", 250.0, 1.0, "ms"),
        ("frequency", "28800 vph", "0.5 Hz", 28800.0, 3600.0, "vph"),
        ("impacts", 7, 2, 7.0, 2.0, ""),
        ("anything", "3 mm", "5 µm", 3.0, 0.005, "mm"),
        ("share", "12 %", "3 %", 12.0, 3.0, "%"),
    ],
)
def test_a_promise_is_kept_in_the_unit_of_its_value(
    key: str, value: object, tolerance: object, number: float, width: float, unit: str
) -> None:
    (found,), said = expected({key: {"value": value, "tolerance": tolerance}})
    assert not said and (found.key, found.value, found.unit) == (key, number, unit)
    assert found.tolerance == pytest.approx(width, rel=1e-12)


REFUSED = [
    ({"amplitude": {"value": "3 s", "tolerance": "1°"}}, 'expect.amplitude.value = "3 s": "3 s" is a time; here an angle'),
    ({"amplitude": {"value": "3°", "tolerance": "1 s"}}, 'expect.amplitude.tolerance = "1 s": "1 s" is a time; here an angle'),
    (
        {"any": {"value": "3 mm", "tolerance": 1}},
        'expect.any.tolerance = 1: a bare number needs a unit here. Write "1 mm"',
    ),
    (
        {"any": {"value": "0.5 %", "tolerance": 0.03}},
        'expect.any.tolerance = 0.03: a bare number needs a unit here. Write "0.03%"',
    ),
    (
        {"amplitude": {"value": "270°", "tolerance": 1}},
        "expect.amplitude.tolerance = 1: a bare number needs a unit here: 1 rad and 1° differ by a factor of 57.3. ",
    ),
    ({"any": {"value": "3 mm", "tolerance": "0 mm"}}, 'expect.any.tolerance = "0 mm": must be above zero'),
    ({"any": {"value": "3 mm", "tolerance": "-1 mm"}}, 'expect.any.tolerance = "-1 mm": must be above zero'),
    ({"any": {"value": "3 mm"}}, "expect.any: missing: tolerance. Write e.g. { value = 500, tolerance = 3 }"),
    ({"any": {"tolerance": "3 mm"}}, "expect.any: missing: value. Write e.g. { value = 500"),
    ({"any": 3}, "expect.any = 3: a table of keys is needed here"),
    (3, "expect = 3: write e.g."),
]


@pytest.mark.parametrize(("entries", "words"), REFUSED)
def test_a_promise_that_cannot_be_kept(entries: Any, words: str) -> None:
    found, said = expected(entries)
    assert len(said) == 1 and said[0].startswith(words) and (found == () or "tolerance" in words)


MAPPING: dict[str, Any] = {
    "title": 'a "quoted" µ\ntext\x7f\\',
    "numbers": [1, 2.5, -3e-300, 1e22],
    "truth": [True, False],
    "empty": {},
    "lists": [[1, [2]], []],
    "table": {"a.b": 1, "nested": {"deep": "x"}, "of": [{"k": 1, "in": {"v": 2}}, {"k": 3}]},
    "tables": [{"name": "x", "inner": [{"y": 1}, {"y": 2}]}, {}],
    "only": {"inner": {"z": 5}},
}


def test_what_is_written_reads_back_the_same() -> None:
    assert tomllib.loads(toml_text(MAPPING)) == MAPPING and toml_text({}) == "\n"
    assert toml_text({"a": 1, "b": {"c": 2}}) == "a = 1\n\n[b]\nc = 2\n"
    assert toml_text({"only": {"inner": {"z": 5}}}) == "[only.inner]\nz = 5\n"
    assert toml_text({"t": [{"a": 1}, {"a": 2}]}) == "[[t]]\na = 1\n\n[[t]]\na = 2\n"
    with pytest.raises(TypeError, match="TOML cannot hold complex"):
        value_text([1j])


def test_faults_come_in_the_order_of_the_file_each_once() -> None:
    """At their own line, else at that of the table that holds them; what was changed since is named so."""
    faults = Faults("f.toml", {"a": 9, "a.b": 4, "c": 2}, frozenset({"c.x"}))
    for key in ("a.b", "a.z", "c.x", "c.x.1", "c.xy", "a.b.0", "none", "a.b"):
        faults.add(key, "wrong")
    places = {fault.key: fault.place for fault in faults.found}
    assert places == {
        **{"a.b": "f.toml:4", "a.b.0": "f.toml:4", "a.z": "f.toml:9", "c.xy": "f.toml:2"},
        **{"c.x": "changed value", "c.x.1": "changed value", "none": "f.toml"},
    }
    with pytest.raises(SceneError) as caught:
        faults.raise_any()
    assert [fault.key for fault in caught.value.faults] == ["none", "c.x", "c.x.1", "c.xy", "a.b", "a.b.0", "a.z"]
    Faults().raise_any()
    assert (
        str(Fault("k", "why", " = 3", "here")) == "here  k = 3\n  why."
        and str(Fault("", "why?\nso", "", "here")) == "here\n  why?\n  so."
    )


@pytest.mark.parametrize(
    ("names", "taken"), [(("scene.toml", "scene.lock.toml"), "scene.toml"), (("scene.lock.toml",), "scene.lock.toml")]
)
def test_of_a_folder_the_scene_comes_before_its_lock(tmp_path: Path, names: tuple[str, ...], taken: str) -> None:
    for name in names:
        (tmp_path / name).write_text('[bodies.b]\ninertia = "1 g·cm²"\n', encoding="utf-8-sig")
    scene = load(tmp_path)
    assert scene.path == tmp_path / taken and scene.title == tmp_path.name
    with pytest.raises(SceneError, match=r"cannot be read: .*\."):
        load(tmp_path / taken / "below")


@pytest.mark.parametrize(
    ("text", "line"), [("a = 1\nb = \n", 2), ("a = 1\n\n[b\n", 3), ('a = """x\n\n\n', 3), ("a = 1\na = 2\n", 2)]
)
def test_what_is_no_toml_is_told_with_its_line(tmp_path: Path, text: str, line: int) -> None:
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(SceneError) as caught:
        load(path)
    (fault,) = caught.value.faults
    assert fault.place == f"{path}:{line}" and fault.message.startswith("not valid TOML: ") and "(at" not in fault.message
