"""What does the player of a page need: outlines, motion, events, forces, packed small?

In: a `Trajectory` and a window. Out: plain data for JSON (`data`). Imports `render`, `analysis`, `simulation` and below.
"""
