"""Where do the tests find their independent truths?

This folder is put on the path, so that `naive` (slow oracles) and `reference` (closed forms) can be imported everywhere.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
