"""watchsim card RUN: one picture to share, with phase, forces and timing."""

from __future__ import annotations

import argparse
from pathlib import Path

from watchsim.commands.console import FINE, parse_positive

HELP = "a picture to share: mechanism, phase, forces, timing"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("run_folder", metavar="RUN", help="a results folder")
    parser.add_argument("--time", metavar="TIME", help='the instant shown, such as "1.234 s" (default: in the last impulse)')
    parser.add_argument("--gif", action="store_true", help="the last oscillation in 5 s, slow where things happen")
    parser.add_argument("--dark", action="store_true", help="with a dark background")
    parser.add_argument("-o", "--output", metavar="FILE", help="file.png or file.gif (default RUN/card.png, RUN/card.gif)")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import read_run, secured_file, swept_run
    from watchsim.render.card import card, check_card
    from watchsim.results.folder import read_summary
    from watchsim.units import TIME

    instant = None if args.time is None else parse_positive("--time", args.time, TIME)
    swept_run(args.run_folder)
    trajectory = read_run(args.run_folder)
    name = args.output or Path(args.run_folder) / ("card.gif" if args.gif else "card.png")
    target = secured_file(check_card(name), "the card")
    print(card(trajectory, target, instant, dark=args.dark, numbers=read_summary(args.run_folder)))
    return FINE
