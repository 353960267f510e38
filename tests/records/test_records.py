"""Does the program still say of many drawings, scenes and runs what it said before?

What is kept holds on any machine. Where something moves for a reason, `python scripts/make_records.py` shows what and
rewrites the records. That a number is right is for other tests to say.
"""

import functools
from collections.abc import Callable
from pathlib import Path

import matplotlib
import pytest
from every_time import few
from records import benchmark_records, design_records, drawing_records, picture_records, run_records, scene_records
from records.wording import agree, moved, said, sections, without_unsure, written

KEPT = Path(__file__).parent / "kept"
TOPICS = {
    **{"drawings": drawing_records, "scenes": scene_records, "runs": run_records, "benchmarks": benchmark_records},
    **{"designs": design_records, "pictures": picture_records},
}
LONG = {
    ("runs", "tourbillon"),
    ("runs", "grasshopper"),
    ("runs", "remontoir"),
    ("runs", "duplex"),
    ("runs", "cylinder"),
}  # half a second and more
MAKERS: dict[str, dict[str, Callable[[Path], str]]] = {topic: module.records() for topic, module in TOPICS.items()}
KNOWN = [(topic, name) for topic, makers in MAKERS.items() for name in makers]
RECORDS = few(KNOWN, lambda one: one not in LONG, several=True)


def said_of(topic: str, name: str, scratch: Path) -> str:
    """What is said now; names of folders are left out."""
    folder = scratch / "made"
    folder.mkdir()
    return MAKERS[topic][name](folder).replace(f"{folder}/", "")


@functools.cache
def kept_of(topic: str) -> dict[str, str]:
    return sections(KEPT / f"{topic}.txt")


@pytest.mark.parametrize(("topic", "name"), RECORDS, ids=lambda text: text.replace(" ", "_"))
def test_what_is_said_is_what_was_said(topic: str, name: str, tmp_path: Path) -> None:
    if topic == "pictures" and kept_of(topic)["matplotlib"].strip() != matplotlib.__version__:
        pytest.skip("matplotlib is of another version than that of the records")
    kept, now = kept_of(topic)[name], said_of(topic, name, tmp_path)
    assert not moved(kept, now), "\n".join(moved(kept, now))


@pytest.mark.parametrize("topic", TOPICS)
def test_nothing_is_kept_of_what_is_gone(topic: str) -> None:
    assert set(kept_of(topic)) == set(MAKERS[topic])


def test_what_moves_is_noticed() -> None:
    assert agree("a: 1.0000001 mm", "a: 1 mm")
    assert not agree("a: 1.00001 mm", "a: 1 mm")
    assert not agree("a: 1 mm", "b: 1 mm")
    assert not agree("a: 1", "a: −1")
    assert agree("at [3, 1e-12]", "at [3, -2e-13]")
    assert not agree("at [3, 1e-6]", "at [3, 0]")
    assert not agree("at 3, 1e-12", "at 3, -2e-13")
    assert agree("closes to ~ of it", "closes to 2e-11 of it")
    assert moved("a\nb 1\n", "a\nb 2\n") == ["- b 1", "+ b 2"]
    assert moved("a\n", "a\nb\n") == ["+ b"]


def test_what_rounding_moves_is_blotted_out() -> None:
    assert without_unsure("x 1, y 3e-17\n", "x 1.00000001, y -2e-18\n") == "x 1, y ~\n"
    assert without_unsure("x 1\nz\n", "y 1\nz\n") == "~\nz\n"
    with pytest.raises(ValueError, match="not only numbers"):
        without_unsure("x 1\n", "x 1\ny\n")


def test_sections_come_back(tmp_path: Path) -> None:
    (tmp_path / "kept.txt").write_text(written({"a b": "1\n2\n", "c": "\n"}, ["About."]))
    assert sections(tmp_path / "kept.txt") == {"a b": "1\n2\n", "c": "\n"}
    assert sections(tmp_path / "none.txt") == {}
    assert list(said({"a": {"b": [1.5, 2], "c": 1e-9}}, "x")) == ["x.a.b: [1.5, 2]", "x.a.c: 1e-09"]
