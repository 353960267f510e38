"""Which contacts are closed, resting, sliding or sticking?

The mode of a contact is indexed by its permanent number. Of the closed contacts I_C those that neither approach nor separate
are I_N (method 2.3); the decision over I_N (method 2.5) leaves some in force, whose mode is not OPEN. I_T are those that STICK.
"""

from __future__ import annotations

OPEN = 0
FORWARD = 1  # sliding with g_T_dot > 0: friction force -mu lambda_N
BACKWARD = -1
STICK = 2
