"""Along which path do bodies move within a step, and how sharply can it bend?

In a coupled step the motion is the continuous extension: a polynomial of degree 7 in the time of the step. Its velocity is
the derivative of that polynomial, and its acceleration is bounded by the Bernstein coefficients of the second derivative.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.cell_lookup import along
from watchsim.contact.gaps import STICK, place_body
from watchsim.jit import hot_kernel, kernel
from watchsim.model import FREE
from watchsim.simulation.options import longest_step
from watchsim.simulation.scratch import FLIGHT, is_kept, keep_event, keep_row
from watchsim.simulation.state import EventKind
from watchsim.tolerances import FLIGHT_PHASE, FLIGHT_SIZES, PASSAGE_RESOLUTION

# Where, between two times with values of opposite sign, is a zero?
#
# Illinois' method, with a bisection where three steps have not halved the bracket: a function that is flat at one end and steep
# at the other, as the least of several margins is, would hold the method back for ever. The caller evaluates:
#
#     bracket = opened(low, f_low, high, f_high)
#     time = next_time(bracket)
#     while is_open(bracket, time, resolution):
#         bracket = narrowed(bracket, time, f := ..., on_high_side)
#         time = next_time(bracket)

MOST = 250  # evaluations at most: bisections alone reach the rounding of time before
LOOK_EVERY = 3

NEITHER, LOW, HIGH = 0, -1, 1


class Bracket(NamedTuple):
    """Two times with values of opposite sign; a value that has been kept twice in a row is halved (Illinois)."""

    low: float
    f_low: float
    high: float
    f_high: float
    moved: int  # the end that was moved last
    looks: int  # evaluations so far
    before: float  # width at the last of every third evaluations


@kernel
def opened(low, f_low, high, f_high):
    """The bracket to begin with."""
    return Bracket(low, f_low, high, f_high, NEITHER, 0, 2.0 * (high - low))


@kernel
def next_time(bracket):
    """The time to evaluate next; not strictly within the bracket where nothing is."""
    low, high = bracket.low, bracket.high
    middle = (low * bracket.f_high - high * bracket.f_low) / (bracket.f_high - bracket.f_low)
    is_slow = bracket.looks % LOOK_EVERY == 0 and high - low > 0.5 * bracket.before
    if is_slow or not low < middle < high:
        middle = 0.5 * (low + high)
    return middle


@kernel
def is_open(bracket, time, resolution):
    """True while the bracket is wider than `resolution` and something lies within it."""
    if bracket.looks >= MOST or bracket.high - bracket.low <= resolution:
        return False
    return bracket.low < time < bracket.high


@kernel
def narrowed(bracket, time, f, on_high_side):
    """The bracket after the value f at `time`, which replaces the upper end or the lower one."""
    before = bracket.high - bracket.low if bracket.looks % LOOK_EVERY == 0 else bracket.before
    if on_high_side:
        f_low = 0.5 * bracket.f_low if bracket.moved == HIGH else bracket.f_low
        return Bracket(bracket.low, f_low, time, f, HIGH, bracket.looks + 1, before)
    f_high = 0.5 * bracket.f_high if bracket.moved == LOW else bracket.f_high
    return Bracket(time, f, bracket.high, f_high, LOW, bracket.looks + 1, before)


# How does an uncoupled coordinate move? Exactly.

SERIES = 1e-2  # below it the exponential differences are summed as series: no cancellation


@kernel
def _phi(z):
    """(1 - exp(-z))/z and (z - 1 + exp(-z))/z²."""
    if abs(z) < SERIES:
        first = 1.0 - z / 2.0 * (1.0 - z / 3.0 * (1.0 - z / 4.0 * (1.0 - z / 5.0 * (1.0 - z / 6.0))))
        second = 0.5 * (1.0 - z / 3.0 * (1.0 - z / 4.0 * (1.0 - z / 5.0 * (1.0 - z / 6.0 * (1.0 - z / 7.0)))))
        return first, second
    first = -math.expm1(-z) / z
    return first, (1.0 - first) / z


@kernel
def steady_force(coordinate, grip):
    """The constant force, with the dry friction of a bearing that moves in direction `grip` (0: none)."""
    return coordinate.force - grip * coordinate.coulomb


@hot_kernel
def flow(coordinate, grip, q, u, t):
    """Coordinate and velocity after time t from (q, u)."""
    k, m, force = coordinate.stiffness, coordinate.mass, steady_force(coordinate, grip)
    if k == 0.0:
        pull = force / m
        first, second = _phi(coordinate.viscous * t / m)
        return q + t * (u * first + pull * t * second), u * math.exp(-coordinate.viscous * t / m) + pull * t * first
    decay = 0.5 * coordinate.viscous / m
    square = k / m - decay * decay
    if square > 0.0:
        rate = math.sqrt(square)
        cosine, sine = math.cos(rate * t), math.sin(rate * t) / rate
    elif square < 0.0:
        rate = math.sqrt(-square)
        cosine, sine = math.cosh(rate * t), math.sinh(rate * t) / rate
    else:
        cosine, sine = 1.0, t
    fade = math.exp(-decay * t)
    middle = coordinate.rest + force / k
    x = q - middle
    return middle + fade * (x * cosine + (u + decay * x) * sine), fade * (u * cosine - (k / m * x + decay * u) * sine)


@kernel
def acceleration(coordinate, grip, q, u):
    """q'' at (q, u)."""
    pull = steady_force(coordinate, grip) - coordinate.viscous * u - coordinate.stiffness * (q - coordinate.rest)
    return pull / coordinate.mass


@kernel
def acceleration_bound(coordinate, grip, q, u):
    """A bound of |q''| for all later times of the flight.

    q'' obeys the same linear equation without force, so its energy-like norm never grows:
    q''² + (m/k) q'''² k/m ≤ its start value, with q''' = -(c q'' + k u)/m.
    """
    a = acceleration(coordinate, grip, q, u)
    if coordinate.stiffness == 0.0:
        return abs(a)
    jerk = -(coordinate.viscous * a + coordinate.stiffness * u) / coordinate.mass
    return math.sqrt(a * a + jerk * jerk * coordinate.mass / coordinate.stiffness)


@kernel
def fastest_change(coordinate):
    """What `acceleration_bound` times this bounds: the rate of change of the acceleration. 1/s."""
    if coordinate.stiffness == 0.0:
        return coordinate.viscous / coordinate.mass
    return math.sqrt(coordinate.stiffness / coordinate.mass)


@kernel
def quarter_period(coordinate):
    """A quarter of the undamped period; infinity without a spring."""
    if coordinate.stiffness == 0.0:
        return math.inf
    return 0.5 * math.pi * math.sqrt(coordinate.mass / coordinate.stiffness)


@kernel
def turning_time(coordinate, grip, q, u):
    """The first time after the start of a flight from (q, u) at which the velocity vanishes; infinity if it never does."""
    k, m = coordinate.stiffness, coordinate.mass
    if k == 0.0:
        pull = steady_force(coordinate, grip)
        if not u * pull < 0.0:
            return math.inf
        share = -coordinate.viscous * u / pull
        return m / coordinate.viscous * math.log1p(share) if coordinate.viscous > 0.0 else -m * u / pull
    # exp(decay t) u(t) = u cos(w t) + slope sin(w t) / w, w imaginary where damping is strong.
    decay = 0.5 * coordinate.viscous / m
    square = k / m - decay * decay
    slope = acceleration(coordinate, grip, q, u) + decay * u
    if square > 0.0:
        rate = math.sqrt(square)
        if u == 0.0:
            return math.pi / rate
        side = 1.0 if u > 0.0 else -1.0
        return math.atan2(side * u, -side * slope / rate) / rate
    if not u * slope < 0.0:
        return math.inf
    rate = math.sqrt(-square)
    if rate == 0.0:
        return -u / slope
    share = -u * rate / slope
    return math.atanh(share) / rate if share < 1.0 else math.inf


# Where is everything at a time within the current step?
#
# In a coupled step: the continuous extension, a polynomial of degree 7 in the share x of the step that has passed (Hairer,
# Noersett & Wanner 1993, II.6). In a flight: the closed form.


@kernel
def dense(step, i, tau):
    """Component i of y, and its time derivative, at time tau after the start of a coupled step."""
    h, d = step.span.length, step.dense
    x = tau / h
    w = 1.0 - x
    value, slope = d[5, i] + x * d[6, i], d[6, i]
    value, slope = d[4, i] + w * value, w * slope - value
    value, slope = d[3, i] + x * value, x * slope + value
    value, slope = d[2, i] + w * value, w * slope - value
    value, slope = d[1, i] + x * value, x * slope + value
    value, slope = d[0, i] + w * value, w * slope - value
    return step.y0[i] + x * value, (x * slope + value) / h


@kernel
def dense_bend(step, i, tau):
    """Second time derivative of component i of y at time tau after the start of a coupled step."""
    h, d = step.span.length, step.dense
    x = tau / h
    w = 1.0 - x
    value, slope, bend = d[5, i] + x * d[6, i], d[6, i], 0.0
    for term in range(4, -1, -1):  # what is nested in `dense`, times w and x in turn
        share, way = (w, -1.0) if term % 2 == 0 else (x, 1.0)
        value, slope, bend = d[term, i] + share * value, share * slope + way * value, share * bend + 2.0 * way * slope
    return (x * bend + 2.0 * slope) / (h * h)


@kernel
def dense_value(step, i, tau):
    """Component i of y alone."""
    return dense(step, i, tau)[0]


@hot_kernel
def coordinate_within(model, step, i, tau):
    """Coordinate i and its velocity at time tau after the start of the step."""
    if step.span.kind == FLIGHT:
        if step.awake[i] == 0:
            return step.q[i], 0.0
        return flow(model.coordinates[i], step.grip[i], step.q[i], step.u[i], tau)
    n = len(model.coordinates)
    return dense_value(step, i, tau), dense_value(step, n + i, tau)


@kernel
def flight_acceleration(model, step, i, q, u):
    """q'' of coordinate i during a flight."""
    return acceleration(model.coordinates[i], step.grip[i], q, u) if step.awake[i] else 0.0


# How does an exact flight go: how long, with which work and losses, and with which rows?
#
# Where no contact couples the moving bodies, each coordinate follows its own closed form (see `free`) up to the next event.

# Gauss-Legendre nodes and weights on [0, 1]: damping losses of a flight of at most a quarter period, to rounding.
_NODES = (0.019855071751231856, 0.10166676129318664, 0.2372337950418355, 0.4082826787521751)
_WEIGHTS = (0.05061426814518813, 0.11119051722668724, 0.15685332293894363, 0.18134189168918099)


@kernel
def can_fly(model, awake, awake_contacts):
    """True if no contact is in force between awake bodies and all awake coordinates have exact solutions."""
    if awake_contacts > 0:
        return False
    for i in range(len(model.coordinates)):
        if awake[i] and not model.coordinates[i].linear:
            return False
    return True


@kernel
def _row_spacing(model, options, i):
    """Longest time between rows for coordinate i in flight: its own time scale."""
    coordinate = model.coordinates[i]
    spacing = math.inf
    if coordinate.stiffness > 0.0:
        spacing = options.row_phase * math.sqrt(coordinate.mass / coordinate.stiffness)
    if coordinate.viscous > 0.0:
        spacing = min(spacing, options.row_phase * coordinate.mass / coordinate.viscous)
    return spacing


@kernel
def _time_far(coordinate, grip, q, u):
    """A time (s) in which the coordinate goes no further than `FLIGHT_SIZES` times the scene's size.

    What falls with 1e30 m/s² would be looked for in 1e27 places along one step.
    """
    far = FLIGHT_SIZES * coordinate.scale
    speed, bound = abs(u), acceleration_bound(coordinate, grip, q, u)
    both = speed + math.sqrt(speed * speed + 2.0 * bound * far)
    return 2.0 * far / both if both > 0.0 else math.inf


@kernel
def flight_length(model, regime, q, u, options, time):
    """(length, row spacing): of an exact flight now."""
    length, spacing = longest_step(options, time), math.inf
    for i in range(len(model.coordinates)):
        if regime.awake[i]:
            far = _time_far(model.coordinates[i], regime.grip[i], q[i], u[i])
            length = min(length, quarter_period(model.coordinates[i]), far)
            spacing = min(spacing, _row_spacing(model, options, i))
    return min(length, FLIGHT_PHASE / options.row_phase * spacing), spacing


@kernel
def begin_flight(model, regime, q, u, time, length, out_step):
    """Make the current step an exact flight of all awake coordinates; dry friction may hold the shaft of a loose body."""
    step = out_step
    step.span.kind = FLIGHT
    step.span.start, step.span.length = time, length
    for i in range(len(model.coordinates)):
        step.q[i], step.u[i], step.grip[i] = q[i], u[i], regime.grip[i]
        step.awake[i] = 0 if regime.grip[i] == STICK else regime.awake[i]
        step.bound[i] = 0.0
        if step.awake[i]:
            step.bound[i] = acceleration_bound(model.coordinates[i], regime.grip[i], q[i], u[i])


@kernel
def add_flight_sums(model, step, end, out_sums):
    """Work in and damping losses of the first `end` seconds of a flight."""
    for i in range(len(model.coordinates)):
        coordinate = model.coordinates[i]
        if not step.awake[i] or coordinate.driven:
            continue
        out_sums.drive += coordinate.force * (coordinate_within(model, step, i, end)[0] - step.q[i])
        if coordinate.coulomb > 0.0:
            out_sums.damping += coordinate.coulomb * abs(coordinate_within(model, step, i, end)[0] - step.q[i])
        if coordinate.viscous == 0.0:
            continue
        total = 0.0
        for j in range(4):
            first = coordinate_within(model, step, i, end * _NODES[j])[1]
            last = coordinate_within(model, step, i, end * (1.0 - _NODES[j]))[1]
            total += _WEIGHTS[j] * (first * first + last * last)
        out_sums.damping += coordinate.viscous * end * total


@kernel
def keep_flight_rows(model, end, spacing, step, record, out_q, out_u, out_a):
    """Rows of a flight, evenly spaced, the last one at its end, where q, u and a are left."""
    n = len(model.coordinates)
    rows = 1 if spacing == math.inf or not is_kept(record, step.span.start, end) else max(1, math.ceil(end / spacing))
    for row in range(1, rows + 1):
        tau = end * row / rows if row < rows else end
        for i in range(n):
            out_q[i], out_u[i] = coordinate_within(model, step, i, tau)
            out_a[i] = flight_acceleration(model, step, i, out_q[i], out_u[i])
        keep_row(record, step.span.start + tau, out_q, out_u, out_a)


# When did a sprung body turn back, and when did it pass its rest position?


@kernel
def _seen(model, step, i, on, tau):
    """Coordinate i and its velocity at time tau of the step; against coordinate `on` if that is not -1."""
    q, u = coordinate_within(model, step, i, tau)
    if on >= 0:
        there, speed = coordinate_within(model, step, on, tau)
        return q - there, u - speed
    return q, u


@kernel
def _value(model, step, spring, turn, tau):
    i, on, rest = spring
    q, u = _seen(model, step, i, on, tau)
    return u if turn else q - rest


@kernel
def _root(model, step, spring, turn, end):
    """Time in [0, end] at which the velocity (turn) or the distance from rest changes sign."""
    f_low, f_high = _value(model, step, spring, turn, 0.0), _value(model, step, spring, turn, end)
    if f_low == 0.0 or f_low * f_high > 0.0:
        return 0.0
    bracket = opened(0.0, f_low, end, f_high)
    tau = next_time(bracket)
    while is_open(bracket, tau, PASSAGE_RESOLUTION * (step.span.start + bracket.high)):
        f = _value(model, step, spring, turn, tau)
        bracket = narrowed(bracket, tau, f, f * bracket.f_high > 0.0)
        if f == 0.0:
            break
        tau = next_time(bracket)
    return bracket.low if abs(bracket.f_low) < abs(bracket.f_high) else bracket.high


@kernel
def sign(x):
    """-1, 0 or 1."""
    if x > 0.0:
        return 1
    return -1 if x < 0.0 else 0


@kernel
def turning_side(u, coordinate, options):
    """The sign of a velocity; 0 where it counts as none: what rests does not turn."""
    return sign(u) if abs(u) * options.size > options.speed_zero * coordinate.scale else 0


@kernel
def keep_passages(model, state, options, step, end, record):
    """Write down the turning points and rest passages of sprung bodies in the step's first `end` seconds.

    The state's q and u are those at the end; `end` 0 means a jump of velocity at one instant.
    """
    now, n = state.clock.time, len(model.coordinates)
    for spring in range(n + len(model.joints)):
        if spring < n:
            if model.coordinates[spring].watched == 0:
                continue
            i, on, rest = spring, -1, model.coordinates[spring].level
        else:
            joint = model.joints[spring - n]
            if joint.watched == 0:
                continue
            i, on, rest = joint.coordinate, joint.on, joint.rest
        side = turning_side(along(state.u, i, on), model.coordinates[i], options)
        if side != 0 and side != state.side_u[i]:
            if state.side_u[i] != 0:
                tau = _root(model, step, (i, on, rest), True, end) if end > 0.0 else 0.0
                q = _seen(model, step, i, on, tau)[0] if end > 0.0 else along(state.q, i, on)
                state.clock.time = now - end + tau
                keep_event(record, state.clock, state.counts, EventKind.TURN, -1, model.coordinates[i].body, q)
            state.side_u[i] = side
        side = sign(along(state.q, i, on) - rest)
        if side != 0 and side != state.side_q[i]:
            if state.side_q[i] != 0 and end > 0.0:
                tau = _root(model, step, (i, on, rest), False, end)
                state.clock.time = now - end + tau
                speed = _seen(model, step, i, on, tau)[1]
                keep_event(record, state.clock, state.counts, EventKind.CROSS, -1, model.coordinates[i].body, speed)
            state.side_q[i] = side
        state.clock.time = now


# Which rows does a coupled step need, so that the motion within it can be interpolated from them?
#
# Between rows the motion is taken for polynomials through q, u and a at both ends (see `Trajectory.sample`). Where these stray
# from the step's continuous extension by more than the tolerance, rows are put between, as many as it takes: the error of
# positions goes with the 6th power of the distance of rows, that of velocities with the 4th.

MOST_ROWS = 64


@kernel
def _pieces(model, options, end, step):
    """Into how many equal parts the step's first `end` seconds must be cut."""
    n = len(model.coordinates)
    most = 1.0
    for i in range(n):
        q0, u0, a0 = step.q[i], end * step.u[i], end * end * step.stages[0, n + i]
        speed, rate = dense(step, n + i, end)
        q1, u1, a1 = dense_value(step, i, end), end * speed, end * end * rate
        q = 0.5 * (q0 + q1) + 0.15625 * (u0 - u1) + 0.015625 * (a0 + a1)
        u = (0.5 * (u0 + u1) + 0.125 * (a0 - a1)) / end
        middle = dense_value(step, n + i, 0.5 * end)
        coordinate = model.coordinates[i]
        strays = abs(q - dense_value(step, i, 0.5 * end)) / (options.tolerance * coordinate.scale)
        off = abs(u - middle) / (options.tolerance * max(coordinate.scale * coordinate.rate, abs(middle)))
        most = max(most, strays ** (1.0 / 6.0), off**0.25)
    return int(min(math.ceil(most), MOST_ROWS))


@kernel
def keep_inner_rows(model, options, end, step, record):
    """Append the rows needed within the first `end` seconds of the coupled step just made, but not the one at their end."""
    if end <= 0.0 or not is_kept(record, step.span.start, end):
        return
    n = len(model.coordinates)
    pieces = _pieces(model, options, end, step)
    for piece in range(1, pieces):
        tau = end * piece / pieces
        if not is_kept(record, step.span.start + tau, 0.0):
            continue
        row = record.used.rows
        record.rows[row, 0] = step.span.start + tau
        for i in range(2 * n):
            record.rows[row, 1 + i] = dense_value(step, i, tau)
        for i in range(n):
            record.rows[row, 1 + 2 * n + i] = dense(step, n + i, tau)[1]
        record.used.rows = row + 1


DEGREE = 7
# The continuous extension is y0 + sum of dense[t] x^a (1 - x)^b, with these exponents (a, b).
TERMS = ((1, 0), (1, 1), (2, 1), (2, 2), (3, 2), (3, 3), (4, 3))


def _derivative(order: int) -> NDArray[np.float64]:
    """Bernstein coefficients, by row, of that derivative of each term, by the definition of the basis."""
    terms = np.array(
        [
            [math.comb(DEGREE - a - b, k - a) / math.comb(DEGREE, k) if k >= a else 0.0 for a, b in TERMS]
            for k in range(DEGREE + 1)
        ]
    )
    return np.asarray(math.perm(DEGREE, order) * np.diff(terms, n=order, axis=0))


BEND, JERK = _derivative(2), _derivative(3)


@kernel
def bound_accelerations(step, n):
    """Bounds of |q''| over the coupled step, for its n coordinates, into `step.bound`."""
    h = step.span.length
    for i in range(n):
        step.bound[i] = _largest_coefficient(BEND, step.dense, i) / (h * h)


@kernel
def jerk_bound(model, step, i):
    """A bound of |q'''| of coordinate i over the step."""
    if step.awake[i] == 0:
        return 0.0
    if step.span.kind == FLIGHT:
        return step.bound[i] * fastest_change(model.coordinates[i])
    h = step.span.length
    return _largest_coefficient(JERK, step.dense, i) / (h * h * h)


@kernel
def _largest_coefficient(derivative, dense, i):
    """The largest Bernstein coefficient of that derivative of coordinate i, which no value of the polynomial exceeds."""
    largest = 0.0
    for row in range(len(derivative)):
        total = 0.0
        for term in range(DEGREE):
            total += derivative[row, term] * dense[term, i]
        largest = max(largest, abs(total))
    return largest


@kernel
def acceleration_on_path(model, step, i, tau, path):
    """q'' of coordinate i at time tau of the step, at which it must stand in `path`."""
    if step.awake[i] == 0:
        return 0.0
    if step.span.kind == FLIGHT:
        return flight_acceleration(model, step, i, path.q[i], path.u[i])
    return dense_bend(step, i, tau)


@hot_kernel
def body_on_path(model, step, b, tau, path):
    """Bring body b's coordinates (in `path.q`, `path.u`) and pose to time tau of the step; u is exactly q'."""
    part = b
    while part >= 0:  # the body, then its carrier
        body = model.bodies[part]
        part = body.carrier
        if body.first < 0:
            continue
        for j in range(3 if body.motion == FREE else 1):
            i = body.first + j
            if step.awake[i] == 0:
                path.q[i], path.u[i] = step.q[i], 0.0
            elif step.span.kind == FLIGHT:
                path.q[i], path.u[i] = flow(model.coordinates[i], step.grip[i], step.q[i], step.u[i], tau)
            else:
                path.q[i], path.u[i] = dense(step, i, tau)
    place_body(model, b, path.q, path.u, path.pose)
