"""In which order are an instant and each of its islands gone through? With made-up answers of what is called."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
from made_up import named
from plain_kernels import in_python

from watchsim.simulation.events import after_event
from watchsim.simulation.loop_state.state import NO_CONTACT
from watchsim.simulation.stops import Stop

EXTENT = 1e-9
OPTIONS = named(extent=EXTENT, behind=2e-8, speed_zero=1e-8)


def settled(**changed: object) -> tuple[int, list[object], SimpleNamespace]:
    """(code, calls, now) of an instant with contacts 9, 4, 7 in islands 0, 0, 2 of four coordinates."""
    given: dict[str, Any] = {"handed": True, "gathered": Stop.RUNNING, "stops": {}, **changed}
    calls: list[object] = []
    now = named(event_waits=1, touched=4)
    state = named(q="q", u="u", now=now, active="active")
    event = named(pace=np.full(4, 77.0), pose="pose", label=[0, 0, 2, 3], listed=[9, 4, 7], upto=[2, 2, 3])

    def island(model, state, island, span, options, scratch, record) -> int:
        calls.append((island, span))
        return int(given["stops"].get(island, Stop.RUNNING))

    instead = {
        "place": lambda model, q, u, pose: calls.append("place"),
        "_land": lambda *_: calls.append("land"),
        "hand_over": lambda *_: calls.append("hand over") or given["handed"],
        "_release": lambda *_: calls.append("release"),
        "gather": lambda *_: (given["gathered"], 3),
        "label_islands": lambda model, ids, m, label: calls.append(("label", m)),
        "sort_by_island": lambda model, label, m, ids, upto: calls.append(("sort", m)),
        "island_of": lambda model, label, k: {9: 0, 4: 0, 7: 2}[k],
        "_settle_island": island,
        "_closed_of": lambda state, m, ids, out: 10 * m,
        "_go_on": lambda model, state, f, options, scratch, record: calls.append(("go on", f)),
    }
    code = in_python(after_event.settle, **instead)(None, None, state, OPTIONS, named(event=event, work=None), None)
    assert event.pace.tolist() == [0.0] * 4
    return int(code), calls, now


def test_an_instant_is_settled_island_by_island() -> None:
    """Also those without a contact: their bearings may stand."""
    begin = ["place", "land", "hand over", "release", ("label", 3), ("sort", 3)]
    code, calls, now = settled()
    assert code == Stop.RUNNING and (now.event_waits, now.touched) == (0, NO_CONTACT)
    assert calls == [*begin, (0, (0, 2)), (2, (2, 3)), (3, (3, 3)), ("go on", 30)]
    code, calls, now = settled(stops={2: Stop.LCP_FAILED})
    assert (code, calls[6:]) == (Stop.LCP_FAILED, [(0, (0, 2)), (2, (2, 3))]) and (now.event_waits, now.touched) == (1, 4)


def test_an_instant_waits_where_a_cell_is_unknown() -> None:
    assert settled(handed=False)[:2] == (Stop.CELL_UNKNOWN, ["place", "land", "hand over"])
    assert settled(gathered=Stop.TOO_MANY_CONTACTS)[:2] == (Stop.TOO_MANY_CONTACTS, ["place", "land", "hand over", "release"])


def island(deepest: float = 0.0, stop: Stop = Stop.RUNNING) -> tuple[int, list[object], float]:
    """(code, calls, worst penetration) of an island with the contacts at places 2 to 4, of which two and then one are left."""
    calls: list[object] = []
    instead = {
        "fill_inverse": lambda model, grip, inverse: calls.append("inverse"),
        "place_contacts": lambda model, ids, first, last, pose, closed: calls.append((ids, first, last)) or last - first,
        "drop_immovable": lambda model, state, m, event, record: calls.append(("immovable", m)) or m - 1,
        "drop_later": lambda model, state, m, options, work, event: calls.append(("later", m)) or m - 1,
        "note_pace": lambda u, pace: calls.append((u, pace)),
        "project_positions": lambda closed, m, both, behind, work, q: calls.append((m, both, behind, q)) or deepest,
        "place": lambda *_: calls.append("place"),
        "refresh": lambda model, m, closed, pose: calls.append(("refresh", m)),
        "project_velocities": lambda closed, m, mode, independent, work, u: calls.append((m, mode, independent, u)),
        "_resolve": lambda model, state, island, m, options, scratch, record: calls.append((island, m)) or (stop, 5),
        "_take": lambda state, m, r, event, record: calls.append(("take", m, r)),
    }
    state = named(grip=None, u="u", q="q", mode="mode", worst=named(penetration=3e-9))
    scratch = named(work=named(inverse=None), event=named(closed=None, listed="listed", pose=None, pace="pace"))
    code = in_python(after_event._settle_island, **instead)(None, state, 7, (2, 5), OPTIONS, scratch, None)
    return int(code), calls, state.worst.penetration


def test_an_island_is_settled_with_what_can_move_and_is_met_now() -> None:
    begin = ["inverse", ("listed", 2, 5), ("immovable", 3), ("later", 2), ("u", "pace"), (1, False, OPTIONS.behind, "q")]
    assert island() == (Stop.RUNNING, [*begin, (7, 1), ("take", 1, 5)], 3e-9)
    again = ["place", ("refresh", 1), (1, "mode", 1e-6, "u"), "place", ("refresh", 1)]
    assert island(1e-12) == (Stop.RUNNING, [*begin, *again, (7, 1), ("take", 1, 5)], 3e-9)
    assert island(4e-9)[2] == 4e-9
    assert island(stop=Stop.LCP_FAILED) == (Stop.LCP_FAILED, [*begin, (7, 1)], 3e-9)


def resolved(**script: list[Any]) -> tuple[tuple[int, int], list[object], int]:
    """((code, contacts in I_N), calls, failures counted); what is called answers in turn, the last answer for ever."""
    calls: list[object] = []
    usual: dict[str, list[Any]] = {
        "approaching": [False], "collide": [True], "decide": [(2, True)], "stop_at_dead_centre": [False],
        "stands_at_dead_centre": [False], "contradicts": [False], "stop_rounding": [True], "slides": [True],
    }  # fmt: skip
    answers = {name: list(script.get(name, usual[name])) for name in usual}

    def told(name: str, value: object = None) -> Any:
        calls.append(name if value is None else (name, value))
        left = answers[name]
        return left.pop(0) if len(left) > 1 else left[0]

    instead = {
        "set_rate_zeros": lambda closed, m, exactly, options, pace, zero: calls.append("exactly") if exactly else None,
        "approaching": lambda m, closed, zero: told("approaching"),
        "collide": lambda model, state, island, m, options, jam, scratch, record: told("collide", jam),
        "decide": lambda *_: told("decide"),
        "stop_at_dead_centre": lambda *_: told("stop_at_dead_centre"),
        "stands_at_dead_centre": lambda *_: told("stands_at_dead_centre"),
        "contradicts": lambda *_: told("contradicts"),
        "stop_rounding": lambda *_: told("stop_rounding"),
        "slides": lambda r, speed, rest: told("slides"),
        "stop_held": lambda *_: calls.append("held"),
        "hold_gaps": lambda *_: calls.append("hold gaps"),
        "place": lambda *_: calls.append("place"),
        "refresh": lambda *_: calls.append("refresh"),
    }
    counts = named(lcp_failures=0)
    state = named(q=None, u=None, grip=None, counts=counts)
    event = named(closed=None, rest=None, pace=None, zero=None, pose=None, label=None)
    found = in_python(after_event._resolve, **instead)(None, state, 7, 3, OPTIONS, named(work=None, event=event), None)
    return found, calls, counts.lcp_failures


ASKED = ["decide", "stop_at_dead_centre", "stands_at_dead_centre"]


def test_impacts_are_resolved_until_nothing_approaches_then_modes_are_decided() -> None:
    found, calls, _ = resolved(approaching=[True, True, False])
    assert found == (Stop.RUNNING, 2)
    assert calls == ["approaching", ("collide", 0.0)] * 2 + ["approaching", *ASKED, "contradicts", "held"]
    assert resolved(approaching=[True], collide=[False])[0] == (Stop.LCP_FAILED, 0)
    found, calls, _ = resolved(approaching=[True])
    assert found == (Stop.TOO_MANY_EVENTS, 0) and calls == ["approaching", ("collide", 0.0)] * 16


def test_rates_that_contradict_modes_are_taken_exactly_once() -> None:
    found, calls, _ = resolved(contradicts=[True])
    assert found == (Stop.RUNNING, 2)
    assert calls == ["approaching", *ASKED, "contradicts", "exactly", "approaching", *ASKED, "held"]


def test_on_the_line_of_centres_bodies_are_stopped_or_stand() -> None:
    found, calls, _ = resolved(stop_at_dead_centre=[True, False])
    assert calls[:6] == ["approaching", "decide", "stop_at_dead_centre", "place", "refresh", "approaching"]
    found, calls, _ = resolved(stands_at_dead_centre=[True], decide=[(3, False)])
    assert found == (Stop.RUNNING, 3) and calls == ["approaching", *ASKED]


def test_where_no_forces_exist_what_slides_is_jammed_and_stopped_by_impulses() -> None:
    """Not before rounding of an impact has been taken away; what does not slide is a failure."""
    found, calls, failures = resolved(decide=[(2, False), (2, True)])
    assert found == (Stop.RUNNING, 2) and failures == 0
    assert calls == [
        "approaching",
        *ASKED,
        "slides",
        "hold gaps",
        "refresh",
        ("collide", 1e-8),
        "approaching",
        *ASKED,
        "contradicts",
        "held",
    ]
    assert resolved(decide=[(2, False)], slides=[False])[::2] == ((Stop.LCP_FAILED, 0), 1)
    found, calls, _ = resolved(approaching=[True, False], decide=[(2, False), (2, False), (2, True)])
    assert calls[:7] == ["approaching", ("collide", 0.0), "approaching", *ASKED, "stop_rounding"]
    assert calls[7:14] == ["approaching", *ASKED, "slides", "hold gaps", "refresh"]
    found, calls, _ = resolved(approaching=[True, False], decide=[(2, False), (2, True)], stop_rounding=[False])
    assert calls[6:10] == ["stop_rounding", "slides", "hold gaps", "refresh"]
    found, calls, _ = resolved(decide=[(2, False), (2, False), (2, True)])
    assert "stop_rounding" not in calls  # a jam is no impact that left rounding
    assert calls.count("slides") == 2
