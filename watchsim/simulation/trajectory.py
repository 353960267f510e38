"""How do two parts of one motion become one trajectory?"""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from watchsim.displays import notebook_html, player
from watchsim.mechanism.compile import Compiled
from watchsim.mechanism.play import loose
from watchsim.scene.roles import frequency
from watchsim.scene.scene import ALL, STATISTICS, Body, Scene, Window
from watchsim.scene.trains import carried_last
from watchsim.simulation.recording import Pair, columns_of, stretch_rows, tail_length, within
from watchsim.simulation.saved_state import SavedState
from watchsim.simulation.state import EventKind, Stop
from watchsim.storage.columns import blocks, is_mapped, let_go, one_behind_the_other
from watchsim.tolerances import ROW_NOISE

# How do rows and events read in the coordinates of the scene?
#
# The loop counts all angles in the movement; a scene gives those of carried bodies relative to their carriers.

Array = NDArray[np.float64]


def rows_of_scene(compiled: Compiled, rows: Array) -> tuple[Array, ...]:
    """t, q, u, a of rows of the loop."""
    t, q, u, a = columns_of(rows)
    relative = compiled.relative
    return t, relative(q), relative(u, rates=True), relative(a, rates=True)


def events_of_scene(compiled: Compiled, events: NDArray[Any]) -> NDArray[Any]:
    """The events, angles of turning points in the coordinates of the scene."""
    turned = [(compiled.model.coordinates[own].body, angle) for own, _, angle in compiled.against if angle != 0.0]
    events = events.copy() if turned else events
    for body, angle in turned:
        events["value"][(events["kind"] == EventKind.TURN) & (events["body"] == body)] -= angle
    return events


# Where in the movement are the frames of all bodies, from the coordinates of its scene?

NONE = slice(0, 0)


def frames(scene: Scene, slices: Mapping[str, slice], q: Array) -> dict[str, Array]:
    """For every body (rows, 3): x, y (m) and angle (rad) in the movement; q (rows, n) with the columns `slices` says."""
    found: dict[str, Array] = {}
    shafts = loose(scene)
    for body in carried_last(scene.bodies):
        columns = slices.get(body.name, NONE)
        own = _own(body, q[:, columns])
        if body.name in shafts:
            x, y, _ = _on(own, np.tile([*body.centre_of_mass, 0.0], (len(q), 1))).T
            own[:, :2] += q[:, columns.start - 2 : columns.start] - np.stack([x, y], axis=1)
        found[body.name] = own if body.on is None else _on(found[body.on], own)
    return found


def speeds(scene: Scene, slices: Mapping[str, slice], q: Array, u: Array) -> dict[str, Array]:
    """For every body (rows, 3): the velocity of its origin (m/s) and its turning rate (rad/s) in the movement."""
    places = frames(scene, slices, q)
    found: dict[str, Array] = {}
    shafts = loose(scene)
    for body in carried_last(scene.bodies):
        columns = slices.get(body.name, NONE)
        own = _own_speed(body, u[:, columns])
        if body.name in shafts:
            arm = _on(places[body.name], np.tile([*body.centre_of_mass, 0.0], (len(u), 1))) - places[body.name]
            drift = own[:, 2:] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
            own[:, :2] += u[:, columns.start - 2 : columns.start] - drift
        if body.on is not None:
            arm, carrier = places[body.name] - places[body.on], found[body.on]
            own = own + carrier + carrier[:, 2:] * np.stack([-arm[:, 1], arm[:, 0], np.zeros(len(arm))], axis=1)
        found[body.name] = own
    return found


def _own(body: Body, q: Array) -> Array:
    """The same in the frame of the carrier."""
    if body.motion == "free":
        return q
    found = np.tile([*body.position, body.angle], (len(q), 1))
    if body.motion == "pivot":
        found[:, 2] = q[:, 0]
    elif body.motion == "slide":
        found[:, :2] += q * np.array(body.axis)
    return found


def _own_speed(body: Body, u: Array) -> Array:
    """Only pivoted and fixed bodies are carried, whose origins rest in their carriers."""
    if body.motion == "free":
        return u
    found = np.zeros((len(u), 3))
    if body.motion == "pivot":
        found[:, 2] = u[:, 0]
    elif body.motion == "slide":
        found[:, :2] = u * np.array(body.axis)
    return found


def _on(carrier: Array, own: Array) -> Array:
    """Frames given in carriers' frames."""
    c, s = np.cos(carrier[:, 2]), np.sin(carrier[:, 2])
    x, y, angle = own.T
    return carrier + np.stack([c * x - s * y, s * x + c * y, angle], axis=1)


# What comes out of a simulation?
#
# A frozen value: rows of time, coordinates, velocities and accelerations, and a table of events. Everything after it (beats,
# plots, movies) is a function of it.

NO_ROW = "no row of this run was kept, so where its bodies were is not known"
AT_ONCE = 1000  # times that are looked up together where rows lie in a file: those of a stretch of it, in order


@dataclass(frozen=True)
class Trajectory:
    """The motion of a scene. Arrays have one row per accepted step (two rows with the same time at an impact).

    t                  times of the rows (rows,), s
    q, u, a            coordinates, velocities, accelerations (rows, n), SI and rad; of a carried body relative to its carrier
    slices             body -> its columns of q, u, a; fixed bodies have none
    events             one record each, as in EVENT_DTYPE: t (s), kind, contact, body, impulses (N·s), energy lost (J), value
    pairs              the contacts that `contact` of an event counts, with bodies, layers and primitives
    stop, stop_message  why the run ended
    simulated          the time reached, s; `end_q` and `end_u` (n,) belong to it
    wall, compile      what the run took, and what compiling or loading the solver took besides, s
    method, tolerance, step  of the run; `step` (s) only of a method with fixed steps
    worst_penetration  the deepest gap of a contact that counted, m
    worst_residual     the worst violation of a complementarity condition, as a share of the problem's largest term
    overlap            what looking at the outlines themselves has found, apart from all gap functions: worst_m, between,
                       t_s, x_mm, y_mm, looks, resolution_m, allowed_m (simulation/record/overlap_watch.py)
    energy             J: in_J, stored_J, dissipated {cause: J}, residual_J; residual_relative
    counts             events, impacts, steps, lcp_failures and the like
    keep, spans        what was kept (scene/recording.py): `spans` the stretches of time (s) with rows, () for a run that was
                       made by hand
    sums               over all events of the whole run, kept or not (simulation/tally.py)
    end_state          from which the run can go on; None for one that was made by hand
    failure            the complementarity problem on which the solver gave up (simulation/lcp_failure.py), else None
    """

    scene: Scene
    t: Array
    q: Array
    u: Array
    a: Array
    slices: dict[str, slice]
    events: NDArray[Any]
    pairs: Sequence[Pair]
    stop: Stop
    stop_message: str = ""
    simulated: float = 0.0
    wall: float = 0.0
    compile: float = 0.0
    method: str = "pfeiffer-glocker"
    tolerance: float = 1e-9
    worst_penetration: float = 0.0
    worst_residual: float = 0.0
    overlap: dict[str, Any] = field(default_factory=dict)
    energy: dict[str, Any] = field(default_factory=dict)
    counts: dict[str, int] = field(default_factory=dict)
    step: float | None = None  # s, of a method with fixed steps
    end_q: Array = field(default_factory=lambda: np.zeros(0))  # at `simulated`, whether rows are kept there or not
    end_u: Array = field(default_factory=lambda: np.zeros(0))
    keep: str = ALL
    spans: tuple[Window, ...] = ()
    sums: dict[str, Any] = field(default_factory=dict)
    end_state: SavedState | None = field(default=None, repr=False, compare=False)  # to go on from, see `simulate`
    failure: dict[str, Any] | None = field(default=None, repr=False)

    @property
    def worst_overlap(self) -> float:
        """The deepest overlap of bodies that looking at their outlines has found, m; 0: none as deep as the resolution."""
        return float(self.overlap.get("worst_m", 0.0))

    def __post_init__(self) -> None:
        """A frozen value to the last element; views, so that whoever made the arrays may go on with them."""
        for name in ("t", "q", "u", "a", "events", "end_q", "end_u"):
            view = getattr(self, name)[...]
            view.flags.writeable = False
            object.__setattr__(self, name, view)

    def __repr__(self) -> str:
        kinds = f"{len(self.t)} rows of {self.q.shape[1]} coordinates, {len(self.events)} events"
        return f"<Trajectory of {self.scene.title!r}: {self.simulated:g} s, {kinds}; {self.stop.sentence}>"

    def _repr_html_(self) -> str:
        return notebook_html(self)

    def player(self, window: Window | None = None) -> Any:
        """A player that a notebook shows under its cell, see `watchsim.show`."""
        return player(self, window)

    @cached_property
    def _noise(self) -> Array:
        """(n,): how exact each coordinate is at its rows."""
        most: Array = np.zeros(self.q.shape[1])
        for (part,) in blocks(self.q):
            most = np.maximum(most, np.max(np.abs(part), axis=0, initial=0.0))
        return ROW_NOISE * self.tolerance * most

    def at(self, t: float) -> tuple[Array, Array]:
        """q and u at time `t` (after the impact where one happens at `t`).

        Positions by the quintics through q, u, a of two rows; velocities by the cubics through u, a, with what is missing to
        the way between the rows where that is more than the error of positions: within ten tolerances of the coordinate's
        largest value times its own rate. Times outside are clamped.
        """
        q, u = self.sample(np.array([t]))
        return q[0], u[0]

    def sample(self, times: ArrayLike) -> tuple[Array, Array]:
        """q and u, each (len(times), n), at all those times, or (n,) at a single one; as `at`.

        ValueError where no row was kept.
        """
        times = np.asarray(times, float)
        if times.ndim == 0:
            return self.at(float(times))
        if len(self.t) == 0:
            raise ValueError(NO_ROW)
        if len(times) > AT_ONCE and is_mapped(self.q):
            found = [self.sample(part) for (part,) in blocks(times, length=AT_ONCE)]
            return np.concatenate([q for q, _ in found]), np.concatenate([u for _, u in found])
        i, j, h, s, last = self._intervals(times)
        q, u = between(s, h, (self.q[i], self.u[i], self.a[i]), (self.q[j], self.u[j], self.a[j]), self._noise)
        q, u = np.where(last, self.q[j], q), np.where(last, self.u[j], u)
        let_go(self.t, self.q, self.u, self.a)
        return q, u

    def positions(self, times: ArrayLike, columns: Sequence[int]) -> Array:
        """(len(times), len(columns)): these coordinates alone, as `sample`, which takes several times as long."""
        times = np.asarray(times, float)
        if len(self.t) == 0:
            raise ValueError(NO_ROW)
        if len(times) > AT_ONCE and is_mapped(self.q):
            return np.concatenate([self.positions(part, columns) for (part,) in blocks(times, length=AT_ONCE)])
        i, j, h, s, last = self._intervals(times)
        left, right = (tuple(array[rows[:, None], columns] for array in (self.q, self.u, self.a)) for rows in (i, j))
        q = np.where(last, right[0], place_between(s, h, left, right))
        let_go(self.t, self.q, self.u, self.a)
        return q

    def _intervals(self, times: Array) -> tuple[NDArray[np.intp], NDArray[np.intp], Array, Array, NDArray[np.bool_]]:
        """The rows before and after each of the times (clamped), and as columns: how far apart they are (s), at what fraction
        between them the time lies, and whether both are of one instant."""
        i = np.clip(np.searchsorted(self.t, times, side="right") - 1, 0, max(len(self.t) - 2, 0))
        j = np.minimum(i + 1, len(self.t) - 1)
        h = (self.t[j] - self.t[i])[:, None]
        last = h <= 0.0  # two rows of one instant at the very end: the one after the impact counts
        h = np.where(last, 1.0, h)
        return i, j, h, np.clip((times - self.t[i])[:, None] / h, 0.0, 1.0), last

    def acceleration(self, times: ArrayLike) -> Array:
        """(len(times), n): accelerations, of the cubics through u and a of two rows; as `sample`."""
        times = np.asarray(times, float)
        if times.ndim == 0:
            return self.acceleration(times[None])[0]
        if len(self.t) == 0:
            raise ValueError(NO_ROW)
        i, j, h, s, last = self._intervals(times)
        way = (self.u[j] - self.u[i]) / h
        left, right = self.a[i], self.a[j]
        cubic = left + s * (6.0 * way - 4.0 * left - 2.0 * right + s * (3.0 * (left + right) - 6.0 * way))
        return np.where(last, right, cubic)

    def pose(self, body: str, t: float) -> tuple[float, float, float]:
        """x, y (m) and angle (rad) of the body's frame in the movement at time `t`."""
        return self.pose_of(body, self.at(t)[0] if self.slices else np.zeros(0))

    @property
    def end(self) -> tuple[Array, Array] | None:
        """q and u at `simulated`, whether rows were kept there or not; None for a run that was made by hand without rows."""
        if len(self.end_q):
            return self.end_q, self.end_u
        return (self.q[-1], self.u[-1]) if len(self.t) else None

    def pose_of(self, body: str, coordinates: Array) -> tuple[float, float, float]:
        """The same where all coordinates are given."""
        x, y, angle = frames(self.scene, self.slices, coordinates[None])[body][0].tolist()
        return x, y, angle


def between(s: Array, h: Array, left: tuple[Array, ...], right: tuple[Array, ...], noise: Array) -> tuple[Array, Array]:
    """q and u at fractions `s` of intervals of length h with (q, u, a) at both ends; `noise` is the error of q.

    The derivative of the quintic in q is the cubic in u and a bump, which makes up for the way that the cubic misses. Over a
    short time an error of q of the size of the tolerance would make much of it; rows are close enough for the cubic there.
    """
    u0, a0, u1, a1 = h * left[1], h * h * left[2], h * right[1], h * h * right[2]
    cubic = u0 + s * (a0 + s * (3.0 * (u1 - u0) - 2.0 * a0 - a1 + s * (2.0 * (u0 - u1) + a0 + a1)))
    missed = right[0] - left[0] - 0.5 * (u0 + u1) - (a0 - a1) / 12.0
    bump = 30.0 * np.where(np.abs(missed) > noise, missed, 0.0) * (s * (1.0 - s)) ** 2
    return place_between(s, h, left, right), (cubic + bump) / h


def place_between(s: Array, h: Array, left: tuple[Array, ...], right: tuple[Array, ...]) -> Array:
    """The same, q alone."""
    q0, u0, a0 = left[0], h * left[1], h * h * left[2]
    q1, u1, a1 = right[0], h * right[1], h * h * right[2]
    d = q1 - q0
    c3 = 10.0 * d - 6.0 * u0 - 4.0 * u1 - 1.5 * a0 + 0.5 * a1
    c4 = -15.0 * d + 8.0 * u0 + 7.0 * u1 + 1.5 * a0 - a1
    c5 = 6.0 * d - 3.0 * (u0 + u1) - 0.5 * (a0 - a1)
    return q0 + s * (u0 + s * (0.5 * a0 + s * (c3 + s * (c4 + s * c5))))


def joined(first: Trajectory, rest: Trajectory, folder: Path | None = None) -> Trajectory:
    """`first` up to its saved state and `rest`, which went on from there.

    What `first` holds beyond that state is the step its end cut short; `rest` holds the same stretch in whole steps.
    Sums and counts run through the saved state, so those of `rest` are those of both. Times on the clock add up. Rows and
    events go to files in `folder` where they are many.
    """
    saved, later = first.end_state, rest.end_state
    if saved is None:
        raise ValueError("the first part carries no end state")
    cut, stays = saved.rows, saved.recorded.get("stays", np.ones(saved.rows, bool))
    if rest.keep != ALL and len(saved.recorded.get("row", ())):
        cut -= 1  # the row about which the next one decides is among those of `rest`, if it stays
    if later is not None:
        recorded = {**later.recorded, "stays": np.append(stays[:cut], later.recorded.get("stays", np.ones(later.rows, bool)))}
        later = dataclasses.replace(later, rows=cut + later.rows, events=saved.events + later.events, recorded=recorded)
    before = [array[:cut] for array in (first.t, first.q, first.u, first.a)]
    t, q, u, a = one_behind_the_other(before, (rest.t, rest.q, rest.u, rest.a), folder)
    (events,) = one_behind_the_other([first.events[: saved.events]], [rest.events], folder)
    whole = dataclasses.replace(
        rest,
        t=t,
        q=q,
        u=u,
        a=a,
        events=events,
        wall=first.wall + rest.wall,
        compile=first.compile + rest.compile,
        end_state=later,
    )
    return whole if rest.keep == ALL else _without_old_tail(whole, stays[:cut])


def _without_old_tail(run: Trajectory, stays: NDArray[np.bool_]) -> Trajectory:
    """Without the last seconds of the first part, where only those of the whole are kept; `stays`: which rows stay anyway."""
    since = max(0.0, run.simulated - tail_length(frequency(run.scene)))
    rows = stretch_rows(run.t, ((since, run.simulated),))
    rows[: len(stays)] |= stays
    rows[len(stays) :] = True
    events = within(run.events["t"], run.spans) | (run.keep != STATISTICS)
    saved = run.end_state
    if saved is not None:
        recorded = {**saved.recorded, "stays": saved.recorded["stays"][rows[: saved.rows]]}
        kept_rows, kept_events = int(rows[: saved.rows].sum()), int(events[: saved.events].sum())
        saved = dataclasses.replace(saved, rows=kept_rows, events=kept_events, recorded=recorded)
    return dataclasses.replace(
        run, t=run.t[rows], q=run.q[rows], u=run.u[rows], a=run.a[rows], events=run.events[events], end_state=saved
    )
