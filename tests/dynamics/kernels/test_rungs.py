"""Is each rung of the ladder tried in its turn, does each alone solve small problems, and what is kept after a small change?"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from naive.lcp_oracle import residual, solutions
from plain_kernels import in_python
from sparse_contacts import Sparse

from watchsim.dynamics import coulomb, solver_fallbacks
from watchsim.dynamics.delassus import ContactWork, contact_work
from watchsim.dynamics.lcp.outcome import LcpOutcome
from watchsim.dynamics.problem_kinds import Level, Rung

M, BEARINGS = 2, 1
ELEMENTS, SIZE = M + BEARINGS, M + 2 * (M + BEARINGS)


def tried(lemke: LcpOutcome, works: str = "", elements: int = 2) -> tuple[Rung, list[str], ContactWork]:
    """(the rung that solves it, those tried before and it, the room), where only the one named `works` does."""
    asked: list[str] = []
    work = contact_work(3, 1)

    def rung(name: str) -> Any:
        def answer(work: ContactWork, *given: Any) -> bool:
            assert given[: 2 - (name in ("detour", "rough"))] == ((3, elements) if name in ("copositive", "modes") else (n,))
            asked.append(name)
            return name == works

        return answer

    n, detours = 3 + 2 * elements, {False: rung("detour"), True: rung("rough")}
    instead = {
        "lemke_checked": lambda A, b, size, lcp, x: lemke if size == n else None,
        "_solve_copositive": rung("copositive"),
        "_detour": lambda work, n, rough: detours[rough](work, n),
        "enumerate_modes": rung("modes"),
    }
    found = in_python(solver_fallbacks.solve_contacts, **instead)(work, 3, elements)
    return found, asked, work


@pytest.mark.parametrize(
    ("works", "rung"),
    [
        ("copositive", Rung.COPOSITIVE),
        ("detour", Rung.DETOUR),
        ("modes", Rung.ENUMERATED),
        ("rough", Rung.INEXACT),
        ("", Rung.FAILED),
    ],
)
def test_rung_after_rung_is_tried_and_counted(works: str, rung: Rung) -> None:
    found, asked, work = tried(LcpOutcome.RAY, works)
    order = ["copositive", "detour", "modes", "rough"]
    assert found == rung and asked == (order[: order.index(works) + 1] if works else order)
    assert work.rungs.tolist() == [int(place == rung) for place in range(6)]
    assert work.sizes.tolist() == [0, 0, 0, 1, 0, 0] and work.posed.lemke == LcpOutcome.RAY


def test_where_lemke_solves_it_nothing_else_is_tried_and_without_friction_there_is_no_other_form() -> None:
    assert tried(LcpOutcome.SOLVED)[:2] == (Rung.LEMKE, [])
    assert tried(LcpOutcome.INEXACT, "detour", elements=0)[:2] == (Rung.DETOUR, ["detour"])


def test_kinds_are_numbered_one_after_another() -> None:
    """They are places in arrays, and numbers in what is kept of a failure."""
    for kind, words in (
        (Rung, "LEMKE COPOSITIVE DETOUR ENUMERATED INEXACT FAILED"),
        (Level, "NONE ACCELERATION COMPRESSION EXPANSION"),
        (LcpOutcome, "SOLVED RAY TOO_MANY_PIVOTS INEXACT"),
    ):
        assert [(one.name, one.value) for one in kind] == [(word, place) for place, word in enumerate(words.split())]


@pytest.mark.parametrize("rough", [False, True])
def test_a_detour_takes_eight_other_paths_and_the_usual_one_too_where_it_may_be_rough(rough: bool) -> None:
    for outcome, close, expected in (
        (LcpOutcome.SOLVED, False, True),
        (LcpOutcome.INEXACT, True, rough),
        (LcpOutcome.INEXACT, False, False),
        (LcpOutcome.RAY, True, False),
    ):
        paths: list[int] = []

        def lemke(A: Any, b: Any, n: int, path: int, lcp: Any, x: Any, paths: Any = paths, outcome: Any = outcome) -> Any:
            paths.append(path)
            return outcome if path == 8 else LcpOutcome.RAY

        instead = {"lemke_on_path": lemke, "solves": lambda n, share, lcp, close=close: close and (n, share) == (5, 1e-9)}
        work = SimpleNamespace(A=None, rhs=None, lcp=None, x=None)
        assert bool(in_python(solver_fallbacks._detour, **instead)(work, 5, rough)) == expected
        assert paths == list(range(0 if rough else 1, 9))


def posed(seed: int, both_approach: bool = False, slow: float = 1.0) -> tuple[ContactWork, np.ndarray, np.ndarray]:
    """The compression of two contacts and a bearing; its matrix and right-hand side."""
    rng = np.random.default_rng(seed)
    case = Sparse(rng, M, 6, friction=0.3, slots=(4, 6))
    work, rows = contact_work(M, BEARINGS), 2 * M + BEARINGS
    both = np.vstack([case.W, np.eye(6)[5:]])
    work.G[:rows, :rows], work.drag[:] = both * case.work.inverse @ both.T, case.friction
    add = in_python(coulomb.add_element)
    for e, block in enumerate((1, 2, 0)):
        add(work, block, e, (2.0 * case.friction[block], 0.0, 0.0) if block < M else (0.0, 0.6, -0.3))
    assert in_python(coulomb.fill_matrix)(work, M, ELEMENTS) == SIZE
    b = both @ rng.normal(size=6)
    b[0] = -abs(b[0])
    if both_approach:
        b[:3:2] = -3.0 - np.abs(b[:3:2])
    in_python(coulomb.fill_rhs)(work, M, ELEMENTS, slow * b)
    work.rhs[M + ELEMENTS : SIZE] *= slow
    return work, work.A[:SIZE, :SIZE].copy(), work.rhs[:SIZE].copy()


RUNGS = {
    "copositive": lambda work: in_python(solver_fallbacks._solve_copositive)(work, M, ELEMENTS),
    "detour": lambda work: in_python(solver_fallbacks._detour)(work, SIZE, False),
    "rough": lambda work: in_python(solver_fallbacks._detour)(work, SIZE, True),
    "modes": lambda work: in_python(solver_fallbacks.enumerate_modes)(work, M, ELEMENTS),
}


@pytest.mark.parametrize("rung", RUNGS)
@pytest.mark.parametrize("seed", range(6))
def test_each_rung_alone_solves_small_problems(seed: int, rung: str) -> None:
    work, A, b = posed(seed)
    work.x[:] = np.nan
    assert RUNGS[rung](work)
    truth = solutions(A, b)
    assert residual(A, b, work.x[:SIZE]) < 1e-10
    assert min(np.abs(work.x[:SIZE] - other).max() for other in truth) < 1e-9


@pytest.mark.parametrize(
    ("m", "elements", "tries"), [(15, 0, True), (16, 0, False), (1, 9, True), (1, 10, False), (6, 6, True)]
)
def test_modes_are_tried_of_up_to_fifty_thousand_sets(m: int, elements: int, tries: bool) -> None:
    work = SimpleNamespace(A=None, rhs=None, x=None, lcp=SimpleNamespace(is_active=np.zeros(40, int)))
    instead = {
        "scale": lambda A, b, n, lcp: 3.0,
        "solve_active": lambda n, lcp: None,
        "is_solution": lambda n, lcp: n == m + 2 * elements,
        "unscale": lambda n, magnitude, lcp, x: None,
    }
    assert bool(in_python(solver_fallbacks.enumerate_modes, **instead)(work, m, elements)) == tries


def test_every_set_of_modes_is_tried_once() -> None:
    """Pressed or not; friction at its lower end, within, at its upper end, where the slip is active, too."""
    m, elements = 2, 2
    work = SimpleNamespace(A=None, rhs=None, x=None, lcp=SimpleNamespace(is_active=np.zeros(6, int)))
    seen: list[tuple[int, ...]] = []
    instead = {
        "scale": lambda *_: 1.0,
        "solve_active": lambda n, lcp: seen.append(tuple(lcp.is_active.tolist())),
        "is_solution": lambda *_: False,
    }
    assert not in_python(solver_fallbacks.enumerate_modes, **instead)(work, m, elements)
    pressed = {one[:2] for one in seen}
    friction = {(one[2 + e], one[4 + e]) for one in seen for e in range(2)}
    assert len(seen) == len(set(seen)) == 36
    assert pressed == {(0, 0), (0, 1), (1, 0), (1, 1)} and friction == {(0, 0), (1, 0), (1, 1)}


@pytest.mark.parametrize("rung", [Rung.LEMKE, Rung.COPOSITIVE])
@pytest.mark.parametrize("slow", [1.0, 2.0**-20])
@pytest.mark.parametrize("change", [1e-3, 3.0])
def test_after_a_small_change_the_same_unknowns_are_active(rung: Rung, change: float, slow: float) -> None:
    """If they still solve it; else the old solution stays."""
    kept = 0
    for seed in range(6):
        work, A, _ = posed(seed, both_approach=True, slow=slow)
        assert in_python(solver_fallbacks.solve_contacts)(work, M, ELEMENTS) == Rung.LEMKE
        before, active = work.x[:SIZE].copy(), work.x[:SIZE] > 0.0
        work.rhs[:M] += slow * change * np.array([1.0, -0.6])
        if rung != Rung.LEMKE:
            work.lcp.is_active[:] = 7
        in_python(solver_fallbacks.keep_basis)(work, M, ELEMENTS, rung)
        expected = np.zeros(SIZE)
        expected[active] = np.linalg.solve(A[np.ix_(active, active)], -work.rhs[:SIZE][active])
        solves = residual(A, work.rhs[:SIZE] / slow, expected / slow) < 1e-10
        assert work.x[:SIZE] == pytest.approx(expected if solves else before, rel=1e-9, abs=1e-10 * slow)
        kept += solves
    assert kept == 6 if change < 1.0 else kept < 6


@pytest.mark.parametrize(("share", "forgiven"), [(0.9e-13, True), (1.1e-13, False)])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_rounding_in_the_place_of_zeros_is_forgiven(share: float, forgiven: bool, sign: float) -> None:
    """In the scaling of the solver; below zero whatever it is, since the check of the conditions follows."""
    columns, trial, x = np.array([4.0, 0.5]), np.full(2, np.nan), np.array([3.0, 0.0])
    work = SimpleNamespace(A=None, rhs=None, x=x, lcp=SimpleNamespace(column_scale=columns, trial=trial))
    x[1] = sign * share * 0.5 * 2.0
    instead = {"scale": lambda *_: 2.0, "is_solution": lambda n, lcp: n == 2}
    assert in_python(solver_fallbacks._is_solved, **instead)(work, 2)
    assert trial == pytest.approx([3.0 / 8.0, 0.0 if forgiven or sign < 0.0 else share], rel=1e-12, abs=0.0)
