"""Does the mean speed of a gear train depend on how many arcs its flanks are drawn with, and on the tolerance?"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "ordinary")]

from gear_scenes import TEETH, contact_ratio, gear_scene, train  # noqa: E402
from mean_speed import mean_speed  # noqa: E402
from reference.gear_friction import FASTEST, SLOWEST  # noqa: E402
from reference.gear_friction import mean_speed as exact_speed  # noqa: E402

from watchsim.simulation.simulate import simulate  # noqa: E402
from watchsim.simulation.stops import Stop  # noqa: E402

ARCS = (6, 10, 20, 40, 60)
TOLERANCES = (1e-7, 1e-9, 1e-11)
SHORT = 0.215  # modules off both tips: one pair of teeth at a time
DURATION, SETTLED = 0.3, 0.15  # s
SAME = 1e-4
TEXT = """An involute wheel of 30 teeth (module 0.2 mm) drives a pinion of 8 against a viscous load; each flank is N arcs
through three points of the involute. Mean speed of the wheel in rad/s over whole teeth between {settled:g} and
{duration:g} s, when successive teeth agree to 2e-9. *Apart*: relative difference between the tolerances; above 1e-4 wrong,
or marked *differ* where the solution is not unique. The reference is `tests/reference/gear_friction.py`: exact involutes,
one equation of motion, scipy.

Without friction the truth is {free:.4f} rad/s, and the speed converges to it. With friction 0.1 and teeth as usual
(contact ratio {usual:.2f}) two pairs of teeth share the load for part of the way, and rigid bodies leave open how:
the forces are redundant, the lever arms of friction differ, and any speed from {slow:.3f} to {fast:.3f} (the load on
the pair that costs most, or least) obeys all laws. Which pair carries is decided by the arcs' deviations from the
involute, nanometres, which take turns from arc to arc. So each drawing has its own speed, within these limits: 2e-3 apart
between N = 6 and 60. With N it need not converge, and does not; that the drawing decides, and not the solver, is seen from
the tolerances, which agree to 7e-7. With the
tips cut by {short:g} modules (contact ratio {one:.5f}) one pair carries at a time, the truth is unique
({unique:.4f}), and the speed converges to it: the same solver, the same friction, the same arcs. Moreau's stepping
was compared for usual teeth: 45.894 and 45.962 for N = 20 and 30, where events gave 45.895 and 45.961 (1 µs, over 0.1 s),
and 45.844 and 45.895 for N = 6 and 40, where they gave 45.843 and 45.899 (2 µs, from 0.06 to 0.1 s).

| teeth | friction | N | {heads} | apart | truth | off | impacts a tooth | gap evaluations a tooth and arc |
|---|---:|---:|{rules}---:|---:|---:|---:|---:|
"""


def section(quick: bool) -> tuple[str, int]:
    """The section of the page, and how many lines were wrong."""
    usual = [exact_speed(train(0.1), share) for share in (SLOWEST, FASTEST)]
    text = TEXT.format(
        settled=SETTLED,
        duration=DURATION,
        free=exact_speed(train(0.0), FASTEST),
        usual=contact_ratio(),
        slow=usual[0],
        fast=usual[1],
        short=SHORT,
        one=contact_ratio(SHORT),
        unique=exact_speed(train(0.1, SHORT), FASTEST),
        heads=" | ".join(f"at {x:g}" for x in TOLERANCES),
        rules="---:|" * len(TOLERANCES),
    )
    lines, total = [], 0
    for cut, friction in ((0.0, 0.0), (SHORT, 0.1), (0.0, 0.1)):
        for arcs in ARCS[:3] if quick else ARCS:
            line, wrong = _line(cut, friction, arcs)
            lines.append(line)
            total += wrong
            print(line, flush=True)
    return text + "\n".join(lines), total


def _line(cut: float, friction: float, arcs: int) -> tuple[str, int]:
    scene, speeds, wrong = gear_scene(arcs, friction, cut=cut), [], False
    for tolerance in TOLERANCES:
        run = simulate(scene, DURATION, tolerance=tolerance)
        wrong |= run.stop != Stop.DURATION or abs(run.energy["residual_relative"]) > 1e-6
        speeds.append(mean_speed(run, 1, TEETH[1], SETTLED))
        teeth = float(run.q[-1, 1] - run.q[0, 1]) * TEETH[1] / 6.283185307179586
        cost = run.counts["impacts"] / teeth, run.counts["gap_evaluations"] / teeth / arcs
    low, high = (exact_speed(train(friction, cut), share) for share in (SLOWEST, FASTEST))
    apart = max(speeds) / min(speeds) - 1.0
    wrong |= not low * (1.0 - 1e-3) < speeds[-1] < high * (1.0 + 1e-3)
    unique = high / low - 1.0 < 1e-5
    wrong |= unique and apart > SAME
    truth, off = (f"{high:.4f}", f"{speeds[-1] / high - 1.0:+.1e}") if unique else (f"{low:.3f} … {high:.3f}", "")
    told = " | ".join(f"{x:.5f}" for x in speeds)
    kind = "short" if cut else "usual"
    line = f"| {kind} | {friction:g} | {arcs} | {told} | {apart:.0e} | {truth} | {off} | {cost[0]:.0f} | {cost[1]:.0f} |"
    note = " wrong |" if wrong else " differ |" if apart > SAME else ""
    return line + note, int(wrong)
