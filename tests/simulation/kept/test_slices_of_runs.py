"""What is done between the slices of a run, and what at its end? With a made-up loop."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.mechanism.compile import compile_scene
from watchsim.scene.body import Body
from watchsim.scene.force import Spring
from watchsim.scene.recording import Recording
from watchsim.scene.scene import Scene
from watchsim.simulation import runner, simulate
from watchsim.simulation.record.saved_state import SavedState
from watchsim.simulation.runner import Run
from watchsim.simulation.stops import Stop


class MadeUp(Run):
    """A run whose loop gives these codes in turn, half a second later each time, until 3 s."""

    def __init__(self, codes: list[Stop], **changed: Any) -> None:
        self.codes, self.told = list(codes), [self]
        self.said: list[Any] = []
        given: dict[str, Any] = {"ledger": [False], "overlaps": [False], "interrupted": [False], "look": math.inf, **changed}
        self.given = given
        self.state: Any = SimpleNamespace(
            clock=SimpleNamespace(time=0.0), q=np.array([0.25]), u=np.array([0.5]),
            worst=SimpleNamespace(kinetic_energy=3.0, penetration=1e-9),
            sums=SimpleNamespace(drive=7.0, friction=1.0, damping=2.0, impacts=0.5),
        )  # fmt: skip
        self.watch: Any = SimpleNamespace(
            next_look=lambda t: given["look"] * (math.floor(t / given["look"]) + 1.0) if given["look"] < math.inf else math.inf,
            see=lambda: self.said.append("see"), see_state=lambda t, q: self.said.append(("look", t)),
            fails=lambda admitted: self._next("overlaps") if admitted == 1e-9 else None,
        )  # fmt: skip
        self.record: Any = "record"
        self.saved = None
        self.tolerance, self.stored_at_start, self._usual_energy = 1e-9, 2.0, 1.0

    def _next(self, name: str) -> Any:
        values = self.given[name]
        return values.pop(0) if len(values) > 1 else values[0]

    def _advance(self, until: Any, record: Any) -> Stop:
        self.said.append(("slice", until.slice_end, until.may_cut))
        self.state.clock.time += 0.5
        code = self.codes.pop(0)
        if isinstance(code, type):
            raise code
        return code

    def _learn(self) -> None:
        self.said.append("learn")

    def flush(self) -> None:
        self.said.append("flush")

    def save(self) -> Any:
        self.said.append("save")
        return "saved"

    def _ledger_fails(self) -> bool:
        return bool(self._next("ledger"))

    def slices(self, progress: Any = None) -> tuple[Stop, list[Any]]:
        stop = self._slices(3.0, progress, lambda: self._next("interrupted"))
        return stop, [one for one in self.said if one[0] != "slice"]


def test_between_slices_cells_are_learnt_buffers_emptied_and_the_last_step_prepared() -> None:
    run = MadeUp([Stop.SLICE, Stop.CELL_UNKNOWN, Stop.BUFFER_FULL, Stop.LAST_STEP, Stop.DURATION])
    assert run.slices() == (Stop.DURATION, ["learn", "flush", "save"]) and run.saved == "saved"
    assert [one[2] for one in run.said if one[0] == "slice"] == [0, 0, 0, 0, 1]
    assert MadeUp([Stop.LCP_FAILED]).slices() == (Stop.LCP_FAILED, [])


def test_progress_is_told_after_each_slice_but_not_for_a_cell() -> None:
    told: list[tuple[float, float]] = []
    codes = [Stop.SLICE, Stop.CELL_UNKNOWN, Stop.BUFFER_FULL, Stop.DURATION]
    MadeUp(codes).slices(lambda now, duration: told.append((now, duration)))
    assert told == [(0.5, 3.0), (1.5, 3.0)]


def test_states_are_looked_at_when_their_time_has_come() -> None:
    run = MadeUp([Stop.SLICE] * 5 + [Stop.DURATION], look=1.0)
    assert run.slices()[1] == [("look", 1.0), ("look", 2.0)]
    assert max(one[1] for one in run.said if one[0] == "slice") <= 3.0


@pytest.mark.parametrize(
    ("name", "stop"), [("ledger", Stop.LEDGER), ("overlaps", Stop.OVERLAP), ("interrupted", Stop.INTERRUPTED)]
)
def test_a_run_that_checks_itself_ends_between_slices(name: str, stop: Stop) -> None:
    assert MadeUp([Stop.SLICE] * 3, **{name: [False, True]}).slices()[0] == stop
    codes = [Stop.CELL_UNKNOWN, Stop.SLICE, Stop.DURATION]
    assert MadeUp(codes, **{name: [True]}).slices()[0] == stop


def test_an_unknown_cell_lets_the_user_interrupt() -> None:
    assert MadeUp([Stop.CELL_UNKNOWN] * 9, interrupted=[False, False, True]).slices() == (Stop.INTERRUPTED, ["learn"] * 3)


@pytest.mark.parametrize(("raised", "stop"), [
    (KeyboardInterrupt, Stop.INTERRUPTED), (OverflowError, Stop.FAR_AWAY), (MemoryError, Stop.OUT_OF_MEMORY),
])  # fmt: skip
def test_what_is_raised_ends_a_run_and_what_there_is_is_kept(raised: Any, stop: Stop) -> None:
    run = MadeUp([raised])
    assert run.to_the_end(3.0, None) == stop and run.saved == "saved"  # type: ignore[comparison-overlap]
    assert run.said[1:] == ["save", "flush", ("look", 0.5), "see"]


def test_at_the_end_a_run_is_looked_at_and_its_books_are_closed() -> None:
    def ended(code: Stop, **changed: Any) -> Stop:
        return MadeUp([code], **changed).to_the_end(3.0, None)

    assert ended(Stop.DURATION) == Stop.DURATION
    assert ended(Stop.DURATION, ledger=[True]) == Stop.LEDGER and ended(Stop.DURATION, overlaps=[True]) == Stop.OVERLAP
    assert ended(Stop.DURATION, overlaps=[True], ledger=[True]) == Stop.OVERLAP
    assert ended(Stop.LCP_FAILED, overlaps=[True], ledger=[True]) == Stop.LCP_FAILED
    run = MadeUp([Stop.LAST_STEP, Stop.DURATION])
    assert run.to_the_end(3.0, None) == Stop.DURATION and run.said.count("save") == 1


@pytest.mark.parametrize(
    ("kinetic", "stored", "usual", "held"), [(3.0, 2.0, 1.0, 3.0), (1.0, 3.5, 2.0, 3.5), (1.0, 2.0, 4.5, 4.5)]
)
def test_the_ledger_is_held_against_the_most_energy_there_was(kinetic, stored, usual, held, monkeypatch) -> None:
    run = MadeUp([])
    run.state.worst.kinetic_energy, run.stored_at_start, run._usual_energy = kinetic, stored, usual
    asked: list[Any] = []
    monkeypatch.setattr(runner, "ledger_fails", lambda energy, most, tolerance: asked.append((energy, most, tolerance)) or True)
    monkeypatch.setattr(run, "energy", lambda: "books")
    assert Run._ledger_fails(run) and asked == [("books", held, 1e-9)]


def test_the_ledger_is_made_of_the_sums_and_what_is_stored_at_both_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    run = MadeUp([])
    run.compiled = SimpleNamespace(model="model")  # type: ignore[assignment]
    monkeypatch.setattr(runner, "stored_energy", lambda model, q, u: 4.0 + q[0] + u[0])
    monkeypatch.setattr(runner, "ledger", lambda *given: given)
    lost = {"friction": 1.0, "damping": 2.0, "impacts": 0.5}
    assert Run.energy(run) == (7.0, lost, (2.0, 4.75), "model")  # type: ignore[comparison-overlap]


@pytest.mark.parametrize(("duration", "tolerance", "method", "step", "says"), [
    (0.0, 1e-9, "moreau", None, "positive number of seconds"), (-1.0, 1e-9, "moreau", None, "positive"),
    (math.inf, 1e-9, "moreau", None, "positive"), (math.nan, 1e-9, "moreau", None, "positive"),
    (1.0, 0.99e-13, "moreau", None, "between 1e-13 and 0.01"), (1.0, 1.01e-2, "moreau", None, "between"),
    (1.0, math.nan, "moreau", None, "between"), (1.0, 1e-9, "euler", None, 'no method "euler"'),
    (1.0, 1e-9, "pfeiffer-glocker", 1e-5, "belongs to the method moreau"), (1.0, 1e-9, "moreau", 0.0, "up to the duration"),
    (1.0, 1e-9, "moreau", 1.01, "up to the duration"), (1.0, 1e-9, "moreau", -1e-9, "positive number"),
])  # fmt: skip
def test_bad_arguments_are_refused_in_words(duration, tolerance, method, step, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        simulate._check(duration, tolerance, method, step)


def test_arguments_at_their_limits_are_taken() -> None:
    for tolerance in (1e-13, 1e-2):
        simulate._check(1e-9, tolerance, "pfeiffer-glocker", None)
    simulate._check(1.0, 1e-9, "moreau", 1.0)
    simulate._check(1.0, 1e-9, "moreau", 1e-12)
    assert simulate._seconds("duration", "2.5 ms") == 2.5e-3 and simulate._seconds("step", 3) == 3.0
    with pytest.raises(ValueError, match=r"step: .*kg"):
        simulate._seconds("step", "2 kg")


def test_a_run_goes_on_from_a_state_that_lies_before_its_end() -> None:
    taken: list[Any] = []
    run: Any = SimpleNamespace(begin_from=taken.append)
    saved = SavedState({"clock": np.array([1.5, 0.0, 0.0])}, "", {}, 0.0)
    simulate._take_up(run, saved, 1.6)
    assert taken == [saved]
    for duration in (1.5, 1.0):
        with pytest.raises(ValueError, match=r"reached 1.5 s already; the duration"):
            simulate._take_up(run, saved, duration)


def test_a_run_begins_with_room_for_what_it_keeps() -> None:
    """Windows reach a longest step further, a quarter of the period; the first step is a thousandth of that; 20000 and more."""
    balance = Body("balance", "pivot", angle=0.75, velocity=(0.5,), inertia=2e-9)
    scene = Scene("one", (balance,), springs=(Spring("balance", 8e-9, rest=0.25),), duration=3.0)
    run = Run(scene, compile_scene(scene), 1e-8, Recording(((4.0, 5.0), (7.0, 8.0))))
    quarter = 0.5 * math.pi / 2.0
    assert run.options.max_step == pytest.approx(quarter) and run.state.clock.step == pytest.approx(1e-3 * quarter)
    assert run.record.windows == pytest.approx(np.array([[4.0, 5.0], [7.0, 8.0]]) + quarter * np.array([-1.0, 1.0]))
    assert run.record.rows.shape == (20000 + 136, 4) and run.record.events.shape == (20000 + 20 * 48,)
    assert (run.method, run.step, run.parts_before, run.saved, run.tolerance) == ("pfeiffer-glocker", None, 0, None, 1e-8)
    assert run.stored_at_start == pytest.approx(0.5 * 2e-9 * 0.25 + 0.5 * 8e-9 * 0.25)
    assert run.kept.tail == pytest.approx((8.0 + 4.0) * math.pi) and run.settings()["gap_zero"] == run.options.gap_zero
    assert run.counts()["declared_pairs"] == 0 == run.counts()["cells"]


def test_buffers_are_emptied_into_sums_watch_and_what_is_kept() -> None:
    run, told = MadeUp([]), []
    run.record = SimpleNamespace(rows=np.arange(5), events=10 + np.arange(5), used=SimpleNamespace(rows=3, events=2))
    run.tally = SimpleNamespace(fold=lambda events: told.append(events.tolist()))  # type: ignore[assignment]
    run.watch = SimpleNamespace(see_rows=lambda rows: told.append(rows.tolist()))  # type: ignore[assignment]
    run.kept = SimpleNamespace(flush=lambda rows, events: told.append((rows.tolist(), events.tolist())))  # type: ignore[assignment]
    Run.flush(run)
    assert told == [[10, 11], [0, 1, 2], ([0, 1, 2], [10, 11])] and vars(run.record.used) == {"rows": 0, "events": 0}


@pytest.mark.parametrize("taken_back", [0.0, 1e-12])
def test_what_is_taken_back_at_the_start_moves_it(taken_back: float, monkeypatch: pytest.MonkeyPatch) -> None:
    run = MadeUp([])
    run.scene = run.finder = run.options = None  # type: ignore[assignment]
    run.compiled = SimpleNamespace(model="model")  # type: ignore[assignment]
    monkeypatch.setattr(runner, "clear_start", lambda *_: (np.array([0.75]), taken_back))
    monkeypatch.setattr(runner, "stored_energy", lambda model, q, u: 10.0 * q[0] + u[0])
    run.begin()
    found = (run.state.q[0], run.state.worst.penetration, run.stored_at_start)
    assert found == ((0.75, 1e-12, 8.0) if taken_back else (0.25, 1e-9, 2.0))
