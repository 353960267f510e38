"""Do the complementarity problems say the law of each friction force, in unscaled forces and rates?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.dynamics import coulomb, handedness
from watchsim.dynamics.delassus import ContactWork, contact_work

M, BEARINGS, ROWS = 3, 2, 8
BLOCKS = (4, 0, 2, 3)  # of each element: a bearing, two contacts, the other bearing; contact 1 has none
ROW_OF = (7, 1, 5, 6)  # of G
ELEMENTS = len(BLOCKS)
SIZE = M + 2 * ELEMENTS


def posed(seed: int) -> tuple[ContactWork, np.ndarray, np.random.Generator]:
    """Any G, any intervals of friction; and rates of the rows."""
    rng = np.random.default_rng(seed)
    work = contact_work(M, BEARINGS)
    work.A[:], work.rhs[:] = np.nan, np.nan
    work.G[:] = rng.normal(size=(ROWS, ROWS))
    work.G[np.arange(ROWS), np.arange(ROWS)] = 10.0 ** rng.uniform(-3.0, 3.0, ROWS)
    work.drag[:] = rng.normal(size=M)
    for e, block in enumerate(BLOCKS):
        assert in_python(coulomb.add_element)(work, block, e, tuple(rng.uniform(0.1, 1.0, 3))) == e + 1
    return work, rng.normal(size=ROWS), rng


@pytest.mark.parametrize("seed", range(6))
def test_lines_are_rates_of_gaps_and_slips_and_what_is_left_of_intervals(seed: int) -> None:
    """For any forces above the lower ends, whatever their units: those give G a diagonal of one."""
    work, b, rng = posed(seed)
    assert in_python(coulomb.fill_matrix)(work, M, ELEMENTS) == SIZE
    in_python(coulomb.fill_rhs)(work, M, ELEMENTS, b)
    above, slip, pressed = rng.normal(size=ELEMENTS), rng.normal(size=ELEMENTS), rng.normal(size=M)
    own = np.diag(work.G)
    unit = np.append(np.maximum(own[:6:2], own[1:6:2]), own[6:]) ** -0.5
    assert work.unit == pytest.approx(unit)
    force = np.zeros(ROWS)  # less the constant parts of the lower ends, which are in b
    force[:6:2], force[1:6:2] = pressed, -work.drag * pressed
    for e, row in enumerate(ROW_OF):
        force[row] += above[e]
    rates, units = b + work.G @ force, unit[list(BLOCKS)]
    width = [pressed[block] * work.width[e] if block < M else 0.0 for e, block in enumerate(BLOCKS)]
    unknowns = np.concatenate([pressed / unit[:M], above / units, slip])
    found = work.A[:SIZE, :SIZE] @ unknowns + work.rhs[:SIZE]
    assert found[:M] == pytest.approx(unit[:M] * rates[:6:2])
    assert found[M : M + ELEMENTS] == pytest.approx(units * rates[list(ROW_OF)] + slip)
    assert found[M + ELEMENTS :] == pytest.approx((width + work.span[:ELEMENTS] - above) / units)
    assert np.isnan(work.A[SIZE:]).all() and np.isnan(work.A[:, SIZE:]).all() and np.isnan(work.rhs[SIZE:]).all()
    work.x[:SIZE] = unknowns
    forces = np.zeros(ROWS)
    in_python(coulomb.read_forces)(work, M, ELEMENTS, forces)
    for e, row in enumerate(ROW_OF):
        force[row] += work.shift[e]
    assert forces == pytest.approx(force)


def test_what_nothing_moves_keeps_its_unit() -> None:
    work, _, _ = posed(1)
    work.G[2, 2] = work.G[3, 3] = work.G[7, 7] = 0.0
    in_python(coulomb._fill_units)(work, M, ELEMENTS)
    assert work.unit[[1, 4]].tolist() == [1.0, 1.0]


def reversed_rows(slip: list[float], across: float = 0.5, own: tuple[float, float] = (2.0, 3.0), block: int = 1) -> list[float]:
    """Which rows are reversed, of a contact and of a second contact or (block 2) a bearing."""
    rng = np.random.default_rng(7)
    half = rng.normal(size=(5, 5))
    G = half + half.T
    G[1, 1], G[2 * block + (block < 2), 2 * block + (block < 2)] = own
    G[1, 0] = G[0, 1] = across
    G[3, 2] = G[2, 3] = across
    rates = np.array(slip)
    work = SimpleNamespace(G=G.copy(), hand=np.full(5, 9.0), block=np.array([0, block]), force=rng.normal(size=5))
    force = work.force.copy()
    in_python(handedness.reverse_directions)(work, 2, 5, 2, rates)
    hand = work.hand.copy()
    assert np.array_equal(work.G, G * np.outer(hand, hand)) and np.array_equal(rates, hand * slip)
    in_python(handedness.restore_directions)(work, 5, rates)
    assert np.array_equal(work.G, G) and rates.tolist() == slip and work.force == pytest.approx(hand * force)
    return list(hand)


def test_directions_are_taken_such_that_slips_are_positive() -> None:
    """In the rows of elements alone; G, slips and forces change with them, and back."""
    assert reversed_rows([-1.0, -0.3, -1.0, 0.4, -2.0]) == [1, -1, 1, 1, 1]
    assert reversed_rows([1.0, 0.3, 1.0, -0.4, 2.0]) == [1, 1, 1, -1, 1]
    assert reversed_rows([-1.0, -0.3, -1.0, -0.4, -2.0], block=2) == [1, -1, 1, 1, -1]


@pytest.mark.parametrize("across", [0.5, -0.5])
@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize(("share", "by_slip"), [(0.9e-9, False), (1.1e-9, True)])
def test_what_hardly_slips_has_the_direction_that_a_normal_force_gives_it(
    share: float, by_slip: bool, sign: float, across: float
) -> None:
    """Below a billionth of the fastest, each by what would stop it; a bearing has the sign of its slip in any case."""
    slow = sign * share * 0.7 * (3.0 / 2.0) ** 0.5
    expected = -1 if (sign if by_slip else across) < 0.0 else 1
    assert reversed_rows([1.0, 0.7, 1.0, slow, 1.0], across)[3] == expected
    assert reversed_rows([1.0, 0.7, 1.0, 1.0, slow], across, block=2)[4] == (-1 if sign < 0.0 else 1)


def test_what_nothing_can_stop_does_not_count_as_the_fastest() -> None:
    assert reversed_rows([1.0, 5e9, 1.0, -0.2, 1.0], own=(0.0, 3.0)) == [1, 1, 1, -1, 1]
    for own in (1.0, 1e-6):
        assert reversed_rows([1.0, 5e9, 1.0, -0.2, 1.0], own=(own, 3.0)) == [1, 1, 1, 1, 1]
