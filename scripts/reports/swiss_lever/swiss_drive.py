"""Chapters on what drives and brakes the Swiss lever: torque, the best possible amplitude, friction and restitution."""

from __future__ import annotations

import math
import re

import numpy as np
from swiss_pictures import BLUE, CURVE, GOLD, GREEN, MARKED, RED, dots, line, named, panels, saved
from swiss_studies import (
    DAY,
    JEWEL,
    STONES,
    Floats,
    Series,
    amplitude_of_work,
    both,
    everywhere,
    over,
    over_torque,
    work_per_beat,
)

import watchsim as ws

MICRO = 1e-6
TORQUES = np.linspace(0.2, 1.5, 27) * MICRO  # N·m
LISTED = (0.2, 0.4, 0.6, 0.8, 1.0, 1.2, 1.4)  # µN·m, with a line in the table
COMMON = 200.0  # °, where two ways to a low amplitude are compared
LOSSLESS_RUN = 120.0  # s: without damping a cycle takes so long to settle


def torque(scene: ws.Scene, series: Series) -> list[str]:
    """Amplitude over torque, beside the square-root law twice: drawn through one point, and of the measured work."""
    at, amplitude = series.at / MICRO, series.of("amplitude_deg")
    here = int(np.argmin(abs(at - 1.0)))
    law = amplitude[here] * np.sqrt(at / at[here])
    works, predicted = _by_work(scene, series)
    picture = _torque_picture(series, law, predicted)
    pitch = math.pi / 15.0  # rad of the wheel in a beat
    rows = []
    for one in LISTED:
        i = int(np.argmin(abs(at - one)))
        share = works[i] / (series.at[i] * pitch)
        rows.append(
            f"| {at[i]:.2f} | {amplitude[i]:.4f} ± {series.of('amplitude_deg_error')[i]:.0e} | {law[i]:.2f} |"
            f" {1e9 * works[i]:.2f} | {100.0 * share:.2f} % | {predicted[i]:.4f} |"
            f" {amplitude[i] / predicted[i] - 1.0:+.1e} |"
        )
    off, worst = np.nanmax(abs(amplitude / law - 1.0)), np.nanmax(abs(amplitude / predicted - 1.0))
    knocking = [a for a, cycle in zip(at, series.cycles, strict=True) if cycle.verdict == "knocks"]
    end = (
        f"From {knocking[0]:.2f} µN·m on the watch knocks."
        if knocking
        else "Up to the largest of these torques it does not knock."
    )
    return [
        "## Torque and amplitude",
        "",
        f"![Amplitude over torque]({picture})",
        "",
        "| torque, µN·m | amplitude, ° | √ law, ° | work per beat, nJ | of the wheel's | √ of the work, ° | off |",
        "|---|---|---|---|---|---|---|",
        *rows,
        "",
        "With viscous damping alone the balance loses πcωA²/2 in a beat, so that A = √(2w/(πcω)) for a"
        " work w per beat. The work is",
        "measured on the motion itself, from the balance's energy before the jewel enters the fork and"
        " after it leaves; the law then",
        f"holds to {worst:.1e} of the amplitude. If the escapement passed on the same share of the"
        " wheel's work at any torque, the",
        f"amplitude would grow with √torque; it does to {100.0 * off:.1f} %, because the share hardly changes. {end}",
        "",
        "*For a watch:* a mainspring that loses 20 % of its torque costs 10 % of the amplitude, not 20"
        " %; and half the amplitude is",
        "left at a quarter of the torque.",
        "",
    ]


def _by_work(scene: ws.Scene, series: Series) -> tuple[Floats, Floats]:
    """The work per beat (J) at each torque, and the amplitude (°) that it keeps up; nan where there is no limit cycle."""
    works, predicted = np.full(len(series.at), math.nan), np.full(len(series.at), math.nan)
    for i, cycle in enumerate(series.cycles):
        if cycle.found:
            changed = scene.set("torques.0.value", -float(series.at[i]))
            works[i] = work_per_beat(changed, cycle)
            predicted[i] = amplitude_of_work(changed, cycle, works[i])
    return works, predicted


def _torque_picture(series: Series, law: Floats, predicted: Floats) -> str:
    at, amplitude = series.at / MICRO, series.of("amplitude_deg")
    figure, (above, below) = panels(2, height=58.0)
    dots(above, at, series, "amplitude_deg", "limit cycles", BLUE)
    line(above, at, law, "A ∝ √torque, through 1 µN·m")
    named(above, "", "amplitude (°)")
    below.plot(at, 100.0 * (amplitude / law - 1.0), color=BLUE, **MARKED, label="against A ∝ √torque")
    below.plot(
        at, 100.0 * (amplitude / predicted - 1.0), color=RED, **{**MARKED, "marker": "s"}, label="against √(measured work)"
    )
    named(below, "torque at the escape wheel (µN·m)", "amplitude beyond the law (%)")
    return saved(figure, "torque")


def best(scene: ws.Scene, drawn: Series) -> list[str]:
    """The best amplitude: without friction, then without any loss but impacts."""
    smooth = everywhere(scene, "friction", 0.0)
    without = over_torque(smooth, TORQUES[: int(np.argmin(abs(TORQUES - 0.95 * MICRO))) + 1])
    bare = smooth.set("damping.0.viscous", 0.0).set("run.duration", f"{LOSSLESS_RUN:g} s")
    small = np.array([0.02, 0.04, 0.06, 0.08, 0.1, 0.12]) * MICRO
    impacts = {e: over_torque(everywhere(bare, "restitution", e), small) for e in (0.0, 0.2)}
    picture = _best_picture(drawn, without, impacts[0.2])
    rows = []
    for one in (0.2, 0.4, 0.6, 0.8):
        i, j = (int(np.argmin(abs(s.at / MICRO - one))) for s in (drawn, without))
        a, b = drawn.of("amplitude_deg")[i], without.of("amplitude_deg")[j]
        rows.append(f"| {one:.1f} | {a:.2f} | {b:.2f} | {100.0 * (b / a - 1.0):.1f} % |")
    last = without.of("amplitude_deg")
    hit = [1e6 * t for t, cycle in zip(small, impacts[0.0].cycles, strict=True) if cycle.verdict == "knocks"]
    knocks = f" At {hit[0]:.2f} µN·m it knocks." if hit else ""
    reached = int(np.nanargmax(last))
    return [
        "## The best possible amplitude",
        "",
        f"![Amplitude over torque with fewer losses]({picture})",
        "",
        "| torque, µN·m | as drawn, ° | no friction, ° | more |",
        "|---|---|---|---|",
        *rows,
        "",
        f"Without friction anywhere the amplitude rises to {last[reached]:.1f}° at"
        f" {1e6 * without.at[reached]:.2f} µN·m; with more torque"
        " it knocks.",
        "",
        "Without friction and without air nothing is left but the impacts: the wheel that falls on the"
        " stones, the jewel that meets",
        "the fork. Geometry and inertias force them. They take the more the faster the balance is, and"
        " so limit the swing even then:",
        "",
        "| torque, µN·m | restitution 0, ° | restitution 0.2, ° |",
        "|---|---|---|",
        *_lossless(impacts[0.0], impacts[0.2]),
        "",
        f"These are ends of runs of {LOSSLESS_RUN:.0f} s, for such a watch settles slowly.{knocks}",
        "",
        "*For a watch:* polishing and oil have a bound, and it is in sight in the first table; what is"
        " beyond it belongs to the air,",
        "to the pivots and to the mass of wheel and lever.",
        "",
    ]


def _best_picture(drawn: Series, without: Series, impacts: Series) -> str:
    figure, (axes,) = panels(1, height=75.0)
    dots(axes, drawn.at / MICRO, drawn, "amplitude_deg", "as drawn: friction 0.12, air", BLUE)
    dots(axes, without.at / MICRO, without, "amplitude_deg", "no friction, air", GREEN, "s")
    dots(axes, impacts.at / MICRO, impacts, "amplitude_deg", "no friction, no air: impacts alone", RED, "^")
    for cycle in drawn.cycles:
        if seen := re.search(r"from outside at (\d+)°", cycle.message):
            knock = f"the jewel reaches the back of the fork ({seen[1]}°)"
            axes.axhline(float(seen[1]), color=GOLD, linestyle=":", linewidth=CURVE, label=knock)
            break
    named(axes, "torque at the escape wheel (µN·m)", "amplitude (°)")
    return saved(figure, "best")


def _lossless(dead: Series, lively: Series) -> list[str]:
    """Rows of the table: the amplitudes where impacts alone take energy, at two restitutions."""
    columns = (one.of(name) for one in (dead, lively) for name in ("amplitude_deg", "amplitude_deg_error"))
    return [
        f"| {1e6 * t:.2f} | {a:.2f} ± {ea:.0e} | {b:.2f} ± {eb:.0e} |"
        for t, a, ea, b, eb in zip(dead.at, *columns, strict=True)
        if np.isfinite(a + b)
    ]


def friction(scene: ws.Scene) -> list[str]:
    """Friction at stones and jewel, and restitution."""
    values = np.linspace(0.0, 0.2, 11)
    weaker = scene.set("torques.0.value", "-0.8 µN·m")  # at the drawn torque the frictionless watch knocks
    stones = over(weaker, f"contacts.{STONES}.friction", values)
    jewel = over(weaker, f"contacts.{JEWEL}.friction", values)
    bounce = both(weaker, "restitution", np.linspace(0.0, 0.5, 11))
    figure, axes = panels(2, 2, share=False, height=55.0)
    for upper, name, label in ((True, "amplitude_deg", "amplitude (°)"), (False, "rate_s_per_d", "rate (s/d)")):
        left, right = axes[:2] if upper else axes[2:]
        dots(left, stones.at, stones, name, "wheel on stones", BLUE)
        dots(left, jewel.at, jewel, name, "jewel in fork", RED, "s")
        named(left, "" if upper else "friction coefficient", label)
        dots(right, bounce.at, bounce, name, "all contacts", GREEN, "^")
        named(right, "" if upper else "restitution", label)
    picture = saved(figure, "friction")
    a, r = stones.of("amplitude_deg"), stones.of("rate_s_per_d")
    b, s = jewel.of("amplitude_deg"), jewel.of("rate_s_per_d")
    e, f = bounce.of("amplitude_deg"), bounce.of("rate_s_per_d")
    rows = [f"| {values[i]:.2f} | {a[i]:.3f} | {r[i]:+.3f} | {b[i]:.3f} | {s[i]:+.3f} |" for i in range(0, len(values), 2)]
    return [
        "## Friction and restitution",
        "",
        f"![Amplitude and rate over friction and restitution]({picture})",
        "",
        "At 0.8 µN·m, where the watch does not knock even without friction; what is not varied is as drawn.",
        "",
        "| coefficient | stones: amplitude, ° | rate, s/d | jewel: amplitude, ° | rate, s/d |",
        "|---|---|---|---|---|",
        *rows,
        "",
        f"Friction at the stones from 0 to {values[-1]:.1f} takes {a[0] - a[-1]:.1f}° of amplitude and"
        " changes the rate by"
        f" {r[-1] - r[0]:+.2f} s/d; at the",
        f"jewel {b[0] - b[-1]:.1f}° and {s[-1] - s[0]:+.2f} s/d. Restitution from 0 to 0.5 changes the"
        " amplitude by no more than"
        f" {np.nanmax(e) - np.nanmin(e):.2f}° and the rate by {np.nanmax(f) - np.nanmin(f):.3f} s/d.",
        "",
        "*For a watch:* oil the stones first. The restitution of ruby and steel need not be known: it hardly matters here.",
        "",
    ]


def isochronism(scene: ws.Scene, series: Series) -> list[str]:
    """Rate over amplitude, by torque and by damping, beside Airy's law."""
    damping = scene.damping[0].viscous
    braked = over(scene, "damping.0.viscous", np.array([0.8, 0.9, 1.0, 1.2, 1.5, 2.0, 3.0, 4.0]) * damping)
    amplitude, rate = series.of("amplitude_deg"), series.of("rate_s_per_d")
    quality = math.sqrt(scene.springs[0].stiffness * scene.body("balance").inertia) / damping
    late = -rate * 2.0 * quality * amplitude / DAY  # ° behind the middle, by Airy
    good = np.isfinite(late)
    mean = float(np.mean(late[good]))
    law = -DAY * mean / (2.0 * quality * amplitude)
    slower = braked.of("amplitude_deg") * math.nan
    for i, factor in enumerate(braked.at / damping):
        slower[i] = -braked.of("rate_s_per_d")[i] * 2.0 * quality / factor * braked.of("amplitude_deg")[i] / DAY
    figure, (axes,) = panels(1, height=75.0)
    dots(axes, amplitude, series, "rate_s_per_d", "torque 0.2 to 1.5 µN·m", BLUE)
    dots(axes, braked.of("amplitude_deg"), braked, "rate_s_per_d", "damping × 4 to × 0.8, at 1 µN·m", RED, "s")
    line(axes, amplitude[good], law[good], f"Airy: impulse {mean:.1f}° late")
    named(axes, "amplitude (°)", "rate (s/d)")
    picture = saved(figure, "isochronism")
    at = series.at / MICRO
    rows = [
        f"| {at[i]:.2f} | {amplitude[i]:.2f} | {rate[i]:+.4f} ±"
        f" {series.of('rate_s_per_d_error')[i]:.0e} | {law[i]:+.3f} | {late[i]:.2f} |"
        for i in (int(np.argmin(abs(at - one))) for one in LISTED)
        if good[i]
    ]
    i, j = (int(np.nanargmin(abs(amplitude - a))) for a in (270.0, 220.0))
    sagged = float(np.interp(COMMON, amplitude[good], rate[good]))
    thick = float(np.interp(COMMON, braked.of("amplitude_deg")[::-1], braked.of("rate_s_per_d")[::-1]))
    return [
        "## Rate over amplitude (isochronism)",
        "",
        f"![Rate over amplitude]({picture})",
        "",
        "| torque, µN·m | amplitude, ° | rate, s/d | Airy, s/d | impulse late by, ° |",
        "|---|---|---|---|---|",
        *rows,
        "",
        "The balance's spring is linear, so the whole error is the escapement's. Airy's rule says that"
        " a short impulse centred θ̄ after",
        f"the middle loses 86400·θ̄/(2QA) s/d: with Q = {quality:.0f} the rates of all torques tell a θ̄ of"
        f" {np.min(late[good]):.2f}° to {np.max(late[good]):.2f}°, with",
        f"the damping changed instead {np.nanmin(slower):.2f}° to {np.nanmax(slower):.2f}°. Unlocking"
        " before the middle and impulse"
        " after it both lose.",
        "",
        f"*For a watch:* from {amplitude[i]:.0f}° down to {amplitude[j]:.0f}° it goes"
        f" {rate[j] - rate[i]:+.2f} s/d by the escapement alone, when"
        " the torque sags: the loss grows as 1/A.",
        "When the air or the oil brakes more instead, A falls with √Q and the loss grows as 1/A³: at"
        f" {COMMON:.0f}° it is {sagged:+.2f} s/d with"
        f" less torque and {thick:+.2f} s/d",
        "with more damping. The amplitude alone does not tell the rate.",
        "",
    ]
