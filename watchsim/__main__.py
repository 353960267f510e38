"""python -m watchsim"""

import sys

from watchsim.cli import main

sys.exit(main())
