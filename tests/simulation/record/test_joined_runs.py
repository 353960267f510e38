"""What becomes of rows, events and times on the clock where a run goes on from a saved state?"""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from watchsim.scene.body import Body
from watchsim.scene.scene import Scene
from watchsim.simulation.event_kinds import EVENT_DTYPE
from watchsim.simulation.record.joined_runs import joined
from watchsim.simulation.record.saved_state import SavedState
from watchsim.simulation.record.trajectory import Trajectory
from watchsim.simulation.stops import Stop

SCENE = Scene("one", (Body("one", "pivot"),))


def saved(rows: int, events: int, **recorded: object) -> SavedState:
    return SavedState({}, "", {}, 0.0, rows=rows, events=events, recorded={k: np.asarray(v) for k, v in recorded.items()})


def part(times: list[float], events: list[float], state: SavedState | None, **more: object) -> Trajectory:
    """A part of a run: its places say its times."""
    t, rows = np.array(times), np.zeros(len(events), EVENT_DTYPE)
    rows["t"] = events
    q = t[:, None]
    given = {"simulated": times[-1], "end_state": state, **more}
    return Trajectory(SCENE, t, q, 10.0 * q, 100.0 * q, {"one": slice(0, 1)}, rows, (), Stop.DURATION, **given)


def times_of(run: Trajectory) -> list[float]:
    assert run.q[:, 0].tolist() == run.t.tolist()
    assert np.array_equal(run.u, 10.0 * run.q) and np.array_equal(run.a, 100.0 * run.q)
    return run.t.tolist()


def test_up_to_its_state_the_first_part_counts_and_times_on_the_clock_add_up() -> None:
    first = part([0.0, 1.0, 2.0, 2.5], [0.5, 1.5, 2.2], saved(3, 2), wall=3.0, compile=2.0)
    rest = part([3.0, 4.0], [2.2, 3.5], saved(1, 1), wall=5.0, compile=0.5)
    whole = joined(first, rest)
    assert times_of(whole) == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert whole.events["t"].tolist() == [0.5, 1.5, 2.2, 3.5]
    assert (whole.wall, whole.compile, whole.simulated) == (8.0, 2.5, 4.0)
    assert whole.end_state is not None
    assert (whole.end_state.rows, whole.end_state.events) == (4, 3)
    assert whole.end_state.recorded["stays"].tolist() == [True] * 4


def test_where_the_rest_has_no_state_the_whole_has_none() -> None:
    first, rest = part([0.0, 1.0], [], saved(2, 0)), part([2.0], [], None)
    assert joined(first, rest).end_state is None
    assert times_of(joined(first, dataclasses.replace(rest, keep="statistics"))) == [0.0, 1.0, 2.0]
    with pytest.raises(ValueError, match="no end state"):
        joined(rest, first)


@pytest.mark.parametrize("keep", ["all", "events", "statistics"])
def test_a_row_that_waited_for_the_next_one_is_told_by_the_rest(keep: str) -> None:
    """Where all is kept, rows that wait are not among those told, so that none is left out."""
    first = part([0.0, 1.0, 2.0], [0.5], saved(3, 1, row=[2.0, 2.0, 20.0, 200.0], stays=[True, True, False]), keep=keep)
    rest = part([2.0, 3.0] if keep != "all" else [3.0], [2.5], saved(1, 1, stays=[True]), keep=keep)
    assert times_of(joined(first, rest)) == [0.0, 1.0, 2.0, 3.0]


@pytest.mark.parametrize("keep", ["events", "statistics"])
def test_of_the_first_part_its_last_seconds_are_forgotten(keep: str) -> None:
    """Two seconds are kept of the whole, and the row before them; of the first part what stays for good or is in windows."""
    stays = [True, False, False, False, False]
    first = part([0.0, 1.0, 2.0, 3.0, 4.0], [0.5, 1.5, 3.5], saved(5, 3, row=[], stays=stays), keep=keep)
    state = saved(2, 1, stays=[False, False])
    rest = part([5.0, 6.0], [4.2, 5.5], state, keep=keep, spans=((0.0, 0.9), (4.0, 6.0)))
    whole = joined(first, rest)
    assert times_of(whole) == [0.0, 4.0, 5.0, 6.0]
    assert whole.events["t"].tolist() == ([0.5, 4.2, 5.5] if keep == "statistics" else [0.5, 1.5, 3.5, 4.2, 5.5])
    assert whole.end_state is not None
    assert whole.end_state.rows == 4 and whole.end_state.recorded["stays"].tolist() == [True, False, False, False]
    assert whole.end_state.events == (2 if keep == "statistics" else 4)


def test_of_a_run_shorter_than_the_tail_all_stays() -> None:
    first = part([0.0, 0.5], [], saved(2, 0, row=[], stays=[False, False]), keep="events")
    rest = part([1.0, 1.5], [], saved(1, 0, stays=[False]), keep="events")
    assert times_of(joined(first, rest)) == [0.0, 0.5, 1.0, 1.5]
