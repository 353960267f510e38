"""Which tolerances decide, and in which units?

All lengths scale with the scene's size, so that a tower clock and a wristwatch are treated alike.
"""

from __future__ import annotations

from typing import NamedTuple

from watchsim.jit import by_reference
from watchsim.mechanism.contact_features import JOINT

FINEST_ROWS, COARSEST_ROWS = 0.0125, 0.1  # rad


class Options(NamedTuple):
    """Tolerances of a run. Each line: what it is; too large: ...; too small: ..."""

    tolerance: float  # relative error per step of coordinates and velocities. Large: wrong rates; small: slow below 1e-12
    gap_zero: float  # m: a gap this small is zero to rounding. Large: early contacts; small: below the rounding of positions
    gap_close: float  # m: gaps this small take part in an impact. Large: merges events; small: splits simultaneous ones
    behind: float  # m: a step may end this far behind a contact. Large: takes backs of parts for fronts; small: falls through
    extent: float  # m: how far beyond its primitive's end a contact counts. Large: sticks out; small: slips through joints
    speed_zero: float  # m/s: slower is zero. Large: freezes slow sliding; small: below the rounding of velocities
    force_zero: float  # share of a contact's force terms that counts as zero. Large: late detachment; small: rounding decides
    accumulation_time: float  # s: rebounds that would end sooner are ended by rule. Large: changes timing; small: more impacts
    accumulation_speed: float  # m/s: faster rebounds are never ended by rule
    sleep: float  # share of a coordinate's force terms below which its acceleration counts as zero
    row_phase: float  # rad: spacing of recorded rows in free flight, in phase of the coordinate's own oscillation
    max_step: float  # s
    size: float  # m, the scene's size


OptionsRef = by_reference(Options, __name__)


def options_for(size: float, tolerance: float, max_step: float) -> Options:
    """Options for a scene whose contact outlines are `size` metres across."""
    return Options(
        tolerance=tolerance,
        gap_zero=1e-13 * size,
        # Alike for all tolerances: which contacts share an impact must not depend on how exactly it is computed.
        gap_close=2e-10 * size,
        # A corner that lands flat comes within its primitives only when it has landed: as far behind as drift has let it.
        behind=max(2e-10, min(20.0 * tolerance, 2e-5)) * size,
        extent=4.0 * JOINT * size,
        # Velocities drift off their contacts by about the tolerance within a step.
        speed_zero=max(1e-8, 20.0 * tolerance) * size,
        force_zero=1e-10,
        accumulation_time=1e-6,
        accumulation_speed=0.1 * size,
        sleep=1e-9,
        # Rates between rows are off by the 5th power of their spacing: here by less than the tolerance.
        row_phase=min(max(FINEST_ROWS, 0.1 * (tolerance / 1e-9) ** 0.2), COARSEST_ROWS),
        max_step=max_step,
        size=size,
    )
