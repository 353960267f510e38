"""What does the timing sheet of a page say: amplitude, rate and beat error, phases, parameters?

In: a `Trajectory` and its numbers. Out: HTML (`sheet`). Imports `pages.charts`, `analysis` and below.
"""
