"""Do accidents to a file ever bring the reader down or lose geometry in silence?

`scripts/fuzz/fuzz_drawings.py` does the same with many more files, with limits of time and memory.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import judge_mutation
import mutate_dxf
import mutate_svg
import pytest

from watchsim.drawing.read import read

Accident = Callable[[random.Random, bytes], bytes]
MUTATORS = [mutate_dxf, mutate_svg]
ACCIDENTS = [(mutator, accident) for mutator in MUTATORS for accident in mutator.ACCIDENTS]


def judged(folder: Path, mutator: ModuleType, seeds: range) -> list[str]:
    path = folder / f"drawing.{mutator.ENDING}"
    wholes = []
    for sample in mutator.samples():
        path.write_bytes(sample)
        wholes.append(read(path))
        assert not wholes[-1].findings
    faults = []
    for seed in seeds:
        rng = random.Random(seed)
        k = rng.randrange(len(wholes))
        data = mutator.mutate(rng, mutator.samples()[k])
        path.write_bytes(data)
        faults.append(judge_mutation.fault(path, wholes[k], mutator))
    return faults


@pytest.mark.parametrize("mutator", MUTATORS, ids=lambda mutator: mutator.ENDING)
def test_tens_of_accidents(tmp_path: Path, mutator: ModuleType) -> None:
    assert not any(judged(tmp_path, mutator, range(30)))


@pytest.mark.slow
@pytest.mark.parametrize("mutator", MUTATORS, ids=lambda mutator: mutator.ENDING)
def test_hundreds_of_accidents(tmp_path: Path, mutator: ModuleType) -> None:
    assert not any(judged(tmp_path, mutator, range(1000, 1800)))


@pytest.mark.parametrize(
    ("mutator", "accident"),
    [(m, a) for m in MUTATORS for a in m.ACCIDENTS],
    ids=lambda one: one.__name__.removeprefix("mutate_"),
)
def test_every_kind_of_accident_changes_the_file(
    mutator: ModuleType, accident: Callable[[random.Random, bytes], bytes]
) -> None:
    data = mutator.samples()[0]
    assert sum(accident(random.Random(seed), data) != data for seed in range(20)) > 8


@pytest.mark.parametrize("mutator", MUTATORS, ids=lambda mutator: mutator.ENDING)
def test_both_readers_agree_on_the_whole_files(tmp_path: Path, mutator: ModuleType) -> None:
    path = tmp_path / f"drawing.{mutator.ENDING}"
    for sample in mutator.samples():
        path.write_bytes(sample)
        assert judge_mutation.agreed(read(path), mutator.length(path))
        assert not judge_mutation.agreed(read(path), 0.9 * (mutator.length(path) or 0.0))


def test_a_loss_in_silence_would_be_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "drawing.dxf"
    path.write_bytes(mutate_dxf.every_entity())
    whole = read(path)
    assert mutate_dxf.entities(mutate_dxf.every_entity()) == 11
    assert not judge_mutation.fault(path, whole, mutate_dxf)
    path.write_bytes(mutate_dxf.samples()[2])
    assert not judge_mutation.fault(path, whole, mutate_dxf), "ezdxf agrees that there is less"
    monkeypatch.setattr(mutate_dxf, "length", lambda _: 9.0)
    assert judge_mutation.fault(path, whole, mutate_dxf).startswith("silent loss: 17 before")
    monkeypatch.setattr(mutate_dxf, "entities", lambda _: 5)
    assert judge_mutation.fault(path, read(path), mutate_dxf).startswith("silent loss: 5 entities in the file, 4 read")
    assert mutate_dxf.lost(mutate_dxf.every_entity().replace(b"0\nINSERT", b"70\nINSERT"))
    assert not any(map(mutate_dxf.lost, mutate_dxf.samples()))


def test_an_exception_would_be_noticed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object) -> None:
        raise ZeroDivisionError

    path = tmp_path / "drawing.dxf"
    path.write_bytes(mutate_dxf.every_entity())
    whole = read(path)
    monkeypatch.setattr(judge_mutation, "inspect_text", broken)
    assert judge_mutation.fault(path, whole, mutate_dxf).startswith("exception:")


def test_a_loss_in_silence_would_be_noticed_in_svg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "drawing.svg"
    path.write_bytes(mutate_svg.every_element())
    whole = read(path)
    assert mutate_svg.entities(mutate_svg.every_element()) == 10
    path.write_bytes(mutate_svg.layered().replace(b'width="10" height="12"', b'width="20" height="12"'))
    assert not judge_mutation.fault(path, whole, mutate_svg), "the plain reading agrees that there is less"
    monkeypatch.setattr(mutate_svg, "length", lambda _: 9.0)
    assert judge_mutation.fault(path, whole, mutate_svg).startswith("silent loss: 18 before")
    monkeypatch.setattr(mutate_svg, "entities", lambda _: 5)
    assert judge_mutation.fault(path, read(path), mutate_svg).startswith("silent loss: 5 entities in the file, 3 read")
    assert mutate_svg.lost(b"<svg><text><![CDATA[<rect width='4'/>]]></text></svg>") and mutate_svg.lost(b"<svg><g></svg>")
    assert not any(map(mutate_svg.lost, mutate_svg.samples()))
