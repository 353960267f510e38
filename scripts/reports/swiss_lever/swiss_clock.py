"""Chapters on what keeps the time: inertia and stiffness, temperature, and what matters most."""

from __future__ import annotations

import numpy as np
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
)

import watchsim as ws
from watchsim.render.figures.effects_plot import plot_sensitivity

# Expansion of brass and steel, 1/K: what a brass or steel balance alone loses, 1.64 and 0.95 s/d in 1 K (D. Boettcher's
# spreadsheet, described at hsn161.com/HSN/watches.php), divided by 86400. The loss of a steel spring on a brass balance, about
# 11 s/d in 1 K, is from his article at bwcmg.org, "Nickel Steel Balance Spring".
BRASS, STEEL = 1.64 / DAY, 0.95 / DAY
LOSS_TOLD = "https://bwcmg.org/index.php/2024/09/10/nickel-steel-balance-spring-a-major-development-in-watchmaking"
STEEL_AND_BRASS = 11.0  # s/d in 1 K
TEMPERATURES = np.array([-15.0, -10.0, -5.0, 0.0, 5.0, 10.0, 15.0])  # K from that of adjustment


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
