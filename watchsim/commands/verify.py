"""watchsim verify: are the closed-form and published benchmarks met?"""

from __future__ import annotations

import argparse

from watchsim.commands.console import FINE, MISSED, announce_compile, print_json

HELP = "closed-form and published benchmarks: expected, obtained, verdict"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--slow", action="store_true", help="also a hundred thousand random problems and the finest steps")
    parser.add_argument("--json", action="store_true", help="print one JSON list instead of a table")


def run(args: argparse.Namespace) -> int:
    from watchsim.results.tables import plain
    from watchsim.verification.verify import verify, verify_text

    announce_compile()
    rows = verify(args.slow)
    if args.json:
        print_json(plain(rows))  # what a run that ended early does not give is null
    else:
        print(verify_text(rows))
    return FINE if all(row["ok"] for row in rows) else MISSED
