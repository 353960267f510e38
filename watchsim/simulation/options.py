"""Which tolerances decide, and in which units?

All lengths scale with the scene's size, all times with its own unit, so that a tower clock and a wristwatch are treated alike.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from watchsim.jit import by_reference, kernel
from watchsim.scene.forces import CONSTANT
from watchsim.tolerances import (
    ACCUMULATION_SPEED,
    ACCUMULATION_TIME,
    BEHIND_LEAST,
    BEHIND_MOST,
    BEHIND_PER_TOLERANCE,
    COARSEST_ROWS,
    COARSEST_SPEED_ZERO,
    EXTENT_PER_JOINT,
    FINEST_ROWS,
    FORCE_ZERO,
    GAP_CLOSE,
    GAP_ZERO,
    JOINT_RESOLUTION,
    LEDGER_OF_PATH,
    SLEEP,
    SPEED_PER_TOLERANCE,
    SPEED_ZERO,
)

if TYPE_CHECKING:
    from watchsim.mechanism.compile import Compiled
    from watchsim.scene.scene import Scene


class Options(NamedTuple):
    """Tolerances of a run, from those of watchsim/tolerances.py. Each line: what it is; too large: ...; too small: ..."""

    tolerance: float  # relative error per step of coordinates and velocities. Large: wrong rates; small: slow below 1e-12
    gap_zero: float  # m: a gap this small is zero to rounding. Large: early contacts; small: below the rounding of positions
    gap_close: float  # m: gaps this small take part in an impact. Large: merges events; small: splits simultaneous ones
    behind: float  # m: a step may end this far behind a contact. Large: accepts contacts on the far side; small: falls through
    sunk: float  # m: so far behind, where flat faces have let it. Large: accepts contacts on the far side; small: falls through
    extent: float  # m: how far beyond its primitive's end a contact counts. Large: sticks out; small: slips through joints
    speed_zero: float  # m/s: slower is zero. Large: freezes slow sliding; small: below the rounding of velocities
    speed_rest: float  # m/s: a slower slip has friction of rest in an impact. Large: as `speed_zero`; small: rounding chooses
    speed_drift: float  # m/s: so much of a velocity may be the error of a step. Large: hides faults; small: reports rounding
    force_zero: float  # share of a contact's force terms that counts as zero. Large: late detachment; small: rounding decides
    accumulation_time: float  # s: rebounds that would end sooner are ended by rule. Large: changes timing; small: more impacts
    accumulation_speed: float  # m/s: faster rebounds are never ended by rule
    sleep: float  # share of a coordinate's force terms below which its acceleration counts as zero
    row_phase: float  # rad: spacing of recorded rows in free flight, in phase of the coordinate's own oscillation
    max_step: float  # s, from the duration the scene gives; see `longest_step`
    natural: float  # s, `natural_step`
    size: float  # m, the scene's size
    ledger: float  # share of the kinetic energy by which that of a step's path may miss the ledger; 0: not looked at


OptionsRef = by_reference(Options, __name__)


def options_for(size: float, tolerance: float, longest: float, natural: float = math.inf, unit: float = 1.0) -> Options:
    """Options for a scene whose outlines are `size` metres across; the two longest steps and its unit of time in seconds."""
    return Options(
        tolerance=tolerance,
        gap_zero=GAP_ZERO * size,
        # Alike for all tolerances: which contacts share an impact must not depend on how exactly it is computed.
        gap_close=GAP_CLOSE * size,
        # A corner that lands flat comes within its primitives only when it has landed: as far behind as drift has let it.
        behind=max(BEHIND_LEAST, min(BEHIND_PER_TOLERANCE * tolerance, BEHIND_MOST)) * size,
        sunk=BEHIND_MOST * size,
        extent=EXTENT_PER_JOINT * JOINT_RESOLUTION * size,
        # Velocities drift off their contacts by about the tolerance within a step.
        speed_zero=max(SPEED_ZERO, min(SPEED_PER_TOLERANCE * tolerance, COARSEST_SPEED_ZERO)) * size / unit,
        speed_rest=SPEED_ZERO * size / unit,
        speed_drift=max(SPEED_ZERO, SPEED_PER_TOLERANCE * tolerance) * size / unit,
        force_zero=FORCE_ZERO,
        accumulation_time=ACCUMULATION_TIME * unit,
        accumulation_speed=ACCUMULATION_SPEED * size / unit,
        sleep=SLEEP,
        # Rates between rows are off by the 5th power of their spacing: here by less than the tolerance.
        row_phase=min(max(FINEST_ROWS, 0.1 * (tolerance / 1e-9) ** 0.2), COARSEST_ROWS),
        max_step=min(longest, natural),
        natural=natural,
        size=size,
        ledger=0.0,
    )


def options_of(scene: Scene, compiled: Compiled, tolerance: float) -> Options:
    """Options for a run of this scene. Its ledger is watched but for constant friction and linear springs."""
    found = options_for(compiled.size, tolerance, scene.duration, natural_step(compiled), compiled.unit)
    slips = any(contact.slip != CONSTANT for contact in scene.contacts)
    bent = any(spring.cubic or spring.curb is not None or spring.wound is not None for spring in scene.springs)
    watched = scene.bearings or scene.shocks or slips or bent
    return found._replace(ledger=LEDGER_OF_PATH * tolerance) if watched else found


def natural_step(compiled: Compiled) -> float:
    """A quarter of the fastest spring's period (s), so that no turning point hides between two others; infinity without one."""
    return 0.5 * math.pi / compiled.fastest if compiled.fastest else math.inf


@kernel
def longest_step(options, t):
    """The longest step at time t, s.

    Without springs it follows from the duration the scene gives, not from the requested one: how far a run is to go must not
    change a bit of it. What goes on far beyond that duration may take steps as long as the time that has passed.
    """
    return max(options.max_step, min(t, options.natural))
