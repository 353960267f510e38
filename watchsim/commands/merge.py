"""watchsim merge STUDY ...: combines the shards of a study, wherever they were computed."""

from __future__ import annotations

import argparse
import contextlib
from pathlib import Path

from watchsim.commands.console import FINE, MISSED, InputError, say
from watchsim.commands.tolerance import show

HELP = "combine the shards of a study (watchsim tolerance --shard)"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("studies", metavar="STUDY", nargs="+", help="results folders of watchsim tolerance")
    parser.add_argument("-o", "--output", metavar="DIR", required=True, help="results folder of the combined study")
    parser.add_argument("--force", action="store_true", help="replace a study that exists there")
    parser.add_argument("--no-plots", action="store_true", help="write no plots")
    parser.add_argument("--json", action="store_true", help="print one JSON object")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import claimed, secured_folder
    from watchsim.studies.tolerance import merge

    folder = Path(args.output)
    if any(folder.resolve() == Path(one).resolve() for one in args.studies):
        raise InputError(f"{folder} is one of the shards: choose another folder (-o).")
    secured_folder(folder, "results")
    if folder.is_dir() and any(folder.iterdir()) and not args.force:
        raise InputError(f"{folder} exists already. Replace it (--force), or choose another folder (-o).")
    folder.mkdir(exist_ok=True)
    with contextlib.ExitStack() as held:
        held.enter_context(claimed(folder))
        done = merge(args.studies, folder)
        show(done, folder, args.no_plots, args.json)
    if not done.whole:
        say("Samples are missing: not all shards are there, or some are not finished.")
        return MISSED
    return FINE
