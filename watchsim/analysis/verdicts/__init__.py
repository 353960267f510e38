"""Does the watch work, and if not, what is wrong with it?

In: a `Trajectory` and its beats. Out: one `Verdict`, the first that applies, with a sentence for people (`verdict`). One file
a verdict. Imports `analysis.timing`, `simulation` and below.
"""
