"""How far apart are the rows of a stepped run, how long is a slice of it, and what is kept when it is taken up again?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.simulation.loop_state.buffers import new_until
from watchsim.simulation.moreau import time_stepping
from watchsim.simulation.moreau.time_stepping import MoreauRun
from watchsim.simulation.runner import Run
from watchsim.simulation.stops import Stop

STEP = 0.25


@pytest.mark.parametrize(("longest", "row"), [(600.0, 2.0), (60.0, STEP)])
def test_there_are_three_hundred_rows_in_a_quarter_of_a_period_but_none_between_steps(
    monkeypatch: pytest.MonkeyPatch, longest: float, row: float
) -> None:
    """And room in the buffers beyond what is emptied at once: for a step's rows, and two events of each contact."""

    def begin(self: Any, scene: object, compiled: Any, tolerance: float, recording: object) -> None:
        self.options = SimpleNamespace(max_step=longest)
        self.record = SimpleNamespace(windows="windows")

    monkeypatch.setattr(Run, "__init__", begin)
    monkeypatch.setattr(time_stepping, "moreau_work", lambda model: "work")
    monkeypatch.setattr(time_stepping, "room_for", lambda model: 11)
    monkeypatch.setattr(time_stepping, "new_record", lambda *given: given)
    any_scene: Any = None
    run = MoreauRun(any_scene, SimpleNamespace(model="model"), 1e-9, any_scene, STEP)  # type: ignore[arg-type]
    assert (run.step, run.pace.step, run.pace.row, run.work) == (STEP, STEP, row, "work")
    assert run.record == ("model", 20000 + 3, 20000 + 2 * 11, "windows")


def stepping(steps_done: float, code: Stop = Stop.SLICE) -> tuple[Stop, list[tuple[float, float]], Any]:
    """(why it stops, (start, end of the slice) as asked for, what is left to do) of ten steps from 2 s on, or to 9 s."""
    asked = []
    run: Any = object.__new__(MoreauRun)
    run.compiled, run.finder = SimpleNamespace(model=None), SimpleNamespace(cells=None)
    run.state, run.options, run.work = SimpleNamespace(clock=SimpleNamespace(time=2.0)), None, None
    run.pace = SimpleNamespace(step=STEP)
    until = new_until(slice_end=9.0, end=99.0, steps=10.0)

    def advance(model: object, cells: object, state: Any, options: object, until: Any, *others: object) -> Stop:
        asked.append((float(state.clock.time), float(until.slice_end)))
        state.clock.time += steps_done * STEP
        return code

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(time_stepping, "advance_fixed", advance)
        stop = run._advance(until, None)
    return stop, asked, until


@pytest.mark.parametrize(("done", "left"), [(10.0, 0.0), (7.0, 3.0), (6.6, 3.0), (0.0, 10.0)])
def test_a_slice_is_as_long_as_so_many_steps(done: float, left: float) -> None:
    """Those that were done are counted down, a shortened one as a whole."""
    stop, asked, until = stepping(done)
    assert stop == Stop.SLICE and asked == [(2.0, 2.0 + 10 * STEP)] and until.steps == left


def test_a_slice_ends_when_it_shall() -> None:
    run: Any = stepping(0.0, Stop.BUFFER_FULL)
    assert run[0] == Stop.BUFFER_FULL and isinstance(run[0], Stop)


def test_the_step_is_among_the_settings_and_what_is_kept_from_step_to_step_among_the_arrays(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    run: Any = object.__new__(MoreauRun)
    kept = SimpleNamespace(sweeps=17)
    run.step, run.work = STEP, SimpleNamespace(memory="memory", kept=kept)
    run.state = SimpleNamespace(sums=SimpleNamespace(correction=0.75))
    monkeypatch.setattr(Run, "settings", lambda self: {"other": 1.0})
    monkeypatch.setattr(Run, "arrays", lambda self: {"q": "q"})
    monkeypatch.setattr(Run, "counts", lambda self: {"lcp": 3})
    monkeypatch.setattr(Run, "_dissipated", lambda self: {"friction": 0.5})
    monkeypatch.setattr(
        time_stepping, "row_of", lambda kept: {name: name for name in ("depth", "sweeps", "row_time", "violation")}
    )
    assert run.settings() == {"other": 1.0, "step": STEP}
    assert run.arrays() == {"q": "q", "memory": "memory", "depth": "depth", "sweeps": "sweeps", "row_time": "row_time"}
    assert run.worst_residual() == "violation"
    assert run.counts() == {"lcp": 3, "sweeps": 17} and run._dissipated() == {"friction": 0.5, "stepping": 0.75}
    assert run._ledger_fails() is False


def test_states_of_earlier_versions_are_taken_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """Whose time of the last row stands behind two other times."""
    taken: list[Any] = []
    monkeypatch.setattr(Run, "begin_from", lambda self, saved: taken.append(saved.arrays))
    monkeypatch.setattr(time_stepping.dataclasses, "replace", lambda saved, arrays: SimpleNamespace(arrays=arrays))
    run: Any = object.__new__(MoreauRun)
    clock = np.array([1.0, 2.0, 3.5])
    run.begin_from(SimpleNamespace(arrays={"clock": clock}))
    run.begin_from(SimpleNamespace(arrays={"clock": clock, "row_time": np.array([7.0])}))
    assert taken[0]["row_time"].tolist() == [3.5] and taken[1]["row_time"].tolist() == [7.0]
