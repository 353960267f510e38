"""Which bodies does a drawing hold, and what are they?

`source` reads, `piece` finds outlines that hang together, `centres` what they turn about, `parts` puts them together as
bodies, `roles` says which is the wheel, the lever, the oscillator.
"""
