"""python -m watchsim"""

import sys

from watchsim.cli import process

sys.exit(process())
