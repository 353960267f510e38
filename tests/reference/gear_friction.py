"""How fast does an involute wheel turn a pinion against a viscous load, with friction between the flanks?

One pair of teeth in contact: the force acts along the line of action, friction across it, with the distances from the base
circles' tangent points as lever arms; before the pitch point friction helps the wheel, behind it hinders. With two pairs the
share of each is not determined (rigid flanks on rigid flanks): the mean speed lies between those of the two extreme shares.
Nothing of the package is used.
"""

import itertools
import math
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

ONE, FASTEST, SLOWEST = "one pair", "fastest", "slowest"


@dataclass(frozen=True)
class Train:
    """SI units: base and tip radii of wheel (drives) and pinion, distance, module's base pitch, inertias, torque, damping."""

    base: tuple[float, float]
    tip: tuple[float, float]
    distance: float
    pitch: float  # m, along the line of action
    inertia: tuple[float, float]
    torque: float
    damping: float
    friction: float

    @property
    def path(self) -> tuple[float, float, float, float]:
        """Where contact begins, the pitch point, where it ends, and how long the tangent is; from the wheel's tangent point."""
        working = math.acos(sum(self.base) / self.distance)
        length = self.distance * math.sin(working)
        begin = length - math.sqrt(self.tip[1] ** 2 - self.base[1] ** 2)
        return begin, self.base[0] * math.tan(working), math.sqrt(self.tip[0] ** 2 - self.base[0] ** 2), length


def _ratio(train: Train, x: float) -> float:
    """Arm of the force about the pinion over that about the wheel while a pair touches at x."""
    _, pitch_point, _, length = train.path
    rub = math.copysign(train.friction, x - pitch_point)
    return (train.base[1] + rub * (length - x)) / (train.base[0] + rub * x)


def mean_speed(train: Train, share: str) -> float:
    """Mean speed of the wheel, rad/s, once it repeats from tooth to tooth."""
    begin, pitch_point, end, _ = train.path
    gear = train.base[0] / train.base[1]

    def ratio(x: float) -> float:
        pairs = [y for y in (x - train.pitch, x, x + train.pitch) if begin <= y <= end]
        arms = [_ratio(train, y) for y in pairs] or [_ratio(train, x)]
        if share == ONE:
            return arms[0]
        return max(arms) if share == FASTEST else min(arms)

    first = end - train.pitch
    breaks = {first, end, pitch_point, begin, begin + train.pitch, pitch_point - train.pitch, pitch_point + train.pitch}
    # Only what lies within one pitch; forces jump there.
    stops = sorted(x for x in breaks if first <= x <= end)

    def rates(x: float, y: np.ndarray) -> list[float]:
        arms = ratio(x)
        turn = (arms * train.torque - train.damping * gear * y[1]) / (train.inertia[1] * gear + train.inertia[0] * arms)
        pace = train.base[0] * y[1]
        return [1.0 / pace, turn / pace]

    speed, time = train.torque / (gear**2 * train.damping), 0.0
    for _ in range(400):
        before, time = speed, 0.0
        for a, b in itertools.pairwise(stops):
            inset = 1e-9 * (b - a)
            made = solve_ivp(rates, (a + inset, b - inset), [0.0, speed], method="DOP853", rtol=1e-10, atol=1e-14)
            time, speed = time + float(made.y[0, -1]), float(made.y[1, -1])
        if abs(speed / before - 1.0) < 1e-11:
            break
    return train.pitch / (train.base[0] * time)
