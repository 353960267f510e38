"""How do shells complete what is typed? A script for each, made by shtab from the parser; behind --set stand the paths of the
scene that the line names."""

from __future__ import annotations

import argparse

SHELLS = ("bash", "zsh", "fish")
FILES = ("SCENE", "RUN", "FILE", "DRAWING", "FILE.wav", "MEASURED", "DESIGN")  # metavars behind which a path stands
PATHS = "_watchsim_paths"
LISTED = 'watchsim schema --paths "$word" 2>/dev/null | sed "s/=.*/=/"'
PREAMBLE = {
    "bash": f"""{PATHS}() {{
  local word
  for word in "${{COMP_WORDS[@]:2}}"; do
    if [[ -e $word ]]; then compgen -W "$({LISTED})" -- "$1"; return; fi
  done
}}
""",
    "zsh": f"""{PATHS}() {{
  local word
  for word in "${{words[@]:2}}"; do
    if [[ -e $word ]]; then compadd -S '' -- ${{(f)"$({LISTED})"}}; return; fi
  done
}}
""",
    "fish": f"""function {PATHS}
  for word in (commandline -opc)[3..]
    if test -e "$word"; {LISTED}; return; end
  end
end
""",
}


def script(parser: argparse.ArgumentParser, shell: str) -> str:
    """The text that the shell reads, for the whole command line."""
    import shtab

    paths = {"bash": PATHS, "zsh": PATHS, "fish": f"({PATHS})"}
    for action in _actions(parser):
        if "--set" in action.option_strings:
            action.complete = paths  # type: ignore[attr-defined]
        elif action.metavar in FILES:
            action.complete = shtab.FILE  # type: ignore[attr-defined]
        elif action.metavar == "DIR":
            action.complete = shtab.DIRECTORY  # type: ignore[attr-defined]
    return str(shtab.complete(parser, shell, root_prefix="watchsim", preamble=PREAMBLE[shell]))


def _actions(parser: argparse.ArgumentParser) -> list[argparse.Action]:
    """Those of all commands."""
    subs = next(one for one in parser._actions if isinstance(one, argparse._SubParsersAction))
    return [action for sub in subs.choices.values() for action in sub._actions]
