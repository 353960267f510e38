"""How does a process of the command line begin and end?

It hears signals before it loads anything, and when its command is done it is done: nothing that runs while an interpreter is
taken apart can change the exit status any more. Only what calls `process` imports this module: from here on signals wait.
"""

import _signal as signal  # type: ignore[import-not-found]  # built in: nothing to load

HEARD = (signal.SIGINT, signal.SIGTERM)
if hasattr(signal, "pthread_sigmask"):  # what comes while nobody listens yet waits; so, too, while a start script goes on
    signal.pthread_sigmask(signal.SIG_BLOCK, HEARD)

TYPE_CHECKING = False  # as in typing, whose import would leave Ctrl-C unheard for some milliseconds
if TYPE_CHECKING:
    from typing import NoReturn

PROMPT = 5e-4  # s that a thread may keep Python from another: 5 ms, as usual, would hold up whoever has only little to do


def process() -> "NoReturn":
    """Run the command line of this process, and end it."""
    from watchsim import stopping
    from watchsim.memory import tidy_seldom

    stopping.install()
    if hasattr(signal, "pthread_sigmask"):
        signal.pthread_sigmask(signal.SIG_UNBLOCK, HEARD)
    import atexit
    import os
    import sys

    tidy_seldom()
    sys.setswitchinterval(PROMPT)
    from watchsim.commands.console import lost_output, open_streams

    open_streams()
    from watchsim.cli import main

    try:
        status = main()
    except SystemExit as stop:  # argparse: --help, --version, what cannot be parsed
        status = stop.code if isinstance(stop.code, int) else int(stop.code is not None)
    atexit._run_exitfuncs()
    lost = lost_output()
    if lost:
        from watchsim.commands.console import BAD_INPUT, say

        say(f"What was printed could not all be written: {lost}. Send it to another place.")
        status = max(status, BAD_INPUT)
    number = stopping.last_word()
    os._exit(128 + number if number else status)
