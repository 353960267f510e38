"""Which machine code still holds when one file has changed?

The cache of kernels is keyed by all their sources together. What was compiled from files that do not import the changed one,
not even through others, is handed on to the new key: `python kept_code.py KEY FILE`, with the key before the change and the
file's path in the package, writes there and prints the new key; without arguments it only prints the key. Tests' own kernels
are not handed on.
"""

from __future__ import annotations

import argparse
import ast
import shutil
from collections.abc import Iterator
from pathlib import Path

from watchsim.jit_cache import PACKAGE, cache_folder


def dependents(changed: Path) -> set[str]:
    """The names (without .py) of the files that import a file, directly or not, and its own."""
    imported = {path: set(_imported(path)) for path in PACKAGE.rglob("*.py")}
    found = {changed}
    while more := {path for path, uses in imported.items() if uses & found} - found:
        found |= more
    return {path.stem for path in found}


def _imported(path: Path) -> Iterator[Path]:
    """The files that a file may import from, at its top or within a function."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.split(".")[0] == PACKAGE.name:
            module = PACKAGE.joinpath(*node.module.split(".")[1:])
            yield from (module.with_suffix(".py"), *(module / f"{name.name}.py" for name in node.names))


def hand_on(before: Path, after: Path, changed: Path) -> None:
    """Copy what does not depend on the changed file."""
    known = {path.stem for path in PACKAGE.rglob("*.py")} - dependents(changed)
    for path in before.glob("*/*.nb?"):
        if path.name.split(".", 1)[0] in known and not path.parent.name.startswith("tests"):
            (after / path.parent.name).mkdir(exist_ok=True)
            shutil.copy2(path, after / path.parent.name / path.name)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("key", nargs="?", help="of the sources before the change")
    parser.add_argument("file", nargs="?", type=Path, help="what has changed, its path in the package")
    given = parser.parse_args()
    now = cache_folder()
    assert now is not None
    if given.key and given.file and now.name != given.key:
        hand_on(now.parent / given.key, now, PACKAGE / given.file)
    print(now.name)


if __name__ == "__main__":
    main()
