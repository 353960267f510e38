"""Is what a thread has done meanwhile the same as if it had been done later, and done then where it could not?"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from watchsim.commands.second.second_core import Meanwhile
from watchsim.profiles_path import profiles_dir
from watchsim.results.tables import EventLines, write_events
from watchsim.scene.file.load import load
from watchsim.simulation.simulate import simulate


def test_events_made_into_text_meanwhile_are_the_same_table(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """With buffers so small that they are emptied many times."""
    monkeypatch.setattr("watchsim.simulation.runner.EVENTS", 20)
    monkeypatch.setattr("watchsim.simulation.runner.ROWS", 100)
    scene = load(profiles_dir() / "bench_lever")
    meanwhile = Meanwhile(scene, tmp_path)
    run = simulate(scene, 0.3, progress=meanwhile.progress, follow=meanwhile.follow)
    lines = meanwhile.end()
    assert lines is not None and 50 < lines.rows <= len(run.events)
    lines.settle(run)
    write_events(run, tmp_path / "whole.csv")
    for name in ("begun.csv", "again.csv"):  # in another place, where the first could not be written to
        lines.write(run, tmp_path / name)
        assert (tmp_path / name).read_bytes() == (tmp_path / "whole.csv").read_bytes()


def test_events_that_the_disk_did_not_take_are_written_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = simulate(load(profiles_dir() / "bench_lever"), 0.1)
    lines = EventLines(run.scene, run.pairs, tmp_path)

    def full(_: int) -> None:
        raise OSError

    monkeypatch.setattr("watchsim.results.tables.os.fsync", full)
    lines.settle(run)
    lines.write(run, tmp_path / "begun.csv")
    write_events(run, tmp_path / "whole.csv")
    assert (tmp_path / "begun.csv").read_bytes() == (tmp_path / "whole.csv").read_bytes()


def test_what_fails_meanwhile_is_left_to_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: object) -> None:
        raise OSError

    monkeypatch.setattr(EventLines, "add", fails)
    scene = load(profiles_dir() / "bench_lever")
    meanwhile = Meanwhile(scene, tmp_path)
    meanwhile.follow([], np.zeros(1))
    assert meanwhile.end() is None
