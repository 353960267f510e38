"""Which tolerances and rooms has a run? Against the numbers of the method, for a scene of any size."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.simulation.loop_state.buffers import new_record, new_until
from watchsim.simulation.loop_state.scratch import new_scratch
from watchsim.simulation.loop_state.state import COUNT_NAMES, NO_CONTACT, new_state, room_for
from watchsim.simulation.loop_state.state_arrays import arrays_of, copy_of_state, write_state
from watchsim.simulation.methods import METHODS, MOREAU, USUAL_STEP
from watchsim.simulation.options import natural_step, options_for


@pytest.mark.parametrize("size", [0.4, 3e-3])
@pytest.mark.parametrize(
    ("tolerance", "behind", "speed"),
    [(1e-12, 2e-8, 1e-8), (1e-10, 2e-8, 1e-8), (2e-9, 4e-8, 4e-8), (1e-7, 2e-6, 2e-6), (1e-3, 2e-5, 2e-2)],
)
def test_lengths_and_speeds_that_are_zero_scale_with_the_size(
    size: float, tolerance: float, behind: float, speed: float
) -> None:
    options = options_for(size, tolerance, 0.125)
    lengths = {"gap_zero": 1e-13, "gap_close": 2e-10, "behind": behind, "sunk": 2e-5, "extent": 1.2e-10, "speed_zero": speed}
    for name, share in {**lengths, "accumulation_speed": 0.1}.items():
        assert getattr(options, name) == pytest.approx(share * size, rel=1e-12, abs=0.0)
    assert (options.tolerance, options.size, options.max_step) == (tolerance, size, 0.125)
    assert (options.force_zero, options.sleep, options.accumulation_time) == (1e-10, 1e-9, 1e-6)


@pytest.mark.parametrize(("tolerance", "phase"), [
    (1e-9, 0.1), (1e-8, 0.1), (1e-10, 0.1 * 10.0**-0.2), (1e-12, 0.1 * 10.0**-0.6), (3e-14, 0.0125), (1e-13, 0.1 * 10.0**-0.8),
])  # fmt: skip
def test_rows_lie_closer_by_the_fifth_root_of_the_tolerance(tolerance: float, phase: float) -> None:
    assert options_for(1.0, tolerance, 0.125).row_phase == pytest.approx(phase, rel=1e-12)


def test_ways_of_stepping_have_names_and_a_usual_step() -> None:
    """Ten microseconds, as the manual says."""
    assert (METHODS, MOREAU, USUAL_STEP) == (("pfeiffer-glocker", "moreau"), "moreau", 1e-5)


def test_no_step_is_longer_than_a_quarter_of_the_fastest_period() -> None:
    def step(fastest: float) -> float:
        compiled: Any = SimpleNamespace(fastest=fastest)
        return natural_step(compiled, 3.0)

    assert step(8.0) == pytest.approx(2.0 * math.pi / 8.0 / 4.0) and step(0.1) == 3.0 == step(0.0)


def model(n: int = 3, bodies: int = 2, contacts: int = 5, pairs: int = 4) -> Any:
    fields = [("rest", "f8")]
    joints = np.zeros(2, [("watched", "i8"), ("coordinate", "i8"), ("on", "i8"), ("rest", "f8")]).view(np.recarray)
    joints.watched, joints.coordinate, joints.on, joints.rest = [0, 1], [0, 2], [1, 0], [9.0, 0.25]
    return SimpleNamespace(
        coordinates=np.full(n, 0.5).astype(fields).view(np.recarray), bodies=[None] * bodies, contacts=[None] * contacts,
        pairs=[None] * pairs, joints=joints,
    )  # fmt: skip


@pytest.mark.parametrize(("n", "room"), [(3, 48), (24, 48), (25, 50), (100, 200)])
def test_as_many_contacts_may_close_at_once(n: int, room: int) -> None:
    """Two for each coordinate, or four dozen."""
    assert room_for(model(n)) == room


def test_room_is_as_large_as_what_it_holds() -> None:
    """Three coordinates, two bodies, five contacts, four pairs of bodies; 48 contacts closed at once."""
    scratch = new_scratch(model())
    n, width, room, monitors = 3, 2 * 3 + 3, 48, 4 * (48 + 3)
    step, smooth, event, impact, path = scratch.step, scratch.smooth, scratch.event, scratch.impact, scratch.path
    assert [array.shape for array in step[1:]] == [(n,), (n,), (n,), (width,), (width,), (16, width), (7, width)]
    assert [len(array) for array in (smooth.y, smooth.dy)] == [width] * 2 and len(smooth.closed.ids) == room
    assert [len(array) for array in (smooth.monitors, smooth.before, smooth.fired)] == [monitors] * 3
    assert [len(array) for array in (smooth.engaged, smooth.load, smooth.terms)] == [2, n, n] and len(smooth.pose) == 2
    assert [len(event.closed.ids), len(event.rest.ids), len(event.pose)] == [room, room, 2]
    assert [len(array) for array in event[3:]] == [n, room, n, room, room, 5, 5, room, n, n]
    assert [len(array) for array in impact] == [room, 2 * room, n, 2 * room, 2 * room, n, 2 * room, 5]
    assert [len(path.q), len(path.u), len(path.pose), len(path.probe.ids), len(path.waiting)] == [n, n, 2, 1, 5 + 4]
    assert len(scratch.asked.at) == n and len(scratch.ended.by) == 64


def test_buffers_are_empty_and_hold_time_places_velocities_and_accelerations() -> None:
    windows = np.array([[1.0, 2.0]])
    record = new_record(model(), 7, 5, windows)
    assert record.rows.shape == (7, 10) and record.events.shape == (5,) and record.windows is windows
    assert (record.used.rows, record.used.events) == (0, 0)
    until = new_until(1.5, 2.5, True, 3.5)
    assert (until.slice_end, until.end, until.may_cut, until.steps) == (1.5, 2.5, 1, 3.5)
    nothing = new_until()
    assert (nothing.slice_end, nothing.end, nothing.may_cut, nothing.steps) == (0.0, 0.0, 0, 0.0)


def a_state() -> Any:
    return new_state(model(), np.array([0.6, 0.4, 0.9]), np.array([-1.0, 2.0, -0.5]))


def test_a_run_begins_awake_with_an_event_and_knows_on_which_side_springs_are() -> None:
    """Rest at 0.5; the third coordinate is seen against the first one, from which it rests 0.25 away."""
    state = a_state()
    assert (state.q.tolist(), state.u.tolist(), state.a.tolist()) == ([0.6, 0.4, 0.9], [-1.0, 2.0, -0.5], [0.0] * 3)
    assert (state.now.event_waits, state.now.touched, state.now.lenience) == (1, NO_CONTACT, 1.0)
    assert (state.returning.contact, state.clock.time, state.now.awake_contacts) == (NO_CONTACT, 0.0, 0)
    assert state.awake.tolist() == [1] * 3 and state.grip.tolist() == [0] * 3 and state.mode.tolist() == [0] * 5
    assert (len(state.active), len(state.upto), len(state.decided)) == (48, 48, 32)
    assert state.side_u.tolist() == [-1, 1, 1]  # -0.5 against -1
    assert state.side_q.tolist() == [1, -1, 1]  # 0.9 against 0.6 + 0.25


def test_a_state_is_saved_and_copied_with_all_it_holds() -> None:
    state = a_state()
    numbers = ("awake_contacts", "sleeping_contacts", "event_waits", "events", "touched", "decisions")
    for i, name in enumerate(numbers):
        setattr(state.now, name, 10 + i)
    state.now.lenience = 0.75
    for i, name in enumerate(("contact", "hits")):
        setattr(state.returning, name, 20 + i)
    for i, name in enumerate(("last", "away", "rate")):
        setattr(state.returning, name, 0.5 + i)
    for i, name in enumerate(name for name in COUNT_NAMES if not name.startswith("lcp_to") and name != "lcp_larger"):
        setattr(state.counts, name, i)
    state.counts.lcp_sizes[:] = 100 + np.arange(6)
    arrays = arrays_of(state)
    assert arrays.numbers.tolist() == [10, 11, 12, 13, 14, 15] and arrays.lenience.tolist() == [0.75]
    assert arrays.returning.tolist() == [20, 21] and arrays.returned.tolist() == [0.5, 1.5, 2.5]
    assert arrays.counts.tolist() == [*range(20), *range(100, 106)] and len(COUNT_NAMES) == 26
    copied, other = copy_of_state(state), a_state()
    arrays.numbers[3], arrays.returned[1], arrays.q[0] = 99, 9.5, 8.5
    assert (state.now.events, state.returning.away, state.q[0]) == (99, 9.5, 8.5)
    assert (copied.now.events, copied.returning.away, copied.q[0]) == (13, 1.5, 0.6)
    write_state(other, state)
    assert all(np.array_equal(one, two) for one, two in zip(arrays_of(other), arrays, strict=True))
