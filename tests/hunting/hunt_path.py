"""Puts `scripts` on the path, where the hunt lives; its tests import this first."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
