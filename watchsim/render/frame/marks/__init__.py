"""What does a frame show besides the parts themselves: words, numbers, arrows, insets, a strip of curves?

In: a `Trajectory` and an instant. Out: artists on the axes of a frame. Imports `render.palette`, `analysis`, `simulation` and
below.
"""
