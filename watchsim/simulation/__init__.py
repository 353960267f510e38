"""Time: how does a mechanism move from its start to its end?

In: a `Scene` or a saved state, a duration, tolerances. Out: a `Trajectory`. `simulate` is the door, `runner` drives the loop
from Python, `event_loop` is the loop, `moreau` its independent twin. Imports `dynamics` and all below.
"""

EVENT_DRIVEN, MOREAU = "pfeiffer-glocker", "moreau"
METHODS = (EVENT_DRIVEN, MOREAU)
