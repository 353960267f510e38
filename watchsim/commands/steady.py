"""watchsim steady SCENE: the limit cycle itself, without simulating minutes."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

from watchsim.commands.console import FINE, MISSED, announce_compile, check_tolerance, print_json

if TYPE_CHECKING:
    from watchsim.studies.cycle import Cycle


HELP = "amplitude, rate and beat error that a watch settles to, without waiting for it"
LABEL = 13


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="SCENE", help="a scene file (TOML), or the folder that holds scene.toml")
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], help="change a value of the scene")
    parser.add_argument(
        "--tol", "--tolerance", metavar="X", type=float, help="relative error per step (default: the scene's, 1e-9)"
    )
    parser.add_argument("--all", action="store_true", help="every cycle, stable or not, and which swings lead to which")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import load_scene
    from watchsim.studies.steady import steady

    check_tolerance(args.tol)
    scene = load_scene(args.scene, args.set)
    announce_compile()
    cycle = steady(scene, tolerance=args.tol, all_cycles=args.all)
    if args.json:
        from watchsim.results.tables import plain

        print_json(plain(cycle.numbers()))
    else:
        print(text(scene.title, cycle))
    return FINE if cycle.found else MISSED


def text(title: str, cycle: Cycle) -> str:
    """The cycle for people, a line each."""
    lines = []
    for value, error, label, unit in (
        (cycle.amplitude_deg, cycle.amplitude_deg_error, "amplitude", "°"),
        (cycle.rate_s_per_d, cycle.rate_s_per_d_error, "rate", " s/d"),
        (cycle.beat_error_ms, cycle.beat_error_ms_error, "beat error", " ms"),
        (cycle.period_s, cycle.period_s_error, "period", " s"),
    ):
        if value is not None:
            lines.append((label, with_error(value, error, unit)))
    for multiplier in cycle.multipliers:
        each = "each oscillation" if cycle.oscillations == 1 else f"{cycle.oscillations} oscillations"
        stable = "stable" if abs(multiplier) < 1.0 else "unstable"
        lines.append(("multiplier", f"{multiplier:.6f} of a small disturbance is left after {each}; {stable}"))
    if (cycle.tooth_spread_deg or 0.0) > (cycle.amplitude_deg_error or 0.0) and cycle.oscillations > 1:
        lines.append(("teeth", f"they differ: the amplitude varies by {cycle.tooth_spread_deg:.2g}° in a turn of the wheel"))
    if cycle.verdict:
        lines.append(("verdict", cycle.verdict))
    if cycle.message:
        lines.append(("", cycle.message) if lines else ("cycle", cycle.message))
    lines += all_cycles(cycle)
    cells = f", {cycle.cells_s:.2g} s of it for the search for candidate contacts" if cycle.cells_s >= 5e-3 else ""
    lines.append(("computed", f"{cycle.simulated_s:.3g} s simulated in {cycle.wall_s:.2g} s{cells}"))
    return "\n".join([title, *(f"  {label:{LABEL}}{words}".rstrip() for label, words in lines)])


def all_cycles(cycle: Cycle) -> list[tuple[str, str]]:
    """Every cycle, and what becomes of swings of all sizes; nothing where that was not requested."""
    lines = []
    for number, one in enumerate(cycle.cycles or (), 1):
        swings = " and ".join(f"{amplitude:.6g}°" for amplitude in one.amplitudes_deg)
        turns = f", {len(one.amplitudes_deg)} oscillations in turn" if len(one.amplitudes_deg) > 1 else ""
        left = "" if one.multiplier is None else f", multiplier {one.multiplier:.6f}"
        kind = "stable" if one.stable else "unstable"
        rate = f"{one.rate_s_per_d:.3f}".replace("-", "−")
        lines.append((f"cycle {number}", f"{swings}{turns}, {rate} s/d{left}; {kind}"))
    for place, start in enumerate(cycle.starts or ()):
        end = start.verdict if start.cycle is None else f"leads to cycle {start.cycle + 1}"
        sign = "−" if start.side < 0 else "+"
        lines.append(("" if place else "released at", f"{sign}{start.from_deg:.4g}° to {sign}{start.to_deg:.4g}°: {end}"))
    if cycle.cycles is not None and not cycle.cycles:
        lines.append(("cycles", "none at any swing examined"))
    return lines


def with_error(value: float, error: float | None, unit: str) -> str:
    """ "279.26990530° ± 7e-08°": digits down to the error's first, a true minus sign."""
    import math

    usable = error is not None and math.isfinite(error) and error > 0.0
    decimals = min(max(0, -math.floor(math.log10(error))), 12) if usable and error is not None else 6
    shown = f"{value:.{decimals}f}".replace("-", "−")
    return f"{shown}{unit} ± {error:.1g}{unit}" if usable else f"{shown}{unit}"
