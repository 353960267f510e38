"""Which overlaps are taken back at the start, and by the smallest change that does it?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.optimize import minimize

from watchsim.model.records import Model
from watchsim.simulation import overlap_removal
from watchsim.simulation.overlap_removal import _beside, _furthest, _least_change, directions, overlapping_rows, taken_back_from

OPTIONS = SimpleNamespace(extent=1e-3, gap_zero=1e-9, size=2.0)


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("unit", [1.0, 1e-6])
def test_the_change_is_the_smallest_that_opens_every_gap(seed: int, unit: float) -> None:
    """Against a general minimiser; some gaps are open already."""
    rng = np.random.default_rng(seed)
    ways, wanted = rng.normal(size=(4, 3)) * rng.uniform(0.1, 3.0, (4, 1)), np.array([0.3, 0.1, -0.2, 0.05])
    found = _least_change(ways, unit * wanted)
    rule = {"type": "ineq", "fun": lambda y: ways @ y - wanted, "jac": lambda y: ways}
    best = minimize(
        lambda y: y @ y, np.zeros(3), jac=lambda y: 2.0 * y, constraints=rule, method="SLSQP", options={"ftol": 1e-15}
    )
    if not best.success:
        assert found is None
        return
    assert found is not None
    assert np.all(ways @ found >= unit * (wanted - 1e-9))
    assert found == pytest.approx(unit * best.x, abs=1e-5 * unit)


def test_what_is_wedged_in_cannot_be_taken_back() -> None:
    assert _least_change(np.array([[1.0, 0.0], [-1.0, 0.0]]), np.array([0.1, 0.1])) is None
    assert _least_change(np.array([[1.0, 0.0], [-1.0, 1e-2]]), np.array([0.1, 0.1])) is not None


def outline(count: int, corners: tuple[int, ...]) -> np.recarray:
    """A closed chain of primitives, each with the one before and after it."""
    rows = np.zeros(count, [("before", "i8"), ("after", "i8"), ("corner", "i8")]).view(np.recarray)
    rows.before, rows.after = np.roll(np.arange(count), 1), np.roll(np.arange(count), -1)
    rows.corner[list(corners)] = 1
    return rows


def test_two_primitives_to_either_side_lie_beside_one() -> None:
    rows = outline(7, ())
    assert sorted(_beside(SimpleNamespace(primitives=rows), 0)) == [1, 2, 5, 6]
    rows.after[1] = -1
    rows.before[0] = -1
    assert sorted(_beside(SimpleNamespace(primitives=rows), 0)) == [1]


def contacts(gaps: list[float], margins: list[float], met: list[int], circles: list[int]) -> tuple[Model, SimpleNamespace]:
    made = SimpleNamespace(
        contacts=np.rec.fromarrays([circles, met], names="a,b"), primitives=outline(20, ()),
    )  # fmt: skip
    kin = SimpleNamespace(g=np.array(gaps), margin=np.array(margins))
    return made, SimpleNamespace(kin=kin)  # type: ignore[return-value]


@pytest.mark.parametrize(
    ("gap", "margin", "counts"),
    [(-1.1e-6, 0.0, True), (-0.9e-6, 0.0, False), (-0.9e-4, -0.9e-3, True), (-1.1e-4, 0.0, False), (-1e-5, -1.1e-3, False)],
)
def test_an_overlap_counts_between_the_least_and_what_is_near_and_within_its_primitives(
    gap: float, margin: float, counts: bool
) -> None:
    model, closed = contacts([0.5, gap], [0.0, margin], [3, 9], [30, 31])
    assert overlapping_rows(model, closed, OPTIONS, 1e-4, 1e-6).tolist() == ([1] if counts else [])


@pytest.mark.parametrize(
    ("other", "circle", "gap", "margin", "counts"),
    [
        (6, 30, -1e-6, 0.0, False),  # beside it, less deep: this one is the back of the corner
        (7, 30, 1e-6, 0.0, False),
        (3, 30, -1e-6, 0.0, False),
        (8, 30, -1e-6, 0.0, True),  # further along the outline
        (6, 31, -1e-6, 0.0, True),  # another circle
        (6, 30, -2e-5, 0.0, True),  # deeper: the other one is the back
        (6, 30, -1e-6, -2e-3, True),  # outside its primitives
    ],
)
def test_the_back_of_a_corner_does_not_count(other: int, circle: int, gap: float, margin: float, counts: bool) -> None:
    model, closed = contacts([-1e-5, gap], [0.0, margin], [5, other], [30, circle])
    assert (0 in overlapping_rows(model, closed, OPTIONS, 1e-4, 1.5e-6).tolist()) == counts


def test_directions_over_coordinates_add_up_what_acts_on_the_same_one() -> None:
    closed = SimpleNamespace(ids=[0, 1], slots=[2, 3], coord=np.array([[0, 2, 9], [1, 1, 3]]))
    sparse = np.array([[1.0, 2.0, 9.0], [3.0, 4.0, 5.0]])
    assert directions(closed, sparse, 4).tolist() == [[1.0, 0.0, 2.0, 0.0], [0.0, 7.0, 0.0, 5.0]]


def test_how_far_a_change_moves_a_point_at_most() -> None:
    model = SimpleNamespace(coordinates=SimpleNamespace(scale=np.array([1.0, 2.0, 0.5])))
    assert _furthest(model, np.array([0.1, -0.5, 0.1]), 2.0) == pytest.approx(0.5)


def removed(gap: float, slope: float, near: float, tangent: float = 0.0, mass: float = 4.0) -> float | None:
    """The place at which a body that overlaps at 0 by -gap is put, its gap growing with that slope; None where it is not."""

    def at(model, q):
        kin = SimpleNamespace(g=np.array([gap + slope * float(q[0])]), margin=np.zeros(1))
        slots = {"slots": [1], "coord": np.zeros((1, 1), int)}
        return SimpleNamespace(ids=[0], kin=kin, w_N=np.array([[slope]]), w_T=np.array([[tangent]]), **slots)

    coordinates = SimpleNamespace(mass=np.array([mass]), scale=np.array([2.0]))
    model = SimpleNamespace(
        contacts=np.rec.fromarrays([[30], [5]], names="a,b"), primitives=outline(20, ()), coordinates=coordinates
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(overlap_removal, "kinematics_at", at)
        found = taken_back_from(model, np.zeros(1), OPTIONS, near)
    return None if found is None else float(found[0])


def test_an_overlap_is_taken_back_to_zero() -> None:
    assert removed(-1e-4, 2.0, 1e-3) == pytest.approx(0.5e-4)
    assert removed(-1e-4, -0.5, 1e-3) == pytest.approx(-2e-4)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_ten_times_the_gap_that_is_zero_may_be_left(share: float) -> None:
    assert (removed(-share * 10.0 * 1e-9, 1.0, 1e-3) == 0.0) == (share < 1.0)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_nothing_is_moved_further_than_fifty_times_what_is_near(share: float) -> None:
    near = 1e-3
    assert (removed(-near, near / (share * 50.0 * near), near) is None) == (share > 1.0)


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_what_hardly_moves_across_is_left_as_it_is(share: float) -> None:
    """A millionth of how it moves along the face."""
    found = removed(-1e-12 - 1e-7, share * 1e-6, 1e-2, tangent=1.0)
    assert (found == 0.0) == (share < 1.0)


@pytest.mark.parametrize(("gap", "margin", "heeded"), [
    (0.0, 0.0, True), (0.9e-3, 0.0, True), (1.1e-3, 0.0, False), (0.0, -0.9e-3, True), (0.0, -1.1e-3, False),
    (0.5e-3, 0.9e-3, True),
])  # fmt: skip
def test_what_touches_from_outside_is_not_pushed_into(gap: float, margin: float, heeded: bool) -> None:
    """Near, and within its primitives: 2 x + y takes the overlap back, x closes the other gap."""

    def at(model, q):
        x, y = q
        kin = SimpleNamespace(g=np.array([-1e-3 + 2.0 * x + y, gap - x]), margin=np.array([0.0, margin]))
        ways = np.array([[2.0, 1.0], [-1.0, 0.0]])
        return SimpleNamespace(ids=[0, 1], kin=kin, w_N=ways, w_T=0.0 * ways, slots=[2, 2], coord=np.array([[0, 1], [0, 1]]))

    coordinates = SimpleNamespace(mass=np.ones(2), scale=np.full(2, 2.0))
    model = SimpleNamespace(
        contacts=np.rec.fromarrays([[30, 31], [5, 9]], names="a,b"), primitives=outline(20, ()), coordinates=coordinates
    )
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(overlap_removal, "kinematics_at", at)
        found = taken_back_from(model, np.zeros(2), OPTIONS, 1e-3)
    assert found is not None
    most = min(gap, 0.4e-3) if heeded else 0.4e-3  # alone, x is twice y
    assert found == pytest.approx([most, 1e-3 - 2.0 * most], abs=1e-9)
