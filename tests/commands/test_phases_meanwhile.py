"""Are phases that were made into text while a run went on those of the whole run?"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from every_time import few
from numpy.typing import NDArray

from watchsim.analysis import beat_tables
from watchsim.analysis.beat_tables import phases_csv
from watchsim.analysis.timing import phases
from watchsim.analysis.timing.beats import beats
from watchsim.commands.second.made_beside import PhasesMeanwhile
from watchsim.commands.second.settled import Settled
from watchsim.profiles_path import profiles_dir
from watchsim.scene.file.load import load
from watchsim.scene.oscillation import frequency
from watchsim.scene.scene import Scene
from watchsim.simulation.record.trajectory import Pair, Trajectory
from watchsim.simulation.simulate import simulate

BEATS = 4  # that are made into text together, instead of hundreds


def run_and_texts(
    scene: Scene, seconds: float, monkeypatch: pytest.MonkeyPatch, until: float = math.inf
) -> tuple[Trajectory, PhasesMeanwhile]:
    for module in (phases, beat_tables):
        monkeypatch.setattr(module, "AT_ONCE", BEATS)
    monkeypatch.setattr("watchsim.simulation.runner.EVENTS", 10)
    monkeypatch.setattr("watchsim.simulation.runner.ROWS", 40)
    meanwhile, settled = PhasesMeanwhile(scene, until, "pfeiffer-glocker", scene.tolerance), Settled()

    def follow(pairs: Sequence[Pair], events: NDArray[Any], rows: Sequence[NDArray[Any]]) -> None:
        settled.add(events, rows)
        meanwhile.work(pairs, settled)

    return simulate(scene, seconds, follow=follow), meanwhile


def whole(run: Trajectory, ready: dict[bytes, str] | None = None) -> str:
    return "".join(phases_csv(run, beats(run), ready))


LEVERS = ("swiss_lever", "bench_lever", "pin_pallet", "detent", "remontoir", "tourbillon", "carriage")
ANCHORS = ("graham", "recoil_anchor", "pin_wheel", "cylinder", "duplex", "grasshopper")


@pytest.mark.parametrize("profile", few([*LEVERS, *ANCHORS], 3))
def test_texts_of_finished_phases_fit(profile: str, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = load(profiles_dir() / profile).set("run.record", ["all"])
    run, meanwhile = run_and_texts(scene, 16.0 / frequency(scene), monkeypatch)
    parts = [part.content for part in phases.stretches(run, beats(run))]
    ready = [part in meanwhile.texts for part in parts]
    assert sum(ready) >= 2
    assert sum(ready) == len(meanwhile.texts)  # nothing was made in vain
    assert whole(run, meanwhile.texts) == whole(run)


def test_what_is_ready_is_not_worked_out_again(monkeypatch: pytest.MonkeyPatch) -> None:
    run, meanwhile = run_and_texts(load(profiles_dir() / "bench_lever"), 3.0, monkeypatch)
    other = dict.fromkeys(meanwhile.texts, "ready\n")
    text = whole(run, other)
    assert text.count("ready\n") == len(other) > 2
    assert whole(run).endswith(text[text.rindex("ready\n") + len("ready\n") :])


def test_near_the_end_nothing_is_begun(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = load(profiles_dir() / "bench_lever")
    part = 0.5 * BEATS / frequency(scene)  # s
    _, all_along = run_and_texts(scene, 3.0, monkeypatch)
    _, meanwhile = run_and_texts(scene, 3.0, monkeypatch, until=1.5 + part)
    assert 0 < len(meanwhile.texts) < len(all_along.texts)


@pytest.mark.parametrize("record", ["events", "statistics", ["0 s", "1 s"]])
def test_what_is_not_kept_whole_is_left_alone(record: object, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = load(profiles_dir() / "bench_lever").set("run.record", [record])
    _, meanwhile = run_and_texts(scene, 1.5, monkeypatch)
    assert not meanwhile.texts


def test_of_more_than_memory_should_hold_there_is_less(monkeypatch: pytest.MonkeyPatch) -> None:
    _, all_along = run_and_texts(load(profiles_dir() / "bench_lever"), 3.0, monkeypatch)
    monkeypatch.setattr("watchsim.commands.second.settled.MOST", 3e5)
    run, meanwhile = run_and_texts(load(profiles_dir() / "bench_lever"), 3.0, monkeypatch)
    assert 0 < len(meanwhile.texts) < len(all_along.texts)
    assert whole(run, meanwhile.texts) == whole(run)


def test_a_scene_without_beats_is_left_alone() -> None:
    scene = load(profiles_dir() / "incline")
    meanwhile = PhasesMeanwhile(scene, math.inf, "pfeiffer-glocker", scene.tolerance)
    settled = Settled()
    settled.add(np.zeros(0), [np.array([1e9])] * 4)
    meanwhile.work((), settled)
    assert not meanwhile.texts
