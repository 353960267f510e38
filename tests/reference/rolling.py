"""How does a disc on an incline move that starts with slip? It slides until the slip is gone, then rolls."""

import math
from typing import NamedTuple


class Rolling(NamedTuple):
    """Way downhill (m), angle in the sense of rolling downhill (rad), their rates."""

    x: float
    angle: float
    v: float
    spin: float


class Disc(NamedTuple):
    """`kappa` is inertia over mass times radius squared; slope in radians."""

    radius: float
    mu: float
    slope: float = 0.0
    kappa: float = 0.5
    gravity: float = 9.81


def motion(disc: Disc, v0: float, spin0: float, t: float) -> Rolling:
    """State at time t; the disc is in contact throughout."""
    pull, press = disc.gravity * math.sin(disc.slope), disc.gravity * math.cos(disc.slope)
    side = math.copysign(1.0, v0 - disc.radius * spin0) if v0 != disc.radius * spin0 else 0.0
    grip = side * disc.mu * press
    start = Rolling(0.0, 0.0, v0, spin0)
    sliding = min(t, slip_ends(disc, v0, spin0))
    state = _uniform(start, sliding, pull - grip, grip / (disc.kappa * disc.radius))
    if sliding >= t:
        return state
    rolling = pull / (1.0 + disc.kappa)
    if abs(pull - rolling) > disc.mu * press:  # friction cannot hold: it slides downhill from here on
        return _uniform(state, t - sliding, pull - disc.mu * press, disc.mu * press / (disc.kappa * disc.radius))
    return _uniform(state, t - sliding, rolling, rolling / disc.radius)


def slip_ends(disc: Disc, v0: float, spin0: float) -> float:
    """Time at which the slip vanishes; infinite where it never does."""
    slip = v0 - disc.radius * spin0
    pull, press = disc.gravity * math.sin(disc.slope), disc.gravity * math.cos(disc.slope)
    decay = disc.mu * press * (1.0 + 1.0 / disc.kappa) - math.copysign(1.0, slip) * pull
    if slip == 0.0:
        return 0.0
    return abs(slip) / decay if decay > 0.0 else math.inf


def _uniform(state: Rolling, t: float, acceleration: float, spin_up: float) -> Rolling:
    return Rolling(
        state.x + state.v * t + 0.5 * acceleration * t * t,
        state.angle + state.spin * t + 0.5 * spin_up * t * t,
        state.v + acceleration * t,
        state.spin + spin_up * t,
    )
