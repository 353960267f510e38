"""Is the motion right at kinks, in every orientation, and on curves of many arcs? Writes docs/reports/ordinary-mechanisms.md.

    python scripts/reports/ordinary.py [--quick] [--only PART ...] [--page FILE]

Parts: kinks, orientations, gears, cams. With --only the other parts of the page stay as they are.
The exit status is 1 where a run was wrong.
"""

import argparse
import math
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "ordinary")]

from flat_cams import ANGLES, FRICTIONS, RESTITUTIONS, TOLERANCES, bar_for, beyond, compared, expected, off  # noqa: E402
from gear_scenes import TEETH, contact_ratio, gear_scene, train  # noqa: E402
from mean_speed import mean_speed  # noqa: E402
from mechanisms import MECHANISMS, TOLERANCE, mechanism  # noqa: E402
from orientations import apart, random_pose, seen  # noqa: E402
from reference.flat_cam import FlatCam, Harmonic, Oval  # noqa: E402
from reference.gear_friction import FASTEST, SLOWEST  # noqa: E402
from reference.gear_friction import mean_speed as exact_speed  # noqa: E402

from watchsim.simulation.simulate import simulate  # noqa: E402
from watchsim.simulation.state import Stop  # noqa: E402

DECADES = ((0.0, 1e-8), (1e-8, 1e-6), (1e-6, 1e-5), (1e-5, 1e-4), (1e-4, 1e-3), (1e-3, 0.15), (0.15, 2.0))
KINKS = """A bar slides under a round follower that a torque presses on. Its level top rises (concave) or falls (convex) by an
angle. {angles} angles, even in their logarithm from 1e-10 to 0.1 rad, then to 90°; restitution {restitutions};
friction {frictions}; tolerance {tolerances}. The reference shares nothing with watchsim
(`tests/reference/kinked_bar.py`): the impact of one contact in closed form, flights on parabolas, one equation for
the contact force while the follower rides (scipy). Compared are the speeds of bar and follower and their places 20 ms
after the kink (beyond 0.15 rad 2 ms), relative to the bar's speed and travel. *Open*: the
compression ends with both bodies at rest, stuck at both faces, so that the laws leave open how much either face took; there the
speeds must follow from one of the possible splits (a linear program over the impulses). Energy: the residual over the kinetic energy.

A run counts as wrong beyond 1e-9 + 20 tolerances + what two rules cost (`allowed` in
`tests/ordinary/flat_cams.py`): rebounds that end within 1 µs are ended at once, and concave joints too flat for
an impact are passed as tangent, without the friction of that impact: Δu/u = m_f/m d (μ + d), m_f the mass of the
follower as seen by the contact.

| kinks | angles, rad | runs | open | speed off | place off | energy off | largest share of what is allowed | wrong |
|---|---|---:|---:|---:|---:|---:|---:|---:|
"""


def kinks(quick: bool) -> tuple[str, int]:
    """The kinks of the page and how many runs were wrong."""
    lines, wrong = [], 0
    for convex in (False, True):
        for low, high in DECADES:
            line, bad = _decade([a for a in ANGLES if low < a <= high][:: 4 if quick else 1], convex)
            lines.append(line)
            wrong += bad
            print(line, flush=True)
    text = KINKS.format(
        angles=len(ANGLES),
        restitutions=", ".join(f"{x:g}" for x in RESTITUTIONS),
        frictions=", ".join(f"{x:g}" for x in FRICTIONS),
        tolerances=", ".join(f"{x:g}" for x in TOLERANCES),
    )
    return text + "\n".join(lines), wrong


def _decade(angles: list[float], convex: bool) -> tuple[str, int]:
    worst, share, runs, free, wrong = [0.0, 0.0, 0.0], 0.0, 0, 0, 0
    for angle in angles:
        for friction in FRICTIONS:
            for restitution in RESTITUTIONS:
                bar, truth = bar_for(angle, convex, friction, restitution), expected(angle, convex, friction, restitution)
                for tolerance in TOLERANCES:
                    found = off(bar, truth, beyond(angle), tolerance)
                    runs += 1
                    free += truth.is_open
                    worst = [max(pair) for pair in zip(worst, (found.speed, found.place, found.energy), strict=True)]
                    share = max(share, max(found.speed, found.place) / found.allowed)
                    if found.wrong:
                        wrong += 1
                        print("   wrong:", convex, angle, friction, restitution, tolerance, found, flush=True)
    kind = "convex" if convex else "concave"
    cells = " | ".join(f"{x:.1e}" for x in worst)
    return f"| {kind} | {angles[0]:.1e} … {angles[-1]:.1e} | {runs} | {free} | {cells} | {share:.2f} | {wrong} |", wrong


SEED = 11
POSES = 1000
LIMIT = 1e-9
ORIENTATIONS = """{count} mechanisms, each in three quarter turns and in random poses (seed {seed}): the world is turned by a random
angle, with gravity and axes, and the outlines of each body are turned within its frame by another one. Compared with the
original mechanism: all coordinates at the end and all turning points of what swings on a spring, since the
start, relative to the largest of them; tolerance {tolerance:g}. Wrong is a difference above {limit:g}, a missing turning point,
an early end, or an energy residual above 1e-6.

| mechanism | impacts | turning points | poses | largest difference | wrong |
|---|---:|---:|---:|---:|---:|
"""


def orientations(quick: bool) -> tuple[str, int]:
    """The orientations of the page and how many runs were wrong."""
    poses, lines, total = (20 if quick else POSES), [], 0
    for name in MECHANISMS:
        line, wrong = compare(name, poses)
        lines.append(line)
        total += wrong
        print(line, flush=True)
    return ORIENTATIONS.format(count=len(MECHANISMS), seed=SEED, tolerance=TOLERANCE, limit=LIMIT) + "\n".join(lines), total


def compare(name: str, poses: int) -> tuple[str, int]:
    """A line of the table, and how many poses of the mechanism were wrong."""
    scene, rng = mechanism(name), np.random.default_rng(SEED)
    truth = seen(scene, 0.0, (0.0,) * len(scene.bodies))
    wrong, worst = int(bool(truth.bad)), 0.0
    still = (0.0,) * len(scene.bodies)
    quarters = [(0.5 * math.pi * k, still) for k in (1, 2, 3)]  # where zeros become rounding
    for pose in [*quarters, *(random_pose(scene, rng) for _ in range(poses - len(quarters)))]:
        found = seen(scene, *pose)
        off = apart(truth, found)
        worst = max(worst, off)
        if off > LIMIT or found.bad:
            wrong += 1
            print("   wrong:", name, pose, off, found.bad, flush=True)
    return f"| {name} | {truth.impacts} | {len(truth.turns)} | {poses} | {worst:.1e} | {wrong} |", wrong


ARCS = (6, 20, 60)
GEAR_TOLERANCES = (1e-7, 1e-9, 1e-11)
SHORT = 0.215  # modules off both tips: one pair of teeth at a time
DURATION, SETTLED = 0.3, 0.15  # s
SAME = 1e-4
GEARS = """An involute wheel of 30 teeth (module 0.2 mm) drives a pinion of 8 against a viscous load; each flank is N arcs
through three points of the involute. Mean speed of the wheel in rad/s over whole teeth between {settled:g} and
{duration:g} s, when successive teeth agree to 2e-9. *Apart*: relative difference between the tolerances; above 1e-4 wrong,
or marked *differ* where the solution is not unique. The reference is `tests/reference/gear_friction.py`: exact involutes,
one equation of motion, scipy.

Without friction the truth is {free:.4f} rad/s, and the speed converges to it. With friction 0.1 and teeth as usual
(contact ratio {usual:.2f}) two pairs of teeth share the load for part of the way, and rigid bodies leave open how:
the forces are redundant, the lever arms of friction differ, and any speed from {slow:.3f} to {fast:.3f} (the load on
the pair that costs most, or least) obeys all laws. Which pair carries is decided by the arcs' deviations from the
involute, nanometres, which take turns from arc to arc. So each drawing has its own speed within
these limits; that the drawing decides, and not the solver, is seen from the tolerances, which agree. With the
tips cut by {short:g} modules (contact ratio {one:.5f}) one pair carries at a time, the truth is unique
({unique:.4f}), and the speed converges to it: the same solver, the same friction, the same arcs.

| teeth | friction | N | {heads} | apart | truth | off | impacts a tooth | gap evaluations a tooth and arc |
|---|---:|---:|{rules}---:|---:|---:|---:|---:|
"""


def gears(quick: bool) -> tuple[str, int]:
    """The gears of the page, and how many lines were wrong."""
    usual = [exact_speed(train(0.1), share) for share in (SLOWEST, FASTEST)]
    text = GEARS.format(
        settled=SETTLED,
        duration=DURATION,
        free=exact_speed(train(0.0), FASTEST),
        usual=contact_ratio(),
        slow=usual[0],
        fast=usual[1],
        short=SHORT,
        one=contact_ratio(SHORT),
        unique=exact_speed(train(0.1, SHORT), FASTEST),
        heads=" | ".join(f"at {x:g}" for x in GEAR_TOLERANCES),
        rules="---:|" * len(GEAR_TOLERANCES),
    )
    lines, total = [], 0
    for cut, friction in ((0.0, 0.0), (SHORT, 0.1), (0.0, 0.1)):
        for arcs in ARCS[:3] if quick else ARCS:
            line, wrong = _gear(cut, friction, arcs)
            lines.append(line)
            total += wrong
            print(line, flush=True)
    return text + "\n".join(lines), total


def _gear(cut: float, friction: float, arcs: int) -> tuple[str, int]:
    scene, speeds, wrong = gear_scene(arcs, friction, cut=cut), [], False
    for tolerance in GEAR_TOLERANCES:
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


CAM_COUNTS = (8, 32, 128, 400)
CAMS = """A cam turns under a flat follower on a spring, for about five turns; no friction, so that the truth is one equation of
motion for the curve itself (`tests/reference/flat_cam.py`, scipy). The curve, an ellipse of 4 mm by 3.2 mm or a sum of two
harmonics, is drawn as N arcs through three of its points each, or as N chords. The expected orders: the place of arcs is
off by N⁻³; chords lose at each corner the square of its angle, N times N⁻², so that the error goes with 1/N. *Passed* are
pieces of the outline, *each* is of these, *order* is that from the line above. With few pieces the cam is another one.

The number of events grows with the pieces passed, or less. Gap evaluations grow somewhat faster: neighbours of the piece in
contact are looked at as well, and there are more of them within reach where pieces are small.

| curve | drawn as | restitution | N | angle off, rad | order | speed off | passed | events each | gap evaluations each |
|---|---|---:|---:|---:|---:|---:|---:|---:|---:|
"""


def cams(quick: bool) -> tuple[str, int]:
    """The cams of the page, and how many runs gave up or did not converge."""
    lines, wrong = [], 0
    for curve in (Oval(), Harmonic()):
        for chords in (False, True):
            for restitution in (0.0, 0.3):
                counts = CAM_COUNTS[: 2 if quick else None]
                more, bad = _table(FlatCam(curve), chords, restitution, counts)
                lines += more
                wrong += bad
    return CAMS + "\n".join(lines), wrong


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


PAGE = ROOT / "docs" / "reports" / "ordinary-mechanisms.md"
HEAD = """# Ordinary mechanisms

What no lever escapement shows: kinks between edges from 1e-10 rad to 90°, mechanisms in any orientation, curves of many arcs.
Made by `scripts/reports/ordinary.py`, which the nightly script runs; the tests in `tests/ordinary`
hold a part.
"""
PARTS: dict[str, tuple[str, Callable[[bool], tuple[str, int]]]] = {
    "kinks": ("Kinks", kinks),
    "orientations": ("Orientations", orientations),
    "gears": ("Gears of arcs", gears),
    "cams": ("Cams of arcs and chords", cams),
}


def read(page: Path) -> dict[str, str]:
    """The parts of a page that is there, by title."""
    if not page.exists():
        return {}
    blocks = page.read_text(encoding="utf-8").split("\n## ")[1:]
    return {title: text.strip() for title, _, text in (block.partition("\n") for block in blocks)}


def write(page: Path, found: dict[str, str]) -> None:
    titles = [title for title, _ in PARTS.values() if title in found]
    page.write_text(HEAD + "".join(f"\n## {title}\n\n{found[title]}\n" for title in titles), encoding="utf-8")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="fewer runs of each")
    parser.add_argument("--only", nargs="+", choices=PARTS, default=list(PARTS), metavar="PART", help="measure these parts")
    parser.add_argument("--page", type=Path, default=PAGE, help="file to write")
    wanted = parser.parse_args()
    found, wrong = read(wanted.page), 0
    for part in wanted.only:
        title, section = PARTS[part]
        print(f"== {title}", flush=True)
        found[title], bad = section(wanted.quick)
        print(f"{bad} wrong", flush=True)
        wrong += bad
        write(wanted.page, found)
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
