"""python -m watchsim"""

from watchsim.process import process

process()
