"""What is said of the end of a run, and is all told of a problem that nothing solved?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from watchsim.dynamics.lcp.outcome import LcpOutcome
from watchsim.dynamics.problem_kinds import Level
from watchsim.model.records import FREE, PIVOT, SLIDE
from watchsim.simulation import frozen_run
from watchsim.simulation.advance import BEARING, KINDS, TOUCHED
from watchsim.simulation.event_kinds import EVENT_DTYPE, EventKind
from watchsim.simulation.lcp_failure import driven_into, failure_of
from watchsim.simulation.loop_state.scratch import RECENT
from watchsim.simulation.motion.coupled_motion import EXTENT, NORMAL, PARADOX, TANGENTIAL
from watchsim.simulation.record.contact_names import Pair
from watchsim.simulation.stop_details import furthest, unaccounted, unexplained, what_alternates
from watchsim.simulation.stops import Stop

PAIRS = [Pair(0, f"body{k}", "corner", k, "layer", f"other{k}", "line", 10 + k, "face") for k in range(8)]


def test_kinds_of_ends_have_the_numbers_of_saved_runs() -> None:
    wanted = {
        "running": 0, "slice": 1, "cell_unknown": 2, "buffer_full": 3, "duration": 4, "interrupted": 5, "too_many_events": 6,
        "lcp_failed": 7, "step_too_small": 8, "not_finite": 9, "too_many_contacts": 10, "last_step": 11, "out_of_memory": 12,
        "far_away": 13, "overlap": 20, "unexplained": 21, "ledger": 22,
    }  # fmt: skip
    assert {stop.name.lower(): stop.value for stop in Stop} == wanted
    assert [stop for stop in Stop if stop.is_wrong] == [20, 21, 22]
    assert [stop for stop in Stop if stop.gave_up] == [6, 7, 8, 9, 10, 12, 13, 20, 21, 22]
    assert len({stop.sentence for stop in Stop}) == len(Stop)


def test_kinds_of_events_have_the_numbers_of_saved_runs() -> None:
    names = ["IMPACT", "CLOSE", "OPEN", "STICK", "SLIDE", "HANDOVER", "ACCUMULATION", "TURN", "CROSS", "JAM"]
    assert [(kind.name, kind.value) for kind in EventKind] == [(name, i) for i, name in enumerate(names, 1)]
    assert EVENT_DTYPE.itemsize == 5 * 8 + 3 * 4


def test_what_is_missing_in_the_ledger_is_told_with_what_came_in() -> None:
    assert unaccounted({"residual_J": 1.2345e-9, "in_J": 0.98765}).startswith(
        "1.23e-09 J are unaccounted for, of 0.988 J put in. "
    )


def test_six_contacts_in_force_are_named() -> None:
    def told(count: int) -> str:
        state: Any = SimpleNamespace(active=np.arange(8), now=SimpleNamespace(awake_contacts=count))
        return unexplained(state, PAIRS)

    assert told(0) == told(2).split(". ", 1)[1]
    assert told(2).startswith(f"in contact: {PAIRS[0]}; {PAIRS[1]}. Try")
    assert [told(count).count(" / ") for count in (5, 6, 7, 8)] == [5, 6, 6, 6]


def test_what_ended_the_last_steps_is_told_most_frequent_first() -> None:
    codes = {
        KINDS * 3 + NORMAL: (2, f"the force ends at {PAIRS[3]}"),
        KINDS * 5 + TANGENTIAL: (7, f"slip or grip ends at {PAIRS[5]}"),
        KINDS + EXTENT: (4, f"an edge ends at {PAIRS[1]}"),
        KINDS * 2 + PARADOX: (6, f"no finite force holds {PAIRS[2]}"),
        KINDS * 4 + TOUCHED: (5, f"{PAIRS[4]} touch"),
        KINDS * 1 + BEARING: (3, "dry friction in the bearing of wheel holds or lets go"),
        KINDS * 6 + TOUCHED: (1, "one too many to be told"),
    }
    by = np.zeros(RECENT, np.int64)
    listed = [code for code, (times, _) in codes.items() for _ in range(times)]
    by[: len(listed)] = listed
    ended: Any = SimpleNamespace(by=by, number=len(listed))
    told = what_alternates(ended, PAIRS, ["lever", "wheel"])
    wanted = sorted(codes.values(), reverse=True)[:6]
    assert told == "what alternates: " + "; ".join(f"{words} ({times}×)" for times, words in wanted)
    assert what_alternates(SimpleNamespace(by=by, number=0), PAIRS, []) == ""  # type: ignore[arg-type]
    by[:] = KINDS * 4 + TOUCHED
    assert f"({RECENT}×)" in what_alternates(SimpleNamespace(by=by, number=1000), PAIRS, [])  # type: ignore[arg-type]


@pytest.mark.parametrize(("q", "words"), [
    ([5.0, 0.1, 0.1, 0.1, 0.1], "wheel is at 5 rad, rounded to 9e-16 rad"),
    ([1.0, -2.5, 0.1, 0.1, 0.1], "slide is at 2.5 m, rounded to 4e-16 m"),
    ([1.0, 0.1, 0.1, 0.7, 0.1], "disc is at 0.7 m, rounded to 1e-16 m"),
    ([1.0, 0.1, 0.7, 0.1, 0.1], "disc is at 0.7 m, rounded to 1e-16 m"),
    ([1.0, 0.1, 0.1, 0.1, -9.0], "disc is at 9 rad, rounded to 2e-15 rad"),
])  # fmt: skip
def test_the_body_that_has_gone_furthest_is_told_in_its_unit(q: list[float], words: str) -> None:
    """Seen against radians, or the size of the scene, 0.5 m."""
    names = ["wheel", "slide", "disc"]
    bodies = [SimpleNamespace(motion=m, first=f) for m, f in ((PIVOT, 0), (SLIDE, 1), (FREE, 2))]
    rows = np.rec.fromarrays([[1.0, 0.5, 0.5, 0.5, 1.0], [0, 1, 2, 2, 2]], names="scale,body")
    model: Any = SimpleNamespace(bodies=bodies, coordinates=rows)
    state: Any = SimpleNamespace(q=np.array(q))
    assert furthest(state, model, names).startswith(words)


def failure(level: Level) -> dict[str, Any]:
    """Of a problem of two contacts with one element and one bearing."""
    closed, rest = (
        SimpleNamespace(
            ids=np.array(ids), kin=np.rec.fromarrays([[i + 0.1 for i in ids], [0.2] * 3, [0.3] * 3], names="g,gN_dot,gT_dot")
        )
        for ids in ([5, 3, 7], [6, 2, 7])
    )
    G, A = (base + np.arange(100.0).reshape(10, 10) for base in (1000.0, 2000.0))
    work = SimpleNamespace(
        posed=SimpleNamespace(contacts=2, elements=1, bearings=1, level=int(level), lemke=int(LcpOutcome.RAY)),
        dry=np.array([4, 77]), G=G, A=A, b=np.arange(10.0), rhs=20.0 + np.arange(10.0),
        hand=np.array([1.0, -1.0, 1.0, 1.0, -1.0, -1.0]),
    )  # fmt: skip
    scratch: Any = SimpleNamespace(work=work, event=SimpleNamespace(closed=closed, rest=rest))
    state: Any = SimpleNamespace(
        clock=SimpleNamespace(time=2.5), q=np.array([1.0]), u=np.array([2.0]), mode=np.array([0, 0, 1, 2, 0, -1, 2, 0])
    )
    return failure_of(state, scratch, PAIRS)


@pytest.mark.parametrize(("level", "ids", "modes"), [
    (Level.ACCELERATION, [6, 2], [2, 1]), (Level.COMPRESSION, [5, 3], [-1, 2]), (Level.EXPANSION, [5, 3], [-1, 2]),
])  # fmt: skip
def test_a_problem_that_nothing_solved_is_told_whole(level: Level, ids: list[int], modes: list[int]) -> None:
    """Five rows, N and T of two contacts and a bearing; four unknowns, two normal forces and both ends of one cone."""
    made = failure(level)
    assert (made["level"], made["lemke_ended_with"], made["t"]) == (level.name.lower(), "ray", 2.5)
    assert [contact["number"] for contact in made["contacts"]] == ids
    assert [contact["mode"] for contact in made["contacts"]] == modes
    assert made["contacts"][1]["between"] == str(PAIRS[ids[1]]) and made["contacts"][0]["gap_m"] == pytest.approx(ids[0] + 0.1)
    assert (made["contacts"][0]["gap_rate_m_per_s"], made["contacts"][0]["slip_m_per_s"]) == (0.2, 0.3)
    assert (made["q"], made["u"], made["bearings"], made["reversed"]) == ([1.0], [2.0], [4], [1, 4])
    assert made["G"] == (1000.0 + np.arange(100.0).reshape(10, 10))[:5, :5].tolist() and made["b"] == [0.0, 1.0, 2.0, 3.0, 4.0]
    assert made["A"] == (2000.0 + np.arange(100.0).reshape(10, 10))[:4, :4].tolist() and made["rhs"] == [20.0, 21.0, 22.0, 23.0]


def test_a_driven_body_that_jams_another_is_the_cause() -> None:
    problem = {"contacts": [{"number": 2}, {"number": 4}, {"number": 2}]}
    assert driven_into(problem, PAIRS, {"wheel"}) == "" == driven_into(None, PAIRS, {"body2"})
    told = driven_into(problem, PAIRS, {"body2", "other4"})
    ways = (("body2", "other2", 2), ("other4", "body4", 4))
    one, two = (f"{own}, which is driven, leaves {other} no way out at {PAIRS[k]}" for own, other, k in ways)
    assert told.startswith(f"{one}; {two}. This is a jam") and told.count("driven, leaves") == 2


@pytest.mark.parametrize(("stop", "words"), [
    (Stop.OVERLAP, "of overlap"), (Stop.LEDGER, "1 J are unaccounted for, of 2 J put in"),
    (Stop.UNEXPLAINED, "in contact: body3"),
    (Stop.TOO_MANY_EVENTS, "what alternates: dry friction in the bearing of lever"), (Stop.FAR_AWAY, "wheel is at 9 rad"),
])  # fmt: skip
def test_the_sentence_of_an_end_is_followed_by_what_is_known_of_it(stop: Stop, words: str) -> None:
    rows = np.rec.fromarrays([[1.0, 1.0], [1, 0]], names="scale,body")
    run: Any = SimpleNamespace(
        watch=SimpleNamespace(words=lambda: "of overlap"), energy=lambda: {"residual_J": 1.0, "in_J": 2.0}, pairs=PAIRS,
        state=SimpleNamespace(active=np.array([3]), now=SimpleNamespace(awake_contacts=1), q=np.array([1.0, 9.0])),
        scratch=SimpleNamespace(ended=SimpleNamespace(by=np.full(RECENT, BEARING), number=3)),
        scene=SimpleNamespace(bodies=[SimpleNamespace(name=name, prescribed=None) for name in ("wheel", "lever")]),
        compiled=SimpleNamespace(
            model=SimpleNamespace(coordinates=rows, bodies=[SimpleNamespace(motion=PIVOT, first=i) for i in (1, 0)])
        ),
    )  # fmt: skip
    said = frozen_run._words(run, stop)
    assert said.startswith(f"{stop.sentence}: {words}")
    assert frozen_run._words(run, Stop.DURATION) == Stop.DURATION.sentence
    assert frozen_run._words(run, Stop.LCP_FAILED) == Stop.LCP_FAILED.sentence  # nothing is driven
