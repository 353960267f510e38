"""Which contacts can be made up at random, without any geometry? Directions and masses alone.

`impact` and `decide_modes` read nothing else: the rows w_N, w_T, the masses, and the friction of each contact's law.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from watchsim.contact.kinematics import Closed, closed_contacts
from watchsim.dynamics.delassus import ContactWork, contact_work
from watchsim.dynamics.impact import energy_change, impact
from watchsim.jit import callable_kernel
from watchsim.mechanism.model import (
    BODY,
    BODY_PAIR,
    CONTACT,
    COORDINATE,
    LAW,
    PRIMITIVE,
    TABLE,
    TANGENTIAL_CODE,
    Model,
    frozen,
    records,
)

_impact, _energy_change = callable_kernel(impact), callable_kernel(energy_change)


class Case:
    """m contacts on n coordinates: masses, W (2m, n) in the order N, T, N, T, ..., friction and restitution by contact."""

    def __init__(
        self, mass: np.ndarray, W: np.ndarray, mu: np.ndarray, eps: np.ndarray, law: str = "coulomb", **more: Any
    ) -> None:
        """`law` with `tangential` (restitution, by contact) and `nu` as in the scene file."""
        self.law, self.tangential, self.nu = law, np.broadcast_to(more.get("tangential", 0.0), len(mu)), more.get("nu", 0.0)
        self.mass, self.W, self.mu, self.eps = mass, W, mu, eps
        self.m, self.n = len(mu), len(mass)
        self.G = W / mass @ W.T
        self.model, self.closed = self._model(), self._closed()
        self.work: ContactWork = contact_work(self.m, self.n)

    def _model(self) -> Model:
        coordinates, laws, contacts = records(COORDINATE, self.n), records(LAW, self.m), records(CONTACT, self.m)
        coordinates.mass, laws.friction, contacts.group = self.mass, self.mu, np.arange(self.m)
        laws.kind, laws.tangential, laws.nu = TANGENTIAL_CODE[self.law], self.tangential, self.nu
        empty = [records(dtype, 0) for dtype in (BODY, TABLE, PRIMITIVE, BODY_PAIR)]
        parts = (empty[0], coordinates, empty[1], np.zeros((0, 2)), empty[2], contacts, laws, empty[3], np.zeros(0, np.int64))
        return Model(*(frozen(part) for part in parts))

    def _closed(self) -> Closed:
        closed = closed_contacts(self.m)
        for i in range(self.m):
            closed.ids[i], closed.slots[i] = i, self.n
            closed.coord[i, : self.n] = np.arange(self.n)
            closed.w_N[i, : self.n], closed.w_T[i, : self.n] = self.W[2 * i], self.W[2 * i + 1]
        return closed

    def impact(self, u: np.ndarray, eps: np.ndarray | None = None) -> tuple[int, np.ndarray, np.ndarray]:
        """Status, velocities after, impulses (2m,) N, T, N, T, ..."""
        after = u.copy()
        status = _impact(self.model, self.closed, self.m, self.eps if eps is None else eps, 0.0, self.work, after)
        return int(status), after, self.work.force[: 2 * self.m].copy()

    def energy_change(self) -> float:
        """Of the impact just solved, as the kernel says."""
        return float(_energy_change(self.m, self.work)[0])

    def kinetic(self, u: np.ndarray) -> float:
        return 0.5 * float(u @ (self.mass * u))


def random_case(rng: np.random.Generator, m: int, n: int, **chosen: Any) -> Case:
    """Directions and velocities of order one; masses over two decades; friction up to 0.6."""
    mass = 10.0 ** rng.uniform(-1.0, 1.0, n)
    mu = chosen.get("mu", rng.uniform(0.0, 0.6, m))
    eps = chosen.get("eps", np.full(m, rng.uniform(0.0, 1.0)))
    mu, eps = np.broadcast_to(mu, m).astype(float), np.broadcast_to(eps, m).astype(float)
    more = {key: value for key, value in chosen.items() if key not in ("mu", "eps")}
    return Case(mass, rng.normal(size=(2 * m, n)), mu, eps, **more)
