"""What wears: how far does each place of an outline slide, under which load, and how much work does friction do there?

table = wear(run)
print(table)

Archard's law says that a place loses the volume V = k N s / H: the wear coefficient k of the two materials, the hardness H of
the one that wears, and the load times the way that it slides, N s, which a run knows. Only that index is worked out, without
lubrication, running-in or any change of the outlines by wear (J. F. Archard, Journal of Applied Physics 24, 1953, 981).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from watchsim.analysis.balanced_forces import Mechanism, modes_in_force
from watchsim.analysis.flows import LOSSES, NODES, WEIGHTS, slips
from watchsim.analysis.forces import absolute, forces
from watchsim.analysis.timeline import pallet_side
from watchsim.mechanism.compile import Compiled, compile_scene
from watchsim.model import CORNER, FULL, LINE
from watchsim.scene.roles import pallet_name, pitch, touching, with_anchor
from watchsim.simulation.trajectory import NO_ROW, Array, Trajectory, frames

YEAR = 365.25 * 86400.0  # s
CELLS = 48  # of an edge
TOOTH = "tooth "
AT_ONCE = 1000  # steps whose forces are worked out together
LOCKS = np.sin(np.radians(30.0))  # a pallet's face whose normal passes nearer by the pivot, as a share of the way to it, locks


@dataclass(frozen=True, slots=True)
class WornPlace:
    """What one place of a body went through: a tooth, a face of a stone, otherwise all that touches of a layer.

    distance  that it slid, or was slid over, m; percussions take no time and have none
    friction  work of friction while it slid, J; `percussions`: that of friction within impacts, J
    index     load times sliding distance, N·m, percussions included: of these the normal impulse times the mean of the speeds
              of slip before and after
    """

    body: str
    name: str
    distance: float
    friction: float
    percussions: float
    index: float

    def volume(self, coefficient: float, hardness: float) -> float:
        """Archard's k N s / H, m³, from the wear coefficient and the hardness (Pa) of what wears here."""
        return coefficient * self.index / hardness


@dataclass(frozen=True)
class Wear:
    """What wore in `seconds` of a run; each contact counts with the places on both of its sides.

    friction     work of friction of all contacts while they slid, J; `percussions`: within impacts
    places       sorted by body and name
    along        primitive of the model -> index of each of CELLS equal parts of it, N·m
    where        the same -> its body, and what the place is called
    """

    seconds: float
    friction: float
    percussions: float
    places: tuple[WornPlace, ...]
    along: dict[int, Array] = field(repr=False)
    where: dict[int, tuple[str, str]] = field(repr=False)

    @property
    def typical(self) -> tuple[WornPlace, ...]:
        """The places, with the mean of all teeth in place of each."""
        own = [one for one in self.places if one.name.startswith(TOOTH)]
        rest = tuple(one for one in self.places if not one.name.startswith(TOOTH))
        if not own:
            return rest
        mean = np.mean([(one.distance, one.friction, one.percussions, one.index) for one in own], axis=0)
        return (WornPlace(own[0].body, f"{TOOTH}mean of {len(own)}", *mean.tolist()), *rest)

    def in_a_year(self, value: float) -> float:
        """What `value`, a sum over the run, comes to if the watch goes on like that for a year."""
        return value * YEAR / self.seconds

    def __str__(self) -> str:
        """A table for people."""
        head = f"{'place':40} {'slides (m/year)':>16} {'friction (J/year)':>18} {'N·s (N·m/year)':>16}"
        rows = (
            (f"{one.body} {one.name}", *map(self.in_a_year, (one.distance, one.friction + one.percussions, one.index)))
            for one in self.places
        )
        return "\n".join((head, *(f"{name:40} {way:16.4g} {work:18.4g} {index:16.4g}" for name, way, work, index in rows)))


@dataclass(frozen=True)
class _Rubbed:
    """Of one contact at n instants: where (n, 2), m, and distance, work, work within percussions and N s there, (n, 4)."""

    contact: int
    t: Array
    point: Array
    amounts: Array
    slid: bool  # steps, NODES of each, and not percussions


def wear(run: Trajectory, window: Sequence[float] | None = None) -> Wear:
    """What wore in the steps within a window (s), by default in all that was recorded.

    ValueError for a run by fixed steps, where events were not kept, and where no step lies within.
    """
    if len(run.t) == 0:
        raise ValueError(NO_ROW)
    start, end = window or (-np.inf, np.inf)
    rows = np.unique(run.t[(run.t >= start) & (run.t <= end)])
    spans = run.spans or ((float(run.t[0]), float(run.t[-1])),)
    steps = [np.column_stack((own[:-1], own[1:])) for a, b in spans if len(own := rows[(rows >= a) & (rows <= b)]) > 1]
    if not steps:
        raise ValueError("no step of the run was recorded there, so nothing is known of what wears")
    whole = np.concatenate(steps)
    compiled = compile_scene(run.scene)
    found = [*_sliding(run, whole), *_percussions(run, compiled, whole)]
    along: dict[int, Array] = {}
    where: dict[int, tuple[str, str]] = {}
    sums: dict[tuple[str, str], Array] = {}
    named = _Names(run, compiled)
    for one in found:
        contact = compiled.model.contacts[one.contact]
        for side, other in ((int(contact.a), int(contact.b)), (int(contact.b), int(contact.a))):
            local = _local(run, compiled, side, one)
            key = compiled.owners[side], named.of(side, other, float(one.t[0]), local[0])
            where.setdefault(side, key)
            sums[key] = sums.get(key, 0.0) + one.amounts.sum(axis=0)
            ends = np.sort(_stretches(_share(compiled, side, local), one.slid), axis=1)
            along[side] = along.get(side, np.zeros(CELLS)) + _spread(ends, one.amounts[:, 3])
    total = sum((one.amounts.sum(axis=0) for one in found), np.zeros(4))
    order = {body.name: k for k, body in enumerate(run.scene.bodies)}
    keys = sorted(sums, key=lambda key: (order[key[0]], len(key[1]), key[1]))
    places = tuple(WornPlace(*key, *sums[key].tolist()) for key in keys if sums[key].any())
    return Wear(
        float(np.ptp(whole, axis=1).sum()),
        float(total[1]),
        float(total[2]),
        places,
        {k: v for k, v in along.items() if v.any()},
        {k: where[k] for k, v in along.items() if v.any()},
    )


def _sliding(run: Trajectory, steps: Array) -> Iterator[_Rubbed]:
    """By Gauss's rule over the steps in which a contact is in force."""
    middles = steps.mean(axis=1)
    closed = sorted(row for contacts, own in modes_in_force(run, middles).items() if contacts for row in own)
    for k in range(0, len(closed), AT_ONCE):
        start, h = steps[closed[k : k + AT_ONCE], 0], np.diff(steps[closed[k : k + AT_ONCE]], axis=1)
        times, weights = (start[:, None] + h * NODES).ravel(), (h * WEIGHTS).ravel()
        found = forces(run, times)
        slip = slips(run, found)
        for j, contact in enumerate(found.pairs.tolist()):
            own = np.isfinite(found.point[:, j, 0])
            way, ones = weights[own] * np.abs(slip[own, j]), weights[own] * slip[own, j]
            amounts = (way, -found.tangential[own, j] * ones, np.zeros(len(way)), found.normal[own, j] * way)
            yield _Rubbed(contact, times[own], found.point[own, j], np.column_stack(amounts), True)


def _percussions(run: Trajectory, compiled: Compiled, steps: Array) -> Iterator[_Rubbed]:
    """An impulse works on the mean of the velocities before and after it; both are rows of its instant."""
    mechanism = Mechanism(compiled)
    struck = run.events[np.isin(run.events["kind"], LOSSES)]
    struck = struck[(struck["t"] >= steps[0, 0]) & (struck["t"] <= steps[-1, 1]) & np.isin(struck["t"], run.t)]
    for contact in np.unique(struck["contact"]).tolist():
        own = struck[struck["contact"] == contact]
        t = np.ascontiguousarray(own["t"])
        before, after = np.searchsorted(run.t, t), np.searchsorted(run.t, t, side="right") - 1
        q, rates = absolute(compiled, run.q[after], False), [absolute(compiled, run.u[k], True) for k in (before, after)]
        seen = mechanism.seen(t, q, rates[1], np.array([contact]))
        slip = np.stack([np.einsum("nc,nc->n", seen.w_T[:, 0], u) for u in rates])
        work = -own["impulse_tangential"] * slip.mean(axis=0)
        nothing = np.zeros(len(t))
        amounts = (nothing, nothing, work, own["impulse_normal"] * np.abs(slip).mean(axis=0))
        yield _Rubbed(contact, t, seen.point[:, 0].copy(), np.column_stack(amounts), False)


def _local(run: Trajectory, compiled: Compiled, side: int, one: _Rubbed) -> Array:
    """The points in the frame of the primitive's body, m (n, 2)."""
    number = int(compiled.model.primitives.body[side])
    if number >= len(run.scene.bodies):  # the rack of a gear, which is nowhere
        return np.zeros_like(one.point)
    frame = frames(run.scene, run.slices, run.sample(one.t)[0])[run.scene.bodies[number].name]
    c, s = np.cos(frame[:, 2]), np.sin(frame[:, 2])
    x, y = (one.point - frame[:, :2]).T
    return np.column_stack((c * x + s * y, c * y - s * x))


def _share(compiled: Compiled, side: int, local: Array) -> Array:
    """How far along a primitive these points lie, 0 to 1, (n,)."""
    p = compiled.model.primitives[side]
    x, y = (local - (p.x, p.y)).T
    if p.kind == CORNER:
        return np.zeros(len(local))
    if p.kind == LINE:
        return np.asarray((x * p.tx + y * p.ty) / p.length)
    turn = np.arctan2(y, x) - np.arctan2(p.py - p.y, p.px - p.x)
    return np.asarray(0.5 + 0.5 * ((turn + np.pi) % (2.0 * np.pi) - np.pi) / _half(p))


# The points at the nodes of Gauss's rule stand for the stretches between the times at which their weights meet, where the
# polynomial through them says.
_MEET = np.concatenate(([0.0], np.cumsum(WEIGHTS)))
_THROUGH = np.linalg.solve(np.vander(NODES).T, np.vander(_MEET, len(NODES)).T)


def _stretches(share: Array, slid: bool) -> Array:
    """From where to where along a primitive each instant counts, (n, 2); a percussion has no length."""
    if not slid:
        return np.column_stack((share, share))
    edges = share.reshape(-1, len(NODES)) @ _THROUGH
    edges[np.ptp(edges, axis=1) > 0.5] = np.nan  # round a full circle from its end to its start
    ends = np.column_stack((edges[:, :-1].ravel(), edges[:, 1:].ravel()))
    return np.where(np.isnan(ends), share[:, None], ends)


def _spread(ends: Array, amounts: Array) -> Array:
    """The amounts, each evenly over its stretch (n, 2), by cell."""
    limits = np.linspace(0.0, 1.0, CELLS + 1)
    limits[[0, -1]] = -np.inf, np.inf
    low, width = ends[:, :1], np.maximum(ends[:, 1:] - ends[:, :1], np.finfo(float).eps)
    return np.asarray(amounts @ np.diff(np.clip((limits - low) / width, 0.0, 1.0), axis=1))


def _half(arc: np.record) -> float:
    return np.pi if arc.extent == FULL else float(np.arctan2(arc.half_sin, arc.half_cos))


def cell_ends(compiled: Compiled, side: int) -> Array:
    """Of the CELLS parts of a primitive: their ends in its body's frame, m (CELLS + 1, 2); one point for a corner."""
    p, share = compiled.model.primitives[side], np.linspace(0.0, 1.0, CELLS + 1)
    if p.kind == CORNER:
        return np.array([[p.x, p.y]])
    if p.kind == LINE:
        return np.column_stack((p.x + share * p.length * p.tx, p.y + share * p.length * p.ty))
    turn = np.arctan2(p.py - p.y, p.px - p.x) + (2.0 * share - 1.0) * _half(p)
    return np.column_stack((p.x + p.radius * np.cos(turn), p.y + p.radius * np.sin(turn)))


class _Names:
    """What places are called: teeth by number, pallets by what they do, all else by layer."""

    def __init__(self, run: Trajectory, compiled: Compiled) -> None:
        self._run, self._compiled, self._parts = run, compiled, with_anchor(run.scene)
        self._teeth = teeth(run, compiled)
        self._roles = {(body, layer): text for body, layer, text in touching(run.scene, self._parts)}
        self._known: dict[tuple[int, int], str] = {}

    def of(self, side: int, other: int, time: float, local: Array) -> str:
        """The place of a primitive that touches another one at that time (s), there in its body's frame (m)."""
        if (side, other) not in self._known:
            self._known[side, other] = self._name(side, other, time, local)
        return self._known[side, other]

    def _name(self, side: int, other: int, time: float, local: Array) -> str:
        if side in self._teeth:
            return f"{TOOTH}{self._teeth[side]}"
        owners, parts = self._compiled.owners, self._parts
        role = self._roles.get((owners[side], self._compiled.layers[side]))
        if parts.lever == owners[side] and parts.wheel == owners[other] and role is None:
            where = pallet_side(self._run, self._compiled, parts, side, time)
            return f"{pallet_name(self._run.scene, where)} {self._face(side, local)}"
        return role or self._compiled.layers[side]

    def _face(self, side: int, local: Array) -> str:
        p = self._compiled.model.primitives[side]
        if p.kind == CORNER:
            return "corner"
        nx, ny = (p.nx, p.ny) if p.kind == LINE else (local - (p.x, p.y)) / p.radius
        return "locking face" if abs(local[0] * ny - local[1] * nx) < LOCKS * np.hypot(*local) else "impulse face"


def teeth(run: Trajectory, compiled: Compiled) -> dict[int, int]:
    """Primitive of the escape wheel -> number of its tooth, from 1, counter-clockwise; empty where teeth are not equal."""
    wheel = with_anchor(run.scene).wheel
    step = pitch(run.scene, wheel) if wheel else None
    if step is None:
        return {}
    own = np.array([k for k, owner in enumerate(compiled.owners) if owner == wheel], np.int64)
    p = compiled.model.primitives[own]
    polar, reach = np.arctan2(p.py, p.px), np.hypot(p.px, p.py)
    gap = polar[np.argmin(reach)]  # teeth are parted where the outline is nearest to the pivot
    number: NDArray[np.int64] = np.floor((polar - gap) / step + 1e-9).astype(np.int64) % round(2.0 * np.pi / step)
    return dict(zip(own.tolist(), (number + 1).tolist(), strict=True))
