"""Are rows, events, frames and contacts told as the scene has them? Made up by hand, with carried and geared bodies."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.model.records import ARC, CORNER, LINE
from watchsim.scene.body import Body
from watchsim.scene.scene import Scene
from watchsim.simulation import frozen_run
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.interrupts import held_interrupts
from watchsim.simulation.record.body_frames import frames, speeds
from watchsim.simulation.record.contact_names import Pair, Pairs, as_pairs, pairs_of
from watchsim.simulation.record.saved_state import SavedState
from watchsim.simulation.record.scene_coordinates import events_of_scene, rows_of_scene
from watchsim.simulation.stops import Stop

BODIES = (
    Body("disc", "free"),
    Body("arm", "pivot", (3.0, -2.0), 0.4),
    Body("planet", "pivot", (0.5, 0.25), 0.1, on="arm"),
    Body("pin", "fixed", (-0.3, 0.6), 0.7, on="planet"),
    Body("rack", "slide", (1.0, 5.0), -0.2, axis=(0.6, -0.8)),
    Body("post", "fixed", (7.0, 8.0), 0.9),
)
SCENE = Scene("carried", BODIES)
SLICES = {"disc": slice(0, 3), "arm": slice(3, 4), "planet": slice(4, 5), "rack": slice(5, 6)}
Q = np.array([[0.3, -0.7, 1.1, 0.8, -0.6, 0.9], [1.3, 0.2, -0.4, 2.1, 1.7, -0.5]])
U = np.array([[0.5, -0.1, 0.9, 1.4, -2.3, 0.7], [-1.5, 0.6, 0.3, -0.8, 1.9, 2.2]])


def by_hand(q: np.ndarray) -> dict[str, tuple[complex, float]]:
    """Place and angle of every body by complex numbers."""
    arm, planet = (3.0 - 2.0j, q[3]), (0.5 + 0.25j, q[4])
    on_arm = arm[0] + planet[0] * np.exp(1j * arm[1]), arm[1] + planet[1]
    pin = on_arm[0] + (-0.3 + 0.6j) * np.exp(1j * on_arm[1]), on_arm[1] + 0.7
    return {
        "disc": (complex(q[0], q[1]), q[2]), "arm": arm, "planet": on_arm, "pin": pin,
        "rack": (1.0 + 5.0j + q[5] * (0.6 - 0.8j), -0.2), "post": (7.0 + 8.0j, 0.9),
    }  # fmt: skip


def test_frames_stand_on_their_carriers_and_move_with_them() -> None:
    found, rates = frames(SCENE, SLICES, Q), speeds(SCENE, SLICES, Q, U)
    step = 1e-6
    for k in range(2):
        there, before, after = by_hand(Q[k]), by_hand(Q[k] - step * U[k]), by_hand(Q[k] + step * U[k])
        for body in BODIES:
            place, angle = there[body.name]
            assert found[body.name][k] == pytest.approx([place.real, place.imag, angle], abs=1e-13)
            way = (after[body.name][0] - before[body.name][0]) / (2.0 * step)
            turn = (after[body.name][1] - before[body.name][1]) / (2.0 * step)
            assert rates[body.name][k] == pytest.approx([way.real, way.imag, turn], abs=1e-8)


def test_rows_are_told_relative_to_carriers_angles_not_rates() -> None:
    rows = np.arange(14.0).reshape(2, 7)
    compiled: Any = SimpleNamespace(relative=lambda q, rates=False: (q.tolist(), rates))
    t, q, u, a = rows_of_scene(compiled, rows)
    assert t.tolist() == [0.0, 7.0]
    assert (q, u, a) == (
        ([[1.0, 2.0], [8.0, 9.0]], False),
        ([[3.0, 4.0], [10.0, 11.0]], True),
        ([[5.0, 6.0], [12.0, 13.0]], True),
    )


def test_turns_of_carried_bodies_are_told_from_where_their_angle_counts() -> None:
    """Passages are velocities, and others keep their values; the loop's own events stay as they are."""
    events = np.zeros(6, EVENT_DTYPE)
    events["kind"] = [EventKind.TURN, EventKind.TURN, EventKind.CROSS, EventKind.TURN, EventKind.IMPACT, EventKind.TURN]
    events["body"], events["value"] = [4, 2, 4, 4, 4, 3], 5.0
    model = SimpleNamespace(coordinates=[SimpleNamespace(body=b) for b in (2, 4, 3)])
    compiled: Any = SimpleNamespace(model=model, against=[(0, -1, 0.0), (1, 0, 0.25), (2, 0, -0.5)])
    assert events_of_scene(compiled, events)["value"].tolist() == [4.75, 5.0, 5.0, 4.75, 5.0, 5.5]
    assert (events["value"] == 5.0).all()
    compiled.against = [(0, -1, 0.0)]
    assert events_of_scene(compiled, events) is events


def test_contacts_are_told_by_body_kind_number_within_it_and_layer() -> None:
    contacts = np.rec.fromarrays([[5, 7, 5], [3, 0, 4], [1, 2, 2]], names="group,a,b")
    model = SimpleNamespace(contacts=contacts, primitives=SimpleNamespace(kind=np.array([LINE, ARC, CORNER, ARC, LINE])))
    compiled: Any = SimpleNamespace(
        model=model, owners=["wheel", "wheel", "lever", "lever", "lever"], layers=["a", "b", "c", "d", "e"]
    )
    pairs = pairs_of(compiled)
    wanted = (
        Pair(5, "lever", "arc", 1, "d", "wheel", "arc", 1, "b"), Pair(7, "wheel", "line", 0, "a", "lever", "corner", 0, "c"),
        Pair(5, "lever", "line", 2, "e", "lever", "corner", 0, "c"),
    )  # fmt: skip
    assert tuple(pairs) == wanted and pairs[1] == wanted[1] and pairs[-1] == wanted[2] and pairs[1:] == wanted[1:]
    assert pairs == wanted and pairs == as_pairs(wanted) and as_pairs(pairs) is pairs and hash(pairs) == hash(wanted)
    assert (
        pairs != wanted[:2] and pairs != as_pairs(wanted[::-1]) and len(pairs) == 3 and repr(pairs) == "<3 pairs of primitives>"
    )
    assert pairs.of_body("wheel").tolist() == [True, True, False] and pairs.of_body("lever").tolist() == [True] * 3
    assert str(wanted[0]) == "lever.d arc 1 / wheel.b arc 1"
    made = as_pairs(wanted)
    assert len(made.names) == 5 and made.table[:, 0].tolist() == [5, 7, 5]


def test_many_pairs_are_read_some_at_a_time() -> None:
    names = [("one", "line", 0, "a"), ("two", "arc", 3, "b")]
    table = np.zeros((9000, 3), np.int32)
    table[:, 0], table[:, 2] = np.arange(9000), 1
    pairs = Pairs(names, table)
    assert [pair.group for pair in pairs] == list(range(9000)) and not pairs.table.flags.writeable
    assert pairs[4096] == Pair(4096, *names[0], *names[1])


def ended(saved: SavedState | None, closed: Any = None) -> Any:
    kept = SimpleNamespace(
        counts=lambda end, parts: (7, 9) if (end, parts) == (2.5, 3) else None,
        for_good=lambda end, parts: "stays" if (end, parts) == (2.5, 3) else None,
        closed=lambda end: closed if end == 2.5 else None,
    )
    return SimpleNamespace(
        state=SimpleNamespace(clock=SimpleNamespace(time=2.5), q=np.zeros(4)), saved=saved, kept=kept, parts_before=3
    )


def test_the_state_to_go_on_from_knows_how_many_rows_and_events_belong_to_it() -> None:
    assert frozen_run._end_state(ended(None)) is None
    state = frozen_run._end_state(ended(SavedState({}, "", {}, 0.0, recorded={"met": np.array(4)})))
    assert state is not None and (state.rows, state.events) == (7, 9)
    assert state.recorded == {"met": np.array(4), "stays": "stays"}


def test_of_a_run_that_kept_nothing_there_are_columns_without_rows() -> None:
    (t, q, u, a), events = frozen_run._all_kept(ended(None))
    assert t.shape == (0,) and q.shape == u.shape == a.shape == (0, 4) and events.shape == (0,)
    assert frozen_run._all_kept(ended(None, "everything")) == "everything"


def test_a_trajectory_has_all_that_is_known_of_its_run() -> None:
    """What is at its end in the coordinates of the scene, as copies; the problem that failed only where one did."""
    run = ended(SavedState({}, "", {}, 0.0, recorded={}), (np.arange(8.0).reshape(4, 2), np.zeros(0, EVENT_DTYPE)))
    t, q = np.arange(2.0), np.arange(8.0).reshape(2, 4)
    run.kept.closed = lambda end: ((t, q, 10.0 * q, 100.0 * q), np.zeros(0, EVENT_DTYPE))
    run.kept.recording, run.kept.spans = SimpleNamespace(keep="events"), lambda end: ((0.5, end),)
    run.state.q, run.state.u = np.array([1.0, 2.0, 3.0, 4.0]), np.array([5.0, 6.0, 7.0, 8.0])
    run.state.worst = SimpleNamespace(penetration=3e-9)
    run.compiled = SimpleNamespace(slices=SLICES, relative=lambda q, rates=False: q + (100.0 if rates else 200.0))
    run.watch = SimpleNamespace(result=lambda admitted: {"worst_m": 2.0 * admitted})
    run.worst_residual, run.energy, run.counts = lambda: np.array([4e-9]), lambda: {"in_J": 5.0}, lambda: {"steps": 6}
    run.tally, run.scene, run.pairs = SimpleNamespace(finished=lambda: {"half_swings": 7}), SCENE, "pairs"
    run.method, run.tolerance, run.step = "moreau", 1e-7, 1e-5
    made = frozen_run.trajectory_of(run, Stop.DURATION, 8.0, 9.0)
    assert (made.scene, made.slices, made.pairs, made.stop) == (SCENE, SLICES, "pairs", Stop.DURATION)
    assert made.stop_message == f"t = 2.5 s: {Stop.DURATION.sentence}" and (made.simulated, made.wall, made.compile) == (
        2.5,
        8.0,
        9.0,
    )
    assert (made.method, made.tolerance, made.step) == ("moreau", 1e-7, 1e-5)
    assert (made.worst_penetration, made.worst_residual, made.overlap) == (3e-9, 4e-9, {"worst_m": 6e-9})
    assert (made.energy, made.counts, made.keep, made.spans, made.sums) == (
        {"in_J": 5.0}, {"steps": 6}, "events", ((0.5, 2.5),), {"half_swings": 7},
    )  # fmt: skip
    assert (made.end_q.tolist(), made.end_u.tolist()) == ([201.0, 202.0, 203.0, 204.0], [105.0, 106.0, 107.0, 108.0])
    assert (made.t.tolist(), made.a.tolist(), made.failure) == ([0.0, 1.0], (100.0 * q).tolist(), None)
    assert made.end_state is not None and (made.end_state.rows, made.end_state.events) == (7, 9)


@pytest.fixture
def heard() -> Iterator[None]:
    """Ctrl-C reaches Python, also where the tests run in the background of a shell, which has it ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("heard")
def test_the_first_interrupt_is_remembered_and_the_second_one_raises() -> None:
    with held_interrupts() as came:
        assert not came()
        signal.raise_signal(signal.SIGINT)
        assert came()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_where_somebody_else_listens_nothing_is_held() -> None:
    heard: list[int] = []
    before = signal.signal(signal.SIGINT, lambda number, frame: heard.append(number))
    try:
        with held_interrupts() as came:
            signal.raise_signal(signal.SIGINT)
            assert not came()
    finally:
        signal.signal(signal.SIGINT, before)
    assert heard == [signal.SIGINT]
    told: list[bool] = []

    def elsewhere() -> None:
        with held_interrupts() as came:
            told.append(came())

    thread = threading.Thread(target=elsewhere)
    thread.start()
    thread.join()
    assert told == [False]
