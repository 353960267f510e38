"""What happens at kinks of 1e-10 rad to 90 degrees, and is it what the laws say?"""

from __future__ import annotations

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT), str(ROOT / "tests"), str(ROOT / "tests" / "ordinary")]

from kinked_scenes import ANGLES, FRICTIONS, RESTITUTIONS, TOLERANCES, bar_for, beyond, expected, off  # noqa: E402

DECADES = ((0.0, 1e-8), (1e-8, 1e-6), (1e-6, 1e-5), (1e-5, 1e-4), (1e-4, 1e-3), (1e-3, 0.15), (0.15, 2.0))
TEXT = """A bar slides under a round follower that a torque presses on. Its level top rises (concave) or falls (convex) by an
angle. {angles} angles, even in their logarithm from 1e-10 to 0.1 rad, then to 90°; restitution {restitutions};
friction {frictions}; tolerance {tolerances}. The reference shares nothing with watchsim
(`tests/reference/kinked_bar.py`): the impact of one contact in closed form, flights on parabolas, one equation for
the contact force while the follower rides (scipy). Compared are the speeds of bar and follower and their places 20 ms
after the kink (beyond 0.15 rad 2 ms), relative to the bar's speed and travel. Where friction stops the follower at the kink,
the speeds right after the impact are compared. Energy: the residual over the kinetic energy.

A run counts as wrong beyond 1e-9 + 20 tolerances + what two rules cost (`allowed` in
`tests/ordinary/kinked_scenes.py`): rebounds that end within 1 µs are ended at once, and concave joints too flat for
an impact are passed as tangent, without the friction of that impact: Δu/u = m_f/m d (μ + d), m_f the mass of the
follower as seen by the contact.

| kinks | angles, rad | runs | speed off | place off | energy off | largest share of what is allowed | wrong |
|---|---|---:|---:|---:|---:|---:|---:|
"""


def section(quick: bool) -> tuple[str, int]:
    """The section of the page and how many runs were wrong."""
    lines, wrong = [], 0
    for convex in (False, True):
        for low, high in DECADES:
            line, bad = _decade([a for a in ANGLES if low < a <= high][:: 4 if quick else 1], convex)
            lines.append(line)
            wrong += bad
            print(line, flush=True)
    text = TEXT.format(
        angles=len(ANGLES),
        restitutions=", ".join(f"{x:g}" for x in RESTITUTIONS),
        frictions=", ".join(f"{x:g}" for x in FRICTIONS),
        tolerances=", ".join(f"{x:g}" for x in TOLERANCES),
    )
    return text + "\n".join(lines), wrong


def _decade(angles: list[float], convex: bool) -> tuple[str, int]:
    worst, share, runs, wrong = [0.0, 0.0, 0.0], 0.0, 0, 0
    for angle in angles:
        for friction in FRICTIONS:
            for restitution in RESTITUTIONS:
                bar, truth = bar_for(angle, convex, friction, restitution), expected(angle, convex, friction, restitution)
                for tolerance in TOLERANCES:
                    found = off(bar, truth, beyond(angle), tolerance)
                    runs += 1
                    worst = [max(pair) for pair in zip(worst, (found.speed, found.place, found.energy), strict=True)]
                    share = max(share, max(found.speed, found.place) / found.allowed)
                    if found.wrong:
                        wrong += 1
                        print("   wrong:", convex, angle, friction, restitution, tolerance, found, flush=True)
    kind = "convex" if convex else "concave"
    cells = " | ".join(f"{x:.1e}" for x in worst)
    return f"| {kind} | {angles[0]:.1e} … {angles[-1]:.1e} | {runs} | {cells} | {share:.2f} | {wrong} |", wrong
