"""How do a sliding bar with a kink and a round follower on it move, by the laws of contact alone?

The bar slides along x, the follower swings about a pivot to its left: two coordinates, (s, theta). The bar's top is level up to
the kink, rises (concave) or falls (convex) by its angle. At a concave kink one contact is hit while the other leaves, so the
impact is that of a single contact, in closed form; rebounds are flights on parabolas, and while the follower rides on a line or
on the corner, one equation holds for the contact force. Nothing of the package is used.
"""

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, linprog

Vector = NDArray[np.float64]
SHORT = 1e-7  # s: rebounds that last less are over


class BeyondClosedFormError(Exception):
    """The motion goes on in a way that is not written down here (slip that reverses, a contact that opens)."""


@dataclass(frozen=True)
class Bar:
    """SI units; `kink` > 0 is concave, < 0 convex."""

    kink: float
    friction: float = 0.0
    restitution: float = 0.0
    mass: float = 0.1
    inertia: float = 1e-5
    torque: float = -1e-3
    speed: float = -0.1
    arm: float = 0.03
    radius: float = 3e-3
    ahead: float = 0.01  # m, how far the kink is ahead of the follower at the start


@dataclass(frozen=True)
class Motion:
    """Time and state (s, theta, their rates) when the kink is met, right after it, and at the end.

    `after` is None without an impact, `end` where the motion after it goes on beyond the closed forms. `is_open`: the laws
    allow other motions after the impact, see `obeys_laws`.
    """

    met: float
    before: Vector
    after: Vector | None
    end: Vector | None
    is_open: bool = False


class _Surface:
    """Gap and force directions of the follower against a line (angle) or the corner (None)."""

    def __init__(self, bar: Bar, angle: float | None) -> None:
        self.bar, self.angle = bar, angle

    def at(self, x: Vector) -> tuple[float, Vector, Vector, float]:
        """Gap, w_N, w_T and the part of the gap's second derivative that is not from accelerations."""
        bar, (s, theta, ds, dtheta) = self.bar, x
        reach = bar.arm * np.array([math.cos(theta), math.sin(theta)])
        d = reach - np.array([bar.arm + bar.ahead + s, -bar.radius])
        d_dot = dtheta * np.array([-reach[1], reach[0]]) - np.array([ds, 0.0])
        if self.angle is None:
            away = math.hypot(d[0], d[1])
            n, gap = d / away, away - bar.radius
        else:
            n = np.array([-math.sin(self.angle), math.cos(self.angle)])
            gap = float(n @ d) - bar.radius
        t = np.array([-n[1], n[0]])
        foot = reach - bar.radius * n
        w_n = np.array([-n[0], n[1] * reach[0] - n[0] * reach[1]])
        w_t = np.array([-t[0], t[1] * foot[0] - t[0] * foot[1]])
        curved = 0.0 if self.angle is not None else float(t @ d_dot) ** 2 / math.hypot(d[0], d[1])
        return gap, w_n, w_t, curved - dtheta**2 * float(n @ reach)


def _inverse(bar: Bar) -> Vector:
    return np.array([1.0 / bar.mass, 1.0 / bar.inertia])


def _rates(surface: _Surface, x: Vector) -> Vector:
    """Derivative of the state while the follower slides on the surface."""
    bar, inverse = surface.bar, _inverse(surface.bar)
    _, w_n, w_t, bend = surface.at(x)
    slip = float(w_t @ x[2:])
    force = w_n - bar.friction * math.copysign(1.0, slip) * w_t
    free = inverse * np.array([0.0, bar.torque])
    load = -(float(w_n @ free) + bend) / float(w_n @ (inverse * force))
    if load < 0.0:
        raise BeyondClosedFormError("the contact opens")
    if bar.friction > 0.0 and abs(slip) < 1e-9:
        raise BeyondClosedFormError("slip reverses")
    return np.concatenate([x[2:], free + inverse * force * load])


def _ride(surface: _Surface, x: Vector, span: float, until: Any) -> tuple[float, Vector]:
    """Slide for at most `span`, or to the first zero of `until(state)`; the time taken and the state."""
    if until is not None and until(x) <= 0.0:
        return 0.0, x
    made = solve_ivp(
        lambda _, y: _rates(surface, y),
        (0.0, span),
        x,
        method="DOP853",
        rtol=1e-12,
        atol=1e-15,
        dense_output=True,
        max_step=0.02,
    )
    if until is None or until(made.y[:, -1]) > 0.0:
        return span, made.y[:, -1]
    time = float(brentq(lambda t: until(made.sol(t)), 0.0, span, xtol=1e-16, rtol=1e-15))
    return time, made.sol(time)


def single_impact(bar: Bar, surface: _Surface, x: Vector) -> Vector:
    """State after the impact of one contact: Poisson's law in two phases, Coulomb's law for friction in both."""
    inverse = _inverse(bar)
    _, w_n, w_t, _ = surface.at(x)
    nn, nt, tt = float(w_n @ (inverse * w_n)), float(w_n @ (inverse * w_t)), float(w_t @ (inverse * w_t))
    rate, slip, mu = float(w_n @ x[2:]), float(w_t @ x[2:]), bar.friction
    if mu == 0.0:
        normal, tangential = -(1.0 + bar.restitution) * rate / nn, 0.0
    else:
        normal, tangential = _compressed(rate, slip, nn, nt, tt, mu)
        more = bar.restitution * normal
        for side in (1.0, -1.0):  # expansion: friction at a bound that its slip keeps to, or none of both: it sticks
            end = slip + nt * (normal + more) + tt * (tangential - side * mu * more)
            if side * end > 1e-15:
                normal, tangential = normal + more, tangential - side * mu * more
                break
        else:
            normal, tangential = normal + more, -(slip + nt * (normal + more)) / tt
    u = x[2:] + inverse * (w_n * normal + w_t * tangential)
    return np.concatenate([x[:2], u])


def _compressed(rate: float, slip: float, nn: float, nt: float, tt: float, mu: float) -> tuple[float, float]:
    """Impulses after which nothing approaches: sliding to one side or the other, or stuck."""
    for side in (1.0, -1.0):
        mobility = nn - side * mu * nt
        if mobility <= 0.0:
            continue
        normal = -rate / mobility
        if side * (slip + (nt - side * mu * tt) * normal) > 1e-15:
            return normal, -side * mu * normal
    normal, tangential = np.linalg.solve(np.array([[nn, nt], [nt, tt]]), [-rate, -slip])
    return float(normal), float(tangential)


def _splits(bar: Bar, x: Vector) -> tuple[Any, Any, Any]:
    """(A, b, columns): impulses (N, T of the level, N, T of the ramp) that friction allows, A Λ <= b, and what they do to u."""
    inverse = _inverse(bar)
    columns = [inverse * w for angle in (0.0, bar.kink) for w in _Surface(bar, angle).at(x)[1:3]]
    mu = bar.friction
    cone = np.array([[-mu, 1.0], [-mu, -1.0]])
    zero = np.zeros((2, 2))
    return np.block([[cone, zero], [zero, cone]]), np.zeros(4), np.array(columns).T


def is_open(bar: Bar, x: Vector) -> bool:
    """Do the laws leave open which contact takes how much of the compression?

    Where everything stands still at its end, both contacts may have pressed, stuck, in any split that stops both bodies.
    """
    ramp = _Surface(bar, bar.kink)
    if np.abs(single_impact(replace(bar, restitution=0.0), ramp, x)[2:] * [1.0, bar.arm]).max() > 1e-9 * abs(bar.speed):
        return False
    cones, bounds, columns = _splits(bar, x)
    scale = bar.mass * abs(bar.speed)
    sides = [(0.0, None), (None, None)] * 2
    most = linprog([-1.0, 0.0, 0.0, 0.0], cones, bounds, columns * scale, -x[2:], sides)
    return bool(most.status == 0 and most.x[0] > 1e-6)


def obeys_laws(bar: Bar, x: Vector, after: Vector) -> bool:
    """Is there a split of the compression that stops both bodies, and an expansion, that lead from the state x to `after`?

    The expansion returns the share eps, more only at a contact that stays closed; both lie within the cones of friction, the
    expansion of what slides at their bounds.
    """
    cones, bounds, columns = _splits(bar, x)
    nothing, columns, still = np.zeros_like(cones), columns * bar.mass * abs(bar.speed), 1e-9 * abs(bar.speed)
    less, same = [], []
    for contact, angle in enumerate((0.0, bar.kink)):
        N, T = 2 * contact, 2 * contact + 1
        _, w_n, w_t, _ = _Surface(bar, angle).at(x)
        rate, slip = float(w_n @ after[2:]), float(w_t @ after[2:])
        if rate < -still:
            return False
        returned = np.zeros(8)
        returned[N], returned[4 + N] = bar.restitution, -1.0
        (same if rate > still else less).append(returned)
        if abs(slip) > still:
            slides = np.zeros(8)
            slides[4 + N], slides[4 + T] = math.copysign(bar.friction, slip), 1.0
            same.append(slides)
    motion_of = np.block([[columns, np.zeros_like(columns)], [columns, columns]])
    found = linprog(
        np.zeros(8),
        np.vstack([np.block([[cones, nothing], [nothing, cones]]), *less]),
        np.concatenate([bounds, bounds, np.zeros(len(less))]),
        np.vstack([motion_of, *same]),
        np.concatenate([-x[2:], after[2:] - x[2:], np.zeros(len(same))]),
        [(0.0, None), (None, None)] * 4,
    )
    return bool(found.status == 0)


def _bounce(bar: Bar, surface: _Surface, x: Vector, span: float) -> tuple[float, Vector]:
    """From right after an impact: flights and impacts until the follower rides; time taken and state."""
    spent, pull = 0.0, bar.torque / bar.inertia
    while True:
        _, w_n, _, bend = surface.at(x)
        rate, closing = float(w_n @ x[2:]), -(w_n[1] * pull + bend)
        time = 2.0 * max(rate, 0.0) / closing if closing > 0.0 else span
        if time < SHORT:
            return spent, _ended(surface, x)
        start = x

        def flown(t: float, start: Vector = start) -> Vector:
            s, theta, ds, dtheta = start
            return np.array([s + ds * t, theta + dtheta * t + 0.5 * pull * t * t, ds, dtheta + pull * t])

        if surface.at(flown(span - spent))[0] > 0.0:
            return span, flown(span - spent)
        late = 1.1 * time
        while surface.at(flown(late))[0] > 0.0:
            late *= 1.5
        time = float(brentq(lambda t: surface.at(flown(t))[0], 0.5 * time, late, xtol=1e-17, rtol=1e-15))
        spent, x = spent + time, single_impact(bar, surface, flown(time))


def _ended(surface: _Surface, x: Vector) -> Vector:
    """The state without the rest of its gap rate.

    What is left to rebound takes the time T, in which the contact gives the momentum of the rate less than the load would in
    T. To ride on at once, with the load, that momentum is taken away, with its friction.
    """
    inverse = _inverse(surface.bar)
    _, w_n, w_t, _ = surface.at(x)
    force = w_n - surface.bar.friction * math.copysign(1.0, float(w_t @ x[2:])) * w_t
    return np.concatenate([x[:2], x[2:] - inverse * force * float(w_n @ x[2:]) / float(w_n @ (inverse * force))])


def _past_concave(bar: Bar, after: Vector, span: float) -> Vector | None:
    ramp = _Surface(bar, bar.kink)
    if float(_Surface(bar, 0.0).at(after)[1] @ after[2:]) < 1e-3 * abs(bar.speed) * math.sin(bar.kink):
        return None  # the level contact is not lifted, so it stays
    try:
        spent, x = _bounce(bar, ramp, after, span)
        end = _ride(ramp, x, span - spent, None)[1] if spent < span else x
    except BeyondClosedFormError:
        return None
    return end if end[1] > 0.0 else None  # the follower has fallen back on the level


def _past_convex(bar: Bar, x: Vector, span: float) -> Vector:
    along = np.array([math.cos(bar.kink), math.sin(bar.kink)])

    def ahead(y: Vector) -> float:
        reach = bar.arm * np.array([math.cos(y[1]), math.sin(y[1])])
        return -float(along @ (reach - np.array([bar.arm + bar.ahead + y[0], -bar.radius])))

    spent, x = _ride(_Surface(bar, None), x, span, ahead)
    if spent < span:
        _, x = _ride(_Surface(bar, bar.kink), x, span - spent, None)
    return x


def motion(bar: Bar, beyond: float) -> Motion:
    """From the start on the level top to `beyond` seconds after the kink is met."""
    x = np.array([0.0, 0.0, bar.speed, 0.0])
    kink = _Surface(bar, bar.kink)
    met = (lambda y: kink.at(y)[0]) if bar.kink > 0.0 else (lambda y: bar.ahead + y[0])
    # The gap to a nearly level ramp is d times the way: it is scaled to the way.
    scale = math.sin(bar.kink) if bar.kink > 0.0 else 1.0
    time, x = _ride(_Surface(bar, 0.0), x, 2.0 * bar.ahead / abs(bar.speed), lambda y: met(y) / scale)
    x[1], x[3] = 0.0, 0.0
    if bar.kink > 0.0:
        after = single_impact(bar, kink, x)
        if is_open(bar, x):
            return Motion(time, x, after, None, is_open=True)
        return Motion(time, x, after, _past_concave(bar, after, beyond))
    return Motion(time, x, None, _past_convex(bar, x, beyond))
