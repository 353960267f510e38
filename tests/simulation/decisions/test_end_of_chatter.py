"""How much energy may the end of a row of rebounds give back?"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from plain_kernels import in_python

from watchsim.contact.index_sets import BACKWARD, FORWARD, STICK
from watchsim.simulation.events import chatter

KINETIC = 3.0  # J


def end(taken: float, gain: float, tangential: float = 0.1, slip: float = 1.0) -> tuple[bool, int, int]:
    """What `end_chatter` answers for one contact with N = 2, μ = 0.5, and the mode it gives that."""

    def plastic(model, closed, m, time, u, work):
        work.force[:] = 2.0, tangential
        return True

    kernel = in_python(
        chatter.end_chatter,
        plastic_impact=plastic,
        contact_kinematics=lambda *_: None,
        solve_mode=lambda *_: True,
        kinetic_energy=lambda *_: KINETIC,
        _gain=lambda *_: gain,
        apply=lambda *_: None,
    )
    model = SimpleNamespace(contacts=[SimpleNamespace(group=0)], laws=[SimpleNamespace(friction=0.5)])
    closed = SimpleNamespace(ids=[0], kin=[SimpleNamespace(gT_dot=slip)])
    room = SimpleNamespace(ending=np.zeros(2), mode=np.zeros(1, int))
    work = SimpleNamespace(force=np.zeros(2), inverse=None)
    state = SimpleNamespace(u=None, now=SimpleNamespace(lenience=1.0))
    found, count = kernel(model, state, 1, (0.0, taken), work, SimpleNamespace(closed=closed, rest=None, pose=None), room)
    return found, count, int(room.mode[0])


@pytest.mark.parametrize(("taken", "most"), [(0.0, 3e-8), (1e-8, 3e-8), (1e-6, 1e-6), (2.9e-6, 2.9e-6), (1.0, 3e-6)])
def test_no_more_than_was_taken_and_a_millionth_of_the_whole_or_a_hundred_millionth(taken: float, most: float) -> None:
    assert end(taken, 0.999 * most)[:2] == (True, 1)
    assert end(taken, 1.001 * most)[:2] == (False, 0)


@pytest.mark.parametrize(
    ("tangential", "slip", "mode"),
    [(0.999, 1.0, STICK), (-0.999, 1.0, STICK), (1.0, -1.0, BACKWARD), (-1.0, 1.0, FORWARD)],
)
def test_what_slips_slips_against_its_friction(tangential: float, slip: float, mode: int) -> None:
    assert end(0.0, 0.0, tangential, slip)[2] == mode


def test_the_gain_of_an_impulse_is_the_difference_of_energies() -> None:
    """Against kinetic energies of masses before and after."""
    rng = np.random.default_rng(5)
    mass, W, u, impulse = rng.uniform(0.5, 2.0, 3), rng.normal(size=(3, 4)), rng.normal(size=3), rng.normal(size=4)
    after = u + (W @ impulse) / mass

    def rates(closed, r, u, out):
        out[:] = W.T @ u

    work = SimpleNamespace(b=np.zeros(4), G=W.T @ (W / mass[:, None]))
    gain = in_python(chatter._gain, contact_velocities=rates)(None, 2, u, impulse, work)
    assert gain == pytest.approx(0.5 * float(mass @ (after**2 - u**2)), rel=1e-12)
