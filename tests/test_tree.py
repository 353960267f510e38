"""Can a file be found by its name alone: each name once, and no folder that is too long to read at a glance?"""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
MOST = 16  # files in one folder


def sources(top: str) -> list[Path]:
    return [path for path in (ROOT / top).rglob("*.py") if path.name not in ("__init__.py", "conftest.py")]


@pytest.mark.parametrize("top", ["watchsim", "tests"])
def test_each_file_name_occurs_once(top: str) -> None:
    found = Counter(path.name for path in sources(top))
    assert sum(found.values()) > 100
    assert [name for name, count in found.items() if count > 1] == []


@pytest.mark.parametrize("top", ["watchsim", "tests", "scripts"])
def test_no_folder_is_crowded(top: str) -> None:
    found = Counter(path.parent.relative_to(ROOT).as_posix() for path in sources(top))
    assert {folder: count for folder, count in found.items() if count > MOST} == {}


def test_the_files_of_a_design_carry_its_name() -> None:
    inside = [path for path in sources("watchsim/construction") if path.parent.name != "construction"]
    assert len(inside) > 10
    assert [path.name for path in inside if not path.name.startswith(f"{path.parent.name}_")] == []


def test_no_two_neighbours_differ_by_their_ending_alone() -> None:
    """Such as keep and kept, part and parts: nobody can tell which of them to open."""
    here = {path.with_suffix("") for path in sources("watchsim")}
    endings = ("s", "es", "ed", "ing", "er", "ion")
    assert [str(path) for path in here for ending in endings if path.with_name(path.name + ending) in here] == []


def test_every_script_answers_help() -> None:
    """By a parser of its own, or by `usage`."""
    scripts = [path for path in (ROOT / "scripts").rglob("*.py") if "__main__" in path.read_text(encoding="utf-8")]
    silent = [path.name for path in scripts if not re.search("ArgumentParser|usage", path.read_text(encoding="utf-8"))]
    assert len(scripts) > 15 and silent == []
