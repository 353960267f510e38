"""Do contacts stay closed, stick and rub as their modes say, under the forces that are found? With made-up directions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from watchsim.analysis.balanced_forces import Mechanism
from watchsim.contact.index_sets import STICK
from watchsim.dynamics.equations_of_motion import Seen

TIMES, WIDTH = 3, 7
RNG = np.random.default_rng(21)
FRICTION = np.array([0.9, 0.3, 0.7, 0.15, 0.5])  # of contacts 0 to 4


def mechanism(monkeypatch: pytest.MonkeyPatch, seen: Seen, **changed: Any) -> Any:
    made: Any = Mechanism.__new__(Mechanism)
    values: dict[str, Any] = {
        **{"mobility": np.array([0.5, 2.0, 3.0, 0.25, 1.5, 4.0, 0.7]), "friction": FRICTION},
        **{"dry": np.zeros(WIDTH), "prescribed": np.zeros(WIDTH, bool)},
    }
    for name, value in (values | changed).items():
        setattr(made, name, value)
    monkeypatch.setattr(Mechanism, "seen", lambda self, t, q, u, ids: seen)
    return made


def directions(contacts: int) -> Seen:
    """Of which no contact can carry what another does: there is only one answer."""
    shape = (TIMES, contacts, WIDTH)
    bar, places = RNG.normal(size=(TIMES, 2, contacts)), RNG.normal(size=(2, TIMES, contacts, 2))
    return Seen(RNG.normal(size=shape), RNG.normal(size=shape), bar, places[0], places[1], RNG.normal(size=(TIMES, WIDTH)))


U = RNG.choice([-1.5, 0.4, 2.5], (TIMES, WIDTH))


@pytest.mark.parametrize("modes", [{1: STICK, 3: STICK}, {4: 1, 1: STICK}, {3: -1, 2: 1}, {2: -1}, {0: STICK, 3: 1, 1: -1}, {}])
def test_laws_of_contacts(monkeypatch: pytest.MonkeyPatch, modes: dict[int, int]) -> None:
    """Closed contacts do not accelerate apart nor sticking ones along, and sliding ones rub against the way they slide."""
    ids = sorted(modes)
    seen = directions(len(ids))
    monkeypatch.setattr("watchsim.analysis.balanced_forces.SLACK", 1e9)  # cones are another question
    made = mechanism(monkeypatch, seen)
    found = made.balanced(np.zeros(TIMES), np.zeros((TIMES, WIDTH)), U, modes)
    assert found.ids.tolist() == ids and found.force.shape == (TIMES, len(ids), 2)
    assert found.normal is seen.normal and found.point is seen.point
    for row in range(TIMES):
        force, a = found.force[row], found.acceleration[row]
        load = sum((force[k, 0] * seen.w_N[row, k] + force[k, 1] * seen.w_T[row, k] for k in range(len(ids))), np.zeros(WIDTH))
        assert found.load[row] == pytest.approx(load, rel=1e-9, abs=1e-12)
        assert a == pytest.approx(made.mobility * (seen.h[row] + load), rel=1e-9, abs=1e-12)
        for k, number in enumerate(ids):
            assert seen.w_N[row, k] @ a + seen.bar[row, 0, k] == pytest.approx(0.0, abs=1e-9)
            if modes[number] == STICK:
                assert seen.w_T[row, k] @ a + seen.bar[row, 1, k] == pytest.approx(0.0, abs=1e-9)
            else:
                assert force[k, 1] == pytest.approx(-FRICTION[number] * modes[number] * force[k, 0], rel=1e-9)


def test_bearings_with_dry_friction_and_driven_bodies(monkeypatch: pytest.MonkeyPatch) -> None:
    """One that stands does not move; one that turns is braked; one that is driven does what h says, whatever touches it."""
    seen = directions(2)
    dry = np.array([0.5, 5e-4, 0.0, 0.7, 0.3, 0.0, 0.2])
    prescribed = np.array([False, False, False, False, True, True, False])
    u = np.array([0.0, 0.0, 0.0, -1e-4, 3.0, 2.0, 2.5]) * np.ones((TIMES, 1))
    made = mechanism(monkeypatch, seen, dry=dry, prescribed=prescribed)
    monkeypatch.setattr("watchsim.analysis.balanced_forces.SLACK", 1e9)
    found = made.balanced(np.zeros(TIMES), u, u, {1: STICK, 4: 1})
    h, load, a = seen.h, found.load, found.acceleration
    assert (a[:, :2] == 0.0).all()
    assert a[:, 2] == pytest.approx(made.mobility[2] * (h[:, 2] + load[:, 2]), rel=1e-9)
    assert a[:, 3] == pytest.approx(made.mobility[3] * (h[:, 3] + 0.7 + load[:, 3]), rel=1e-9)
    assert a[:, 4] == pytest.approx(h[:, 4] - 0.3, rel=1e-9) and a[:, 5] == pytest.approx(h[:, 5], rel=1e-9)
    assert a[:, 6] == pytest.approx(made.mobility[6] * (h[:, 6] - 0.2 + load[:, 6]), rel=1e-9)
    for row in range(TIMES):
        for k in range(2):
            assert seen.w_N[row, k] @ a[row] + seen.bar[row, 0, k] == pytest.approx(0.0, abs=1e-9)
        assert seen.w_T[row, 0] @ a[row] + seen.bar[row, 1, 0] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    ("share", "beyond"), [(0.3 * (1.0 + 3e-9), False), (0.3 * (1.0 + 4e-9), True), (-0.31, True), (-0.29, False)]
)
def test_what_lies_beyond_a_cone_is_shared_anew(monkeypatch: pytest.MonkeyPatch, share: float, beyond: bool) -> None:
    """Contact 1 sticks with µ = 0.3. Only at the instants at which a force is beyond its cone, together."""
    w_n, w_t = np.zeros((2, TIMES, 1, WIDTH))
    w_n[:, 0, 0] = w_t[:, 0, 1] = 1.0
    w_n[:, 0, 2], w_t[:, 0, 2] = (1.0, 2.0, 3.0), (4.0, 5.0, 6.0)  # of a coordinate that nothing moves
    bar = np.array([[[-2.0], [-2.0 * share]], [[-2.0], [0.0]], [[-3.0], [-3.0 * share]]])
    places = np.zeros((TIMES, 1, 2))
    seen = Seen(w_n, w_t, bar, places, places, np.zeros((TIMES, WIDTH)))
    made = mechanism(monkeypatch, seen, mobility=np.where(np.arange(WIDTH) == 2, 0.0, 1.0))
    asked: list[Any] = []

    def shared(system: Any, right: Any, ways: Any, laws: Any) -> Any:
        asked.append(right.tolist())
        sticks, slide, friction = laws
        assert sticks.tolist() == [0] and slide.tolist() == [0.0] and friction.tolist() == [0.3]
        assert system.shape == (2, 2, WIDTH) and [way[:, 0, 2].tolist() for way in ways] == [[1.0, 3.0], [4.0, 6.0]]
        return np.array([[[7.0, 8.0]], [[5.0, 6.0]]])

    monkeypatch.setattr("watchsim.analysis.balanced_forces._within_cones", shared)
    found = made.balanced(np.zeros(TIMES), np.zeros((TIMES, WIDTH)), np.ones((TIMES, WIDTH)), {1: STICK})
    kept = np.array([[[2.0, 2.0 * share]], [[2.0, 0.0]], [[3.0, 3.0 * share]]])
    if beyond:
        kept[0], kept[2] = (7.0, 8.0), (5.0, 6.0)
        assert asked == [[[2.0, 2.0 * share], [3.0, 3.0 * share]]]
    assert found.force == pytest.approx(kept, rel=1e-12) and bool(asked) is beyond
