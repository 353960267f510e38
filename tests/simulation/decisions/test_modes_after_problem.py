"""What does a contact do next, from the acceleration of its slip and the end of the cone at which its friction is?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.contact.index_sets import BACKWARD, FORWARD, STICK
from watchsim.dynamics.acceleration import _mode_of

CONTACTS, ELEMENTS = 3, 2  # two of the contacts have friction that is sought


@pytest.mark.parametrize("slip", [-1.0, 0.0, 1.0])
@pytest.mark.parametrize("at", ["forward end", "backward end", "between"])
@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize(("contact", "element"), [(0, 0), (2, 1)])
def test_it_slides_only_the_way_that_friction_lets_it(slip: float, at: str, mirrored: bool, contact: int, element: int) -> None:
    """Friction at one end of the cone holds against sliding one way: with the other end, or between, the contact sticks."""
    x = np.ones(CONTACTS + 2 * ELEMENTS)  # forces, then what is left to each end of the cones
    x[CONTACTS + element] = 0.0 if at == "forward end" else 0.5
    x[CONTACTS + ELEMENTS + element] = 0.5 if at == "backward end" else 0.0
    hand = np.ones(2 * CONTACTS)
    hand[2 * contact + 1] = -1.0 if mirrored else 1.0
    tangent = np.full(CONTACTS, -1)
    tangent[contact] = element
    rows = 2 * CONTACTS
    work = SimpleNamespace(
        x=x, hand=hand, tangent=tangent, force=np.zeros(rows), drag=np.zeros(CONTACTS), G=np.zeros((rows, rows))
    )
    asked = []

    def acceleration(_: object, __: int, row: int) -> float:
        asked.append(row)
        return slip

    mode = in_python(_mode_of, _row_acceleration=acceleration, row_terms=lambda *_: 1.0)(
        SimpleNamespace(), contact, CONTACTS, ELEMENTS, 0, work
    )
    ways = (BACKWARD, FORWARD) if not mirrored else (FORWARD, BACKWARD)
    slides = (slip > 0.0 and at == "forward end") or (slip < 0.0 and at == "backward end")
    assert asked == [2 * contact + 1]
    assert mode == ((ways[1] if slip > 0.0 else ways[0]) if slides else STICK)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("share", [0.9, 1.1])
@pytest.mark.parametrize(("contact", "element"), [(0, 0), (2, 1)])
def test_a_slip_is_none_within_rounding_of_its_terms_and_of_the_cone(
    sign: float, share: float, contact: int, element: int
) -> None:
    """A hundred billionth of the row's terms and of what friction and its bound do to it."""
    rows, T = 2 * CONTACTS, 2 * contact + 1
    x = np.ones(CONTACTS + 2 * ELEMENTS)
    x[CONTACTS + element] = 0.0 if sign > 0.0 else 0.5
    force, drag, G = np.full(rows, 99.0), np.full(CONTACTS, 99.0), np.full((rows, rows), 99.0)
    force[T - 1], force[T], drag[contact], G[T, T] = 5.0, -2.0, 0.4, 3.0
    tangent = np.full(CONTACTS, -1)
    tangent[contact] = element
    work = SimpleNamespace(x=x, hand=np.ones(rows), tangent=tangent, force=force, drag=drag, G=G)
    slip = sign * share * 1e-11 * (7.0 + 3.0 * (2.0 + 0.4 * 5.0))
    instead = {"_row_acceleration": lambda *_: slip, "row_terms": lambda work, m, rows, row: 7.0 if row == T else 99.0}
    mode = in_python(_mode_of, **instead)(SimpleNamespace(), contact, CONTACTS, ELEMENTS, 0, work)
    assert mode == (STICK if share < 1.0 else FORWARD if sign > 0.0 else BACKWARD)
