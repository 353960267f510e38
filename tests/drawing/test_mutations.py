"""Do accidents to a file ever bring the reader down or lose geometry in silence?

`scripts/fuzz_drawings.py` does the same with many more files, with limits of time and memory.
"""

from __future__ import annotations

import random
from pathlib import Path

import judge_mutation
import mutate_dxf
import pytest

from watchsim.drawing.read import read


def judged(folder: Path, seeds: range) -> list[str]:
    path = folder / "drawing.dxf"
    wholes = []
    for sample in mutate_dxf.samples():
        path.write_bytes(sample)
        wholes.append(read(path))
        assert not wholes[-1].findings
    faults = []
    for seed in seeds:
        rng = random.Random(seed)
        k = rng.randrange(len(wholes))
        data = mutate_dxf.mutate(rng, mutate_dxf.samples()[k])
        path.write_bytes(data)
        faults.append(judge_mutation.fault(path, wholes[k], mutate_dxf))
    return faults


def test_tens_of_accidents(tmp_path: Path) -> None:
    assert not any(judged(tmp_path, range(60)))


@pytest.mark.slow
def test_hundreds_of_accidents(tmp_path: Path) -> None:
    assert not any(judged(tmp_path, range(1000, 1800)))


@pytest.mark.parametrize("accident", mutate_dxf.ACCIDENTS, ids=lambda accident: accident.__name__)
def test_every_kind_of_accident_changes_the_file(accident: object) -> None:
    data = mutate_dxf.every_entity()
    changed = [accident(random.Random(seed), data) != data for seed in range(20)]  # type: ignore[operator]
    assert sum(changed) > 8


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
