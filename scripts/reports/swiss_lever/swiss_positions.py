"""The chapter on positions: flat and hanging, with a balance out of poise."""

from __future__ import annotations

import math

from scipy.special import j1
from swiss_studies import DAY, unpoised

import watchsim as ws
from watchsim.studies.limit_cycle.cycle import Cycle

G = 9.81  # m/s²
FLAT, HANGING = "1.02 nN·m", "3.06 nN·m"  # pivot friction of parameter set A (profiles/set_a/scene.toml)
HEAVY, RIM = 5e-9, 4.5e-3  # kg too much, at that radius (m)
BALANCE = 50e-6  # kg; only its product with the offset counts
HEAVY_AT = 60.0  # °, from 3 o'clock towards 12, with the balance at rest
POSITIONS = {"3 o'clock down": (1.0, 0.0), "12 down": (0.0, 1.0), "9 down": (-1.0, 0.0), "6 down": (0.0, -1.0)}


def poise_rate(scene: ws.Scene, cycle: Cycle, down: float) -> float:
    """s/d that a heavy place adds, by the mean of its torque over a harmonic swing: (mgr/k)·J₁(A)/A.

    `down` is the cosine of the angle between the heavy place at rest and the direction of gravity.
    """
    assert cycle.amplitude_deg is not None
    swing = math.radians(cycle.amplitude_deg)
    return DAY * HEAVY * G * RIM / scene.springs[0].stiffness * down * float(j1(swing)) / swing


def positions(scene: ws.Scene) -> list[str]:
    """Flat, and hanging in four positions with a balance out of poise, at two torques."""
    offset = HEAVY * RIM / BALANCE
    place = (offset * math.cos(math.radians(HEAVY_AT)), offset * math.sin(math.radians(HEAVY_AT)))
    rows, worst, spans = [], 0.0, []
    for torque, words in (("-1.0 µN·m", "wound"), ("-0.6 µN·m", "run down")):
        driven = scene.set("torques.0.value", torque)
        flat = ws.steady(driven.set("damping.0.coulomb", FLAT))
        rows.append(f"| {words} | flat | {flat.amplitude_deg:.2f} | {flat.rate_s_per_d:+.3f} | | |")
        hanging = driven.set("damping.0.coulomb", HANGING)
        poised = ws.steady(hanging)
        rows.append(f"| {words} | hanging, in poise | {poised.amplitude_deg:.2f} | {poised.rate_s_per_d:+.3f} | | |")
        rates = []
        for name, (x, y) in POSITIONS.items():
            cycle = unpoised(hanging, BALANCE, place, (G * x, G * y))
            assert cycle.rate_s_per_d is not None and poised.rate_s_per_d is not None
            down = (x * place[0] + y * place[1]) / offset
            law, got = poise_rate(scene, cycle, down), cycle.rate_s_per_d - poised.rate_s_per_d
            worst = max(worst, abs(got - law))
            rates.append(cycle.rate_s_per_d)
            rows.append(
                f"| {words} | {name} | {cycle.amplitude_deg:.2f} | {cycle.rate_s_per_d:+.3f} | {got:+.3f} | {law:+.3f} |"
            )
        spans.append(max(rates) - min(rates))
    return [
        "## Positions",
        "",
        f"Pivots rub more in a hanging watch than in one lying flat ({HANGING} against {FLAT} as in",
        "[parameter set A](../reports/parameter-sets.md)), and a balance out of poise is a pendulum:"
        f" here {1e9 * HEAVY:.0f} µg too much at"
        f" {1e3 * RIM:.1f} mm, {HEAVY_AT:.0f}° from",
        "3 o'clock towards 12 when it is at rest. Dial up and dial down are the same in a plane model. In a scene, `gravity` under",
        "`[scene]` says which way is down, and the balance says where its weight lies:",
        "",
        "```toml",
        "[scene]",
        'gravity = ["0 m/s²", "-9.81 m/s²"]       # 6 o\'clock down; 12 down is ["0 m/s²", "9.81 m/s²"], 3 down ["9.81 m/s²", "0 m/s²"]',
        "",
        "[bodies.balance]",
        'mass           = "50 mg"',
        'inertia        = "12 mg·cm²"',
        f'centre_of_mass = ["{1e6 * place[0]:.6g} µm", "{1e6 * place[1]:.6g} µm"]  # from the staff, with the balance at rest',
        "```",
        "",
        "| | position | amplitude, ° | rate, s/d | by poise, s/d | (mgr/k)·J₁(A)/A, s/d |",
        "|---|---|---|---|---|---|",
        *rows,
        "",
        f"The last column is the closed form for a harmonic swing; the simulation agrees to {worst:.3f}"
        " s/d. J₁ changes its sign at 219.5°:",
        "above it the heavy place below loses, beneath it gains. The four hanging positions differ by"
        f" {spans[0]:.2f} s/d wound and"
        f" {spans[1]:.2f} s/d run down.",
        "",
        "*For a watch:* poise at low amplitude, where it shows, and look at the sign before filing:"
        " near 220° no timing machine sees a",
        "heavy place at all.",
        "",
    ]
