"""Where do the tests find their independent truths?

This folder is put on the path, so that `naive` (slow oracles) and `reference` (closed forms) can be imported everywhere.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))


def pytest_report_header() -> str:
    """Says which copy of the package is tested: as installed, or a checkout on the path."""
    import watchsim

    return f"watchsim from {Path(watchsim.__file__).parent}"
