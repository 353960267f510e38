"""Which dimensions of a dead-beat or recoil escapement do not go together?"""

from __future__ import annotations

from collections.abc import Iterator

from watchsim.construction.design import Conflict
from watchsim.construction.graham.graham_points import Anchor
from watchsim.construction.graham.graham_wheel import gap

LEAST_WIDTH, LEAST_GAP, MOST_SPAN = 0.2, 0.3, 80.0


def conflicts(anchor: Anchor) -> Iterator[Conflict]:
    """What cannot be drawn or cannot work."""
    values = anchor.values
    if abs(values.embraced % 1.0 - 0.5) > 1e-9:
        yield Conflict("embraced", "must be a whole number and a half, else both pallets are worked at once")
    if anchor.half_span > MOST_SPAN or anchor.half_span < 90.0 - MOST_SPAN:
        spread = (
            f"{2.0 * anchor.half_span:.4g}° of the wheel, {2.0 * (90.0 - MOST_SPAN):g}° to {2.0 * MOST_SPAN:g}° can be drawn"
        )
        yield Conflict("embraced", f"with {values.teeth} teeth the pallets embrace {spread}")
    if anchor.pallet_width < LEAST_WIDTH:
        most = 180.0 / values.teeth - values.tip_width - LEAST_WIDTH
        yield Conflict("drop", f"must be less than {most:.4g}°: nothing would be left of the pallets")
    if values.lock >= values.lift:
        yield Conflict("lock", f"must be less than the lift of {values.lift:g}°: the impulse would end before the middle")
    if values.start <= anchor.released:
        yield Conflict("start", f"must be more than {anchor.released:.4g}°, else no tooth is let off")
    if values.back <= values.undercut:
        yield Conflict("back", f"must be more than the undercut of {values.undercut:g}°, else a tooth is thinner at its foot")
    elif gap(values) < LEAST_GAP:
        yield Conflict("back", f"leaves {gap(values):.3g}° between two teeth; {LEAST_GAP:g}° are needed")
