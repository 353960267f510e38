"""watchsim schema: the JSON Schema of a scene file, by which editors complete and check it; or the paths for --set."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path

from watchsim.commands.completion import SHELLS, script
from watchsim.commands.console import FINE, print_json

HELP = "the JSON Schema of a scene file (Draft 4), for editors; or the paths of one for --set"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("-o", "--output", metavar="FILE", help="write it there instead of printing it")
    parser.add_argument("--paths", metavar="SCENE", help="list the paths of that scene, each with its value, instead")
    parser.add_argument(
        "--completion", metavar="SHELL", choices=SHELLS, help="print what completes commands in bash, zsh or fish"
    )
    parser.add_argument("--json", action="store_true", help="print one JSON object (the schema is one)")


def run(args: argparse.Namespace) -> int:
    from watchsim.commands.inputs import secured_file
    from watchsim.scene.assign import paths_of
    from watchsim.scene.load import load
    from watchsim.scene.schema import schema_text
    from watchsim.storage.write import write_file

    if args.completion:
        sys.stdout.write(script(args.top, args.completion))
    elif args.paths:
        found = paths_of(load(args.paths).source)
        if args.json:
            print_json(found)
        else:
            print("\n".join(f"{path}={value}" for path, value in found.items()))
    elif args.output:
        path = secured_file(Path(args.output), "the schema")
        write_file(path, lambda place: place.write_text(schema_text(), encoding="utf-8"), "the schema")
    else:
        sys.stdout.write(schema_text())
    return FINE
