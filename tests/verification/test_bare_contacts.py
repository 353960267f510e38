"""Are contacts without any geometry put to the kernels as they are given? The kernels' answers are made up."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from watchsim.contact.index_sets import OPEN, STICK
from watchsim.model.records import TANGENTIAL_CODE
from watchsim.verification import bare_contacts as module
from watchsim.verification.bare_contacts import BareContacts

RNG = np.random.default_rng(77)
MASS, W = np.array([0.5, 3.0, 7.0, 11.0]), RNG.normal(size=(6, 4))
FRICTION, RESTITUTION = np.array([0.15, 0.35, 0.6]), np.array([0.2, 0.5, 0.9])
U, H = np.array([1.5, -0.4, 0.7, 2.5]), np.array([0.3, -8.0, 5.0, 0.9])


@pytest.fixture
def case() -> BareContacts:
    return BareContacts(MASS, W, FRICTION, RESTITUTION)


def answers(monkeypatch: pytest.MonkeyPatch, kernel: str, write: Any) -> list[tuple[Any, ...]]:
    """What the kernel is given, by call; `write` fills in what it answers."""
    seen: list[tuple[Any, ...]] = []

    def made_up(*given: Any) -> bool:
        seen.append(given)
        write(*given)
        return True

    monkeypatch.setattr(module, kernel, made_up)
    return seen


def test_the_model_has_masses_and_laws_and_nothing_else(case: BareContacts) -> None:
    model = case.model
    assert model.coordinates.mass.tolist() == MASS.tolist() and model.contacts.group.tolist() == [0, 1, 2]
    assert model.laws.friction.tolist() == FRICTION.tolist() and not model.laws.tangential.any() and not model.laws.nu.any()
    assert set(model.laws.kind.tolist()) == {TANGENTIAL_CODE["coulomb"]}
    for part in ("bodies", "joints", "lines", "tables", "primitives", "pairs", "near", "knots"):
        assert len(getattr(model, part)) == 0
    assert model.knots.shape == (0, 2)
    assert pytest.approx(np.einsum("in,jn,n->ij", W, W, 1.0 / MASS)) == case.G


def test_tangential_laws_as_in_the_scene_file() -> None:
    other = next(law for law in TANGENTIAL_CODE if law != "coulomb")
    model = BareContacts(MASS, W, FRICTION, RESTITUTION, other, tangential=np.array([0.1, 0.3, 0.8]), nu=0.7).model
    assert model.laws.tangential.tolist() == [0.1, 0.3, 0.8] and set(model.laws.nu.tolist()) == {0.7}
    assert set(model.laws.kind.tolist()) == {TANGENTIAL_CODE[other]}


@pytest.mark.parametrize("taken", [[0, 1, 2], [2, 0], [1], []])
def test_those_that_take_part_stand_in_this_order(case: BareContacts, taken: list[int]) -> None:
    if taken != [0, 1, 2]:  # at first all do
        case.take(taken)
    assert case.taken == taken
    for row, i in enumerate(taken):
        closed = case.closed
        assert (closed.ids[row], closed.slots[row], closed.coord[row, :4].tolist()) == (i, 4, [0, 1, 2, 3])
        assert closed.w_N[row, :4].tolist() == W[2 * i].tolist() and closed.w_T[row, :4].tolist() == W[2 * i + 1].tolist()


@pytest.mark.parametrize("given", [None, np.array([0.3, 0.4, 0.7])])
def test_impacts(case: BareContacts, monkeypatch: pytest.MonkeyPatch, given: np.ndarray | None) -> None:
    def write(model: Any, closed: Any, m: int, shares: Any, jam: float, work: Any, out: Any) -> None:
        work.force[:] = np.arange(len(work.force)) + 0.5
        out += 10.0

    seen = answers(monkeypatch, "impact", write)
    case.take([2, 0])
    solved, after, force = case.impact(U, given)
    assert solved is True and after.tolist() == (U + 10.0).tolist() and U[0] == 1.5
    assert force.tolist() == [0.5, 1.5, 2.5, 3.5]
    model, closed, m, shares, jam = seen[0][:5]
    assert model is case.model and closed is case.closed and (m, jam) == (2, 0.0)
    assert shares.tolist() == ([0.9, 0.2] if given is None else [0.7, 0.3])
    case.work.force[:] = 0.0
    assert force[0] == 0.5  # a copy


def test_modes(case: BareContacts, monkeypatch: pytest.MonkeyPatch) -> None:
    def write(model: Any, closed: Any, m: int, bearings: int, zero: float, work: Any, grip: Any, mode: Any) -> None:
        assert len(grip) == 4 and mode.tolist() == [OPEN] * 3
        mode[2] = STICK

    seen = answers(monkeypatch, "decide_modes", write)
    case.take([2, 0])
    solved, mode = case.modes(U, H, 3e-7)
    assert solved is True and mode.tolist() == [OPEN, OPEN, STICK]
    assert seen[0][2:5] == (2, 0, 3e-7) and case.work.h.tolist() == H.tolist()
    rates = W @ U
    for row, i in enumerate((2, 0)):
        kin = case.closed.kin[row]
        assert (kin.gN_dot, kin.gT_dot) == pytest.approx((rates[2 * i], rates[2 * i + 1]), rel=1e-14)


def test_forces(case: BareContacts, monkeypatch: pytest.MonkeyPatch) -> None:
    def write(model: Any, closed: Any, m: int, mode: Any, lenience: float, work: Any) -> None:
        assert mode.dtype == np.int8 and mode.tolist() == [STICK, OPEN, STICK]
        assert work.inverse == pytest.approx(1.0 / MASS) and work.h.tolist() == H.tolist()
        work.force[:] = np.arange(len(work.force)) - 1.5

    seen = answers(monkeypatch, "solve_mode", write)
    case.take([2, 0])
    force = case.forces(H, np.array([STICK, OPEN, STICK]))
    assert force.tolist() == [-1.5, -0.5, 0.5, 1.5] and (seen[0][2], seen[0][4]) == (2, 1.0)
    case.work.force[:] = 0.0
    assert force[0] == -1.5


def test_energies(case: BareContacts, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_energy_change", lambda m, work: (-0.25 * m, 9.0))
    case.take([1, 2])
    assert case.energy_change() == -0.5
    assert case.kinetic(U) == pytest.approx(0.5 * (0.5 * 2.25 + 3.0 * 0.16 + 7.0 * 0.49 + 11.0 * 6.25), rel=1e-14)
