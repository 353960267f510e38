"""Where is a block pushed up an incline? It slides up, stops, and stays or slides back."""

import math


def block(t: float, speed: float, mu: float, slope: float, gravity: float = 9.81) -> tuple[float, float]:
    """Way uphill (m) and its rate at time t, for a start speed >= 0 uphill; slope in radians."""
    pull, press = gravity * math.sin(slope), gravity * math.cos(slope)
    stop = speed / (pull + mu * press)
    if t <= stop:
        return speed * t - 0.5 * (pull + mu * press) * t * t, speed - (pull + mu * press) * t
    top = 0.5 * speed * stop
    back = max(0.0, pull - mu * press)
    return top - 0.5 * back * (t - stop) ** 2, -back * (t - stop)


def stops_at(speed: float, mu: float, slope: float, gravity: float = 9.81) -> float:
    """Time at which the block comes to rest uphill, s."""
    return speed / (gravity * (math.sin(slope) + mu * math.cos(slope)))
