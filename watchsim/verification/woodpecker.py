"""Does the woodpecker toy come out?"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm
from scipy.optimize import brentq

from watchsim.contact.gaps import OPEN, STICK
from watchsim.jit import callable_kernel
from watchsim.simulation.moreau_percussions import laws, relax
from watchsim.verification.checks import Row, compared
from watchsim.verification.random_problems import BareContacts

# A sleeve with play on a pole, and a bird that a torsion spring holds to it: pecking, sticking and slipping it comes down.
# Three coordinates, the height of the sleeve and the tilts of sleeve and bird; three frictional contacts with the pole: the
# beak, the sleeve's lower and its upper edge. Linearised for small tilts. Data: Ch. Glocker, Dynamik von Starrkörpersystemen
# mit Reibung und Stößen, thesis, Munich 1995, and Ch. Glocker, C. Studer, Multibody System Dynamics 13 (2005) 447.

Array = NDArray[np.float64]

BEAK, LOWER, UPPER = 0, 1, 2
PLACES = ("beak", "lower edge", "upper edge")


@dataclass(frozen=True)
class Toy:
    """Constants, SI. `restitution` by contact: the wooden beak springs back, the sleeve does not."""

    sleeve_mass: float = 3e-4
    sleeve_inertia: float = 5e-9
    bird_mass: float = 4.5e-3
    bird_inertia: float = 7e-7
    stiffness: float = 5.6e-3  # N·m/rad
    gravity: float = 9.81
    pole_radius: float = 2.5e-3
    sleeve_radius: float = 3.1e-3
    sleeve_half_height: float = 5.8e-3
    sleeve_to_spring: float = 0.010
    spring_to_bird: float = 0.015
    beak_height: float = 0.020
    beak_length: float = 0.0201
    friction: float = 0.3
    restitution: tuple[float, float, float] = (0.5, 0.0, 0.0)

    @property
    def mass(self) -> Array:
        """(3, 3) mass matrix."""
        m, a, b = self.bird_mass, self.sleeve_to_spring, self.spring_to_bird
        return np.array(
            [
                [m + self.sleeve_mass, m * a, m * b],
                [m * a, self.sleeve_inertia + m * a * a, m * a * b],
                [m * b, m * a * b, self.bird_inertia + m * b * b],
            ]
        )

    @property
    def load(self) -> Array:
        """(3,) weight."""
        m = self.bird_mass
        return -self.gravity * np.array([m + self.sleeve_mass, m * self.sleeve_to_spring, m * self.spring_to_bird])

    @property
    def directions(self) -> Array:
        """(6, 3) rows N, T of beak, lower and upper edge."""
        a, b, h = self.sleeve_to_spring, self.spring_to_bird, self.sleeve_half_height
        return np.array(
            [
                [0.0, 0.0, -self.beak_height],
                [1.0, a, b - self.beak_length],
                [0.0, h, 0.0],
                [1.0, self.sleeve_radius, 0.0],
                [0.0, -h, 0.0],
                [1.0, self.sleeve_radius, 0.0],
            ]
        )

    @property
    def gaps(self) -> Array:
        """(3,) gaps with all coordinates zero; they are linear in the coordinates."""
        play = self.sleeve_radius - self.pole_radius
        return np.array([self.sleeve_to_spring + self.spring_to_bird - self.beak_length - self.pole_radius, play, play])


@dataclass(frozen=True)
class Modal:
    """The toy in coordinates e with unit masses and one spring: q = basis e, gap = gaps + N e, slip = T e'."""

    basis: Array  # (3, 3) by column
    spring: Array  # (3,) stiffness of each modal coordinate, 1/s²; two are free
    load: Array
    contacts: BareContacts
    gaps: Array

    def force(self, e: Array) -> Array:
        """Weight and spring at e."""
        return np.asarray(self.load - self.spring * e, float)

    def into(self, vector: Array) -> Array:
        """Modal coordinates of (y, tilt of the sleeve, tilt of the bird)."""
        return np.asarray(np.linalg.solve(self.basis, vector), np.float64)


def modal(toy: Toy) -> Modal:
    """M and K are diagonal together: the spring feels only the difference of the tilts, so two modes are exactly free."""
    free = np.tri(3)  # its first two columns tilt both alike
    basis = free @ np.linalg.inv(np.linalg.cholesky(free.T @ toy.mass @ free).T)
    twist = basis[1, 2] - basis[2, 2]
    spring = np.array([0.0, 0.0, toy.stiffness * twist * twist])
    contacts = BareContacts(np.ones(3), toy.directions @ basis, np.full(3, toy.friction), np.array(toy.restitution))
    return Modal(basis, spring, basis.T @ toy.load, contacts, toy.gaps)


def start(toy: Toy, model: Modal) -> tuple[Array, Array]:
    """Modal coordinates and velocities of the papers' start, near the cycle: the lower edge slides down the pole."""
    tilt = -(toy.sleeve_radius - toy.pole_radius) / toy.sleeve_half_height  # printed -0.1036, a little inside the pole
    return model.into(np.array([0.0, tilt, -0.2788])), model.into(np.array([-0.3411, 0.0, -7.4583]))


# With constant directions the contact forces of a mode are linear in the coordinates: the motion within a mode is that of a
# linear system with constant coefficients, and its exponential is exact. Forces, modes and impacts come from the kernels of
# `dynamics`; only the time of the next event is found here.

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
    # Forces end a mode late: who decides again must see them beyond their bound. Gaps and slips end it exactly.
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


# How does Moreau's time stepping move the woodpecker toy? Relaxation in place of complementarity, steps in place of events.
#
# The step of `--method moreau`, in the toy's modal coordinates: contacts closed at the middle of the step; stop and throw back
# what approaches (Poisson); then forces and contacts together, the spring at the middle of the step.

_relax = callable_kernel(relax)


def percussions(G: Array, rates: Array, low: Array, friction: Array) -> Array:
    """(2m,) that keep the normal rates from being negative, at least `low` along the normals."""
    m = len(low)
    obeyed = laws(m, 0)
    obeyed.G[:], obeyed.b[:], obeyed.low[:] = G, rates, low
    obeyed.ends[:] = np.outer(friction, (0.0, -1.0, 0.0, 1.0))  # Coulomb's law, see percussion_laws
    _, settled = _relax(obeyed, m, 0)
    if not settled:
        raise RuntimeError("the relaxation of the woodpecker has not settled")
    return obeyed.P


def step_to(model: Modal, e: Array, v: Array, until: float, h: float) -> tuple[Array, Array]:
    """Modal coordinates and velocities at time `until` by steps of about h."""
    W, mu, restitution = model.contacts.W, model.contacts.friction, model.contacts.restitution
    count = round(until / h)
    h = until / count
    stiff = 1.0 + 0.25 * h * h * model.spring
    for _ in range(count):
        middle = e + 0.5 * h * v
        closed = [i for i in range(3) if model.gaps[i] + W[2 * i] @ middle <= 0.0]
        rows = W[[2 * i + k for i in closed for k in (0, 1)]]
        w = _impact(rows, v, mu[closed], restitution[closed]) if closed else v
        free = ((2.0 - stiff) * w + h * (model.load - model.spring * e)) / stiff
        new = free
        if closed:
            P = percussions(rows / stiff @ rows.T, rows @ free, np.zeros(len(closed)), mu[closed])
            new = free + rows.T @ P / stiff
        e = e + 0.5 * h * (w + new)
        v = new
    return e, v


def _impact(rows: Array, v: Array, mu: Array, restitution: Array) -> Array:
    """Velocities after compression and expansion."""
    G, m = rows @ rows.T, len(mu)
    P = percussions(G, rows @ v, np.zeros(m), mu)
    middle = v + rows.T @ P
    more = percussions(G, rows @ middle, restitution * P[::2], mu)
    return middle + rows.T @ more


# While the lower edge sticks only the bird moves, and the edge breaks loose at one tilt of the bird: what the toy does next
# depends on one number, the bird's rate there. A cycle is a fixed point of the map from that number to the one a peck later.

LONG = 0.5  # s: more than two pecks
SETTLED = 1e-13  # relative change of the fixed point


@dataclass(frozen=True)
class Cycle:
    """One peck: its events from one breaking loose to the next, the period, how far it is from closing, the map's slope."""

    events: list[Moment]
    period: float
    descent: float
    gap: float  # largest difference of tilts (rad) and of rates over 10 rad/s and 0.1 m/s, after one period
    slope: float


def breaks_loose(moment: Moment) -> bool:
    """True where the section is: the sleeve's lower edge gives way."""
    return moment.cause == "slip" and moment.contact == LOWER


def one_peck(model: Modal, q: Array, u: Array) -> list[Moment]:
    """Events from the state (q, u) to the next breaking loose, included."""
    events = []
    for moment in moments(model, model.into(q), model.into(u), LONG):
        events.append(moment)
        if len(events) > 1 and breaks_loose(moment):
            break
    return events


def find_cycle(toy: Toy) -> Cycle:
    """From the papers' start to the section, then the secant method."""
    model = modal(toy)
    first = next(moment for moment in moments(model, *start(toy, model), LONG) if breaks_loose(moment))
    place = np.array([0.0, *first.q[1:]])

    def after(rate: float) -> float:
        return float(one_peck(model, place, np.array([0.0, 0.0, rate]))[-1].u[2])

    rate, image = float(first.u[2]), after(float(first.u[2]))
    slope = 0.0
    for _ in range(20):
        new = rate + (image - rate) / (1.0 - slope)
        if abs(new - rate) <= SETTLED * abs(rate):
            break
        new_image = after(new)
        slope = (new_image - image) / (new - rate)
        rate, image = new, new_image
    events = one_peck(model, place, np.array([0.0, 0.0, rate]))
    last = events[-1]
    tilts = np.abs(last.q[1:] - place[1:]).max()
    rates = max(abs(last.u[0]) / 0.1, abs(last.u[1]) / 10.0, abs(last.u[2] - rate) / 10.0)
    return Cycle(events, last.t, -float(last.q[0]), float(max(tilts, rates)), slope)


# Two runs of the same toy from the same start, by Moreau's time stepping: the reference of Siconos, whose state at the end is
# known; and the animation of M. Baumann, G. Nützi, Simulating the Woodpecker Toy, 2017 (github.com/gabyx/Woodpecker,
# WoodpeckerAnimation2.svg), which shows positions and contact forces in 644 frames of 0.43 s and thereby every change of
# mode: where a force begins or ends, where it leaves the cone of friction's edge and the sleeve stops, or begins to slide
# again.

NAME = "woodpecker toy"
# One peck, with the last frame before each event. The sleeve slides on its lower edge and sticks; breaks loose, slides and lets
# go; its upper edge meets the pole; the beak pecks; the upper edge slides up the pole; the lower edge comes back twice.
FRAMES = (
    ("reverse", LOWER, 32),
    ("slip", LOWER, 91),
    ("open", LOWER, 100),
    ("impact", UPPER, 116),
    ("impact", BEAK, 121),
    ("impact", UPPER, 122),
    ("open", UPPER, 124),
    ("impact", LOWER, 177),
    ("impact", LOWER, 182),
)
FRAME, FRAMES_STEP = 0.43 / 643, 1e-4  # s
FRAMES_SOURCE = "Baumann, Nützi 2017, github.com/gabyx/Woodpecker, WoodpeckerAnimation2.svg, steps of 1e-4 s"
END, END_STEP = 0.29998, 2e-5  # s
AT_END = {"height of the sleeve [m]": -0.04134818676833654, "tilt of the bird [rad]": -0.3409339755504301}
END_SOURCE = "siconos-tutorials, examples/mechanics/Woodpecker/Woodpecker.ref, steps of 2e-5 s"
FASTEST = 250.0  # rad/s: what a step too early or late at each of the impacts does to the tilt of the bird after a peck


def published_rows(toy: Toy, cycle: Cycle) -> list[Row]:
    """The order of events, their times, and the state at the end of a run.

    Times may lie outside their frames by as many steps as there were impacts: each may shift by up to one. So do the steps of
    the other run at each of its nine changes of mode.
    """
    model = modal(toy)
    seen = list(moments(model, *start(toy, model), END))
    first = [(one.cause, one.contact, one.t) for one in seen[1 : len(FRAMES) + 1]]
    order = [frame[:2] for frame in FRAMES]
    wrong = sum(one[:2] != wanted for one, wanted in zip(first, order, strict=True))
    # The cycle begins where the sleeve breaks loose.
    again = [(event.cause, event.contact) for event in cycle.events[1:]]
    wrong += sum(one != wanted for one, wanted in zip(again, [*order[2:], *order[:2]], strict=True))
    outside = max(max(k * FRAME - t, t - (k + 1) * FRAME, 0.0) for (_, _, t), (_, _, k) in zip(first, FRAMES, strict=True))
    impacts = sum(cause == "impact" for cause, _ in order)
    got = {"height of the sleeve [m]": seen[-1].q[0], "tilt of the bird [rad]": seen[-1].q[2]}
    return [
        compared(NAME, "events of the first peck and of the cycle out of order", 0.0, float(wrong), 0.0, FRAMES_SOURCE),
        compared(NAME, "events outside their frames by [s]", 0.0, outside, impacts * FRAMES_STEP, FRAMES_SOURCE),
        *(
            compared(NAME, f"{word} at {END:g} s", value, float(got[word]), FASTEST * END_STEP, END_SOURCE)
            for word, value in AT_END.items()
        ),
    ]


STEPS, SLOW_STEPS = (5e-5, 5e-6), (5e-5, 5e-6, 5e-7)


def woodpecker_rows(steps: tuple[float, ...] = STEPS) -> list[Row]:
    """Closing of the cycle, published runs with their order of events, and Moreau's time stepping with these steps, s."""
    toy = Toy()
    cycle = find_cycle(toy)
    return [*_cycle_rows(cycle), *published_rows(toy, cycle), *(_twin_row(toy, cycle, h) for h in steps)]


def _cycle_rows(cycle: Cycle) -> list[Row]:
    source = "the toy of Glocker 1995 and of Leine, Glocker, van Campen, DETC 2001: a stable cycle, one peck after the other"
    return [
        compared(NAME, "tilts and rates after one period, scaled", 0.0, cycle.gap, 1e-9, source),
        compared(NAME, "slope of the map beyond 1 (unstable)", 0.0, max(0.0, abs(cycle.slope) - 1.0), 0.0, source),
    ]


def _twin_row(toy: Toy, cycle: Cycle, h: float) -> Row:
    model = modal(toy)
    first, last = cycle.events[0], cycle.events[-1]
    e, _ = step_to(model, model.into(first.q), model.into(first.u), cycle.period, h)
    tilts = float(np.abs((model.basis @ e - last.q)[1:]).max())
    source = "first order: the error of the event-driven solution would not go with the step"
    return compared(NAME, f"Moreau, steps of {h:g} s: tilts after a peck [rad]", 0.0, tilts, FASTEST * h, source)
