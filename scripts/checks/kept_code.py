"""Which machine code still holds when one file has changed?

The cache of kernels is keyed by all their sources together. What was compiled from files that do not import the changed one,
not even through others, is handed on to the new key: `python kept_code.py KEY FILE`, with the key before the change and the
file's path in the package, writes there and prints the new key; without arguments it only prints the key. Tests' own kernels
are not handed on.
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from watchsim.machine_code import PACKAGE, _imported, _reachable_sources, cache_folder


def dependents(changed: Path) -> set[str]:
    """The names (without .py) of the files that import a file, directly or not, and its own."""
    sources = {Path(path): text.decode() for path, text in _reachable_sources(PACKAGE).items()}
    imported = {path: {Path(one) for one in _imported(PACKAGE, text)} for path, text in sources.items()}
    found = {changed}
    while more := {path for path, uses in imported.items() if uses & found} - found:
        found |= more
    return {path.stem for path in found}


def hand_on(before: Path, after: Path, changed: Path) -> None:
    """Copy what does not depend on the changed file."""
    known = {path.stem for path in PACKAGE.rglob("*.py")} - dependents(changed)
    for path in before.glob("*/*.nb?"):
        if path.name.split(".", 1)[0] in known and not path.parent.name.startswith("tests"):
            (after / path.parent.name).mkdir(exist_ok=True)
            shutil.copy2(path, after / path.parent.name / path.name)


if __name__ == "__main__":
    now = cache_folder()
    assert now is not None
    if sys.argv[1:]:
        key, file = sys.argv[1:]
        if now.name != key:
            hand_on(now.parent / key, now, PACKAGE / file)
    print(now.name)
