"""When does a free direction count, and by how much may forces that no motion decides miss a law?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics import acceleration, impact, redundant_contacts
from watchsim.dynamics.delassus import contact_work


@pytest.mark.parametrize(("share", "kept"), [(0.9, 1), (1.1, 2)])
@pytest.mark.parametrize("length", [1.0, 30.0])
def test_what_is_left_of_a_direction_counts_from_a_hundred_trillionth_of_a_millionth_of_its_square_on(
    share: float, kept: int, length: float
) -> None:
    rest = (share * 1e-20) ** 0.5
    vectors = np.array([[1.0, 0.0], [length, length * rest]])
    assert in_python(redundant_contacts._orthonormalize)(vectors, 2, 2, np.ones(2)) == kept


def test_what_moves_with_difficulty_has_its_worth_and_its_slack() -> None:
    """However small its mobility; what does not move at all has none."""
    work = SimpleNamespace(G=np.diag([1e-6, 9.0, 0.0, 9.0, -1.0, 9.0]), size=np.array([3.0, 9.0, 4.0, 9.0, 5.0, 9.0]))
    work.worth = np.full(3, np.nan)
    in_python(acceleration._fill_worth)(work, 3)
    assert work.worth.tolist() == pytest.approx([3e6, 0.0, 0.0])
    slacks = [in_python(redundant_contacts._slack)(work, i, 2.0) for i in range(3)]
    assert slacks == pytest.approx([0.25 * 2.0 * 1e-10 * 3e6, 0.0, 0.0], rel=1e-12, abs=0.0)


def test_small_arms_are_parallel_too() -> None:
    asked = in_python(impact.is_parallel)
    for unit in (1.0, 1e-6):
        assert asked(SimpleNamespace(G=unit * np.array([[4.0, 6.0], [6.0, 9.0]])), 0)
        assert not asked(SimpleNamespace(G=unit * np.array([[4.0, 5.9], [5.9, 9.0]])), 0)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("share", "counts"), [(0.9, False), (1.1, True)])
def test_a_direction_along_the_edge_of_a_law_does_nothing_for_it(share: float, counts: bool, sign: float) -> None:
    work = SimpleNamespace(B=np.array([[9.0, 9.0], [0.5, 0.25]]))
    vector = np.array([sign * share * 4e-11, -sign * share * 4e-11])
    gain = in_python(redundant_contacts._gain)(work, 2, 1, vector)
    assert gain == (pytest.approx(sign * share * 1e-11, rel=1e-9, abs=0.0) if counts else 0.0)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_laws_may_be_missed_by_a_billionth_of_the_largest_force(share: float) -> None:
    """Of either sign: then nothing is searched."""
    asked: list[int] = []

    def lemke(A: object, b: object, laws: int, lcp: object, x: np.ndarray) -> int:
        asked.append(laws)
        return 1

    for largest in (3.0, -3.0):
        x = np.array([largest, -share * 1e-9 * 3.0])
        work = SimpleNamespace(x=x, B=np.eye(2), free=np.zeros((1, 2)), other_rhs=np.array([0.0 - min(0.0, largest), 0.0]))
        work.rhs, work.other_x, work.A, work.lcp, work.dual = np.zeros(2), np.zeros(2), np.zeros((2, 2)), None, None
        in_python(redundant_contacts._keep_laws, lemke_checked=lemke)(2, 2, 1, work)
    assert len(asked) == (0 if share < 1.0 else 4)


def test_a_law_at_its_edge_is_not_broken_to_obey_another() -> None:
    """x >= 0 and 0.8 y >= 0.6 x from (0, -1): what would obey the second alone breaks the first; the corner obeys both."""
    work = contact_work(2, 2)
    work.x[:2], work.B[:2, :2], work.free[:2, :2] = [0.0, -1.0], [[1.0, 0.0], [-0.6, 0.8]], np.eye(2)
    in_python(redundant_contacts._keep_laws)(2, 2, 2, work)
    assert work.x[:2] == pytest.approx([0.0, 0.0], abs=1e-14)
