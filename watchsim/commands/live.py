"""watchsim live SCENE: a page on this machine that follows every save of the scene and its drawings."""

from __future__ import annotations

import argparse
import os
import threading
from pathlib import Path

from watchsim import stopping
from watchsim.commands.console import FINE, InputError, announce_compile, say

HELP = "a local page that follows every save of scene and drawings"
MISSING = "live needs a server that is not installed here ({}): pip install 'watchsim[live]'"


def options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("scene", metavar="SCENE", help="a scene file (TOML), or the folder that holds scene.toml")
    parser.add_argument("--port", metavar="N", type=int, default=0, help="port of the page's address (default: a free one)")
    parser.add_argument("--no-browser", action="store_true", help="only print the address")


def run(args: argparse.Namespace) -> int:
    from watchsim.scene.load import scene_file

    try:
        from watchsim.live.server import Live
    except ModuleNotFoundError as error:
        raise InputError(MISSING.format(error.name)) from error
    path = scene_file(Path(args.scene)).absolute()
    if not path.is_file():
        raise InputError(f"{args.scene}: there is no such scene file.")
    if not 0 <= args.port <= 65535:
        raise InputError(f"--port {args.port}: a port lies between 1 and 65535; 0 takes a free one.")
    try:
        live = Live(path, args.port)
    except OSError as error:
        raise InputError(f"--port {args.port}: {os.strerror(error.errno or 0)}. Choose another port, or none.") from error
    announce_compile()
    with stopping.held():  # at the first Ctrl-C the server ends, and with it the process that computes
        live.serve(lambda url: _open(url, args.no_browser))
    return stopping.status() if stopping.requested() else FINE


def _open(url: str, only_print: bool) -> None:
    import webbrowser

    print(url, flush=True)
    say("Following every save; Ctrl-C ends it.")

    def show() -> None:
        if not webbrowser.open(url):
            say("There is no browser here to open it; open the address above yourself.")

    if not only_print:
        threading.Thread(target=show, daemon=True).start()  # a browser in the terminal stays until it is left
