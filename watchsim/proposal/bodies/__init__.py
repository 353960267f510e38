"""Which bodies does a drawing hold, and what are they?

In: drawings. Out: parts with centre and role. `source` reads, `piece` finds outlines that hang together, `centres` what they
turn about, `grouped_pieces` makes bodies of them, `part_roles` says which is the wheel, the lever, the oscillator. Imports
`analysis`, `drawing` and below.
"""
