"""Does every script say what it is for?"""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def test_every_script_answers_help() -> None:
    """By a parser of its own, or by `usage`."""
    scripts = [path for path in (ROOT / "scripts").rglob("*.py") if "__main__" in path.read_text(encoding="utf-8")]
    silent = [path.name for path in scripts if not re.search("ArgumentParser|usage", path.read_text(encoding="utf-8"))]
    assert len(scripts) > 15 and silent == []
