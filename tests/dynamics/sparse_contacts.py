"""Which contacts act on a few of all coordinates, in any order, as those of bodies do?"""

from types import SimpleNamespace

import numpy as np

from watchsim.contact.gaps import Closed, closed_contacts
from watchsim.model import CONTACT, COORDINATE, LAW, Records, records
from watchsim.simulation.scratch import ContactWork, contact_work

SPARE = 2  # rows of contacts that nobody may read


class Sparse:
    """m contacts on n coordinates and what kernels read of them; `W` (2m, n) is the same as one matrix, rows N, T, N, T, ...

    A contact moves two to four coordinates, or as many as `slots` says. Its number is not its row, nor is its law's. What
    nobody may read is not a number.
    """

    def __init__(
        self, rng: np.random.Generator, m: int, n: int, friction: float = 0.3, slots: tuple[int, int] = (2, 4)
    ) -> None:
        self.m, self.n = m, n
        self.closed: Closed = closed_contacts(m + SPARE)
        self.work: ContactWork = contact_work(m + SPARE, n)
        parts = [array for part in self.work for array in part]
        for values in (self.closed.w_N, self.closed.w_T, self.closed.kin.bar_N, self.closed.kin.bar_T, *parts):
            if isinstance(values, np.ndarray) and values.dtype == float:
                values[:] = np.nan
        self.closed.slots[m:] = 1
        self.W = np.zeros((2 * m, n))
        numbers = rng.permutation(2 * m)[:m]
        for i in range(m):
            self.closed.ids[i] = numbers[i]
            self.moves(i, rng.permutation(n)[: int(rng.integers(slots[0], slots[1] + 1))], rng)
            self.closed.kin.bar_N[i], self.closed.kin.bar_T[i] = rng.normal(size=2)
            self.closed.kin.bar_size[i] = rng.uniform(2.0, 4.0)
        coordinates, contacts, laws = records(COORDINATE, n), records(CONTACT, 2 * m), records(LAW, 2 * m)
        coordinates.mass, coordinates.load = rng.uniform(0.4, 3.0, n), rng.uniform(0.1, 2.0, n)
        contacts.group = rng.permutation(2 * m)
        laws.friction = friction * rng.uniform(0.5, 1.0, 2 * m)
        self.model = SimpleNamespace(coordinates=coordinates, contacts=contacts, laws=laws, bearings=[])
        self.friction = np.array([laws[contacts[k].group].friction for k in numbers])
        self.bars = np.ravel([self.closed.kin.bar_N[:m], self.closed.kin.bar_T[:m]], order="F")
        self.work.system.inverse[:] = 1.0 / coordinates.mass
        self.work.system.h[:] = rng.normal(size=n)

    def moves(self, i: int, coords: np.ndarray, rng: np.random.Generator) -> None:
        """Contact i acts on these coordinates, in this order."""
        count = len(coords)
        self.closed.slots[i], self.closed.coord[i, :count] = count, coords
        self.closed.w_N[i, :count], self.closed.w_T[i, :count] = rng.normal(size=(2, count))
        self.W[2 * i : 2 * i + 2] = 0.0
        self.W[2 * i, coords], self.W[2 * i + 1, coords] = self.closed.w_N[i, :count], self.closed.w_T[i, :count]

    @property
    def laws(self) -> Records:
        """The law of each contact."""
        return self.model.laws[self.model.contacts[self.closed.ids[: self.m]].group]

    @property
    def G(self) -> np.ndarray:
        """The rates that impulses make."""
        return self.W * self.work.system.inverse @ self.W.T
