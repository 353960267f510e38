"""python -m watchsim"""

from __future__ import annotations

from watchsim.process import process

process()
