"""Which contacts can be given without any geometry? Directions, masses and laws alone.

`impact`, `decide_modes` and `solve_mode` read nothing else, so that random problems and models with their own coordinates
can be put to them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.index_sets import OPEN
from watchsim.contact.kinematics import Closed, closed_contacts
from watchsim.dynamics.delassus import ContactWork, contact_work
from watchsim.dynamics.impact import energy_change
from watchsim.jit import callable_kernel
from watchsim.model.records import (
    BODY,
    BODY_PAIR,
    CONTACT,
    COORDINATE,
    JOINT,
    LAW,
    LINE_SPRING,
    PRIMITIVE,
    TABLE,
    TANGENTIAL_CODE,
    Model,
    frozen,
    records,
)
from watchsim.verification.contact_problems import decide_modes, impact, solve_mode

Array = NDArray[np.float64]


_energy_change = callable_kernel(energy_change)


class BareContacts:
    """m contacts on n coordinates: masses (n,), W (2m, n) with rows N, T, N, T, ..., friction and restitution (m,)."""

    def __init__(self, mass: Array, W: Array, friction: Array, restitution: Array, law: str = "coulomb", **more: Any) -> None:
        """`law` with `tangential` (restitution, by contact) and `nu` as in the scene file."""
        self.law, self.tangential, self.nu = (
            law,
            np.broadcast_to(more.get("tangential", 0.0), len(friction)),
            more.get("nu", 0.0),
        )
        self.mass, self.W, self.friction, self.restitution = mass, W, friction, restitution
        self.m, self.n = len(friction), len(mass)
        self.G = W / mass @ W.T
        self.model = self._model()
        self.closed: Closed = closed_contacts(self.m)
        self.work: ContactWork = contact_work(self.m, self.n)
        self.take(list(range(self.m)))

    def _model(self) -> Model:
        coordinates, laws, contacts = records(COORDINATE, self.n), records(LAW, self.m), records(CONTACT, self.m)
        coordinates.mass, laws.friction, contacts.group = self.mass, self.friction, np.arange(self.m)
        laws.kind, laws.tangential, laws.nu = TANGENTIAL_CODE[self.law], self.tangential, self.nu
        none = {
            "bodies": BODY,
            "joints": JOINT,
            "lines": LINE_SPRING,
            "tables": TABLE,
            "primitives": PRIMITIVE,
            "pairs": BODY_PAIR,
        }
        parts = {name: records(dtype, 0) for name, dtype in none.items()}
        parts |= {"coordinates": coordinates, "contacts": contacts, "laws": laws}
        parts |= {"knots": np.zeros((0, 2)), "near": np.zeros(0, np.int64)}
        return Model(**{name: frozen(part) for name, part in parts.items()})

    def take(self, contacts: list[int]) -> None:
        """Let only these contacts take part, in this order."""
        self.taken = contacts
        for row, i in enumerate(contacts):
            self.closed.ids[row], self.closed.slots[row] = i, self.n
            self.closed.coord[row, : self.n] = np.arange(self.n)
            self.closed.w_N[row, : self.n], self.closed.w_T[row, : self.n] = self.W[2 * i], self.W[2 * i + 1]

    def impact(self, u: Array, restitution: Array | None = None) -> tuple[bool, Array, Array]:
        """Solved?, velocities after, impulses N, T, N, T, ... of the contacts that take part."""
        after, m = u.copy(), len(self.taken)
        shares = (self.restitution if restitution is None else restitution)[self.taken]
        solved = impact(self.model, self.closed, m, shares, 0.0, self.work, after)
        return bool(solved), after, self.work.force[: 2 * m].copy()

    def energy_change(self) -> float:
        """Of the impact just solved, as the kernel says, J."""
        return float(_energy_change(len(self.taken), self.work)[0])

    def kinetic(self, u: Array) -> float:
        """J."""
        return 0.5 * float(u @ (self.mass * u))

    def modes(self, u: Array, h: Array, speed_zero: float) -> tuple[bool, NDArray[np.int8]]:
        """Solved?, and mode by contact, of the contacts that take part under the forces h; constant directions."""
        mode, grip = np.full(self.m, OPEN, np.int8), np.zeros(self.n, np.int8)
        for row, i in enumerate(self.taken):
            self.closed.kin[row].gN_dot, self.closed.kin[row].gT_dot = self.W[2 * i : 2 * i + 2] @ u
        self.work.h[:] = h
        solved = decide_modes(self.model, self.closed, len(self.taken), 0, speed_zero, self.work, grip, mode)
        return bool(solved), mode

    def forces(self, h: Array, mode: NDArray[np.int8]) -> Array:
        """Forces N, T, N, T, ... of the contacts that take part in their modes under the forces h."""
        self.work.inverse[:], self.work.h[:] = 1.0 / self.mass, h
        solve_mode(self.model, self.closed, len(self.taken), np.asarray(mode, np.int8), 1.0, self.work)
        return self.work.force[: 2 * len(self.taken)].copy()
