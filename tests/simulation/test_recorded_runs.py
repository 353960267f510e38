"""Does the solver still do what it did when this was recorded, and does a record notice what moved?"""

from pathlib import Path

import pytest
from record_file import COUNT_MARGIN, LEAST_BOUND, MARGIN, ROUNDING, moved, read, recorded_of, written
from recorded_scenes import ROOT, Told, run_of, scene_of, told

# Does the solver still do what it did when this was recorded?

if not (ROOT / "scripts" / "hunt").is_dir():
    pytest.skip("the mechanisms' generator is not here", allow_module_level=True)

RECORD = read()


@pytest.mark.parametrize("name", RECORD)
def test_as_recorded(name: str) -> None:
    assert moved(told(run_of(scene_of(name))), RECORD[name]) == []


# Is a record read as it was written, and does it notice what has moved by more than its copies did?


def told_record_file(shift: float = 0.0, steps: int = 40, turns: int = 1, spread: float = 0.0) -> Told:
    values = {"t": [0.5], "q0": [1.0 + shift, -2.0], "u0": [3.0, 0.0], "turn events": [0.25 + spread, 7.0]}
    return Told(values, {"steps": steps, "turn events": turns, "lcp": 0, "body": -3}, [1e-12, 2e-13])


COPIES = [told_record_file(1e-11), told_record_file(-2e-11, steps=41)]


def changed(**how) -> Told:
    """The run with one of its numbers replaced: (name, place) -> number, or name -> count."""
    one = told_record_file()
    for name, value in how.pop("values", {}).items():
        one.values[name[0]][name[1]] = value
    one.counts.update(how.pop("counts", {}))
    return Told(one.values, one.counts, how.pop("worst", one.worst))


def test_a_record_is_read_as_it_was_written(tmp_path: Path) -> None:
    kept = recorded_of(told_record_file(), COPIES)
    assert kept is not None
    path = tmp_path / "record.txt"
    path.write_text(written({"hunt/some-1": kept, "case/a block, rocking": kept}), encoding="utf-8")
    again = read(path)
    assert list(again) == ["hunt/some-1", "case/a block, rocking"]
    for one in again.values():
        assert moved(told_record_file(), one) == []
        assert one.counts == {"steps": (40, 3), "turn events": (1, 0), "body": (-3, 0)}
        assert one.values["q0"][0] == pytest.approx((1.0, MARGIN * 2e-11), rel=0.1)
        assert one.worst == pytest.approx([3e-12, 6e-13], rel=0.1)


@pytest.mark.parametrize(
    ("how", "words"),
    [
        ({"values": {("q0", 0): 1.0 + 0.9 * MARGIN * 2e-11}}, ""),
        ({"values": {("q0", 0): 1.0 + 1.1 * MARGIN * 2e-11}}, "q0"),
        ({"values": {("q0", 1): -2.0 - 1.1 * 2.0 * ROUNDING}}, "q0"),
        ({"values": {("u0", 1): 1.1 * 3.0 * ROUNDING}}, "u0"),
        ({"values": {("u0", 1): float("nan")}}, "u0"),
        ({"values": {("turn events", 0): 0.26}}, "turn events"),
        ({"counts": {"steps": 40 + COUNT_MARGIN}}, ""),
        ({"counts": {"steps": 41 + COUNT_MARGIN}}, "steps"),
        ({"counts": {"lcp": 1}}, "lcp"),
        ({"counts": {"body": -4}}, "body"),
        ({"worst": [3.1e-12, 0.0]}, "at most"),
        ({"worst": [0.0, 6.1e-13 + LEAST_BOUND]}, "at most"),
    ],
)
def test_what_has_moved_by_more_than_the_copies_is_said(how: dict, words: str) -> None:
    kept = recorded_of(told_record_file(), COPIES)
    assert kept is not None
    found = moved(changed(**how), kept)
    assert [line.startswith(words) for line in found] == ([True] if words else [])


def test_what_differs_by_chance_is_left_out() -> None:
    kept = recorded_of(told_record_file(), [told_record_file(turns=2, spread=0.1), told_record_file()])
    assert kept is not None and kept.counts["turn events"] is None and "turn events" not in kept.values
    assert moved(told_record_file(turns=5, spread=0.2), kept) == []


def test_runs_that_come_apart_are_not_recorded() -> None:
    assert recorded_of(told_record_file(), [told_record_file(1e-6)]) is None
