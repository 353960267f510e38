"""What does a fresh interpreter print?"""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from watchsim import jit

ROOT = Path(jit.__file__).resolve().parents[1]  # of the copy under test


def python(code: str, **environment: str) -> str:
    """What a fresh interpreter prints."""
    everything = {**os.environ, "PYTHONPATH": str(ROOT), **environment}
    done = subprocess.run([sys.executable, "-c", code], env=everything, capture_output=True, text=True, check=True)
    return done.stdout.strip()
