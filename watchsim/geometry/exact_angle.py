"""What are the cosine and sine of an angle, to more digits than a float holds?

A point on an arc whose radius is a million times its length keeps all its digits only so.
"""

from __future__ import annotations

import math
from decimal import Decimal, localcontext

from watchsim.geometry.primitives import Arc

DIGITS = 40
QUARTER = Decimal("1.5707963267948966192313216916397514420985846996875529")


def cos_sin(angle: Decimal) -> tuple[Decimal, Decimal]:
    """Cosine and sine of `angle` (radians, up to some turns) to about 38 digits."""
    with localcontext() as context:
        context.prec = DIGITS
        quarters = int((angle / QUARTER).to_integral_value())
        rest = angle - quarters * QUARTER  # within an eighth of a turn either way
        term, k = Decimal(1), 0
        sums = [Decimal(0), Decimal(0)]
        while abs(term) > Decimal(10) ** -DIGITS:
            sums[k % 2] += -term if k % 4 >= 2 else term
            k += 1
            term *= rest / k
        c, s = sums
        return ((c, s), (-s, c), (-c, -s), (s, -c))[quarters % 4]


def middle(edge: Arc, exact: bool) -> tuple[float, float, float, float]:
    """Middle of the arc and the direction to it from the centre; `exact`: rounded once, however far the centre is."""
    if not exact:
        angle = edge.start_angle + 0.5 * edge.sweep
        c, s = math.cos(angle), math.sin(angle)
        return edge.x + edge.radius * c, edge.y + edge.radius * s, c, s
    cosine, sine = cos_sin(Decimal(edge.start_angle) + Decimal(edge.sweep) / 2)
    x, y, radius = Decimal(edge.x), Decimal(edge.y), Decimal(edge.radius)
    return float(x + radius * cosine), float(y + radius * sine), float(cosine), float(sine)
