"""Where is a disc that bounces down an incline, in closed form?

A disc (radius R, mass m, inertia mR²/2) falls from a normal height h on a plane inclined by `slope`; Coulomb friction mu,
Poisson restitution e; one point of contact, so Newton's and Poisson's laws agree. Everything but the flights is
algebra: with normal impulse m(1+e)v the slip s = x' - R spin drops by at most 3 mu (1+e) v, else it sticks.
Flights shrink by the factor e and end at t1 (1+e)/(1-e); there rolling or sliding begins. Evaluated with mpmath (60 digits).
"""

from dataclasses import dataclass

from mpmath import mp, mpf

mp.dps = 60
RADIUS, HEIGHT, RESTITUTION, GRAVITY, SLOPE_DEG = mpf("0.05"), mpf("0.1"), mpf("0.5"), mpf("9.81"), mpf(20)
BOUNCES = 260  # 0.5**260 = 5e-79: nothing is left of the bouncing


@dataclass(frozen=True)
class State:
    """Time (s), place along the plane (m), angle in the sense of rolling (rad), speed (m/s), spin (rad/s)."""

    t: mpf
    x: mpf
    theta: mpf
    v: mpf
    spin: mpf


def gravity() -> tuple[mpf, mpf]:
    """Components along and into the plane, m/s²."""
    slope = SLOPE_DEG * mp.pi / 180
    return GRAVITY * mp.sin(slope), GRAVITY * mp.cos(slope)


def first_impact() -> mpf:
    """Time of the first touch, s."""
    return mp.sqrt(2 * HEIGHT / gravity()[1])


def accumulation() -> mpf:
    """Time at which the bounces have died out, s."""
    return first_impact() * (1 + RESTITUTION) / (1 - RESTITUTION)


def flight(state: State, duration: mpf) -> State:
    """Free motion: the plane's component of gravity, constant spin."""
    pull = gravity()[0]
    x = state.x + state.v * duration + pull * duration**2 / 2
    return State(state.t + duration, x, state.theta + state.spin * duration, state.v + pull * duration, state.spin)


def impact(state: State, speed: mpf, mu: mpf) -> State:
    """After a touch with normal speed `speed`: friction takes the slip down by at most 3 mu (1+e) speed."""
    slip = state.v - RADIUS * state.spin
    taken = min(slip, 3 * mu * (1 + RESTITUTION) * speed)
    return State(state.t, state.x, state.theta, state.v - taken / 3, state.spin + 2 * taken / (3 * RADIUS))


def contact(state: State, duration: mpf, mu: mpf) -> State:
    """Sliding until the slip is gone, then rolling (or sliding for ever where the friction is too small)."""
    sliding = min(duration, rolling_begins(state, mu) - state.t)
    pull, press = gravity()
    slide = _uniform(state, sliding, pull - mu * press, 2 * mu * press / RADIUS)
    return _uniform(slide, duration - sliding, 2 * pull / 3, 2 * pull / (3 * RADIUS))


def rolling_begins(state: State, mu: mpf) -> mpf:
    """Time at which the slip of a disc resting on the plane vanishes; infinite where it never does."""
    pull, press = gravity()
    slip = state.v - RADIUS * state.spin
    decay = 3 * mu * press - pull
    if abs(slip) < mpf(10) ** -50:
        return state.t
    return state.t + slip / decay if decay > 0 else mp.inf


def settled(mu: mpf) -> State:
    """The state at the accumulation time."""
    return _bounce(mu, None)


def reference(t: str, mu: str) -> State:
    """The state at time `t` for friction `mu` (decimal strings, so that nothing is lost)."""
    if mpf(t) < accumulation():
        return _bounce(mpf(mu), mpf(t))
    start = settled(mpf(mu))
    return contact(start, mpf(t) - start.t, mpf(mu))


def _bounce(mu: mpf, until: mpf | None) -> State:
    duration = first_impact()
    state = State(mpf(0), mpf(0), mpf(0), mpf(0), mpf(0))
    speed = gravity()[1] * duration
    for _ in range(BOUNCES):
        if until is not None and state.t + duration > until:
            return flight(state, until - state.t)
        state = impact(flight(state, duration), speed, mu)
        speed *= RESTITUTION
        duration = 2 * speed / gravity()[1]
    return state


def _uniform(state: State, duration: mpf, acceleration: mpf, spin_up: mpf) -> State:
    x = state.x + state.v * duration + acceleration * duration**2 / 2
    theta = state.theta + state.spin * duration + spin_up * duration**2 / 2
    return State(state.t + duration, x, theta, state.v + acceleration * duration, state.spin + spin_up * duration)
