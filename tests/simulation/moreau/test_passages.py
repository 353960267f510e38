"""When does a spring turn or pass its rest within a step of constant acceleration? Against roots that numpy finds."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.moreau.steps import _keep_of

START, STEP, REST = 2.0, 0.5, 0.3


def kept(
    place: float, speed: float, bend: float, carrier: bool = False, before: int | None = None
) -> tuple[list[tuple[int, float, float]], list[int]]:
    """(kind, time, value) of the events of a parabola that begins there, and the signs of speed and way left behind.

    `before`: the sign of the speed before an impact at the start of the step.
    """
    end, last = place + speed * STEP + 0.5 * bend * STEP**2, speed + bend * STEP
    ends = [np.array([9.0, x, 0.25]) for x in (place, speed, end, last)]
    if carrier:
        for array in ends:
            array[1] += array[2]
    sides = (np.sign(speed) if before is None else before, np.sign(place - REST))
    state = SimpleNamespace(clock=SimpleNamespace(time=START), counts=SimpleNamespace(events=0))
    state.side_u, state.side_q = (np.array([5, int(side)]) for side in sides)
    record = SimpleNamespace(events=np.zeros(4, EVENT_DTYPE).view(np.recarray), used=SimpleNamespace(events=0))
    model = SimpleNamespace(coordinates=[None, SimpleNamespace(body=7)])
    in_python(_keep_of)(model, state, STEP, (1, 2 if carrier else -1, REST), tuple(ends), record)
    events = record.events[: record.used.events]
    assert state.clock.time == START and (events["body"] == 7).all() and (events["contact"] == -1).all()
    assert state.side_u[0] == state.side_q[0] == 5
    return [(int(e["kind"]), float(e["t"]), float(e["value"])) for e in events], [int(state.side_u[1]), int(state.side_q[1])]


@pytest.mark.parametrize("seed", range(40))
@pytest.mark.parametrize("carrier", [False, True])
@pytest.mark.parametrize("unit", [1.0, 1e-4])
@pytest.mark.parametrize("towards", [True, False])
def test_turns_and_passages_are_those_of_the_parabola(seed: int, carrier: bool, unit: float, towards: bool) -> None:
    """A passage counts where the ends lie on either side of the rest position; away from it the spring turns before."""
    place, speed, bend = np.random.default_rng(seed).uniform([-0.5, 0.1, -9.0], [1.0, 2.0, 9.0])
    speed *= np.sign(REST - place) if towards else np.sign(place - REST)
    if not towards:  # such that it comes back within the step
        bend = -np.sign(speed) * (8.0 * (abs(place - REST) + abs(speed) * STEP) / STEP**2 + abs(bend))
    place, speed, bend = REST + unit * (place - REST), unit * speed, unit * bend
    way = np.polynomial.Polynomial([place - REST, speed, 0.5 * bend])
    expected = []
    turn = -speed / bend
    if 0.0 < turn < STEP:
        expected.append((int(EventKind.TURN), START + turn, way(turn) + REST))
    if way(0.0) * way(STEP) < 0.0:
        root = next(float(root.real) for root in way.roots() if abs(root.imag) < 1e-12 and 0.0 < root.real < STEP)
        expected.append((int(EventKind.CROSS), START + root, way.deriv()(root)))
    found, sides = kept(place, speed, bend, carrier)
    assert [kind for kind, _, _ in found] == [kind for kind, _, _ in expected]
    for one, other in zip(found, expected, strict=True):
        assert one == pytest.approx(other, rel=1e-8, abs=1e-9 * unit)
    assert sides == [np.sign(way.deriv()(STEP)), np.sign(way(STEP))]


def test_what_begins_at_rest_or_in_its_rest_position_neither_turns_nor_passes() -> None:
    assert kept(REST, 0.0, 4.0) == ([], [1, 1])
    assert kept(REST, 1.0, 0.0) == ([], [1, 1])
    assert kept(REST + 1.0, 0.0, 0.0) == ([], [0, 1])


def test_what_an_impact_has_turned_round_turns_at_the_start_of_the_step() -> None:
    found, sides = kept(REST + 0.4, 1.0, 0.5, before=-1)
    assert found == [(int(EventKind.TURN), START, pytest.approx(REST + 0.4))] and sides == [1, 1]
