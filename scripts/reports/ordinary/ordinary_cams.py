"""Does the motion of a cam converge with the number of arcs or chords its curve is drawn with, and at which cost?"""

from __future__ import annotations

import math
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "ordinary")]

from flat_cams import compared  # noqa: E402
from reference.flat_cam import FlatCam, Harmonic, Oval  # noqa: E402

COUNTS = (2, 4, 8, 16, 32, 64, 128, 256, 400)
TEXT = """A cam turns under a flat follower on a spring, for about five turns; no friction, so that the truth is one equation of
motion for the curve itself (`tests/reference/flat_cam.py`, scipy). The curve, an ellipse of 4 mm by 3.2 mm or a sum of two
harmonics, is drawn as N arcs through three of its points each, or as N chords. The expected orders: the place of arcs is
off by N⁻³; chords lose at each corner the square of its angle, N times N⁻², so that the error goes with 1/N. *Passed* are
pieces of the outline, *each* is of these, *order* is that from the line above. With few pieces the cam is another one; with
four chords it has not the energy to turn. N = 2 … 4 is therefore a test of running at all.

The number of events grows with the pieces passed, or less. Gap evaluations grow somewhat faster: neighbours of the piece in
contact are looked at as well, and there are more of them within reach where pieces are small.

| curve | drawn as | restitution | N | angle off, rad | order | speed off | passed | events each | gap evaluations each |
|---|---|---:|---:|---:|---:|---:|---:|---:|---:|
"""


def section(quick: bool) -> tuple[str, int]:
    """The section of the page, and how many runs gave up or did not converge."""
    lines, wrong = [], 0
    for curve in (Oval(), Harmonic()):
        for chords in (False, True):
            for restitution in (0.0, 0.3):
                counts = COUNTS[1 if chords else 0 : 6 if quick else None]
                more, bad = _table(FlatCam(curve), chords, restitution, counts)
                lines += more
                wrong += bad
    return TEXT + "\n".join(lines), wrong


def _table(cam: FlatCam, chords: bool, restitution: float, counts: tuple[int, ...]) -> tuple[list[str], int]:
    """Lines of one curve, and how many of them were wrong."""
    name = "ellipse" if isinstance(cam.curve, Oval) else "harmonics"
    lines, wrong, before = [], 0, None
    for count in counts:
        c = compared(cam, count, chords, restitution)
        order = math.nan if before is None else math.log(before[1] / c.angle) / math.log(count / before[0])
        bad = c.stop != "DURATION" or abs(c.residual) > 1e-6
        bad |= count > 32 and not order > (0.8 if chords else 2.4)
        wrong, before = wrong + bad, (count, c.angle)
        told = "" if math.isnan(order) else f"{order:.1f}"
        line = (
            f"| {name} | {'chords' if chords else 'arcs'} | {restitution:g} | {count} | {c.angle:.1e} | {told} | {c.speed:.1e} "
        )
        line += f"| {c.passed} | {c.events / c.passed:.1f} | {c.evaluations / c.passed:.0f} |"
        lines.append(line + " wrong |" if bad else line)
        print(lines[-1], flush=True)
    return lines, wrong
