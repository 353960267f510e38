"""The chapter on two days without winding: torque, amplitude and rate as a mainspring runs down."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path

import numpy as np
from swiss_pictures import BLUE, MARKED, RED, named, panels, saved

import watchsim as ws
from watchsim.units import ANGLE, TORQUE, parse

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
