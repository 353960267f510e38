"""How are plots drawn: what changes over time, over a beat or over a parameter?

In: a `Trajectory` or a `Sweep`. Out: matplotlib figures. Imports `render.frame`, `studies`, `analysis` and below.
"""
