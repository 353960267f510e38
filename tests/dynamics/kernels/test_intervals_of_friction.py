"""In which interval may friction lie in the expansion, and in which order is an impact put together?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics import coulomb, expansion_friction, impact
from watchsim.dynamics.problem_kinds import Rung
from watchsim.model.records import COULOMB, PG1996, SHIFTED

MU, BACK, SHARE, N = 0.4, 0.7, 0.6, 2.0  # friction, tangential and normal restitution, normal impulse
Two = tuple[float, float]
INTERVAL = in_python(expansion_friction.interval)


def interval(kind: int, T: float, normal: float = N, share: float = SHARE) -> tuple[float, ...]:
    found: tuple[float, ...] = INTERVAL(SimpleNamespace(kind=kind, friction=MU, tangential=BACK), share, normal, T)
    return found


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("off", "one_sided"), [(0.9e-10, False), (1.1e-10, True)])
def test_a_tangential_impulse_that_small_in_its_cone_has_no_sign(off: float, one_sided: bool, sign: float) -> None:
    T = sign * off * MU * N
    returned = SHARE * BACK * T
    cone = MU * SHARE * N
    span = cone - abs(returned)
    low = (0.5 * MU, -0.5 * span) if not one_sided else (0.0, abs(returned)) if sign > 0.0 else (MU, -cone)
    assert interval(PG1996, T) == pytest.approx((low[0], MU, span, low[1], returned), rel=1e-14, abs=0.0)


@pytest.mark.parametrize("T", [0.3, -0.3])
def test_what_was_not_pressed_has_half_a_cone_to_either_side(T: float) -> None:
    assert interval(PG1996, T, normal=0.0) == pytest.approx((0.5 * MU, MU, 0.0, 0.0, SHARE * BACK * T))


def test_what_was_hardly_pressed_is_pressed() -> None:
    press, T = 1e-4, 2e-5
    returned = SHARE * BACK * T
    assert interval(PG1996, T, press) == pytest.approx((0.0, MU, MU * SHARE * press - returned, returned, returned), rel=1e-12)


def test_no_interval_is_of_negative_length() -> None:
    """Where rounding has left friction outside its cone."""
    law = SimpleNamespace(kind=PG1996, friction=MU, tangential=1.0)
    assert INTERVAL(law, 1.0, N, (1.0 + 1e-15) * MU * N)[2] == 0.0


def test_the_usual_law_gives_nothing_back_and_another_no_more_than_restitution() -> None:
    cone = MU * SHARE * N
    assert interval(COULOMB, 0.3) == pytest.approx((MU, 2.0 * MU, 2.0 * cone, -cone, 0.0))
    radius = MU * (0.9 - BACK) * N
    assert interval(SHIFTED, 0.3, share=0.9) == pytest.approx((MU, 2.0 * MU, 2.0 * radius, BACK * 0.3 - radius, 0.0))
    assert interval(SHIFTED, 0.3) == pytest.approx((MU, 2.0 * MU, 0.0, SHARE * 0.3, 0.0))


@pytest.mark.parametrize("friction", [(0.3, 0.0, 1e-4), (0.0, 0.0, 0.0), (0.0, 0.2, 0.5)])
def test_every_contact_with_friction_however_small_has_an_element(friction: tuple[float, ...]) -> None:
    drag, tangent = np.full(3, np.nan), np.full(3, 77)
    work = SimpleNamespace(drag=drag, tangent=tangent, block=[9] * 3, width=[9.0] * 3, span=[9.0] * 3, shift=[9.0] * 3)
    model = SimpleNamespace(laws=[SimpleNamespace(friction=mu) for mu in friction], contacts=[None] * 4)
    model.contacts = [SimpleNamespace(group=(k + 1) % 3) for k in range(3)]
    closed = SimpleNamespace(ids=[2, 0, 1])
    rough = [i for i, mu in enumerate(friction) if mu > 0.0]
    assert in_python(impact._begin)(model, closed, 3, work) == len(rough)
    assert drag.tolist() == list(friction)
    assert tangent.tolist() == [rough.index(i) if i in rough else -1 for i in range(3)]
    assert work.block[: len(rough)] == rough and work.width[: len(rough)] == [2.0 * friction[i] for i in rough]
    assert work.span[: len(rough)] == work.shift[: len(rough)] == [0.0] * len(rough)
    assert in_python(coulomb.element_row)(SimpleNamespace(block=[2, 5]), 3, 0) == 5
    assert in_python(coulomb.element_row)(SimpleNamespace(block=[2, 5]), 3, 1) == 8


def impacted(
    share: tuple[float, float], normal: tuple[float, float], expands: bool = True
) -> tuple[bool, list[str], list[float]]:
    """(is it solved?, what was done, impulses) of an impact of two contacts."""
    done: list[str] = []
    force = np.array([normal[0], 2.0, normal[1], 4.0, 99.0])
    work = SimpleNamespace(force=force, more=np.array([10.0, 20.0, 30.0, 40.0, 50.0]), b=None, inverse=None)

    def note(name: str, answer: object) -> object:
        return lambda *given: (done.append(name), answer)[1]  # type: ignore[func-returns-value]

    instead = {
        "_compress": note("compress", (share != (9.0, 9.0), 1)),
        "_expand": note("expand", expands),
        "restore_directions": lambda work, rows, b: done.append(f"restore {rows}"),
        "apply": note("apply", None),
    }
    solved = in_python(impact.impact, **instead)(None, None, 2, share, 0.0, work, np.zeros(1))
    return bool(solved), done, force.tolist()


@pytest.mark.parametrize(
    ("share", "normal", "expands"),
    [
        ((0.5, 0.0), (1.0, 0.0), True),
        ((0.5, 0.0), (0.0, 1.0), False),
        ((0.0, 1e-4), (0.0, 1e-4), True),
        ((0.0, 0.0), (1.0, 1.0), False),
    ],
)
def test_only_what_was_pressed_and_gives_back_expands(
    share: tuple[float, float], normal: tuple[float, float], expands: bool
) -> None:
    solved, done, force = impacted(share, normal)
    assert solved and done == ["compress", *(["expand"] if expands else []), "restore 4", "apply"]
    more = [10.0, 20.0, 30.0, 40.0] if expands else [0.0] * 4
    assert force == [normal[0] + more[0], 2.0 + more[1], normal[1] + more[2], 4.0 + more[3], 99.0]


def test_an_impact_without_a_solution_changes_nothing() -> None:
    assert impacted((9.0, 9.0), (1.0, 1.0))[:2] == (False, ["compress", "restore 4"])
    assert impacted((0.5, 0.5), (1.0, 1.0), expands=False)[:2] == (False, ["compress", "expand", "restore 4"])


@pytest.mark.parametrize("nudged", [(False, False), (True, False), (False, True)])
@pytest.mark.parametrize("rung", [Rung.LEMKE, Rung.COPOSITIVE, Rung.FAILED])
def test_what_was_nudged_is_solved_again_without(nudged: tuple[bool, bool], rung: Rung) -> None:
    done: list[object] = []
    names = ("_begin", "fill_delassus", "contact_velocities", "_drop_rounding", "reverse_directions", "_grip_more")
    instead = {name: lambda *_: 4 for name in (*names, "fill_matrix", "note_posed", "read_forces")} | {
        "inverse_mass": lambda one: one,
        "fill_rhs": lambda *_: done.append("fill"),
        "_nudge": lambda *_: nudged[0],
        "_keep_sliding": lambda *_: nudged[1],
        "solve_contacts": lambda *_: rung,
        "keep_basis": lambda work, m, elements, rung: done.append((m, elements, rung)),
    }
    work = SimpleNamespace(inverse=np.zeros(1), b=None, force=None)
    model = SimpleNamespace(coordinates=[0.25])
    assert in_python(impact._compress, **instead)(model, None, 3, None, 0.0, work) == (rung != Rung.FAILED, 4)
    again = any(nudged) and rung != Rung.FAILED
    assert done == ["fill", *(["fill", (3, 4, rung)] if again else [])] and work.inverse.tolist() == [0.25]


@pytest.mark.parametrize(("jam", "found"), [(0.0, False), (1e-7, True), (1e-9, False)])
def test_a_gap_that_stands_still_to_the_speed_of_a_jam_is_nudged(jam: float, found: bool) -> None:
    """However slow that is; the rate is 5e-9 m/s, the slip 2e-6 m/s."""
    work = SimpleNamespace(tangent=[0], b=[-5e-9, 2e-6], unit=[4.0], rhs=np.zeros(1))
    assert bool(in_python(impact._nudge)(1, jam, work)) == found
    assert work.rhs[0] == pytest.approx(-1e-6 * 2e-6 * 4.0 if found else 0.0, rel=1e-12, abs=0.0)
