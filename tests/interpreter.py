"""What does a fresh interpreter print?"""

import os
import subprocess
import sys
from pathlib import Path

from watchsim import jit

# Of the copy under test. `python -c` and `python -m` look in the current folder first: started where the tests were called,
# they would take a checkout that lies there, and compile its machine code, too.
ROOT = Path(jit.__file__).resolve().parents[1]


def python(code: str, **environment: str) -> str:
    """What a fresh interpreter prints."""
    everything = {**os.environ, "PYTHONPATH": str(ROOT), **environment}
    done = subprocess.run([sys.executable, "-c", code], env=everything, cwd=ROOT, capture_output=True, text=True, check=True)
    return done.stdout.strip()
