"""Chapters on what keeps the time: period, positions, temperature, run-down, and what matters most."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import numpy as np
from scipy.special import j1
from swiss_pictures import BLUE, GREEN, MARKED, RED, dots, line, named, panels, saved
from swiss_studies import (
    DAY,
    NOMINAL,
    Floats,
    Series,
    deviation_ppm,
    free_period,
    over,
    slopes,
    unpoised,
)

import watchsim as ws
from watchsim.render.figures.effects_plot import plot_sensitivity
from watchsim.studies.limit_cycle.cycle import Cycle
from watchsim.units import ANGLE, TORQUE, parse

G = 9.81  # m/s²
FLAT, HANGING = "1.02 nN·m", "3.06 nN·m"  # pivot friction of parameter set A (profiles/set_a/scene.toml)
HEAVY, RIM = 5e-9, 4.5e-3  # kg too much, at that radius (m)
BALANCE = 50e-6  # kg; only its product with the offset counts
HEAVY_AT = 60.0  # °, from 3 o'clock towards 12, with the balance at rest
POSITIONS = {"3 o'clock down": (1.0, 0.0), "12 down": (0.0, 1.0), "9 down": (-1.0, 0.0), "6 down": (0.0, -1.0)}
# Expansion of brass and steel, 1/K: what a brass or steel balance alone loses, 1.64 and 0.95 s/d in 1 K (D. Boettcher's
# spreadsheet, described at hsn161.com/HSN/watches.php), divided by 86400. The loss of a steel spring on a brass balance, about
# 11 s/d in 1 K, is from his article at bwcmg.org, "Nickel Steel Balance Spring".
BRASS, STEEL = 1.64 / DAY, 0.95 / DAY
LOSS_TOLD = "https://bwcmg.org/index.php/2024/09/10/nickel-steel-balance-spring-a-major-development-in-watchmaking"
STEEL_AND_BRASS = 11.0  # s/d in 1 K
TEMPERATURES = np.array([-15.0, -10.0, -5.0, 0.0, 5.0, 10.0, 15.0])  # K from that of adjustment
# An example of a mainspring and its train. Assumed: the torque falls quickly at first, then evenly, and again at the end; a barrel
# that turns once in 6.75 h, so that the escape wheel (960 turns an hour) turns 6480 times as often; four fifths arrive.
WOUND_SCENE = """\
[scene]
title  = "Swiss lever with a mainspring"
schema = 1

[design]
of = "swiss_lever"

[[torques]]
body       = "wheel"
over       = "barrel"                    # the table is the mainspring's: turns of the barrel since it was wound, torque at it
table      = [["0 rev", "9.72 mN·m"], ["0.3 rev", "9.33 mN·m"], ["1.8 rev", "8.65 mN·m"], ["3.6 rev", "7.85 mN·m"],
              ["5.3 rev", "6.92 mN·m"], ["6.2 rev", "5.83 mN·m"], ["6.8 rev", "4.1 mN·m"], ["7.1 rev", "2.92 mN·m"]]
ratio      = -6480                       # turns of the wheel for one of the barrel; clockwise
efficiency = 0.8
run_down   = "0 rev"                     # how far the barrel has turned at the start

[[damping]]
body    = "balance"
coulomb = "1.02 nN·m"                    # pivots, lying flat
"""
HOURS_A_TURN = 6.75
RATIO, EFFICIENCY = 6480.0, 0.8  # as in the scene: the torque at the wheel is worked out from the table by hand
FLAT_COLOUR = "#6a7683"


def period(scene: ws.Scene) -> list[str]:
    """Period over inertia and stiffness, and the escapement's own deviation."""
    inertia, stiffness = scene.body("balance").inertia, scene.springs[0].stiffness
    shares = np.linspace(0.84, 1.2, 10)  # small swings must stay within 10 % of the nominal frequency
    heavier = over(scene, "bodies.balance.inertia", shares * inertia)
    stiffer = over(scene, "springs.0.stiffness", shares * stiffness)
    figure, axes = panels(2, 2, height=55.0)
    rows = []
    own: list[Floats] = []
    for i, (series, words, unit, factor) in enumerate(
        ((heavier, "moment of inertia", "mg·cm²", 1e10), (stiffer, "spring stiffness", "µN·m/rad", 1e6))
    ):
        free = np.array([free_period(x, stiffness) if i == 0 else free_period(inertia, x) for x in series.at])
        own.append(deviation_ppm(series.of("period_s"), free))
        dots(axes[i], factor * series.at, series, "period_s", "limit cycles", BLUE)
        line(axes[i], factor * series.at, free, "2π √(I/k)")
        named(axes[i], "", "period (s)")
        axes[2 + i].plot(factor * series.at, own[i], color=RED, **MARKED)
        named(axes[2 + i], f"{words} ({unit})", "escapement's own (ppm)", legend=False)
    picture = saved(figure, "period")
    for k in range(0, len(shares), 3):
        rows.append(
            f"| {1e10 * heavier.at[k]:.2f} | {heavier.of('period_s')[k]:.9f} | {own[0][k]:.2f} |"
            f" {1e6 * stiffer.at[k]:.4f} | {stiffer.of('period_s')[k]:.9f} | {own[1][k]:.2f} |"
        )
    told = slopes(scene)
    table = [
        f"| {words} | {whole:+.6f} | {part:+.6f} | {whole - part:+.6f} |"
        for words, (whole, part) in (("moment of inertia", told["I"]), ("spring stiffness", told["k"]))
    ]
    left = max(abs(told["I"][0] - told["I"][1] - 0.5), abs(told["k"][0] - told["k"][1] + 0.5))
    return [
        "## Inertia, stiffness and the period",
        "",
        f"![Period over inertia and stiffness]({picture})",
        "",
        "| inertia, mg·cm² | period, s | own, ppm | stiffness, µN·m/rad | period, s | own, ppm |",
        "|---|---|---|---|---|---|",
        *rows,
        "",
        "*Own* is what the escapement adds to the period of balance and spring alone. Slopes in"
        " logarithms at the drawn values; the",
        "escapement's part follows from the derivatives by torque, damping and the other inertias,"
        " because forces and time have no",
        "unit of their own:",
        "",
        "| over | slope | of it the escapement | left |",
        "|---|---|---|---|",
        *table,
        "",
        f"What is left is ±1/2 to {left:.0e}.",
        "",
        f"*For a watch:* 1 % of inertia is 0.5 % of the period, {0.5 * 0.01 * DAY:.0f} s/d;"
        f" {2e6 / DAY:.0f} millionths are 1 s/d. What the"
        f" escapement adds is {np.min(own):.0f} to {np.max(own):.0f} ppm",
        f"({DAY * 1e-6 * np.min(own):.1f} to {DAY * 1e-6 * np.max(own):.1f} s/d), always a loss.",
        "",
    ]


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


def temperature(scene: ws.Scene) -> list[str]:
    """Rate over temperature, of a steel spring and of a compensating one, on a brass balance."""
    # Rate in 1 K: 86400·((β + 3 α_spring)/2 − α_balance), as k = E h e³/12L and I grows with α twice.
    steel = 2.0 * (BRASS - STEEL_AND_BRASS / DAY) - 3.0 * STEEL
    exact = 2.0 * BRASS - 3.0 * STEEL
    inertia, stiffness = scene.body("balance").inertia, scene.springs[0].stiffness
    rows, slopes_told = [], []
    figure, (axes,) = panels(1, height=60.0)
    for words, beta, colour in (("steel spring", steel, BLUE), ("compensating alloy", exact, GREEN)):
        cycles = []
        for kelvin in TEMPERATURES:
            heavy = inertia * (1.0 + BRASS * kelvin) ** 2
            stiff = stiffness * (1.0 + beta * kelvin) * (1.0 + STEEL * kelvin) ** 3
            warm = scene.set("bodies.balance.inertia", heavy).set("springs.0.stiffness", stiff)
            cycles.append(ws.steady(warm))
            free = DAY * (1.0 / (NOMINAL * free_period(heavy, stiff)) - 1.0)
            last = cycles[-1]
            assert last.rate_s_per_d is not None
            rows.append(
                f"| {words} | {kelvin:+.0f} | {last.amplitude_deg:.3f} | {last.rate_s_per_d:+.3f} | {free:+.3f} |"
                f" {last.rate_s_per_d - free:+.4f} |"
            )
        series = Series(TEMPERATURES, tuple(cycles))
        dots(axes, TEMPERATURES, series, "rate_s_per_d", words, colour)
        rate = series.of("rate_s_per_d")
        slopes_told.append((rate[-1] - rate[0]) / (TEMPERATURES[-1] - TEMPERATURES[0]))
    named(axes, "temperature from that of adjustment (K)", "rate (s/d)")
    picture = saved(figure, "temperature")
    return [
        "## Temperature",
        "",
        f"![Rate over temperature]({picture})",
        "",
        "Warmth makes the balance larger and the spring softer, longer and thicker (k = E h e³/12L). A"
        " brass balance alone loses 1.64 s/d",
        "in 1 K, a steel one 0.95 s/d ([HSN 161](http://www.hsn161.com/HSN/watches.php), after D."
        " Boettcher), which gives their expansion; with",
        f"a steel spring a brass balance loses about 11 s/d in 1 K ([Boettcher]({LOSS_TOLD})), which",
        f"gives {1e6 * steel:.0f}·10⁻⁶/K for the modulus of the steel. An alloy that compensates this balance needs"
        f" {1e6 * exact:+.1f}·10⁻⁶/K, for a spring that expands like steel.",
        "",
        "| | K | amplitude, ° | rate, s/d | balance and spring alone, s/d | escapement, s/d |",
        "|---|---|---|---|---|---|",
        *rows,
        "",
        f"With its escapement the watch with the steel spring changes by {slopes_told[0]:+.3f} s/d in 1"
        " K, with the alloy by"
        f" {slopes_told[1]:+.5f} s/d. Oil is not in this",
        "table: friction and damping are kept.",
        "",
        "*For a watch:* the escapement neither helps nor harms; temperature is a matter of spring and balance.",
        "",
    ]


def run_down() -> list[str]:
    """48 hours from full wind, by limit cycles at the torque of each hour."""
    hours = np.arange(0.0, 49.0, 2.0)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "scene.toml"
        file.write_text(WOUND_SCENE, encoding="utf-8")
        scene = ws.load(file)
        found = ws.sweep(scene, {"torques.0.run_down": (hours / HOURS_A_TURN * math.tau).tolist()})
    amplitude, rate = (np.array(found.column(name), float) for name in ("amplitude", "rate"))
    spring = scene.source["torques"][0]["table"]
    turns, at_barrel = (np.array([parse(row[i], kind) for row in spring]) for i, kind in enumerate((ANGLE, TORQUE)))
    torque = EFFICIENCY / RATIO * np.interp(hours / HOURS_A_TURN * math.tau, turns, at_barrel)
    figure, axes = panels(3, height=42.0)
    axes[0].plot(hours, 1e6 * torque, color=FLAT_COLOUR, **MARKED)
    named(axes[0], "", "torque (µN·m)", legend=False)
    axes[1].errorbar(hours, amplitude, found.column("amplitude_deg_error"), color=BLUE, **MARKED)
    named(axes[1], "", "amplitude (°)", legend=False)
    axes[2].errorbar(hours, rate, found.column("rate_s_per_d_error"), color=RED, **MARKED)
    named(axes[2], "hours since full wind", "rate (s/d)", legend=False)
    picture = saved(figure, "run_down")
    rows = [
        f"| {hours[i]:.0f} | {hours[i] / HOURS_A_TURN:.2f} | {1e6 * torque[i]:.3f} | {amplitude[i]:.2f} | {rate[i]:+.3f} |"
        for i in range(0, len(hours), 3)
    ]
    middle = 0.5 * (rate[1:] + rate[:-1]) * np.diff(hours) / 24.0
    first, second = float(np.sum(middle[:12])), float(np.sum(middle[12:]))
    return [
        "## Two days without winding",
        "",
        f"![Torque, amplitude and rate over 48 hours]({picture})",
        "",
        "An example, with the torque of an assumed mainspring. A watch settles within a minute, a mainspring runs down in days: so each",
        "hour is a limit cycle of its own, with the spring as far wound as it is then:",
        "",
        "```toml",
        *WOUND_SCENE.rstrip().split("\n"),
        "```",
        "",
        "```",
        'watchsim sweep my_watch "torques.0.run_down=0:7.11:25 rev" -o two_days',
        "```",
        "",
        "| hours | turns of the barrel | torque at the wheel, µN·m | amplitude, ° | rate, s/d |",
        "|---|---|---|---|---|",
        *rows,
        "",
        f"The rate falls from {rate[0]:+.2f} to {rate[12]:+.2f} s/d in 24 hours and to {rate[-1]:+.2f}"
        f" s/d in 48. The hands lose {-first:.2f} s on",
        f"the first day and {-second:.2f} s on the second.",
        "",
        "*For a watch:* wound every day it loses the same every day, which the regulator takes away;"
        " on a second day it falls back by",
        f"{first - second:.2f} s against that. Either the torque must stay (a stop work, a remontoir) or the impulse come nearer to the"
        " middle.",
        "",
    ]


def told(value: float, decimals: int) -> str:
    """With its sign, and 0 where nothing of it is left."""
    text = f"{value:+.{decimals}f}"
    return text if float(text) else "0"


def what_matters(scene: ws.Scene) -> list[str]:
    """All derivatives on the limit cycle."""
    found = ws.sensitivity(scene)
    picture = saved(plot_sensitivity(found), "sensitivity")
    rows = found.rows()
    agreeing = sum(1 for effect in found.effects if all(one.agrees for one in effect.by.values()))
    listed = [
        f"| `{row['key']}` | {row['value']:.5g} {row['unit']} | {row['change']} |"
        f" {told(row['amplitude_deg_per_change'], 3)} |"
        f" {told(row['rate_s_per_d_per_change'], 3)} | {told(row['beat_error_ms_per_change'], 4)} |"
        f" {row['message']} |"
        for row in rows[:14]
        if row["amplitude_deg_per_change"] is not None
    ]
    return [
        "## What matters",
        "",
        f"![Effects of all numbers of the scene]({picture})",
        "",
        f"Derivatives on the limit cycle by all {len(rows)} numbers of the scene (`watchsim sweep"
        " profiles/swiss_lever --sensitivity`), given as"
        " the effect of",
        "1 % more, 10 µm or 0.1°; the largest on the amplitude first. Two step sizes agree to 1 % in"
        f" {agreeing} of {len(rows)}; the others say so.",
        "",
        "| by | value | change | amplitude, ° | rate, s/d | beat error, ms | |",
        "|---|---|---|---|---|---|---|",
        *listed,
        "",
        "*For a watch:* stiffness and inertia alone carry the rate; torque and air the amplitude. Of"
        " the places, a hundredth of a millimetre between",
        "wheel and lever counts as much for the amplitude as 1 % of friction at the stones, and one"
        " sideways between balance, lever and banking is",
        "the beat error.",
        "",
    ]
