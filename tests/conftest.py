"""Where do the tests find their independent truths, and what several folders of them share?

This folder is put on the path, so that `naive` (slow oracles) and `reference` (closed forms) can be imported everywhere, and so
are the folders whose made-up scenes and drawings tests in other folders use, too.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

HERE = Path(__file__).resolve().parent
SHARED = ("contact", "drawing", "drawing/damaged", "scene", "simulation")
sys.path[:0] = [str(HERE), *(str(HERE / name) for name in SHARED)]


def pytest_report_header() -> str:
    """Says which copy of the package is tested: as installed, or a checkout on the path."""
    import watchsim

    return f"watchsim from {Path(watchsim.__file__).parent}"


@pytest.fixture
def desk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """A desk with a good scene and its drawings."""
    from made_scenes import Desk

    return Desk(tmp_path, monkeypatch)


@pytest.fixture
def good() -> Any:
    """The mapping of the good scene."""
    from made_scenes import GOOD

    return GOOD
