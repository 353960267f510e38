"""Along which path do bodies move within a step, and how sharply can it bend?

In a coupled step the motion is the continuous extension: a polynomial of degree 7 in the time of the step. Its velocity is
the derivative of that polynomial, and its acceleration is bounded by the Bernstein coefficients of the second derivative.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from watchsim.contact.poses import place_body
from watchsim.jit import hot_kernel, kernel
from watchsim.model.records import FREE
from watchsim.simulation.loop_state.scratch import FLIGHT
from watchsim.simulation.motion.dense_output import dense, dense_bend, flight_acceleration
from watchsim.simulation.motion.free_motion import fastest_change, flow

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
def jerk_bound(model, state, step, i):
    """A bound of |q'''| of coordinate i over the step."""
    if state.awake[i] == 0:
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
def acceleration_on_path(model, state, step, i, tau, path):
    """q'' of coordinate i at time tau of the step, at which it must stand in `path`."""
    if state.awake[i] == 0:
        return 0.0
    if step.span.kind == FLIGHT:
        return flight_acceleration(model, state, i, path.q[i], path.u[i])
    return dense_bend(step, i, tau)


@hot_kernel
def body_on_path(model, state, step, b, tau, path):
    """Bring body b's coordinates (in `path.q`, `path.u`) and pose to time tau of the step; u is exactly q'."""
    part = b
    while part >= 0:  # the body, then its carrier
        body = model.bodies[part]
        part = body.carrier
        if body.first < 0:
            continue
        for j in range(3 if body.motion == FREE else 1):
            i = body.first + j
            if state.awake[i] == 0:
                path.q[i], path.u[i] = state.q[i], 0.0
            elif step.span.kind == FLIGHT:
                path.q[i], path.u[i] = flow(model.coordinates[i], state.grip[i], step.q[i], step.u[i], tau)
            else:
                path.q[i], path.u[i] = dense(step, i, tau)
    place_body(model, b, path.q, path.u, path.pose)
