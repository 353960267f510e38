"""Does the repository need nothing that lies beside it?"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
DOOR = "tests/strangers.py"  # the one place that may look outside
TEXT = {".py", ".toml", ".md", ".sh", ".ipynb", ".yaml", ""}
OUT = re.compile(
    r"""(?P<up>(?:\.\./)+)|parents\[(?P<index>\d+)\](?P<parent>\.parent)?|\bROOT\.parents?\b|/ ["']\.\.["']|os\.pardir"""
)


def leaving(path: str, text: str) -> list[str]:
    """What in a file (its path in the repository, its text) names a place outside."""
    depth = path.count("/")

    def leaves(found: re.Match[str]) -> bool:
        if found["up"]:
            return found["up"].count("/") > depth
        return found["index"] is None or int(found["index"]) + bool(found["parent"]) > depth

    return [found.group() for found in OUT.finditer(text) if leaves(found)]


@pytest.mark.parametrize(
    ("path", "text", "out"),
    [
        ("tests/a/b.py", 'parents[2] / "docs"', False),
        ("tests/a/b.py", 'parents[3] / "shared"', True),
        ("tests/a/b.py", 'parents[2].parent / "shared"', True),
        ("tests/b.py", "ROOT.parent", True),
        ("tests/b.py", 'folder / ".."', True),
        ("docs/guide/a.md", "../images/a.png", False),
        ("tests/a/scene.toml", "../../../shared/a.dxf", True),
    ],
)
def test_what_leaves_is_recognised(path: str, text: str, out: bool) -> None:
    assert bool(leaving(path, text)) is out


def test_nothing_leaves_the_repository_but_at_one_place() -> None:
    tops = [ROOT / name for name in ("tests", "scripts", "docs", "profiles", "watchsim", ".ci")]
    files = [path for top in tops for path in top.rglob("*") if path.is_file() and path.suffix in TEXT] + list(
        ROOT.glob("*.md")
    )
    own = {Path(__file__).relative_to(ROOT).as_posix()}
    assert len(files) > 500
    found = {
        name: leaving(name, path.read_text(encoding="utf-8"))
        for path in files
        if (name := path.relative_to(ROOT).as_posix()) not in own
    }
    assert [name for name, places in found.items() if places] == [DOOR]
