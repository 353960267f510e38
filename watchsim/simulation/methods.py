"""Which ways of stepping through time are there?"""

from __future__ import annotations

EVENT_DRIVEN, MOREAU = "pfeiffer-glocker", "moreau"
METHODS = (EVENT_DRIVEN, MOREAU)
USUAL_STEP = 1e-5  # s, of Moreau's time stepping
