"""How does the woodpecker toy move, exactly?

With constant directions the contact forces of a mode are linear in the coordinates: the motion within a mode is that of a
linear system with constant coefficients, and its exponential is exact. Forces, modes and impacts come from the kernels of
`dynamics`; only the time of the next event is found here.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm
from scipy.optimize import brentq

from watchsim.contact.index_sets import OPEN, STICK
from watchsim.verification.woodpecker.toy import Array, Modal

Modes = NDArray[np.int8]  # by contact
CLOSED = 1e-12  # m: gaps this small are closed
STILL = 1e-10  # m/s: slower is standing
GAP, SLIP, FORCE = 1e-14, 0.5 * STILL, 2e-9  # m, m/s, N: what ends a mode lies this far beyond zero, out of rounding's reach
FINE, STRIDE = 24, 5e-5  # halvings of the first stride, s; the spring's period is 6 ms
BLOCK = 64  # strides at once
TERMS = 16  # of the exponential over a stride
AT_ONCE = 40  # events at one instant


@dataclass(frozen=True)
class Moment:
    """An event: when, what ended the mode before it, and the state after it."""

    t: float
    cause: str  # "impact", "open", "reverse" (a slip stops), "slip" (a stick breaks), "end"
    contact: int
    q: Array  # y, tilt of the sleeve, tilt of the bird
    u: Array
    before: Array  # the same velocities before it
    mode: tuple[int, ...]


@dataclass(frozen=True)
class Phase:
    """Motion in one set of modes: z = (e, e', 1), z' = flow z; the mode holds while all `rows` z + `slack` are positive."""

    flow: Array
    rows: Array
    slack: Array
    causes: list[tuple[str, int]]


def phase_of(model: Modal, mode: Modes, taken: list[int]) -> Phase:
    """The linear system of the contacts in force, from forces at four places."""
    contacts, n = model.contacts, 3
    contacts.take(taken)
    W = np.array([contacts.W[2 * i + k] for i in taken for k in (0, 1)]).reshape(-1, n)
    at_zero = contacts.forces(model.force(np.zeros(n)), mode) if taken else np.zeros(0)
    slope = np.array([contacts.forces(model.force(e), mode) - at_zero for e in np.eye(n)]).T if taken else np.zeros((0, n))
    flow = np.zeros((2 * n + 1, 2 * n + 1))
    flow[:n, n : 2 * n] = np.eye(n)
    flow[n : 2 * n, :n] = W.T @ slope - np.diag(model.spring)
    flow[n : 2 * n, -1] = model.load + W.T @ at_zero
    rows, causes = [], []
    for i in range(3):
        N, T, mu = contacts.W[2 * i], contacts.W[2 * i + 1], contacts.friction[i]
        if i not in taken:
            rows.append(np.concatenate([N, np.zeros(n), [model.gaps[i]]]))
            causes.append(("impact", i))
            continue
        j = 2 * taken.index(i)
        normal = np.concatenate([slope[j], np.zeros(n), [at_zero[j]]])
        tangential = np.concatenate([slope[j + 1], np.zeros(n), [at_zero[j + 1]]])
        rows.append(normal)
        causes.append(("open", i))
        if mode[i] == STICK:
            rows += [mu * normal - tangential, mu * normal + tangential]
            causes += [("slip", i)] * 2
        else:
            rows.append(np.concatenate([np.zeros(n), mode[i] * T, [0.0]]))
            causes.append(("reverse", i))
    slack = {"impact": GAP, "reverse": SLIP, "open": FORCE, "slip": FORCE}
    return Phase(flow, np.array(rows), np.array([slack[cause] for cause, _ in causes]), causes)


def next_event(phase: Phase, z: Array, until: float) -> tuple[float, int]:
    """Time until the first row loses its sign, and which; (until, -1) if none does.

    Samples show every sign change and every minimum; rows that begin at zero are followed from fractions of a stride on.
    """
    first = [0.0, *(STRIDE * 0.5**k for k in range(FINE, 0, -1))]
    states = [z, *(expm(phase.flow * t) @ z for t in first[1:])]
    times = list(first)
    stride = expm(phase.flow * STRIDE)
    while True:
        found = _first_root(phase, np.array(times), np.array(states))
        if found is not None:
            return found if found[0] < until else (until, -1)
        if times[-1] >= until:
            return until, -1
        begin, last = times[-1], states[-1]
        if begin < STRIDE:
            last, begin = z, 0.0
        states, times = [last], [begin]
        for k in range(1, BLOCK):
            states.append(stride @ states[-1])
            times.append(begin + k * STRIDE)


def _first_root(phase: Phase, times: Array, states: Array) -> tuple[float, int] | None:
    """(time, row) of the first sign change between the samples, or of a minimum below zero."""
    values, slopes = states @ phase.rows.T + phase.slack, states @ (phase.rows @ phase.flow).T
    fell = values[1:] <= 0.0
    bent = (values[:-1] > 0.0) & (slopes[:-1] < 0.0) & (slopes[1:] > 0.0)
    best: tuple[float, int] | None = None
    for row in range(len(phase.rows)):
        for k in np.flatnonzero(fell[:, row] | bent[:, row]):
            if best is not None and times[k] >= best[0]:
                break
            within = _within(phase, row, states[k], times[k + 1] - times[k])
            if within is not None:
                best = min(best or (np.inf, row), (float(times[k]) + within, row))
                break
    return best


def _within(phase: Phase, row: int, z: Array, length: float) -> float | None:
    """Time from sample z on, at most `length`, at which a row loses its sign; None if it does not."""
    series = np.zeros(TERMS)
    term = z
    for j in range(TERMS):
        series[TERMS - 1 - j] = phase.rows[row] @ term
        term = phase.flow @ term / (j + 1)
    slack = phase.slack[row]

    def value(t: float) -> float:
        return float(np.polyval(series, t)) + slack

    slope = np.polyder(series)
    if value(length) > 0.0:  # a minimum in between
        length = _root(lambda t: float(np.polyval(slope, t)), 0.0, length)
        if value(length) > 0.0:
            return None
    if value(0.0) <= 0.0:
        return 0.0
    root = _root(value, 0.0, length)
    # Forces end a mode late: who decides anew must see them beyond their bound. Gaps and slips end it exactly.
    if phase.causes[row][0] in ("impact", "reverse") and value(0.0) > slack:
        root = _root(lambda t: value(t) - slack, 0.0, root)
    return root


def _root(f: Callable[[float], float], low: float, high: float) -> float:
    """Where f changes its sign; the end nearer to zero where rounding decides."""
    a, b = f(low), f(high)
    if (a > 0.0) == (b > 0.0):
        return low if abs(a) < abs(b) else high
    return float(brentq(f, low, high, xtol=1e-18, rtol=1e-15))


def moments(model: Modal, e: Array, v: Array, until: float) -> Iterator[Moment]:
    """The events from modal coordinates e and velocities v on, up to time `until`."""
    t, cause, contact, at_once = 0.0, "start", -1, 0
    e, v = e.copy(), v.copy()
    while True:
        before = v.copy()
        e, v, mode, taken, hit = settle(model, e, v)
        kind = "impact" if hit else ("close" if cause == "impact" else cause)
        yield Moment(t, kind, contact, model.basis @ e, model.basis @ v, model.basis @ before, tuple(int(k) for k in mode))
        if t >= until:
            return
        phase = phase_of(model, mode, taken)
        z = np.concatenate([e, v, [1.0]])
        span, row = next_event(phase, z, until - t)
        cause, contact = phase.causes[row] if row >= 0 else ("end", -1)
        z = expm(phase.flow * span) @ z
        at_once = 0 if span > 0.0 else at_once + 1
        if at_once > AT_ONCE:
            raise RuntimeError(f"the woodpecker stands still in time at {t:g} s")
        t, e, v = (t + span if row >= 0 else until), z[:3], z[3:6]


def settle(model: Modal, e: Array, v: Array) -> tuple[Array, Array, Modes, list[int], bool]:
    """What follows an event: impacts until nothing approaches, modes, exact gaps; (e, v, mode, contacts in force, impact?)."""
    contacts, hit = model.contacts, False
    N = contacts.W[::2]
    closed = [i for i in range(3) if model.gaps[i] + N[i] @ e <= CLOSED]
    for _ in range(AT_ONCE):
        if not any(N[i] @ v < -STILL for i in closed):
            break
        contacts.take(closed)
        solved, v, _ = contacts.impact(v)
        hit = True
        if not solved:
            raise RuntimeError("an impact of the woodpecker has no solution")
    resting = [i for i in closed if abs(N[i] @ v) <= STILL]
    mode = np.full(3, OPEN, np.int8)
    if resting:
        contacts.take(resting)
        solved, mode = contacts.modes(v, model.force(e), STILL)
        if not solved:
            raise RuntimeError("the woodpecker has no finite forces")
    taken = [i for i in resting if mode[i] != OPEN]
    if taken:
        e, v = _exact(model, taken, mode, e, v)
    return e, v, mode, taken, hit


def _exact(model: Modal, taken: list[int], mode: Modes, e: Array, v: Array) -> tuple[Array, Array]:
    """Gaps and rates of the contacts in force, and the slip of those that stick, exactly zero."""
    W = model.contacts.W
    N = W[[2 * i for i in taken]]
    held = np.vstack([N, *(W[2 * i + 1][None] for i in taken if mode[i] == STICK)])
    e = e - np.linalg.pinv(N) @ (N @ e + model.gaps[taken])
    return e, v - np.linalg.pinv(held) @ (held @ v)
