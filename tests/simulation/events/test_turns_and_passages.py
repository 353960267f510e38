"""At which times of a step do springs turn and pass their rest, and what is written down? Against closed forms."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.motion import turning_points
from watchsim.simulation.motion.turning_points import keep_passages

START, LENGTH = 5.0, 0.6
TURN, CROSS = int(EventKind.TURN), int(EventKind.CROSS)


def swing(phase: float, size: float, t: float) -> tuple[float, float]:
    """Place and velocity of a swing about zero."""
    return size * math.cos(2.0 * t + phase), -2.0 * size * math.sin(2.0 * t + phase)


def kept(
    phases: list[float], rests: list[float], end: float, before: tuple[list[int], list[int]], joint: bool = False
) -> tuple[list[tuple[int, int, float, float]], list[int], list[int]]:
    """(kind, body, time, value) of what was written down, and the sides left, of two coordinates or of one on the other."""
    coordinates = [SimpleNamespace(watched=int(not joint), level=rest, body=7 + i) for i, rest in enumerate(rests)]
    joints = [SimpleNamespace(watched=int(joint), coordinate=1, on=0, rest=rests[1])]
    model = SimpleNamespace(coordinates=coordinates, joints=joints)
    ends = [swing(phase, 1.0 + i, end) for i, phase in enumerate(phases)]
    state = SimpleNamespace(
        clock=SimpleNamespace(time=START + end), counts=SimpleNamespace(events=0),
        q=np.array([q for q, _ in ends]), u=np.array([u for _, u in ends]),
        side_u=np.array(before[0]), side_q=np.array(before[1]),
    )  # fmt: skip
    record = SimpleNamespace(events=np.zeros(9, EVENT_DTYPE).view(np.recarray), used=SimpleNamespace(events=0))
    step = SimpleNamespace(span=SimpleNamespace(start=START))
    instead = {"coordinate_within": lambda model, state, step, i, tau: swing(phases[i], 1.0 + i, tau)}
    in_python(keep_passages, **instead)(model, state, step, end, record)
    assert state.clock.time == START + end
    events = record.events[: record.used.events]
    assert (events["contact"] == -1).all()
    found = [(int(e["kind"]), int(e["body"]), float(e["t"]), float(e["value"])) for e in events]
    return found, state.side_u.tolist(), state.side_q.tolist()


def test_a_turn_and_a_passage_are_dated_where_they_happen() -> None:
    """The first coordinate turns at 0.3 s; the second passes its rest, 0.4, on the way down."""
    phases, rests = [-0.6, 1.0], [-9.0, 0.4]
    crossing = 0.5 * (math.acos(0.4 / 2.0) - 1.0)
    found, side_u, side_q = kept(phases, rests, LENGTH, ([1, -1, 0], [1, 1, 0]))
    assert [one[:2] for one in found] == [(TURN, 7), (CROSS, 8)]
    assert found[0][2:] == pytest.approx((START + 0.3, 1.0), abs=1e-14)
    assert found[1][2:] == pytest.approx((START + crossing, -4.0 * math.sqrt(1.0 - 0.04)), abs=1e-13)
    assert (side_u, side_q) == ([-1, -1, 0], [1, -1, 0])


def test_of_a_coordinate_on_another_the_difference_counts() -> None:
    """2 cos(2t + 1) - cos(2t - 0.6) passes its rest 0 and turns as one swing of its own."""
    amplitude = 2.0 * np.exp(1.0j) - np.exp(-0.6j)
    after = amplitude * np.exp(2.0j * LENGTH)
    before, later = ([int(np.sign(x)) for x in (at.real, -at.imag)] for at in (amplitude, after))
    found, side_u, side_q = kept([-0.6, 1.0], [0.0, 0.0], LENGTH, ([0, before[1], 0], [0, before[0], 0]), joint=True)
    assert [kind for kind, *_ in found] == [TURN] * (before[1] != later[1]) + [CROSS] * (before[0] != later[0])
    assert CROSS in [kind for kind, *_ in found]
    for kind, body, t, value in found:
        at = amplitude * np.exp(2.0j * (t - START))
        assert body == 8 and START < t < START + LENGTH
        assert abs(at.real if kind == CROSS else at.imag) < 1e-13
        assert kind == TURN or value == pytest.approx(-2.0 * at.imag)
    assert (side_u, side_q) == ([0, later[1], 0], [0, later[0], 0])


def test_at_a_jump_the_turn_is_now_and_no_rest_is_passed() -> None:
    """The velocity has changed its sign at one instant; the value is the place."""
    found, side_u, side_q = kept([1.0, 1.0], [9.0, -9.0], 0.0, ([1, 1, 0], [1, 0, 0]))
    assert found == [(TURN, 7, START, math.cos(1.0)), (TURN, 8, START, 2.0 * math.cos(1.0))]
    assert (side_u, side_q) == ([-1, -1, 0], [-1, 1, 0])


def test_what_begins_has_no_side_before_and_writes_nothing_down() -> None:
    assert kept([-0.6, 1.0], [-9.0, 0.4], LENGTH, ([0] * 3, [0] * 3)) == ([], [-1, -1, 0], [1, -1, 0])
    assert kept([-0.6, 1.0], [-9.0, 0.4], LENGTH, ([-1, -1, 0], [1, -1, 0])) == ([], [-1, -1, 0], [1, -1, 0])


@pytest.mark.parametrize("start", [0.0, 3e-6, 1e3])
def test_a_root_is_as_close_as_the_time_itself_is_known(start: float) -> None:
    """Also a microsecond after the start of a run."""
    step = SimpleNamespace(span=SimpleNamespace(start=start))
    kernel = in_python(turning_points._root, _value=lambda model, state, step, spring, turn, tau: math.cos(1e7 * tau))
    found = kernel(None, None, step, None, True, 3e-7)
    assert found == pytest.approx(0.5e-7 * math.pi, rel=1e-14, abs=2e-16 * start)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_what_is_zero_at_the_very_end_turns_there(side: float) -> None:
    step = SimpleNamespace(span=SimpleNamespace(start=5.0))
    kernel = in_python(turning_points._root, _value=lambda model, state, step, spring, turn, tau: side * (0.25 - tau))
    assert kernel(None, None, step, None, True, 0.25) == pytest.approx(0.25, rel=1e-14)
