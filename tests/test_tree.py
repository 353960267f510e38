"""Is the tree seen at one glance, and does every script say what it is for?"""

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
SOURCES = [path for path in (ROOT / "watchsim").rglob("*.py") if path.name != "__init__.py"]


def test_packages_hold_files_not_folders() -> None:
    assert len(SOURCES) > 100
    assert [str(path) for path in SOURCES if len(path.relative_to(ROOT / "watchsim").parts) > 2] == []


def test_a_file_holds_a_whole_thought_and_no_more() -> None:
    """Half of all have 200 lines or more; none is longer than can be read in one sitting."""
    lengths = sorted(len(path.read_text(encoding="utf-8").splitlines()) for path in SOURCES)
    assert lengths[len(lengths) // 2] >= 200 and lengths[-1] < 700


def test_every_script_answers_help() -> None:
    """By a parser of its own, or by `usage`."""
    scripts = [path for path in (ROOT / "scripts").rglob("*.py") if "__main__" in path.read_text(encoding="utf-8")]
    silent = [path.name for path in scripts if not re.search("ArgumentParser|usage", path.read_text(encoding="utf-8"))]
    assert len(scripts) > 15 and silent == []
