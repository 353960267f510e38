"""What is written down of impacts, changes of mode and rows, and do the sums of energy agree with it?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.contact.index_sets import BACKWARD, FORWARD, OPEN, STICK
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.events import collision
from watchsim.simulation.record.write_buffers import is_kept, keep_change, keep_row

MASS = np.array([2.0, 0.5, 1.0])
BEFORE, AFTER = np.array([1.0, -2.0, 0.3]), np.array([0.4, -1.2, 0.3])
W = np.array([[1.0, 0.2, 0.0], [0.0, 1.0, -0.5], [0.3, -1.0, 0.0], [0.7, 0.1, 0.0]])  # N, T of two contacts
IDS = [4, 6]


def books() -> tuple[SimpleNamespace, SimpleNamespace]:
    """A state and a record with room for ten events."""
    sums = SimpleNamespace(impacts=0.5, drive=0.25)
    counts = SimpleNamespace(impacts=0, jams=0, accumulations=0, events=0)
    state = SimpleNamespace(
        u=AFTER.copy(), sums=sums, counts=counts, clock=SimpleNamespace(time=1.5), mode=np.zeros(9, np.int8)
    )
    return state, SimpleNamespace(events=np.zeros(10, EVENT_DTYPE).view(np.recarray), used=SimpleNamespace(events=0, rows=0))


def rates(closed, m, u, out):
    out[: 2 * m] = W[: 2 * m] @ u


def written(impulse: list[float], *, jam: float = 0.0, ended: bool = False, restitution=(0.0, 0.0)):
    state, record = books()
    room = SimpleNamespace(
        before=BEFORE, rates_before=np.zeros(4), rates=np.zeros(4), impulse=np.array(impulse), restitution=np.array(restitution)
    )
    laws = [SimpleNamespace(restitution=0.6), SimpleNamespace(restitution=0.0)]
    model = SimpleNamespace(laws=laws, contacts=[SimpleNamespace(group=int(k == 6)) for k in range(8)])
    instead = {"contact_velocities": rates, "drive_through_contacts": lambda *_: 0.125}
    closed = SimpleNamespace(ids=IDS)
    in_python(collision._write, **instead)(model, state, 2, jam, closed, room, record, ended, 1.75)
    return state, record.events[: record.used.events]


def test_losses_of_contacts_are_their_impulses_times_the_mean_of_their_rates() -> None:
    impulse = [2.0, -0.3, 1.0, 0.4]
    state, events = written(impulse)
    lost = -np.array(impulse) * (W @ (BEFORE + AFTER)) / 2.0
    assert events["kind"].tolist() == [EventKind.IMPACT] * 2 and events["contact"].tolist() == IDS
    assert events["energy_lost"] == pytest.approx([lost[:2].sum(), lost[2:].sum()])
    assert events["impulse_normal"].tolist() == [2.0, 1.0] and events["impulse_tangential"].tolist() == [-0.3, 0.4]
    assert events["value"] == pytest.approx((W @ BEFORE)[::2])
    assert events["t"].tolist() == [1.5, 1.5] and (events["body"] == -1).all()
    assert state.sums.impacts == pytest.approx(0.5 + lost.sum()) and state.sums.drive == 0.375
    assert vars(state.counts) == {"impacts": 2, "jams": 0, "accumulations": 0, "events": 2}


def test_a_contact_without_an_impulse_is_not_hit() -> None:
    state, events = written([0.0, 0.0, 1.0, 0.0])
    assert events["contact"].tolist() == [6] and state.counts.impacts == 1


def test_a_rebound_that_was_ended_says_when_it_would_have_ended() -> None:
    """Of contacts whose law has a restitution that has been taken away."""
    state, events = written([1.0, 0.0, 1.0, 0.0], ended=True)
    assert events["kind"].tolist() == [EventKind.IMPACT, EventKind.ACCUMULATION, EventKind.IMPACT]
    assert events["value"][1] == 1.75 and state.counts.accumulations == 1
    assert len(written([1.0, 0.0, 1.0, 0.0], ended=True, restitution=(0.6, 0.0))[1]) == 2


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_a_jam_is_a_slip_that_is_stopped_while_the_gap_stands_still(share: float) -> None:
    """Rates before: gap 0.6, slip -2.15 of contact 4; gap 2.3, slip 0.5 of contact 6."""
    state, events = written([1.0, 0.0, 1.0, 0.0], jam=0.6 / share)
    jams = events[events["kind"] == EventKind.JAM]
    assert jams["contact"].tolist() == ([4] if share < 1.0 else []) and state.counts.jams == len(jams)
    assert jams["value"] == pytest.approx([(W @ BEFORE)[1]] * len(jams))


def chatter_ended(found: bool = True, closing: float = 0.0) -> tuple[SimpleNamespace, np.ndarray, int]:
    """At (state, events, how often contacts were read again) after a chatter of two contacts that takes 0.02 s."""
    state, record = books()
    state.u, state.q, state.a = BEFORE.copy(), None, None
    refreshed = []
    kin = [SimpleNamespace(gN_dot=1e-3), SimpleNamespace(gN_dot=1e-10)]
    event = SimpleNamespace(closed=SimpleNamespace(kin=kin, ids=IDS), rest=None, pose=None, zero=[1e-9, 1e-9])
    room = SimpleNamespace(before=BEFORE + 1.0, rates=np.zeros(4), ending=None)

    def end(model, state, m, ended, work, event, room):
        energy = 0.5 * float(MASS @ (BEFORE + 1.0) ** 2), 0.5 * float(MASS @ BEFORE**2)
        assert ended == (0.02, pytest.approx(energy[0] - energy[1]))
        state.u[:] = AFTER
        return found, 2

    instead = {
        "kinetic_energy": lambda model, u: 0.5 * float(MASS @ u**2),
        "end_chatter": end,
        "count_problems": lambda *_: None,
        "contact_velocities": lambda closed, m, u, out: out.__setitem__(slice(0, 4), [closing, 9.0, 0.0, -9.0]),
        "return_time": lambda closed, i, a: 0.01,
        "place": lambda *_: None,
        "refresh": lambda *_: refreshed.append(1),
        "drive_through_contacts": lambda *_: 0.125,
    }
    in_python(collision._end_chatter, **instead)(
        None, state, 2, 0.02, SimpleNamespace(work=None, event=event, impact=room), record
    )
    return state, record.events[: record.used.events], len(refreshed)


def test_an_ended_chatter_takes_what_energy_is_missing_then() -> None:
    state, events, refreshed = chatter_ended()
    lost = 0.5 * float(MASS @ (BEFORE**2 - AFTER**2))
    assert state.u.tolist() == AFTER.tolist() and refreshed == 1
    assert state.sums.drive == 0.375 and state.sums.impacts == pytest.approx(0.5 + lost + 0.125)
    assert events["kind"].tolist() == [EventKind.ACCUMULATION] and events["contact"].tolist() == [4]
    assert events["value"][0] == pytest.approx(1.51) and state.counts.accumulations == 1


@pytest.mark.parametrize(("found", "closing"), [(False, 0.0), (True, -1.1e-9)])
def test_where_no_end_is_found_impacts_go_on_as_if_nothing_had_been_tried(found: bool, closing: float) -> None:
    state, events, refreshed = chatter_ended(found, closing)
    assert state.u.tolist() == BEFORE.tolist() and len(events) == refreshed == 0
    assert (state.sums.drive, state.sums.impacts) == (0.25, 0.5)


def test_rates_within_rounding_do_not_close() -> None:
    assert chatter_ended(True, -0.9e-9)[0].u.tolist() == AFTER.tolist()


@pytest.mark.parametrize(
    ("old", "new", "kind", "value"),
    [
        (OPEN, STICK, EventKind.CLOSE, float(STICK)),
        (OPEN, FORWARD, EventKind.CLOSE, float(FORWARD)),
        (STICK, OPEN, EventKind.OPEN, 0.0),
        (FORWARD, STICK, EventKind.STICK, 0.0),
        (STICK, BACKWARD, EventKind.SLIDE, float(BACKWARD)),
        (BACKWARD, FORWARD, EventKind.SLIDE, float(FORWARD)),
        (STICK, STICK, None, 0.0),
        (OPEN, OPEN, None, 0.0),
    ],
)
def test_a_change_of_mode_has_its_own_event(old: int, new: int, kind: EventKind | None, value: float) -> None:
    state, record = books()
    state.mode[5] = new
    in_python(keep_change)(state, record, 5, old)
    assert record.used.events == (kind is not None)
    if kind is not None:
        event = record.events[0]
        assert (event.kind, event.contact, event.body, event.value, event.t) == (kind, 5, -1, value, 1.5)


def test_rows_are_kept_within_windows_and_no_others() -> None:
    record = SimpleNamespace(rows=np.zeros((9, 7)), used=SimpleNamespace(rows=0), windows=np.array([[1.0, 2.0], [5.0, 6.0]]))
    for t in (0.999, 1.0, 2.0, 2.001, 4.999, 5.5, 6.001):
        in_python(keep_row)(None, record, t, np.array([t, 2.0]), np.array([3.0, 4.0]), np.array([5.0, 6.0]))
    assert record.rows[: record.used.rows].tolist() == [[t, t, 2.0, 3.0, 4.0, 5.0, 6.0] for t in (1.0, 2.0, 5.5)]
    kept = in_python(is_kept)
    assert kept(record, 0.5, 0.5) and not kept(record, 0.5, 0.49) and kept(record, 3.0, 2.0) and not kept(record, 3.0, 1.9)
