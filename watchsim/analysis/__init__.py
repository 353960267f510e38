"""Which numbers follow from a trajectory: beats, energy, forces, verdicts, and the summary of them all?

In: a `Trajectory`. Out: plain numbers in SI with names; `summary` gathers them. Imports `results` for the tables, and
`simulation` and all below for the records; never a picture.
"""
