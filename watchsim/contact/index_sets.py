"""Which contacts are closed, resting, sliding or sticking?

The mode of a contact is indexed by its permanent number. I_N are the contacts whose mode is not OPEN, I_T those that STICK.
"""

from __future__ import annotations

OPEN = 0
FORWARD = 1  # sliding with g_T_dot > 0: friction force -mu lambda_N
BACKWARD = -1
STICK = 2
