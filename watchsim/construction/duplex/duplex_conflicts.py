"""Which dimensions of a duplex escapement do not go together?"""

from __future__ import annotations

import math
from collections.abc import Iterator

from watchsim.construction.design import Conflict
from watchsim.construction.duplex.duplex_dimensions import Duplex
from watchsim.construction.duplex.duplex_outlines import floor_between
from watchsim.construction.duplex.duplex_points import DuplexPoints

FREE = 0.2  # degrees of the wheel by which an impulse tooth stands outside the overlap until the notch has let go
LEAST_FLOOR = 2.0  # degrees
LEAST_IMPULSE = 8.0  # degrees of the balance
WITHIN = 1.0  # degrees of the balance by which the pallet is in the overlap as a tooth is let go
SLIDES = 5.0  # degrees by which the point's direction on the roller must exceed the angle of friction
SPARE = 20.0  # degrees of swing


def conflicts(values: Duplex) -> Iterator[Conflict]:
    """Every conflict between dimensions, each named by the one to change first."""
    points = DuplexPoints(values)
    most = points.waiting - 2.0 * points.rests - FREE
    if values.reach > most:
        words = f"must be at most {most:.4g}°: as the notch lets a tooth go, the impulse tooth that will drive is"
        yield Conflict(
            "reach", f"{words} {most + FREE:.4g}° from the line of centres, and the pallet has to be there before it"
        )
        return
    at_letting_go = points.pallet_at(points.waiting - 2.0 * points.rests)
    least = WITHIN - points.half_impulse - at_letting_go
    if values.drop < least:
        yield Conflict("drop", f"must be at least {least:.4g}°, else the tooth passes before the pallet is in its way")
    most = points.half_impulse - LEAST_IMPULSE - at_letting_go
    if values.drop > most:
        yield Conflict("drop", f"must be at most {most:.4g}°: {LEAST_IMPULSE:g}° of impulse are needed")
    holds = math.degrees(math.atan(values.friction)) + SLIDES
    if values.intersection < holds:
        words = f"must be at least {holds:.4g}°, or a tooth wedges itself below the roller at a friction of {values.friction:g}"
        yield Conflict("intersection", words)
    if values.undercut <= values.notch / 2.0:
        yield Conflict(
            "undercut", f"must be more than {values.notch / 2.0:.4g}°, half of the notch, so that points touch its wall"
        )
    floor = floor_between(points)
    if not LEAST_FLOOR <= floor <= points.pitch:
        words = f"with {values.teeth} teeth leaves no rim between the feet of the resting teeth"
        yield Conflict("undercut", f"{words}: {LEAST_FLOOR:g}° of it are needed; less undercut, or fewer teeth")
    # The notch comes round to the resting tooth a second time.
    round_again = 360.0 - abs(values.letting_go) - 2.0 * values.intersection - values.notch - SPARE
    if values.start > round_again:
        yield Conflict("start", f"must be at most {round_again:.4g}°: farther out the notch comes round to the tooth again")
