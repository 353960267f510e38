"""In which order is an impact solved, its rebounds ended, written down, and a chatter ended? With made-up answers."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import pytest
from made_up import named
from plain_kernels import in_python

from watchsim.simulation.events import collision

TIME = 2.5


def collided(jam: float = 0.0, m: int = 2, **script: Any) -> tuple[bool, list[Any], SimpleNamespace]:
    """(found?, calls, state); answers in turn, the last one for ever."""
    usual: dict[str, Any] = {
        "endless": False, "solve": [True], "ends": [(False, 0.0)], "may": False, "accelerations": True,
        "chatter": (0.0, False), "pressed": 0.0, **script,
    }  # fmt: skip
    calls: list[Any] = []

    def next_of(name: str) -> Any:
        return usual[name].pop(0) if len(usual[name]) > 1 else usual[name][0]

    def solve(model, state, m, jam, work, closed, room) -> bool:
        calls.append(("solve", jam))
        state.u[:] = [5.0, 6.0, 7.0]
        work.force[:] = [float(len(calls) + i) for i in range(6)]
        return bool(next_of("solve"))

    instead = {
        "_law_restitution": lambda model, closed, m, out: calls.append("laws"),
        "end_endless": lambda state, m, options, event, room: calls.append("endless") or usual["endless"],
        "_solve": solve,
        "place": lambda *_: calls.append("place"),
        "refresh": lambda model, m, closed, pose: calls.append(("refresh", m)),
        "note_pace": lambda u, pace: calls.append("pace"),
        "_end_rebounds": lambda *_: next_of("ends"),
        "_write": lambda model, state, m, jam, closed, room, record, ended, ends: calls.append(("write", jam, ended, ends)),
        "may_be_chatter": lambda m, options, event, room: calls.append("may") or usual["may"],
        "_accelerations": lambda *_: calls.append("accelerations") or usual["accelerations"],
        "chatter_time": lambda state, m, options, event: usual["chatter"],
        "pressed_time": lambda *_: calls.append("pressed") or usual["pressed"],
        "_end_chatter": lambda model, state, m, time, scratch, record: calls.append(("end", time)),
    }
    room = named(before=[0.0] * 3, restitution=None, impulse=[77.0] * 8)
    state = named(u=[1.0, 2.0, 3.0], q=None, clock=named(time=TIME))
    scratch = named(work=named(force=[0.0] * 6), event=named(closed=None, pose=None, pace=None), impact=room)
    found = in_python(collision.collide, **instead)(None, state, 7, m, None, jam, scratch, None)
    assert room.before == [1.0, 2.0, 3.0] and room.impulse[2 * m :] == [77.0] * (8 - 2 * m)
    state.impulse = room.impulse[: 2 * m]
    return bool(found), calls, state


ONCE = [("solve", 0.0), "place", ("refresh", 2), "pace"]


def test_an_impact_is_solved_placed_and_written_down() -> None:
    found, calls, state = collided()
    assert found and calls == ["laws", "endless", *ONCE, ("write", 0.0, False, TIME), "may"]
    assert state.u == [5.0, 6.0, 7.0] and state.impulse == [3.0, 4.0, 5.0, 6.0]


def test_rebounds_are_ended_one_after_the_other_and_the_latest_end_is_written_down() -> None:
    """At most as many as there are contacts, and once without."""
    _, calls, _ = collided(ends=[(True, 2.75), (True, 2.625), (False, 9.0)])
    assert calls == ["laws", "endless", *ONCE, *ONCE, *ONCE, ("write", 0.0, True, 2.75), "may"]
    assert collided(ends=[(True, 2.0)])[1].count(("solve", 0.0)) == 3
    assert collided(m=3, ends=[(True, 2.0)])[1].count(("solve", 0.0)) == 4
    assert ("write", 0.0, True, TIME) in collided(ends=[(True, 2.0)])[1]
    assert ("write", 0.0, True, TIME) in collided(endless=True)[1]


def test_where_nothing_solves_it_velocities_stay() -> None:
    found, calls, state = collided(solve=[False])
    assert not found and state.u == [1.0, 2.0, 3.0] and calls == ["laws", "endless", ("solve", 0.0)]


def test_a_jam_has_no_rebounds_without_end_and_no_chatter() -> None:
    assert collided(jam=1e-8, may=True)[1] == [
        "laws",
        ("solve", 1e-8),
        "place",
        ("refresh", 2),
        "pace",
        ("write", 1e-8, False, TIME),
    ]


@pytest.mark.parametrize(("chatter", "pressed", "ended"), [
    ((0.5, False), 9.0, 0.5), ((0.0, False), 9.0, None), ((math.inf, False), 9.0, None), ((0.5, True), 0.75, 0.75),
    ((0.5, True), 0.25, 0.5), ((0.5, True), math.inf, None), ((0.0, True), 0.75, None), ((math.inf, True), 0.75, None),
    ((1e-9, False), 9.0, 1e-9), ((1e-9, True), 2e-9, 2e-9),
])  # fmt: skip
def test_chatter_ends_when_all_of_its_contacts_are_back(chatter, pressed: float, ended: float | None) -> None:
    calls = collided(may=True, chatter=chatter, pressed=pressed)[1]
    assert ("pressed" in calls) == (chatter[1] and 0.0 < chatter[0] < math.inf)
    assert [call for call in calls if call[0] == "end"] == ([("end", ended)] if ended else [])
    assert calls[-1] != ("end", ended) or "accelerations" in calls


def test_without_accelerations_chatter_goes_on() -> None:
    calls = collided(may=True, accelerations=False, chatter=(0.5, False))[1]
    assert calls[-2:] == ["may", "accelerations"]
