"""Speed against error: this solver, its twin and other engines on the same scenes."""
